#include "io/formats.h"
#include "io/repair_steps.h"
#include "ostraka/core/error.h"
#include "ostraka/io/carry_extras.h"
#include "ostraka/io/mesh_of_polygons.h"
#include "ostraka/mesh/limits.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace ostraka {

namespace io {

void close_polygon(PolygonSoup& soup, const std::string& file) {
    if (soup.corners.size() >= no_index || soup.polygon_begin.size() >= no_index)
        fail_work(file, "has more than four thousand million face corners", "split it");
    soup.polygon_begin.push_back(static_cast<Index>(soup.corners.size()));
}

std::uint8_t channel_from_byte(double value, std::size_t& out_of_range) {
    if (!(value >= 0 && value <= 255)) {
        ++out_of_range;
        return value > 255 ? 255 : 0;
    }
    return static_cast<std::uint8_t>(std::lround(value));
}

std::uint8_t channel_from_unit(double value, std::size_t& out_of_range) {
    if (!(value >= 0 && value <= 1)) {
        ++out_of_range;
        return value > 1 ? 255 : 0;
    }
    return static_cast<std::uint8_t>(std::lround(255 * value));
}

namespace {

enum class Format { obj, off, ply, stl, gltf, three_mf, medit, vtu };

std::string name_of(Format format) {
    constexpr const char* names[] = {"OBJ", "OFF", "PLY", "STL", "glTF", "3MF", "Medit's mesh", "VTU"};
    return names[static_cast<int>(format)];
}

/// A format that is not read, and a program of the field that converts it.
struct OtherFormat {
    const char *ending, *name, *converter;
};
constexpr const char* by_assimp = "convert it, for example: assimp export {} NAME.glb";
constexpr const char* by_meshlab = "convert it to PLY or OBJ, for example with MeshLab (File, Export Mesh As)";
constexpr const char* by_freecad = "convert it to STL, for example with FreeCAD (File, Export)";
constexpr const char* by_blender = "convert it to GLB, for example with Blender (File, Export, glTF 2.0)";
constexpr std::array other_formats{
    OtherFormat{".dae", "COLLADA", by_assimp},
    OtherFormat{".x3d", "X3D", by_assimp},
    OtherFormat{".x3db", "binary X3D", by_assimp},
    OtherFormat{".fbx", "FBX", by_assimp},
    OtherFormat{".3ds", "3D Studio", by_assimp},
    OtherFormat{".lwo", "LightWave", by_assimp},
    OtherFormat{".ac", "AC3D", by_assimp},
    OtherFormat{".wrl", "VRML", by_meshlab},
    OtherFormat{".vrml", "VRML", by_meshlab},
    OtherFormat{".blend", "a scene of Blender", by_blender},
    OtherFormat{".usd", "USD", by_blender},
    OtherFormat{".usda", "USD", by_blender},
    OtherFormat{".usdc", "USD", by_blender},
    OtherFormat{".usdz", "USD", by_blender},
    OtherFormat{".abc", "Alembic", by_blender},
    OtherFormat{".step", "STEP", by_freecad},
    OtherFormat{".stp", "STEP", by_freecad},
    OtherFormat{".iges", "IGES", by_freecad},
    OtherFormat{".igs", "IGES", by_freecad},
    OtherFormat{".vtk", "legacy VTK", "convert it to PLY, for example with ParaView (File, Save Data)"},
    OtherFormat{".vtp", "VTK PolyData", "convert it to PLY, for example with ParaView (File, Save Data)"},
    OtherFormat{".drc", "Draco without glTF", "convert it, for example: draco_decoder -i {} -o NAME.ply"},
    OtherFormat{".zip", "an archive", "unpack it, for example: unzip {}"},
};

Format format_of_extension(const Path& file) {
    const std::string ending = extension(file);
    if (ending == ".obj") return Format::obj;
    if (ending == ".off") return Format::off;
    if (ending == ".ply") return Format::ply;
    if (ending == ".stl") return Format::stl;
    if (ending == ".glb" || ending == ".gltf") return Format::gltf;
    if (ending == ".3mf") return Format::three_mf;
    if (ending == ".mesh") return Format::medit;
    if (ending == ".vtu") return Format::vtu;
    for (const OtherFormat& other : other_formats)
        if (ending == other.ending)
            throw Error(ErrorKind::usage, file.string(), fmt::format("is {}, which is not read", other.name),
                        fmt::format(fmt::runtime(other.converter), file.string()));
    throw Error(ErrorKind::usage, file.string(), "does not have the extension of a readable mesh format",
                "use .obj, .ply, .glb, .gltf, .stl, .off or .3mf, or .mesh or .vtu for tetrahedra");
}

/// The format of the extension, unless the content clearly has another format.
Format format_of_content(Format expected, std::string_view bytes) {
    if (looks_like_ply(bytes)) return Format::ply;
    if (looks_like_glb(bytes)) return Format::gltf;
    if (looks_like_off(bytes)) return Format::off;
    if (looks_like_stl(bytes)) return Format::stl;
    return expected;
}

/// The encoding of a 16-bit text: UTF-16 if it begins with a byte order mark, UTF-16LE or UTF-16BE if letters alternate with
/// zeros; else empty.
std::string wide_encoding(std::string_view bytes) {
    bytes = bytes.substr(0, 64);
    const std::size_t mark = bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF") ? 2 : 0;
    for (const std::size_t zero : {1, 0}) {
        bool is_text = bytes.size() >= mark + 8;
        for (std::size_t i = mark; i < bytes.size(); ++i) {
            const auto c = static_cast<unsigned char>(bytes[i]);
            const bool letter = (c >= ' ' && c < 127) || c == '\t' || c == '\n' || c == '\r';
            is_text = is_text && (i % 2 == zero ? c == 0 : letter);
        }
        if (is_text) return mark > 0 ? "UTF-16" : zero == 1 ? "UTF-16LE" : "UTF-16BE";
    }
    return {};
}

std::string defects_in_words(const ManifoldDefects& defects) {
    std::string text;
    const auto add = [&text](std::size_t count, const char* description) {
        if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, description);
    };
    add(defects.repeated_corners, "triangles that repeat a vertex");
    add(defects.nonmanifold_edges, "edges with more than two triangles");
    add(defects.misoriented_edges, "edges whose triangles are oriented differently");
    add(defects.nonmanifold_vertices, "vertices where several sheets touch");
    return fmt::format("{}; the first at triangle {}", text, defects.example_triangle);
}

constexpr const char* no_manifold = "is not an oriented manifold";

/// Makes the triangles an oriented manifold without removing or adding any: turns triangles over, and cuts the surface along
/// edges and at vertices where it is none. Vertices and triangles keep their indices.
void make_manifold(TriangulatedSoup& triangles, const ManifoldDefects& defects) {
    const std::size_t vertex_count = triangles.soup.points.size();
    detail::RepairSoup work(triangles.soup);
    detail::orient_patches(work);
    const std::size_t copies = detail::cut_apart(work);
    std::vector<Index> corners;
    if (!triangles.extras.corner_texture.empty())
        for (const auto& corner : work.corner_like) corners.insert(corners.end(), corner.begin(), corner.end());
    MeshExtras extras = carried(triangles.extras, {&work.vertex_like, nullptr, &corners});
    extras.tetrahedra = std::move(triangles.extras.tetrahedra);
    triangles.extras = std::move(extras);
    triangles.soup = std::move(work.soup);
    const auto flipped = std::count(work.flipped.begin(), work.flipped.end(), std::uint8_t{1});
    std::string changes = flipped > 0 ? fmt::format("{} triangles were turned over", flipped) : std::string();
    if (triangles.soup.points.size() > vertex_count)
        changes += fmt::format("{}the surface was cut there, with {} copies of vertices after those of the file",
                               changes.empty() ? "" : " and ", copies);
    triangles.notes.push_back(
        fmt::format("{}: {}; for this operation {} (ostraka mesh repair and ostraka import make a sound mesh)", no_manifold,
                    defects_in_words(defects), changes.empty() ? "nothing was changed" : changes));
}

}  // namespace

}  // namespace io

