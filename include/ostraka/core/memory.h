// Memory use and memory limit of this process.
#pragma once

#include <string>

namespace ostraka {

/// Resident memory of this process in bytes; 0 if the system does not report it.
double resident_memory();

/// Memory limit in bytes for the work of this thread: the limit set by the thread's Watch, else the memory of the machine; 0 if
/// unknown.
double memory_limit();

/// Checks before large work that memory suffices: throws Error (failure) if `bytes` plus the memory now in use exceed the limit.
/// For the message: `purpose` says what needs the memory, `remedy` how to need less.
void require_memory(double bytes, const std::string& purpose, const std::string& remedy);

}  // namespace ostraka
