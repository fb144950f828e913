#include "semantic/statement.h"

#include "semantic/statements.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/text.h"
#include "ostraka/relation/geometric.h"

#include <fmt/core.h>

#include <functional>
#include <map>

namespace ostraka::semantic {

namespace {

using Understanding = std::function<Statement(const MembersPtr&, const ParameterReader&, const RelationOptions&)>;

/// Reads the parameters, all of which must be known, before the constraint is interpreted.
template <class Spec>
Understanding by(Statement (*understand)(const MembersPtr&, const Spec&, const RelationOptions&)) {
    return [understand](const MembersPtr& members, const ParameterReader& read, const RelationOptions& tolerances) {
        const bool hard = read.flag("hard");
        const Spec spec(read);
        read.refuse_others();
        Statement statement = understand(members, spec, tolerances);
        statement.hard = hard;
        bool follows = false;
        if constexpr (requires { spec.leader; }) follows = spec.leader.any;
        statement.left_alone = statement.left_alone || (hard && !statement.sized.empty() && !follows);
        return statement;
    };
}

const std::map<std::string, Understanding>& table() {
    static const std::map<std::string, Understanding> rows{
        {"keep shape", by(keep_shape)},
        {"same level", by(same_level)},
        {"co-axiality", by(co_axiality)},
        {"parallel axes", by(axis_angle)},
        {"perpendicular axes", by(axis_angle)},
        {"structural continuity", by(structural_continuity)},
        {"proportion", by(proportion)},
        {"keep measure", by(keep_measure)},
        {"same measure", by(same_measure)},
        {"co-planarity", by(co_planarity)},
        {"co-linearity", by(co_linearity)},
        {"mirror symmetry", by(mirror_symmetry)},
        {"adjacency", by(adjacency)},
        {"containment", by(selections_kept)},
        {"equal selections", by(selections_kept)},
        {"horizontal support", by(support)},
        {"side contact", by(contact)},
        {"part similarity", by(part_similarity)},
        {"equal attributes", by(same_measure)},
        {"same length", by(same_length)},
        {"keep direction", by(keep_direction)},
        {"keep position", by(keep_position)},
    };
    return rows;
}

}  // namespace

std::vector<int> vertex_star(const Mesh& mesh, Vertex vertex, int first) {
    std::vector<int> ids{first + static_cast<int>(vertex.idx())};
    for (const Vertex n : mesh.vertices_around_target(mesh.halfedge(vertex))) ids.push_back(first + static_cast<int>(n.idx()));
    return ids;
}

Measured verdict_of(std::vector<Deviation> deviations) {
    Measured result;
    result.verdict =
        std::all_of(deviations.begin(), deviations.end(), [](const Deviation& d) { return *d.value <= *d.tolerance; })
            ? Verdict::holds
            : Verdict::fails;
    result.deviations = std::move(deviations);
    return result;
}

std::function<Measured(const State&)> as_related(const MembersPtr& members, Relationship stated,
                                                 const RelationOptions& tolerances) {
    stated.is_constraint = false;
    // Distance tolerances are relative to the diagonal at rest, independent of the current size.
    const double diagonal = box_diagonal(members->shape().mesh);
    return [members, stated, given = tolerances, diagonal](const State& deformed) -> Measured {
        RelationOptions at_rest = given;
        if (const double now = box_diagonal(deformed.mesh); now > 0)
            at_rest.distance = std::min(1.0, given.distance * diagonal / now);
        const RelationCheck check = RelationMeter({deformed.mesh, members->shape().annotations}, at_rest).measure(stated);
        return {check.verdict, check.parameters.deviations, check.text};
    };
}

double length_tolerance(const ConstraintMembers& members, const RelationOptions& tolerances) {
    return tolerances.distance * box_diagonal(members.shape().mesh);
}

Statement understand(const Shape& shape, const Relationship& relationship, const RelationOptions& tolerances,
                     const std::string& where) {
    const std::string place = fmt::format("{}, constraint {} ({})", where, relationship.id, relationship.type);
    const auto members = std::make_shared<const ConstraintMembers>(shape, relationship, place);
    const ParameterReader read(relationship, place);
    if (const auto row = table().find(relationship.type); row != table().end()) return row->second(members, read, tolerances);
    Statement statement;
    if (!is_low_level(relationship.type)) {
        statement.unknown = "deformation does not know this type";
        return statement;
    }
    statement = low_level(members, read, tolerances);
    statement.hard = read.flag("hard");
    read.refuse_others();
    return statement;
}

std::string contradiction(const Statement& one, const Statement& other) {
    constexpr double exact = 1e-6;
    for (const Statement::Direction& a : one.directions)
        for (const Statement::Direction& b : other.directions) {
            if (a.annotation != b.annotation || a.reference != b.reference) continue;
            // Axes have no sign: each direction may be reversed.
            const double between = std::atan2(a.direction.cross(b.direction).norm(), a.direction.dot(b.direction));
            const auto apart = [&](double angle) {
                return angle < std::abs(a.angle - b.angle) - exact || angle > a.angle + b.angle + exact;
            };
            if (!apart(between) || !apart(pi - between)) continue;
            const auto text = [](const Statement::Direction& d) {
                const std::string degrees = digits(d.angle / degree, 4) + " degrees to ";
                if (d.reference) return degrees + "that of annotation " + std::to_string(*d.reference);
                return degrees + "(" + digits(d.direction.x(), 4) + ", " + digits(d.direction.y(), 4) + ", " +
                       digits(d.direction.z(), 4) + ")";
            };
            return "no axis of annotation " + std::to_string(a.annotation) + " is at " + text(a) + " and at " + text(b);
        }
    return {};
}

ConstraintReport report_of(const Relationship& relationship, const Statement& statement) {
    ConstraintReport report;
    report.id = relationship.id;
    report.annotations = relationship.annotations;
    report.type = relationship.type;
    report.weight = relationship.weight;
    report.hard = statement.hard;
    report.used = statement.unknown.empty() && relationship.weight > 0;
    if (!statement.unknown.empty()) report.text = "left out: " + statement.unknown;
    else if (!report.used) report.text = "left out: its weight is zero";
    return report;
}

}  // namespace ostraka::semantic
