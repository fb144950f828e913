// Small soups with known answers for the tests of diagnosis and repair.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <cmath>
#include <map>
#include <numbers>

namespace ostraka::soups {

using Place = std::array<double, 3>;

/// Axis-aligned cube of 12 triangles, oriented outwards.
inline TriangleSoup cube(Place low = {0, 0, 0}, double side = 1) {
    TriangleSoup s;
    for (int i = 0; i < 8; ++i)
        s.points.push_back({low[0] + (i & 1 ? side : 0), low[1] + (i & 2 ? side : 0), low[2] + (i & 4 ? side : 0)});
    s.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return s;
}

/// The union of both soups, with shifted indices of the second.
inline TriangleSoup both(TriangleSoup a, const TriangleSoup& b) {
    const auto shift = static_cast<Index>(a.points.size());
    a.points.insert(a.points.end(), b.points.begin(), b.points.end());
    for (auto t : b.triangles) a.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    return a;
}

/// Merges exactly equal points.
inline TriangleSoup welded(const TriangleSoup& s) {
    TriangleSoup r;
    std::map<Place, Index> index_of;
    std::vector<Index> to;
    for (const auto& p : s.points) {
        const auto [at, fresh] = index_of.emplace(p, static_cast<Index>(r.points.size()));
        if (fresh) r.points.push_back(p);
        to.push_back(at->second);
    }
    for (const auto& t : s.triangles) r.triangles.push_back({to[t[0]], to[t[1]], to[t[2]]});
    return r;
}

/// Sphere of `rings` x `sectors` with poles, oriented outwards.
inline TriangleSoup sphere(int rings = 12, int sectors = 24, double radius = 1, Place centre = {0, 0, 0}) {
    TriangleSoup s;
    const double pi = std::numbers::pi;
    s.points.push_back({centre[0], centre[1], centre[2] + radius});
    for (int i = 1; i < rings; ++i)
        for (int j = 0; j < sectors; ++j) {
            const double a = pi * i / rings, b = 2 * pi * j / sectors;
            s.points.push_back({centre[0] + radius * std::sin(a) * std::cos(b), centre[1] + radius * std::sin(a) * std::sin(b),
                                centre[2] + radius * std::cos(a)});
        }
    s.points.push_back({centre[0], centre[1], centre[2] - radius});
    const auto at = [&](int i, int j) { return static_cast<Index>(1 + (i - 1) * sectors + (j + sectors) % sectors); };
    const auto south = static_cast<Index>(s.points.size() - 1);
    for (int j = 0; j < sectors; ++j) s.triangles.push_back({0, at(1, j), at(1, j + 1)});
    for (int i = 1; i + 1 < rings; ++i)
        for (int j = 0; j < sectors; ++j) {
            s.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            s.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    for (int j = 0; j < sectors; ++j) s.triangles.push_back({south, at(rings - 1, j + 1), at(rings - 1, j)});
    return s;
}

inline TriangleSoup torus(int n = 24, int m = 12, double big = 2, double small = 0.5) {
    TriangleSoup s;
    const double pi = std::numbers::pi;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) {
            const double a = 2 * pi * i / n, b = 2 * pi * j / m, r = big + small * std::cos(b);
            s.points.push_back({r * std::cos(a), r * std::sin(a), small * std::sin(b)});
        }
    const auto at = [&](int i, int j) { return static_cast<Index>(i % n * m + j % m); };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) {
            s.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            s.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return s;
}

/// Moebius strip of n quads: one side, one border.
inline TriangleSoup moebius(int n = 24) {
    TriangleSoup s;
    for (int i = 0; i < n; ++i) {
        const double a = 2 * std::numbers::pi * i / n;
        for (const double t : {-0.4, 0.4}) {
            const double r = 2 + t * std::cos(a / 2);
            s.points.push_back({r * std::cos(a), r * std::sin(a), t * std::sin(a / 2)});
        }
    }
    for (int i = 0; i < n; ++i) {
        const auto a = static_cast<Index>(2 * i), b = a + 1;
        const Index c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? b + 2 : 0;
        s.triangles.push_back({a, c, b});
        s.triangles.push_back({b, c, d});
    }
    return s;
}

inline TriangleSoup moved(TriangleSoup s, double scale, Place by) {
    for (auto& p : s.points)
        for (std::size_t k = 0; k < 3; ++k) p[k] = p[k] * scale + by[k];
    return s;
}

inline void flip(TriangleSoup& s, std::size_t t) { std::swap(s.triangles[t][1], s.triangles[t][2]); }

}  // namespace ostraka::soups
