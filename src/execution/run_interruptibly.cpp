#include "ostraka/execution/run_interruptibly.h"

#include "ostraka/core/progress.h"

#include <omp.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace ostraka {

namespace {

/// State shared by the two threads.
struct SharedState {
    std::mutex mutex;
    std::condition_variable changed;
    bool done = false;
    std::exception_ptr failure;
    Watch watch;  ///< watch of the background work; cancelled together with the caller's
};

/// Counts abandoned work. The process waits for it before it exits: libraries must not be unloaded while they compute.
class Abandoned {
public:
    ~Abandoned() {
        std::unique_lock lock(mutex_);
        ended_.wait(lock, [&] { return count_ == 0; });
    }
    void add(int change) {
        const std::lock_guard lock(mutex_);
        count_ += change;
        if (count_ == 0) ended_.notify_all();
    }

private:
    std::mutex mutex_;
    std::condition_variable ended_;
    int count_ = 0;
};

Abandoned& abandoned() {
    static Abandoned instance;
    return instance;
}

}  // namespace

void run_interruptibly(std::function<void()> work) {
    Watch* const watch = current_watch();
    if (watch == nullptr) return work();
    check_cancelled();
    abandoned().add(1);
    const auto shared = std::make_shared<SharedState>();
    shared->watch.memory_limit = watch->memory_limit;
    const int threads = omp_get_max_threads();
    std::thread thread([shared, threads, work = std::move(work)]() mutable {
        omp_set_num_threads(threads);  // OpenMP stores the setting per thread
        const WatchScope watched(&shared->watch);
        std::exception_ptr failure;
        try {
            work();
        } catch (...) {
            failure = std::current_exception();
        }
        work = nullptr;  // if the work was abandoned, its data are freed here
        {
            const std::lock_guard lock(shared->mutex);
            shared->failure = failure;
            shared->done = true;
            shared->changed.notify_all();
        }
        abandoned().add(-1);
    });
    std::unique_lock lock(shared->mutex);
    while (!shared->changed.wait_for(lock, std::chrono::milliseconds(20), [&] { return shared->done; })) {
        if (!watch->is_cancelled()) continue;
        shared->watch.cancel();
        lock.unlock();
        thread.detach();
        check_cancelled();
    }
    lock.unlock();
    thread.join();
    if (shared->failure) std::rethrow_exception(shared->failure);
    check_cancelled();
}

}  // namespace ostraka
