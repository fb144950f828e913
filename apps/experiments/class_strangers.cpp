#include "class_objects.h"

#include "ostraka/core/angles.h"

#include <array>
#include <cmath>

namespace ostraka::experiments {

namespace {

/// A closed surface from a grid of `rings` x `sides` points: periodic in both directions (a torus), or only around the rings,
/// whose first and last one are poles (a ball).
template <class At>
ClassObject made_of_grid(const char* name, Index rings, Index sides, bool torus, At&& at) {
    TriangleSoup soup;
    const Index rows = torus ? rings : rings - 1;
    for (Index i = 0; i < rows; ++i)
        for (Index j = 0; j < sides; ++j) {
            const double u = torus ? static_cast<double>(i) / rings : static_cast<double>(i + 1) / rings;
            const Eigen::Vector3d p = at(u, static_cast<double>(j) / sides);
            soup.points.push_back({p.x(), p.y(), p.z()});
        }
    const auto index = [&](Index i, Index j) { return (torus ? i % rings : i) * sides + j % sides; };
    for (Index i = 0; i + (torus ? 0 : 1) < rows; ++i)
        for (Index j = 0; j < sides; ++j) {
            soup.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
            soup.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
        }
    if (!torus)
        for (const bool last : {false, true}) {
            const Eigen::Vector3d p = at(last ? 1 : 0, 0);
            const auto pole = static_cast<Index>(soup.points.size());
            soup.points.push_back({p.x(), p.y(), p.z()});
            for (Index j = 0; j < sides; ++j) {
                const Index a = index(last ? rows - 1 : 0, j), b = index(last ? rows - 1 : 0, j + 1);
                if (last) soup.triangles.push_back({a, pole, b});
                else soup.triangles.push_back({pole, a, b});
            }
        }
    ClassObject object;
    object.member.name = name;
    object.member.mesh = build_mesh(soup);
    object.whole = measure_whole_shape(object.member.mesh);
    return object;
}

/// A tube of circular section around a closed curve with parameter from 0 to 1.
template <class Curve>
ClassObject tube(const char* name, double radius, Curve&& curve) {
    return made_of_grid(name, 150, 16, true, [&](double u, double v) {
        constexpr double step = 1e-4;
        const Eigen::Vector3d along = (curve(u + step) - curve(u - step)).normalized();
        const Eigen::Vector3d across =
            along
                .cross(curve(u).squaredNorm() > 1e-12 && std::abs(along.z()) > 0.99 ? Eigen::Vector3d::UnitX()
                                                                                    : Eigen::Vector3d::UnitZ())
                .normalized();
        const double angle = -2 * pi * v;  // outward orientation
        return Eigen::Vector3d(curve(u) + radius * (std::cos(angle) * across + std::sin(angle) * along.cross(across)));
    });
}

/// A star-shaped surface: radius as a function of direction.
template <class Radius>
ClassObject star_shaped(const char* name, Radius&& radius) {
    return made_of_grid(name, 50, 60, false, [&](double u, double v) {
        const double polar = pi * u, around = 2 * pi * v;
        const Eigen::Vector3d way(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around), std::cos(polar));
        return Eigen::Vector3d(radius(way).cwiseProduct(way));
    });
}

}  // namespace

std::vector<ClassObject> made_strangers() {
    using Eigen::Vector3d;
    std::vector<ClassObject> made;
    const auto knot = [](double p, double q) {
        return [p, q](double u) {
            const double t = 2 * pi * u, r = 2 + std::cos(q * t);
            return Vector3d(r * std::cos(p * t), r * std::sin(p * t), -std::sin(q * t));
        };
    };
    made.push_back(tube("knot", 0.4, knot(2, 3)));
    made.push_back(tube("knot of five", 0.3, knot(2, 5)));
    made.push_back(tube("torus", 0.7, [](double u) { return Vector3d(2 * std::cos(2 * pi * u), 2 * std::sin(2 * pi * u), 0); }));
    made.push_back(star_shaped("ball", [](const Vector3d&) { return Vector3d(1, 1, 1); }));
    made.push_back(star_shaped("rod", [](const Vector3d&) { return Vector3d(1, 1, 8); }));
    made.push_back(star_shaped("disc", [](const Vector3d&) { return Vector3d(4, 4, 0.5); }));
    made.push_back(star_shaped("star", [](const Vector3d& way) {
        const double r = 1 + 1.5 * std::pow(std::abs(way.x() * way.x() * way.x()) + std::abs(way.y() * way.y() * way.y()) +
                                                std::abs(way.z() * way.z() * way.z()),
                                            4);
        return Vector3d(r, r, r);
    }));
    return made;
}

}  // namespace ostraka::experiments
