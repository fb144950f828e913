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

struct PlyColumn {
    std::string name;
    std::vector<double> values;
};
/// Of each element a number for each that the file has.
struct PlyNumbers {
    std::vector<PlyColumn> vertices, faces;
};
/// The real properties of vertices and of faces (polygons) but for coordinates, normals, colours and texture; nothing where the
/// file is no PLY file. Throws Error (input) for a file that is damaged up to there.
PlyNumbers read_ply_numbers(const Path& file);

}  // namespace ostraka
