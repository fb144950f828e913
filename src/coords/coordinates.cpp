#include "ostraka/coords/coordinates.h"

#include "coords/kinds.h"

#include "ostraka/coords/nested.h"
#include "ostraka/core/error.h"
#include "ostraka/core/memory.h"
#include "ostraka/core/message_text.h"
#include "ostraka/execution/parallel.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

std::vector<CoordinateKind>& kinds() {
    static std::vector<CoordinateKind> registered{
        {"mean-value", "mean value coordinates (Ju, Schaefer, Warren 2005)", true, false, &coords::mean_value},
        {"green", "Green coordinates (Lipman, Levin, Cohen-Or 2008), for unconstrained deformation", false, true, &coords::green},
        {"harmonic", "harmonic coordinates (Joshi et al. 2007) on tetrahedra", true, false, &coords::harmonic},
        {"local", "local barycentric coordinates (Zhang et al. 2014) on tetrahedra", true, false, &coords::local},
        {"positive-mean-value", "positive mean value coordinates (Lipman et al. 2007)", true, false,
         &coords::positive_mean_value}};
    return registered;
}

bool is_finite(const Point& p) { return std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.z()); }

void check_cage(const Mesh& cage) {
    if (cage.number_of_faces() == 0) fail_input("cage", "has no faces", "give a closed triangle mesh around the mesh");
    if (cage.has_garbage()) fail_input("cage", "contains removed elements", "collect its garbage first");
    for (const Vertex v : cage.vertices())
        if (!is_finite(cage.point(v)))
            fail_input("cage", fmt::format("vertex {} is not finite", v.idx()), "give a cage with finite coordinates");
    for (const Face f : cage.faces())
        if (cage.degree(f) != 3) fail_input("cage", fmt::format("face {} is not a triangle", f.idx()), "triangulate the cage");
    for (const Halfedge h : cage.halfedges())
        if (cage.is_border(h))
            fail_input("cage",
                       fmt::format("is open: it has a border at the edge from vertex {} to vertex {}", cage.source(h).idx(),
                                   cage.target(h).idx()),
                       "close it, for example with 'ostraka mesh repair'");
}

}  // namespace

void add_coordinate_kind(CoordinateKind kind) {
    for (CoordinateKind& existing : kinds())
        if (existing.name == kind.name) {
            existing = std::move(kind);
            return;
        }
    kinds().push_back(std::move(kind));
}

std::vector<std::string> coordinate_kinds() {
    std::vector<std::string> names;
    for (const CoordinateKind& kind : kinds()) names.push_back(kind.name);
    return names;
}

const CoordinateKind& coordinate_kind(const std::string& name) {
    for (const CoordinateKind& kind : kinds())
        if (kind.name == name) return kind;
    fail_usage(fmt::format("there are no coordinates of the kind '{}'", name), "use one of: " + joined(coordinate_kinds()));
}

Coordinates compute_coordinates(const std::string& name, const Mesh& cage, const std::vector<Point>& points,
                                const CoordinateOptions& options) {
    const CoordinateKind& kind = coordinate_kind(name);
    check_options(options, name + " coordinates");
    check_cage(cage);
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!is_finite(points[i]))
            fail_input("point " + std::to_string(i), "is not finite", "give a mesh with finite coordinates");
    // One number per point and cage vertex, and per point and cage face for kinds with a normal term.
    const double columns =
        static_cast<double>(cage.number_of_vertices()) + (kind.with_normals ? static_cast<double>(cage.number_of_faces()) : 0.0);
    require_memory(
        8 * columns * static_cast<double>(points.size()),
        fmt::format("{} coordinates of {} points in a cage of {} vertices", name, points.size(), cage.number_of_vertices()),
        "give a coarser cage or mesh");
    Coordinates result = kind.compute(cage, points, options);
    result.kind = name;
    return result;
}

std::vector<Point> points_of(const Mesh& mesh) {
    std::vector<Point> points;
    points.reserve(mesh.number_of_vertices());
    for (const Vertex v : mesh.vertices()) points.push_back(mesh.point(v));
    return points;
}

Coordinates compute_coordinates(const std::string& kind, const Mesh& cage, const Mesh& mesh, const CoordinateOptions& options) {
    check_cage(cage);
    if (const std::vector<CageLevel> levels = cage_levels(cage); levels.size() > 1)
        return nested_coordinates(kind, levels, mesh, options);
    return compute_coordinates(kind, cage, points_of(mesh), options);
}

