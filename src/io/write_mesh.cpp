#include "formats.h"
#include "ostraka/core/error.h"

#include <cmath>
#include <stdexcept>

namespace ostraka {

namespace {

void check_extras(const MeshExtras& extras, const WriteOptions& options, std::size_t vertices, std::size_t triangles) {
    const auto check = [](std::size_t size, std::size_t wanted, const char* what) {
        if (size != 0 && size != wanted)
            throw std::logic_error(std::string("write_mesh: ") + what + " has " + std::to_string(size) + " entries instead of " +
                                   std::to_string(wanted));
    };
    check(options.vertex_quality.size(), vertices, "vertex_quality");
    for (const FaceValues& one : options.face_values) check(one.values.size(), triangles, one.name.c_str());
    check(extras.vertex_colours.size(), vertices, "vertex_colours");
    check(extras.vertex_labels.size(), vertices, "vertex_labels");
    check(extras.vertex_texture.size(), vertices, "vertex_texture");
    check(extras.face_colours.size(), triangles, "face_colours");
    check(extras.face_labels.size(), triangles, "face_labels");
    check(extras.corner_texture.size(), 3 * triangles, "corner_texture");
    for (const auto& tetrahedron : extras.tetrahedra)
        for (const Index v : tetrahedron)
            if (v >= vertices) throw std::logic_error("write_mesh: a tetrahedron of a vertex that is not there");
}

/// Face attributes of the polygons, taken from their triangles.
MeshExtras of_polygons(const MeshExtras& extras, const std::vector<Index>& triangle) {
    MeshExtras result = extras;
    const auto pick = [&](const auto& from, auto& to) {
        if (from.empty()) return;
        to.clear();
        for (const Index t : triangle) to.push_back(from[t]);
    };
    pick(extras.face_colours, result.face_colours);
    pick(extras.face_labels, result.face_labels);
    result.corner_texture.clear();
    return result;
}

std::vector<std::string> write_polygons(const Path& file, const TriangleSoup& soup, const MeshExtras& extras,
                                        const WriteOptions& options) {
    const std::string ending = extension(file);
    if (options.polygons.size() != options.polygon_triangle.size())
        throw std::logic_error("write_mesh: polygons without triangles");
    for (const auto& polygon : options.polygons)
        for (const Index v : polygon)
            if (v >= soup.points.size()) throw std::logic_error("write_mesh: a polygon of a vertex that is not there");
    WriteOptions rest = options;
    std::vector<std::string> notes;
    if (ending != ".obj" && ending != ".off" && ending != ".ply") {
        rest.polygons.clear();
        rest.polygon_triangle.clear();
        notes = write_triangles(file, soup, extras, rest);
        notes.emplace_back("only OBJ, OFF and PLY hold polygons: they are cut into triangles");
        return notes;
    }
    for (FaceValues& one : rest.face_values) {
        std::vector<float> values;
        for (const Index t : options.polygon_triangle) values.push_back(one.values[t]);
        one.values = std::move(values);
    }
    const MeshExtras own = of_polygons(extras, options.polygon_triangle);
    notes = ending == ".obj"   ? io::write_obj(file, soup, own, rest)
            : ending == ".off" ? io::write_off(file, soup, own, rest)
                               : io::write_ply(file, soup, own, rest);
    if (!extras.corner_texture.empty())
        notes.emplace_back("texture coordinates of corners are left out where polygons are written");
    if (!extras.tetrahedra.empty()) notes.emplace_back("tetrahedra are left out: .mesh and .vtu hold them");
    return notes;
}

void check_soup(const Path& file, const TriangleSoup& soup) {
    for (std::size_t v = 0; v < soup.points.size(); ++v)
        for (const double x : soup.points[v])
            if (!std::isfinite(x))
                fail_work(file.string(), "vertex " + std::to_string(v) + " has a coordinate that is not finite");
    for (std::size_t t = 0; t < soup.triangles.size(); ++t)
        for (const Index v : soup.triangles[t])
            if (v >= soup.points.size())
                fail_work(file.string(), "triangle " + std::to_string(t) + " names vertex " + std::to_string(v) + " of " +
                                             std::to_string(soup.points.size()));
}

}  // namespace

void check_mesh_extension(const Path& file) {
    const std::string ending = extension(file);
    for (const char* known : {".obj", ".ply", ".off", ".stl", ".glb", ".mesh", ".vtu"})
        if (ending == known) return;
    throw Error(ErrorKind::usage, file.string(), "has no extension of a mesh file that can be written",
                "use .ply, .obj, .off, .stl or .glb, of tetrahedra .mesh or .vtu");
}

std::vector<std::string> write_triangles(const Path& file, const TriangleSoup& soup, const MeshExtras& extras,
                                         const WriteOptions& options) {
    check_mesh_extension(file);
    check_extras(extras, options, soup.points.size(), soup.triangles.size());
    check_soup(file, soup);
    const std::string ending = extension(file);
    if (ending != ".ply" && (!options.vertex_quality.empty() || !options.face_values.empty())) {
        WriteOptions rest = options;
        rest.vertex_quality.clear();
        rest.face_values.clear();
        std::vector<std::string> notes = write_triangles(file, soup, extras, rest);
        notes.emplace_back("only PLY holds numbers of vertices and faces: they are left out");
        return notes;
    }
    if (!options.polygons.empty()) return write_polygons(file, soup, extras, options);
    if (ending == ".mesh") return io::write_medit(file, soup, extras, options);
    if (ending == ".vtu") return io::write_vtu(file, soup, extras, options);
    if (!extras.tetrahedra.empty()) {
        MeshExtras surface = extras;
        surface.tetrahedra.clear();
        std::vector<std::string> notes = write_triangles(file, soup, surface, options);
        notes.push_back(std::to_string(extras.tetrahedra.size()) + " tetrahedra are left out: .mesh and .vtu hold them");
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
