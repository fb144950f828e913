// The vertices of a PLY file as columns of numbers, for files without faces.
#pragma once

#include "ostraka/files/file.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

/// A property of the vertices of a PLY file.
struct PlyVertexColumn {
    std::string name;            ///< name of the property
    bool is_real = true;         ///< true: real numbers; false: whole numbers
    std::size_t bytes = 4;       ///< bytes of a number in a binary file
    std::vector<double> values;  ///< one number per vertex
};

/// The vertices of a PLY file.
struct PlyVertexProperties {
    std::size_t vertices = 0;              ///< number of vertices
    bool has_faces = false;                ///< true: the file has faces or triangle strips; `columns` is then empty
    std::vector<PlyVertexColumn> columns;  ///< the properties except lists, in the order of the file
    std::vector<std::string> notes;        ///< messages about contents of the file that are not in `columns`
};

/// Reads the vertices of the PLY file with the content `bytes`; numbers may be infinite or NaN. Throws Error (input) with the
/// line or byte if the header or the vertex data are damaged. Memory is bounded by the size of the file.
PlyVertexProperties read_ply_vertex_properties(const std::string& bytes, const std::string& file);

}  // namespace ostraka
