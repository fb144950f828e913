// Shortest edge paths between vertices (thesis, Algorithm 3 with its erratum).
#pragma once

#include "ostraka/core/mesh.h"

#include <functional>
#include <string>
#include <vector>

namespace ostraka {

/// What a step from a vertex to its neighbour costs (thesis, section 2.4.1).
enum class PathMetric {
    euclidean,  ///< the length of the edge
    segment,    ///< the distance of the neighbour to the guide (the straight segment between the path's ends)
    combined    ///< the sum of both
};
PathMetric path_metric(const std::string& name);  ///< Error (usage) for an unknown name

/// Searches paths on one mesh again and again without allocating anew; what it holds grows with the largest search, not with the
/// mesh. Not for use by several threads at once.
class PathSearch {
public:
    explicit PathSearch(const Mesh& mesh);

    struct Query {
        PathMetric metric = PathMetric::euclidean;
        std::vector<Point> guide;             ///< polyline for the segment distance; empty: the segment between the ends
        std::function<bool(Vertex)> blocked;  ///< vertices not to be entered (the ends never are); may be empty
        double limit = 0;                     ///< longest path worth finding, in Euclidean length; 0 = any
    };

    /// The vertices from `from` to `to`, both included (one vertex if they are the same); empty if there is no path.
    /// Dijkstra with a heap and early exit; ties go to the lower vertex index.
    std::vector<Index> find(Vertex from, Vertex to, const Query& query);

    /// The Euclidean shortest path from `from` to the nearest vertex that `goal` accepts, within `limit`; empty if there is none.
    std::vector<Index> find_nearest(Vertex from, const std::function<bool(Vertex)>& goal, double limit);

private:
    std::vector<Index> search(Vertex from, const std::function<bool(Vertex)>& is_goal, const std::function<double(Vertex)>& bound,
                              const std::vector<Point>& guide, const Query& query);

    /// A vertex that a search has come upon.
    struct Record {
        Index vertex = no_index;
        std::uint32_t search = 0;  ///< the number of the search it belongs to; of another one: the place is free
        Index previous = no_index;
        bool settled = false;
        double cost = 0;
        double length = 0;
    };
    /// Makes one, without a cost, for a vertex that has none yet. Valid until the next call.
    Record& record(Index vertex);

    const Mesh& mesh_;
    std::uint32_t search_ = 0;
    std::size_t used_ = 0;
    std::vector<Record> records_;  ///< a hash table: each as soon after its place as there is room; a power of two in size
};

/// Distance from a point to a segment or a polyline.
double distance_to_segment(const Point& p, const Point& a, const Point& b);
double distance_to_polyline(const Point& p, const std::vector<Point>& polyline);

}  // namespace ostraka
