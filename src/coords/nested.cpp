#include "ostraka/coords/nested.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/point_tree.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/mesh/flood.h"
#include "ostraka/mesh/orientation.h"

#include <CGAL/Side_of_triangle_mesh.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// Tests which points are strictly inside a closed mesh. Everything is scaled by a power of two so that no coordinate exceeds
/// 1: otherwise CGAL's test rays could be too short relative to the coordinates of their origins.
std::vector<bool> strictly_inside(const Mesh& closed, const std::vector<Point>& places) {
    double largest = 0;
    const auto widen = [&](const Point& p) { largest = std::max({largest, std::abs(p.x()), std::abs(p.y()), std::abs(p.z())}); };
    for (const Point& p : closed.points()) widen(p);
    for (const Point& p : places) widen(p);
    int exponent = 0;
    if (largest > 0 && std::isfinite(largest)) (void)std::frexp(largest, &exponent);
    const auto in_unit = [&](const Point& p) {
        return Point(std::ldexp(p.x(), -exponent), std::ldexp(p.y(), -exponent), std::ldexp(p.z(), -exponent));
    };
    Mesh scaled = closed;
    for (const Vertex v : scaled.vertices()) scaled.point(v) = in_unit(closed.point(v));
    const CGAL::Side_of_triangle_mesh<Mesh, Kernel> side(scaled);
    std::vector<char> inside(places.size(), 0);
    if (places.empty()) return {};
    static_cast<void>(side(in_unit(places.front())));  // the first query builds the search structure
    parallel_for(places.size(), [&](std::size_t i) { inside[i] = side(in_unit(places[i])) == CGAL::ON_BOUNDED_SIDE; });
    return {inside.begin(), inside.end()};
}

/// The faces of the chosen components, and the isolated vertices if `loose`.
SubMesh part_of(const Mesh& cage, const FacePieces& pieces, const std::vector<bool>& chosen, bool loose) {
    SubMesh part;
    std::vector<Index> new_index(cage.number_of_vertices(), no_index);
    std::vector<bool> used(cage.number_of_vertices(), false);
    for (const Face f : cage.faces())
        if (chosen[pieces.of_face[f]])
            for (const Vertex v : corners(cage, f)) used[v] = true;
    for (const Vertex v : cage.vertices())
        if (used[v] || (loose && cage.is_isolated(v))) {
            new_index[v] = part.mesh.add_vertex(cage.point(v));
            part.vertices.push_back(v);
        }
    for (const Face f : cage.faces()) {
        if (!chosen[pieces.of_face[f]]) continue;
        const auto [a, b, c] = corners(cage, f);
        part.mesh.add_face(Vertex(new_index[a]), Vertex(new_index[b]), Vertex(new_index[c]));
        part.faces.push_back(f);
    }
    return part;
}

/// Quintic smooth step: 0 up to 0, 1 from 1 on, with continuous second derivative.
double smooth_step(double t) {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * t * (t * (6 * t - 15) + 10);
}

/// The influence of a level on each vertex of a mesh, 0 to 1.
std::vector<double> level_influence(const Mesh& cage, const Mesh& mesh, double fade) {
    const std::vector<Point> points = points_of(mesh);
    const std::vector<bool> inside = strictly_inside(cage, points);
    // Only the largest piece inside counts: other parts of the object that reach into the cage are ignored.
    std::vector<bool> visited(points.size(), false);
    std::vector<Vertex> piece;
    for (const Vertex first : mesh.vertices()) {
        if (!inside[first] || visited[first]) continue;
        std::vector<Vertex> component = flood_vertices(mesh, first, visited, [&](Vertex v) -> bool { return inside[v]; });
        if (component.size() > piece.size()) piece = std::move(component);
    }
    std::vector<bool> in_piece(points.size(), false);
    for (const Vertex v : piece) in_piece[v] = true;
    const SurfaceSearch search(cage);
    std::vector<Point> entries;
    for (const Edge e : mesh.edges()) {
        Vertex inner = mesh.vertex(e, 0), outer = mesh.vertex(e, 1);
        if (in_piece[inner] == in_piece[outer]) continue;
        if (in_piece[outer]) std::swap(inner, outer);
        const double inner_distance = search.closest(mesh.point(inner)).distance,
                     outer_distance = search.closest(mesh.point(outer)).distance;
        const double t = inner_distance + outer_distance > 0 ? inner_distance / (inner_distance + outer_distance) : 0;
        entries.push_back(mesh.point(inner) + t * (mesh.point(outer) - mesh.point(inner)));
    }
    std::vector<double> influence(points.size(), 0);
    if (entries.empty()) {
        for (const Vertex v : piece) influence[v] = 1;
        return influence;
    }
    const PointTree tree(entries);
    const double length = fade * box_diagonal(cage);
    parallel_for(piece.size(), [&](std::size_t i) {
        const double distance = std::sqrt(tree.nearest(points[piece[i]]).squared);
        influence[piece[i]] = length > 0 ? smooth_step(distance / length) : 1;
    });
    return influence;
}

}  // namespace

