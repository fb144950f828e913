// Sherds of a thick shell of revolution whose facets and neighbours are known exactly.
#pragma once

#include "ostraka/fracture/fragment.h"

#include "meshes.h"

#include <cmath>
#include <map>

namespace ostraka::test {

struct SyntheticSherd {
    Mesh mesh;
    std::vector<Facet> facets;  ///< per face
};

/// The surface of a grid of boxes, welded; `side` of each triangle: 0, 1 across u, 2, 3 across v, 4 (low), 5 (high) across w.
inline TriangleSoup box_grid(const std::array<int, 3>& count,
                             const std::function<std::array<double, 3>(double, double, double)>& at, std::vector<int>& side) {
    TriangleSoup soup;
    std::map<std::array<int, 3>, Index> index_of;
    const auto vertex = [&](const std::array<int, 3>& p) {
        const auto [it, added] = index_of.try_emplace(p, static_cast<Index>(soup.points.size()));
        if (added) soup.points.push_back(at(double(p[0]) / count[0], double(p[1]) / count[1], double(p[2]) / count[2]));
        return it->second;
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const int high : {0, 1})
            for (int i = 0; i < count[(axis + 1) % 3]; ++i)
                for (int j = 0; j < count[(axis + 2) % 3]; ++j) {
                    const auto corner = [&](int a, int b) {
                        std::array<int, 3> p{};
                        p[axis] = high * count[axis], p[(axis + 1) % 3] = i + a, p[(axis + 2) % 3] = j + b;
                        return vertex(p);
                    };
                    std::array<Index, 4> q{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
                    if (high == 0) std::swap(q[1], q[3]);
                    soup.triangles.push_back({q[0], q[1], q[2]});
                    soup.triangles.push_back({q[0], q[2], q[3]});
                    side.insert(side.end(), 2, 2 * axis + high);
                }
    return soup;
}

/// Shape of a fracture: waves along it and through the wall; `which` selects the fracture.
inline double broken(int which, double along, double through) {
    const double a = 1.7 * which;
    return 0.35 * std::sin(2.3 * along + a) + 0.2 * std::sin(5.1 * along + 2 * a + 0.5) + 0.06 * std::sin(11 * along + 3 * a) +
           0.08 * std::sin(9 * along + 4 * a) * std::sin(5 * through + a) + 0.06 * through;
}

/// A piece of a pot of radius 6 with walls of thickness 0.7, between two vertical and two horizontal fractures; the fracture
/// `right` of a piece is the `left` of its neighbour.
inline SyntheticSherd synthetic_sherd(int left, int right, double from, double to, int fineness = 1) {
    constexpr double wall = 0.7, low = 0, high = 6, around = 6;
    const auto at = [&](double u, double v, double w) -> std::array<double, 3> {
        const double s = w - 0.5;
        const double z0 = low + broken(7, around * (from + (to - from) * u), s),
                     z1 = high + broken(8, around * (from + (to - from) * u), s);
        const double z = z0 + (z1 - z0) * v;
        const double a0 = from + broken(left, low + (high - low) * v, s) / around,
                     a1 = to + broken(right, low + (high - low) * v, s) / around;
        const double angle = a0 + (a1 - a0) * u, radius = around + std::sin(0.5 * z) + wall * s;
        return {radius * std::cos(angle), radius * std::sin(angle), z};
    };
    std::vector<int> side;
    SyntheticSherd sherd;
    sherd.mesh = build_mesh(box_grid({30 * fineness, 30 * fineness, 4 * fineness}, at, side));
    for (const int s : side) sherd.facets.push_back(s == 4 ? Facet::inner : s == 5 ? Facet::outer : Facet::fracture);
    return sherd;
}

/// A round bar whose upper end is broken, or the bar above it, whose lower end is broken.
inline SyntheticSherd synthetic_bar(int fineness = 1, bool above = false) {
    const auto at = [above](double u, double v, double w) -> std::array<double, 3> {
        // Maps the square to the disc (Shirley and Chiu 1997).
        const double a = 2 * u - 1, b = 2 * v - 1, r = std::max(std::abs(a), std::abs(b));
        const double angle = r == 0                       ? 0
                             : std::abs(a) >= std::abs(b) ? (a > 0 ? 0 : M_PI) + M_PI / 4 * b / a
                                                          : (b > 0 ? M_PI / 2 : 1.5 * M_PI) - M_PI / 4 * a / b;
        const double x = r * std::cos(angle), y = r * std::sin(angle);
        const double end = 4 + 0.15 * std::sin(5 * x + 1) * std::cos(4 * y) + 0.05 * std::sin(11 * y - 3 * x);
        return {x, y, above ? 8 - (1 - w) * (8 - end) : w * end};
    };
    std::vector<int> side;
    SyntheticSherd bar;
    bar.mesh = build_mesh(box_grid({16 * fineness, 16 * fineness, 30 * fineness}, at, side));
    for (const int s : side) bar.facets.push_back(s == (above ? 4 : 5) ? Facet::fracture : Facet::outer);
    return bar;
}

inline double agreement(const SyntheticSherd& truth, const std::vector<Facet>& facets) {
    double same = 0, all = 0;
    for (const Face face : truth.mesh.faces()) {
        const double area = face_area(truth.mesh, face);
        all += area;
        same += facets[face] == truth.facets[face] ? area : 0;
    }
    return same / all;
}

}  // namespace ostraka::test
