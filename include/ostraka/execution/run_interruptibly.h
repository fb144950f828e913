// Makes calls of library functions cancellable although these functions do not check for cancellation.
#pragma once

#include <functional>
#include <memory>
#include <utility>

namespace ostraka {

/// Runs `work` on a separate thread, waits until `work` has ended and rethrows its exceptions. If the watch of this thread is
/// cancelled, throws Error (cancelled) within a few hundredths of a second; `work` then continues in the background until it ends
/// or checks for cancellation, and its results are dropped. Therefore `work` must own all data that it uses, and must not write
/// files. The process does not exit before `work` has ended. Without a watch, `work` runs on this thread.
void run_interruptibly(std::function<void()> work);

/// Runs `work(data)` as `run_interruptibly` does; `data` is moved to the thread and returned.
template <class Data, class Work>
Data run_interruptibly_on(Data data, Work work) {
    const auto state = std::make_shared<std::pair<Data, Work>>(std::move(data), std::move(work));
    run_interruptibly([state] { state->second(state->first); });
    return std::move(state->first);
}

}  // namespace ostraka
