// Descriptors of figures that have them in closed form: rotated, scaled, far away, refined, and as the limit of finer polygons.
#include "ostraka/slicing/slice_descriptors.h"

#include "meshes.h"
#include "ostraka/core/error.h"
#include "prisms.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

Slice figure(const std::vector<Polygon>& polygons) {
    return slice_mesh(walls(polygons), slice_frame({0, 0, 0}, {0, 0, 1}), {0.5}).slices.at(0);
}
SliceDescriptors describe(const std::vector<Polygon>& polygons) { return describe_slice(figure(polygons)); }

/// Dimensionless descriptors, and others divided by the scale.
std::vector<std::pair<std::string, double>> numbers(const SliceDescriptors& d, double scale = 1) {
    return {{"area", d.area / scale / scale},
            {"perimeter", d.perimeter / scale},
            {"hole area", d.hole_area / scale / scale},
            {"outline area", d.outline_area / scale / scale},
            {"outline perimeter", d.outline_perimeter / scale},
            {"box length", d.box_length / scale},
            {"box breadth", d.box_breadth / scale},
            {"elongation", d.elongation},
            {"eccentricity", d.eccentricity},
            {"solidity", d.solidity},
            {"compactness", d.compactness},
            {"circular variance", d.circular_variance},
            {"rectangular variance", d.rectangular_variance},
            {"euler number", double(d.euler_number)},
            {"hole-area ratio", d.hole_area_ratio},
            {"equivalent radius", d.equivalent_radius / scale},
            {"roundness, equivalent", d.roundness_equivalent / scale},
            {"roundness, equivalent, relative", d.roundness_equivalent_relative},
            {"fitted radius", d.fitted_radius / scale},
            {"roundness, fitted", d.roundness_fitted / scale},
            {"roundness, fitted, relative", d.roundness_fitted_relative},
            {"thickness mean", d.thickness_mean / scale},
            {"thickness variance", d.thickness_variance / scale / scale},
            {"thickness least", d.thickness_min / scale},
            {"thickness most", d.thickness_max / scale}};
}

void expect_same(const SliceDescriptors& a, const SliceDescriptors& b, double scale, double tolerance, bool thickness = true) {
    const auto first = numbers(a), second = numbers(b, scale);
    for (std::size_t i = 0; i < first.size(); ++i) {
        if (!thickness && first[i].first.starts_with("thickness")) continue;
        if (std::isnan(first[i].second)) {
            EXPECT_TRUE(std::isnan(second[i].second)) << first[i].first;
            continue;
        }
        EXPECT_NEAR(second[i].second, first[i].second, tolerance * std::abs(first[i].second) + 1e-2 * tolerance)
            << first[i].first;
    }
}

}  // namespace

TEST(SliceDescriptors, ARectangle) {
    const double a = 5, b = 2;
    const auto d = describe({rectangle(a, b, {3, 7})});
    EXPECT_NEAR(d.area, 10, 1e-12);
    EXPECT_NEAR(d.perimeter, 14, 1e-12);
    EXPECT_NEAR((d.barycentre - Eigen::Vector2d(3, 7)).norm(), 0, 1e-12);
    EXPECT_NEAR(d.box_length, 5, 1e-12);
    EXPECT_NEAR(d.box_breadth, 2, 1e-12);
    EXPECT_NEAR(d.elongation, 0.6, 1e-12);
    EXPECT_NEAR(d.eccentricity, 0.4, 1e-12);
    EXPECT_NEAR(d.solidity, 1, 1e-12);
    EXPECT_NEAR(d.compactness, 4 * M_PI * 10 / 196, 1e-12);
    EXPECT_NEAR(d.rectangular_variance, 0, 1e-20);
    EXPECT_EQ(d.euler_number, 1);
    EXPECT_EQ(d.hole_area_ratio, 0);
    EXPECT_TRUE(std::isnan(d.thickness_mean));
    // Mean of (|p| - r)^2 by |p|^2, and the integral of sqrt(t^2 + h^2) along each side.
    const double r = std::sqrt(10 / M_PI), A = a / 2, B = b / 2;
    const auto first = [](double h, double l) { return (l * std::hypot(l, h) + h * h * std::asinh(l / h)); };
    const double squares = 4 * (A * (A * A / 3 + B * B) + B * (B * B / 3 + A * A)), distances = 2 * (first(B, A) + first(A, B));
    EXPECT_NEAR(d.circular_variance, (squares - 2 * r * distances + 14 * r * r) / 14 / (r * r), 1e-11);
}

