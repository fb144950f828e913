// An example of each kind of constraint and each way of using it, with points that violate it.
#pragma once

#include "ostraka/solver/make_constraint.h"

#include <cmath>
#include <numbers>
#include <random>

namespace ostraka {

struct Example {
    std::string name;
    ConstraintKind kind;
    std::vector<int> ids;
    Points rest, points;
    bool rotates = true;  ///< equivariant under rotations of points and parameters; displacement forms only under translations
    bool closest = true;  ///< projection is the closest of all admissible points, not only of rigid motions of the given points
};

inline std::string_view name_of(const ConstraintKind& kind) { return info_of(kind).name; }

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
    // The points of each example depend on the number of preceding ones: append new examples at the end.
    const auto add = [&](const std::string& name, const ConstraintKind& kind, int count) -> Example& {
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
    const Eigen::Vector3d tilted(1, -2, 3), place(0.3, 0.2, -0.4);

    add("Closeness to rest", kinds::Closeness{}, 4);
    add("Closeness to targets", kinds::Closeness{random_points(3, 77)}, 3);
    add("OnSurface", kinds::OnSurface{[](const Eigen::Vector3d& p) { return onto_sphere(p, {0.1, 0.2, 0.3}, 0.7); }}, 5);
    add("EdgeStrain, longer", kinds::EdgeStrain{{2.5, 3}}, 2);
    add("EdgeStrain, shorter", kinds::EdgeStrain{{0.1, 0.2}}, 2);
    add("EdgeStrain, absolute", kinds::EdgeStrain{{5, 6}, true}, 2);
    add("TriangleStrain", kinds::TriangleStrain{{0.95, 1.05}}, 3);
    add("TetrahedronStrain", kinds::TetrahedronStrain{{0.9, 1.1}}, 4);
    add("TetrahedronStrain, inside out", kinds::TetrahedronStrain{{0.5, 2}}, 4).points.row(0) *= -1;
    add("Area, larger", kinds::Area{{3, 4}}, 3);
    add("Area, smaller", kinds::Area{{0.2, 0.3}}, 3);
    add("Area, much smaller", kinds::Area{{0.01, 0.02}}, 3);
    add("Volume, larger", kinds::Volume{{4, 5}}, 4);
    add("Volume, smaller", kinds::Volume{{0.1, 0.2}}, 4);
    add("Volume, inside out", kinds::Volume{{1, 1}}, 4).points.row(0) *= -1;
    add("Volume, absolute", kinds::Volume{{0.7, 0.8}, true}, 4);
    add("Bending", kinds::Bending{{0.5, 0.6}}, 4);
    add("Line", kinds::Line{}, 6);
    add("Plane", kinds::Plane{}, 7);
    add("Orientation", kinds::Orientation{tilted}, 6);
    const auto round = [&](Example& e, bool sphere) {
        for (Eigen::Index i = 0; i < e.points.cols(); ++i) {
            const double a = 0.9 * static_cast<double>(i), b = sphere ? 0.7 * static_cast<double>(i) : 0.0;
            e.points.col(i) =
                Eigen::Vector3d(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)) + 0.2 * e.rest.col(i);
        }
    };
    round(add("Circle", kinds::Circle{}, 7), false);
    round(add("Sphere", kinds::Sphere{}, 9), true);
    add("Similarity", kinds::Similarity{}, 6);
    add("Similarity, larger", kinds::Similarity{{1.5, 2}}, 5);
    add("Rigid", kinds::Rigid{}, 6);
    add("Rigid copy of a shape", kinds::Rigid{random_points(5, 78)}, 5);
    add("Rigid, mirrored", kinds::Rigid{}, 5).points.row(1) *= -1;
    add("NonUniformScaling", kinds::NonUniformScaling{tilted}, 7);
    add("NonUniformScaling, longer", kinds::NonUniformScaling{tilted, {1.5, 2}}, 7);
    add("Equilateral triangle", kinds::Equilateral{}, 3);
    add("Regular pentagon", kinds::Equilateral{}, 5);
    add("Parallelogram", kinds::Parallelogram{}, 4);
    add("Rectangle", kinds::Rectangle{}, 4);
    add("Laplacian", kinds::Laplacian{}, 6);
    add("LaplacianDisplacement", kinds::LaplacianDisplacement{}, 6).rotates = false;
    const auto fan = [&](Example& e) {
        for (Eigen::Index i = 1; i < e.rest.cols(); ++i) {
            const double a = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(e.rest.cols() - 1);
            e.rest.col(i) = Eigen::Vector3d(std::cos(a), std::sin(a), 0) + 0.2 * e.rest.col(i);
        }
        e.rest.col(0) *= 0.2;
    };
    fan(add("CotangentLaplacian", kinds::CotangentLaplacian{}, 6));
    add("CotangentLaplacian, given weights", kinds::CotangentLaplacian{{0.5, 1.5, 1}}, 4);
    {
        Example& e = add("CotangentLaplacianDisplacement", kinds::CotangentLaplacianDisplacement{}, 6);
        fan(e);
        e.rotates = false;
    }
    {
        Example& e = add("FittedPlaneOrientation", kinds::FittedPlaneOrientation{tilted}, 6);
        e.points.row(1) *= 0.3;
        e.closest = false;
    }
    {
        Example& e = add("CoAxiality", kinds::CoAxiality{tilted, place}, 6);
        e.rest.row(2) *= 3;
        e.points = e.rest + random_points(6, 79, 0.3);
        e.closest = false;
    }
    add("CoAxiality, given axis", kinds::CoAxiality{tilted, place, Eigen::Vector3d(2, 1, 1), Eigen::Vector3d(0.1, -0.3, 0.2)}, 6)
        .closest = false;
    add("AxisOnLine", kinds::AxisOnLine{tilted, place, {0, 0, 1, 1, 1, 2}}, 6);
    add("MeansOnLevel", kinds::MeansOnLevel{tilted, {0, 0, 1, 1, 1, 2}}, 6);
    add("MirrorSymmetry", kinds::MirrorSymmetry{}, 7).ids = {0, 1, 2, 3, 4, 4, 5, 6};
    add("MirrorSymmetry in a plane", kinds::MirrorSymmetry{kinds::MirrorPlane{tilted, place}}, 4);
    {
        kinds::Proportion ratio{{2, 3}, {{0, 1}}, kinds::PinnedMeasure{{5, 6}}, 5};
        add("Proportion", ratio, 7).closest = false;
        ratio.range = {4, 5};
        ratio.measure.direction = tilted;
        ratio.second->direction = Eigen::Vector3d(1, 1, 0);
        ratio.anchors = {2, 3};
        add("Proportion, indirect, anchored", ratio, 7).closest = false;
    }
    {
        Example& e = add("Angle, wider", kinds::Angle{{2.5, 2.6}}, 3);
        e.points.col(1) = e.points.col(0) + Eigen::Vector3d(1, 0.2, 0);
        e.points.col(2) = e.points.col(0) + Eigen::Vector3d(0.3, 0.5, 1.5);
    }
    add("Angle, narrower", kinds::Angle{{0.1, 0.2}}, 3);
    add("Parallel", kinds::Parallel{}, 6);
    add("Perpendicular", kinds::Perpendicular{}, 4);
    add("PolylineLength, longer", kinds::PolylineLength{{2, 2.2}}, 6);
    add("PolylineLength, shorter", kinds::PolylineLength{{0.1, 0.2}}, 6);
    add("EqualLengths", kinds::EqualLengths{}, 8);
    add("EqualLength", kinds::EqualLength{3}, 7);
    add("AxisOnLine, shares of the next station",
        kinds::AxisOnLine{tilted, place, {0, 0, 1, 1, 1, 2}, {0, 0.75, 0.125, 0.5, 1, 0}}, 6);
    {
        kinds::Proportion single{{4, 5}, {{0, 1}}};
        add("Proportion, one measure", single, 5).closest = false;
        single.range = {0.1, 0.2};
        single.measure.direction = tilted;
        single.anchors = {2, 3};
        add("Proportion, one measure, indirect, anchored", single, 5).closest = false;
    }
    const auto add_axis = [&](const std::string& name, const kinds::AxisDirection& kind) {
        Example& e = add(name, kind, 7);
        e.rest.row(2) *= 3;
        e.points = e.rest + random_points(7, 80, 0.3);
        e.closest = false;
    };
    constexpr double right_angle = std::numbers::pi / 2;
    add_axis("AxisDirection, parallel", {tilted});
    add_axis("AxisDirection, perpendicular", {tilted, {right_angle, right_angle}});
    add_axis("AxisDirection, given axis, wider", {tilted, {0.9, 1.1}, Eigen::Vector3d(2, -3, 1)});
    add_axis("AxisDirection, given axis, narrower", {tilted, {0.2, 0.4}, Eigen::Vector3d(2, 3, 1)});
    kinds::MirrorInTriangles triangles{{tilted, place}, {0.25, 0.5, 0.25, 0.125, 0.75, 0.125}};
    add("MirrorSymmetry, partners in triangles", triangles, 7).ids = {0, 1, 2, 3, 4, 4, 5, 6};
    triangles.discrepancies = random_points(2, 81, 0.2);
    add("MirrorSymmetry, partners in triangles, nearly", triangles, 7).ids = {0, 1, 2, 3, 4, 4, 5, 6};
    add("MeanPosition", kinds::MeanPosition{place, {1, 2, 1, 0.5, 1, 3}}, 6);
    return list;
}

