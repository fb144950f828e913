#include "ostraka/slicing/capacity.h"

#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/files/json.h"
#include "ostraka/io/mesh_file.h"
#include "scratch.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <random>
#include <utility>

namespace ostraka {
namespace {

constexpr double pi = std::numbers::pi;
using Eigen::Vector2d;

const Vector upwards(0, 0, 1);

/// A closed cup: outer radius 10, height 40, cavity of radius 7 and depth 30.
std::vector<Vector2d> cup_profile() { return {{0, 0}, {10, 0}, {10, 40}, {7, 40}, {7, 10}, {0, 10}}; }
constexpr double cup_capacity = pi * 49 * 30;

/// The surface z = height(r) over a disc, as a thin bowl, with triangles of alternating columns.
Mesh bowl(Index columns, Index rows, double radius, const std::function<double(double)>& height) {
    TriangleSoup soup;
    soup.points.push_back({0, 0, height(0)});
    for (Index j = 1; j <= rows; ++j)
        for (Index i = 0; i < columns; ++i) {
            const double r = radius * j / rows, a = 2 * pi * (i + 0.5 * (j % 2)) / columns;
            soup.points.push_back({r * std::cos(a), r * std::sin(a), height(r)});
        }
    const auto at = [&](Index j, Index i) { return 1 + (j - 1) * columns + i % columns; };
    for (Index i = 0; i < columns; ++i) soup.triangles.push_back({0, at(1, i), at(1, i + 1)});
    for (Index j = 1; j < rows; ++j)
        for (Index i = 0; i < columns; ++i) {
            soup.triangles.push_back({at(j, i), at(j + 1, i), at(j + 1, i + 1)});
            soup.triangles.push_back({at(j, i), at(j + 1, i + 1), at(j, i + 1)});
        }
    return build_mesh(soup);
}

TriangleSoup moved(TriangleSoup soup, const Eigen::Matrix3d& rotation, double scale, const Eigen::Vector3d& shift) {
    for (auto& p : soup.points) {
        const Eigen::Vector3d q = scale * (rotation * Eigen::Vector3d(p[0], p[1], p[2])) + shift;
        p = {q.x(), q.y(), q.z()};
    }
    return soup;
}

TEST(Capacity, ClosedFormsToATenThousandth) {
    const auto expect = [](const Mesh& mesh, double volume, const char* name) {
        const Capacity capacity = find_capacity(mesh, upwards);
        ASSERT_TRUE(capacity.known()) << name << ": " << capacity.reason;
        EXPECT_NEAR(capacity.full.volume / volume, 1, 1e-4) << name;
        std::cout << name << ": relative error " << capacity.full.volume / volume - 1 << '\n';
    };
    expect(revolve_profile(cup_profile()), cup_capacity, "cylinder");
    expect(revolve_profile({{0, 0}, {5, 10}}), pi * 25 * 10 / 3, "cone");
    expect(revolve_profile({{0, 0}, {3, 0}, {5, 10}}), pi * 10 / 3 * (9 + 15 + 25), "truncated cone");
    expect(bowl(720, 400, 3, [](double r) { return r * r; }), pi * 81 / 2, "paraboloid");
    // A ring channel: half a torus open upwards.
    expect(build_mesh(test::grid(
               900, 200, true, false,
               [](double u, double v) {
                   const double a = 2 * pi * u, b = pi + pi * v;
                   return std::array<double, 3>{(2 + std::cos(b)) * std::cos(a), (2 + std::cos(b)) * std::sin(a), std::sin(b)};
               })),
           2 * pi * pi, "half torus");
    std::vector<Vector2d> quarter;
    for (int i = 0; i <= 1000; ++i) quarter.emplace_back(5 * std::sin(pi * i / 2000), -5 * std::cos(pi * i / 2000));
    quarter.front().x() = 0;
    expect(revolve_profile(quarter), 2 * pi / 3 * 125, "hemisphere");
}

TEST(Capacity, IsExactForTheTriangles) {
    // A square box without lid: 2 x 3 x 4.
    TriangleSoup soup = test::box(4);
    for (auto& p : soup.points) p = {2 * p[0], 3 * p[1], 4 * p[2]};
    std::erase_if(soup.triangles, [&](const auto& t) {
        return soup.points[t[0]][2] == 4 && soup.points[t[1]][2] == 4 && soup.points[t[2]][2] == 4;
    });
    const Capacity capacity = find_capacity(build_mesh(soup), upwards, {{FillRequest::Kind::height, 1.3, {}}});
    EXPECT_NEAR(capacity.full.volume, 24, 1e-12);
    EXPECT_NEAR(capacity.full.surface, 6, 1e-12);
    EXPECT_NEAR(capacity.levels.at(0).volume, 6 * 1.3, 1e-12);
    EXPECT_EQ(capacity.cavities.at(0).over, Overflow::rim);
}

TEST(Capacity, LevelsSharesAndLandmarks) {
    using Kind = FillRequest::Kind;
    const Capacity capacity = find_capacity(revolve_profile(cup_profile()), upwards,
                                            {{Kind::height, 15, {}},
                                             {Kind::share, 0.8, {}},
                                             {Kind::share, 1, {}},
                                             {Kind::height, 0, Point(7, 0, 20)},
                                             {Kind::height, 31, {}},
                                             {Kind::height, -1, {}}});
    EXPECT_NEAR(capacity.full.height, 30, 1e-9);
    EXPECT_NEAR(capacity.full.level, 40, 1e-9);
    EXPECT_NEAR(capacity.levels.at(0).volume, pi * 49 * 15, 1e-6);
    EXPECT_NEAR(capacity.levels.at(1).volume, pi * 49 * 24, 1e-6);
    EXPECT_NEAR(capacity.levels.at(2).volume, capacity.full.volume, 1e-9);
    EXPECT_NEAR(capacity.levels.at(3).volume, pi * 49 * 10, 1e-6);
    for (const std::size_t i : {4U, 5U}) {
        EXPECT_TRUE(std::isnan(capacity.levels.at(i).volume));
        EXPECT_FALSE(capacity.levels.at(i).reason.empty());
    }
    EXPECT_TRUE(capacity.known());
}

TEST(Capacity, OrientationOfTheMeshDoesNotMatter) {
    std::vector<Vector2d> reversed = cup_profile();
    std::reverse(reversed.begin(), reversed.end());
    EXPECT_NEAR(find_capacity(revolve_profile(reversed), upwards).full.volume, cup_capacity, 1e-6 * cup_capacity);
    const Mesh bowl_inwards = revolve_profile({{5, 10}, {3, 0}, {0, 0}});
    EXPECT_NEAR(find_capacity(bowl_inwards, upwards).full.volume, pi * 10 / 3 * 49, 1e-6 * 513);
}

TEST(Capacity, OverturnedDomesAndSealedVesselsHoldNothing) {
    const Mesh cup = revolve_profile(cup_profile());
    const Capacity overturned = find_capacity(cup, Vector(0, 0, -1));
    EXPECT_FALSE(overturned.known());
    EXPECT_TRUE(std::isnan(overturned.full.volume));
    EXPECT_FALSE(find_capacity(bowl(90, 20, 3, [](double r) { return -r * r; }), upwards).known());
    EXPECT_FALSE(find_capacity(build_mesh(test::octahedron_sphere(4)), upwards).known()) << "a solid ball";
    // A ball with a cavity that is closed all round.
    TriangleSoup shell = test::octahedron_sphere(4);
    TriangleSoup inner = moved(shell, Eigen::Matrix3d::Identity(), 0.5, Eigen::Vector3d::Zero());
    const auto count = static_cast<Index>(shell.points.size());
    shell.points.insert(shell.points.end(), inner.points.begin(), inner.points.end());
    for (const auto& t : inner.triangles) shell.triangles.push_back({t[0] + count, t[2] + count, t[1] + count});
    const Capacity sealed = find_capacity(build_mesh(shell), upwards);
    EXPECT_FALSE(sealed.known());
    EXPECT_NE(sealed.reason.find("closed on all sides"), std::string::npos) << sealed.reason;
    ASSERT_FALSE(sealed.cavities.empty());
    EXPECT_NEAR(sealed.cavities[0].full.volume, 4 * pi / 3 / 8, 0.01 * 4 * pi / 3 / 8);
}

TEST(Capacity, SpoutsNotchesAndHolesDetermineTheOverflow) {
    // A thin cup of radius 1 and height 3 whose rim has a notch down to 2.5.
    TriangleSoup soup = test::grid(60, 30, true, false, [](double u, double v) {
        const double rim = 3 - 0.5 * std::exp(-200 * (u - 0.5) * (u - 0.5));
        return std::array<double, 3>{std::cos(2 * pi * u), std::sin(2 * pi * u), rim * v};
    });
    const auto base = static_cast<Index>(soup.points.size());
    soup.points.push_back({0, 0, 0});
    for (Index i = 0; i < 60; ++i) soup.triangles.push_back({base, (i + 1) % 60, i});
    const double area = 30 * std::sin(2 * pi / 60);
    const Capacity notched = find_capacity(build_mesh(soup), upwards);
    EXPECT_NEAR(notched.full.volume, 2.5 * area, 1e-9);
    EXPECT_NEAR(notched.cavities.at(0).overflow.x(), -1, 1e-9);
    EXPECT_EQ(notched.cavities.at(0).over, Overflow::rim);
    // A hole in the wall: two triangles at height 1.
    TriangleSoup holed = soup;
    holed.triangles.erase(holed.triangles.begin() + 2 * (10 * 60 + 5), holed.triangles.begin() + 2 * (10 * 60 + 5) + 2);
    const Capacity leaking = find_capacity(build_mesh(holed), upwards, {{FillRequest::Kind::height, 2, {}}});
    EXPECT_NEAR(leaking.full.volume, area, 1e-9);
    EXPECT_EQ(leaking.cavities.at(0).over, Overflow::hole);
    EXPECT_FALSE(leaking.levels.at(0).reason.empty()) << "above the hole";
}

TEST(Capacity, UnscannedWallGivesAnUpperBoundOnly) {
    // The closed cup with a hole in its inner wall below the rim: behind it is clay, or a hollow.
    TriangleSoup soup = to_soup(revolve_profile(cup_profile(), 90));
    std::size_t removed = 0;
    std::erase_if(soup.triangles, [&](const auto& t) {
        const bool floor = soup.points[t[0]][2] == 10 && soup.points[t[1]][2] == 10 && soup.points[t[2]][2] == 10;
        return floor && removed++ < 3;
    });
    ASSERT_GT(removed, 3U);
    const Capacity capacity = find_capacity(build_mesh(soup), upwards);
    EXPECT_FALSE(capacity.known());
    EXPECT_NE(capacity.reason.find("hole below its rim"), std::string::npos) << capacity.reason;
}

TEST(Capacity, AMissingTriangleOfTheRimOrTheBaseDoesNotMakeClayACavity) {
    // A thick-walled cup, whose clay has more volume than its cavity, with a triangle missing at the rim or at the base.
    const std::vector<Vector2d> thick{{0, 0}, {10, 0}, {10, 40}, {4, 40}, {4, 10}, {0, 10}};
    for (const double height : {40.0, 0.0}) {
        TriangleSoup soup = to_soup(revolve_profile(thick, 90));
        bool removed = false;
        std::erase_if(soup.triangles, [&](const auto& t) {
            const bool level = soup.points[t[0]][2] == height && soup.points[t[1]][2] == height && soup.points[t[2]][2] == height;
            return level && !std::exchange(removed, removed || level);
        });
        const Capacity capacity = find_capacity(build_mesh(soup), upwards);
        ASSERT_TRUE(capacity.known()) << capacity.reason;
        EXPECT_NEAR(capacity.full.volume, pi * 16 * 30, 1e-6 * pi * 16 * 30) << "missing at " << height;
    }
}

TEST(Capacity, TwoCompartmentsCountTogetherAboveTheirPartition) {
    // A trough of 4 x 2 x 3 with a thin partition of height 1 at x = 1.
    TriangleSoup soup;
    soup.points = {{0, 0, 3}, {0, 0, 0}, {1, 0, 1}, {4, 0, 0}, {4, 0, 3}, {0, 2, 3}, {0, 2, 0}, {1, 2, 1}, {4, 2, 0}, {4, 2, 3}};
    // Floor with a ridge at x = 1 (height 1), four walls.
    soup.triangles = {{1, 2, 7}, {1, 7, 6}, {2, 3, 8}, {2, 8, 7}, {0, 1, 6}, {0, 6, 5}, {3, 4, 9},
                      {3, 9, 8}, {0, 2, 1}, {0, 4, 2}, {2, 4, 3}, {5, 6, 7}, {5, 7, 9}, {7, 8, 9}};
    const Mesh mesh = build_mesh(soup);
    const double ridge = 2 * (0.5 * 1 * 1 + 0.5 * 3 * 1);
    const Capacity capacity =
        find_capacity(mesh, upwards, {{FillRequest::Kind::height, 0.5, {}}, {FillRequest::Kind::height, 1, {}}});
    EXPECT_NEAR(capacity.full.volume, 24 - ridge, 1e-12);
    EXPECT_NEAR(capacity.levels.at(1).volume, 8 - ridge, 1e-12);
    EXPECT_NEAR(capacity.levels.at(0).volume, (8 - ridge) / 4, 1e-12) << "both hollows";
    EXPECT_EQ(capacity.cavities.size(), 1U);
}

TEST(Capacity, HandlesBesideTheWallHoldNothing) {
    TriangleSoup soup = to_soup(revolve_profile(cup_profile(), 90));
    const Eigen::Matrix3d upright = Eigen::AngleAxisd(pi / 2, Eigen::Vector3d::UnitX()).toRotationMatrix();
    const TriangleSoup handle = moved(test::torus(60, 20), upright, 3, {30, 0, 20});
    const auto count = static_cast<Index>(soup.points.size());
    soup.points.insert(soup.points.end(), handle.points.begin(), handle.points.end());
    for (const auto& t : handle.triangles) soup.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
    const Capacity capacity = find_capacity(build_mesh(soup), upwards);
    EXPECT_NEAR(capacity.full.volume, cup_capacity, 1e-6 * cup_capacity);
    // A ball that lies in the vessel takes its room.
    const TriangleSoup ball = moved(test::octahedron_sphere(4), Eigen::Matrix3d::Identity(), 3, {0, 0, 20});
    const double ball_volume = cup_capacity - [&] {
        TriangleSoup with_ball = to_soup(revolve_profile(cup_profile(), 90));
        const auto first = static_cast<Index>(with_ball.points.size());
        with_ball.points.insert(with_ball.points.end(), ball.points.begin(), ball.points.end());
        for (const auto& t : ball.triangles) with_ball.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
        return find_capacity(build_mesh(with_ball), upwards).full.volume;
    }();
    EXPECT_NEAR(ball_volume, 4 * pi / 3 * 27, 0.02 * 113);
}

TEST(Capacity, IsInvariantToScalePlaceAndRotation) {
    const TriangleSoup soup = to_soup(revolve_profile(cup_profile(), 120));
    for (const double scale : {1e-4, 1.0, 1e4})
        for (const double far : {0.0, 1e5}) {
            const Eigen::Matrix3d rotation = (Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized())).toRotationMatrix();
            const Eigen::Vector3d up = rotation * Eigen::Vector3d::UnitZ();
            const Mesh mesh = build_mesh(moved(soup, rotation, scale, Eigen::Vector3d::Constant(far * scale)));
            CapacityOptions options;
            options.up_error = 0;
            const Capacity capacity = find_capacity(mesh, Vector(up.x(), up.y(), up.z()), {}, options);
            ASSERT_TRUE(capacity.known()) << capacity.reason;
            EXPECT_NEAR(capacity.full.volume / (scale * scale * scale) / cup_capacity, 1, 1e-7) << scale << ' ' << far;
        }
}

TEST(Capacity, UncertaintyOfTheDirectionIsThatOfATiltedCylinder) {
    CapacityOptions options;
    options.up_error = 1;
    options.noise = 0;
    const Capacity capacity = find_capacity(revolve_profile(cup_profile()), upwards, {}, options);
    const double tilt = std::sqrt(2.0) * pi / 180, loss = pi * 343 * std::tan(tilt);
    EXPECT_NEAR(capacity.full.by_direction, loss, 0.01 * loss);
    EXPECT_EQ(capacity.full.by_noise, 0);
    options.wall_error = 0.1;
    const double wetted = pi * 49 + 2 * pi * 7 * 30;
    EXPECT_NEAR(find_capacity(revolve_profile(cup_profile()), upwards, {}, options).full.by_wall, 0.1 * wetted,
                0.01 * wetted * 0.1);
}

TEST(Capacity, NoiseIsEstimatedAndPropagated) {
    // Volumes of noisy bowls scatter as their uncertainty says, at a level below the rim.
    const double sigma = 0.02;
    std::vector<double> volumes;
    double stated = 0;
    std::mt19937 random(7);
    std::normal_distribution<double> normal(0, sigma);
    for (int trial = 0; trial < 24; ++trial) {
        TriangleSoup soup = test::octahedron_sphere(5);
        std::erase_if(soup.triangles,
                      [&](const auto& t) { return soup.points[t[0]][2] + soup.points[t[1]][2] + soup.points[t[2]][2] > 1e-9; });
        TriangleSoup half;
        std::vector<Index> number(soup.points.size(), no_index);
        for (const auto& t : soup.triangles) {
            auto& triangle = half.triangles.emplace_back();
            for (std::size_t k = 0; k < 3; ++k) {
                if (number[t[k]] == no_index) {
                    number[t[k]] = static_cast<Index>(half.points.size());
                    const auto& p = soup.points[t[k]];
                    const double r = 5 + normal(random);
                    half.points.push_back({r * p[0], r * p[1], r * p[2]});
                }
                triangle[k] = number[t[k]];
            }
        }
        CapacityOptions options;
        options.up_error = 0;
        const Mesh mesh = build_mesh(half);
        EXPECT_NEAR(surface_noise(mesh), sigma, 0.25 * sigma);
        const Capacity capacity = find_capacity(mesh, upwards, {{FillRequest::Kind::height, -1, Point(0, 0, 0)}}, options);
        volumes.push_back(capacity.levels.at(0).volume);
        stated = capacity.levels.at(0).by_noise;
    }
    double mean = 0, variance = 0;
    for (const double v : volumes) mean += v / 24;
    for (const double v : volumes) variance += (v - mean) * (v - mean) / 23;
    std::cout << "scatter " << std::sqrt(variance) << ", stated " << stated << '\n';
    EXPECT_LT(std::sqrt(variance), stated) << "the level is known exactly here";
    EXPECT_EQ(surface_noise(build_mesh(test::patch(2, 2))), 0) << "too few vertices";
}

TEST(Capacity, DegenerateMeshes) {
    EXPECT_THROW((void)find_capacity(Mesh(), upwards), Error);
    EXPECT_THROW((void)find_capacity(revolve_profile(cup_profile(), 12), Vector(0, 0, 0)), Error);
    EXPECT_FALSE(find_capacity(build_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}), upwards).known());
    EXPECT_FALSE(find_capacity(build_mesh({{{0, 0, 0}, {1, 0, 1}, {0, 1, 0}}, {{0, 1, 2}}}), upwards).known());
    CapacityOptions options;
    options.up_error = 100;
    EXPECT_THROW((void)find_capacity(revolve_profile(cup_profile(), 12), upwards, {}, options), Error);
    EXPECT_THROW((void)revolve_profile({{1, 0}}), Error);
    EXPECT_THROW((void)revolve_profile({{1, 0}, {-1, 1}}), Error);
    EXPECT_THROW((void)revolve_profile({{0, 0}, {0, 1}}), Error);
}

