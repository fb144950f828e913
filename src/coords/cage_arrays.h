// The cage as flat arrays, for the loops over points.
#pragma once

#include "coords/vector3.h"

#include "ostraka/execution/parallel.h"
#include "ostraka/mesh/mesh.h"

#include <algorithm>
#include <array>
#include <vector>

namespace ostraka::coords {

/// An edge of the cage.
struct CageEdge {
    Index from, to;  ///< vertices of the edge
    Vector3 along;   ///< to - from
    double length;   ///< length of `along`
};

/// A face of the cage. Edge k of the face lies opposite to its corner k. The edge runs from corner k + 1 to corner k + 2 if sign
/// k is 1, and in the other direction if sign k is -1.
struct CageFace {
    std::array<Index, 3> corner, edge;  ///< indices of vertices and edges
    Vector3 sign;                       ///< direction of each edge: 1 or -1
    Vector3 normal;                     ///< twice the area vector
    double double_area;                 ///< length of `normal`: twice the area of the face
};

/// The cage as flat arrays. Lengths are multiplied by `scale`, a power of two (without rounding), so that the diagonal is close
/// to one.
struct CageArrays {
    /// Factor from input lengths to scaled lengths; scaled diagonal of the bounding box.
    double scale = 1, diagonal = 1;
    std::vector<Vector3> points;  ///< positions of the vertices, not scaled
    std::vector<CageEdge> edges;
    std::vector<CageFace> faces;

    explicit CageArrays(const Mesh& cage);
    /// Scaled vector from x to vertex i.
    [[nodiscard]] Vector3 from(const Vector3& x, Index i) const { return scale * (points[i] - x); }
};

inline Vector3 vector3(const Point& p) { return {p.x(), p.y(), p.z()}; }

/// Loads eight points at a time into `work.x`, calls `compute(work)`, then calls `store(work, l, i)` for each lane l, where i is
/// the index of the point in the lane.
template <class Work, class Compute, class Store>
void for_each_point(const CageArrays& cage, const std::vector<Point>& points, const Compute& compute, const Store& store) {
    parallel_blocks(points.size(), 64, [&](std::size_t begin, std::size_t end) {
        Work work(cage);
        for (std::size_t first = begin; first < end; first += lanes) {
            const std::size_t count = std::min<std::size_t>(lanes, end - first);
            for (std::size_t l = 0; l < lanes; ++l)
                work.x.set(static_cast<int>(l), vector3(points[first + std::min(l, count - 1)]));
            compute(work);
            for (std::size_t l = 0; l < count; ++l) store(work, l, first + l);
        }
    });
}

}  // namespace ostraka::coords
