// Cages of synthetic and scanned meshes.
#include "ostraka/cage/cage.h"

#include "annotation/example_meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/synthetic/make_mesh.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>
#include <set>

using namespace ostraka;
using namespace ostraka::example;

namespace {

std::string findings_text(const CageCheck& check) {
    std::string text;
    for (const Finding& f : findings(check, "mm")) text += f.where + " " + f.text + "\n";
    return text;
}

}  // namespace

TEST(Cage, OfSyntheticObjects) {
    for (const char* name : {"teapot", "chair", "hand", "statuette", "vase"}) {
        const SyntheticMesh object = make_mesh(synthetic_object(name), {.vertices = 5000});
        for (const std::uint64_t vertices : {100, 200, 500}) {
            const CageResult result = make_cage(object.mesh, {.vertices = vertices});
            const CageCheck check = check_cage(result.cage, object.mesh);
            EXPECT_TRUE(check.valid()) << name << " " << findings_text(check);
            EXPECT_EQ(result.cage.number_of_vertices(), vertices) << name;
            std::cout << name << " " << vertices << ": alpha " << result.alpha << ", wrap " << result.wrap_vertices << ", genus "
                      << check.genus << ", clearance " << check.clearance << '\n';
        }
    }
}

TEST(Cage, OfRealMeshes) {
    const Path folder = OSTRAKA_SHARED_DATA;
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the real meshes are not here: " << folder;
    // A closed scan, a sculpture with holes, an object of several components, a hand.
    for (const char* file : {"multires/bunny10k.ply", "heritage-scans/gargoyle.ply", "cage-hand-made/teapot.obj",
                             "products-articulated/hand.off", "multires/anchor.off"}) {
        const Mesh mesh = read_mesh(folder / file).mesh;
        const CageResult result = make_cage(mesh, {.vertices = 200});
        const CageCheck check = check_cage(result.cage, mesh);
        EXPECT_TRUE(check.valid()) << file << " " << findings_text(check);
        EXPECT_TRUE(result.reached) << file << " " << result.cage.number_of_vertices();
    }
}

TEST(Cage, MirroredToTheBit) {
    const SyntheticMesh object = make_mesh(synthetic_object("chair"), {.vertices = 4000});
    const auto plane = std::optional<MirrorPlane>({Point(0, 0, 0), Vector(1, 0, 0)});
    const CageResult result = make_cage(object.mesh, {.vertices = 150}, {}, plane);
    const CageCheck check = check_cage(result.cage, object.mesh);
    EXPECT_TRUE(check.valid()) << findings_text(check);
    EXPECT_LE(result.cage.number_of_vertices(), 150U);
    EXPECT_GE(result.cage.number_of_vertices(), 149U);
    std::set<std::array<double, 3>> positions;
    for (const Point& p : result.cage.points()) positions.insert({p.x() == 0 ? 0 : p.x(), p.y(), p.z()});
    for (const auto& [x, y, z] : positions)
        if (std::abs(x) > 1e-6) {
            EXPECT_TRUE(positions.count({-x, y, z})) << x << " " << y << " " << z;
        }
}

TEST(Cage, NestedLevelsEncloseEachOther) {
    const SyntheticMesh object = make_mesh(synthetic_object("statuette"), {.vertices = 3000});
    const auto levels = make_nested_cages(object.mesh, {60, 240, 120});
    ASSERT_EQ(levels.size(), 3U);
    const Mesh* inner = &object.mesh;
    std::size_t expected_vertices = 240;
    for (const CageResult& level : levels) {
        EXPECT_TRUE(check_cage(level.cage, *inner).valid()) << findings_text(check_cage(level.cage, *inner));
        EXPECT_EQ(level.cage.number_of_vertices(), expected_vertices);
        expected_vertices /= 2;
        inner = &level.cage;
    }
}

TEST(Cage, MoreVerticesWhereTheDensityIsHigher) {
    const Mesh mesh = spheres(4);
    const auto count_above = [](const Mesh& cage) {
        std::size_t count = 0;
        for (const Point& p : cage.points()) count += p.z() > 0;
        return count;
    };
    const std::size_t uniform_count = count_above(make_cage(mesh, {.vertices = 100}).cage);
    const CageResult weighted = make_cage(mesh, {.vertices = 100}, [](const Point& p) { return p.z() > 0 ? 6.0 : 1.0; });
    EXPECT_TRUE(check_cage(weighted.cage, mesh).valid());
    EXPECT_NEAR(static_cast<double>(uniform_count), 50, 12);
    EXPECT_GT(count_above(weighted.cage), uniform_count + 15);
}

