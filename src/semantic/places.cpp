// Constraints on positions of points and parts: on a plane, on a line, mirrored, adjacent.
#include "reader.h"

#include "ostraka/geom/point_tree.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/relation/geometric.h"

namespace ostraka::semantic {

namespace {

/// Largest distance at rest of points that are paired, in the mesh's unit; has a lower limit for constraints with small
/// tolerances.
double near(const Reader& read, const RelationOptions& tolerances) {
    return std::max(tolerances.distance, 0.01) * box_diagonal(read.shape().mesh);
}

/// A statement with one constraint of this kind on all vertices.
Statement all_on(const char* kind, const ReaderPtr& read, const RelationOptions& tolerances) {
    read->need(1, 0);
    Statement statement;
    statement.lower = [read, kind](const State&, const State&) { return only(read->make(kind, read->all_vertices(), {})); };
    const std::shared_ptr<const Constraint> together = read->make(kind, read->all_vertices(), {});
    const Deviation distance{"rms distance", 0.0, read->tolerance("distance", length_tolerance(*read, tolerances)),
                             read->shape().set.unit};
    statement.measure = [together, distance](const State& deformed) {
        Deviation rms = distance;
        rms.value = std::sqrt(together->squared_distance(deformed.points) / static_cast<double>(together->ids().size()));
        return verdict_of({rms});
    };
    return statement;
}

/// The faces of an annotation as a separate mesh, with the indices of its vertices in the whole. Faces are not connected, since
/// a patch that touches itself at a vertex is not manifold.
struct Piece {
    Mesh mesh;
    std::vector<Index> vertex;
    Piece(const Mesh& whole, const std::vector<Index>& faces) {
        for (const Index f : faces) {
            std::array<Vertex, 3> corner;
            for (std::size_t k = 0; const Index v : corners(whole, Face(f))) {
                corner.at(k++) = mesh.add_vertex(whole.point(Vertex(v)));
                vertex.push_back(v);
            }
            mesh.add_face(corner[0], corner[1], corner[2]);
        }
    }
};

/// Pairs of a point and the corners of the face that contains its mirror image.
struct Partners {
    std::vector<int> ids;
    std::vector<double> coefficients;
    std::vector<Vector3d> gaps;  ///< mirror image minus partner, at rest
};

/// Partners of the vertices of member `from` on the surface of member `to`.
Partners partners_of(const Reader& read, std::size_t from, std::size_t to, const Vector3d& point, const Vector3d& normal,
                     double search_radius) {
    const Piece piece(read.shape().mesh, read.faces(to));
    const SurfaceSearch search(piece.mesh);
    Partners partners;
    Eigen::AlignedBox3d near;
    for (const Vertex v : piece.mesh.vertices()) near.extend(eigen(piece.mesh.point(v)));
    near.extend(near.min() - Vector3d::Constant(search_radius));
    near.extend(near.max() + Vector3d::Constant(search_radius));
    for (const Index v : read.vertices(from)) {
        const Vector3d p = read.shape().rest.col(v), image = p - 2 * normal.dot(p - point) * normal;
        if (!near.contains(image)) continue;
        const SurfaceHit hit = search.closest(point_of(image));
        if (hit.distance > search_radius) continue;
        const auto corner = corners(piece.mesh, Face(hit.face));
        partners.ids.push_back(static_cast<int>(v));
        for (std::size_t k = 0; k < 3; ++k) {
            partners.ids.push_back(static_cast<int>(piece.vertex[corner[k]]));
            partners.coefficients.push_back(hit.barycentric[k]);
        }
        partners.gaps.push_back(image - eigen(hit.point));
    }
    return partners;
}

/// Adds a pair, lower index first, of each vertex and the nearest vertex within the search radius that does not coincide with
/// it.
void add_nearest(const Points& points, const std::vector<Index>& from, const std::vector<Index>& to, double search_radius,
                 std::vector<std::array<int, 2>>& pairs) {
    std::vector<Point> places;
    for (const Index v : to) places.push_back(point_of(points.col(v)));
    const PointTree tree(places);
    std::vector<Index> near;
    for (const Index v : from) {
        double best = std::numeric_limits<double>::infinity();
        Index partner = no_index;
        tree.within(point_of(points.col(v)), search_radius, near);
        for (const Index i : near) {
            const double d = (points.col(to[i]) - points.col(v)).norm();
            if (d > 0 && d < best) best = d, partner = to[i];
        }
        if (partner == no_index) continue;
        pairs.push_back({static_cast<int>(std::min(v, partner)), static_cast<int>(std::max(v, partner))});
    }
}

/// For a shape judged alone: the distances between the mirror images of all vertices of each part and the surface of the other.
Statement mirrored_alone(const ReaderPtr& read, const RelationOptions& tolerances, const std::optional<Vector3d>& point,
                         const std::optional<Vector3d>& normal) {
    Statement statement;
    if (!normal) {
        statement.measure = as_related(read, read->relationship(), tolerances);
        return statement;
    }
    double sum = 0;
    std::size_t count = 0;
    const double everywhere = 1e3 * box_diagonal(read->shape().mesh) + 2 * (*point).norm();
    for (const std::size_t from : {std::size_t{0}, read->members() - 1}) {
        const Partners partners = partners_of(*read, from, read->members() - 1 - from, *point, *normal, everywhere);
        for (const Vector3d& gap : partners.gaps) sum += gap.squaredNorm(), ++count;
    }
    const Deviation rms{"distance", std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, count))),
                        read->tolerance("distance", length_tolerance(*read, tolerances)), read->shape().set.unit};
    statement.measure = [rms](const State&) { return verdict_of({rms}); };
    return statement;
}

