// Volumes of bodies that are inside out, turned, repeated or overlapping.
#include "ostraka/io/bodies.h"

#include "ostraka/core/error.h"
#include "ostraka/files/json.h"
#include "ostraka/io/diagnose.h"
#include "ostraka/io/mesh_file.h"
#include "scratch.h"
#include "soups.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

using soups::both;
using soups::cube;

TriangleSoup turned(TriangleSoup soup) {
    for (auto& t : soup.triangles) std::swap(t[1], t[2]);
    return soup;
}

TEST(Bodies, OrientationDoesNotChangeTheVolume) {
    const SolidBodies right = solid_bodies(cube()), inside_out = solid_bodies(turned(cube()));
    EXPECT_DOUBLE_EQ(right.volume, 1);
    EXPECT_TRUE(right.remarks().empty());
    EXPECT_DOUBLE_EQ(inside_out.volume, 1);
    EXPECT_DOUBLE_EQ(inside_out.signed_volume, -1);
    EXPECT_EQ(inside_out.inside_out, 1U);
    ASSERT_EQ(inside_out.remarks().size(), 1U);
    EXPECT_NE(inside_out.remarks()[0].find("inside out"), std::string::npos);
}

TEST(Bodies, CavitiesAreSubtractedHoweverTheyAreOriented) {
    const TriangleSoup inner = cube({0.25, 0.25, 0.25}, 0.5), core = cube({0.4, 0.4, 0.4}, 0.2);
    for (const bool outer_turned : {false, true})
        for (const bool inner_turned : {false, true}) {
            const SolidBodies bodies =
                solid_bodies(both(outer_turned ? turned(cube()) : cube(), inner_turned ? turned(inner) : inner));
            EXPECT_NEAR(bodies.volume, 0.875, 1e-14);
            EXPECT_EQ(bodies.bound, 0);
            EXPECT_EQ(bodies.cavities, 1U);
            EXPECT_EQ(bodies.turned_cavities, inner_turned ? 0U : 1U);
            EXPECT_EQ(bodies.inside_out, outer_turned ? 1U : 0U);
            EXPECT_NEAR(bodies.centroid[0], 0.5, 1e-12);
        }
    const SolidBodies nested = solid_bodies(both(both(cube(), turned(inner)), core));
    EXPECT_NEAR(nested.volume, 1 - 0.125 + 0.008, 1e-14);
    EXPECT_TRUE(nested.remarks().empty());
    // A cavity off the centre moves the centroid.
    const SolidBodies aside = solid_bodies(both(cube(), turned(cube({0.5, 0.25, 0.25}, 0.25))));
    EXPECT_NEAR(aside.centroid[0], (0.5 - 0.625 / 64) / (1 - 1.0 / 64), 1e-12);
}

TEST(Bodies, OverlapsAreBoundedAndCopiesCountOnce) {
    const SolidBodies overlap = solid_bodies(both(cube(), cube({0.5, 0.3, 0.2})));
    EXPECT_EQ(overlap.overlapping, 2U);
    const double united = 2 - 0.5 * 0.7 * 0.8;
    EXPECT_LE(std::abs(overlap.volume - united), overlap.bound);
    EXPECT_DOUBLE_EQ(overlap.volume + overlap.bound, 2);
    EXPECT_DOUBLE_EQ(overlap.volume - overlap.bound, 1);
    ASSERT_EQ(overlap.remarks().size(), 1U);
    EXPECT_NE(overlap.remarks()[0].find("overlap"), std::string::npos);
    const SolidBodies twice = solid_bodies(both(cube(), cube()));
    EXPECT_DOUBLE_EQ(twice.volume, 1);
    EXPECT_EQ(twice.repeated, 1U);
    EXPECT_EQ(twice.bound, 0);
    // A cavity that breaks through the wall.
    const SolidBodies through = solid_bodies(both(cube(), turned(cube({0.8, 0.25, 0.25}, 0.5))));
    EXPECT_GT(through.bound, 0);
    EXPECT_LE(std::abs(through.volume - (1 - 0.2 * 0.25)), through.bound + 0.125);
    // Apart from each other.
    EXPECT_DOUBLE_EQ(solid_bodies(both(cube(), cube({5, 5, 5}))).volume, 2);
}

TEST(Bodies, DegenerateSoups) {
    EXPECT_EQ(solid_bodies({}).volume, 0);
    TriangleSoup open = cube();
    open.triangles.pop_back();
    EXPECT_EQ(solid_bodies(open).closed, 0U);
    EXPECT_EQ(solid_bodies({{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}}}).closed, 0U);
    EXPECT_THROW((void)solid_bodies({{{0, 0, 0}}, {{0, 1, 2}}}), Error);
    for (const double scale : {1e-6, 1e6}) {
        TriangleSoup far = both(cube(), cube({0.25, 0.25, 0.25}, 0.5));
        for (auto& p : far.points)
            for (double& x : p) x = scale * (x + 1000);
        EXPECT_NEAR(solid_bodies(far).volume / (scale * scale * scale), 0.875, 1e-9);
    }
}

TEST(Bodies, InfoAndDescribeSayWhichAndGiveTheVolume) {
    const test::Scratch scratch;
    const auto file = [&](const std::string& name, const TriangleSoup& soup) {
        write_triangles(scratch / name, soup);
        return (scratch / name).string();
    };
    const std::string inside_out = file("out.ply", turned(cube())),
                      cavity = file("cavity.ply", both(cube(), cube({0.25, 0.25, 0.25}, 0.5))),
                      overlap = file("overlap.ply", both(cube(), cube({0.5, 0.3, 0.2})));
    const auto volume = [](const std::string& line) {
        const auto result = test::run_command(line);
        return parse_json(result.out, "report")["result"]["size"]["volume"].GetDouble();
    };
    EXPECT_DOUBLE_EQ(volume("mesh info --json " + inside_out), 1);
    EXPECT_DOUBLE_EQ(volume("mesh info --json " + cavity), 0.875);
    EXPECT_NE(test::run_command("mesh info " + cavity).out.find("oriented outwards"), std::string::npos);
    EXPECT_NE(test::run_command("mesh info " + overlap).out.find("overlap"), std::string::npos);
    const auto described = [](const std::string& name) {
        const auto result = test::run_command("measure describe --json " + name);
        EXPECT_EQ(result.code, 0) << result.err;
        const Json report = parse_json(result.out, "report");
        std::map<std::string, double> values;
        for (const auto& quantity : report["result"]["annotations"][0]["quantities"].GetArray())
            if (quantity["value"].IsNumber()) values[quantity["name"].GetString()] = quantity["value"].GetDouble();
        values["remarks"] = report["result"].HasMember("notes") ? report["result"]["notes"].Size() : 0;
        return values;
    };
    EXPECT_DOUBLE_EQ(described(inside_out)["volume"], 1);
    EXPECT_NEAR(described(cavity)["volume"], 0.875, 1e-12);
    auto overlapping = described(overlap);
    EXPECT_DOUBLE_EQ(overlapping["volume"], 1.5);
    EXPECT_DOUBLE_EQ(overlapping["volume bound"], 0.5);
    EXPECT_GT(overlapping["remarks"], 1) << "a note names the overlap";
}

}  // namespace
}  // namespace ostraka
