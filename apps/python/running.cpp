#include "running.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/files/file.h"

#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

namespace ostraka::python {

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds poll{50}, grace_period{600};
constexpr int interrupted_polls = 4;  ///< polls during which the main thread may handle an interrupt

/// A running job, owned by the worker thread and by the waiting thread.
struct Job {
    std::shared_ptr<Watch> watch;
    std::function<void()> work;
    std::mutex mutex;
    std::condition_variable ended;
    bool done = false;
    std::exception_ptr failure;
    bool at_end = false;                               ///< the call runs while Python is shutting down
    std::atomic<bool> abandoned{false};                ///< no thread waits for it; set while holding the GIL
    std::optional<py::error_already_set> raised = {};  ///< exception raised by Python; accessed only while holding the GIL
};

/// Running jobs of all threads; a forked process starts without those of its parent. Never destroyed, since threads may outlive
/// it.
class Jobs {
public:
    void add(const Job* job) {
        change([&] { jobs_.insert(job); });
    }
    void remove(const Job* job) {
        change([&] { jobs_.erase(job); });
    }
    /// Cancels all jobs; returns whether there are any.
    bool cancel() {
        bool any = false;
        change([&] {
            for (const Job* job : jobs_) job->watch->cancel();
            any = !jobs_.empty();
        });
        return any;
    }

private:
    template <class Change>
    void change(const Change& work) {
        const std::lock_guard lock(mutex_);
        work();
    }
    std::mutex mutex_;
    std::set<const Job*> jobs_;
};
/// Abandoned, not destroyed, in a forked process: the threads belong to the parent.
std::atomic<Jobs*> jobs{nullptr};

void add_jobs() { jobs = new Jobs; }

bool python_ends() {
#if PY_VERSION_HEX >= 0x030D0000
    return Py_IsFinalizing() != 0;
#else
    return _Py_IsFinalizing() != 0;
#endif
}

void work_on(const std::shared_ptr<Job>& job, Jobs* running_jobs) {
    try {
        set_threads(requested_threads);  // a setting of each thread
        const WatchScope watched(job->watch.get());
        job->work();
    } catch (...) {
        job->failure = std::current_exception();
    }
    job->work = nullptr;  // also frees the objects it owns
    running_jobs->remove(job.get());
    const std::lock_guard lock(job->mutex);
    job->done = true;
    job->ended.notify_one();
}

/// Stores the exception raised by Python and cancels the job.
void stop(Job& job) {
    py::error_already_set error;
    if (!job.raised) job.raised.emplace(std::move(error));
    job.watch->cancel();
}

std::function<void(const std::string&, double)> progress_callback(const std::weak_ptr<Job>& weak_job,
                                                                  const py::object& progress) {
    return [weak_job, function = progress.ptr()](const std::string& phase, double share) {
        const std::shared_ptr<Job> job = weak_job.lock();
        if (!job || job->abandoned || python_ends()) return;
        const py::gil_scoped_acquire python;
        if (job->abandoned || job->raised) return;
        PyObject* answer = PyObject_CallFunction(function, "sd", phase.c_str(), share);
        if (answer == nullptr) stop(*job);
        Py_XDECREF(answer);
    };
}

/// Runs signal handlers and picks up exceptions that other threads raised in this one. `polls`: number of consecutive calls
/// during which the main thread has been handling an interrupt.
void handle_signals(Job& job, int& polls) {
    if (PyErr_CheckSignals() != 0) return stop(job);
    PyObject* module = PyImport_ImportModule("ostraka._interrupts");
    PyObject* answer = module == nullptr ? nullptr : PyObject_CallMethod(module, "main_thread_state", nullptr);
    Py_XDECREF(module);
    const long state = answer == nullptr ? -1 : PyLong_AsLong(answer);
    Py_XDECREF(answer);
    if (PyErr_Occurred() != nullptr) return stop(job);
    polls = state == 1 ? polls + 1 : 0;
    if (state == 2 || polls >= interrupted_polls) {
        PyErr_SetNone(PyExc_KeyboardInterrupt);
        stop(job);
    }
}

/// While Python shuts down, a thread that requests the GIL would be terminated inside this code: all threads except the one
/// that shuts Python down wait for the end of the process.
void wait_if_python_ends(const Job& job) {
    while (!job.at_end && python_ends()) ::pause();
}

/// Waits without the GIL until the job has ended, or for 0.6 s after its cancellation. Returns whether it has ended.
bool wait_for(Job& job) {
    int polls = 0;
    std::optional<Clock::time_point> deadline;
    for (std::unique_lock lock(job.mutex); !job.ended.wait_for(lock, poll, [&] { return job.done; });) {
        lock.unlock();
        wait_if_python_ends(job);
        {
            const py::gil_scoped_acquire python;
            if (!job.raised) handle_signals(job, polls);
            if (job.raised && !deadline) deadline = Clock::now() + grace_period;
            if (deadline && Clock::now() > *deadline) {
                job.abandoned = true;
                return false;
            }
        }
        lock.lock();
    }
    wait_if_python_ends(job);
    return true;
}

}  // namespace

void run_watched(const std::shared_ptr<Watch>& watch, const py::object& progress, std::function<void()> work) {
    const auto job = std::make_shared<Job>();
    job->watch = watch;
    job->work = std::move(work);
    job->at_end = python_ends();
    watch->memory_limit = requested_memory;
    if (!progress.is_none()) watch->on_progress = progress_callback(job, progress);
    {
        const py::gil_scoped_release without_gil;
        jobs.load()->add(job.get());
        std::thread worker;
        try {
            worker = std::thread(work_on, job, jobs.load());
        } catch (const std::system_error&) {
            jobs.load()->remove(job.get());
            throw Error(ErrorKind::failure, "", "no further thread can be started", "end other work first");
        }
        if (wait_for(*job)) worker.join();
        else worker.detach();
    }
    if (!job->abandoned) watch->on_progress = nullptr;
    if (job->raised) {
        py::error_already_set raised(std::move(*job->raised));
        job->raised.reset();
        throw raised;
    }
    try {
        if (job->failure) std::rethrow_exception(job->failure);
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::failure, "", "there is not enough memory", "end other programs, or give a smaller object");
    }
}

void hold_spare_team() {
    std::thread([] {
        std::atomic<int> members{0};
#pragma omp parallel num_threads(2)
        ++members;
        for (;;) ::pause();  // the team lasts as long as its first thread
    }).detach();
}

void stop_work_at_exit() {
    add_jobs();
    ::pthread_atfork(nullptr, nullptr, add_jobs);
    // Python has shut down completely by then. Jobs still running would use data that process exit destroys.
    Py_AtExit([] {
        if (!jobs.load()->cancel()) return;
        abandon_outputs();
        ::on_exit([](int status, void* /*none*/) { ::_exit(status); }, nullptr);
    });
}

}  // namespace ostraka::python
