// Shortest edge paths between vertices (thesis, Algorithm 3 with its erratum).
#pragma once

#include "ostraka/mesh/mesh.h"

#include <functional>
#include <string>
#include <vector>

namespace ostraka {

/// Cost of a step from a vertex to an adjacent vertex (thesis, section 2.4.1).
enum class PathMetric {
    euclidean,  ///< length of the edge
    /// Distance of the adjacent vertex from Query::guide (by default the straight segment between the ends of the path).
    segment,
    combined  ///< sum of `euclidean` and `segment`
};
/// The metric of this name; throws Error (usage) for an unknown name.
PathMetric path_metric(const std::string& name);

/// Repeated path searches on one mesh without repeated allocation; the memory grows with the largest search, not with the mesh.
/// Not thread-safe.
class PathSearch {
public:
    explicit PathSearch(const Mesh& mesh);

    struct Query {
        PathMetric metric = PathMetric::euclidean;  ///< cost of a step
        /// Poly-line from which the metric `segment` measures distances; empty: the straight segment between the ends of the
        /// path.
        std::vector<Point> guide;
        /// True for vertices that the path must not enter (never called for the ends); may be empty.
        std::function<bool(Vertex)> blocked;
        double limit = 0;  ///< maximum Euclidean length of a path; 0: no limit
    };

    /// The vertices of the shortest path from `from` to `to`, both included (one vertex if the ends are equal); empty if there is
    /// no path. Dijkstra's algorithm with a heap and early exit; ties are resolved in favour of the lower vertex index.
    std::vector<Index> find(Vertex from, Vertex to, const Query& query);

    /// The shortest Euclidean path from `from` to the first vertex that `goal` accepts, of length up to `limit`; empty if there
    /// is none.
    std::vector<Index> find_nearest(Vertex from, const std::function<bool(Vertex)>& goal, double limit);

private:
    std::vector<Index> search(Vertex from, const std::function<bool(Vertex)>& is_goal, const std::function<double(Vertex)>& bound,
                              const std::vector<Point>& guide, const Query& query);

    /// Search state of a visited vertex.
    struct Record {
        Index vertex = no_index;
        /// Number of the search that wrote this record; if it is not the current search, the slot is free.
        std::uint32_t search = 0;
        Index previous = no_index;  ///< vertex before this vertex on the path
        bool settled = false;       ///< true: the cost is final
        double cost = 0;            ///< cost of the path
        double length = 0;          ///< Euclidean length of the path
    };
    /// Finds or creates the record of a vertex. The reference is valid until the next call.
    Record& record(Index vertex);

    const Mesh& mesh_;
    std::uint32_t search_ = 0;
    std::size_t used_ = 0;
    std::vector<Record> records_;  ///< hash table with linear probing; its size is a power of two
};

/// Distance from point p to the segment from a to b.
double distance_to_segment(const Point& p, const Point& a, const Point& b);
double distance_to_polyline(const Point& p, const std::vector<Point>& polyline);

}  // namespace ostraka
