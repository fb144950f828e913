// Additional properties in PLY files.
#pragma once

#include "ostraka/files/file.h"

#include <array>
#include <string>
#include <vector>

namespace ostraka {

/// Reads three floating-point properties of the vertices, such as nx, ny and nz, as vectors; empty if the file is not a PLY file
/// or lacks one of the properties. Throws Error (input) if the file is damaged before the end of the vertices.
std::vector<std::array<double, 3>> read_ply_vectors(const Path& file, const std::array<std::string, 3>& names);

}  // namespace ostraka
