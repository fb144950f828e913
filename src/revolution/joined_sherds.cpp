#include "stages.h"

#include "ostraka/core/error.h"

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
    std::vector<Index> all;
    for (const auto& own : of_fragment) all.insert(all.end(), own.begin(), own.end());
    return all;
}

std::vector<bool> JoinedSherds::broken() const {
    std::vector<bool> result(mesh.number_of_faces(), true);
    for (const auto& own : of_fragment)
        for (const Index f : own) result[f] = false;
    return result;
}

JoinedSherds joined(const std::vector<LaidSherd>& sherds, const std::vector<bool>& take) {
    JoinedSherds all;
    for (std::size_t k = 0; k < sherds.size(); ++k) {
        const Fragment* sherd = sherds[k].fragment;
        auto& own = all.of_fragment.emplace_back();
        if (!take[k]) continue;
        const Mesh& mesh = sherd->mesh;
        std::vector<Vertex> vertices;
        for (const Vertex v : mesh.vertices())
            vertices.push_back(all.mesh.add_vertex(point_of(sherds[k].motion(eigen(mesh.point(v))))));
        for (const Face face : mesh.faces()) {
            auto c = corners(mesh, face);
            if (sherds[k].inside_out) std::swap(c[1], c[2]);
            const Face made = all.mesh.add_face(vertices[c[0]], vertices[c[1]], vertices[c[2]]);
            if (!sherd->facets.empty() && sherd->facets[face] == Facet::fracture) continue;
            own.push_back(static_cast<Index>(made));
        }
    }
    return all;
}

void leave_out(SherdOnProfile& sherd, const std::string& reason, const std::string& remedy) {
    sherd.use = SherdUse::left_out;
    sherd.reason = reason;
    sherd.remedy = remedy;
    sherd.weight = 0;
}

void fail_all_left_out(const RevolutionTemplate& result) {
    std::string each;
    for (const SherdOnProfile& one : result.sherds) each += (each.empty() ? "" : "; ") + one.name + " " + one.reason;
    fail_input(result.sherds.size() == 1 ? "the sherd" : "the sherds", "cannot be used: " + each,
               result.sherds.size() == 1 && !result.sherds[0].remedy.empty()
                   ? result.sherds[0].remedy
                   : "lay them as they were in the vessel, and give closed meshes of sherds that show some of its turn");
}

}  // namespace ostraka
