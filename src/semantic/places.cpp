// Constraints on positions of points and parts: on a plane, on a line, mirrored, adjacent.
#include "semantic/statements.h"

#include "ostraka/geom/point_tree.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/relation/geometric.h"

namespace ostraka::semantic {

namespace {

/// Largest distance at rest of points that are paired, in the mesh's unit; has a lower limit for constraints with small
/// tolerances.
double near(const ConstraintMembers& members, const RelationOptions& tolerances) {
    return std::max(tolerances.distance, 0.01) * box_diagonal(members.shape().mesh);
}

/// A statement with one constraint of this kind on all vertices.
Statement all_on(const ConstraintKind& kind, const MembersPtr& members, const RelationOptions& tolerances) {
    members->need(1, 0);
    Statement statement;
    statement.lower = [members, kind](const State&, const State&) { return only(members->make(kind, members->all_vertices())); };
    const std::shared_ptr<const Constraint> together = members->make(kind, members->all_vertices());
    const Deviation distance{"rms distance", 0.0, members->tolerance("distance", length_tolerance(*members, tolerances)),
                             members->shape().annotations.unit};
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
    std::vector<double> barycentric;
    std::vector<Vector3d> gaps;  ///< mirror image minus partner, at rest
};

/// Partners of the vertices of member `from` on the surface of member `to`.
Partners partners_of(const ConstraintMembers& members, std::size_t from, std::size_t to, const kinds::MirrorPlane& plane,
                     double search_radius) {
    const auto& [normal, point] = plane;
    const Piece piece(members.shape().mesh, members.faces(to));
    const SurfaceSearch search(piece.mesh);
    Partners partners;
    Eigen::AlignedBox3d near;
    for (const Vertex v : piece.mesh.vertices()) near.extend(eigen(piece.mesh.point(v)));
    near.extend(near.min() - Vector3d::Constant(search_radius));
    near.extend(near.max() + Vector3d::Constant(search_radius));
    for (const Index v : members.vertices(from)) {
        const Vector3d p = members.shape().rest.col(v), image = p - 2 * normal.dot(p - point) * normal;
        if (!near.contains(image)) continue;
        const SurfaceHit hit = search.closest(point_of(image));
        if (hit.distance > search_radius) continue;
        const auto corner = corners(piece.mesh, Face(hit.face));
        partners.ids.push_back(static_cast<int>(v));
        for (std::size_t k = 0; k < 3; ++k) {
            partners.ids.push_back(static_cast<int>(piece.vertex[corner[k]]));
            partners.barycentric.push_back(hit.barycentric[k]);
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
Statement mirrored_alone(const MembersPtr& members, const RelationOptions& tolerances,
                         const std::optional<kinds::MirrorPlane>& plane) {
    Statement statement;
    if (!plane) {
        statement.measure = as_related(members, members->relationship(), tolerances);
        return statement;
    }
    double sum = 0;
    std::size_t count = 0;
    const double everywhere = 1e3 * box_diagonal(members->shape().mesh) + 2 * plane->point.norm();
    for (const std::size_t from : {std::size_t{0}, members->count() - 1}) {
        const Partners partners = partners_of(*members, from, members->count() - 1 - from, *plane, everywhere);
        for (const Vector3d& gap : partners.gaps) sum += gap.squaredNorm(), ++count;
    }
    const Deviation rms{"distance", std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, count))),
                        members->tolerance("distance", length_tolerance(*members, tolerances)),
                        members->shape().annotations.unit};
    statement.measure = [rms](const State&) { return verdict_of({rms}); };
    return statement;
}

/// For a shape judged alone: the distance between the parts.
Statement adjacent_alone(const MembersPtr& members, double tolerance) {
    const auto first = members->vertices(0), second = members->vertices(1);
    std::vector<Point> places;
    for (const Index v : second) places.push_back(members->shape().mesh.point(Vertex(v)));
    const PointTree tree(places);
    double gap = std::numeric_limits<double>::infinity();
    for (const Index v : first) {
        gap = std::min(gap, std::sqrt(tree.nearest(members->shape().mesh.point(Vertex(v))).squared));
    }
    Statement statement;
    statement.measure = [measured = verdict_of({{"gap", gap, tolerance, members->shape().annotations.unit}})](const State&) {
        return measured;
    };
    return statement;
}

}  // namespace

Statement co_planarity(const MembersPtr& members, const spec::None&, const RelationOptions& tolerances) {
    return all_on(kinds::Plane{}, members, tolerances);
}

Statement co_linearity(const MembersPtr& members, const spec::None&, const RelationOptions& tolerances) {
    return all_on(kinds::Line{}, members, tolerances);
}

Statement mirror_symmetry(const MembersPtr& members, const spec::MirrorSymmetry& spec, const RelationOptions& tolerances) {
    members->need(1, 2);
    for (std::size_t i = 0; i < members->count(); ++i) members->need_region(i);
    if (members->shape().alone) return mirrored_alone(members, tolerances, spec.plane);
    std::optional<kinds::MirrorPlane> given = spec.plane;
    if (!given) {
        Relationship stated = members->relationship();
        stated.is_constraint = false;
        const RelationCheck check = RelationMeter(members->shape(), tolerances).measure(stated);
        if (!check.parameters.plane) members->fail("has no plane of symmetry: " + check.text, "give direction and point");
        const auto& plane = *check.parameters.plane;
        given = kinds::MirrorPlane{{plane.direction[0], plane.direction[1], plane.direction[2]},
                                   {plane.point[0], plane.point[1], plane.point[2]}};
    }
    const double tolerance = members->tolerance("distance", length_tolerance(*members, tolerances)),
                 search_radius = 3 * near(*members, tolerances);
    const Partners partners = partners_of(*members, 0, members->count() - 1, *given, search_radius);
    if (2 * partners.gaps.size() < members->vertices(0).size())
        members->fail("has a mirror image for less than half of annotation " + std::to_string(members->member(0).id),
                      "give the plane, or a greater --distance");
    kinds::MirrorInTriangles mirror{*given, partners.barycentric, Points(3, static_cast<Eigen::Index>(partners.gaps.size()))};
    for (std::size_t i = 0; i < partners.gaps.size(); ++i)
        mirror.discrepancies->col(static_cast<Eigen::Index>(i)) = partners.gaps[i];
    if (members->count() == 2) members->check_leader(spec.leader);
    Statement statement;
    statement.lower = [=](const State& edited, const State&) {
        Statement::Constraints list = only(members->make(mirror, partners.ids));
        if (const auto leader = members->count() == 2 ? members->leader(spec.leader, edited) : std::nullopt)
            list.push_back(members->as_edited(*leader, edited));
        return list;
    };
    const Deviation distance{"distance", 0.0, tolerance, members->shape().annotations.unit};
    statement.measure = [=](const State& deformed) {
        Deviation rms = distance;
        double sum = 0;
        for (std::size_t i = 0; i < partners.gaps.size(); ++i) {
            const Vector3d p = deformed.points.col(partners.ids[4 * i]);
            const auto& [n, origin] = mirror.plane;
            Vector3d off = p - 2 * n.dot(p - origin) * n - partners.gaps[i];
            for (std::size_t k = 0; k < 3; ++k)
                off -= partners.barycentric[3 * i + k] * deformed.points.col(partners.ids[4 * i + 1 + k]);
            sum += off.squaredNorm();
        }
        rms.value = std::sqrt(sum / static_cast<double>(partners.gaps.size()));
        return verdict_of({rms});
    };
    return statement;
}

Statement adjacency(const MembersPtr& members, const spec::None&, const RelationOptions& tolerances) {
    members->need(2, 2);
    const double search_radius = near(*members, tolerances);
    if (members->shape().alone) return adjacent_alone(members, search_radius);
    const auto first = members->vertices(0), second = members->vertices(1);
    std::vector<Index> shared;
    std::set_intersection(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(shared));
    // Parts with common vertices cannot separate; other parts keep the gap where they are close to each other.
    std::vector<std::array<int, 2>> pairs;
    if (shared.empty()) {
        add_nearest(members->shape().rest, first, second, search_radius, pairs);
        add_nearest(members->shape().rest, second, first, search_radius, pairs);
        std::sort(pairs.begin(), pairs.end());
        pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
        if (pairs.empty())
            members->fail("has parts that are nowhere within " + std::to_string(search_radius) + " of each other",
                          "raise --distance");
    }
    Statement statement;
    statement.lower = [=](const State&, const State&) {
        Statement::Constraints list;
        for (const auto& pair : pairs)
            list.push_back(members->make(kinds::EdgeStrain{}, {pair[0], pair[1]}, 1.0 / static_cast<double>(pairs.size())));
        return list;
    };
    const Deviation opened{"change of the gap", 0.0, length_tolerance(*members, tolerances), members->shape().annotations.unit};
    const Points rest = members->shape().rest;
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
