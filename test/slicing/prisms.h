// Walls over planar figures, whose slices are known exactly.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <Eigen/Geometry>

#include <cmath>
#include <vector>

namespace ostraka::test {

using Polygon = std::vector<Eigen::Vector2d>;

/// Vertical walls from z = 0 to 1 over polygons (outer ones counter-clockwise, holes clockwise), without floor and lid.
inline Mesh walls(const std::vector<Polygon>& polygons) {
    TriangleSoup soup;
    for (const auto& polygon : polygons) {
        const auto first = static_cast<Index>(soup.points.size()), n = static_cast<Index>(polygon.size());
        for (const auto& p : polygon) {
            soup.points.push_back({p.x(), p.y(), 0});
            soup.points.push_back({p.x(), p.y(), 1});
        }
        for (Index i = 0; i < n; ++i) {
            const Index a = first + 2 * i, b = first + 2 * ((i + 1) % n);
            soup.triangles.push_back({a, b, b + 1});
            soup.triangles.push_back({a, b + 1, a + 1});
        }
    }
    return build_mesh(soup);
}

inline Polygon reversed(Polygon polygon) {
    std::reverse(polygon.begin(), polygon.end());
    return polygon;
}

inline Polygon rectangle(double length, double breadth, const Eigen::Vector2d& centre = {0, 0}) {
    const double x = length / 2, y = breadth / 2;
    return {centre + Eigen::Vector2d(-x, -y), centre + Eigen::Vector2d(x, -y), centre + Eigen::Vector2d(x, y),
            centre + Eigen::Vector2d(-x, y)};
}

inline Polygon ellipse(int corners, double a, double b, const Eigen::Vector2d& centre = {0, 0}) {
    Polygon polygon;
    for (int i = 0; i < corners; ++i) {
        const double t = 2 * M_PI * (i + 0.3) / corners;
        polygon.push_back(centre + Eigen::Vector2d(a * std::cos(t), b * std::sin(t)));
    }
    return polygon;
}

/// Divides every side into `pieces` of unequal lengths.
inline Polygon refined(const Polygon& polygon, int pieces) {
    Polygon finer;
    for (std::size_t i = 0; i < polygon.size(); ++i)
        for (int k = 0; k < pieces; ++k) {
            const double t = std::pow(double(k) / pieces, 1.3);
            finer.push_back(polygon[i] + t * (polygon[(i + 1) % polygon.size()] - polygon[i]));
        }
    return finer;
}

inline Polygon transformed(const Polygon& polygon, double scale, double angle, const Eigen::Vector2d& translation) {
    Polygon moved;
    const Eigen::Rotation2Dd rotation(angle);
    for (const auto& p : polygon) moved.push_back(rotation * (scale * p) + translation);
    return moved;
}

}  // namespace ostraka::test
