// Synthetic statuettes: the surface has the specified deviations, and planted properties are found.
#include "ostraka/synthetic/statuettes.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace ostraka {
namespace {

constexpr double pi = std::numbers::pi;

bool closed(const Mesh& mesh) {
    for (const Halfedge h : mesh.halfedges())
        if (mesh.is_border(h)) return false;
    return true;
}

/// The point where the surface is crossed, walking from `inner` (inside) to `outer` along a horizontal ray from `centre`.
double crossing(const SyntheticObject& object, const Eigen::Vector2d& centre, double angle, double z, double inner,
                double outer) {
    const auto value = [&](double r) {
        return object.sample({centre.x() + r * std::cos(angle), centre.y() + r * std::sin(angle), z}).value;
    };
    const double sign = value(inner) < 0 ? 1 : -1;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (inner + outer);
        (sign * value(middle) < 0 ? inner : outer) = middle;
    }
    return inner;
}

/// Fourier coefficient `k` of the outer radius at a height, divided by the mean radius.
std::complex<double> harmonic(const SyntheticObject& object, double z, int k, double reach) {
    std::complex<double> sum = 0;
    double mean = 0;
    const int samples = 180;
    for (int i = 0; i < samples; ++i) {
        const double angle = 2 * pi * i / samples, r = crossing(object, {0, 0}, angle, z, 0.5 * reach, 2 * reach);
        mean += r;
        sum += r * std::polar(1.0, -k * angle);
    }
    return 2.0 * sum / mean;
}

StatuetteParameters plain() {
    StatuetteParameters p;
    p.wall = 0;
    p.vertices = 6000;
    return p;
}

TEST(Statuettes, WithoutDeviationTheBodyIsRound) {
    const auto object = statuette_object(plain());
    for (int k = 1; k < 6; ++k) EXPECT_LT(std::abs(harmonic(*object, 60, k, 19)), 1e-9) << k;
}

TEST(Statuettes, OvalityAndItsDriftAreThoseOfTheSections) {
    StatuetteParameters p = plain();
    p.ovality = 0.04;
    p.ovality_drift = 40;
    const auto object = statuette_object(p);
    const double joint = p.height - std::sqrt(p.head_height * p.head_height * (1 - 0.04));
    const auto low = harmonic(*object, 40, 2, 19), high = harmonic(*object, 80, 2, 19);
    EXPECT_NEAR(std::abs(low), 0.04, 0.0005);
    EXPECT_NEAR(std::abs(high), 0.04, 0.0005);
    // The second harmonic's phase rotates twice as fast as the direction.
    double turned = -(std::arg(high) - std::arg(low)) / 2 * 180 / pi;
    turned = std::remainder(turned, 180);
    EXPECT_NEAR(turned, 40 * 40 / joint, 0.2);
}

TEST(Statuettes, FingerMarksHaveTheStatedDeviation) {
    // One body's waves have random wavelengths: their mean square over all bodies is the stated one.
    double sum = 0;
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        StatuetteParameters p = plain();
        p.finger_marks = 0.01;
        p.seed = seed;
        const auto object = statuette_object(p);
        for (double z = 30; z < 100; z += 10, ++count)
            for (int k = 3; k <= 7; ++k) sum += 0.5 * std::norm(harmonic(*object, z, k, 19));
    }
    EXPECT_NEAR(std::sqrt(sum / count), 0.01, 0.001);
}

TEST(Statuettes, TheWallIsAsThickAsStated) {
    StatuetteParameters p = plain();
    p.wall = 4.5;
    const auto object = statuette_object(p);
    for (const double z : {20.0, 50.0, 80.0, 110.0}) {
        const double outer = crossing(*object, {0, 0}, 1, z, 40, 17), inner = crossing(*object, {0, 0}, 1, z, outer - 2, 2);
        EXPECT_NEAR(outer - inner, 4.5, 0.05) << z;
    }
    p.wall_noise = 0.1;
    const auto uneven = statuette_object(p);
    double sum = 0, squares = 0;
    int count = 0;
    for (double z = 30; z < 100; z += 5)
        for (double angle = 0; angle < 6; angle += 0.5, ++count) {
            const double outer = crossing(*uneven, {0, 0}, angle, z, 40, 17);
            const double wall = outer - crossing(*uneven, {0, 0}, angle, z, outer - 2, 2);
            sum += wall, squares += wall * wall;
        }
    const double mean = sum / count;
    EXPECT_NEAR(std::sqrt(squares / count - mean * mean) / mean, 0.1, 0.03);
}

