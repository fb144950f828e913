#include "ostraka/cage/cage.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/io/wrap.h"
#include "ostraka/mesh/limits.h"

#include "cage/shrink.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka {

namespace {

/// The triangles of the mesh and, with a mirror plane, their images.
TriangleSoup obstacle_of(const Mesh& mesh, const std::optional<MirrorPlane>& mirror) {
    TriangleSoup soup = to_soup(mesh);
    if (!mirror) return soup;
    const auto points = static_cast<Index>(soup.points.size());
    const std::size_t count = soup.triangles.size();
    for (const Vertex v : mesh.vertices()) {
        const Point p = cage::image(mesh.point(v), *mirror);
        soup.points.push_back({p.x(), p.y(), p.z()});
    }
    for (std::size_t t = 0; t < count; ++t) {
        const auto [a, b, c] = soup.triangles[t];
        soup.triangles.push_back({a + points, c + points, b + points});
    }
    return soup;
}

Mesh without_loose_vertices(Mesh mesh) {
    for (const Vertex v : mesh.vertices())
        if (mesh.is_isolated(v)) mesh.remove_vertex(v);
    mesh.collect_garbage();
    return mesh;
}

/// Checks what the wrap requires: at least one triangle with positive area, and coordinates fine enough for the clearance
/// within the offset.
void check_soup(const TriangleSoup& soup, double offset) {
    const auto point = [&](Index v) { return Point(soup.points[v][0], soup.points[v][1], soup.points[v][2]); };
    const bool has_surface = std::any_of(soup.triangles.begin(), soup.triangles.end(),
                                         [&](const auto& t) { return !CGAL::collinear(point(t[0]), point(t[1]), point(t[2])); });
    if (!has_surface)
        fail_input("mesh", "has no face with an area (the corners of each face are collinear)", "give a mesh with a surface");
    double largest = 0;
    for (const auto& p : soup.points)
        for (const double x : p) largest = std::max(largest, std::abs(x));
    // The clearance is a tenth of the offset and must be at least a hundred rounding steps.
    const double rounding = largest * std::numeric_limits<double>::epsilon();
    if (!(offset >= 1000 * rounding))
        fail_input(
            "mesh",
            fmt::format(
                "is too far from the origin for its size: coordinates are rounded to {} there, and the offset of the wrap is {}",
                digits(rounding, 3), digits(offset, 3)),
            "translate the mesh to the origin, or raise the offset");
}

/// The plane with its normal scaled to a length near one. Throws Error (usage) if it is not finite or the normal is zero.
MirrorPlane checked(const MirrorPlane& plane) {
    const auto finite = [](const auto& p) { return std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.z()); };
    if (!finite(plane.point) || !finite(plane.normal))
        throw Error(ErrorKind::usage, "mirror plane", "a coordinate is not finite", "give a point and a direction");
    const Vector normal = scaled_vector(plane.normal);
    if (normal == CGAL::NULL_VECTOR) throw Error(ErrorKind::usage, "mirror plane", "its normal is zero", "give a direction");
    return {plane.point, normal};
}

}  // namespace

CageResult make_cage(const Mesh& object, const CageOptions& options, const CageDensity& density,
                     const std::optional<MirrorPlane>& plane) {
    check_options(options, "cage");
    const auto mirror = plane ? std::optional(checked(*plane)) : std::nullopt;
    const Mesh mesh = without_loose_vertices(object);
    const double diagonal = box_diagonal(mesh);
    if (mesh.number_of_faces() == 0) fail_input("mesh", "has no faces", "give a mesh with faces");
    if (!(diagonal > 0)) fail_input("mesh", "has no extent", "give a mesh whose vertices do not coincide");
    const TriangleSoup soup = obstacle_of(mesh, mirror);
    check_soup(soup, options.offset * diagonal);
    const cage::Obstacle obstacle(soup);

    CageResult best;
    double alpha = options.alpha > 0 ? options.alpha : 1.0 / 40;
    bool finer = options.alpha == 0;  // until the wrap has enough vertices
    while (alpha <= 4) {
        Mesh surface = build_mesh(wrap_soup(soup, alpha * diagonal, options.offset * diagonal));
        finer = finer && surface.number_of_vertices() < options.vertices && alpha > 1e-3;
        if (finer) {
            alpha /= 2;
            continue;
        }
        const double used_alpha = alpha;
        alpha *= 2;
        if (options.genus == CageOptions::Genus::fill && check_cage(surface, Mesh()).genus > 0) continue;
        const std::size_t size = surface.number_of_vertices();
        if (mirror) surface = cage::upper_half(surface, *mirror);
        if (surface.number_of_faces() == 0) continue;
        const std::size_t reached =
            cage::shrink(surface, obstacle, options.vertices, 0.1 * options.offset * diagonal, density, mirror);
        if (mirror) surface = cage::mirrored_whole(surface, *mirror);
        // Every collapse was checked; what can remain are rounding errors on the mirror plane.
        if (surface.number_of_faces() == 0 || !check_cage(surface, mesh).valid()) continue;
        if (best.cage.number_of_faces() == 0 || reached < best.cage.number_of_vertices()) {
            best.cage = std::move(surface);
            best.alpha = used_alpha;
            best.wrap_vertices = size;
            best.reached = reached <= options.vertices;
        }
        if (best.reached || options.alpha > 0) break;
    }
    if (best.cage.number_of_faces() == 0)
        throw Error(ErrorKind::failure, "cage", "no wrap of the mesh results in a valid cage",
                    options.alpha > 0 ? "omit --alpha, or raise it" : "raise --offset");
    return best;
}

std::vector<CageResult> make_nested_cages(const Mesh& mesh, std::vector<std::uint64_t> levels, const CageOptions& options,
                                          const CageDensity& density, const std::optional<MirrorPlane>& mirror) {
    if (levels.empty()) throw Error(ErrorKind::usage, "levels", "no level is given", "give numbers of vertices");
    std::sort(levels.rbegin(), levels.rend());
    std::vector<CageResult> results;
    for (const std::uint64_t level : levels) {
        CageOptions level_options = options;
        level_options.vertices = level;
        results.push_back(make_cage(results.empty() ? mesh : results.back().cage, level_options, density, mirror));
    }
    return results;
}

void CageOptions::declare_options(OptionList& list) {
    list("vertices", vertices, "target number of vertices of the cage", Range{4, 1e6});
    list(
        "alpha", alpha,
        "half the maximum width of openings of the mesh that are closed; 0: a fortieth, or more if the target number of vertices "
        "requires it",
        Range{0, 1}, "share of the diagonal");
    list("offset", offset, "distance between the mesh and the wrap from which the cage is made", Range{1e-4, 0.5},
         "share of the diagonal");
    list("genus", genus,
         "treatment of the handles (holes) of the object: follow (the cage has the handles whose openings are wider than "
         "twice --alpha) or fill (the cage has no handles)",
         Choices{"follow", "fill"});
}

}  // namespace ostraka
