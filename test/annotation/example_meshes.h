// Small meshes for the tests of annotations, selections and measures.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <cmath>
#include <map>

namespace ostraka::example {

/// A flat square of n x n cells, two triangles each; vertex (i, j) is i + j (n + 1), at (i, j, 0).
inline Mesh grid(Index n, double scale = 1) {
    TriangleSoup soup;
    for (Index j = 0; j <= n; ++j)
        for (Index i = 0; i <= n; ++i) soup.points.push_back({scale * i, scale * j, 0});
    for (Index j = 0; j < n; ++j)
        for (Index i = 0; i < n; ++i) {
            const Index a = i + j * (n + 1), b = a + 1, c = a + n + 1, d = c + 1;
            soup.triangles.push_back({a, b, d});
            soup.triangles.push_back({a, d, c});
        }
    return build_mesh(soup);
}

/// Spheres from an octahedron subdivided `levels` times; one per centre, in this order.
inline Mesh spheres(int levels, const std::vector<std::array<double, 3>>& centres = {{0, 0, 0}}, double radius = 1) {
    TriangleSoup soup;
    soup.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    soup.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<Index, Index>, Index> middles;
        const auto middle = [&](Index a, Index b) {
            const auto [entry, added] = middles.emplace(std::minmax(a, b), static_cast<Index>(soup.points.size()));
            if (added) {
                std::array<double, 3> p{};
                for (std::size_t k = 0; k < 3; ++k) p[k] = soup.points[a][k] + soup.points[b][k];
                const double length = std::hypot(p[0], p[1], p[2]);
                for (double& x : p) x /= length;
                soup.points.push_back(p);
            }
            return entry->second;
        };
        std::vector<std::array<Index, 3>> triangles;
        for (const auto& [a, b, c] : soup.triangles) {
            const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            triangles.insert(triangles.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        soup.triangles = std::move(triangles);
    }
    TriangleSoup all;
    for (const auto& centre : centres) {
        const Index shift = static_cast<Index>(all.points.size());
        for (const auto& p : soup.points)
            all.points.push_back({centre[0] + radius * p[0], centre[1] + radius * p[1], centre[2] + radius * p[2]});
        for (const auto& [a, b, c] : soup.triangles) all.triangles.push_back({a + shift, b + shift, c + shift});
    }
    return build_mesh(all);
}

}  // namespace ostraka::example