std::vector<Vector> stretched_normals(const Mesh& rest_cage, const std::vector<Point>& cage_points) {
    if (cage_points.size() != rest_cage.number_of_vertices())
        fail_usage(fmt::format("the moved cage has {} points, but the cage has {} vertices", cage_points.size(),
                               rest_cage.number_of_vertices()),
                   "give one point for each vertex of the cage");
    std::vector<Vector> normals;
    normals.reserve(rest_cage.number_of_faces());
    for (const Face f : rest_cage.faces()) {
        const auto [a, b, c] = corners(rest_cage, f);
        const Vector u = rest_cage.point(b) - rest_cage.point(a), v = rest_cage.point(c) - rest_cage.point(a);
        const Vector U = cage_points[b] - cage_points[a], V = cage_points[c] - cage_points[a];
        // The ratio does not depend on the unit of length; normalised lengths keep the fourth powers in range.
        const double unit = std::sqrt(std::max(u.squared_length(), v.squared_length()));
        const Vector u1 = u / unit, v1 = v / unit, U1 = U / unit, V1 = V / unit, n = CGAL::cross_product(U1, V1);
        const double area = std::sqrt(CGAL::cross_product(u1, v1).squared_length()), normal = std::sqrt(n.squared_length());
        if (!(unit > 0) || !(area > 0) || !(normal > 0)) {
            normals.emplace_back(0, 0, 0);
            continue;
        }
        // s = sqrt(|u'|^2 |v|^2 - 2 (u' . v')(u . v) + |v'|^2 |u|^2) / (sqrt(8) area), where |u x v| is twice the area.
        const double s = std::sqrt(std::max(0.0, U1 * U1 * (v1 * v1) - 2 * (U1 * V1) * (u1 * v1) + V1 * V1 * (u1 * u1))) /
                         (std::sqrt(2.0) * area);
        normals.push_back(s / normal * n);
    }
    return normals;
}

std::vector<Point> deformed(const Coordinates& coordinates, const Mesh& rest_cage, const std::vector<Point>& cage_points) {
    const auto columns = static_cast<std::size_t>(coordinates.vertex.cols());
    const auto rows = static_cast<std::size_t>(coordinates.vertex.rows());
    if (columns != rest_cage.number_of_vertices() || columns != cage_points.size())
        fail_usage(fmt::format("the coordinates of {} cage vertices do not match a cage of {} vertices and {} moved points",
                               columns, rest_cage.number_of_vertices(), cage_points.size()),
                   "give the cage that the coordinates were computed for");
    if (coordinates.has_normals() && (static_cast<std::size_t>(coordinates.normal.cols()) != rest_cage.number_of_faces() ||
                                      static_cast<std::size_t>(coordinates.normal.rows()) != rows))
        fail_usage("the normal weights do not match the faces of the cage",
                   "give the cage that the coordinates were computed for");
    using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3>;
    Columns V(static_cast<Eigen::Index>(columns), 3), N(0, 3);
    // Relative to the first vertex, so that no digits are lost far from the origin.
    const Point origin = columns > 0 ? cage_points.front() : Point(0, 0, 0);
    for (std::size_t i = 0; i < columns; ++i)
        for (int k = 0; k < 3; ++k) V(static_cast<Eigen::Index>(i), k) = cage_points[i][k] - origin[k];
    if (coordinates.has_normals()) {
        const std::vector<Vector> normals = stretched_normals(rest_cage, cage_points);
        N.resize(static_cast<Eigen::Index>(normals.size()), 3);
        for (std::size_t i = 0; i < normals.size(); ++i)
            for (int k = 0; k < 3; ++k) N(static_cast<Eigen::Index>(i), k) = normals[i][k];
    }
    std::vector<Point> result(rows);
    parallel_blocks(rows, 64, [&](std::size_t begin, std::size_t end) {
        const auto first = static_cast<Eigen::Index>(begin), count = static_cast<Eigen::Index>(end - begin);
        Columns X(count, 3);
        if (coordinates.is_sparse()) {
            for (Eigen::Index i = 0; i < count; ++i) {
                Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
                for (SparseWeights::InnerIterator entry(coordinates.sparse, first + i); entry; ++entry)
                    sum += entry.value() * V.row(entry.col());
                X.row(i) = sum;
            }
        } else {
            X = coordinates.vertex.middleRows(first, count) * V;
        }
        if (coordinates.has_normals()) X += coordinates.normal.middleRows(first, count) * N;
        for (std::size_t i = begin; i < end; ++i) {
            const auto row = static_cast<Eigen::Index>(i - begin);
            result[i] = Point(origin.x() + X(row, 0), origin.y() + X(row, 1), origin.z() + X(row, 2));
        }
    });
    return result;
}

double Coordinates::stored_share() const {
    if (!is_sparse() || vertex.size() == 0) return 1;
    return static_cast<double>(sparse.nonZeros()) / static_cast<double>(vertex.size());
}

void CoordinateOptions::declare_options(OptionList& list) {
    list("snap", snap, "points within this distance of the cage count as lying on the cage", Range{0, 1e-6},
         "share of the cage's diagonal");
    list("nodes", nodes, "harmonic, local: approximate number of nodes of the tetrahedral mesh inside the cage", Range{100, 5e6});
    list("drop", drop, "weights below this value are set to zero (not with mean-value or green)", Range{0, 0.01});
    list("iterations", iterations, "local: maximum number of iterations", Range{1, 100000});
    list("tolerance", tolerance, "local: stop when ten iterations reduce the total variation by less than this fraction",
         Range{0, 0.1});
    list("fade", fade,
         "nested cages: the influence of an inner cage increases from 0 at its border to 1 at this distance inside it",
         Range{0, 1}, "share of its diagonal");
}

}  // namespace ostraka