TEST(Capacity, DoesNotDependOnTheNumberOfThreads) {
    TriangleSoup soup = to_soup(bowl(80, 60, 3, [](double r) { return r * r; }));
    for (auto& p : soup.points) p[2] += 0.05 * std::sin(3 * p[0] + p[1]) + 0.02 * std::cos(5 * p[1]);
    const Mesh mesh = build_mesh(soup);
    const int before = threads();
    set_threads(1);
    const Capacity one = find_capacity(mesh, upwards);
    set_threads(4);
    const Capacity four = find_capacity(mesh, upwards);
    set_threads(before);
    ASSERT_TRUE(one.known()) << one.reason;
    EXPECT_EQ(one.full.volume, four.full.volume);
    EXPECT_EQ(one.full.by_direction, four.full.by_direction);
    EXPECT_EQ(one.noise, four.noise);
}

class CapacityCommand : public testing::Test {
protected:
    [[nodiscard]] Json run(const std::string& arguments, int code) const {
        const auto result = test::run_command("measure capacity --json " + arguments);
        EXPECT_EQ(result.code, code) << arguments << '\n' << result.err << result.out;
        return parse_json(result.out, "report");
    }
    static double value(const Json& report, const char* name) { return report["result"][name].GetDouble(); }
    test::Scratch scratch;
};

