// Parts whose axes depend on those of others. The last member is the reference, whose axis is taken as it stands.
#include "continuity.h"
#include "reader.h"

#include "ostraka/relation/geometric.h"

namespace ostraka::semantic {

namespace {

Axis axis_of(const Reader& read, std::size_t i) {
    read.need_region(i);
    Axis found = axis_of_part(read.shape().mesh, read.member(i));
    if (!found.found)
        read.fail("annotation " + std::to_string(read.member(i).id) + " has no axis: " + found.reason, "use another relation");
    return found;
}

/// The reference's axis on the shape as it is, or at rest where a deformed reference has none any more.
Axis reference_now(const Reader& read, const Axis& rest, const State& now) {
    Axis found = axis_of_part(now.mesh, read.member(read.members() - 1));
    return found.found ? found : rest;
}

std::vector<int> ids_of(const std::vector<Index>& vertices) { return {vertices.begin(), vertices.end()}; }

}  // namespace

Statement co_axiality(const ReaderPtr& read, const RelationOptions& tolerances) {
    read->need(2, 0);
    std::vector<Axis> axes;
    for (std::size_t i = 0; i < read->members(); ++i) axes.push_back(axis_of(*read, i));
    Statement statement;
    statement.follows = true;
    statement.lower = [read, axes](const State& now) {
        const Axis reference = reference_now(*read, axes.back(), now);
        Statement::Constraints list;
        for (std::size_t i = 0; i + 1 < axes.size(); ++i) {
            ConstraintParameters parameters;
            parameters.direction = eigen(reference.direction);
            parameters.point = eigen(reference.point);
            parameters.rest_direction = eigen(axes[i].direction);
            parameters.rest_point = eigen(axes[i].point);
            list.push_back(read->make("CoAxiality", ids_of(read->vertices(i)), parameters));
        }
        return list;
    };
    statement.measure = as_related(read, read->relationship(), tolerances);
    return statement;
}

Statement axis_angle(const ReaderPtr& read, const RelationOptions& tolerances) {
    read->need(2, 0);
    std::vector<Axis> axes;
    for (std::size_t i = 0; i < read->members(); ++i) axes.push_back(axis_of(*read, i));
    const double angle = read->relationship().type == "perpendicular axes" ? M_PI / 2 : 0;
    Statement statement;
    statement.follows = true;
    statement.lower = [read, axes, angle](const State& now) {
        ConstraintParameters parameters;
        parameters.direction = eigen(reference_now(*read, axes.back(), now).direction);
        parameters.min = parameters.max = angle;
        Statement::Constraints list;
        for (std::size_t i = 0; i + 1 < axes.size(); ++i) {
            parameters.rest_direction = eigen(axes[i].direction);
            list.push_back(read->make("AxisDirection", ids_of(read->vertices(i)), parameters));
        }
        return list;
    };
    statement.measure = as_related(read, read->relationship(), tolerances);
    return statement;
}

Statement structural_continuity(const ReaderPtr& read, const RelationOptions& tolerances) {
    read->need(2, 2);
    read->need_region(0);
    const Axis rest = axis_of(*read, 1);
    const auto segment = std::make_shared<const AxisSegment>(continuing_segment(
        read->shape().mesh, read->member(0), read->member(1), rest.direction, read->number("angle", 10, 0.1, 90)));
    if (!segment->reason.empty())
        read->fail("annotation " + std::to_string(read->member(0).id) + " " + segment->reason,
                   "raise angle, or state co-axiality");
    Statement statement;
    statement.follows = true;
    statement.lower = [read, rest, segment](const State& now) {
        const Axis reference = reference_now(*read, rest, now);
        ConstraintParameters parameters;
        parameters.direction = eigen(reference.direction);
        parameters.point = eigen(reference.point);
        parameters.stations = segment->stations;
        parameters.coefficients = segment->shares;
        Statement::Constraints list;
        list.push_back(read->make("AxisOnLine", segment->vertices, parameters));
        return list;
    };
    const Deviation angle{"angle", 0.0, tolerances.angle, "degree"};
    const Deviation distance{"distance", 0.0, length_tolerance(*read, tolerances), read->shape().set.unit};
    statement.measure = [=](const State& deformed) -> Measured {
        const Axis reference = axis_of_part(deformed.mesh, read->member(1));
        if (!reference.found) return {Verdict::unknown, {}, "the reference has no axis any more: " + reference.reason};
        const std::vector<Vector3d> places = stations_of(*segment, deformed.points);
        const Vector3d direction = eigen(reference.direction), along = places.back() - places.front();
        Deviation turned = angle, off = distance;
        turned.value = std::atan2(direction.cross(along).norm(), std::abs(direction.dot(along))) * 180 / M_PI;
        for (const Vector3d& place : places)
            off.value = std::max(*off.value, direction.cross(place - eigen(reference.point)).norm());
        return verdict_of({turned, off});
    };
    return statement;
}

}  // namespace ostraka::semantic