PolygonSoup read_polygons(const Path& file) {
    using namespace io;
    const Format format_of_name = format_of_extension(file);
    std::string bytes = read_file(file);
    const std::string name = file.string();
    if (bytes.empty()) fail_input(name, "is empty", "export it again");
    if (const std::string encoding = wide_encoding(bytes); !encoding.empty())
        fail_input(name, "is text in UTF-16: convert to UTF-8",
                   fmt::format("run: iconv -f {} -t UTF-8 {} > {}", encoding, name,
                               (file.parent_path() / ("utf8-" + file.filename().string())).string()));
    const Format format = format_of_content(format_of_name, bytes);
    PolygonSoup soup = format == Format::obj        ? read_obj(bytes, name)
                       : format == Format::off      ? read_off(bytes, name)
                       : format == Format::ply      ? read_ply(bytes, name)
                       : format == Format::gltf     ? read_gltf(bytes, name)
                       : format == Format::three_mf ? read_3mf(bytes, name)
                       : format == Format::medit    ? read_medit(bytes, name)
                       : format == Format::vtu      ? read_vtu(bytes, name)
                                                    : read_stl(bytes, name);
    if (format == Format::gltf || !soup.extras.corner_texture.empty()) join_seams(soup);
    if (soup.points.size() >= no_index) fail_work(name, "has more than four thousand million vertices", "split it");
    if (format != format_of_name)
        soup.notes.push_back(
            fmt::format("has the extension {} but contains {}, and was read as such", extension(file), name_of(format)));
    return soup;
}

