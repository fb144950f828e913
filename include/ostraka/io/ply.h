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

/// One property of all vertices or all faces.
struct PlyColumn {
    std::string name;            ///< name of the property
    std::vector<double> values;  ///< one number per vertex or face
};
/// Additional properties in a PLY file.
struct PlyNumbers {
    std::vector<PlyColumn> vertices, faces;  ///< properties of vertices; properties of faces
};
/// Reads the floating-point properties of vertices and faces (polygons), except coordinates, normals, colours and texture
/// coordinates; the result is empty if the file is not a PLY file. Throws Error (input) if the file is damaged before the end of
/// the vertices and faces.
PlyNumbers read_ply_numbers(const Path& file);

}  // namespace ostraka
