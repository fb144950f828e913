// Work on a thread of its own, for which Python's lock is released: what a call of Python waits for, and how it is interrupted.
#pragma once

#include "ostraka/core/progress.h"

#include <pybind11/pybind11.h>

#include <atomic>
#include <functional>
#include <memory>
#include <optional>

namespace py = pybind11;

namespace ostraka::python {

/// The number of threads that operations use: a setting of each thread, handed to every one that works.
inline std::atomic<int> wanted_threads{0};
/// Bytes that the process may occupy while an operation works; 0: what the machine has.
inline std::atomic<double> wanted_memory{0};

/// Runs `work` on a thread of its own, without Python's lock. This thread hears signals meanwhile: what their handlers raise,
/// such as KeyboardInterrupt, cancels the work, and so does what `progress` raises. It is raised as soon as the work has ended,
/// and 0.6 s later at the latest: the work then ends at its next check on the thread of its own, and what it made is dropped.
/// `work` must therefore own all that it uses, and touch nothing of Python. Throws Error (failure) where the memory is used up.
void run_watched(const std::shared_ptr<Watch>& watch, const py::object& progress, std::function<void()> work);

/// The same of work that is not watched; returns what it returns.
template <class Work>
auto unlocked(Work work) {
    const auto result = std::make_shared<std::optional<decltype(work())>>();
    run_watched(std::make_shared<Watch>(), py::none(), [result, work = std::move(work)]() mutable { result->emplace(work()); });
    return std::move(**result);
}

/// For a process that had loaded OpenMP, without a policy of waiting, before this module could name one: threads that wait for
/// work then spin for milliseconds, unless more threads exist than cores. Two more, which sleep for good, see to that.
void hold_spare_team();

/// To be called once: what still works when Python has ended leaves no temporary files, and does not outlive what it uses.
void stop_work_at_exit();

}  // namespace ostraka::python
