// Relations between parts that a deformation preserves, and position and direction of single parts.
#include "semantic/statements.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/axis/axis.h"
#include "ostraka/core/angles.h"
#include "ostraka/relation/geometric.h"

namespace ostraka::semantic {

namespace {

/// For relations that follow from the selections and do not change with the shape.
Statement nothing_to_solve(const MembersPtr& members, const RelationOptions& tolerances) {
    Statement statement;
    statement.lower = [](const State&, const State&) { return Statement::Constraints(); };
    RelationGraph graph;
    graph.relationships.push_back(members->relationship());
    graph.relationships.back().is_constraint = false;
    graph.relationships.back().constraint.clear();
    graph.relationships.back().directed = members->relationship().type == "containment";
    const RelationCheck check = check_relations(members->shape(), graph, tolerances).at(0);
    statement.measure = [check](const State&) -> Measured {
        return {check.verdict, check.parameters.deviations,
                check.text.empty() ? "selections do not change with the shape" : check.text};
    };
    return statement;
}

/// Vertices shared by two parts.
std::vector<Index> common_outline(const ConstraintMembers& members) {
    const auto first = members.vertices(0), second = members.vertices(1);
    std::vector<Index> shared;
    std::set_intersection(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(shared));
    if (shared.size() < 3) members.fail("has parts without a common outline", "use parts that share one, or state adjacency");
    return shared;
}

/// Rotates the common outline of two parts rigidly until the angle between its normal and up is in the range; it is the normal
/// that relations measure.
Statement outline_at_angle(const MembersPtr& members, const spec::Upward& spec, const RelationOptions& tolerances, double min,
                           double max) {
    members->need(2, 2);
    const std::vector<Index> shared = common_outline(*members);
    const Vector3d up = members->up(spec.up);
    Relationship stated = members->relationship();
    stated.is_constraint = false;
    stated.parameters.up = {up[0], up[1], up[2]};
    Statement statement;
    statement.follows = statement.until_it_holds = true;
    statement.lower = [=](const State& edited, const State& now) {
        Vector3d normal = normal_of(members->shape().rest, shared);
        if (const auto plane =
                RelationMeter({now.mesh, members->shape().annotations}, tolerances).measure(stated).parameters.plane)
            normal = motion_back(*members, shared, now).rotation *
                     Vector3d(plane->direction[0], plane->direction[1], plane->direction[2]);
        return only(
            members->make(kinds::AxisDirection{up, {min, max}, normal, columns_at(edited.points, shared)}, ids_of(shared)));
    };
    statement.measure = as_related(members, stated, tolerances);
    return statement;
}

/// Share of the tolerance used, so that the result is well within it.
constexpr double well_within = 0.5;

/// The vertices along the only polyline of a member.
std::vector<int> only_polyline(const ConstraintMembers& members, std::size_t i) {
    const Annotation& line = members.member(i);
    if (line.polylines.size() != 1)
        members.fail("annotation " + std::to_string(line.id) + " is not one poly-line",
                     "use lines of one piece, or state 'same measure' of tapes");
    return ids_of(line.polylines.front());
}

double length_along(const std::vector<int>& way, const Points& points) {
    double sum = 0;
    for (std::size_t i = 1; i < way.size(); ++i) sum += (points.col(way[i]) - points.col(way[i - 1])).norm();
    return sum;
}

}  // namespace

Statement selections_kept(const MembersPtr& members, const spec::None&, const RelationOptions& tolerances) {
    members->need(2, members->relationship().type == "containment" ? 2 : 0);
    return nothing_to_solve(members, tolerances);
}

Statement support(const MembersPtr& members, const spec::Upward& spec, const RelationOptions& tolerances) {
    return outline_at_angle(members, spec, tolerances, 0, well_within * tolerances.tilt * pi / 180);
}

Statement contact(const MembersPtr& members, const spec::Upward& spec, const RelationOptions& tolerances) {
    return outline_at_angle(members, spec, tolerances, pi / 2 - well_within * tolerances.tilt * pi / 180, pi / 2);
}

Statement part_similarity(const MembersPtr& members, const spec::Alike& spec, const RelationOptions& tolerances) {
    members->need(2, 0);
    std::vector<double> at_rest;
    for (std::size_t i = 0; i < members->count(); ++i) {
        members->need_region(i);
        at_rest.push_back(area_of(members->shape().mesh, members->member(i)));
    }
    for (const double area : at_rest)
        if (!(area > 0)) members->fail("has a part without area", "use other parts");
    members->check_leader(spec.leader);
    Statement statement;
    statement.resizes = true;
    statement.follows = true;
    // All parts keep their shape at rest up to a common scale factor: that of the leader, otherwise the mean of their current
    // factors.
    statement.lower = [=](const State& edited, const State& now) {
        const auto leader = members->leader(spec.leader, edited);
        const auto growth = [&](const State& state, std::size_t i) {
            return std::sqrt(area_of(state.mesh, members->member(i)) / at_rest[i]);
        };
        double factor = leader ? growth(edited, *leader) : 0;
        if (!leader)
            for (std::size_t i = 0; i < at_rest.size(); ++i) factor += growth(now, i) / static_cast<double>(at_rest.size());
        Statement::Constraints list;
        for (std::size_t i = 0; i < at_rest.size(); ++i) {
            if (i == leader) {
                list.push_back(members->as_edited(i, edited));
                continue;
            }
            list.push_back(members->make(kinds::Similarity{{factor, factor}}, ids_of(members->vertices(i))));
        }
        return list;
    };
    statement.measure = as_related(members, members->relationship(), tolerances);
    return statement;
}

Statement same_length(const MembersPtr& members, const spec::Alike& spec, const RelationOptions& tolerances) {
    members->need(2, 0);
    std::vector<std::vector<int>> ways;
    for (std::size_t i = 0; i < members->count(); ++i) ways.push_back(only_polyline(*members, i));
    const auto mean = [ways](const Points& points) {
        double sum = 0;
        for (const auto& way : ways) sum += length_along(way, points);
        return sum / static_cast<double>(ways.size());
    };
    if (!(mean(members->shape().rest) > 0)) members->fail("has lines without length", "use other lines");
    members->check_leader(spec.leader);
    Statement statement;
    statement.follows = statement.until_it_holds = true;
    statement.lower = [=](const State& edited, const State& now) {
        const auto leader = members->leader(spec.leader, edited);
        const double length = leader ? length_along(ways[*leader], edited.points) : mean(now.points);
        Statement::Constraints list;
        for (std::size_t i = 0; i < ways.size(); ++i)
            list.push_back(i == leader ? members->as_edited(i, edited)
                                       : members->make(kinds::PolylineLength{{length, length}, true}, ways[i]));
        return list;
    };
    const Deviation tolerance{"difference from their mean", 0.0, tolerances.max_difference, "%"};
    statement.measure = [=](const State& deformed) {
        Deviation worst = tolerance;
        const double size = mean(deformed.points);
        for (const auto& way : ways)
            worst.value = std::max(*worst.value, size > 0 ? 100 * std::abs(length_along(way, deformed.points) / size - 1) : 1e9);
        return verdict_of({worst});
    };
    return statement;
}

Statement keep_direction(const MembersPtr& members, const spec::KeepDirection& spec, const RelationOptions& tolerances) {
    members->need(1, 0);
    const Vector3d up = members->up(spec.up);
    struct Part {
        std::vector<Index> vertices;
        Axis axis;
        double angle;
    };
    const auto angle_to = [up](const Axis& axis) {
        const Vector3d direction = eigen(axis.direction);
        return std::atan2(direction.cross(up).norm(), std::abs(direction.dot(up)));
    };
    std::vector<Part> parts;
    for (std::size_t i = 0; i < members->count(); ++i) {
        members->need_region(i);
        const Axis axis = axis_of_part(members->shape().mesh, members->member(i));
        if (!axis.found)
            members->fail("annotation " + std::to_string(members->member(i).id) + " has no axis: " + axis.reason,
                          "name a part that has one");
        parts.push_back({members->vertices(i), axis, spec.angle ? *spec.angle * pi / 180 : angle_to(axis)});
    }
    Statement statement;
    if (!spec.angle) statement.keeps = "its direction";
    for (std::size_t i = 0; i < parts.size(); ++i) statement.directions.push_back({members->member(i).id, up, parts[i].angle});
    statement.follows = true;
    allow_rotation(members, parts.size(), statement);
    statement.lower = [=](const State& edited, const State& now) {
        Statement::Constraints list;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const Part& part = parts[i];
            list.push_back(members->make(kinds::AxisDirection{up,
                                                              {part.angle, part.angle},
                                                              eigen(axis_carried_back(*members, i, part.axis, now).direction),
                                                              columns_at(edited.points, part.vertices)},
                                         ids_of(part.vertices)));
        }
        return list;
    };
    const Deviation angle{"angle", 0.0, tolerances.angle, "degree"};
    statement.measure = [=](const State& deformed) -> Measured {
        Deviation worst = angle;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const Axis axis = axis_of_part(deformed.mesh, members->member(i));
            if (!axis.found) return {Verdict::unknown, {}, "a part has no axis any more: " + axis.reason};
            worst.value = std::max(*worst.value, std::abs(angle_to(axis) - parts[i].angle) / degree);
        }
        Measured measured = verdict_of({worst});
        if (spec.angle) doubt_axes(*members, deformed, tolerances.angle, measured);  // otherwise axis errors cancel
        return measured;
    };
    return statement;
}

Statement keep_position(const MembersPtr& members, const spec::KeepPosition& spec, const RelationOptions& tolerances) {
    members->need(1, 1);
    const std::vector<Index> vertices = members->vertices(0);
    const Vector3d place = spec.place.value_or(mean_of(vertices, members->shape().rest));
    Statement statement;
    if (!spec.place) statement.keeps = "its place";
    statement.lower = [=](const State&, const State&) {
        return only(members->make(kinds::MeanPosition{place}, ids_of(vertices), static_cast<double>(vertices.size())));
    };
    // The part, in its shape after the edit, is translated as a whole, as far as other constraints allow.
    statement.support = [=](const State& edited, const State&) {
        const Vector3d way = place - mean_of(vertices, edited.points);
        return only(members->make(kinds::Closeness{columns_at(edited.points, vertices).colwise() + way}, ids_of(vertices)));
    };
    const Deviation distance{"distance", 0.0, length_tolerance(*members, tolerances), members->shape().annotations.unit};
    statement.measure = [=](const State& deformed) {
        Deviation off = distance;
        off.value = (mean_of(vertices, deformed.points) - place).norm();
        return verdict_of({off});
    };
    return statement;
}

}  // namespace ostraka::semantic
