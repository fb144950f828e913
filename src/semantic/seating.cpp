#include "semantic/seating.h"

#include "semantic/reattachment.h"

#include "ostraka/files/json_build.h"
#include "ostraka/geom/eigen.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka::semantic {

namespace {

/// Whether the outline is one simple closed line.
bool is_one_loop(const Mesh& mesh, const std::vector<Halfedge>& outline) {
    std::map<Index, Index> next;
    for (const Halfedge h : outline)
        if (!next.emplace(mesh.source(h).idx(), mesh.target(h).idx()).second) return false;
    if (next.size() < 3) return false;
    std::size_t steps = 0;
    Index at = next.begin()->first;
    do {
        const auto found = next.find(at);
        if (found == next.end()) return false;
        at = found->second;
        ++steps;
    } while (at != next.begin()->first && steps <= next.size());
    return steps == next.size();
}

bool is_ornament(const Mesh& mesh, const Annotation& part) {
    if (part.faces.empty() || is_whole(mesh, part)) return false;
    const std::vector<Halfedge> outline = outline_of(mesh, part);
    if (!is_one_loop(mesh, outline)) return false;
    Vector3d centre = Vector3d::Zero(), normal = Vector3d::Zero();
    for (const Halfedge h : outline) centre += eigen(mesh.point(mesh.target(h))) / static_cast<double>(outline.size());
    double squared = 0;
    for (const Halfedge h : outline) {
        const Vector3d a = eigen(mesh.point(mesh.source(h))) - centre, b = eigen(mesh.point(mesh.target(h))) - centre;
        normal += a.cross(b);
        squared += b.squaredNorm() / static_cast<double>(outline.size());
    }
    if (!(normal.norm() > 0)) return false;
    normal.normalize();
    double height = 0;
    for (const Index v : vertices_of(mesh, part))
        height = std::max(height, std::abs(normal.dot(eigen(mesh.point(Vertex(v))) - centre)));
    return height <= 0.5 * std::sqrt(squared);
}

/// The parameters with which the constraint seats its parts; nothing if it specifies otherwise.
std::optional<Json> seated_parameters(const Relationship& relationship) {
    if (relationship.type != "same level" && relationship.type != "keep shape") return {};
    Json parameters =
        relationship.constraint.empty() ? Json(rapidjson::kObjectType) : parse_json(relationship.constraint, "a constraint");
    if (!parameters.IsObject() || parameters.HasMember("follow")) return {};
    const char* const name = relationship.type == "same level" ? "shapes" : "mode";
    const char* const same = relationship.type == "same level" ? "keep" : "rigid";
    const auto says = [&](const char* member, const char* word) {
        return parameters[member].IsString() && std::string(parameters[member].GetString()) == word;
    };
    if (parameters.HasMember(name) && !says(name, same)) return {};
    if (parameters.HasMember("heights") && !says("heights", "equal")) return {};
    parameters.RemoveMember("heights");
    parameters.RemoveMember("hard");  // seated parts hold exactly
    parameters.RemoveMember(name);
    add_members(parameters, parameters.GetAllocator(), name, "seat");
    return parameters;
}

}  // namespace

Seating seat_ornaments(const HandleSpace& space, const RelationGraph& graph) {
    Seating result;
    std::map<Index, int> constraints_at;  // vertex -> constraints on parts that contain it
    for (const Relationship& relationship : graph.relationships) {
        if (!relationship.is_constraint) continue;
        result.graph.relationships.push_back(relationship);
        if (!(relationship.weight > 0)) continue;
        for (const int id : relationship.annotations)
            if (const Annotation* part = space.annotations.find(id); part != nullptr && !is_whole(space.mesh, *part))
                for (const Index v : vertices_of(space.mesh, *part)) ++constraints_at[v];
    }
    for (Relationship& relationship : result.graph.relationships) {
        if (!(relationship.weight > 0)) continue;
        const auto parameters = seated_parameters(relationship);
        if (!parameters) continue;
        const auto fits = [&](int id) {
            const Annotation* part = space.annotations.find(id);
            if (part == nullptr || !is_ornament(space.mesh, *part)) return false;
            const auto vertices = vertices_of(space.mesh, *part);
            return std::all_of(vertices.begin(), vertices.end(), [&](Index v) { return constraints_at[v] == 1; });
        };
        if (!std::all_of(relationship.annotations.begin(), relationship.annotations.end(), fits)) continue;
        relationship.constraint = to_compact_text(*parameters);
        result.seated.push_back(relationship.id);
    }
    return result;
}

}  // namespace ostraka::semantic
