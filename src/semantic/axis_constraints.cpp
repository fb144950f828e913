// Constraints between the axes of parts. The last member is the reference, whose axis is not changed.
#include "semantic/continuity.h"
#include "semantic/statements.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/angles.h"
#include "ostraka/relation/geometric.h"

namespace ostraka::semantic {

namespace {

/// Determines the axis of a part on a shape.
using AxisFinder = Axis (*)(const Mesh& mesh, const Annotation& part);

/// The axis of rotation, which hardly depends on where the part ends; for parts that are not round the axis of the slices.
Axis steadiest(const Mesh& mesh, const Annotation& part) {
    Axis found = find_axis(mesh, part.faces);
    return found.found ? found : axis_of_part(mesh, part);
}

Axis axis_of(const ConstraintMembers& members, std::size_t i, AxisFinder find) {
    members.need_region(i);
    Axis found = find(members.shape().mesh, members.member(i));
    if (!found.found)
        members.fail("annotation " + std::to_string(members.member(i).id) + " has no axis: " + found.reason,
                     "use another relation");
    return found;
}

/// The axes of all members, at least two.
std::vector<Axis> axes_of_parts(const ConstraintMembers& members) {
    members.need(2, 0);
    std::vector<Axis> axes;
    for (std::size_t i = 0; i < members.count(); ++i) axes.push_back(axis_of(members, i, axis_of_part));
    return axes;
}

/// The axis of the reference on the current shape, or at rest if the deformed reference has none.
Axis reference_now(const ConstraintMembers& members, const Axis& rest, const State& now, AxisFinder find) {
    Axis found = find(now.mesh, members.member(members.count() - 1));
    return found.found ? found : rest;
}

}  // namespace

Motion motion_back(const ConstraintMembers& members, const std::vector<Index>& vertices, const State& now) {
    std::vector<Vector3d> from, to;
    for (const Index v : vertices) {
        from.emplace_back(now.points.col(v));
        to.emplace_back(members.shape().rest.col(v));
    }
    return fit_motion(from, to);
}

Axis axis_carried_back(const ConstraintMembers& members, std::size_t i, const Axis& rest, const State& now) {
    Axis found = axis_of_part(now.mesh, members.member(i));
    if (!found.found) return rest;
    const Motion back = motion_back(members, members.vertices(i), now);
    found.point = point_of(back(eigen(found.point)));
    found.direction = vector_of(back.rotation * eigen(found.direction));
    return found;
}

Statement::Constraints keep_vertex_stars(const ConstraintMembers& members, const std::vector<Index>& vertices,
                                         const Points& shape, double grown) {
    constexpr double stiffness = 10;
    const Mesh& mesh = members.shape().mesh;
    Statement::Constraints list;
    for (const Index v : vertices) {
        const std::vector<int> star = vertex_star(mesh, Vertex(v));
        Points grown_star(3, static_cast<Eigen::Index>(star.size()));
        for (std::size_t i = 0; i < star.size(); ++i) grown_star.col(static_cast<Eigen::Index>(i)) = grown * shape.col(star[i]);
        list.push_back(members.make(kinds::Rigid{std::move(grown_star)}, star, stiffness / members.relationship().weight));
    }
    return list;
}

void allow_rotation(const MembersPtr& members, std::size_t count, Statement& statement) {
    std::set<Index> all;
    for (std::size_t i = 0; i < count; ++i)
        for (const Index v : members->vertices(i)) all.insert(v);
    statement.rotating.assign(all.begin(), all.end());
    statement.support = [members, rotating = statement.rotating](const State& edited, const State&) {
        return keep_vertex_stars(*members, rotating, edited.points);
    };
}

namespace {

/// Volume between the faces and the mean of the points.
double volume(const Mesh& mesh, const Points& points) {
    const Vector3d middle = points.col(0) + (points.colwise() - points.col(0).eval()).rowwise().mean();
    double sum = 0;
    for (const Face f : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, f);
        const Vector3d p = points.col(a) - middle, q = points.col(b) - middle, r = points.col(c) - middle;
        sum += p.dot(q.cross(r)) / 6;
    }
    return sum;
}

}  // namespace