TEST(Statuettes, GradientAndSlopeBoundHold) {
    StatuetteParameters p;
    p.technique = StatuetteParameters::Technique::hand;
    p.ovality = 0.06;
    p.ovality_drift = 90;
    p.finger_marks = 0.02;
    p.sway = 0.1;
    p.wall_noise = 0.1;
    const auto object = statuette_object(p);
    double steepest = 0;
    for (int i = 0; i < 400; ++i) {
        const Eigen::Vector3d at(25 * std::sin(1.7 * i), 25 * std::sin(2.3 * i + 1), 130 * (0.5 + 0.5 * std::sin(3.1 * i)));
        const Sample s = object->sample(at);
        const double h = 1e-5;
        Eigen::Vector3d numeric;
        for (int k = 0; k < 3; ++k) {
            const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(k);
            numeric[k] = (object->sample(at + step).value - object->sample(at - step).value) / (2 * h);
        }
        // At creases of the distance both one-sided slopes are valid; such points are rare.
        steepest = std::max(steepest, numeric.norm());
        if ((numeric - s.gradient).norm() < 1e-4) continue;
        const double jump = std::abs(object->sample(at + h * s.gradient).value - s.value - h * s.gradient.squaredNorm());
        EXPECT_LT(jump, 4 * h) << at.transpose();
    }
    EXPECT_LE(steepest, 1 + 1e-6);
}

double length(const Point& a, const Point& b) { return std::sqrt(CGAL::squared_distance(a, b)); }

TEST(Statuettes, PlantedSizesAreThoseOfTheLandmarks) {
    using Pose = StatuetteParameters::Pose;
    for (const std::uint64_t seed : {1, 2, 3}) {
        StatuetteParameters p = plain();
        p.technique = StatuetteParameters::Technique::hand;
        p.seed = seed;
        p.vertices = 10000;
        p.height = 180 + 15 * static_cast<double>(seed);
        p.base_diameter = 52 + 3 * static_cast<double>(seed);
        p.head_height = 48 - 2 * static_cast<double>(seed);
        p.arm_length = 70 + 6 * static_cast<double>(seed);
        p.ovality = 0.03;
        p.sway = 0.05;
        p.pose = seed == 1 ? Pose::raised : seed == 2 ? Pose::down : Pose::forward;
        p.hat = static_cast<StatuetteParameters::Hat>(seed == 1 ? 0 : seed == 2 ? 1 : 2);
        const Statuette s = generate_statuette(p);
        const auto place = [&](const std::string& name) {
            for (const StatuetteLandmark& each : s.landmarks)
                if (each.name == name) return position(s.mesh, each.place);
            ADD_FAILURE() << name;
            return Point(0, 0, 0);
        };
        EXPECT_TRUE(closed(s.mesh));
        EXPECT_NEAR(bounding_box(s.mesh).zmax() - bounding_box(s.mesh).zmin(), p.height, 0.01 * p.height) << seed;
        EXPECT_NEAR(length(place("base right"), place("base left")), p.base_diameter, 0.015 * p.base_diameter) << seed;
        EXPECT_NEAR(length(place("head joint"), place("top of the head")), p.head_height, 0.03 * p.head_height) << seed;
        for (const std::string side : {" right", " left"}) {
            double arm = 0;
            Point last = place("arm joint" + side);
            for (const std::string name :
                 {"arm outside 1", "arm outside 2", "arm outside 3", "arm outside 4", "arm outside 5", "hand end"}) {
                const Point next = place(name + side);
                arm += length(last, next);
                last = next;
            }
            EXPECT_NEAR(arm, p.arm_length, 0.06 * p.arm_length) << seed << side;
        }
        for (const StatuetteLandmark& each : s.landmarks) {
            ASSERT_LT(each.vertex, s.mesh.number_of_vertices());
            ASSERT_LT(each.place.element[0], s.mesh.number_of_faces());
        }
    }
}

