// How far a piece of work is, and whether it shall stop.
#pragma once

#include <atomic>
#include <functional>
#include <string>

namespace ostraka {

/// Watches the work of one thread and of the parallel loops it starts.
class Watch {
public:
    /// Called with the phase under way and its share done (0 to 1), at most ten times a second, from any thread.
    std::function<void(const std::string& phase, double share)> on_progress;

    /// Bytes that the process may occupy while the work is under way; 0: what the machine has (core/memory.h).
    double memory_limit = 0;

    /// Makes the work stop at the next step of a loop, with an Error (cancelled). May be called from any thread or a signal
    /// handler.
    void cancel() { cancelled_ = true; }
    [[nodiscard]] bool is_cancelled() const { return cancelled_; }

private:
    std::atomic<bool> cancelled_{false};
};

/// Installs a watch (or none) for this thread as long as it lives.
class WatchScope {
public:
    explicit WatchScope(Watch* watch);
    ~WatchScope();
    WatchScope(const WatchScope&) = delete;
    WatchScope& operator=(const WatchScope&) = delete;

private:
    Watch* outer_;
};

/// The watch of this thread, or none.
Watch* current_watch();
/// Throws Error (cancelled) if the watch of this thread says so.
void check_cancelled();

/// For innermost loops and functors of other libraries: asks the watch at every 1024th step only. Each thread has its own.
class CancelCheck {
public:
    void operator()() {
        if ((++steps_ & 1023U) == 0) check_cancelled();
    }

private:
    unsigned steps_ = 0;
};

/// Tells the watch of the thread that makes it how far a phase is. `advance` may be called from any thread; it throws Error
/// (cancelled) when the work shall stop.
class Progress {
public:
    Progress(std::string phase, std::size_t total);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    void advance(std::size_t steps = 1);

private:
    std::string phase_;
    std::size_t total_;
    Watch* watch_;
    std::atomic<std::size_t> done_{0};
    std::atomic<long long> last_reported_{0};
};

}  // namespace ostraka