inline std::unique_ptr<Constraint> make(const Example& e, double weight = 1) {
    return make_constraint(e.kind, e.ids, weight, e.rest);
}

/// Visits the parameters of a kind by name and by their transformation with the points: as positions, directions, differences, or
/// none.
template <class Visit>
struct VisitParameters {
    Visit& visit;

    template <class Kind>
    void operator()(Kind&) const {}  ///< no parameters
    void operator()(kinds::Closeness& k) const { visit.place("targets", k.targets); }
    void operator()(kinds::OnSurface& k) const { visit.surface("surface", k.closest_point); }
    void operator()(kinds::Orientation& k) const { visit.direction("normal", k.normal); }
    void operator()(kinds::EdgeStrain& k) const { range(k.length), visit.value("absolute", k.absolute); }
    void operator()(kinds::TriangleStrain& k) const { range(k.stretch); }
    void operator()(kinds::TetrahedronStrain& k) const { range(k.stretch); }
    void operator()(kinds::Area& k) const { range(k.area), visit.value("absolute", k.absolute); }
    void operator()(kinds::Volume& k) const { range(k.volume), visit.value("absolute", k.absolute); }
    void operator()(kinds::Bending& k) const { range(k.bend), visit.value("absolute", k.absolute); }
    void operator()(kinds::CotangentLaplacian& k) const { visit.value("weights", k.weights); }
    void operator()(kinds::CotangentLaplacianDisplacement& k) const { visit.value("weights", k.weights); }
    void operator()(kinds::Similarity& k) const { range(k.scale), visit.place("shape", k.shape); }
    void operator()(kinds::Rigid& k) const { visit.place("shape", k.shape); }
    void operator()(kinds::NonUniformScaling& k) const {
        visit.direction("axis", k.axis), range(k.scale), visit.place("shape", k.shape);
    }
    void operator()(kinds::Angle& k) const { range(k.angle); }
    void operator()(kinds::PolylineLength& k) const { range(k.length), visit.value("absolute", k.absolute); }
    void operator()(kinds::EqualLength& k) const { visit.value("first", k.first); }
    void operator()(kinds::FittedPlaneOrientation& k) const { visit.direction("normal", k.normal); }
    void operator()(kinds::CoAxiality& k) const {
        visit.direction("direction", k.direction), visit.place("point", k.point);
        visit.direction("rest_direction", k.rest_direction), visit.place("rest_point", k.rest_point);
    }
    void operator()(kinds::AxisDirection& k) const {
        visit.direction("direction", k.direction), range(k.angle);
        visit.direction("rest_direction", k.rest_direction), visit.place("min_size", k.min_size);
    }
    void operator()(kinds::AxisOnLine& k) const {
        visit.direction("direction", k.direction), visit.place("point", k.point);
        visit.value("stations", k.stations), visit.value("shares", k.shares);
    }
    void operator()(kinds::MeansOnLevel& k) const {
        visit.direction("up", k.up), visit.value("groups", k.groups), visit.value("weights", k.weights);
        visit.place("places", k.places);
    }
    void operator()(kinds::MeanPosition& k) const { visit.place("place", k.place), visit.value("weights", k.weights); }
    void operator()(kinds::MirrorSymmetry& k) const {
        if (k.plane) visit.direction("normal", k.plane->normal), visit.place("point", k.plane->point);
    }
    void operator()(kinds::MirrorInTriangles& k) const {
        visit.direction("normal", k.plane.normal), visit.place("point", k.plane.point);
        visit.value("barycentric", k.barycentric), visit.direction("discrepancies", k.discrepancies);
    }
    void operator()(kinds::Proportion& k) const {
        range(k.range), visit.value("pins", k.measure.pins), visit.direction("direction", k.measure.direction);
        if (k.second) visit.value("second_pins", k.second->pins), visit.direction("second_direction", k.second->direction);
        visit.value("part", k.part), visit.value("anchors", k.anchors), visit.place("shape", k.shape);
        visit.value("uniform", k.uniform);
    }

private:
    void range(kinds::Interval& interval) const { visit.value("min", interval.min), visit.value("max", interval.max); }
};

