// What the native half of the Python module shares: objects that Python holds, and work that Python's lock is released for.
#pragma once

#include "ostraka/core/parallel.h"
#include "ostraka/core/progress.h"
#include "ostraka/operation/objects.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace py = pybind11;

namespace ostraka {
class Context;
}

namespace ostraka::python {

/// Text of files may hold bytes that are no UTF-8.
py::str text_of_bytes(const std::string& text);

/// A name of a file as Python gives it: bytes, as os.fsencode makes them.
Path path_of(const py::bytes& name);

/// How many threads operations use: a setting of each thread, told to every one that works.
inline std::atomic<int> wanted_threads{0};

/// Runs `work` on a thread of its own, without Python's lock. This thread hears signals meanwhile: what their handlers raise,
/// such as KeyboardInterrupt, cancels the work and is raised once it has ended. So does what `progress` raises.
template <class Work>
void run_watched(Watch& watch, const py::object& progress, const Work& work) {
    std::exception_ptr failure;
    std::optional<py::error_already_set> raised;  // touched under Python's lock only
    const auto stop = [&] {
        py::error_already_set error;
        if (!raised) raised.emplace(std::move(error));
        watch.cancel();
    };
    if (!progress.is_none())
        watch.on_progress = [&](const std::string& phase, double share) {
            const py::gil_scoped_acquire lock;
            if (raised) return;
            PyObject* answer = PyObject_CallFunction(progress.ptr(), "sd", phase.c_str(), share);
            if (answer == nullptr) stop();
            Py_XDECREF(answer);
        };
    {
        const py::gil_scoped_release free;
        std::mutex mutex;
        std::condition_variable ended;
        bool done = false;
        std::thread worker([&] {
            try {
                set_threads(wanted_threads);  // a setting of each thread
                const WatchScope watched(&watch);
                work();
            } catch (...) {
                failure = std::current_exception();
            }
            const std::lock_guard lock(mutex);
            done = true;
            ended.notify_one();
        });
        for (std::unique_lock lock(mutex); !ended.wait_for(lock, std::chrono::milliseconds(50), [&] { return done; });) {
            lock.unlock();
            {
                const py::gil_scoped_acquire python;
                if (PyErr_CheckSignals() != 0) stop();
            }
            lock.lock();
        }
        worker.join();
    }
    watch.on_progress = nullptr;
    if (raised) throw py::error_already_set(std::move(*raised));
    if (failure) std::rethrow_exception(failure);
}

/// The same of work that is not watched.
template <class Work>
auto unlocked(const Work& work) {
    Watch watch;
    std::optional<decltype(work())> result;
    run_watched(watch, py::none(), [&] { result.emplace(work()); });
    return std::move(*result);
}

/// An object of the toolkit that Python holds.
struct Held {
    Object object;
    std::shared_ptr<Context> context = {};  ///< in whose memory the files of a folder or a template are
};

/// Adds the class of such objects, and the functions that read and make them, to the module.
void add_objects(py::module_& module);

}  // namespace ostraka::python
