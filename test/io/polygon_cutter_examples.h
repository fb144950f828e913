// Planar polygons that are difficult to triangulate.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace ostraka::test {

using FlatPolygon = std::vector<std::array<double, 2>>;

/// A band along a spiral of several turns.
inline FlatPolygon spiral(int steps, double turns) {
    FlatPolygon outer, inner;
    for (int i = 0; i < steps; ++i) {
        const double a = 2 * M_PI * turns * i / steps, r = 1 + a;
        outer.push_back({r * std::cos(a), r * std::sin(a)});
        inner.push_back({(r - 0.5) * std::cos(a), (r - 0.5) * std::sin(a)});
    }
    outer.insert(outer.end(), inner.rbegin(), inner.rend());
    return outer;
}

inline FlatPolygon comb(int teeth) {
    FlatPolygon points{{0, 0}, {2.0 * teeth, 0}};
    for (int i = teeth; i > 0; --i) {
        points.push_back({2.0 * i, 10});
        points.push_back({2.0 * i - 1, 1});
    }
    points.push_back({0, 10});
    return points;
}

/// A star polygon {count/step}, which winds several times.
inline std::vector<std::array<double, 3>> regular_star(int count, int step) {
    std::vector<std::array<double, 3>> points;
    for (int i = 0; i < count; ++i)
        points.push_back({std::cos(2 * M_PI * i * step / count), std::sin(2 * M_PI * i * step / count), 0});
    return points;
}

inline std::vector<std::pair<std::string, FlatPolygon>> flat_polygons() {
    FlatPolygon disc, jagged;
    for (int i = 0; i < 60; ++i) {
        const double a = 2 * M_PI * i / 60, r = 1 + 0.8 * std::sin(37.0 * i * i);
        disc.push_back({std::cos(a), std::sin(a)});
        jagged.push_back({r * std::cos(a), r * std::sin(a)});
    }
    return {{"pentagon", {{0, 0}, {2, 0}, {3, 2}, {1, 3}, {-1, 2}}},
            {"arrow", {{0, 0}, {2, -2}, {1, 0}, {2, 2}}},
            {"letter L", {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}},
            {"square with corners on its sides", {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}},
            {"disc", disc},
            {"jagged", jagged},
            {"comb", comb(40)},
            {"spiral", spiral(300, 4)}};
}

}  // namespace ostraka::test
