#include "report.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <fstream>

#include <malloc.h>

namespace ostraka::experiments {

namespace {

/// A value from the process's status, in kilobytes (Linux).
std::optional<double> status(const std::string& name) {
    std::ifstream file("/proc/self/status");
    for (std::string word; file >> word;) {
        double kilobytes = 0;
        if (word == name && file >> kilobytes) return kilobytes;
    }
    return {};
}

}  // namespace

std::string format(const char* pattern, ...) {
    std::va_list list, again;
    va_start(list, pattern);
    va_copy(again, list);
    std::string text(static_cast<std::size_t>(std::max(0, std::vsnprintf(nullptr, 0, pattern, list))), '\0');
    std::vsnprintf(text.data(), text.size() + 1, pattern, again);
    va_end(again);
    va_end(list);
    return text;
}

PeakMemory::PeakMemory() {
    malloc_trim(0);
    std::ofstream reset("/proc/self/clear_refs");  // 5: resets the peak
    reset << "5" << std::flush;
    if (reset) before_ = status("VmRSS:");
}

std::optional<double> PeakMemory::megabytes() const {
    const std::optional<double> peak = status("VmHWM:");
    if (!before_ || !peak) return {};
    return (*peak - *before_) * 1024 / 1e6;
}

}  // namespace ostraka::experiments
