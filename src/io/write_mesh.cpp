#include "io/formats.h"
#include "ostraka/core/error.h"
#include "ostraka/io/carry_extras.h"

#include <fmt/core.h>

#include <cmath>
#include <stdexcept>

namespace ostraka {

namespace {

void check_extras(const MeshExtras& extras, std::size_t vertices, std::size_t triangles) {
    const auto check = [](std::size_t size, std::size_t expected, const char* attribute) {
        if (size != 0 && size != expected)
            throw std::logic_error(fmt::format("write_mesh: {} has {} entries instead of {}", attribute, size, expected));
    };
    for (const NamedValues& column : extras.vertex_values) check(column.values.size(), vertices, column.name.c_str());
    for (const NamedValues& column : extras.face_values) check(column.values.size(), triangles, column.name.c_str());
    check(extras.vertex_colours.size(), vertices, "vertex_colours");
    check(extras.vertex_labels.size(), vertices, "vertex_labels");
    check(extras.face_colours.size(), triangles, "face_colours");
    check(extras.face_labels.size(), triangles, "face_labels");
    check(extras.corner_texture.size(), 3 * triangles, "corner_texture");
    check(extras.face_materials.size(), triangles, "face_materials");
    for (const Index material : extras.face_materials)
        if (material != no_index && material >= extras.appearance.materials.size())
            throw std::logic_error("write_mesh: a face refers to a material that does not exist");
    for (const Material& material : extras.appearance.materials)
        if (material.image != no_index && material.image >= extras.appearance.images.size())
            throw std::logic_error("write_mesh: a material refers to an image that does not exist");
    for (const auto& tetrahedron : extras.tetrahedra)
        for (const Index v : tetrahedron)
            if (v >= vertices) throw std::logic_error("write_mesh: a tetrahedron refers to a vertex that does not exist");
}

std::vector<std::string> write_polygons(const Path& file, const TriangleSoup& soup, const MeshExtras& extras,
                                        const WriteOptions& options) {
    const std::string ending = extension(file);
    if (options.polygons.size() != options.triangle_of_polygon.size())
        throw std::logic_error("write_mesh: polygons without triangles");
    for (const auto& polygon : options.polygons)
        for (const Index v : polygon)
            if (v >= soup.points.size()) throw std::logic_error("write_mesh: a polygon refers to a vertex that does not exist");
    WriteOptions triangle_options = options;
    std::vector<std::string> notes;
    if (ending != ".obj" && ending != ".off" && ending != ".ply") {
        triangle_options.polygons.clear();
        triangle_options.triangle_of_polygon.clear();
        notes = write_triangles(file, soup, extras, triangle_options);
        notes.emplace_back("only OBJ, OFF and PLY can store polygons: they are triangulated");
        return notes;
    }
    // Texture coordinates are those of corners of triangles.
    MeshExtras attributes = carried(extras, {nullptr, &options.triangle_of_polygon, nullptr});
    attributes.corner_texture.clear();
    notes = ending == ".obj"   ? io::write_obj(file, soup, attributes, triangle_options)
            : ending == ".off" ? io::write_off(file, soup, attributes, triangle_options)
                               : io::write_ply(file, soup, attributes, triangle_options);
    if (!extras.corner_texture.empty()) notes.emplace_back("corner texture coordinates are dropped when polygons are written");
    if (!extras.tetrahedra.empty()) notes.emplace_back("tetrahedra are dropped: .mesh and .vtu can store them");
    return notes;
}

void check_soup(const Path& file, const TriangleSoup& soup) {
    for (std::size_t v = 0; v < soup.points.size(); ++v)
        for (const double x : soup.points[v])
            if (!std::isfinite(x)) fail_work(file.string(), fmt::format("vertex {} has a coordinate that is not finite", v));
    for (std::size_t t = 0; t < soup.triangles.size(); ++t)
        for (const Index v : soup.triangles[t])
            if (v >= soup.points.size())
                fail_work(file.string(), fmt::format("triangle {} names vertex {} of {}", t, v, soup.points.size()));
}

}  // namespace

void check_mesh_extension(const Path& file) {
    const std::string ending = extension(file);
    for (const char* supported : {".obj", ".ply", ".off", ".stl", ".glb", ".mesh", ".vtu"})
        if (ending == supported) return;
    throw Error(ErrorKind::usage, file.string(), "does not have the extension of a writable mesh format",
                "use .ply, .obj, .off, .stl or .glb, or .mesh or .vtu for tetrahedra");
}

std::vector<std::string> write_triangles(const Path& file, const TriangleSoup& soup, const MeshExtras& extras,
                                         const WriteOptions& options) {
    check_mesh_extension(file);
    check_extras(extras, soup.points.size(), soup.triangles.size());
    check_soup(file, soup);
    const std::string ending = extension(file);
    if (ending != ".ply" && !(extras.vertex_values.empty() && extras.face_values.empty())) {
        MeshExtras other_extras = extras;
        other_extras.vertex_values.clear();
        other_extras.face_values.clear();
        std::vector<std::string> notes = write_triangles(file, soup, other_extras, options);
        notes.emplace_back("only PLY can store values per vertex and per face: they are dropped");
        return notes;
    }
    if (!options.polygons.empty()) return write_polygons(file, soup, extras, options);
    if (ending == ".mesh") return io::write_medit(file, soup, extras, options);
    if (ending == ".vtu") return io::write_vtu(file, soup, extras, options);
    if (!extras.tetrahedra.empty()) {
        MeshExtras surface = extras;
        surface.tetrahedra.clear();
        std::vector<std::string> notes = write_triangles(file, soup, surface, options);
        notes.push_back(std::to_string(extras.tetrahedra.size()) + " tetrahedra are dropped: .mesh and .vtu can store them");
        return notes;
    }
    if (ending == ".obj") return io::write_obj(file, soup, extras, options);
    if (ending == ".off") return io::write_off(file, soup, extras, options);
    if (ending == ".stl") return io::write_stl(file, soup, extras, options);
    if (ending == ".glb") return io::write_glb(file, soup, extras, options);
    return io::write_ply(file, soup, extras, options);
}

std::vector<std::string> write_mesh(const Path& file, const Mesh& mesh, const MeshExtras& extras, const WriteOptions& options) {
    check_mesh_extension(file);
    return write_triangles(file, to_soup(mesh), extras, options);
}

}  // namespace ostraka
