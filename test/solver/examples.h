// An example of each kind of constraint and each way of using it, with points that violate it.
#pragma once

#include "ostraka/solver/constraint.h"

#include <cmath>
#include <numbers>
#include <random>

namespace ostraka {

struct Example {
    std::string name, kind;
    std::vector<int> ids;
    ConstraintParameters parameters;
    Points rest, points;
    bool rotates = true;  ///< equivariant under rotations of points and parameters; displacement forms only under translations
    bool closest = true;  ///< projection is the closest of all admissible points, not only of rigid motions of the given points
};

inline Points random_points(int count, unsigned seed, double size = 1) {
    std::mt19937 random(seed);
    Points points(3, count);
    const auto value = [&] { return size * (2.0 * static_cast<double>(random()) / 4294967296.0 - 1.0); };
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k) points(k, i) = value();
    return points;
}

inline std::vector<int> first_ids(int count) {
    std::vector<int> ids;
    for (int i = 0; i < count; ++i) ids.push_back(i);
    return ids;
}

/// Closest point on a sphere.
inline Eigen::Vector3d onto_sphere(const Eigen::Vector3d& p, const Eigen::Vector3d& centre, double radius) {
    const Eigen::Vector3d v = p - centre;
    return v.norm() > 0 ? Eigen::Vector3d(centre + radius * v.normalized())
                        : Eigen::Vector3d(centre + radius * Eigen::Vector3d::UnitX());
}