/// Rotates and then translates the parameters of a kind that are points, and rotates those that are directions.
struct Mover {
    Eigen::Matrix3d rotation;
    Eigen::Vector3d by;
    void place(const char*, Points& points) { points = ((rotation * points).colwise() + by).eval(); }
    void place(const char*, Eigen::Vector3d& point) { point = (rotation * point + by).eval(); }
    template <class Matrix>
    void direction(const char*, Matrix& vectors) {
        vectors = (rotation * vectors).eval();
    }
    template <class Matrix>
    void place(const char* name, std::optional<Matrix>& given) {
        if (given) place(name, *given);
    }
    template <class Matrix>
    void direction(const char* name, std::optional<Matrix>& given) {
        if (given) direction(name, *given);
    }
    template <class Value>
    void value(const char*, const Value&) {}
    void surface(const char*, std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& closest_point) {
        closest_point = [inner = closest_point, to = rotation, shift = by](const Eigen::Vector3d& p) {
            return Eigen::Vector3d(to * inner(to.transpose() * (p - shift)) + shift);
        };
    }
};

/// Points, rest state and parameters, rotated and then translated.
inline Example moved(Example e, const Eigen::Matrix3d& rotation, const Eigen::Vector3d& by) {
    Mover mover{rotation, by};
    mover.place("rest", e.rest);
    mover.place("points", e.points);
    std::visit(VisitParameters<Mover>{mover}, e.kind);
    return e;
}

}  // namespace ostraka