/// For a shape judged alone: the distance between the parts.
Statement adjacent_alone(const ReaderPtr& read, double tolerance) {
    const auto first = read->vertices(0), second = read->vertices(1);
    std::vector<Point> places;
    for (const Index v : second) places.push_back(read->shape().mesh.point(Vertex(v)));
    const PointTree tree(places);
    double gap = std::numeric_limits<double>::infinity();
    for (const Index v : first) {
        gap = std::min(gap, std::sqrt(tree.nearest(read->shape().mesh.point(Vertex(v))).squared));
    }
    Statement statement;
    statement.measure = [measured = verdict_of({{"gap", gap, tolerance, read->shape().set.unit}})](const State&) {
        return measured;
    };
    return statement;
}

}  // namespace

Statement co_planarity(const ReaderPtr& read, const RelationOptions& tolerances) { return all_on("Plane", read, tolerances); }

Statement co_linearity(const ReaderPtr& read, const RelationOptions& tolerances) { return all_on("Line", read, tolerances); }

Statement mirror_symmetry(const ReaderPtr& read, const RelationOptions& tolerances) {
    read->need(1, 2);
    for (std::size_t i = 0; i < read->members(); ++i) read->need_region(i);
    ConstraintParameters parameters;
    parameters.direction = read->direction("direction");
    parameters.point = read->vector("point");
    if (parameters.direction.has_value() != parameters.point.has_value())
        read->fail("has direction or point of the plane alone", "give both, or neither: the plane is then that at rest");
    if (read->shape().alone) return mirrored_alone(read, tolerances, parameters.point, parameters.direction);
    if (!parameters.direction) {
        Relationship stated = read->relationship();
        stated.is_constraint = false;
        const RelationCheck check = RelationMeter(read->shape().mesh, read->shape().set, tolerances).measure(stated);
        if (!check.parameters.plane) read->fail("has no plane of symmetry: " + check.text, "give direction and point");
        const auto& plane = *check.parameters.plane;
        parameters.point = Vector3d(plane.point[0], plane.point[1], plane.point[2]);
        parameters.direction = Vector3d(plane.direction[0], plane.direction[1], plane.direction[2]);
    }
    const double tolerance = read->tolerance("distance", length_tolerance(*read, tolerances)),
                 search_radius = 3 * near(*read, tolerances);
    const Partners partners = partners_of(*read, 0, read->members() - 1, *parameters.point, *parameters.direction, search_radius);
    if (2 * partners.gaps.size() < read->vertices(0).size())
        read->fail("has a mirror image for less than half of annotation " + std::to_string(read->member(0).id),
                   "give the plane, or a greater --distance");
    parameters.coefficients = partners.coefficients;
    if (read->members() == 2) read->read_leader();
    Statement statement;
    statement.lower = [=](const State& edited, const State&) {
        ConstraintParameters given = parameters;
        given.target.emplace(3, static_cast<Eigen::Index>(partners.gaps.size()));
        for (std::size_t i = 0; i < partners.gaps.size(); ++i) given.target->col(static_cast<Eigen::Index>(i)) = partners.gaps[i];
        Statement::Constraints list = only(read->make("MirrorSymmetry", partners.ids, given));
        if (const auto leader = read->members() == 2 ? read->leader(edited) : std::nullopt)
            list.push_back(read->as_edited(*leader, edited));
        return list;
    };
    const Deviation distance{"distance", 0.0, tolerance, read->shape().set.unit};
    statement.measure = [=](const State& deformed) {
        Deviation rms = distance;
        double sum = 0;
        for (std::size_t i = 0; i < partners.gaps.size(); ++i) {
            const Vector3d p = deformed.points.col(partners.ids[4 * i]);
            Vector3d off = p - 2 * parameters.direction->dot(p - *parameters.point) * *parameters.direction - partners.gaps[i];
            for (std::size_t k = 0; k < 3; ++k)
                off -= partners.coefficients[3 * i + k] * deformed.points.col(partners.ids[4 * i + 1 + k]);
            sum += off.squaredNorm();
        }
        rms.value = std::sqrt(sum / static_cast<double>(partners.gaps.size()));
        return verdict_of({rms});
    };
    return statement;
}