TEST(Cage, FollowsOrFillsHoles) {
    const SyntheticMesh torus = make_mesh(synthetic_object("torus"), {.vertices = 2000});
    EXPECT_EQ(check_cage(make_cage(torus.mesh, {.vertices = 80}).cage, torus.mesh).genus, 1);
    const CageResult filled = make_cage(torus.mesh, {.vertices = 80, .genus = CageOptions::Genus::fill});
    EXPECT_EQ(check_cage(filled.cage, torus.mesh).genus, 0);
    EXPECT_TRUE(check_cage(filled.cage, torus.mesh).valid());
}

TEST(Cage, OpenFlatTinyHugeAndFarMeshes) {
    const Mesh sheet = grid(5);
    EXPECT_TRUE(check_cage(make_cage(sheet, {.vertices = 30}).cage, sheet).valid());
    const Mesh triangle = build_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
    EXPECT_TRUE(check_cage(make_cage(triangle, {.vertices = 12}).cage, triangle).valid());
    for (const auto& [scale, shift] : {std::pair{1e-6, 0.0}, {1e6, 0.0}, {1.0, 1e5}}) {
        TriangleSoup soup = to_soup(spheres(3));
        for (auto& p : soup.points) p = {p[0] * scale + shift, p[1] * scale, p[2] * scale - shift};
        const Mesh mesh = build_mesh(soup);
        const CageResult result = make_cage(mesh, {.vertices = 40});
        EXPECT_TRUE(check_cage(result.cage, mesh).valid())
            << scale << " " << shift << " " << findings_text(check_cage(result.cage, mesh));
        EXPECT_EQ(result.cage.number_of_vertices(), 40U);
    }
    EXPECT_THROW(make_cage(Mesh()), Error);
    EXPECT_THROW(make_cage(build_mesh({{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}})), Error);
    EXPECT_THROW(make_cage(triangle, {.vertices = 3}), Error);
}

TEST(Cage, RejectsMeshesThatCannotBeWrapped) {
    const auto problem = [](const Mesh& mesh, const std::optional<MirrorPlane>& plane = {}) -> std::string {
        try {
            make_cage(mesh, {.vertices = 40}, {}, plane);
        } catch (const Error& error) {
            EXPECT_FALSE(error.remedy().empty());
            return error.problem();
        }
        return "made";
    };
    const auto contains = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
    for (const std::array<double, 3> third : {std::array<double, 3>{2, 4, 6}, {0, 0, 0}, {1, 2, 3}})
        EXPECT_TRUE(contains(problem(build_mesh({{{0, 0, 0}, {1, 2, 3}, third}, {{0, 1, 2}}})), "no face with an area"));
    const auto moved = [](double shift) {
        TriangleSoup soup = to_soup(spheres(3));
        for (auto& p : soup.points) p = {50 * p[0] + shift, 50 * p[1] - shift, 50 * p[2] + shift};
        return build_mesh(soup);
    };
    TriangleSoup line = to_soup(spheres(3));
    for (auto& p : line.points) p = {p[0], p[0], p[0]};
    EXPECT_TRUE(contains(problem(build_mesh(line)), "no face with an area"));
    for (const double shift : {1e14, 1e15, 1e16})
        EXPECT_TRUE(contains(problem(moved(shift)), "too far from the origin for its size")) << shift;
    const Mesh distant = moved(1e12);
    EXPECT_TRUE(check_cage(make_cage(distant, {.vertices = 40}).cage, distant).valid());
    EXPECT_TRUE(contains(problem(moved(0), MirrorPlane{{NAN, 0, 0}, {1, 0, 0}}), "not finite"));
    EXPECT_TRUE(contains(problem(moved(0), MirrorPlane{{0, 0, 0}, {0, INFINITY, 0}}), "not finite"));
    EXPECT_TRUE(contains(problem(moved(0), MirrorPlane{{0, 0, 0}, {0, 0, 0}}), "normal is zero"));
    EXPECT_TRUE(contains(problem(moved(0), MirrorPlane{{1e17, 0, 0}, {1, 0, 0}}), "too far"));
}

TEST(Cage, GoesAroundFacesOnly) {
    TriangleSoup soup = to_soup(spheres(2));
    soup.points.push_back({0, 0, 9});
    const Mesh mesh = build_mesh(soup);
    const CageResult result = make_cage(mesh, {.vertices = 40});
    EXPECT_EQ(to_soup(result.cage).points, to_soup(make_cage(spheres(2), {.vertices = 40}).cage).points);
    // The check reports the vertex that is then outside, and its distance.
    const CageCheck check = check_cage(result.cage, mesh);
    ASSERT_EQ(check.outside.size(), 1U);
    EXPECT_EQ(check.outside[0].vertex, mesh.number_of_vertices() - 1);
    EXPECT_NEAR(check.outside[0].distance, 8, 0.5);
    EXPECT_FALSE(check.valid());
    soup.points.back() = {0, 0, 0};
    EXPECT_TRUE(check_cage(result.cage, build_mesh(soup)).valid());
}

