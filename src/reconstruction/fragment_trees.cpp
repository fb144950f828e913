#include "reconstruction/fragment_trees.h"

#include "ostraka/geom/submesh.h"

namespace ostraka {

const std::vector<bool>& FragmentTrees::end_vertices() {
    if (!end_vertices_.empty()) return end_vertices_;
    end_vertices_.assign(mesh_.number_of_vertices(), false);
    for (const Halfedge h : mesh_.halfedges())
        if (mesh_.is_border(h) || !outer(mesh_.face(h))) end_vertices_[mesh_.source(h)] = end_vertices_[mesh_.target(h)] = true;
    return end_vertices_;
}

const FragmentTrees::Parts& FragmentTrees::parts(const std::vector<int>& labels) {
    if (labels == labels_) return parts_;
    parts_.clear();
    labels_ = labels;
    std::map<int, std::vector<bool>> kept;
    for (std::size_t f = 0; f < labels.size(); ++f)
        if (outer(Face(static_cast<Index>(f)))) kept.try_emplace(labels[f], labels.size(), false).first->second[f] = true;
    for (const auto& [label, keep] : kept) {
        FragmentPart& part = parts_[label];
        SubMesh sub = keep_faces(mesh_, keep);
        part.mesh = std::move(sub.mesh);
        part.faces = std::move(sub.faces);
        part.edge_ends.assign(part.mesh.number_of_edges(), false);
        part.vertex_ends.assign(part.mesh.number_of_vertices(), false);
        for (const Edge e : part.mesh.edges()) {
            if (!part.mesh.is_border(e)) continue;
            const Vertex a = part.mesh.vertex(e, 0), b = part.mesh.vertex(e, 1);
            Halfedge h = find_halfedge(mesh_, Vertex(sub.vertices[a]), Vertex(sub.vertices[b]));
            bool is_end = h == Mesh::null_halfedge();
            for (int side = 0; side < 2 && !is_end; ++side, h = mesh_.opposite(h))
                is_end = mesh_.is_border(h) || !outer(mesh_.face(h));
            if (!is_end) continue;
            part.edge_ends[e] = true;
            part.vertex_ends[a] = part.vertex_ends[b] = true;
        }
        part.search = std::make_unique<SurfaceSearch>(part.mesh);
    }
    return parts_;
}

}  // namespace ostraka
