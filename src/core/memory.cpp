#include "ostraka/core/memory.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/text.h"

#include <unistd.h>

#include <fmt/core.h>

#include <fstream>

namespace ostraka {

namespace {
std::string gigabytes(double bytes) { return digits(bytes / 1e9, 4) + " GB"; }
}  // namespace

double resident_memory() {
    std::ifstream file("/proc/self/statm");
    double total = 0, resident = 0;
    return file >> total >> resident ? resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) : 0;
}

double memory_limit() {
    const Watch* watch = current_watch();
    if (watch != nullptr && watch->memory_limit > 0) return watch->memory_limit;
    const long pages = ::sysconf(_SC_PHYS_PAGES), size = ::sysconf(_SC_PAGESIZE);
    return pages > 0 && size > 0 ? static_cast<double>(pages) * static_cast<double>(size) : 0;
}

void require_memory(double bytes, const std::string& purpose, const std::string& remedy) {
    const double limit = memory_limit();
    if (limit <= 0 || resident_memory() + bytes <= limit) return;
    const Watch* watch = current_watch();
    const bool is_given = watch != nullptr && watch->memory_limit > 0;
    fail_work("",
              fmt::format("{} needs about {} of memory, but {}", purpose, gigabytes(bytes),
                          is_given ? gigabytes(limit) + " is allowed (--memory)" : "the machine has " + gigabytes(limit)),
              remedy);
}

}  // namespace ostraka