inline std::vector<Example> examples() {
    std::vector<Example> list;
    unsigned seed = 1;
    const auto add = [&](const std::string& name, const std::string& kind, int count) -> Example& {
        Example example;
        example.name = name;
        example.kind = kind;
        example.ids = first_ids(count);
        example.rest = random_points(count, 2 * seed);
        example.points = example.rest + random_points(count, 2 * seed + 1, 0.5);
        ++seed;
        list.push_back(example);
        return list.back();
    };
    const auto range = [](Example& e, double min, double max) {
        e.parameters.min = min;
        e.parameters.max = max;
    };
    const Eigen::Vector3d tilted(1, -2, 3), place(0.3, 0.2, -0.4);

    add("Closeness to rest", "Closeness", 4);
    add("Closeness to targets", "Closeness", 3).parameters.target = random_points(3, 77);
    {
        Example& e = add("OnSurface", "OnSurface", 5);
        e.parameters.closest_point = [](const Eigen::Vector3d& p) { return onto_sphere(p, {0.1, 0.2, 0.3}, 0.7); };
    }
    range(add("EdgeStrain, longer", "EdgeStrain", 2), 2.5, 3);
    range(add("EdgeStrain, shorter", "EdgeStrain", 2), 0.1, 0.2);
    {
        Example& e = add("EdgeStrain, absolute", "EdgeStrain", 2);
        range(e, 5, 6);
        e.parameters.absolute = true;
    }
    range(add("TriangleStrain", "TriangleStrain", 3), 0.95, 1.05);
    range(add("TetrahedronStrain", "TetrahedronStrain", 4), 0.9, 1.1);
    {
        Example& e = add("TetrahedronStrain, inside out", "TetrahedronStrain", 4);
        range(e, 0.5, 2);
        e.points.row(0) *= -1;
    }
    range(add("Area, larger", "Area", 3), 3, 4);
    range(add("Area, smaller", "Area", 3), 0.2, 0.3);
    range(add("Area, much smaller", "Area", 3), 0.01, 0.02);
    range(add("Volume, larger", "Volume", 4), 4, 5);
    range(add("Volume, smaller", "Volume", 4), 0.1, 0.2);
    {
        Example& e = add("Volume, inside out", "Volume", 4);
        range(e, 1, 1);
        e.points.row(0) *= -1;
    }
    {
        Example& e = add("Volume, absolute", "Volume", 4);
        range(e, 0.7, 0.8);
        e.parameters.absolute = true;
    }
    range(add("Bending", "Bending", 4), 0.5, 0.6);
    add("Line", "Line", 6);
    add("Plane", "Plane", 7);
    add("Orientation", "Orientation", 6).parameters.direction = tilted;
    const auto round = [&](Example& e, bool sphere) {
        for (Eigen::Index i = 0; i < e.points.cols(); ++i) {
            const double a = 0.9 * static_cast<double>(i), b = sphere ? 0.7 * static_cast<double>(i) : 0.0;
            e.points.col(i) =
                Eigen::Vector3d(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)) + 0.2 * e.rest.col(i);
        }
    };
    round(add("Circle", "Circle", 7), false);
    round(add("Sphere", "Sphere", 9), true);
    add("Similarity", "Similarity", 6);
    range(add("Similarity, larger", "Similarity", 5), 1.5, 2);
    add("Rigid", "Rigid", 6);
    add("Rigid copy of a shape", "Rigid", 5).parameters.target = random_points(5, 78);
    {
        Example& e = add("Rigid, mirrored", "Rigid", 5);
        e.points.row(1) *= -1;
    }
    {
        Example& e = add("NonUniformScaling", "NonUniformScaling", 7);
        e.parameters.direction = tilted;
    }
    {
        Example& e = add("NonUniformScaling, longer", "NonUniformScaling", 7);
        e.parameters.direction = tilted;
        range(e, 1.5, 2);
    }
    add("Equilateral triangle", "Equilateral", 3);
    add("Regular pentagon", "Equilateral", 5);
    add("Parallelogram", "Parallelogram", 4);
    add("Rectangle", "Rectangle", 4);
    add("Laplacian", "Laplacian", 6);
    add("LaplacianDisplacement", "LaplacianDisplacement", 6).rotates = false;
    const auto fan = [&](Example& e) {
        for (Eigen::Index i = 1; i < e.rest.cols(); ++i) {
            const double a = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(e.rest.cols() - 1);
            e.rest.col(i) = Eigen::Vector3d(std::cos(a), std::sin(a), 0) + 0.2 * e.rest.col(i);
        }
        e.rest.col(0) *= 0.2;
    };
    fan(add("CotangentLaplacian", "CotangentLaplacian", 6));
    add("CotangentLaplacian, given weights", "CotangentLaplacian", 4).parameters.coefficients = {0.5, 1.5, 1};
    {
        Example& e = add("CotangentLaplacianDisplacement", "CotangentLaplacianDisplacement", 6);
        fan(e);
        e.rotates = false;
    }
    {
        Example& e = add("FittedPlaneOrientation", "FittedPlaneOrientation", 6);
        e.points.row(1) *= 0.3;
        e.parameters.direction = tilted;
        e.closest = false;
    }
    {
        Example& e = add("CoAxiality", "CoAxiality", 6);
        e.rest.row(2) *= 3;
        e.points = e.rest + random_points(6, 79, 0.3);
        e.parameters.direction = tilted;
        e.parameters.point = place;
        e.closest = false;
    }
    {
        Example& e = add("CoAxiality, given axis", "CoAxiality", 6);
        e.parameters.direction = tilted;
        e.parameters.point = place;
        e.parameters.rest_direction = Eigen::Vector3d(2, 1, 1);
        e.parameters.rest_point = Eigen::Vector3d(0.1, -0.3, 0.2);
        e.closest = false;
    }
    {
        Example& e = add("AxisOnLine", "AxisOnLine", 6);
        e.parameters.direction = tilted;
        e.parameters.point = place;
        e.parameters.stations = {0, 0, 1, 1, 1, 2};
    }
    {
        Example& e = add("MeansOnLevel", "MeansOnLevel", 6);
        e.parameters.direction = tilted;
        e.parameters.stations = {0, 0, 1, 1, 1, 2};
    }
    {
        Example& e = add("MirrorSymmetry", "MirrorSymmetry", 7);
        e.ids = {0, 1, 2, 3, 4, 4, 5, 6};
    }
    {
        Example& e = add("MirrorSymmetry in a plane", "MirrorSymmetry", 4);
        e.parameters.direction = tilted;
        e.parameters.point = place;
    }
    const auto proportion = [&](Example& e, double min, double max) {
        range(e, min, max);
        e.parameters.split = 5;
        e.parameters.pins = {0, 1, 5, 6};
        e.closest = false;
    };
    proportion(add("Proportion", "Proportion", 7), 2, 3);
    {
        Example& e = add("Proportion, indirect, anchored", "Proportion", 7);
        proportion(e, 4, 5);
        e.parameters.direction = tilted;
        e.parameters.second_direction = Eigen::Vector3d(1, 1, 0);
        e.parameters.anchors = {2, 3};
    }
    {
        Example& e = add("Angle, wider", "Angle", 3);
        e.points.col(1) = e.points.col(0) + Eigen::Vector3d(1, 0.2, 0);
        e.points.col(2) = e.points.col(0) + Eigen::Vector3d(0.3, 0.5, 1.5);
        range(e, 2.5, 2.6);
    }
    range(add("Angle, narrower", "Angle", 3), 0.1, 0.2);
    add("Parallel", "Parallel", 6);
    add("Perpendicular", "Perpendicular", 4);
    range(add("PolylineLength, longer", "PolylineLength", 6), 2, 2.2);
    range(add("PolylineLength, shorter", "PolylineLength", 6), 0.1, 0.2);
    add("EqualLengths", "EqualLengths", 8);
    add("EqualLength", "EqualLength", 7).parameters.split = 3;
    // Append new examples at the end, since the points of each depend on the number of preceding ones.
    {
        Example& e = add("AxisOnLine, shares of the next station", "AxisOnLine", 6);
        e.parameters.direction = tilted;
        e.parameters.point = place;
        e.parameters.stations = {0, 0, 1, 1, 1, 2};
        e.parameters.coefficients = {0, 0.75, 0.125, 0.5, 1, 0};
    }
    const auto single = [&](Example& e, double min, double max) {
        range(e, min, max);
        e.parameters.absolute = true;
        e.parameters.pins = {0, 1};
        e.closest = false;
    };
    single(add("Proportion, one measure", "Proportion", 5), 4, 5);
    {
        Example& e = add("Proportion, one measure, indirect, anchored", "Proportion", 5);
        single(e, 0.1, 0.2);
        e.parameters.direction = tilted;
        e.parameters.anchors = {2, 3};
    }
    const auto axis = [&](Example& e) {
        e.rest.row(2) *= 3;
        e.points = e.rest + random_points(7, 80, 0.3);
        e.parameters.direction = tilted;
        e.closest = false;
    };
    axis(add("AxisDirection, parallel", "AxisDirection", 7));
    {
        Example& e = add("AxisDirection, perpendicular", "AxisDirection", 7);
        axis(e);
        range(e, std::numbers::pi / 2, std::numbers::pi / 2);
    }
    {
        Example& e = add("AxisDirection, given axis, wider", "AxisDirection", 7);
        axis(e);
        e.parameters.rest_direction = Eigen::Vector3d(2, -3, 1);
        range(e, 0.9, 1.1);
    }
    {
        Example& e = add("AxisDirection, given axis, narrower", "AxisDirection", 7);
        axis(e);
        e.parameters.rest_direction = Eigen::Vector3d(2, 3, 1);
        range(e, 0.2, 0.4);
    }
    const auto triangles = [&](Example& e) {
        e.ids = {0, 1, 2, 3, 4, 4, 5, 6};
        e.parameters.direction = tilted;
        e.parameters.point = place;
        e.parameters.coefficients = {0.25, 0.5, 0.25, 0.125, 0.75, 0.125};
    };
    triangles(add("MirrorSymmetry, partners in triangles", "MirrorSymmetry", 7));
    {
        Example& e = add("MirrorSymmetry, partners in triangles, nearly", "MirrorSymmetry", 7);
        triangles(e);
        e.parameters.target = random_points(2, 81, 0.2);
    }
    {
        Example& e = add("MeanPosition", "MeanPosition", 6);
        e.parameters.point = place;
        e.parameters.coefficients = {1, 2, 1, 0.5, 1, 3};
    }
    return list;
}

inline std::unique_ptr<Constraint> make(const Example& e, double weight = 1) {
    return make_constraint(e.kind, e.ids, weight, e.parameters, e.rest);
}

/// Points, rest state and parameters, rotated and then translated.
inline Example moved(Example e, const Eigen::Matrix3d& rotation, const Eigen::Vector3d& by) {
    const auto move = [&](Points& p) { p = (rotation * p).colwise() + by; };
    move(e.rest);
    move(e.points);
    if (e.parameters.target) {
        if (e.kind == "MirrorSymmetry") *e.parameters.target = rotation * *e.parameters.target;  // differences of points
        else move(*e.parameters.target);
    }
    for (auto* direction : {&e.parameters.direction, &e.parameters.second_direction, &e.parameters.rest_direction})
        if (*direction) *direction = rotation * **direction;
    for (auto* point : {&e.parameters.point, &e.parameters.rest_point})
        if (*point) *point = rotation * **point + by;
    if (e.parameters.closest_point)
        e.parameters.closest_point = [inner = e.parameters.closest_point, rotation, by](const Eigen::Vector3d& p) {
            return Eigen::Vector3d(rotation * inner(rotation.transpose() * (p - by)) + by);
        };
    return e;
}

}  // namespace ostraka
