// Mesh files: read without surprises, written atomically, vertex order kept.
#pragma once

#include "ostraka/core/file.h"
#include "ostraka/core/mesh.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace ostraka {

using Colour = std::array<std::uint8_t, 4>;  ///< red, green, blue, alpha

/// What travels with a mesh's elements. Each list is empty or has one entry per element.
struct MeshExtras {
    std::vector<Colour> vertex_colours;
    std::vector<Colour> face_colours;
    std::vector<std::int32_t> vertex_labels;
    std::vector<std::int32_t> face_labels;
    std::vector<std::array<float, 2>> vertex_texture;  ///< texture coordinates per vertex
    std::vector<std::array<float, 2>> corner_texture;  ///< or per polygon corner, in the order of the corners
    /// Of a tetrahedral mesh: the vertices of each tetrahedron. The triangles are then its surface, and vertices within stand
    /// alone.
    std::vector<std::array<Index, 4>> tetrahedra = {};
};

/// A file as it stands: syntax checked, indices in range, coordinates finite; nothing promised of the topology.
/// Elements of `extras` are counted in vertices and polygons.
struct PolygonSoup {
    std::vector<std::array<double, 3>> points;
    std::vector<Index> polygon_begin{0};  ///< polygon i has corners [polygon_begin[i], polygon_begin[i + 1])
    std::vector<Index> corners;
    MeshExtras extras;
    std::vector<std::string> notes;  ///< what the file held that is not kept, in words
    [[nodiscard]] std::size_t polygon_count() const { return polygon_begin.size() - 1; }
};

/// Reads OBJ, PLY (ascii, both binary orders), OFF, STL (ascii, binary), Medit's .mesh and VTK's .vtu (both as text; of
/// tetrahedra the surface, outward) by extension, falling back on content where the
/// extension lies. STL vertices are numbered by first appearance after exact merging. Throws Error (input) naming file,
/// line or byte, and remedy. Memory is bounded by a small multiple of the file's size, whatever its header claims.
PolygonSoup read_polygons(const Path& file);

/// Polygons cut into triangles (convex ones as fans, others by ear clipping in their plane; deterministic);
/// `triangle_polygon` maps each triangle to its polygon. Polygons with fewer than three distinct corners give none.
struct TriangulatedSoup {
    TriangleSoup soup;
    std::vector<Index> triangle_polygon;  ///< empty if every polygon is one triangle
    MeshExtras extras;                    ///< face data per triangle, corner texture per triangle corner
    std::vector<std::string> notes;
};
TriangulatedSoup triangulate(PolygonSoup&& polygons);

/// A file read as an oriented manifold (open or closed) triangle mesh. Vertex i is the file's vertex i.
struct MeshFile {
    Mesh mesh;
    MeshExtras extras;                    ///< per vertex and per triangle
    std::vector<Index> triangle_polygon;  ///< empty if every polygon is one triangle
    std::vector<std::string> notes;
};

/// read_polygons + triangulate + build_mesh. Throws Error (input) with the remedy "run: ostraka mesh repair" if the file
/// is not an oriented manifold, and if it has no faces.
MeshFile read_mesh(const Path& file);

enum class Encoding { binary, ascii };

/// A number for each triangle, under the name that the property has in a PLY file.
struct FaceValues {
    std::string name;
    std::vector<float> values;
};

struct WriteOptions {
    Encoding encoding = Encoding::binary;  ///< for PLY and STL
    std::string comment;                   ///< one line (provenance), where the format has comments
    std::vector<double>
        vertex_quality{};  ///< empty or one number a vertex: the property "quality" of PLY, which viewers colour by
    std::vector<FaceValues> face_values{};  ///< further properties of the faces, of PLY
    /// Polygons to write in place of the triangles into OBJ, OFF and PLY: the corners of each, and the triangle whose colour,
    /// label and values it has. Other formats get the triangles.
    std::vector<std::vector<Index>> polygons{};
    std::vector<Index> polygon_triangle{};
};

/// Writes OBJ, PLY, OFF, STL, GLB, .mesh or .vtu (these with tetrahedra) by extension, atomically. Coordinates as shortest
/// round-trip text or float64 (float32 in STL and GLB). Returns notes on what the format cannot hold. Throws Error (usage) for an
/// unknown extension (before writing), Error (failure) if the file cannot be written.
std::vector<std::string> write_mesh(const Path& file, const Mesh& mesh, const MeshExtras& extras = {},
                                    const WriteOptions& options = {});

/// As write_mesh, for triangles of any topology.
std::vector<std::string> write_triangles(const Path& file, const TriangleSoup& soup, const MeshExtras& extras = {},
                                         const WriteOptions& options = {});

/// Throws Error (usage) unless `write_mesh` knows the extension.
void check_mesh_extension(const Path& file);

}  // namespace ostraka
