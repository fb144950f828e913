// How much memory this process has and may have.
#pragma once

#include <string>

namespace ostraka {

/// Bytes that this process occupies; 0 where the system does not say.
double resident_memory();

/// Bytes that the work of this thread may occupy: the limit of its watch, else the memory of the machine; 0 where nothing is
/// known.
double memory_limit();

/// To be called before large work. Throws Error (failure) where `bytes` more than what is occupied now pass the limit: `what`
/// needs them, `remedy` needs less.
void require_memory(double bytes, const std::string& what, const std::string& remedy);

}  // namespace ostraka