MeshFile read_mesh(const Path& file) { return mesh_of_polygons(read_polygons(file), file.string()); }

std::vector<std::string> manifold_notes(const MeshFile& mesh) {
    std::vector<std::string> notes;
    std::copy_if(mesh.notes.begin(), mesh.notes.end(), std::back_inserter(notes),
                 [](const std::string& note) { return note.starts_with(io::no_manifold); });
    return notes;
}

MeshFile mesh_of_polygons(PolygonSoup polygons, const std::string& name) {
    MeshFile result;
    if (polygons.polygon_count() == 0)
        fail_input(name, fmt::format("has no faces ({} vertices)", polygons.points.size()), "use a file with a surface");
    TriangulatedSoup triangles = triangulate(std::move(polygons));
    if (triangles.soup.triangles.empty())
        fail_input(name, "has no face with three distinct corners", "use a file with a surface");
    if (const ManifoldDefects defects = try_build_mesh(triangles.soup, result.mesh); defects.any()) {
        io::make_manifold(triangles, defects);
        if (try_build_mesh(triangles.soup, result.mesh).any()) throw std::logic_error("read_mesh: the surface was not cut apart");
    }
    const CGAL::Bbox_3 box = bounding_box(result.mesh);
    if (!(box.x_span() > 0 || box.y_span() > 0 || box.z_span() > 0))
        fail_input(name, "has no extent: all its faces are at one point", "use a file with a surface");
    double largest = 0;
    for (const auto& point : triangles.soup.points)
        for (const double x : point) largest = std::max(largest, std::abs(x));
    if (largest > max_coordinate || box_diagonal(result.mesh) < 1e-60)
        fail_input(name, "has coordinates outside the supported range (1e-60 to 1e60)", "choose another unit");
    result.extras = std::move(triangles.extras);
    result.polygon_of_triangle = std::move(triangles.polygon_of_triangle);
    result.notes = std::move(triangles.notes);
    return result;
}

}  // namespace ostraka