TEST_F(CapacityCommand, ReportsLitresLevelsAndUncertainty) {
    const std::string cup = (scratch / "cup.ply").string();
    write_mesh(scratch / "cup.ply", revolve_profile(cup_profile()));
    const Json report = run("--unit cm --level 15 --fill 0.8 " + cup, 0);
    EXPECT_NEAR(value(report, "litres"), cup_capacity / 1000, 1e-6);
    EXPECT_NEAR(value(report, "capacity"), cup_capacity, 1e-3);
    EXPECT_GT(value(report, "uncertainty"), 0);
    ASSERT_EQ(report["result"]["levels"].Size(), 2U);
    EXPECT_NEAR(report["result"]["levels"][1]["volume"].GetDouble(), pi * 49 * 24, 1e-3);
    const auto text = test::run_command("measure capacity --unit cm " + cup);
    EXPECT_NE(text.out.find("litres"), std::string::npos) << text.out;
    EXPECT_EQ(test::run_command("measure capacity --level 35 " + cup).code, 3) << "above the rim";
    EXPECT_EQ(test::run_command("measure capacity --level mark " + cup).code, 2) << "no annotations";
    // Upside down: named, and turned.
    const auto overturned = test::run_command("measure capacity --unit cm --up=-z " + cup);
    EXPECT_EQ(overturned.code, 3);
    EXPECT_NE(overturned.out.find("upside down"), std::string::npos) << overturned.out;
    for (const char* up : {"auto", "axis"})
        EXPECT_NEAR(value(run(std::string("--unit cm --up ") + up + " " + cup, 0), "capacity"), cup_capacity,
                    0.02 * cup_capacity);
}

