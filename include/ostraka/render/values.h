// Files of numbers: one number per vertex or face.
#pragma once

#include "ostraka/files/file.h"

#include <vector>

namespace ostraka {

/// Reads a NumPy array (.npy, little-endian numbers or booleans, of one dimension or one column) or, for any other extension, a
/// text file with one number per line ("nan" for no value; lines that start with # are skipped). Throws Error (input) that names
/// the line or byte.
std::vector<double> read_values(const Path& file);

/// Writes numbers as a NumPy array of float64 (.npy) or, for any other extension, as one number per line, "nan" for no value.
void write_values(const Path& file, const std::vector<double>& values);

}  // namespace ostraka
