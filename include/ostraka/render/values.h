// Lists of numbers, one an element, as maps hold them.
#pragma once

#include "ostraka/core/file.h"

#include <vector>

namespace ostraka {

/// Reads a NumPy array (.npy, little-endian numbers or booleans, of one dimension or one column) or, under any other extension, a
/// text with one number a line ("nan" for no value; lines that start with # are left out). Throws Error (input) with line or
/// byte.
std::vector<double> read_values(const Path& file);

/// Writes a NumPy array of float64 (.npy) or, under any other extension, one number a line, "nan" for no value.
void write_values(const Path& file, const std::vector<double>& values);

}  // namespace ostraka