void doubt_axes(const ConstraintMembers& members, const State& deformed, double tolerance, Measured& measured) {
    if (measured.verdict != Verdict::holds) return;
    for (std::size_t i = 0; i < members.count(); ++i) {
        const Annotation& part = members.member(i);
        const Axis axis = axis_of_part(deformed.mesh, part);
        if (!axis.found) continue;
        const AreaMoments moments = area_moments(deformed.mesh, part.faces);
        if (moments.variances[0] < 4 * moments.variances[1]) continue;
        const Vector3d longest = eigen(moments.directions[0]), own = eigen(axis.direction);
        const double apart = std::atan2(longest.cross(own).norm(), std::abs(longest.dot(own))) / degree;
        if (apart <= tolerance) continue;
        measured.verdict = Verdict::unknown;
        measured.text += (measured.text.empty() ? "" : "; ") + std::string("the axis of '") + printable(part.tag, 60) +
                         "' is certain to " + digits(apart, 2) +
                         " degrees only: the axis of its slices and that of its area differ by as much";
    }
}

Statement co_axiality(const MembersPtr& members, const spec::None&, const RelationOptions& tolerances) {
    const std::vector<Axis> axes = axes_of_parts(*members);
    Statement statement;
    statement.follows = true;
    allow_rotation(members, axes.size() - 1, statement);
    statement.lower = [members, axes](const State&, const State& now) {
        const Axis reference = reference_now(*members, axes.back(), now, axis_of_part);
        Statement::Constraints list;
        for (std::size_t i = 0; i + 1 < axes.size(); ++i) {
            const Axis axis = axis_carried_back(*members, i, axes[i], now);
            list.push_back(members->make(
                kinds::CoAxiality{eigen(reference.direction), eigen(reference.point), eigen(axis.direction), eigen(axis.point)},
                ids_of(members->vertices(i))));
        }
        return list;
    };
    statement.measure = as_related(members, members->relationship(), tolerances);
    return statement;
}

Statement axis_angle(const MembersPtr& members, const spec::None&, const RelationOptions& tolerances) {
    const std::vector<Axis> axes = axes_of_parts(*members);
    const double angle = members->relationship().type == "perpendicular axes" ? pi / 2 : 0;
    Statement statement;
    const int reference = members->member(axes.size() - 1).id;
    for (std::size_t i = 0; i + 1 < axes.size(); ++i) {
        const int own = members->member(i).id;
        statement.directions.push_back({own, eigen(axes.back().direction), angle, reference});
        statement.directions.push_back({reference, eigen(axes[i].direction), angle, own});
    }
    statement.follows = true;
    allow_rotation(members, axes.size() - 1, statement);
    statement.lower = [members, axes, angle](const State& edited, const State& now) {
        const Vector3d direction = eigen(reference_now(*members, axes.back(), now, axis_of_part).direction);
        Statement::Constraints list;
        for (std::size_t i = 0; i + 1 < axes.size(); ++i) {
            const std::vector<Index> vertices = members->vertices(i);
            list.push_back(members->make(kinds::AxisDirection{direction,
                                                              {angle, angle},
                                                              eigen(axis_carried_back(*members, i, axes[i], now).direction),
                                                              columns_at(edited.points, vertices)},
                                         ids_of(vertices)));
        }
        return list;
    };
    statement.measure = [members, related = as_related(members, members->relationship(), tolerances),
                         tolerance = tolerances.angle](const State& deformed) {
        Measured measured = related(deformed);
        doubt_axes(*members, deformed, tolerance, measured);
        return measured;
    };
    return statement;
}

