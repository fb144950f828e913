// Reading and writing of mesh files. Reading is strict, writing is atomic, and both keep the order of vertices.
#pragma once

#include "ostraka/files/file.h"
#include "ostraka/image/appearance.h"
#include "ostraka/mesh/mesh.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace ostraka {

using Colour = std::array<std::uint8_t, 4>;  ///< red, green, blue, alpha

/// A number for each vertex or each face, such as a scanner's quality or a curvature.
struct NamedValues {
    std::string name;            ///< name of the PLY property
    std::vector<double> values;  ///< one number per element
};

/// Attributes of the elements of a mesh. Each list is empty or has one entry per element.
struct MeshExtras {
    std::vector<Colour> vertex_colours;       ///< one colour per vertex
    std::vector<Colour> face_colours;         ///< one colour per face
    std::vector<std::int32_t> vertex_labels;  ///< one label per vertex
    std::vector<std::int32_t> face_labels;    ///< one label per face
    /// Texture coordinates per polygon corner, in the order of the corners. A vertex on a seam of the texture has different
    /// coordinates in its corners.
    std::vector<TexturePoint> corner_texture;
    std::vector<Index> face_materials;                    ///< index of each face's material in `appearance`, or no_index
    Appearance appearance;                                ///< materials and images
    std::vector<NamedValues> vertex_values, face_values;  ///< further values per vertex and per face
    /// For a tetrahedral mesh: the vertices of each tetrahedron. The triangles of the mesh are the surface of the tetrahedra;
    /// interior vertices are isolated in the triangle mesh.
    std::vector<std::array<Index, 4>> tetrahedra = {};
};

/// The polygons read from a mesh file. Syntax has been checked, indices are in range and coordinates are finite; the topology has
/// not been checked.
struct PolygonSoup {
    std::vector<std::array<double, 3>> points;  ///< coordinates of the vertices
    std::vector<Index> polygon_begin{0};        ///< polygon i has corners [polygon_begin[i], polygon_begin[i + 1])
    std::vector<Index> corners;                 ///< indices of the vertices of all polygons, polygon by polygon
    MeshExtras extras;                          ///< attributes per vertex and per polygon
    std::vector<std::string> notes;             ///< messages about content of the file that was not kept
    /// For each vertex in the file: index of its vertex in `points`. Files may contain several copies of a vertex with
    /// different texture coordinates or normals; these copies are merged. no_index: the vertex has no coordinates, is used by
    /// no face and was dropped. Empty: vertex i of the file is vertex i of `points`.
    std::vector<Index> vertex_of_file_vertex = {};
    [[nodiscard]] std::size_t polygon_count() const { return polygon_begin.size() - 1; }
};

/// Reads the polygons of a mesh file: OBJ with its MTL files and images, PLY (ascii, both binary orders), GLB and glTF 2.0, OFF,
/// STL (ascii, binary), 3MF, Medit's .mesh and VTK's .vtu (both as text; tetrahedra are represented by their surface, oriented
/// outwards). The format is chosen by the file name extension, or by the content if extension and content contradict each other.
/// STL vertices with equal coordinates are merged, and numbered by first appearance; In files with texture coordinates (PLY,
/// OBJ, GLB, glTF), border vertices with equal coordinates are merged in the same way if the borders of two faces coincide
/// there, because such files duplicate vertices along the seams of the texture. Throws Error (input) with file, line or byte,
/// and remedy. Memory is bounded by a small multiple of the file size, regardless of the counts in the header.
PolygonSoup read_polygons(const Path& file);

/// Polygons divided into triangles.
struct TriangulatedSoup {
    TriangleSoup soup;
    /// For each triangle: index of its polygon; empty if every polygon is a triangle.
    std::vector<Index> polygon_of_triangle;
    MeshExtras extras;               ///< attributes per vertex and per triangle; corner_texture per triangle corner
    std::vector<std::string> notes;  ///< messages about polygons that were not kept
};
/// Divides polygons into triangles: convex polygons as fans, others by ear clipping in their plane; deterministic. Polygons with
/// fewer than three distinct corners give no triangles.
TriangulatedSoup triangulate(PolygonSoup&& polygons);

/// A mesh file read as an oriented manifold (open or closed). Vertex i of the mesh is vertex i of the file; copies may follow.
struct MeshFile {
    Mesh mesh;          ///< the triangle mesh
    MeshExtras extras;  ///< attributes per vertex and per triangle
    /// For each triangle: index of its polygon; empty if every polygon is a triangle.
    std::vector<Index> polygon_of_triangle;
    std::vector<std::string> notes;  ///< messages about content of the file that was not kept
};

/// Reads a mesh file as an oriented manifold. Where the surface is none, triangles are turned over and the surface is cut, with
/// a note; vertices and triangles keep their indices (doc/mesh-files.md). Throws Error (input) without faces or extent.
MeshFile read_mesh(const Path& file);

/// Encoding of PLY and STL files.
enum class Encoding { binary, ascii };

/// Options of `write_mesh`.
struct WriteOptions {
    Encoding encoding = Encoding::binary;  ///< encoding of PLY and STL
    std::string comment;                   ///< comment of one line (the provenance), written if the format supports comments
    /// Polygons to write instead of the triangles to OBJ, OFF and PLY files: the vertices of each polygon. Other formats get the
    /// triangles.
    std::vector<std::vector<Index>> polygons{};
    /// For each polygon: index of the triangle that provides its colour, label and values.
    std::vector<Index> triangle_of_polygon{};
};

/// Writes a mesh file atomically: OBJ, PLY, OFF, STL, GLB, .mesh or .vtu (the last two with tetrahedra), chosen by the file name
/// extension. Coordinates are written as shortest round-trip text or float64 (float32 in STL and GLB). Returns notes on data that
/// the format cannot store. Throws Error (usage) for an unknown extension (before writing), Error (failure) if the file cannot be
/// written.
std::vector<std::string> write_mesh(const Path& file, const Mesh& mesh, const MeshExtras& extras = {},
                                    const WriteOptions& options = {});

/// Writes triangles of any topology to a mesh file, otherwise like write_mesh.
std::vector<std::string> write_triangles(const Path& file, const TriangleSoup& soup, const MeshExtras& extras = {},
                                         const WriteOptions& options = {});

/// Throws Error (usage) unless `write_mesh` supports the file name extension.
void check_mesh_extension(const Path& file);

}  // namespace ostraka