TEST(SliceDescriptors, AnLShape) {
    // 3 x 3 without its upper right 2 x 2.
    const auto d = describe({{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}});
    EXPECT_NEAR(d.area, 5, 1e-12);
    EXPECT_NEAR(d.perimeter, 12, 1e-12);
    EXPECT_NEAR(d.solidity, 5 / 7.0, 1e-12);
    EXPECT_NEAR(d.compactness, 4 * M_PI * 5 / 144, 1e-12);
    EXPECT_NEAR(d.barycentre.x(), 1.1, 1e-12);
    // Across the corner it would be 6 / sqrt 2 x 4 / sqrt 2.
    EXPECT_NEAR(d.box_length, 3, 1e-12);
    EXPECT_NEAR(d.eccentricity, 1, 1e-12);
    EXPECT_EQ(d.components, 1);
}

TEST(SliceDescriptors, ConvergeQuadraticallyOnCirclesAndEllipses) {
    // Each as a limit of polygons with n corners, whose error falls with n^-2.
    const double a = 3, b = 2, h = std::pow((a - b) / (a + b), 2);
    // Perimeter: Gauss and Kummer's series; mean distances by the periodic trapezoid rule, which is exact for so many nodes.
    const double perimeter = M_PI * (a + b) * (1 + h / 4 + h * h / 64 + h * h * h / 256 + 25 * h * h * h * h / 16384);
    const double r = std::sqrt(a * b);
    double variance = 0, roundness = 0, box = 0, length = 0;
    const int nodes = 200000;
    for (int i = 0; i < nodes; ++i) {
        const double t = 2 * M_PI * (i + 0.5) / nodes, x = a * std::cos(t), y = b * std::sin(t);
        const double w = std::hypot(a * std::sin(t), b * std::cos(t)), e = std::abs(std::hypot(x, y) - r);
        const double side = std::min(a - std::abs(x), b - std::abs(y));
        variance += w * e * e, roundness += w * e, box += w * side * side, length += w;
    }
    struct Expected {
        const char* name;
        double (*value)(const SliceDescriptors&);
        double limit;
    };
    const std::vector<Expected> cases{
        {"area", [](const SliceDescriptors& d) { return d.area; }, M_PI * a * b},
        {"perimeter", [](const SliceDescriptors& d) { return d.perimeter; }, perimeter},
        {"compactness", [](const SliceDescriptors& d) { return d.compactness; }, 4 * M_PI * M_PI * a * b / perimeter / perimeter},
        {"eccentricity", [](const SliceDescriptors& d) { return d.eccentricity; }, b / a},
        {"elongation", [](const SliceDescriptors& d) { return d.elongation; }, 1 - b / a},
        {"equivalent radius", [](const SliceDescriptors& d) { return d.equivalent_radius; }, r},
        {"circular variance", [](const SliceDescriptors& d) { return d.circular_variance; }, variance / length / r / r},
        {"roundness", [](const SliceDescriptors& d) { return d.roundness_equivalent; }, roundness / length},
        {"rectangular variance", [](const SliceDescriptors& d) { return d.rectangular_variance; },
         box / length * M_PI / (4 * a * b)}};
    for (const auto& expected : cases) {
        double previous_error = 0;
        for (const int n : {64, 256, 1024}) {
            const double error = std::abs(expected.value(describe({ellipse(n, a, b, {10, -4})})) - expected.limit);
            if (n == 1024) {
                EXPECT_LT(error, 1e-4 * std::abs(expected.limit)) << expected.name;
                EXPECT_NEAR(std::log(previous_error / error) / std::log(4), 2, 0.5)
                    << expected.name << " " << previous_error << " " << error;
            }
            previous_error = error;
        }
    }
    // A circle: everything round is zero in the limit, in n^-2.
    const auto coarse = describe({ellipse(100, 2, 2)}), fine = describe({ellipse(200, 2, 2)});
    EXPECT_NEAR(coarse.roundness_equivalent / fine.roundness_equivalent, 4, 0.1);
    EXPECT_NEAR(coarse.roundness_fitted / fine.roundness_fitted, 4, 0.1);
    EXPECT_NEAR(coarse.circular_variance / fine.circular_variance, 16, 0.5);
    EXPECT_LT(fine.roundness_fitted_relative, 1e-4);
    EXPECT_NEAR(fine.compactness, 1, 1e-3);
    EXPECT_LT(fine.fitted_centre.norm(), 1e-9);
}

