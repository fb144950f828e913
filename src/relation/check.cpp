#include "ostraka/relation/check.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/relation/geometric.h"
#include "ostraka/relation/topology.h"

#include <set>

namespace ostraka {

std::string to_string(Verdict verdict) {
    return verdict == Verdict::holds ? "holds" : verdict == Verdict::fails ? "fails" : "unknown";
}

namespace {

using EdgeSet = std::set<std::pair<Index, Index>>;

EdgeSet edges_of(const Annotation& annotation) {
    EdgeSet edges;
    for (const auto& polyline : annotation.polylines)
        for (std::size_t i = 1; i < polyline.size(); ++i) edges.insert(std::minmax(polyline[i - 1], polyline[i]));
    return edges;
}

template <class Sorted>
std::size_t missing(const Sorted& inner, const Sorted& outer) {
    std::vector<typename Sorted::value_type> left;
    std::set_difference(inner.begin(), inner.end(), outer.begin(), outer.end(), std::back_inserter(left));
    return left.size();
}

/// Percentage of the area of `inner` outside `outer`, on a mesh cut along free outlines; shares at rounding level count as
/// zero.
double area_outside(const Mesh& mesh, const Annotation& inner, const Annotation& outer) {
    std::vector<Index> left;
    std::set_difference(inner.faces.begin(), inner.faces.end(), outer.faces.begin(), outer.faces.end(), std::back_inserter(left));
    const double whole = area_of(mesh, inner.faces), share = whole > 0 ? 100 * area_of(mesh, left) / whole : 100;
    return share < 1e-4 ? 0 : share;
}

/// Percentage of the elements of `inner` (faces, edges or vertices, by the applicable rule) that are not in `outer`; 100 if no
/// rule allows containment.
double outside(const Mesh& mesh, bool cut, const Annotation& inner, const Annotation& outer) {
    const auto share = [](std::size_t part, std::size_t whole) {
        return whole == 0 ? 100.0 : 100.0 * double(part) / double(whole);
    };
    const bool into_region = outer.type == AnnotationType::region;
    if (inner.type == AnnotationType::region && into_region && cut) return area_outside(mesh, inner, outer);
    if (inner.type == AnnotationType::region)
        return into_region ? share(missing(inner.faces, outer.faces), inner.faces.size()) : 100;
    if (inner.type == AnnotationType::line && outer.type == AnnotationType::point) return 100;
    if (inner.type == AnnotationType::line && outer.type == AnnotationType::line) {
        const EdgeSet edges = edges_of(inner);
        if (!edges.empty()) return share(missing(edges, edges_of(outer)), edges.size());
    }
    const std::vector<Index> vertices = touched_vertices(mesh, inner);
    return share(missing(vertices, touched_vertices(mesh, outer)), vertices.size());
}

void conclude(RelationCheck& check, double value, const std::string& quantity, const std::string& unit, bool holds) {
    check.parameters.deviations = {{quantity, value, {}, unit}};
    check.verdict = holds ? Verdict::holds : Verdict::fails;
}

void check_containment(const Mesh& mesh, bool cut, const std::vector<const Annotation*>& members, RelationCheck& check) {
    const double share = outside(mesh, cut, *members[1], *members[0]);
    conclude(check, share, "outside", "%", share == 0);
    if (share > 0) check.text = "part of the second lies outside of the first";
}

void check_equal_selections(const Mesh& mesh, bool cut, const std::vector<const Annotation*>& members, RelationCheck& check) {
    double share = 0;
    for (const Annotation* member : members)
        share = std::max({share, outside(mesh, cut, *member, *members[0]), outside(mesh, cut, *members[0], *member)});
    conclude(check, share, "not common", "%", share == 0);
    if (share > 0) check.text = "the selections differ";
}

using SharedLengths = std::map<std::pair<int, int>, double>;  ///< by pair of adjacent annotations

void check_adjacency(const SharedLengths& adjacent, const std::string& unit, const std::vector<const Annotation*>& members,
                     RelationCheck& check) {
    const auto entry = adjacent.find(std::minmax(members[0]->id, members[1]->id));
    const bool holds = entry != adjacent.end();
    conclude(check, holds ? entry->second : 0, "shared length", unit, holds);
    if (holds) return;
    const bool regions = members[0]->type == AnnotationType::region && members[1]->type == AnnotationType::region;
    const bool apart = regions && missing(members[0]->faces, members[1]->faces) == members[0]->faces.size();
    check.text = !regions ? "only regions are adjacent" : apart ? "their outlines share no edge" : "they have faces in common";
}

}  // namespace

std::vector<RelationCheck> check_relations(AnnotatedMeshView given, const RelationGraph& graph, const RelationOptions& options) {
    check_graph(graph, given.annotations, "graph");
    const EdgeAlignedAnnotations along_edges(given);
    const AnnotatedMeshView object = along_edges.object();
    const bool cut = along_edges.cut().has_value();
    SharedLengths stated, adjacent;  // only the pairs that occur in the graph
    for (const auto& relationship : graph.relationships)
        if (relationship.annotations.size() == 2)
            stated[std::minmax(relationship.annotations[0], relationship.annotations[1])] = 0;
    const AnnotationTopology found = topology(given);
    for (const auto& pair : found.adjacent) {
        const std::pair<int, int> ids =
            std::minmax(object.annotations.annotations[pair.a].id, object.annotations.annotations[pair.b].id);
        if (stated.contains(ids)) adjacent[ids] = pair.length;
    }
    RelationMeter meter(object, options);
    std::vector<RelationCheck> checks;
    for (const auto& relationship : graph.relationships) {
        RelationCheck& check = checks.emplace_back();
        check.parameters = relationship.parameters;
        std::vector<const Annotation*> members;
        for (const int id : relationship.annotations) members.push_back(object.annotations.find(id));
        const RelationType* type = find_relation_type(relationship.type);
        if (relationship.is_constraint) check.text = "a constraint; constraints are judged separately";
        else if (type == nullptr) check.text = "a user-defined type: only experts can judge it";
        else if (type->geometric == GeometricRelation::containment) check_containment(object.mesh, cut, members, check);
        else if (type->geometric == GeometricRelation::equal_selections) check_equal_selections(object.mesh, cut, members, check);
        else if (type->geometric == GeometricRelation::adjacency)
            check_adjacency(adjacent, object.annotations.unit, members, check);
        else check = meter.measure(relationship);
    }
    return checks;
}

void RelationOptions::declare_options(OptionList& list) {
    list("distance", distance, "tolerance of distances and of height differences", Range{0, 1}, "share of the mesh's diagonal");
    list("angle", angle, "maximum angle between axes at which a relationship holds", Range{0, 90}, "degrees");
    list("tilt", tilt, "maximum tilt of a contact's outline from horizontal (support) or vertical (side contact)", Range{0, 90},
         "degrees");
    list("max-difference", max_difference, "maximum difference of area, shape or attribute at which a relationship holds",
         Range{0, 100}, "per cent");
}

}  // namespace ostraka