TEST(Statuettes, TheScannerSeesTheStatedPart) {
    StatuetteParameters p;
    p.vertices = 6000;
    p.cavity_seen = 0.5;
    const Statuette complete = generate_statuette(p);
    EXPECT_TRUE(closed(complete.mesh));
    p.interior = StatuetteParameters::Interior::open;
    const Statuette open = generate_statuette(p);
    EXPECT_FALSE(closed(open.mesh));
    EXPECT_LT(open.mesh.number_of_faces(), complete.mesh.number_of_faces());
    p.interior = StatuetteParameters::Interior::closed;
    p.holes = 3;
    const Statuette holed = generate_statuette(p);
    EXPECT_FALSE(closed(holed.mesh));
    const double lost = surface_area(complete.mesh) - surface_area(holed.mesh);
    EXPECT_GT(lost, 0.3 * pi * p.hole_radius * p.hole_radius);
    EXPECT_LT(lost, 3.5 * pi * p.hole_radius * p.hole_radius);
}

TEST(Statuettes, NoiseMovesVerticesByItsDeviation) {
    StatuetteParameters p = plain();
    const Statuette clean = generate_statuette(p);
    p.scan_noise = 0.1;
    const Statuette noisy = generate_statuette(p);
    ASSERT_EQ(clean.mesh.number_of_vertices(), noisy.mesh.number_of_vertices());
    double squares = 0;
    for (const Vertex v : clean.mesh.vertices()) squares += CGAL::squared_distance(clean.mesh.point(v), noisy.mesh.point(v));
    EXPECT_NEAR(std::sqrt(squares / static_cast<double>(clean.mesh.number_of_vertices())), 0.1, 0.004);
}

TEST(Statuettes, SameForAnyNumberOfThreads) {
    StatuetteParameters p;
    p.vertices = 5000;
    p.interior = StatuetteParameters::Interior::open;
    p.holes = 2;
    p.scan_noise = 0.05;
    set_threads(1);
    const Statuette statuette = generate_statuette(p);
    set_threads(3);
    const Statuette three = generate_statuette(p);
    set_threads(0);
    EXPECT_EQ(mesh_checksum(statuette.mesh), mesh_checksum(three.mesh));
    EXPECT_EQ(statuette.face_labels, three.face_labels);
    p.seed = 2;
    EXPECT_NE(mesh_checksum(statuette.mesh), mesh_checksum(generate_statuette(p).mesh));
}

TEST(Statuettes, ImpossibleParametersAreRefused) {
    StatuetteParameters p;
    p.wall = 12;
    p.base_diameter = 40;
    EXPECT_THROW(statuette_object(p), Error);
    p = {};
    p.head_height = 120;
    EXPECT_THROW(statuette_object(p), Error);
    EXPECT_THROW(set_option(p, "technique", "mould"), Error);
    EXPECT_THROW(statuette_level(0), Error);
    EXPECT_THROW(statuette_level(6), Error);
}

TEST(Population, ObjectsDoNotDependOnTheirNumberAndFollowTheLevel) {
    PopulationOptions options;
    options.objects = 400;
    options.level = 2;
    const auto many = draw_population(options);
    options.objects = 5;
    const auto few = draw_population(options);
    for (std::size_t i = 0; i < few.size(); ++i) EXPECT_EQ(declare_options(many[i]), declare_options(few[i]));
    const StatuetteLevel level = statuette_level(2);
    for (const bool wheel : {true, false}) {
        double sum = 0, squares = 0;
        int count = 0;
        for (const auto& each : many) {
            if ((each.technique == StatuetteParameters::Technique::wheel) != wheel) continue;
            const double x = std::log(each.ovality);
            sum += x, squares += x * x, ++count;
            if (wheel) {
                EXPECT_GT(each.wall, 0);
            }
        }
        EXPECT_EQ(count, 200);
        const double mean = sum / count;
        // Five standard errors.
        EXPECT_NEAR(mean, std::log(wheel ? level.wheel.ovality : level.hand.ovality), 5 * level.spread / std::sqrt(200));
        EXPECT_NEAR(std::sqrt(squares / count - mean * mean), level.spread, 0.25 * level.spread);
    }
}

TEST(Population, LevelsBecomeMoreSimilar) {
    double last = std::numeric_limits<double>::infinity();
    for (int i = 1; i <= 5; ++i) {
        const StatuetteLevel level = statuette_level(i);
        const double apart = std::log(level.hand.ovality / level.wheel.ovality) / level.spread;
        EXPECT_LT(apart, last) << i;
        EXPECT_GT(apart, 0) << i;
        last = apart;
    }
}

}  // namespace
}  // namespace ostraka
