// Additional properties in PLY files.
#pragma once

#include "ostraka/files/file.h"

#include <array>
#include <string>
#include <vector>

namespace ostraka {

/// Reads three floating-point properties of the vertices, such as nx, ny and nz; empty if the file is no PLY file or lacks one
/// of them. Throws Error (input) if the file is damaged before the end of the vertices.
std::vector<std::array<double, 3>> read_ply_vectors(const Path& file, const std::array<std::string, 3>& names);

struct PlyColumn {
    std::string name;
    std::vector<double> values;
};
/// Additional properties, with one number per element.
struct PlyNumbers {
    std::vector<PlyColumn> vertices, faces;
};
/// Reads the floating-point properties of vertices and faces (polygons), except coordinates, normals, colours and texture
/// coordinates; empty if the file is no PLY file. Throws Error (input) if the file is damaged before the end of these elements.
PlyNumbers read_ply_numbers(const Path& file);

}  // namespace ostraka
