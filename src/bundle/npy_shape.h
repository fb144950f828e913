// The head of a NumPy array.
#pragma once

#include "ostraka/core/file.h"

#include <cstdint>
#include <vector>

namespace ostraka {

/// The shape of a .npy file of little-endian float64 whose size is what the shape asks for, all numbers finite. Throws Error
/// (input).
std::vector<std::uint64_t> npy_shape(const Path& file);

}  // namespace ostraka
