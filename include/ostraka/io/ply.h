// Additional properties in PLY files.
#pragma once

#include "ostraka/files/file.h"

#include <array>
#include <string>
#include <vector>

namespace ostraka {

/// Reads three floating-point properties of the vertices, such as nx, ny and nz, as vectors; the result is empty if the file is
/// not a PLY file or does not have all three properties. Throws Error (input) if the vertex data are damaged.
std::vector<std::array<double, 3>> read_ply_vectors(const Path& file, const std::array<std::string, 3>& names);

}  // namespace ostraka
