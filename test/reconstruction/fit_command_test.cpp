#include "scratch.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/files/json.h"
#include "ostraka/io/mesh_file.h"

#include <gtest/gtest.h>

#include <set>

namespace ostraka {
namespace {

using test::run_command;
using test::Scratch;

std::string quoted(const Path& path) { return "'" + path.string() + "'"; }

/// A synthetic statuette as a template, and a fragment of another one.
class FitCommand : public ::testing::Test {
protected:
    void SetUp() override {
        ASSERT_EQ(run_command("study make proportions --objects 2 --vertices 4000 --seed 1 " + quoted(scratch / "made")).code, 0);
        ASSERT_EQ(run_command("template pack " + quoted(scratch / "made" / "t.template.json") + " --mesh " +
                              quoted(scratch / "made" / "statuette-1.ply") + " --annotations " +
                              quoted(scratch / "made" / "statuette-1.ant.json"))
                      .code,
                  0);
        const auto broken = run_command("mesh break " + quoted(scratch / "made" / "statuette-2.ply") + " " +
                                        quoted(scratch / "top.ply") + " --at head --share 0.45 --annotations " +
                                        quoted(scratch / "made" / "statuette-2.ant.json") + " --annotations-out " +
                                        quoted(scratch / "top.ant.json") + " --pose-out " + quoted(scratch / "pose.json"));
        ASSERT_EQ(broken.code, 0) << broken.err;
    }
    [[nodiscard]] test::CommandResult fit(const std::string& rest) const {
        return run_command("fit " + quoted(scratch / "made" / "t.template.json") + " " + rest + " --output " +
                           quoted(scratch / "out"));
    }
    Scratch scratch;
};

TEST_F(FitCommand, CompletesAStatuetteAndReportsWhatWasObserved) {
    const auto run = fit(quoted(scratch / "top.ply") + " --placed --json");
    EXPECT_EQ(run.code, 3) << run.err << run.out;
    const Json report = parse_json(run.out, "report");
    const JsonValue& result = report["result"];
    EXPECT_STREQ(result["verdict"].GetString(), "undecided") << "one fragment, no constraint";
    EXPECT_GT(result["observedShare"].GetDouble(), 0.3);
    EXPECT_LT(result["observedShare"].GetDouble(), 0.6);
    ASSERT_EQ(result["fragments"].Size(), 1U);
    EXPECT_STREQ(result["fragments"][0]["name"].GetString(), "top");
    EXPECT_TRUE(result["fragments"][0].HasMember("pose"));
    const MeshFile completed = read_mesh(scratch / "out" / "completed.ply");
    const std::set<std::int32_t> origins(completed.extras.face_labels.begin(), completed.extras.face_labels.end());
    EXPECT_EQ(origins, (std::set<std::int32_t>{0, 1, 2}));
    const AnnotationSet set = read_annotations(scratch / "out" / "completed.ant.json", completed.mesh);
    EXPECT_GT(set.annotations.size(), 10U);
    EXPECT_TRUE(std::filesystem::exists(scratch / "out" / "top.placed.ply"));
    const Json assembly = read_json(scratch / "out" / "fit.assembly.json");
    validate(assembly, "assembly", "assembly");
    EXPECT_TRUE(assembly.HasMember("provenance"));
}

TEST_F(FitCommand, StatedMatchesAreUsed) {
    ASSERT_EQ(fit(quoted(scratch / "top.ply")).code, 3);
    Json assembly = read_json(scratch / "out" / "fit.assembly.json");
    JsonValue& matches = assembly["fragments"][0]["annotations"];
    ASSERT_GT(matches.Size(), 2U);
    const int none = matches[0]["ofFragment"].GetInt();
    matches[0]["ofTemplate"].SetNull();
    matches[0]["stated"].SetBool(true);
    write_json(scratch / "said.assembly.json", assembly);
    const auto run = fit(quoted(scratch / "top.ply") + " --json --assembly " + quoted(scratch / "said.assembly.json"));
    ASSERT_EQ(run.code, 3) << run.err;
    const Json report = parse_json(run.out, "report");
    for (const auto& match : report["result"]["fragments"][0]["annotations"].GetArray())
        EXPECT_NE(match["ofFragment"].GetInt(), none);
    matches[0]["ofTemplate"].SetInt(4711);
    write_json(scratch / "wrong.assembly.json", assembly);
    const auto wrong = fit(quoted(scratch / "top.ply") + " --assembly " + quoted(scratch / "wrong.assembly.json"));
    EXPECT_EQ(wrong.code, 1);
    EXPECT_NE(wrong.err.find("4711"), std::string::npos) << wrong.err;
}

TEST_F(FitCommand, InvalidOptionsAndFilesAreReported) {
    EXPECT_EQ(run_command("fit " + quoted(scratch / "made" / "t.template.json") + " --output " + quoted(scratch / "out")).code,
              2);
    EXPECT_EQ(run_command("fit " + quoted(scratch / "made" / "t.template.json") + " " + quoted(scratch / "top.ply")).code, 2);
    EXPECT_EQ(fit(quoted(scratch / "absent.ply")).code, 1);
    EXPECT_EQ(fit(quoted(scratch / "top.ply") + " " + quoted(scratch / "top.ply")).code, 2);
    EXPECT_EQ(fit(quoted(scratch / "top.ply") + " --detail 0").code, 2);
    EXPECT_FALSE(std::filesystem::exists(scratch / "out")) << "nothing is written before all is read";
    // Two landmarks only.
    ASSERT_EQ(run_command("mesh break " + quoted(scratch / "made" / "statuette-2.ply") + " " + quoted(scratch / "base.ply") +
                          " --at base --share 0.2 --annotations " + quoted(scratch / "made" / "statuette-2.ant.json") +
                          " --annotations-out " + quoted(scratch / "base.ant.json"))
                  .code,
              0);
    const auto two = fit(quoted(scratch / "base.ply") + " --search never");
    EXPECT_EQ(two.code, 3);
    EXPECT_NE(two.out.find("cannot decide"), std::string::npos) << two.out;
    EXPECT_NE(two.out.find("landmark"), std::string::npos) << two.out;
}

TEST_F(FitCommand, AFragmentWithoutSupportIsNotCompatible) {
    // The same fragment twice.
    std::filesystem::copy(scratch / "top.ply", scratch / "again.ply");
    std::filesystem::copy(scratch / "top.ant.json", scratch / "again.ant.json");
    const auto twice = fit(quoted(scratch / "top.ply") + " " + quoted(scratch / "again.ply"));
    EXPECT_EQ(twice.code, 3);
    EXPECT_NE(twice.out.find("against again: "), std::string::npos) << twice.out;
    EXPECT_NE(twice.out.find("where earlier fragments are observed"), std::string::npos) << twice.out;
    EXPECT_NE(twice.out.find("incompatible"), std::string::npos);
    // Another unit, stated.
    Json annotations = read_json(scratch / "again.ant.json");
    annotations["unit"].SetString("cm");
    write_json(scratch / "again.ant.json", annotations);
    const auto unit = fit(quoted(scratch / "again.ply"));
    EXPECT_EQ(unit.code, 1);
    EXPECT_NE(unit.err.find("is in cm, and the template in mm"), std::string::npos) << unit.err;
}

TEST_F(FitCommand, InputsAndEarlierResultsAreNotMixedUp) {
    ASSERT_EQ(fit(quoted(scratch / "top.ply") + " --placed").code, 3);
    EXPECT_TRUE(std::filesystem::exists(scratch / "out" / "top.placed.ply"));
    EXPECT_EQ(
        fit(quoted(scratch / "top.ply") + " --counterparts best --distance-weight 0 --boundary-weight 0 --outline-weight 0").code,
        2);
    // A fragment that lies where the result would be written.
    std::filesystem::copy(scratch / "top.ant.json", scratch / "out" / "completed.ant.json",
                          std::filesystem::copy_options::overwrite_existing);
    std::filesystem::copy(scratch / "top.ply", scratch / "out" / "completed.ply",
                          std::filesystem::copy_options::overwrite_existing);
    const std::string before = read_file(scratch / "out" / "completed.ply");
    const auto over = fit(quoted(scratch / "out" / "completed.ply"));
    EXPECT_NE(over.code, 0);
    EXPECT_EQ(read_file(scratch / "out" / "completed.ply"), before) << over.err;
    // Nothing placed: outputs of an earlier run are removed. (Changed files are kept, so they are written again first.)
    ASSERT_EQ(fit(quoted(scratch / "top.ply") + " --placed").code, 3);
    Json annotations = read_json(scratch / "top.ant.json");
    annotations["annotations"].Clear();
    write_json(scratch / "top.ant.json", annotations);
    EXPECT_EQ(fit(quoted(scratch / "top.ply") + " --search never").code, 3);
    EXPECT_TRUE(std::filesystem::exists(scratch / "out" / "fit.assembly.json"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "out" / "completed.ply"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "out" / "top.placed.ply"));
}

TEST_F(FitCommand, SearchesOfAnEarlierFitAreReusedIfNothingChanged) {
    // A piece of the template itself, without annotations.
    const auto broken = run_command("mesh break " + quoted(scratch / "made" / "statuette-1.ply") + " " +
                                    quoted(scratch / "bare.ply") + " --at 0,0,180 --share 0.45");
    ASSERT_EQ(broken.code, 0) << broken.err;
    const auto contents = [&] {
        std::vector<std::string> texts;
        for (const char* name : {"completed.ply", "completed.ant.json", "fit.assembly.json", "fit.searches.json"})
            texts.push_back(read_file(scratch / "out" / name));
        return texts;
    };
    const auto first = fit(quoted(scratch / "bare.ply"));
    EXPECT_EQ(first.code, 3);
    EXPECT_EQ(first.err.find("earlier fit"), std::string::npos) << first.err;
    const Json searches = read_json(scratch / "out" / "fit.searches.json");
    validate(searches, "searches", "searches");
    const auto before = contents();
    const auto repeated = fit(quoted(scratch / "bare.ply"));
    EXPECT_NE(repeated.err.find("1 of 1 pose searches are reused from an earlier fit"), std::string::npos) << repeated.err;
    EXPECT_EQ(contents(), before);
    EXPECT_EQ(repeated.out, first.out);
    // Another fragment is added and removed.
    (void)fit(quoted(scratch / "bare.ply") + " " + quoted(scratch / "top.ply"));
    (void)fit(quoted(scratch / "bare.ply"));
    EXPECT_EQ(contents()[0], before[0]);
    EXPECT_EQ(contents()[2], before[2]);
    EXPECT_EQ(fit(quoted(scratch / "bare.ply") + " --fresh").err.find("earlier fit"), std::string::npos);
    // Numbers that differ from the written ones.
    Json changed = read_json(scratch / "out" / "fit.searches.json");
    for (auto& entry : changed["searches"].GetArray()) entry["result"]["margin"].SetDouble(99);
    write_json(scratch / "out" / "fit.searches.json", changed);
    const auto noticed = fit(quoted(scratch / "bare.ply"));
    EXPECT_NE(noticed.err.find("were changed since"), std::string::npos) << noticed.err;
    EXPECT_EQ(contents()[0], before[0]);
    write_file(scratch / "out" / "fit.searches.json", "{}");
    const auto other = fit(quoted(scratch / "bare.ply"));
    EXPECT_NE(other.err.find("is not used, and is written again"), std::string::npos) << other.err;
    EXPECT_EQ(contents()[0], before[0]);
    // The fragment's own file has changed.
    ASSERT_EQ(run_command("mesh break " + quoted(scratch / "made" / "statuette-1.ply") + " " + quoted(scratch / "bare.ply") +
                          " --at 0,0,180 --share 0.4")
                  .code,
              0);
    EXPECT_EQ(fit(quoted(scratch / "bare.ply")).err.find("earlier fit"), std::string::npos);
    // Nothing to search: no file of searches remains next to the new answer.
    (void)fit(quoted(scratch / "top.ply") + " --fresh");
    EXPECT_FALSE(std::filesystem::exists(scratch / "out" / "fit.searches.json"));
}

TEST_F(FitCommand, FitsThroughACage) {
    const std::string package = quoted(scratch / "made" / "t.template.json"), top = quoted(scratch / "top.ply");
    const auto generated = fit(top + " --space cage");
    EXPECT_EQ(generated.code, 3) << generated.err;
    EXPECT_NE(generated.err.find("has no cage"), std::string::npos) << generated.err;
    EXPECT_TRUE(std::filesystem::exists(scratch / "out" / "completed.ply"));
    // A cage of the template, and one that does not contain it.
    const std::string statuette = quoted(scratch / "made" / "statuette-1.ply");
    ASSERT_EQ(run_command("cage make " + statuette + " " + quoted(scratch / "made" / "cage.ply") + " --vertices 100").code, 0);
    const std::string pack = "template pack " + quoted(scratch / "made" / "caged.template.json") + " --mesh " + statuette +
                             " --annotations " + quoted(scratch / "made" / "statuette-1.ant.json") + " --cage ";
    ASSERT_EQ(run_command(pack + quoted(scratch / "made" / "cage.ply")).code, 0);
    const std::string caged = "fit " + quoted(scratch / "made" / "caged.template.json") + " " + top + " --space both --output " +
                              quoted(scratch / "out");
    const auto own_cage = run_command(caged);
    EXPECT_EQ(own_cage.code, 3) << own_cage.err;
    EXPECT_EQ(own_cage.err.find("has no cage"), std::string::npos) << own_cage.err;
    EXPECT_EQ(run_command("fit " + package + " " + top + " --space air --output " + quoted(scratch / "out")).code, 2);
}

TEST_F(FitCommand, BreakRefusesInvalidInput) {
    const std::string mesh = "mesh break " + quoted(scratch / "made" / "statuette-2.ply") + " " + quoted(scratch / "x.ply");
    EXPECT_EQ(run_command(mesh).code, 2);
    EXPECT_EQ(run_command(mesh + " --at 1,2").code, 2);
    EXPECT_EQ(run_command(mesh + " --at nan,0,0").code, 2);
    EXPECT_EQ(run_command(mesh + " --at head").code, 2) << "no annotations are given";
    EXPECT_EQ(run_command(mesh + " --at 0,0,0 --share 0.001 --erosion 0.5").code, 1);
    EXPECT_FALSE(std::filesystem::exists(scratch / "x.ply"));
}

}  // namespace
}  // namespace ostraka
