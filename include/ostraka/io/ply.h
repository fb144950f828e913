// What PLY files hold beside a mesh.
#pragma once

#include "ostraka/core/file.h"

#include <array>
#include <string>
#include <vector>

namespace ostraka {

/// Three real properties of the vertices, such as nx, ny and nz; empty where the file is no PLY file or lacks one of them. Throws
/// Error (input) for a file that is damaged up to there.
std::vector<std::array<double, 3>> read_ply_vectors(const Path& file, const std::array<std::string, 3>& names);

}  // namespace ostraka
