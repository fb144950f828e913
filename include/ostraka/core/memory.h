// Memory use and memory limit of this process.
#pragma once

#include <string>

namespace ostraka {

/// Resident memory of this process in bytes; 0 if the system does not report it.
double resident_memory();

/// Memory limit in bytes for the work of this thread: the limit of its watch, else the memory of the machine; 0 if unknown.
double memory_limit();

/// To be called before large work. Throws Error (failure) if `bytes` in addition to the memory now in use exceed the limit. For
/// the message: `purpose` needs the memory, `remedy` needs less.
void require_memory(double bytes, const std::string& purpose, const std::string& remedy);

}  // namespace ostraka