TEST(SliceDescriptors, Rings) {
    // Concentric, and with an eccentric cavity.
    const double R = 3, r = 1;
    for (const double e : {0.0, 0.5, 1.2}) {
        const auto slice = figure({ellipse(2000, R, R, {5, 5}), reversed(ellipse(1500, r, r, {5 + e, 5}))});
        const auto d = describe_slice(slice);
        EXPECT_NEAR(d.area, M_PI * (R * R - r * r), 1e-4);
        EXPECT_NEAR(d.hole_area_ratio, r * r / (R * R), 1e-5);
        EXPECT_EQ(d.euler_number, 0);
        EXPECT_NEAR(d.compactness, (R - r) / (R + r), 1e-5);
        EXPECT_NEAR(d.solidity, 1 - r * r / (R * R), 1e-5);
        EXPECT_NEAR(d.barycentre.x(), 5 - e * r * r / (R * R - r * r), 1e-5);
        EXPECT_NEAR(d.outline_barycentre.x(), 5, 1e-9);
        EXPECT_NEAR(d.equivalent_radius, R, 1e-5);
        EXPECT_LT(d.roundness_fitted, 1e-5);
        // From a point of the outer circle at angle t, the inner one is sqrt(R^2 + e^2 - 2 R e cos t) - r away.
        double first = 0, second = 0;
        const int nodes = 10000;
        for (int i = 0; i < nodes; ++i) {
            const double distance = std::sqrt(R * R + e * e - 2 * R * e * std::cos(2 * M_PI * i / nodes)) - r;
            first += distance / nodes, second += distance * distance / nodes;
        }
        EXPECT_NEAR(d.thickness_mean, first, 1e-5);
        EXPECT_NEAR(d.thickness_variance, second - first * first, 1e-5);
        EXPECT_NEAR(d.thickness_min, R - r - e, 1e-5);
        EXPECT_NEAR(d.thickness_max, R - r + e, 1e-5);
        const auto profile = thickness_profile(slice, 36);
        ASSERT_EQ(profile.size(), 36U);
        for (int k = 0; k < 36; ++k) {
            const double t = 2 * M_PI * k / 36, s = e * std::sin(t);
            EXPECT_NEAR(profile[std::size_t(k)], -e * std::cos(t) + std::sqrt(R * R - s * s) - r, 1e-4) << k;
        }
    }
}

TEST(SliceDescriptors, AreInvariantToMotionAndScale) {
    const std::vector<std::vector<Polygon>> figures{{rectangle(5, 2)},
                                                    {ellipse(60, 3, 2)},
                                                    {ellipse(100, 3, 3), reversed(ellipse(80, 1, 1.2, {0.5, 0.3}))},
                                                    {{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}},
                                                    {{{0, 0}, {4, 0}, {3, 1}, {5, 3}, {1, 4}}, {{10, 0}, {11, 0}, {10, 1}}}};
    for (std::size_t f = 0; f < figures.size(); ++f) {
        SCOPED_TRACE(f);
        const auto reference = describe(figures[f]);
        for (const double scale : {1.0, 1e-6, 1e6})
            for (const double angle : {0.0, 0.7, 2.9}) {
                std::vector<Polygon> moved;
                for (const auto& polygon : figures[f])
                    moved.push_back(transformed(polygon, scale, angle, {7 * scale, -2 * scale}));
                // The walls are a unit high, whatever the scale: the plane passes through no vertex.
                expect_same(reference, describe(moved), scale, 1e-9);
            }
        // Far away, coordinates have fewer digits.
        std::vector<Polygon> far;
        for (const auto& polygon : figures[f]) far.push_back(transformed(polygon, 1, 0.4, {1e5, 2e5}));
        expect_same(reference, describe(far), 1, 1e-8);
        // Sides cut into pieces.
        std::vector<Polygon> finer;
        for (const auto& polygon : figures[f]) finer.push_back(refined(polygon, 7));
        const auto fine = describe(finer);
        expect_same(reference, fine, 1, 1e-9, false);
        if (!std::isnan(reference.thickness_mean)) {
            EXPECT_NEAR(fine.thickness_mean, reference.thickness_mean, 1e-5 * reference.thickness_mean);
        }
    }
}

