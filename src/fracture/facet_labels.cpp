#include "facet_evidence.h"

#include <CGAL/boost/graph/alpha_expansion_graphcut.h>

namespace ostraka {

std::vector<std::size_t> min_labels(const Mesh& mesh, const std::vector<std::vector<double>>& costs,
                                    const std::vector<double>& boundary) {
    std::vector<std::size_t> labels(mesh.number_of_faces(), 0);
    for (std::size_t f = 0; f < labels.size(); ++f)
        for (std::size_t label = 1; label < costs.size(); ++label)
            if (costs[label][f] < costs[labels[f]][f]) labels[f] = label;
    std::vector<std::pair<std::size_t, std::size_t>> edges;
    std::vector<double> weights;
    for (const Edge e : mesh.edges()) {
        const Halfedge h = mesh.halfedge(e);
        const Face a = mesh.face(h), b = mesh.face(mesh.opposite(h));
        if (a == Mesh::null_face() || b == Mesh::null_face()) continue;
        edges.emplace_back(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
        weights.push_back(boundary[e]);
    }
    if (!labels.empty())
        CGAL::alpha_expansion_graphcut(edges, weights, costs, labels, CGAL::Alpha_expansion_boost_compressed_sparse_row_tag());
    return labels;
}

}  // namespace ostraka
