#include "reconstruction/assignment.h"

#include <lemon/network_simplex.h>
#include <lemon/smart_graph.h>

#include <stdexcept>

namespace ostraka::fitting {

std::vector<int> assign_columns(int rows, int columns, const std::vector<AssignmentArc>& arcs, std::int64_t unassigned) {
    std::vector<int> result(static_cast<std::size_t>(rows), -1);
    if (rows == 0) return result;
    using Graph = lemon::SmartDigraph;
    Graph graph;
    graph.reserveNode(rows + columns + 1);
    graph.reserveArc(static_cast<int>(arcs.size()) + rows + columns);
    std::vector<Graph::Node> row(static_cast<std::size_t>(rows)), column(static_cast<std::size_t>(columns));
    for (auto& node : row) node = graph.addNode();
    for (auto& node : column) node = graph.addNode();
    const Graph::Node sink = graph.addNode();
    std::vector<Graph::Arc> candidate_arcs;
    for (const AssignmentArc& arc : arcs)
        candidate_arcs.push_back(
            graph.addArc(row[static_cast<std::size_t>(arc.row)], column[static_cast<std::size_t>(arc.column)]));
    Graph::ArcMap<std::int64_t> cost(graph, 0), capacity(graph, 1);
    for (std::size_t i = 0; i < arcs.size(); ++i) cost[candidate_arcs[i]] = arcs[i].cost;
    for (const Graph::Node node : row) cost[graph.addArc(node, sink)] = unassigned;
    for (const Graph::Node node : column) graph.addArc(node, sink);
    Graph::NodeMap<std::int64_t> supply(graph, 0);
    for (const Graph::Node node : row) supply[node] = 1;
    supply[sink] = -rows;
    for (Graph::ArcIt arc(graph); arc != lemon::INVALID; ++arc) capacity[arc] = 1;
    lemon::NetworkSimplex<Graph, std::int64_t, std::int64_t> simplex(graph);
    simplex.upperMap(capacity).costMap(cost).supplyMap(supply);
    if (simplex.run() != lemon::NetworkSimplex<Graph, std::int64_t, std::int64_t>::OPTIMAL)
        throw std::logic_error("assign_columns: no flow, though every row may stay without a column");
    for (std::size_t i = 0; i < arcs.size(); ++i)
        if (simplex.flow(candidate_arcs[i]) > 0) result[static_cast<std::size_t>(arcs[i].row)] = arcs[i].column;
    return result;
}

}  // namespace ostraka::fitting