namespace {

/// Means of the curves in which planes across a direction intersect a part, from the share `first` to the share `last` of the
/// extent of some of its vertices.
std::vector<Vector3d> section_means(const State& shape, const Annotation& part, const std::vector<int>& vertices,
                                    const Vector3d& direction, double first, double last) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const int v : vertices) {
        const double t = direction.dot(shape.points.col(v));
        low = std::min(low, t), high = std::max(high, t);
    }
    constexpr int count = 6;
    std::vector<Vector3d> means;
    for (int k = 0; k < count; ++k) {
        const double level = low + (high - low) * (first + (last - first) * k / (count - 1));
        Vector3d sum = Vector3d::Zero();
        double length = 0;
        for (const Index f : part.faces) {
            std::vector<Vector3d> ends;
            const auto corner = corners(shape.mesh, Face(f));
            for (std::size_t i = 0; i < 3; ++i) {
                const Vector3d a = shape.points.col(corner[i]), b = shape.points.col(corner[(i + 1) % 3]);
                const double at = direction.dot(a) - level, to = direction.dot(b) - level;
                if ((at < 0) != (to < 0)) ends.push_back(a + (b - a) * (at / (at - to)));
            }
            if (ends.size() != 2) continue;
            const double own = (ends[1] - ends[0]).norm();
            sum += own * (ends[0] + ends[1]) / 2;
            length += own;
        }
        if (length > 0) means.push_back(sum / length);
    }
    return means;
}

/// On a coarse mesh the means of few vertices may lie on an axis that the surface does not have. If sections of the part, or of
/// its half next to the reference, contradict the stations, the verdict becomes unknown.
void doubt_stations(const ConstraintMembers& members, const State& deformed, const AxisSegment& segment, const Axis& reference,
                    Measured& measured) {
    if (measured.verdict != Verdict::holds) return;
    const std::vector<Vector3d> stations = stations_of(segment, deformed.points);
    const Vector3d point = eigen(reference.point);
    Vector3d direction = eigen(reference.direction).normalized();
    if (direction.dot(stations.back() - stations.front()) < 0) direction = -direction;  // away from the reference
    for (const double end : {0.9, 0.5}) {
        const std::vector<Vector3d> means = section_means(deformed, members.member(0), segment.vertices, direction, 0.1, end);
        if (means.size() < 3) continue;
        Vector3d along = Vector3d::Zero(), middle = Vector3d::Zero();
        for (const Vector3d& mean : means) middle += mean / static_cast<double>(means.size());
        for (const Vector3d& mean : means) along += (mean - middle) * direction.dot(mean - middle);  // regression on the way
        const double angle = std::atan2(direction.cross(along).norm(), std::abs(direction.dot(along))) / degree;
        const double distance = direction.cross(middle - point).norm();  // single ones are drawn aside by joints
        if (angle <= *measured.deviations[0].tolerance && distance <= *measured.deviations[1].tolerance) continue;
        const std::string& unit = members.shape().annotations.unit;
        measured.verdict = Verdict::unknown;
        measured.text += (measured.text.empty() ? "" : "; ") + std::string("plane sections of '") +
                         printable(members.member(0).tag, 60) + (end < 0.9 ? "', in the half next to the reference," : "'") +
                         " are " + digits(angle, 2) + " degrees and " + digits(distance, 3) + (unit.empty() ? "" : " " + unit) +
                         " off the axis: refine the mesh, it is too coarse to tell";
        return;
    }
}

}  // namespace

