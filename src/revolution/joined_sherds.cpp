#include "revolution/stages.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

namespace ostraka {

std::string to_string(SherdUse use) {
    switch (use) {
        case SherdUse::used:
            return "used";
        case SherdUse::partly:
            return "partly used";
        case SherdUse::left_out:
            break;
    }
    return "left out";
}

std::vector<Index> JoinedSherds::faces() const {
    std::vector<Index> result;
    for (const auto& fragment_faces : of_fragment) result.insert(result.end(), fragment_faces.begin(), fragment_faces.end());
    return result;
}

std::vector<bool> JoinedSherds::broken() const {
    std::vector<bool> result(mesh.number_of_faces(), true);
    for (const auto& fragment_faces : of_fragment)
        for (const Index f : fragment_faces) result[f] = false;
    return result;
}

JoinedSherds joined(const std::vector<PlacedSherd>& sherds, const std::vector<bool>& selected) {
    JoinedSherds result;
    for (std::size_t k = 0; k < sherds.size(); ++k) {
        const Fragment* sherd = sherds[k].fragment;
        auto& fragment_faces = result.of_fragment.emplace_back();
        if (!selected[k]) continue;
        const Mesh& mesh = sherd->mesh;
        std::vector<Vertex> vertices;
        for (const Vertex v : mesh.vertices())
            vertices.push_back(result.mesh.add_vertex(point_of(sherds[k].motion(eigen(mesh.point(v))))));
        for (const Face face : mesh.faces()) {
            auto c = corners(mesh, face);
            if (sherds[k].inside_out) std::swap(c[1], c[2]);
            const Face new_face = result.mesh.add_face(vertices[c[0]], vertices[c[1]], vertices[c[2]]);
            if (!sherd->facets.empty() && sherd->facets[face] == Facet::fracture) continue;
            fragment_faces.push_back(static_cast<Index>(new_face));
        }
    }
    return result;
}

void leave_out(SherdOnProfile& sherd, const std::string& reason, const std::string& remedy) {
    sherd.use = SherdUse::left_out;
    sherd.reason = reason;
    sherd.remedy = remedy;
    sherd.weight = 0;
}

void fail_all_left_out(const RevolutionTemplate& result) {
    std::string reasons;
    for (const SherdOnProfile& sherd : result.sherds)
        reasons += fmt::format("{}{} {}", reasons.empty() ? "" : "; ", sherd.name, sherd.reason);
    fail_input(
        result.sherds.size() == 1 ? "the sherd" : "the sherds", "cannot be used: " + reasons,
        result.sherds.size() == 1 && !result.sherds[0].remedy.empty()
            ? result.sherds[0].remedy
            : "place them as they were in the vessel, and give closed meshes of sherds that cover part of its circumference");
}

}  // namespace ostraka