Statement adjacency(const ReaderPtr& read, const RelationOptions& tolerances) {
    read->need(2, 2);
    const double search_radius = near(*read, tolerances);
    if (read->shape().alone) return adjacent_alone(read, search_radius);
    const auto first = read->vertices(0), second = read->vertices(1);
    std::vector<Index> shared;
    std::set_intersection(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(shared));
    // Parts with common vertices cannot separate; other parts keep the gap where they are close to each other.
    std::vector<std::array<int, 2>> pairs;
    if (shared.empty()) {
        add_nearest(read->shape().rest, first, second, search_radius, pairs);
        add_nearest(read->shape().rest, second, first, search_radius, pairs);
        std::sort(pairs.begin(), pairs.end());
        pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
        if (pairs.empty())
            read->fail("has parts that are nowhere within " + std::to_string(search_radius) + " of each other",
                       "raise --distance");
    }
    Statement statement;
    statement.lower = [=](const State&, const State&) {
        Statement::Constraints list;
        for (const auto& pair : pairs) {
            ConstraintParameters parameters;
            parameters.min = parameters.max = 1;
            list.push_back(read->make("EdgeStrain", {pair[0], pair[1]}, parameters, 1.0 / static_cast<double>(pairs.size())));
        }
        return list;
    };
    const Deviation opened{"change of the gap", 0.0, length_tolerance(*read, tolerances), read->shape().set.unit};
    const Points rest = read->shape().rest;
    statement.measure = [=](const State& deformed) {
        Deviation worst = opened;
        for (const auto& [a, b] : pairs)
            worst.value = std::max(*worst.value, std::abs((deformed.points.col(a) - deformed.points.col(b)).norm() -
                                                          (rest.col(a) - rest.col(b)).norm()));
        Measured result = verdict_of({worst});
        if (pairs.empty()) result.text = "the parts have common vertices and cannot come apart";
        return result;
    };
    return statement;
}

}  // namespace ostraka::semantic
