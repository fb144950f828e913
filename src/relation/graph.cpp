// Types of relationships, and validation of graphs.
#include "ostraka/relation/graph.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/nearest_name.h"
#include "ostraka/core/text.h"
#include "ostraka/mesh/ids.h"

#include <cmath>
#include <limits>
#include <set>
#include <tuple>

namespace ostraka {

const std::vector<RelationType>& relation_types() {
    static const std::vector<RelationType> types = [] {
        using enum GeometricRelation;
        std::vector<RelationType> list{
            {"containment", 2, 2, containment, true},
            {"equal selections", 2, 0, equal_selections},
            {"adjacency", 2, 2, adjacency},
            {"mirror symmetry", 1, 2, mirror_symmetry, false, {"distance"}},
            {"co-axiality", 2, 0, co_axiality, false, {"angle", "distance"}},
            {"co-linearity", 1, 0, co_linearity, false, {"distance"}},
            {"co-planarity", 1, 0, co_planarity, false, {"distance"}},
            {"same level", 2, 0, same_level, false, {"height"}},
            {"parallel axes", 2, 0, parallel_axes, false, {"angle"}},
            {"perpendicular axes", 2, 2, perpendicular_axes, false, {"angle"}},
            {"horizontal support", 2, 2, horizontal_support, true, {"tilt", "height"}},
            {"side contact", 2, 2, side_contact, false, {"tilt"}},
            {"part similarity", 2, 0, part_similarity, false, {"area", "shape"}},
            {"equal attributes", 2, 0, equal_attributes, false, {"difference"}},
        };
        // Low-level constraints of the thesis's solver (section 4.2) and the high-level constraints of chapter 5.
        for (const char* name : {"closeness",
                                 "edge strain",
                                 "triangle strain",
                                 "tetrahedron strain",
                                 "area",
                                 "volume",
                                 "bending",
                                 "line",
                                 "plane",
                                 "circle",
                                 "sphere",
                                 "similarity",
                                 "rigid",
                                 "non-uniform scaling",
                                 "orientation",
                                 "fitted-plane orientation",
                                 "equilateral",
                                 "rectangle",
                                 "parallelogram",
                                 "laplacian",
                                 "laplacian displacement",
                                 "cotangent laplacian",
                                 "cotangent laplacian displacement",
                                 "angle",
                                 "parallel",
                                 "perpendicular",
                                 "polyline length",
                                 "equal lengths",
                                 "keep shape",
                                 "keep measure",
                                 "same measure",
                                 "same length",
                                 "keep direction",
                                 "keep position",
                                 "structural continuity",
                                 "proportion"})
            list.push_back({name, 1, 0, std::nullopt});
        return list;
    }();
    return types;
}

const RelationType& relation_type(GeometricRelation kind) { return relation_types().at(static_cast<std::size_t>(kind)); }

namespace {

bool finite(const std::array<double, 3>& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

void check_direction(const std::array<double, 3>& v, const char* what, const std::string& place) {
    if (!finite(v) || v == std::array<double, 3>{0, 0, 0})
        fail_input(place, std::string("has no direction in '") + what + "'", "give three finite numbers that are not all zero");
}

void check_members(const Relationship& relationship, const AnnotationSet& set, const std::string& place) {
    std::set<int> seen;
    for (const int id : relationship.annotations) {
        if (set.find(id) == nullptr)
            fail_input(place, "names annotation " + std::to_string(id) + ", which does not exist",
                       "use ids that 'ostraka annotation list' shows");
        if (!seen.insert(id).second)
            fail_input(place, "names annotation " + std::to_string(id) + " twice", "name each annotation once");
    }
    if (relationship.annotations.empty()) fail_input(place, "has no annotations", "name those it is about");
    const RelationType* type = find_relation_type(relationship.type);
    if (type == nullptr) return;
    const std::size_t count = relationship.annotations.size();
    if (count < type->minimum || (type->maximum > 0 && count > type->maximum)) {
        const std::string minimum = std::to_string(type->minimum), maximum = std::to_string(type->maximum);
        fail_input(place, "'" + type->name + "' relates " + counted(count, "annotation"),
                   "name " + (type->maximum == 0               ? minimum + " or more"
                              : type->minimum == type->maximum ? minimum
                                                               : minimum + " to " + maximum));
    }
    if (type->geometric && relationship.directed != type->directed)
        fail_input(place, "'" + type->name + (type->directed ? "' has a direction" : "' has no direction"),
                   type->directed ? "set isDirected to true; the first annotation is the subject" : "set isDirected to false");
}

/// The content of a relationship, without origin and tolerances.
using Statement = std::tuple<std::string, std::vector<int>, bool, std::string, std::string>;

/// Whether the order of the members says something: a relation has a direction or none; of a constraint the first member is what
/// changes, or the last one is the reference, but where all are alike.
bool order_counts(const Relationship& relationship) {
    static const std::set<std::string> alike{"adjacency",     "co-linearity",     "co-planarity",   "equal attributes",
                                             "equal lengths", "equal selections", "keep direction", "keep shape",
                                             "same length",   "part similarity",  "same level",     "same measure",
                                             "side contact"};
    return relationship.directed || (relationship.is_constraint && alike.count(relationship.type) == 0);
}

Statement statement(const Relationship& relationship) {
    std::vector<int> members = relationship.annotations;
    if (!order_counts(relationship)) std::sort(members.begin(), members.end());
    std::string constraint =
        relationship.constraint.empty() ? std::string() : to_compact_text(parse_json(relationship.constraint, "constraint"));
    return {relationship.type, std::move(members), relationship.is_constraint, std::move(constraint),
            relationship.parameters.attribute};
}

}  // namespace

const RelationType* find_relation_type(const std::string& name) {
    const std::string wanted = lower_case(name);
    for (const auto& type : relation_types())
        if (type.name == wanted) return &type;
    return nullptr;
}

std::string nearest_relation_type(const std::string& name) {
    const std::string wanted = lower_case(name).substr(0, 100);
    const RelationType* best = nullptr;
    std::size_t minimum = std::numeric_limits<std::size_t>::max();
    for (const auto& type : relation_types()) {
        const std::size_t distance = edit_distance(wanted, type.name, 200);
        if (distance < minimum) minimum = distance, best = &type;
    }
    return best->name;
}

Relationship extracted_relationship(GeometricRelation kind, int id, std::vector<int> annotations) {
    Relationship relationship;
    relationship.id = id;
    relationship.type = relation_type(kind).name;
    relationship.directed = relation_type(kind).directed;
    relationship.annotations = std::move(annotations);
    relationship.origin = "extracted";
    return relationship;
}

int free_id(const RelationGraph& graph) { return next_free_id(graph.relationships); }

void check_relationship(const Relationship& relationship, const AnnotationSet& set, const std::string& place) {
    if (relationship.type.empty()) fail_input(place, "has no type", "name one");
    check_members(relationship, set, place);
    if (relationship.is_constraint && !(std::isfinite(relationship.weight) && relationship.weight >= 0))
        fail_input(place, "its weight is negative or not a number", "use a weight of 0 or more");
    if (!relationship.constraint.empty() && !parse_json(relationship.constraint, place).IsObject())
        fail_input(place, "its constraint is not a JSON object", "give the parameters as {\"name\": value, ...}");
    if (!relationship.constraint.empty() && !relationship.is_constraint)
        fail_input(place, "has a constraint, but is not marked as one", "set isConstraint to true");
    const RelationParameters& parameters = relationship.parameters;
    for (const auto& deviation : parameters.deviations) {
        if (deviation.tolerance && !(std::isfinite(*deviation.tolerance) && *deviation.tolerance >= 0))
            fail_input(place, "the tolerance of '" + deviation.quantity + "' is negative or not a number",
                       "use a tolerance of 0 or more");
        if (deviation.value && !std::isfinite(*deviation.value))
            fail_input(place, "the deviation of '" + deviation.quantity + "' is not a finite number", "leave it out");
    }
    if (parameters.plane) check_direction(parameters.plane->direction, "plane", place);
    if (parameters.axis) check_direction(parameters.axis->direction, "axis", place);
    if (parameters.up) check_direction(*parameters.up, "up", place);
    for (const auto& part : {parameters.plane, parameters.axis})
        if (part && !finite(part->point)) fail_input(place, "has a point that is not finite", "give three finite numbers");
    if (relationship.type == relation_type(GeometricRelation::equal_attributes).name && parameters.attribute.empty())
        fail_input(place, "does not say which attribute is equal", "name it in parameters.attribute");
}

const Relationship* find_equivalent(const RelationGraph& graph, const Relationship& relationship) {
    const auto wanted = statement(relationship);
    for (const auto& known : graph.relationships)
        if (statement(known) == wanted) return &known;
    return nullptr;
}

struct RelationshipIndex::Said {
    std::map<Statement, int> ids;
};

RelationshipIndex::RelationshipIndex(const RelationGraph& graph) : said_(std::make_unique<Said>()) {
    for (const auto& known : graph.relationships) said_->ids.emplace(statement(known), known.id);
}
RelationshipIndex::~RelationshipIndex() = default;

std::optional<int> RelationshipIndex::find(const Relationship& relationship) const {
    const auto found = said_->ids.find(statement(relationship));
    return found == said_->ids.end() ? std::nullopt : std::optional(found->second);
}

void check_graph(const RelationGraph& graph, const AnnotationSet& set, const std::string& where) {
    std::set<int> ids;
    std::map<Statement, int> said;
    for (const auto& relationship : graph.relationships) {
        const std::string place = where + ", relationship " + std::to_string(relationship.id);
        if (!ids.insert(relationship.id).second)
            fail_input(place, "its id is used twice", "give each relationship an id of its own");
        check_relationship(relationship, set, place);
        const auto [entry, added] = said.emplace(statement(relationship), relationship.id);
        if (!added) fail_input(place, "repeats relationship " + std::to_string(entry->second), "remove one of them");
    }
}

}  // namespace ostraka