Statement structural_continuity(const MembersPtr& members, const spec::StructuralContinuity& spec,
                                const RelationOptions& tolerances) {
    members->need(2, 2);
    members->need_region(0);
    const Axis rest = axis_of(*members, 1, steadiest);
    const auto segment = std::make_shared<const AxisSegment>(
        continuing_segment(members->shape().mesh, members->member(0), members->member(1), rest.direction, spec.angle));
    const Deviation angle{"angle", 0.0, tolerances.angle, "degree"};
    Statement statement;
    // If the shape is judged alone, a part that deviates from the axis at once, and as a whole, does not continue the
    // reference.
    if (const Axis own = axis_of_part(members->shape().mesh, members->member(0));
        members->shape().alone && segment->is_empty && own.found) {
        const Vector3d along = eigen(own.direction), direction = eigen(rest.direction);
        Deviation turned = angle;
        turned.value = std::atan2(direction.cross(along).norm(), std::abs(direction.dot(along))) / degree;
        statement.measure = [turned](const State&) { return verdict_of({turned}); };
        if (*turned.value > tolerances.angle) return statement;
    }
    if (!segment->reason.empty())
        members->fail("annotation " + std::to_string(members->member(0).id) + " " + segment->reason,
                      "raise angle, refine the mesh, or state co-axiality");
    statement.follows = statement.left_alone = true;
    statement.lower = [members, rest, segment](const State&, const State& now) {
        const Axis reference = reference_now(*members, rest, now, steadiest);
        return only(members->make(
            kinds::AxisOnLine{eigen(reference.direction), eigen(reference.point), segment->stations, segment->shares},
            segment->vertices));
    };
    // The axis is constrained and the surface follows. The part may rotate, which displacements from neighbours would prevent.
    statement.rotating = members->vertices(0);
    // The reference is fixed, otherwise both would tilt further in each pass. Vertices of the reference that also belong to the
    // part may move.
    const std::set<Index> own(statement.rotating.begin(), statement.rotating.end());
    for (const Index v : members->vertices(1))
        if (own.count(v) == 0) statement.referred.push_back(v);
    statement.support = [members, rotating = statement.rotating](const State& edited, const State&) {
        const Mesh& mesh = members->shape().mesh;
        // The shape at rest, scaled if the edit changes the volume of the whole object.
        const double ratio = volume(mesh, edited.points) / volume(mesh, members->shape().rest);
        const double grown = ratio > 0.01 && ratio < 100 ? std::cbrt(ratio) : 1;
        return keep_vertex_stars(*members, rotating, members->shape().rest, grown);
    };
    statement.prepare = [members, rest, segment, part = statement.rotating](const State& now, Points& start) {
        const Axis reference = reference_now(*members, rest, now, steadiest);
        const Vector3d point = eigen(reference.point), direction = eigen(reference.direction);
        const Points& shape = members->shape().rest;
        const std::vector<Vector3d> then = stations_of(*segment, shape);
        std::vector<Vector3d> there = stations_of(*segment, now.points);
        for (Vector3d& station : there) station = point + direction * direction.dot(station - point);
        const Vector3d was = then.back() - then.front(), is = there.back() - there.front();
        if (!(was.norm() > 0 && is.norm() > 0)) return;
        const Eigen::Quaterniond rotation = rotation_between(was, is);
        // Beyond the segment the part moves with its end.
        std::vector<int> station(static_cast<std::size_t>(shape.cols()), segment->count - 1);
        std::vector<double> share(station.size(), 0);
        for (std::size_t i = 0; i < segment->vertices.size(); ++i) {
            station[static_cast<std::size_t>(segment->vertices[i])] = segment->stations[i];
            share[static_cast<std::size_t>(segment->vertices[i])] = segment->shares[i];
        }
        for (const Index v : part) {
            const auto s = static_cast<std::size_t>(station[v]), next = std::min(s + 1, then.size() - 1);
            const Vector3d from = (1 - share[v]) * then[s] + share[v] * then[next],
                           to = (1 - share[v]) * there[s] + share[v] * there[next];
            start.col(v) = to + rotation * (shape.col(v) - from);
        }
    };
    const Deviation distance{"distance", 0.0, length_tolerance(*members, tolerances), members->shape().annotations.unit};
    statement.measure = [=](const State& deformed) -> Measured {
        const Axis reference = steadiest(deformed.mesh, members->member(1));
        if (!reference.found) return {Verdict::unknown, {}, "the reference has no axis any more: " + reference.reason};
        const std::vector<Vector3d> places = stations_of(*segment, deformed.points);
        const Vector3d direction = eigen(reference.direction), along = places.back() - places.front();
        Deviation turned = angle, off = distance;
        turned.value = std::atan2(direction.cross(along).norm(), std::abs(direction.dot(along))) * 180 / pi;
        for (const Vector3d& place : places)
            off.value = std::max(*off.value, direction.cross(place - eigen(reference.point)).norm());
        Measured measured = verdict_of({turned, off});
        doubt_stations(*members, deformed, *segment, reference, measured);
        return measured;
    };
    return statement;
}

}  // namespace ostraka::semantic
