#include "statement.h"

#include "reader.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/text.h"
#include "ostraka/relation/geometric.h"

#include <map>

namespace ostraka::semantic {

namespace {

using Understanding = Statement (*)(const ReaderPtr&, const RelationOptions&);
const std::map<std::string, Understanding>& table() {
    static const std::map<std::string, Understanding> rows{
        {"keep shape", keep_shape},         {"same level", same_level},         {"co-axiality", co_axiality},
        {"parallel axes", axis_angle},      {"perpendicular axes", axis_angle}, {"structural continuity", structural_continuity},
        {"proportion", proportion},         {"keep measure", keep_measure},     {"same measure", same_measure},
        {"co-planarity", co_planarity},     {"co-linearity", co_linearity},     {"mirror symmetry", mirror_symmetry},
        {"adjacency", adjacency},           {"containment", selections_kept},   {"equal selections", selections_kept},
        {"horizontal support", support},    {"side contact", contact},          {"part similarity", part_similarity},
        {"equal attributes", same_measure}, {"same length", same_length},       {"keep direction", keep_direction},
        {"keep position", keep_position},
    };
    return rows;
}

}  // namespace

std::vector<int> star_of(const Mesh& mesh, Vertex vertex, int first) {
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

std::function<Measured(const State&)> as_related(const ReaderPtr& read, Relationship stated, const RelationOptions& tolerances) {
    stated.is_constraint = false;
    // Distance tolerances are relative to the diagonal at rest, independent of the current size.
    const double diagonal = box_diagonal(read->shape().mesh);
    return [read, stated, given = tolerances, diagonal](const State& deformed) -> Measured {
        RelationOptions at_rest = given;
        if (const double now = box_diagonal(deformed.mesh); now > 0)
            at_rest.distance = std::min(1.0, given.distance * diagonal / now);
        const RelationCheck check = RelationMeter(deformed.mesh, read->shape().set, at_rest).measure(stated);
        return {check.verdict, check.parameters.deviations, check.text};
    };
}

double length_tolerance(const Reader& read, const RelationOptions& tolerances) {
    return tolerances.distance * box_diagonal(read.shape().mesh);
}

Statement understand(const Shape& shape, const Relationship& relationship, const RelationOptions& tolerances,
                     const std::string& where) {
    const auto row = table().find(relationship.type);
    const auto read = std::make_shared<const Reader>(shape, relationship, where);
    Statement statement;
    if (row != table().end()) {
        statement = row->second(read, tolerances);
    } else if (low_level_kind(relationship.type) != nullptr) {
        statement = low_level(read, tolerances);
    } else {
        statement.unknown = "deformation does not know this type";
        return statement;
    }
    statement.hard = read->flag("hard");
    statement.left_alone = statement.left_alone || (statement.hard && !statement.sized.empty() && !read->follows());
    read->refuse_others();
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
