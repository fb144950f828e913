// Calls of library functions that cannot be interrupted.
#pragma once

#include <functional>
#include <memory>
#include <utility>

namespace ostraka {

/// Runs `work` on a separate thread, waits for it and rethrows its exceptions. If the watch of this thread is cancelled, throws
/// Error (cancelled) within a few hundredths of a second; `work` then continues in the background to its end or its next check,
/// and its results are dropped. Therefore `work` must own all data that it uses, and must not write files. The process does not
/// exit before `work` has ended. Without a watch, `work` runs on this thread.
void run_interruptibly(std::function<void()> work);

/// The same for work on `data`, which is moved to the work and returned.
template <class Data, class Work>
Data run_interruptibly_on(Data data, Work work) {
    const auto state = std::make_shared<std::pair<Data, Work>>(std::move(data), std::move(work));
    run_interruptibly([state] { state->second(state->first); });
    return std::move(state->first);
}

}  // namespace ostraka
