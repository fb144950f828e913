// Sherds of a pot with an analytic profile.
#pragma once

#include "ostraka/fracture/fragment.h"

#include <cmath>
#include <vector>

namespace ostraka::test {

/// A pot's wall at t from 0 (bottom) to 1 (rim): radius and height, outside and inside.
inline Eigen::Vector2d outside(double t) { return {1 + 0.5 * std::sin(2.6 * t), 2.5 * t}; }
inline Eigen::Vector2d inside(double t) { return {0.85 + 0.5 * std::sin(2.6 * t), 0.2 + 2.3 * t}; }

/// A closed piece of the wall between two angles, from t = low to t = high.
inline Fragment sherd(double from, double to, double low, double high, const Motion& motion) {
    constexpr Index rows = 40;
    const auto columns = static_cast<Index>((to - from) / 0.05) + 2;
    std::vector<Eigen::Vector2d> line;
    for (Index i = 0; i <= rows; ++i) line.push_back(outside(low + (high - low) * i / rows));
    for (Index i = 0; i <= rows; ++i) line.push_back(inside(high + (low - high) * i / rows));
    TriangleSoup soup;
    const auto n = static_cast<Index>(line.size());
    for (Index j = 0; j < columns; ++j)
        for (const Eigen::Vector2d& p : line) {
            const double a = from + (to - from) * j / (columns - 1);
            const Eigen::Vector3d q = motion({p.x() * std::cos(a), p.x() * std::sin(a), p.y()});
            soup.points.push_back({q.x(), q.y(), q.z()});
        }
    for (Index j = 0; j + 1 < columns; ++j)
        for (Index i = 0; i < n; ++i) {
            const Index a = j * n + i, b = j * n + (i + 1) % n, c = a + n, d = b + n;
            soup.triangles.push_back({a, c, b});
            soup.triangles.push_back({b, c, d});
        }
    for (Index i = 0; i < rows; ++i) {
        const Index a = i, b = i + 1, c = n - 2 - i, d = n - 1 - i, last = (columns - 1) * n;
        soup.triangles.push_back({a, b, d});
        soup.triangles.push_back({b, c, d});
        soup.triangles.push_back({last + a, last + d, last + b});
        soup.triangles.push_back({last + b, last + d, last + c});
    }
    Fragment fragment;
    fragment.name = "sherd";
    fragment.mesh = build_mesh(soup);
    return fragment;
}

inline Motion tilted() {
    Motion motion;
    motion.rotation = Eigen::AngleAxisd(0.9, Eigen::Vector3d(1, 2, 0.3).normalized()).toRotationMatrix();
    motion.translation = Eigen::Vector3d(10, -5, 3);
    return motion;
}

}  // namespace ostraka::test
