// Relations between parts that a deformation preserves, and position and direction of single parts.
#include "reader.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/axis/axis.h"
#include "ostraka/core/angles.h"
#include "ostraka/relation/geometric.h"

namespace ostraka::semantic {

namespace {

/// For relations that follow from the selections and do not change with the shape.
Statement nothing_to_solve(const ReaderPtr& read, const RelationOptions& tolerances) {
    Statement statement;
    statement.lower = [](const State&, const State&) { return Statement::Constraints(); };
    RelationGraph graph;
    graph.relationships.push_back(read->relationship());
    graph.relationships.back().is_constraint = false;
    graph.relationships.back().constraint.clear();
    graph.relationships.back().directed = read->relationship().type == "containment";
    const RelationCheck check = check_relations(read->shape().mesh, read->shape().set, graph, tolerances).at(0);
    statement.measure = [check](const State&) -> Measured {
        return {check.verdict, check.parameters.deviations,
                check.text.empty() ? "selections do not change with the shape" : check.text};
    };
    return statement;
}

/// Vertices shared by two parts.
std::vector<Index> common_outline(const Reader& read) {
    const auto first = read.vertices(0), second = read.vertices(1);
    std::vector<Index> shared;
    std::set_intersection(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(shared));
    if (shared.size() < 3) read.fail("has parts without a common outline", "use parts that share one, or state adjacency");
    return shared;
}

/// Rotates the common outline of two parts rigidly until the angle between its normal and up is in the range; it is the normal
/// that relations measure.
Statement outline_at_angle(const ReaderPtr& read, const RelationOptions& tolerances, double min, double max) {
    read->need(2, 2);
    const std::vector<Index> shared = common_outline(*read);
    ConstraintParameters parameters;
    parameters.direction = read->up();
    parameters.min = min;
    parameters.max = max;
    Relationship stated = read->relationship();
    stated.is_constraint = false;
    stated.parameters.up = {(*parameters.direction)[0], (*parameters.direction)[1], (*parameters.direction)[2]};
    Statement statement;
    statement.follows = statement.until_it_holds = true;
    statement.lower = [=](const State& edited, const State& now) {
        ConstraintParameters given = parameters;
        given.rest_direction = normal_of(read->shape().rest, shared);
        if (const auto plane = RelationMeter(now.mesh, read->shape().set, tolerances).measure(stated).parameters.plane)
            given.rest_direction = motion_back(*read, shared, now).rotation *
                                   Vector3d(plane->direction[0], plane->direction[1], plane->direction[2]);
        given.target = columns_at(edited.points, shared);
        return only(read->make("AxisDirection", ids_of(shared), given));
    };
    statement.measure = as_related(read, stated, tolerances);
    return statement;
}

/// Share of the tolerance used, so that the result is well within it.
constexpr double well_within = 0.5;

/// The vertices along the only polyline of a member.
std::vector<int> only_polyline(const Reader& read, std::size_t i) {
    const Annotation& line = read.member(i);
    if (line.polylines.size() != 1)
        read.fail("annotation " + std::to_string(line.id) + " is not one poly-line",
                  "use lines of one piece, or state 'same measure' of tapes");
    return ids_of(line.polylines.front());
}

double length_along(const std::vector<int>& way, const Points& points) {
    double sum = 0;
    for (std::size_t i = 1; i < way.size(); ++i) sum += (points.col(way[i]) - points.col(way[i - 1])).norm();
    return sum;
}

}  // namespace

Statement selections_kept(const ReaderPtr& read, const RelationOptions& tolerances) {
    read->need(2, read->relationship().type == "containment" ? 2 : 0);
    return nothing_to_solve(read, tolerances);
}

Statement support(const ReaderPtr& read, const RelationOptions& tolerances) {
    return outline_at_angle(read, tolerances, 0, well_within * tolerances.tilt * pi / 180);
}

Statement contact(const ReaderPtr& read, const RelationOptions& tolerances) {
    return outline_at_angle(read, tolerances, pi / 2 - well_within * tolerances.tilt * pi / 180, pi / 2);
}

Statement part_similarity(const ReaderPtr& read, const RelationOptions& tolerances) {
    read->need(2, 0);
    std::vector<double> at_rest;
    for (std::size_t i = 0; i < read->members(); ++i) {
        read->need_region(i);
        at_rest.push_back(area_of(read->shape().mesh, read->member(i)));
    }
    for (const double area : at_rest)
        if (!(area > 0)) read->fail("has a part without area", "use other parts");
    read->read_leader();
    Statement statement;
    statement.resizes = true;
    statement.follows = true;
    // All parts keep their shape at rest up to a common scale factor: that of the leader, otherwise the mean of their current
    // factors.
    statement.lower = [=](const State& edited, const State& now) {
        const auto leader = read->leader(edited);
        const auto growth = [&](const State& state, std::size_t i) {
            return std::sqrt(area_of(state.mesh, read->member(i)) / at_rest[i]);
        };
        double factor = leader ? growth(edited, *leader) : 0;
        if (!leader)
            for (std::size_t i = 0; i < at_rest.size(); ++i) factor += growth(now, i) / static_cast<double>(at_rest.size());
        Statement::Constraints list;
        for (std::size_t i = 0; i < at_rest.size(); ++i) {
            if (i == leader) {
                list.push_back(read->as_edited(i, edited));
                continue;
            }
            ConstraintParameters parameters;
            parameters.min = parameters.max = factor;
            list.push_back(read->make("Similarity", ids_of(read->vertices(i)), parameters));
        }
        return list;
    };
    statement.measure = as_related(read, read->relationship(), tolerances);
    return statement;
}

Statement same_length(const ReaderPtr& read, const RelationOptions& tolerances) {
    read->need(2, 0);
    std::vector<std::vector<int>> ways;
    for (std::size_t i = 0; i < read->members(); ++i) ways.push_back(only_polyline(*read, i));
    const auto mean = [ways](const Points& points) {
        double sum = 0;
        for (const auto& way : ways) sum += length_along(way, points);
        return sum / static_cast<double>(ways.size());
    };
    if (!(mean(read->shape().rest) > 0)) read->fail("has lines without length", "use other lines");
    read->read_leader();
    Statement statement;
    statement.follows = statement.until_it_holds = true;
    statement.lower = [=](const State& edited, const State& now) {
        const auto leader = read->leader(edited);
        ConstraintParameters parameters;
        parameters.min = parameters.max = leader ? length_along(ways[*leader], edited.points) : mean(now.points);
        parameters.absolute = true;
        Statement::Constraints list;
        for (std::size_t i = 0; i < ways.size(); ++i)
            list.push_back(i == leader ? read->as_edited(i, edited) : read->make("PolylineLength", ways[i], parameters));
        return list;
    };
    const Deviation tolerance{"difference from their mean", 0.0, tolerances.ratio, "%"};
    statement.measure = [=](const State& deformed) {
        Deviation worst = tolerance;
        const double size = mean(deformed.points);
        for (const auto& way : ways)
            worst.value = std::max(*worst.value, size > 0 ? 100 * std::abs(length_along(way, deformed.points) / size - 1) : 1e9);
        return verdict_of({worst});
    };
    return statement;
}

Statement keep_direction(const ReaderPtr& read, const RelationOptions& tolerances) {
    read->need(1, 0);
    const Vector3d up = read->up();
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
    const double given = read->has("angle") ? read->number("angle", 0, 0, 90) : -1;
    for (std::size_t i = 0; i < read->members(); ++i) {
        read->need_region(i);
        const Axis axis = axis_of_part(read->shape().mesh, read->member(i));
        if (!axis.found)
            read->fail("annotation " + std::to_string(read->member(i).id) + " has no axis: " + axis.reason,
                       "name a part that has one");
        parts.push_back({read->vertices(i), axis, given >= 0 ? given * pi / 180 : angle_to(axis)});
    }
    Statement statement;
    if (given < 0) statement.keeps = "its direction";
    for (std::size_t i = 0; i < parts.size(); ++i) statement.directions.push_back({read->member(i).id, up, parts[i].angle});
    statement.follows = true;
    let_turn(read, parts.size(), statement);
    statement.lower = [=](const State& edited, const State& now) {
        Statement::Constraints list;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            ConstraintParameters own;
            own.direction = up;
            own.rest_direction = eigen(axis_carried_back(*read, i, parts[i].axis, now).direction);
            own.min = own.max = parts[i].angle;
            own.target = columns_at(edited.points, parts[i].vertices);
            list.push_back(read->make("AxisDirection", ids_of(parts[i].vertices), own));
        }
        return list;
    };
    const Deviation angle{"angle", 0.0, tolerances.angle, "degree"};
    statement.measure = [=](const State& deformed) -> Measured {
        Deviation worst = angle;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const Axis axis = axis_of_part(deformed.mesh, read->member(i));
            if (!axis.found) return {Verdict::unknown, {}, "a part has no axis any more: " + axis.reason};
            worst.value = std::max(*worst.value, std::abs(angle_to(axis) - parts[i].angle) / degree);
        }
        Measured measured = verdict_of({worst});
        if (given >= 0) doubt_axes(*read, deformed, tolerances.angle, measured);  // otherwise axis errors cancel
        return measured;
    };
    return statement;
}

