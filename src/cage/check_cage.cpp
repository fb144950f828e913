#include "ostraka/cage/cage.h"
#include "ostraka/coords/nested.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/geom/watched_tree.h"
#include "ostraka/io/diagnose.h"
#include "ostraka/mesh/flood.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <fmt/core.h>

#include <cmath>

namespace ostraka {

namespace {

constexpr std::size_t max_listed = 1000;

double largest_coordinate_of(const Mesh& mesh) {
    double largest = 0;
    for (const Point& p : mesh.points()) largest = std::max({largest, std::abs(p.x()), std::abs(p.y()), std::abs(p.z())});
    return largest;
}

/// The mesh with all coordinates multiplied by 2^exponent.
Mesh scaled(const Mesh& mesh, int exponent) {
    Mesh result = mesh;
    for (const Vertex v : result.vertices()) {
        const Point& p = mesh.point(v);
        result.point(v) = Point(std::ldexp(p.x(), exponent), std::ldexp(p.y(), exponent), std::ldexp(p.z(), exponent));
    }
    return result;
}

CageCheck check_in_unit(const Mesh& cage, const Mesh& mesh) {
    CageCheck result;
    if (cage.number_of_faces() == 0) return result;
    result.components = face_pieces(cage).count;
    for (const Face f : cage.faces()) {
        const auto [a, b, c] = corners(cage, f);
        result.degenerate += CGAL::collinear(cage.point(a), cage.point(b), cage.point(c));
    }
    result.intersections = self_intersections(to_soup(cage), max_listed).pairs;
    result.closed = std::none_of(cage.halfedges().begin(), cage.halfedges().end(), [&](Halfedge h) { return cage.is_border(h); });
    if (!result.closed) return result;
    result.flat =
        std::none_of(cage.faces().begin(), cage.faces().end(), [&](Face f) { return area_vector(cage, f).squared_length() > 0; });
    if (result.flat) return result;
    std::size_t vertices = 0;
    for (const Vertex v : cage.vertices()) vertices += !cage.is_isolated(v);
    const auto euler =
        static_cast<long>(vertices) - static_cast<long>(cage.number_of_edges()) + static_cast<long>(cage.number_of_faces());
    result.genus = static_cast<long>(result.components) - euler / 2;
    double volume = 0;
    const Point origin = *cage.points().begin();
    for (const Face face : cage.faces()) volume += (centroid(cage, face) - origin) * area_vector(cage, face);
    result.outward = volume > 0;
    if (mesh.number_of_vertices() == 0) return result;

    using Primitive = CGAL::AABB_face_graph_triangle_primitive<Mesh>;
    using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
    Tree tree(cage.faces().begin(), cage.faces().end(), cage);
    build_watched(tree);
    const CGAL::Side_of_triangle_mesh<Mesh, Kernel> side(tree);
    const SurfaceSearch search(cage);
    const std::size_t count = mesh.number_of_vertices();
    std::vector<SurfaceHit> nearest(count);
    std::vector<CGAL::Bounded_side> sides(count, CGAL::ON_BOUNDED_SIDE);
    static_cast<void>(side(mesh.point(*mesh.vertices().begin())));  // the first query builds the search structure
    parallel_for(count, [&](std::size_t v) {
        sides[v] = side(mesh.point(Vertex(static_cast<Index>(v))));
        nearest[v] = search.closest(mesh.point(Vertex(static_cast<Index>(v))));
    });
    result.clearance = std::numeric_limits<double>::infinity();
    for (Index v = 0; v < count; ++v) {
        result.clearance = std::min(result.clearance, nearest[v].distance);
        if (sides[v] == CGAL::ON_BOUNDED_SIDE) continue;
        const bool on_boundary = sides[v] == CGAL::ON_BOUNDARY;
        result.touching += on_boundary;
        result.outside.push_back({v, on_boundary ? 0 : nearest[v].distance, nearest[v].face});
    }
    std::vector<char> crossed(mesh.number_of_faces(), 0);
    parallel_for(mesh.number_of_faces(), [&](std::size_t f) {
        const auto [a, b, c] = corners(mesh, Face(static_cast<Index>(f)));
        for (const Vertex v : {a, b, c})
            if (sides[v] != CGAL::ON_BOUNDED_SIDE) return;
        const Point &p = mesh.point(a), &q = mesh.point(b), &r = mesh.point(c);
        crossed[f] = CGAL::collinear(p, q, r)
                         ? tree.do_intersect(Kernel::Segment_3(p, q)) || tree.do_intersect(Kernel::Segment_3(q, r))
                         : tree.do_intersect(Kernel::Triangle_3(p, q, r));
    });
    for (Index f = 0; f < crossed.size() && result.crossing.size() < max_listed; ++f)
        if (crossed[f]) result.crossing.push_back(f);
    if (!result.encloses()) result.clearance = 0;
    return result;
}

/// Replaces face indices of a level by those of the whole cage.
void use_indices_of_whole_cage(const SubMesh& level, CageCheck& check) {
    for (auto& [f, g] : check.intersections) f = level.faces[f], g = level.faces[g];
    for (OutsideVertex& vertex : check.outside)
        if (vertex.face != no_index) vertex.face = level.faces[vertex.face];
}

}  // namespace

CageCheck check_cage(const Mesh& cage, const Mesh& mesh) {
    // Scaled by a power of two, which is exact, so that no coordinate exceeds 1: CGAL decides sides by rays of length one,
    // which would otherwise be too short relative to the coordinates of their origins.
    const double largest = std::max(largest_coordinate_of(cage), largest_coordinate_of(mesh));
    int exponent = 0;
    if (largest > 0 && std::isfinite(largest)) (void)std::frexp(largest, &exponent);
    const Mesh scaled_cage = scaled(cage, -exponent);
    const std::vector<CageLevel> levels = cage_levels(scaled_cage);
    const Mesh object = scaled(mesh, -exponent);
    CageCheck result = check_in_unit(levels.size() > 1 ? levels[0].cage.mesh : scaled_cage, object);
    if (levels.size() > 1) {
        use_indices_of_whole_cage(levels[0].cage, result);
        for (std::size_t l = 1; l < levels.size(); ++l) {
            CageCheck inner = check_in_unit(levels[l].cage.mesh, Mesh());
            use_indices_of_whole_cage(levels[l].cage, inner);
            result.outward = result.outward && inner.outward;
            result.degenerate += inner.degenerate;
            result.components += inner.components;
            result.genus += inner.genus;
            result.intersections.insert(result.intersections.end(), inner.intersections.begin(), inner.intersections.end());
        }
        result.nested = levels.size() - 1;
    }
    for (OutsideVertex& o : result.outside) o.distance = std::ldexp(o.distance, exponent);
    result.clearance = std::ldexp(result.clearance, exponent);
    return result;
}

std::vector<Finding> findings(const CageCheck& check, const std::string& unit) {
    std::vector<Finding> result;
    const std::string unit_suffix = unit.empty() ? "" : " " + unit;
    if (check.components == 0) return {{true, "cage", "has no faces: make a cage with 'cage make'"}};
    if (!check.closed)
        result.push_back({true, "cage", "has a border: close it with 'mesh repair', or make a cage with 'cage make'"});
    if (check.flat) return {{true, "cage", "has no face with an area: make a cage with 'cage make'"}};
    if (check.closed && !check.outward) result.push_back({true, "cage", "is inside out: reverse its faces with 'mesh repair'"});
    if (check.degenerate > 0)
        result.push_back(
            {true, "cage", fmt::format("has {} without area: move or merge the vertices", counted(check.degenerate, "face"))});
    for (std::size_t i = 0; i < check.intersections.size() && i < 5; ++i)
        result.push_back({true, fmt::format("face {}", check.intersections[i].first),
                          fmt::format("intersects face {}: move their vertices apart", check.intersections[i].second)});
    if (check.intersections.size() > 5)
        result.push_back({true, "cage", fmt::format("has {} more pairs of intersecting faces", check.intersections.size() - 5)});
    for (std::size_t i = 0; i < check.outside.size() && i < 5; ++i) {
        const OutsideVertex& o = check.outside[i];
        result.push_back({true, fmt::format("vertex {} of the mesh", o.vertex),
                          o.distance > 0
                              ? fmt::format("is {}{} outside near face {}: move that face's vertices outwards by more than that",
                                            digits(o.distance, 4), unit_suffix, o.face)
                              : fmt::format("is on face {}: move that face's vertices outwards", o.face)});
    }
    if (check.outside.size() > 5)
        result.push_back(
            {true, "mesh", fmt::format("has {} more vertices that are not inside the cage", check.outside.size() - 5)});
    for (std::size_t i = 0; i < check.crossing.size() && i < 5; ++i)
        result.push_back({true, fmt::format("face {} of the mesh", check.crossing[i]),
                          "is crossed by the cage although its vertices are inside: move the cage outwards there"});
    if (check.crossing.size() > 5)
        result.push_back(
            {true, "mesh", fmt::format("has {} more faces that are crossed by the cage", check.crossing.size() - 5)});
    if (check.nested > 0)
        result.push_back({false, "cage", fmt::format("contains {} within the outermost", counted(check.nested, "cage"))});
    if (check.components > 1 + check.nested)
        result.push_back({false, "cage", fmt::format("has {} components", check.components)});
    return result;
}

}  // namespace ostraka
