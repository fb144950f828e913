// Shortest edge paths between vertices (thesis, Algorithm 3 with its erratum).
#pragma once

#include "ostraka/mesh/mesh.h"

#include <functional>
#include <string>
#include <vector>

namespace ostraka {

/// Cost of a step from a vertex to its neighbour (thesis, section 2.4.1).
enum class PathMetric {
    euclidean,  ///< the length of the edge
    segment,    ///< the distance of the neighbour from the guide (the straight segment between the ends of the path)
    combined    ///< the sum of both
};
PathMetric path_metric(const std::string& name);  ///< Throws Error (usage) for an unknown name.

/// Repeated path searches on one mesh without repeated allocation; the memory grows with the largest search, not with the mesh.
/// Not thread-safe.
class PathSearch {
public:
    explicit PathSearch(const Mesh& mesh);

    struct Query {
        PathMetric metric = PathMetric::euclidean;
        std::vector<Point> guide;             ///< poly-line for the segment distance; empty: the segment between the ends
        std::function<bool(Vertex)> blocked;  ///< vertices that must not be entered (never applied to the ends); may be empty
        double limit = 0;                     ///< maximum Euclidean length of a path; 0: no limit
    };

    /// The vertices from `from` to `to`, both included (one vertex if they are equal); empty if there is no path. Dijkstra's
    /// algorithm with a heap and early exit; ties are resolved in favour of the lower vertex index.
    std::vector<Index> find(Vertex from, Vertex to, const Query& query);

    /// The shortest Euclidean path from `from` to the nearest vertex that `goal` accepts, within `limit`; empty if there is
    /// none.
    std::vector<Index> find_nearest(Vertex from, const std::function<bool(Vertex)>& goal, double limit);

private:
    std::vector<Index> search(Vertex from, const std::function<bool(Vertex)>& is_goal, const std::function<double(Vertex)>& bound,
                              const std::vector<Point>& guide, const Query& query);

    /// Search state of a visited vertex.
    struct Record {
        Index vertex = no_index;
        std::uint32_t search = 0;  ///< number of the search it belongs to; if it is not the current one, the slot is free
        Index previous = no_index;
        bool settled = false;
        double cost = 0;
        double length = 0;
    };
    /// Finds the record of a vertex, or creates one without a cost. The reference is valid until the next call.
    Record& record(Index vertex);

    const Mesh& mesh_;
    std::uint32_t search_ = 0;
    std::size_t used_ = 0;
    std::vector<Record> records_;  ///< hash table with linear probing; its size is a power of two
};

/// Distance from a point to a segment or a polyline.
double distance_to_segment(const Point& p, const Point& a, const Point& b);
double distance_to_polyline(const Point& p, const std::vector<Point>& polyline);

}  // namespace ostraka