std::vector<CageLevel> cage_levels(const Mesh& cage) {
    const FacePieces pieces = face_pieces(cage);
    const bool open =
        std::any_of(cage.halfedges().begin(), cage.halfedges().end(), [&](Halfedge h) { return cage.is_border(h); });
    const auto select_pieces = [&](auto&& condition) {
        std::vector<bool> chosen(pieces.count, false);
        for (Index k = 0; k < pieces.count; ++k) chosen[k] = condition(k);
        return chosen;
    };
    const auto single_level = [&] {
        return CageLevel{part_of(cage, pieces, select_pieces([](Index) { return true; }), true), 0};
    };
    std::vector<CageLevel> levels;
    if (pieces.count < 2 || open) {
        levels.push_back(single_level());
        return levels;
    }
    // The parent of each component is the smallest component around it.
    std::vector<SubMesh> components;
    std::vector<double> volume;
    for (Index k = 0; k < pieces.count; ++k) {
        components.push_back(part_of(cage, pieces, select_pieces([&](Index other) { return other == k; }), false));
        volume.push_back(signed_volume(components.back().mesh));
    }
    std::vector<Index> parent(pieces.count, no_index);
    for (Index k = 0; k < pieces.count; ++k) {
        const std::vector<Point> points = points_of(components[k].mesh);
        for (Index other = 0; other < pieces.count; ++other) {
            if (other == k || !(volume[k] * volume[other] > 0) || !(std::abs(volume[other]) > std::abs(volume[k]))) continue;
            if (parent[k] != no_index && std::abs(volume[parent[k]]) <= std::abs(volume[other])) continue;
            const std::vector<bool> inside = strictly_inside(components[other].mesh, points);
            if (2 * std::count(inside.begin(), inside.end(), true) > static_cast<std::ptrdiff_t>(points.size()))
                parent[k] = other;
        }
    }
    levels.push_back({part_of(cage, pieces, select_pieces([&](Index k) { return parent[k] == no_index; }), true), 0});
    std::vector<std::size_t> level_of(pieces.count, 0);
    std::vector<bool> assigned = select_pieces([&](Index k) { return parent[k] == no_index; });
    for (bool changed = true; changed;) {
        changed = false;
        const std::vector<bool> previously_assigned = assigned;
        for (Index k = 0; k < pieces.count; ++k) {
            if (previously_assigned[k] || !previously_assigned[parent[k]]) continue;
            level_of[k] = levels.size();
            levels.push_back({std::move(components[k]), level_of[parent[k]]});
            assigned[k] = changed = true;
        }
    }
    return levels;
}

std::vector<WeightMatrix> carrying_weights(const std::vector<CageLevel>& levels) {
    std::vector<WeightMatrix> carrying(levels.size());
    for (std::size_t l = 1; l < levels.size(); ++l)
        carrying[l] =
            compute_coordinates("mean-value", levels[levels[l].parent].cage.mesh, points_of(levels[l].cage.mesh)).vertex;
    return carrying;
}

