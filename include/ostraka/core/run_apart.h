// Work of other libraries that cannot be interrupted.
#pragma once

#include <functional>
#include <memory>
#include <utility>

namespace ostraka {

/// Runs `work` on a thread of its own and returns when it is done; what it throws is thrown here. Throws Error (cancelled) within
/// a few hundredths of a second when the watch of this thread says so: the work then goes on alone, to its end or to its next
/// check, and its results are dropped. So it must own all it touches, and write no files. It is there before the process exits.
/// Without a watch the work runs on this thread.
void run_apart(std::function<void()> work);

/// The same for work on `data`, which is handed over and comes back.
template <class Data, class Work>
Data run_apart_on(Data data, Work work) {
    const auto held = std::make_shared<std::pair<Data, Work>>(std::move(data), std::move(work));
    run_apart([held] { held->second(held->first); });
    return std::move(held->first);
}

}  // namespace ostraka
