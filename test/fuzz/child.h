// One run: in a process of its own, with limits, where it can write nowhere but into the folder of all runs.
#pragma once

#include "ostraka/core/file.h"

#include <functional>
#include <mutex>
#include <string>

namespace ostraka::fuzz {

/// How what is under way is stopped. Safe for several threads.
class Stopper {
public:
    void set(std::function<void()> stop) {
        const std::lock_guard lock(mutex_);
        stop_ = std::move(stop);
    }
    void stop() {
        const std::lock_guard lock(mutex_);
        if (stop_) stop_();
    }

    double memory = 0;  ///< bytes that the process may occupy

private:
    std::mutex mutex_;
    std::function<void()> stop_;
};

/// What a run does in its folder, which is the current one; returns all that it has to say.
using Act = std::function<std::string(Stopper&)>;

enum class Outcome {
    accepted,
    refused,   ///< with an Error
    stopped,   ///< it took long, and ended when it was told to
    crash,     ///< a signal, or an exception that is no Error
    hang,      ///< it took long, and did not end when it was told to
    memory,    ///< it took more than it may
    touched,   ///< something outside the folder was changed
    betrayed,  ///< something outside the folder was read and told
};
std::string to_string(Outcome outcome);
inline bool is_finding(Outcome outcome) { return outcome > Outcome::stopped; }

struct Verdict {
    Outcome outcome = Outcome::accepted;
    std::string detail;  ///< in words
    double seconds = 0;
    double peak = 0;  ///< bytes that the process occupied at most
};

struct Limits {
    double seconds = 10;  ///< of the processor, before it is told to stop
    double memory = 0;    ///< bytes, what the process itself takes included
};

/// Whether memory is limited and measured: sanitizers take too much of their own.
bool measures_memory();

/// Whether the system can keep a process from writing elsewhere (Linux's Landlock).
bool can_confine();

/// Runs it in `folder`; it may write below `home` alone. What it says goes to `said`, a file.
Verdict run_child(const Act& act, const Path& folder, const Path& home, const Path& said, const Limits& limits);

/// Bytes that a process occupies which does nothing.
double idle_memory();

}  // namespace ostraka::fuzz
