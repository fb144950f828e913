// The readers and writers behind read_polygons and write_mesh, one pair per format.
#pragma once

#include "ostraka/io/mesh_file.h"
#include "ostraka/io/textured_vertices.h"

#include <optional>
#include <span>

namespace ostraka::io {

// Readers of mesh files: `bytes` is the content of the whole file and may be modified; `file` is the file name for messages.
PolygonSoup read_obj(std::string& bytes, const std::string& file);
PolygonSoup read_off(std::string& bytes, const std::string& file);
PolygonSoup read_ply(const std::string& bytes, const std::string& file);
PolygonSoup read_stl(std::string& bytes, const std::string& file);
PolygonSoup read_medit(std::string& bytes, const std::string& file);
PolygonSoup read_vtu(const std::string& bytes, const std::string& file);
PolygonSoup read_gltf(const std::string& bytes, const std::string& file);  ///< .glb and .gltf
PolygonSoup read_3mf(const std::string& bytes, const std::string& file);

/// True if the content is a PLY file, whatever the name of the file.
bool looks_like_ply(std::string_view bytes);
bool looks_like_off(std::string_view bytes);  ///< true if the content is an OFF file
bool looks_like_stl(std::string_view bytes);  ///< true if the content is an STL file
bool looks_like_glb(std::string_view bytes);  ///< true if the content is a binary glTF file (of any version)

/// The file that a mesh file names, such as an image or MTL file: the reference relative to the folder of `file`, or else the
/// file with the bare name in this folder, in each case also with the letters in another case. Backslashes count as slashes,
/// doubled ones as one; percent escapes are resolved if the plain name does not exist. Only files in the folder of `file` and
/// below are found. Empty: there is none.
std::optional<Path> file_beside(const Path& file, const std::string& reference);

/// Appends the image in `path` to the images of the soup and returns its index. A file that is already among them is not read
/// again; a missing or unreadable image gives a note and a null image.
Index add_image(PolygonSoup& soup, const Path& file, const std::string& reference);

/// Joins vertices that the file doubled for its texture coordinates: where exactly two border edges have the same end points, in
/// opposite directions, their vertices are joined to the first of them. Fills vertex_of_file_vertex if vertices were joined.
void join_seams(PolygonSoup& soup);

/// Completes a polygon whose corners were appended to `soup.corners`; throws Error if the number of corners no longer fits an
/// Index.
void close_polygon(PolygonSoup& soup, const std::string& file);

/// Colour channel from a value between 0 and 1. NaN and values out of range are clamped and counted in `out_of_range`.
std::uint8_t channel_from_unit(double value, std::size_t& out_of_range);
/// Colour channel from a value between 0 and 255. NaN and values out of range are clamped and counted in `out_of_range`.
std::uint8_t channel_from_byte(double value, std::size_t& out_of_range);

inline constexpr Colour white{255, 255, 255, 255};  ///< colour of elements without a colour

/// The faces to write: options.polygons, or the triangles if there are no polygons.
class WrittenFaces {
public:
    WrittenFaces(const TriangleSoup& soup, const WriteOptions& options) : soup_(soup), options_(options) {}
    /// Number of faces.
    [[nodiscard]] std::size_t size() const { return polygons() ? options_.polygons.size() : soup_.triangles.size(); }
    /// Indices of the vertices of a face.
    [[nodiscard]] std::span<const Index> corners(std::size_t face) const {
        if (polygons()) return options_.polygons[face];
        return soup_.triangles[face];
    }

private:
    [[nodiscard]] bool polygons() const { return !options_.polygons.empty(); }
    const TriangleSoup& soup_;
    const WriteOptions& options_;
};

// Writers of mesh files: `extras` must be empty or complete. Each writer returns notes about data that the format cannot store.
using Notes = std::vector<std::string>;
Notes write_obj(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options);
Notes write_off(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options);
Notes write_ply(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options);
Notes write_stl(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options);
Notes write_medit(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options);
Notes write_vtu(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options);
Notes write_glb(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options);

}  // namespace ostraka::io
