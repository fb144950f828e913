// The cage as flat arrays, for the loops over points.
#pragma once

#include "lanes.h"

#include "ostraka/core/mesh.h"
#include "ostraka/core/parallel.h"

#include <algorithm>
#include <array>
#include <vector>

namespace ostraka::coords {

using Three = std::array<double, 3>;

OSTRAKA_INLINE Three operator+(const Three& a, const Three& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
OSTRAKA_INLINE Three operator-(const Three& a, const Three& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
OSTRAKA_INLINE Three operator*(double s, const Three& a) { return {s * a[0], s * a[1], s * a[2]}; }
OSTRAKA_INLINE double dot(const Three& a, const Three& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
OSTRAKA_INLINE Three cross(const Three& a, const Three& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Three& a) { return std::sqrt(dot(a, a)); }

struct CageEdge {
    Index from, to;
    Three along;  ///< to - from
    double length;
};

/// Edge k of a face lies opposite to its corner k; it runs from corner k + 1 to corner k + 2 if its sign is 1, else the other
/// way.
struct CageFace {
    std::array<Index, 3> corner, edge;
    Three sign;
    Three normal;        ///< twice the area vector
    double double_area;  ///< its length
};

/// The cage as arrays. Lengths are scaled by a power of two, which is exact, so that the diagonal is close to one.
struct CageArrays {
    double scale = 1, diagonal = 1;  ///< the diagonal is scaled
    std::vector<Three> points;       ///< not scaled
    std::vector<CageEdge> edges;
    std::vector<CageFace> faces;

    explicit CageArrays(const Mesh& cage);
    /// Scaled vector from x to vertex i.
    [[nodiscard]] Three from(const Three& x, Index i) const { return scale * (points[i] - x); }
};

inline Three three(const Point& p) { return {p.x(), p.y(), p.z()}; }

/// Loads eight points at a time into `work.x`, calls `compute(work)`, then `take(work, l, i)` for the point i in lane l.
template <class Work, class Compute, class Take>
void for_each_point(const CageArrays& cage, const std::vector<Point>& points, const Compute& compute, const Take& take) {
    parallel_blocks(points.size(), 64, [&](std::size_t begin, std::size_t end) {
        Work work(cage);
        for (std::size_t first = begin; first < end; first += lanes) {
            const std::size_t count = std::min<std::size_t>(lanes, end - first);
            for (std::size_t l = 0; l < lanes; ++l) {
                const Three x = three(points[first + std::min(l, count - 1)]);
                for (std::size_t k = 0; k < 3; ++k) work.x[k][l] = x[k];
            }
            compute(work);
            for (std::size_t l = 0; l < count; ++l) take(work, l, first + l);
        }
    });
}

}  // namespace ostraka::coords
