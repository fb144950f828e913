#include "ostraka/semantic/part_cages.h"

#include "ostraka/annotation/part.h"
#include "ostraka/core/error.h"
#include "ostraka/relation/geometric.h"

#include <algorithm>

namespace ostraka {

std::optional<MirrorPlane> symmetry_plane(AnnotatedMeshView object, const RelationGraph& graph, std::vector<int> annotations,
                                          const std::string& graph_name) {
    std::sort(annotations.begin(), annotations.end());
    for (const Relationship& relationship : graph.relationships) {
        const RelationType* type = find_relation_type(relationship.type);
        if (type == nullptr || type->geometric != GeometricRelation::mirror_symmetry) continue;
        std::vector<int> members = relationship.annotations;
        std::sort(members.begin(), members.end());
        if (members != annotations) continue;
        std::optional<PointAndDirection> plane = relationship.parameters.plane;
        if (!plane) {
            const RelationCheck check = RelationMeter(object).measure(relationship);
            plane = check.parameters.plane;
            if (!plane)
                fail_input(graph_name + ", relationship " + std::to_string(relationship.id),
                           "is a mirror symmetry without a plane, and none is found: " + check.text,
                           "give its plane, or leave it out");
        }
        const auto& [p, n] = *plane;
        return MirrorPlane{Point(p[0], p[1], p[2]), Vector(n[0], n[1], n[2])};
    }
    return std::nullopt;
}

std::vector<PartCage> make_part_cages(AnnotatedMeshView object, const std::vector<std::size_t>& parts, const CageOptions& options,
                                      const RelationGraph& graph, const std::string& graph_name) {
    std::vector<PartCage> cages(parts.size());
    std::vector<Mesh> part;
    for (const std::size_t place : parts) part.push_back(cut_out_part(object, {place}, {}, true).mesh);
    std::vector<bool> done(parts.size(), false);
    const auto id_of = [&](std::size_t i) { return object.annotations.annotations[parts[i]].id; };
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (done[i]) continue;
        for (std::size_t j = i + 1; j < parts.size() && !done[i]; ++j) {
            const auto plane = done[j] ? std::nullopt : symmetry_plane(object, graph, {id_of(i), id_of(j)}, graph_name);
            if (!plane) continue;
            const Mesh other = mirror_image(part[j], *plane);
            cages[i].made = make_cage(together({&part[i], &other}), options);
            cages[j].made = cages[i].made;
            cages[j].made.cage = mirror_image(cages[i].made.cage, *plane);
            done[i] = done[j] = true;
        }
        if (!done[i]) cages[i].made = make_cage(part[i], options, {}, symmetry_plane(object, graph, {id_of(i)}, graph_name));
        done[i] = true;
    }
    for (std::size_t i = 0; i < parts.size(); ++i) cages[i].check = check_cage(cages[i].made.cage, part[i]);
    return cages;
}

Mesh together(const std::vector<const Mesh*>& cages) {
    TriangleSoup all;
    for (const Mesh* cage : cages) {
        const TriangleSoup soup = to_soup(*cage);
        const auto first = static_cast<Index>(all.points.size());
        all.points.insert(all.points.end(), soup.points.begin(), soup.points.end());
        for (const auto& [a, b, c] : soup.triangles) all.triangles.push_back({a + first, b + first, c + first});
    }
    return build_mesh(all);
}

}  // namespace ostraka