TEST(Cage, EnclosesEveryComponent) {
    const Mesh mesh = spheres(2, {{0, 0, 0}, {40, 0, 0}, {0, 30, 0}}, 0.5);
    const CageResult result = make_cage(mesh, {.vertices = 40});
    EXPECT_TRUE(check_cage(result.cage, mesh).valid()) << findings_text(check_cage(result.cage, mesh));
}

TEST(CheckCage, TheSameInEveryUnitAndFarAway) {
    const auto in_unit = [](TriangleSoup soup, double unit, double shift = 0) {
        for (auto& p : soup.points) p = {p[0] * unit + shift, p[1] * unit - shift, p[2] * unit + shift};
        return build_mesh(soup);
    };
    const TriangleSoup ball = to_soup(spheres(2)), shifted = to_soup(spheres(1, {{1, 0, 0}}, 1.5));
    const CageCheck reference = check_cage(in_unit(shifted, 1), in_unit(ball, 1));
    ASSERT_FALSE(reference.outside.empty());
    for (const int exponent : {-190, -60, 20, 53, 60, 66, 133, 190}) {
        const double unit = std::ldexp(1.0, exponent);
        EXPECT_EQ(check_cage(in_unit(ball, unit), in_unit(ball, unit)).touching, ball.points.size()) << exponent;
        const CageCheck scaled = check_cage(in_unit(shifted, unit), in_unit(ball, unit));
        ASSERT_EQ(scaled.outside.size(), reference.outside.size()) << exponent;
        for (std::size_t i = 0; i < reference.outside.size(); ++i) {
            EXPECT_EQ(scaled.outside[i].vertex, reference.outside[i].vertex);
            EXPECT_DOUBLE_EQ(scaled.outside[i].distance, reference.outside[i].distance * unit) << exponent;
        }
    }
    // As far away as the precision of coordinates permits.
    const Mesh distant = in_unit(ball, 64, std::ldexp(1.0, 53));
    EXPECT_EQ(check_cage(distant, distant).touching, distant.number_of_vertices());
}

TEST(CheckCage, ACageWithoutAreaIsAFinding) {
    TriangleSoup flat = to_soup(spheres(1));
    for (auto& p : flat.points) p = {p[0], p[0], p[0]};
    const CageCheck check = check_cage(build_mesh(flat), spheres(1));
    EXPECT_TRUE(check.flat);
    EXPECT_FALSE(check.encloses());
    EXPECT_FALSE(check.valid());
    EXPECT_NE(findings_text(check).find("no face with an area"), std::string::npos) << findings_text(check);
}

TEST(CheckCage, ReportsDefectsWithTheirLocation) {
    const Mesh mesh = spheres(2);
    const Mesh cage = spheres(1, {{0, 0, 0}}, 1.5);
    EXPECT_TRUE(check_cage(cage, mesh).valid());
    EXPECT_TRUE(findings(check_cage(cage, mesh), "mm").empty());
    const CageCheck shifted = check_cage(spheres(1, {{1, 0, 0}}, 1.5), mesh);
    EXPECT_FALSE(shifted.valid());
    ASSERT_FALSE(shifted.outside.empty());
    // The reported distance of each outside vertex from the nearest face is right.
    for (const OutsideVertex& o : shifted.outside) EXPECT_GT(o.distance, 0);
    EXPECT_NE(findings(shifted, "mm").front().text.find(" mm outside near face "), std::string::npos);
    EXPECT_EQ(check_cage(mesh, mesh).touching, mesh.number_of_vertices());
    EXPECT_FALSE(check_cage(grid(3), mesh).closed);
    EXPECT_EQ(check_cage(Mesh(), mesh).components, 0U);
    TriangleSoup inside_out = to_soup(cage);
    for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
    EXPECT_FALSE(check_cage(build_mesh(inside_out), mesh).outward);
    // Two intersecting balls.
    const CageCheck intersecting = check_cage(spheres(2, {{0, 0, 0}, {1, 0, 0}}, 1.5), mesh);
    EXPECT_FALSE(intersecting.intersections.empty());
    EXPECT_EQ(intersecting.components, 2U);
    // Two balls in two parts of a cage; a bar between them would cross it.
    EXPECT_TRUE(check_cage(spheres(2, {{0, 0, 0}, {5, 0, 0}}, 1.5), spheres(2, {{0, 0, 0}, {5, 0, 0}})).encloses());
    TriangleSoup bar;
    bar.points = {{0, -0.1, 0}, {5, -0.1, 0}, {0, 0.1, 0}, {0, 0, 0.1}};
    bar.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    const CageCheck crossing = check_cage(spheres(2, {{0, 0, 0}, {5, 0, 0}}, 1.5), build_mesh(bar));
    EXPECT_TRUE(crossing.outside.empty());
    EXPECT_FALSE(crossing.crossing.empty());
}
