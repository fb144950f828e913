// The cage as flat arrays, for the loops over points.
#pragma once

#include "coords/vector3.h"

#include "ostraka/execution/parallel.h"
#include "ostraka/mesh/mesh.h"

#include <algorithm>
#include <array>
#include <vector>

namespace ostraka::coords {

struct CageEdge {
    Index from, to;
    Vector3 along;  ///< to - from
    double length;
};

/// Edge k of a face lies opposite to its corner k; it runs from corner k + 1 to corner k + 2 if its sign is 1, else the other
/// way.
struct CageFace {
    std::array<Index, 3> corner, edge;
    Vector3 sign;
    Vector3 normal;      ///< twice the area vector
    double double_area;  ///< its length
};

/// The cage as arrays. Lengths are scaled by a power of two, which is exact, so that the diagonal is close to one.
struct CageArrays {
    double scale = 1, diagonal = 1;  ///< the diagonal is scaled
    std::vector<Vector3> points;     ///< not scaled
    std::vector<CageEdge> edges;
    std::vector<CageFace> faces;

    explicit CageArrays(const Mesh& cage);
    /// Scaled vector from x to vertex i.
    [[nodiscard]] Vector3 from(const Vector3& x, Index i) const { return scale * (points[i] - x); }
};

inline Vector3 vector3(const Point& p) { return {p.x(), p.y(), p.z()}; }

/// Loads eight points at a time into `work.x`, calls `compute(work)`, then `store(work, l, i)` for the point i in lane l.
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
