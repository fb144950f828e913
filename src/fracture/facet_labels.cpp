#include "ostraka/fracture/facet_graph.h"

#include <CGAL/boost/graph/alpha_expansion_graphcut.h>

namespace ostraka {

std::vector<std::size_t> min_cost_labels(const FacetGraph& graph, const std::vector<std::vector<double>>& costs,
                                         const std::vector<double>& boundary) {
    std::vector<std::size_t> labels(graph.count(), 0);
    for (std::size_t p = 0; p < labels.size(); ++p)
        for (std::size_t label = 1; label < costs.size(); ++label)
            if (costs[label][p] < costs[labels[p]][p]) labels[p] = label;
    std::vector<std::pair<std::size_t, std::size_t>> edges;
    for (const auto& contact : graph.contacts) edges.emplace_back(contact.a, contact.b);
    if (!labels.empty())
        CGAL::alpha_expansion_graphcut(edges, boundary, costs, labels, CGAL::Alpha_expansion_boost_compressed_sparse_row_tag());
    return labels;
}

}  // namespace ostraka
