// Mesh files: strict reading, atomic writing; the order of vertices is kept.
#pragma once

#include "ostraka/files/file.h"
#include "ostraka/mesh/mesh.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace ostraka {

using Colour = std::array<std::uint8_t, 4>;  ///< red, green, blue, alpha

/// Attributes of a mesh's elements. Each list is empty or has one entry per element.
struct MeshExtras {
    std::vector<Colour> vertex_colours;
    std::vector<Colour> face_colours;
    std::vector<std::int32_t> vertex_labels;
    std::vector<std::int32_t> face_labels;
    std::vector<std::array<float, 2>> vertex_texture;  ///< texture coordinates per vertex
    std::vector<std::array<float, 2>> corner_texture;  ///< alternatively per polygon corner, in the order of the corners
    /// For a tetrahedral mesh: the vertices of each tetrahedron. The triangles are its surface; interior vertices are isolated
    /// in the triangle mesh.
    std::vector<std::array<Index, 4>> tetrahedra = {};
};

/// The content of a file: syntax checked, indices in range, coordinates finite; no guarantee about the topology. Entries of
/// `extras` are per vertex and per polygon.
struct PolygonSoup {
    std::vector<std::array<double, 3>> points;
    std::vector<Index> polygon_begin{0};  ///< polygon i has corners [polygon_begin[i], polygon_begin[i + 1])
    std::vector<Index> corners;
    MeshExtras extras;
    std::vector<std::string> notes;  ///< messages about content of the file that is not kept
    [[nodiscard]] std::size_t polygon_count() const { return polygon_begin.size() - 1; }
};

/// Reads OBJ, PLY (ascii, both binary orders), OFF, STL (ascii, binary), Medit's .mesh and VTK's .vtu (both as text; tetrahedra
/// are represented by their surface, oriented outwards). The format is chosen by the extension, or by the content if they
/// contradict each other. STL vertices are numbered by first appearance after exact merging. Throws Error (input) with file,
/// line or byte, and remedy. Memory is bounded by a small multiple of the file size, regardless of the counts in the header.
PolygonSoup read_polygons(const Path& file);

/// Triangulated polygons (convex ones as fans, others by ear clipping in their plane; deterministic). `triangle_polygon` maps
/// each triangle to its polygon. Polygons with fewer than three distinct corners yield no triangles.
struct TriangulatedSoup {
    TriangleSoup soup;
    std::vector<Index> triangle_polygon;  ///< empty if all polygons are single triangles
    MeshExtras extras;                    ///< face data per triangle, corner texture coordinates per triangle corner
    std::vector<std::string> notes;
};
TriangulatedSoup triangulate(PolygonSoup&& polygons);

/// A file read as an oriented manifold triangle mesh (open or closed). Vertex i is vertex i of the file.
struct MeshFile {
    Mesh mesh;
    MeshExtras extras;                    ///< per vertex and per triangle
    std::vector<Index> triangle_polygon;  ///< empty if all polygons are single triangles
    std::vector<std::string> notes;
};

/// read_polygons + triangulate + build_mesh. Throws Error (input), with the remedy "run: ostraka mesh repair", if the file is
/// not an oriented manifold or has no faces.
MeshFile read_mesh(const Path& file);

enum class Encoding { binary, ascii };

/// One number per triangle, stored in PLY files as a property of this name.
struct FaceValues {
    std::string name;
    std::vector<float> values;
};

struct WriteOptions {
    Encoding encoding = Encoding::binary;   ///< encoding of PLY and STL
    std::string comment;                    ///< one line (provenance), written if the format supports comments
    std::vector<double> vertex_quality{};   ///< empty or one number per vertex: PLY property "quality", used for colouring
    std::vector<FaceValues> face_values{};  ///< additional PLY properties of faces
    /// Polygons to write instead of the triangles to OBJ, OFF and PLY: the corners of each polygon, and the triangle that
    /// provides its colour, label and values. Other formats receive the triangles.
    std::vector<std::vector<Index>> polygons{};
    std::vector<Index> polygon_triangle{};
};

/// Writes OBJ, PLY, OFF, STL, GLB, .mesh or .vtu (the last two with tetrahedra), chosen by extension, atomically. Coordinates
/// are written as shortest round-trip text or float64 (float32 in STL and GLB). Returns notes on data that the format cannot
/// store. Throws Error (usage) for an unknown extension (before writing), Error (failure) if the file cannot be written.
std::vector<std::string> write_mesh(const Path& file, const Mesh& mesh, const MeshExtras& extras = {},
                                    const WriteOptions& options = {});

/// As write_mesh, for triangles of any topology.
std::vector<std::string> write_triangles(const Path& file, const TriangleSoup& soup, const MeshExtras& extras = {},
                                         const WriteOptions& options = {});

/// Throws Error (usage) unless `write_mesh` supports the extension.
void check_mesh_extension(const Path& file);

}  // namespace ostraka