TEST(SliceDescriptors, OfTheMeshMovedRigidly) {
    const TriangleSoup soup = joined(torus(60, 40), moved(octahedron_sphere(4), 0.6, {0.1, 0.2, 0.1}));
    const Mesh mesh = build_mesh(soup);
    const Eigen::Matrix3d rotation =
        (Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()) * Eigen::AngleAxisd(1.1, Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    TriangleSoup moved_soup = soup;
    for (auto& p : moved_soup.points) {
        const Eigen::Vector3d q = rotation * Eigen::Vector3d(p[0], p[1], p[2]) + Eigen::Vector3d(3, -2, 1);
        p = {q.x(), q.y(), q.z()};
    }
    const Eigen::Vector3d n(0.3, -0.2, 1), m = rotation * n;
    const auto heights = slice_heights(-0.9, 0.9, 20);
    const auto original = describe_slices(slice_mesh(mesh, slice_frame({0, 0, 0}, {n.x(), n.y(), n.z()}), heights).slices);
    const auto moved_descriptors =
        describe_slices(slice_mesh(build_mesh(moved_soup), slice_frame({3, -2, 1}, {m.x(), m.y(), m.z()}), heights).slices);
    for (std::size_t i = 0; i < heights.size(); ++i) {
        SCOPED_TRACE(i);
        expect_same(original[i], moved_descriptors[i], 1, 1e-9);
    }
}

TEST(SliceDescriptors, OfOpenContours) {
    const auto arc = [](double from, double to, double radius) {
        return build_mesh(grid(400, 1, false, false, [&](double s, double t) {
            const double a = from + s * (to - from);
            return std::array<double, 3>{radius * std::cos(a), radius * std::sin(a), t};
        }));
    };
    const SliceFrame frame = slice_frame({0, 0, 0}, {0, 0, 1});
    const auto open = describe_slice(slice_mesh(arc(0, 4, 2), frame, {0.4}).slices[0]);
    for (const auto& [name, value] : numbers(open)) {
        if (name == "fitted radius" || name == "euler number") continue;
        EXPECT_TRUE(std::isnan(value)) << name;  // and none is round
    }
    EXPECT_NEAR(open.fitted_radius, 2, 1e-4);
    EXPECT_LE(open.fitted_radius_low, 2);
    EXPECT_GT(open.fitted_radius_high, 1.9999);
    EXPECT_LT(open.fitted_radius_high - open.fitted_radius_low, 1e-4);
    // A corner is not an arc.
    const auto corner = describe_slice(
        slice_mesh(build_mesh(grid(80, 1, false, false,
                                   [](double s, double t) {
                                       return std::array<double, 3>{std::max(0.0, 1 - 2 * s), std::max(0.0, 2 * s - 1), t};
                                   })),
                   frame, {0.4})
            .slices[0]);
    EXPECT_TRUE(std::isnan(corner.fitted_radius));
    EXPECT_NEAR(open.open_length, 8, 1e-3);
    EXPECT_EQ(open.components, 0);
    // An inner wall runs clockwise: it is not an outline.
    EXPECT_TRUE(std::isnan(describe_slice(slice_mesh(arc(4, 0, 2), frame, {0.4}).slices[0]).fitted_radius));
    // Nothing at all.
    const auto nothing = describe_slice(slice_mesh(arc(0, 4, 2), frame, {4}).slices[0]);
    for (const auto& [name, value] : numbers(nothing)) {
        if (name != "euler number") {
            EXPECT_TRUE(std::isnan(value)) << name;
        }
    }
    EXPECT_THROW((void)thickness_profile(Slice{}, 0), Error);
    EXPECT_TRUE(thickness_profile(Slice{}).empty());
}

TEST(SliceDescriptors, CirclesOfShapesThatAreNotRound) {
    // The circle that fits a bar best is nearly a line: the equivalent one replaces it.
    const auto bar = describe({rectangle(20, 1)});
    EXPECT_EQ(bar.roundness_fitted, bar.roundness_equivalent);
    EXPECT_NEAR(bar.fitted_radius, std::sqrt(20 / M_PI), 1e-9);
    EXPECT_GT(bar.roundness_fitted_relative, 0.5);
    // Handles beside a body do not make it less round.
    const auto body = describe({ellipse(80, 3, 2.9)}), handled = describe({ellipse(80, 3, 2.9), ellipse(20, 0.5, 0.5, {5, 0})});
    EXPECT_EQ(handled.roundness_fitted, body.roundness_fitted);
    EXPECT_EQ(handled.circular_variance, body.circular_variance);
    EXPECT_LT(handled.eccentricity, body.eccentricity);
    // The fitted circle is no worse than the equivalent one in the mean square, and is where the arc is, not where the area is.
    const auto egg = describe({{{-2, 0}, {-1, -1.6}, {0, -2}, {1, -1.9}, {3, 0}, {1, 1.9}, {0, 2}, {-1, 1.6}}});
    EXPECT_LT(egg.roundness_fitted_relative, 0.2);
    EXPECT_NEAR(egg.fitted_centre.y(), 0, 1e-9);
}

TEST(SliceDescriptors, SeveralComponents) {
    const auto d = describe({rectangle(2, 2), rectangle(1, 1, {4, 0}), reversed(rectangle(1, 1))});
    EXPECT_EQ(d.components, 2);
    EXPECT_EQ(d.holes, 1);
    EXPECT_EQ(d.euler_number, 1);
    EXPECT_NEAR(d.area, 4, 1e-12);
    EXPECT_NEAR(d.hole_area_ratio, 0.2, 1e-12);
    EXPECT_NEAR(d.box_length, 5.5, 1e-12);
    EXPECT_NEAR(d.thickness_mean, 0.25 + (std::sqrt(0.5) / 2 + std::asinh(1.0) / 4) / 2, 1e-6);
}