Statement keep_position(const ReaderPtr& read, const RelationOptions& tolerances) {
    read->need(1, 1);
    const std::vector<Index> vertices = read->vertices(0);
    const Vector3d place = read->vector("point").value_or(mean_of(vertices, read->shape().rest));
    Statement statement;
    if (!read->has("point")) statement.keeps = "its place";
    statement.lower = [=](const State&, const State&) {
        ConstraintParameters parameters;
        parameters.point = place;
        return only(read->make("MeanPosition", ids_of(vertices), parameters, static_cast<double>(vertices.size())));
    };
    // The part, in its shape after the edit, is translated as a whole, as far as other constraints allow.
    statement.support = [=](const State& edited, const State&) {
        ConstraintParameters parameters;
        const Vector3d way = place - mean_of(vertices, edited.points);
        parameters.target.emplace(3, static_cast<Eigen::Index>(vertices.size()));
        for (std::size_t i = 0; i < vertices.size(); ++i)
            parameters.target->col(static_cast<Eigen::Index>(i)) = edited.points.col(vertices[i]) + way;
        return only(read->make("Closeness", ids_of(vertices), parameters));
    };
    const Deviation distance{"distance", 0.0, length_tolerance(*read, tolerances), read->shape().set.unit};
    statement.measure = [=](const State& deformed) {
        Deviation off = distance;
        off.value = (mean_of(vertices, deformed.points) - place).norm();
        return verdict_of({off});
    };
    return statement;
}

}  // namespace ostraka::semantic
