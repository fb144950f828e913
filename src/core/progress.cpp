#include "ostraka/core/progress.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>

namespace ostraka {

namespace {
std::atomic<bool> off{false};

long long now() {
    return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
}  // namespace

void Progress::switch_off() { off = true; }

Progress::Progress(std::string label, std::size_t total)
    : label_(std::move(label)), total_(total), last_drawn_(now()), shown_(!off && total > 0 && ::isatty(2) != 0) {}

Progress::~Progress() {
    if (shown_) std::fprintf(stderr, "\r\033[K");
}

void Progress::advance(std::size_t steps) {
    if (!shown_) return;
    const std::size_t done = done_ += steps;
    long long last = last_drawn_;
    const long long time = now();
    if (time - last < 100 || !last_drawn_.compare_exchange_strong(last, time)) return;
    std::fprintf(stderr, "\r%s %3d %%\033[K", label_.c_str(), static_cast<int>(100 * done / total_));
}

}  // namespace ostraka
