// One run: in a separate process with limits, which can write only into the folder of all runs.
#pragma once

#include "ostraka/files/file.h"

#include <functional>
#include <mutex>
#include <string>

namespace ostraka::fuzz {

/// Cancels the current run. Thread-safe.
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

    double memory = 0;  ///< max memory of the process in bytes

private:
    std::mutex mutex_;
    std::function<void()> stop_;
};

/// The work of a run in the current folder; returns its output.
using Act = std::function<std::string(Stopper&)>;

enum class Outcome {
    accepted,
    refused,   ///< failed with an Error
    stopped,   ///< exceeded the time limit, but ended when cancelled
    crash,     ///< ended by a signal, or by an exception other than Error
    hang,      ///< exceeded the time limit, and did not end when cancelled
    memory,    ///< exceeded the memory limit
    touched,   ///< changed a file outside the folder
    betrayed,  ///< disclosed a file outside the folder
};
std::string to_string(Outcome outcome);
inline bool is_finding(Outcome outcome) { return outcome > Outcome::stopped; }

struct Verdict {
    Outcome outcome = Outcome::accepted;
    std::string detail;  ///< description
    double seconds = 0;
    double peak = 0;  ///< peak memory of the process in bytes
};

struct Limits {
    double seconds = 10;  ///< processor time after which it is cancelled
    double memory = 0;    ///< bytes, including the base memory of the process
};

/// Whether memory is limited and measured; not under sanitizers, which need too much themselves.
bool measures_memory();

/// Whether the system can restrict where a process writes (Linux's Landlock).
bool can_confine();

/// Runs it in `folder`; it may write below `home` only. Its output is written to `output_file`.
Verdict run_child(const Act& act, const Path& folder, const Path& home, const Path& output_file, const Limits& limits);

/// Memory of an idle process in bytes.
double idle_memory();

}  // namespace ostraka::fuzz
