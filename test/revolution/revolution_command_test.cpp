#include "scratch.h"

#include "ostraka/files/file.h"
#include "ostraka/files/json.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/template_package/template.h"
#include "shatter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace ostraka {
namespace {

using test::run_command;

std::string quoted(const Path& path) { return "'" + path.string() + "'"; }

/// A coarse pot in three sherds, in their original poses.
class RevolutionCommand : public ::testing::Test {
protected:
    void SetUp() override {
        PotOptions pot;
        pot.edge = 0.6;
        ShatterOptions breaking;
        breaking.pieces = 3;
        for (const Sherd& sherd : shatter(make_pot(pot), breaking)) {
            files.push_back(scratch / ("sherd" + std::to_string(files.size() + 1) + ".ply"));
            write_mesh(files.back(), sherd.mesh);
        }
    }
    [[nodiscard]] std::string quoted_files() const {
        std::string text;
        for (const Path& file : files) text += quoted(file) + " ";
        return text;
    }
    test::Scratch scratch;
    std::vector<Path> files;
};

TEST_F(RevolutionCommand, ReportsAsInTheSchema) {
    const auto run = run_command("template revolve " + quoted_files() + "--vertices 3000 --unit mm --json --output " +
                                 quoted(scratch / "out"));
    ASSERT_EQ(run.code, 0) << run.err;
    const Json report = parse_json(run.out, "report");
    const JsonValue& result = report["result"];
    validate(result, "vessel", "report");
    EXPECT_NEAR(result["height"].GetDouble(), 20, 0.5);
    EXPECT_TRUE(result["base"].GetBool());
    ASSERT_EQ(result["sherds"].Size(), files.size());
    EXPECT_STREQ(result["sherds"][0]["name"].GetString(), "sherd1");
    const Mesh mesh = read_mesh(scratch / "out" / "vessel.ply").mesh;
    EXPECT_EQ(result["vertices"].GetUint64(), mesh.number_of_vertices());
    const Template built = load_template(read_template(scratch / "out" / "vessel.template.json"));
    for (const Finding& finding : built.findings) EXPECT_FALSE(finding.defect) << finding.text;
    // The schema refuses invalid members.
    Json broken = parse_json(run.out, "report");
    broken["result"].RemoveMember("height");
    EXPECT_THROW(validate(broken["result"], "vessel", "report"), Error);
}

TEST_F(RevolutionCommand, CarriesTheColoursOfSherdsAndTurnsOverThoseThatAreInsideOut) {
    for (const Path& file : files) {
        TriangleSoup soup = to_soup(read_mesh(file).mesh);
        if (file == files[0])
            for (auto& triangle : soup.triangles) std::swap(triangle[1], triangle[2]);
        MeshExtras extras;
        extras.vertex_colours.assign(soup.points.size(), Colour{200, 60, 20, 255});
        write_mesh(file, build_mesh(soup), extras);
    }
    const auto run = run_command("template revolve " + quoted_files() + "--vertices 3000 --output " + quoted(scratch / "out"));
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_NE(run.err.find("sherd1.ply: is inside out: its faces were turned over in memory"), std::string::npos) << run.err;
    const MeshFile vessel = read_mesh(scratch / "out" / "vessel.ply");
    ASSERT_EQ(vessel.extras.vertex_colours.size(), vessel.mesh.number_of_vertices());
    const auto painted = std::count_if(vessel.extras.vertex_colours.begin(), vessel.extras.vertex_colours.end(),
                                       [](const Colour& c) { return std::abs(c[0] - 200) < 3 && std::abs(c[1] - 60) < 3; });
    EXPECT_GT(static_cast<double>(painted), 0.8 * static_cast<double>(vessel.mesh.number_of_vertices()));
}

TEST_F(RevolutionCommand, AFitMatchesRotationsByFractures) {
    ASSERT_EQ(run_command("template revolve " + quoted_files() + "--vertices 6000 --output " + quoted(scratch / "out")).code, 0);
    // Half a turn of the first one about the axis of the vessel, which does not determine its position.
    Mesh mesh = read_mesh(files[0]).mesh;
    for (const Vertex v : mesh.vertices()) mesh.point(v) = Point(-mesh.point(v).x(), -mesh.point(v).y(), mesh.point(v).z());
    write_mesh(files[0], mesh);
    const std::string fit = "fit " + quoted(scratch / "out" / "vessel.template.json") + " " + quoted_files() +
                            "--facets auto --json --output " + quoted(scratch / "fitted");
    const auto run = run_command(fit);
    ASSERT_TRUE(run.code == 0 || run.code == 3) << run.err;
    const Json report = parse_json(run.out, "report");
    const JsonValue& result = report["result"];
    validate(result, "assembly", "report");
    ASSERT_TRUE(result.HasMember("joints"));
    ASSERT_GT(result["joints"].Size(), 0U);
    // The first one is rotated back relative to the others.
    for (const auto& joint : result["joints"].GetArray())
        if (joint["carries"].GetBool() && joint["decided"].GetBool()) {
            const auto pose = [&](const std::string& name) {
                for (const auto& entry : result["fragments"].GetArray())
                    if (name == entry["name"].GetString()) {
                        const double angle = std::atan2(entry["pose"][1][0].GetDouble() - entry["pose"][0][1].GetDouble(),
                                                        entry["pose"][0][0].GetDouble() + entry["pose"][1][1].GetDouble());
                        return angle + (name == "sherd1" ? M_PI : 0.0);
                    }
                ADD_FAILURE() << name;
                return 0.0;
            };
            EXPECT_NEAR(std::remainder(pose(joint["first"].GetString()) - pose(joint["second"].GetString()), 2 * M_PI), 0, 0.06);
        }
    for (const auto& entry : result["fragments"].GetArray()) {
        ASSERT_TRUE(entry.HasMember("turn")) << entry["name"].GetString();
        EXPECT_TRUE(entry["turn"]["decided"].GetBool());
    }
    const auto never = run_command(fit + " --turns never");
    EXPECT_FALSE(parse_json(never.out, "report")["result"].HasMember("joints"));
    EXPECT_EQ(run_command(fit + " --turns perhaps").code, 2);
}

TEST_F(RevolutionCommand, BadFilesAmongGoodOnesAreLeftOutInOneRun) {
    const Path text = scratch / "text.ply", flat = scratch / "flat.ply", cut = scratch / "cut.ply";
    write_file(text, "no mesh\n");
    write_file(cut, read_file(files[1]).substr(0, 2000));
    TriangleSoup box = to_soup(read_mesh(files[0]).mesh);
    for (auto& p : box.points) p = {p[0] / 20, p[1] + 30, p[2]};
    write_mesh(flat, build_mesh(box));
    const std::string command = "template revolve " + quoted(text) + " " + quoted_files() + quoted(flat) + " " + quoted(cut) +
                                " --vertices 3000 --output " + quoted(scratch / "out");
    const auto run = run_command(command + " --json");
    ASSERT_EQ(run.code, 0) << run.err;
    const Json report = parse_json(run.out, "report");
    const JsonValue& result = report["result"];
    validate(result, "vessel", "report");
    ASSERT_EQ(result["sherds"].Size(), files.size() + 3);
    EXPECT_NEAR(result["height"].GetDouble(), 20, 0.5);
    std::size_t left_out_count = 0;
    for (const auto& sherd : result["sherds"].GetArray()) {
        const std::string name = sherd["name"].GetString();
        if (name.rfind("sherd", 0) == 0) {
            EXPECT_STRNE(sherd["use"].GetString(), "left out") << name;
            continue;
        }
        EXPECT_STREQ(sherd["use"].GetString(), "left out") << name;
        EXPECT_TRUE(sherd.HasMember("reason")) << name;
        ++left_out_count;
    }
    EXPECT_EQ(left_out_count, 3U);
    const auto words = run_command(command);
    EXPECT_NE(words.out.find("left out: text"), std::string::npos) << words.out;
    EXPECT_NE(words.out.find("cut.ply"), std::string::npos) << words.out;
    EXPECT_NE(words.out.find("3 of 6 sherds"), std::string::npos) << words.out;
    // Only such sherds: each is named.
    const auto none =
        run_command("template revolve " + quoted(text) + " " + quoted(cut) + " --output " + quoted(scratch / "none"));
    EXPECT_EQ(none.code, 1);
    EXPECT_NE(none.err.find("text.ply"), std::string::npos) << none.err;
    EXPECT_NE(none.err.find("cut.ply"), std::string::npos) << none.err;
}

TEST_F(RevolutionCommand, BadInputIsReportedAndNothingIsWritten) {
    const Path out = scratch / "out";
    const std::string rest = " --output " + quoted(out);
    const auto missing = run_command("template revolve " + quoted(scratch / "nope.ply") + rest);
    EXPECT_EQ(missing.code, 1);
    EXPECT_NE(missing.err.find("nope.ply"), std::string::npos) << missing.err;
    EXPECT_EQ(run_command("template revolve" + rest).code, 2) << "no sherd";
    EXPECT_EQ(run_command("template revolve " + quoted_files()).code, 2) << "no folder";
    EXPECT_EQ(run_command("template revolve " + quoted_files() + "--vertices 1" + rest).code, 2);
    TriangleSoup open = to_soup(read_mesh(files[0]).mesh);
    open.triangles.pop_back();
    write_mesh(scratch / "open.ply", build_mesh(open));
    const auto hole = run_command("template revolve " + quoted(scratch / "open.ply") + rest);
    EXPECT_EQ(hole.code, 1);
    EXPECT_NE(hole.err.find("open"), std::string::npos) << hole.err;
    EXPECT_NE(hole.err.find("not closed"), std::string::npos) << hole.err;
    EXPECT_FALSE(std::filesystem::exists(out / "vessel.ply"));
}

}  // namespace
}  // namespace ostraka
