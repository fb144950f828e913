// Runs work on a separate thread without the GIL, so that the calling Python thread can be interrupted.
#pragma once

#include "ostraka/core/progress.h"

#include <pybind11/pybind11.h>

#include <atomic>
#include <functional>
#include <memory>
#include <optional>

namespace py = pybind11;

namespace ostraka::python {

/// The number of threads that operations use; it is set in every worker thread, since the setting is per thread.
inline std::atomic<int> requested_threads{0};
/// Memory limit of the process during operations in bytes; 0: the memory of the machine.
inline std::atomic<double> requested_memory{0};

/// Runs `work` on a separate thread, without the GIL. The calling thread handles signals meanwhile: an exception raised by
/// their handlers, such as KeyboardInterrupt, or by `progress` cancels the work. The exception is raised when the work has
/// ended, or after 0.6 s at the latest; in that case the work ends at its next cancellation check, and its result is dropped.
/// `work` must therefore own all data it uses and must not use Python objects. Throws Error (failure) if memory is exhausted.
void run_watched(const std::shared_ptr<Watch>& watch, const py::object& progress, std::function<void()> work);

/// Runs work without a watch; returns its result.
template <class Work>
auto unlocked(Work work) {
    const auto result = std::make_shared<std::optional<decltype(work())>>();
    run_watched(std::make_shared<Watch>(), py::none(), [result, work = std::move(work)]() mutable { result->emplace(work()); });
    return std::move(**result);
}

/// For a process that loaded OpenMP without a wait policy before this module could set one: idle threads then spin for
/// milliseconds, unless there are more threads than cores. Starts two additional threads that sleep forever, so that idle
/// threads do not spin.
void hold_spare_team();

/// To be called once: at exit, running work is ended before the data it uses are destroyed, and temporary files are removed.
void stop_work_at_exit();

}  // namespace ostraka::python