Coordinates nested_coordinates(const std::string& kind, const std::vector<CageLevel>& levels, const Mesh& mesh,
                               const CoordinateOptions& options) {
    if (coordinate_kind(kind).with_normals)
        fail_usage(kind + " coordinates are not defined in nested cages",
                   "use another kind of coordinates, or a cage without inner cages");
    Eigen::Index columns = 0;
    for (const CageLevel& level : levels) columns += static_cast<Eigen::Index>(level.cage.vertices.size());
    const std::vector<Point> points = points_of(mesh);
    const Coordinates outer = compute_coordinates(kind, levels[0].cage.mesh, points, options);
    Coordinates result;
    result.kind = kind;
    result.seconds = outer.seconds;
    result.vertex = WeightMatrix::Zero(static_cast<Eigen::Index>(points.size()), columns);
    for (std::size_t j = 0; j < levels[0].cage.vertices.size(); ++j)
        result.vertex.col(levels[0].cage.vertices[j]) = outer.vertex.col(static_cast<Eigen::Index>(j));
    const std::vector<WeightMatrix> carrying = carrying_weights(levels);
    for (std::size_t l = 1; l < levels.size(); ++l) {
        const SubMesh &level_cage = levels[l].cage, &parent_cage = levels[levels[l].parent].cage;
        const std::vector<double> influence = level_influence(level_cage.mesh, mesh, options.fade);
        std::vector<Point> influenced_points;
        std::vector<Eigen::Index> rows;
        for (std::size_t v = 0; v < influence.size(); ++v)
            if (influence[v] > 0) influenced_points.push_back(points[v]), rows.push_back(static_cast<Eigen::Index>(v));
        const Coordinates inner = compute_coordinates(kind, level_cage.mesh, influenced_points, options);
        for (std::size_t k = 0; k < inner.seconds.size(); ++k) result.seconds[k].second += inner.seconds[k].second;
        const WeightMatrix& weights = inner.vertex;
        parallel_for(rows.size(), [&](std::size_t i) {
            const Eigen::RowVectorXd weighted =
                influence[static_cast<std::size_t>(rows[i])] * weights.row(static_cast<Eigen::Index>(i));
            const Eigen::RowVectorXd parent_weights = weighted * carrying[l];
            for (std::size_t j = 0; j < level_cage.vertices.size(); ++j)
                result.vertex(rows[i], level_cage.vertices[j]) += weighted[static_cast<Eigen::Index>(j)];
            for (std::size_t j = 0; j < parent_cage.vertices.size(); ++j)
                result.vertex(rows[i], parent_cage.vertices[j]) -= parent_weights[static_cast<Eigen::Index>(j)];
        });
    }
    if (outer.is_sparse()) result.sparse = result.vertex.sparseView();
    return result;
}

WeightMatrix weights_of_level(const WeightMatrix& vertex, const std::vector<CageLevel>& levels,
                              const std::vector<WeightMatrix>& carrying, std::size_t level) {
    const std::vector<Index>& columns = levels[level].cage.vertices;
    WeightMatrix weights(vertex.rows(), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t j = 0; j < columns.size(); ++j) weights.col(static_cast<Eigen::Index>(j)) = vertex.col(columns[j]);
    for (std::size_t child = level + 1; child < levels.size(); ++child)
        if (levels[child].parent == level) weights += weights_of_level(vertex, levels, carrying, child) * carrying[child];
    return weights;
}

std::size_t governing_level(const WeightMatrix& vertex, const std::vector<Index>& points, const std::vector<CageLevel>& levels,
                            const std::vector<WeightMatrix>& carrying) {
    if (levels.size() < 2) return 0;
    WeightMatrix rows(static_cast<Eigen::Index>(points.size()), vertex.cols());
    for (std::size_t i = 0; i < points.size(); ++i) rows.row(static_cast<Eigen::Index>(i)) = vertex.row(points[i]);
    for (std::size_t l = levels.size() - 1; l > 0; --l)
        if (weights_of_level(rows, levels, carrying, l).sum() >= 0.5 * static_cast<double>(points.size())) return l;
    return 0;
}

}  // namespace ostraka