TEST_F(CapacityCommand, TakesProfiles) {
    const auto profile = scratch.file("profile.csv", "radius,height\n0,0\n10,0\n10,40\n7,40\n7,10\n0,10\n");
    EXPECT_NEAR(value(run("--unit mm " + profile.string(), 0), "capacity"), cup_capacity, 1e-6 * cup_capacity);
    const auto left = scratch.file("left.csv", "x;y\n-5;10\n-3;0\n0;0\n");
    EXPECT_NEAR(value(run(left.string(), 0), "capacity"), pi * 10 / 3 * 49, 1e-3);
    EXPECT_EQ(test::run_command("measure capacity " + scratch.file("slices.csv", "height,area\n1,2\n").string()).code, 1);
    EXPECT_EQ(test::run_command("measure capacity " + scratch.file("word.csv", "radius,height\n1,x\n").string()).code, 1);
    EXPECT_EQ(test::run_command("measure capacity --up auto " + profile.string()).code, 2);
}

TEST_F(CapacityCommand, ClayPointsToTheCapacity) {
    write_mesh(scratch / "cup.ply", revolve_profile(cup_profile()));
    const auto clay = test::run_command("measure clay --unit mm " + (scratch / "cup.ply").string());
    EXPECT_EQ(clay.code, 0);
    EXPECT_NE(clay.out.find("measure capacity"), std::string::npos) << clay.out;
    const auto solid = test::run_command("measure clay --unit mm " OSTRAKA_SOURCE_DIR "/data/conformance/inputs/box.ply");
    EXPECT_EQ(solid.out.find("measure capacity"), std::string::npos) << solid.out;
}

TEST_F(CapacityCommand, SolidObjectsHoldNothing) {
    write_mesh(scratch / "ball.ply", build_mesh(test::octahedron_sphere(3)));
    const Json report = run((scratch / "ball.ply").string(), 3);
    EXPECT_FALSE(report["result"]["known"].GetBool());
    EXPECT_FALSE(report["result"].HasMember("capacity"));
}

}  // namespace
}  // namespace ostraka
