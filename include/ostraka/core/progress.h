// Progress and cancellation of work.
#pragma once

#include <atomic>
#include <functional>
#include <string>

namespace ostraka {

/// Receives the progress of the computations of one thread and of the parallel loops that this thread starts, and can cancel
/// these computations.
class Watch {
public:
    /// Called with the current phase and the completed fraction (0 to 1), at most ten times per second, from any thread.
    std::function<void(const std::string& phase, double share)> on_progress;

    /// Limit of the memory of the process during the computations, in bytes; 0: the memory of the machine (core/memory.h).
    double memory_limit = 0;

    /// Makes the computation throw Error (cancelled) at its next check for cancellation. May be called from any thread or from
    /// a signal handler.
    void cancel() { cancelled_ = true; }
    [[nodiscard]] bool is_cancelled() const { return cancelled_; }  ///< true after cancel()

private:
    std::atomic<bool> cancelled_{false};
};

/// Sets the watch of the current thread (null: none) during the lifetime of this object.
class WatchScope {
public:
    explicit WatchScope(Watch* watch);
    ~WatchScope();
    WatchScope(const WatchScope&) = delete;
    WatchScope& operator=(const WatchScope&) = delete;

private:
    Watch* outer_;
};

/// The watch of the current thread; null if there is none.
Watch* current_watch();
/// Throws Error (cancelled) if the watch of the current thread is cancelled.
void check_cancelled();

/// Function object that checks for cancellation at every 1024th call; for inner loops and for functors passed to other
/// libraries. Each thread needs its own CancelCheck.
class CancelCheck {
public:
    void operator()() {
        if ((++steps_ & 1023U) == 0) check_cancelled();
    }

private:
    unsigned steps_ = 0;
};

/// Reports the progress of a phase to the watch of the thread that constructs the Progress object. `advance` may be called from
/// any thread and throws Error (cancelled) if the work was cancelled.
class Progress {
public:
    /// `total`: number of steps of the phase.
    Progress(std::string phase, std::size_t total);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    void advance(std::size_t steps = 1);  ///< reports that further steps are done

private:
    std::string phase_;
    std::size_t total_;
    Watch* watch_;
    std::atomic<std::size_t> done_{0};
    std::atomic<long long> last_reported_{0};
};

}  // namespace ostraka
