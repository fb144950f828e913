// `ostraka measure distance` as users run it.
#include "meshes.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/files/json.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/render/values.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace ostraka {
namespace {
using test::run_command;
using test::Scratch;

class DistanceCommand : public ::testing::Test {
protected:
    Scratch scratch;
    Path before = scratch / "before.ply", after = scratch / "after.ply", parts = scratch / "after.ant.json";

    /// A ball of radius 50 with noise 0.02; later, the top is worn by 0.5 and the bottom was restored by 0.3.
    static Mesh ball(unsigned seed, bool changed) {
        TriangleSoup soup = test::octahedron_sphere(6);
        std::mt19937 random(seed);
        std::normal_distribution<double> noise(0, 0.02);
        for (auto& p : soup.points) {
            const double change = !changed ? 0 : p[2] > 0.8 ? -0.5 : p[2] < -0.8 ? 0.3 : 0;
            const double r = 50 + change + noise(random);
            for (double& c : p) c *= r;
        }
        return build_mesh(soup);
    }
    void SetUp() override {
        const Mesh later = ball(2, true);
        write_mesh(before, ball(1, false));
        write_mesh(after, later);
        AnnotationSet set;
        set.unit = "mm";
        ensure_root(set, later);
        for (const double sign : {1.0, -1.0}) {
            Annotation& part = set.annotations.emplace_back();
            part.id = static_cast<int>(set.annotations.size());
            part.tag = sign > 0 ? "top" : "bottom";
            for (const Face f : later.faces())
                if (sign * centroid(later, f).z() > 45) part.faces.push_back(f);
        }
        write_annotations(parts, {later, set}, after.string(), {});
    }
    [[nodiscard]] Json report_of(const std::string& words) const {
        const auto result = run_command("measure distance " + words + " --json");
        EXPECT_EQ(result.code, 0) << result.err;
        return parse_json(result.out, "report");
    }
    [[nodiscard]] std::string pair() const { return after.string() + " " + before.string(); }
};

TEST_F(DistanceCommand, WearAndRestorationAreMeasuredByPart) {
    const Json report = report_of(pair() + " --annotations " + parts.string() + " --tolerance 0.1,1 --registration-error 0.001");
    const auto& result = report["result"];
    EXPECT_STREQ(result["unit"].GetString(), "mm");
    EXPECT_TRUE(result["overlap"].GetBool());
    EXPECT_NEAR(result["hausdorff"].GetDouble(), 0.55, 0.07);
    EXPECT_GE(result["hausdorffBound"].GetDouble(), result["hausdorff"].GetDouble());
    const auto& forth = result["directions"][0];
    EXPECT_NEAR(forth["mean"].GetDouble(), 0.1 * -0.5 + 0.1 * 0.3, 0.01);
    EXPECT_NEAR(forth["volumeBelow"].GetDouble(), 0.1 * 4 * M_PI * 2500 * 0.5 + 190, 150);  // the noise adds 190
    EXPECT_NEAR(result["directions"][1]["mean"].GetDouble(), -forth["mean"].GetDouble(), 0.01);
    ASSERT_EQ(result["quantiles"].Size(), 10U);
    for (unsigned i : {0U, 5U})
        for (unsigned k = i; k < i + 4; ++k)
            EXPECT_LE(result["quantiles"][k]["distance"].GetDouble(), result["quantiles"][k + 1]["distance"].GetDouble());
    const auto& place = result["quantiles"][4]["place"];
    EXPECT_GT(place[2].GetDouble(), 35);
    ASSERT_EQ(result["tolerances"].Size(), 4U);
    EXPECT_NEAR(result["tolerances"][0]["below"].GetDouble(), 0.1, 0.01);
    EXPECT_NEAR(result["tolerances"][0]["above"].GetDouble(), 0.1, 0.01);
    EXPECT_EQ(result["tolerances"][1]["within"].GetDouble(), 1);
    const auto& significance = result["significance"][0];
    EXPECT_NEAR(significance["noise"].GetDouble(), 0.02, 0.003);
    EXPECT_EQ(significance["assessed"].GetDouble(), 1);
    EXPECT_NEAR(significance["significant"].GetDouble(), 0.21, 0.03);
    ASSERT_EQ(result["parts"].Size(), 3U);
    EXPECT_STREQ(result["parts"][1]["tag"].GetString(), "top");
    EXPECT_NEAR(result["parts"][1]["mean"].GetDouble(), -0.5, 0.01);
    EXPECT_GT(result["parts"][1]["below"].GetDouble(), 0.99);
    EXPECT_NEAR(result["parts"][2]["mean"].GetDouble(), 0.3, 0.01);
    EXPECT_GT(result["parts"][2]["above"].GetDouble(), 0.99);
}

TEST_F(DistanceCommand, WritesMapsAndPictures) {
    const Path map = scratch / "map.npy", back = scratch / "back.txt", level = scratch / "level.npy";
    for (const char* picture : {"map.svg", "map.png", "map.pdf"}) {
        const auto result = run_command(
            "measure distance " + pair() + " --samples 1000 --output " + map.string() + " --back " + back.string() + " --level " +
            level.string() + " --unit mm --tolerance 0.2 --size 400x200" + " --picture " + (scratch / picture).string());
        ASSERT_EQ(result.code, 0) << result.err;
        EXPECT_GT(std::filesystem::file_size(scratch / picture), 3000U);
    }
    const Mesh later = read_mesh(after).mesh;
    const std::vector<double> values = read_values(map), levels = read_values(level);
    ASSERT_EQ(values.size(), later.number_of_vertices());
    ASSERT_EQ(levels.size(), values.size());
    EXPECT_EQ(read_values(back).size(), read_mesh(before).mesh.number_of_vertices());
    for (const Vertex v : later.vertices())
        if (later.point(v).z() > 45) {
            ASSERT_NEAR(values[v], -0.5, 0.15);
            ASSERT_LT(levels[v], 0.2);
        }
    const std::string svg = read_file(scratch / "map.svg");
    EXPECT_NE(svg.find("<image"), std::string::npos);
    EXPECT_EQ(
        run_command("render " + after.string() + " " + (scratch / "seen.png").string() + " --size 100x80 --map " + map.string())
            .code,
        0);
}

TEST_F(DistanceCommand, MeshesThatAreNotRegisteredAreNamed) {
    Mesh away = ball(1, false), large = away;
    for (const Vertex v : away.vertices()) {
        away.point(v) = away.point(v) + Vector(200, 0, 0);
        large.point(v) = CGAL::ORIGIN + 10 * (large.point(v) - CGAL::ORIGIN);
    }
    write_mesh(scratch / "away.ply", away);
    write_mesh(scratch / "large.ply", large);
    for (const auto& [name, words] : {std::pair{"away.ply", "do not overlap"}, {"large.ply", "times as large"}}) {
        const auto result = run_command("measure distance --samples 1000 " + (scratch / name).string() + " " + before.string());
        EXPECT_EQ(result.code, 0) << result.err;
        EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
        EXPECT_NE(result.err.find("ostraka mesh register"), std::string::npos) << result.err;
    }
}

TEST_F(DistanceCommand, AnInsideOutReferenceIsNamed) {
    TriangleSoup soup = to_soup(ball(1, false));
    for (auto& t : soup.triangles) std::swap(t[1], t[2]);
    write_mesh(scratch / "inside.ply", build_mesh(soup));
    const auto result =
        run_command("measure distance --samples 1000 " + after.string() + " " + (scratch / "inside.ply").string());
    EXPECT_NE(result.err.find("inside out"), std::string::npos) << result.err;
}

TEST_F(DistanceCommand, PlacesBeyondTheBorderAreLeftOut) {
    const auto sheet = [&](const std::string& name, double width) {
        write_mesh(scratch / name, build_mesh(test::grid(20, 10, false, false, [&](double u, double v) {
                       return std::array{width * u, v, 0.0};
                   })));
        return (scratch / name).string();
    };
    const std::string words = sheet("large.ply", 2) + " " + sheet("small.ply", 1) + " --samples 1000";
    EXPECT_NEAR(report_of(words)["result"]["hausdorff"].GetDouble(), 1, 1e-9);
    const Json left_out = report_of(words + " --border leave-out --output " + (scratch / "map.npy").string());
    EXPECT_NEAR(left_out["result"]["hausdorff"].GetDouble(), 0, 1e-12);
    EXPECT_FALSE(left_out["result"].HasMember("hausdorffBound"));
    std::size_t without = 0;
    for (const double value : read_values(scratch / "map.npy")) without += std::isnan(value) ? 1U : 0U;
    EXPECT_EQ(without, 110U);
}

TEST_F(DistanceCommand, RefusesBadInputByName) {
    write_file(scratch / "flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    for (const std::string& words :
         {(scratch / "flat.obj").string() + " " + before.string(), before.string() + " " + (scratch / "flat.obj").string()}) {
        const auto result = run_command("measure distance " + words);
        EXPECT_EQ(result.code, 1);
        EXPECT_NE(result.err.find("flat.obj"), std::string::npos) << result.err;
    }
    EXPECT_EQ(run_command("measure distance " + pair() + " --tolerance -1").code, 2);
    EXPECT_EQ(run_command("measure distance " + pair() + " --picture x.jpg").code, 2);
    EXPECT_EQ(run_command("measure distance " + pair() + " --views nowhere").code, 2);
}

}  // namespace
}  // namespace ostraka
