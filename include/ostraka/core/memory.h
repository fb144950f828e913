// Memory use and memory limit of this process.
#pragma once

#include <string>

namespace ostraka {

/// Resident memory of this process in bytes; 0 if the system does not report it.
double resident_memory();

/// Memory limit in bytes for computations of this thread: the limit set in the thread's Watch, otherwise the memory of the
/// machine; 0 if unknown.
double memory_limit();

/// Checks before a large allocation that memory suffices. Throws Error (failure) if `bytes` plus the memory in use exceed the
/// memory limit. The message contains `purpose` (what the memory is needed for) and `remedy` (how to use less memory).
void require_memory(double bytes, const std::string& purpose, const std::string& remedy);

}  // namespace ostraka
