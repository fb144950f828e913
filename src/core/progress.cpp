#include "ostraka/core/progress.h"

#include "ostraka/core/error.h"

#include <chrono>

namespace ostraka {

namespace {

thread_local Watch* watch_of_thread = nullptr;

long long milliseconds() {
    return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void stop_if_cancelled(const Watch* watch) {
    if (watch != nullptr && watch->is_cancelled()) throw Error(ErrorKind::cancelled, "", "cancelled", "nothing was written");
}

}  // namespace

WatchScope::WatchScope(Watch* watch) : outer_(watch_of_thread) { watch_of_thread = watch; }
WatchScope::~WatchScope() { watch_of_thread = outer_; }

Watch* current_watch() { return watch_of_thread; }
void check_cancelled() { stop_if_cancelled(watch_of_thread); }

Progress::Progress(std::string phase, std::size_t total)
    : phase_(std::move(phase)), total_(total), watch_(watch_of_thread), last_reported_(milliseconds()) {}

Progress::~Progress() {
    if (watch_ != nullptr && watch_->on_progress && done_ > 0) watch_->on_progress(phase_, 1);
}

void Progress::advance(std::size_t steps) {
    if (watch_ == nullptr) return;
    stop_if_cancelled(watch_);
    const std::size_t done = done_ += steps;
    if (!watch_->on_progress || total_ == 0) return;
    long long last = last_reported_;
    const long long now = milliseconds();
    if (now - last < 100 || !last_reported_.compare_exchange_strong(last, now)) return;
    watch_->on_progress(phase_, std::min(1.0, static_cast<double>(done) / static_cast<double>(total_)));
}

}  // namespace ostraka
