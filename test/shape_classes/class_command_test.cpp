#include "scratch.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/files/json.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/shape_classes/class_file.h"
#include "ostraka/shape_classes/fragment_thresholds.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

using test::run_command;
using test::Scratch;

std::string quoted(const Path& path) { return "'" + path.string() + "'"; }

/// Synthetic statuettes, one of them as a template.
class ClassCommand : public ::testing::Test {
protected:
    void SetUp() override {
        ASSERT_EQ(run_command("study make proportions --objects 4 --vertices 4000 --seed 1 " + quoted(scratch / "made")).code, 0);
        ASSERT_EQ(run_command("template pack " + quoted(scratch / "made" / "s.template.json") + " --mesh " +
                              quoted(scratch / "made" / "statuette-1.ply") + " --annotations " +
                              quoted(scratch / "made" / "statuette-1.ant.json"))
                      .code,
                  0);
    }
    [[nodiscard]] std::string member(int i) const {
        return quoted(scratch / "made" / ("statuette-" + std::to_string(i) + ".ply"));
    }
    [[nodiscard]] std::string known() const { return quoted(scratch / "made" / "s.template.json"); }
    Scratch scratch;
};

TEST_F(ClassCommand, LearnsClassifiesSamplesAndPropagates) {
    const auto learnt = run_command("template learn " + known() + " " + member(2) + " " + member(3) + " " + member(4) +
                                    " --name idol --output " + quoted(scratch / "class") + " --json --quiet");
    ASSERT_EQ(learnt.code, 0) << learnt.err;
    const Json report = parse_json(learnt.out, "report");
    EXPECT_EQ(report["result"]["members"].GetInt(), 3);
    validate(read_json(scratch / "class" / "idol.class.json"), "class", "class");
    EXPECT_TRUE(std::filesystem::exists(scratch / "class" / "s.template.json"));
    EXPECT_EQ(read_mesh(scratch / "class" / "idol.mean.ply").mesh.number_of_vertices(),
              read_mesh(scratch / "made" / "statuette-1.ply").mesh.number_of_vertices());

    const auto classified = run_command("template classify " + quoted(scratch / "class" / "idol.class.json") + " " + member(1) +
                                        " --report " + quoted(scratch / "answer.json"));
    EXPECT_TRUE(classified.code == 0 || classified.code == 3) << classified.err;
    const Json classification = read_json(scratch / "answer.json");
    validate(classification, "classification", "answer");
    EXPECT_STREQ(classification["objects"][0]["answers"][0]["class"].GetString(), "idol");

    const auto drawn = run_command("template sample " + quoted(scratch / "class" / "idol.class.json") +
                                   " --count 2 --seed 4 --output " + quoted(scratch / "drawn"));
    EXPECT_TRUE(drawn.code == 0 || drawn.code == 3) << drawn.err;
    const Json samples = read_json(scratch / "drawn" / "idol.samples.json");
    validate(samples, "samples", "samples");
    EXPECT_EQ(samples["accepted"].GetUint(), samples["samples"].Size());

    const auto carried =
        run_command("template propagate " + known() + " " + member(2) + " --output " + quoted(scratch / "carried"));
    ASSERT_EQ(carried.code, 0) << carried.err;
    const MeshFile original = read_mesh(scratch / "made" / "statuette-2.ply");
    EXPECT_GT(read_annotations(scratch / "carried" / "statuette-2.ant.json", original.mesh).annotations.size(), 10U);
}

/// The source of a threshold of a fit.
std::string origin_of(const Json& assembly, const std::string& option) {
    for (const auto& threshold : assembly["thresholds"].GetArray())
        if (option == threshold["option"].GetString()) return threshold["from"].GetString();
    return "";
}

TEST_F(ClassCommand, AFitUsesShapeAndThresholdsOfItsClassOnly) {
    const Path learnt = scratch / "class" / "idol.class.json";
    ASSERT_EQ(run_command("template learn " + known() + " " + member(2) + " " + member(3) + " " + member(4) +
                          " --name idol --output " + quoted(scratch / "class") + " --quiet")
                  .code,
              0);
    const std::string fit = "fit " + known() + " " + member(2) + " --quiet --threads 1 --output " + quoted(scratch / "fitted");
    const auto good = run_command(fit + " --class " + quoted(learnt));
    ASSERT_TRUE(good.code == 0 || good.code == 3) << good.err;
    Json assembly = read_json(scratch / "fitted" / "fit.assembly.json");
    validate(assembly, "assembly", "assembly");
    const ShapeClass read = read_class(learnt);
    std::size_t by_class = 0;
    for (const FragmentThreshold& threshold : fragment_thresholds(read)) {
        if (threshold.option == "min-tolerance") continue;  // never below the default
        ++by_class;
        EXPECT_EQ(threshold.members, 3U);
        EXPECT_EQ(origin_of(assembly, threshold.option), "class");
        EXPECT_NE(good.out.find("--" + threshold.option), std::string::npos) << good.out;
    }
    EXPECT_EQ(by_class, 2U) << "statuettes have landmarks enough";
    // User-specified values are used; without a class the defaults.
    const auto specified = run_command(fit + " --residual 0.4 --class " + quoted(learnt));
    ASSERT_TRUE(specified.code == 0 || specified.code == 3) << specified.err;
    assembly = read_json(scratch / "fitted" / "fit.assembly.json");
    EXPECT_EQ(origin_of(assembly, "residual"), "option");
    EXPECT_EQ(assembly["thresholds"][0]["value"].GetDouble(), 0.4);

    // A class of another template: other vertices, or the same number joined otherwise.
    std::filesystem::copy_file(OSTRAKA_SOURCE_DIR "/data/vase.ply", scratch / "made" / "vase.ply");
    ASSERT_EQ(run_command("template pack " + quoted(scratch / "made" / "vase.template.json") + " --mesh " +
                          quoted(scratch / "made" / "vase.ply"))
                  .code,
              0);
    ASSERT_EQ(run_command("template learn " + quoted(scratch / "made" / "vase.template.json") + " " +
                          quoted(scratch / "made" / "vase.ply") + " --name vase --quiet --output " + quoted(scratch / "class"))
                  .code,
              0);
    const auto other = run_command(fit + " --class " + quoted(scratch / "class" / "vase.class.json"));
    EXPECT_EQ(other.code, 1);
    for (const char* word : {"vase.class.json", "s.template.json", "vertices", "template learn"})
        EXPECT_NE(other.err.find(word), std::string::npos) << other.err;
    std::string text = read_file(learnt);
    const std::size_t at = text.find(read.topology);
    ASSERT_NE(at, std::string::npos);
    text[at] = text[at] == '0' ? '1' : '0';
    write_file(learnt, text);
    for (const std::string& command :
         {fit + " --class " + quoted(learnt), "template classify " + quoted(learnt) + " " + member(1),
          "template sample " + quoted(learnt) + " --output " + quoted(scratch / "drawn")}) {
        const auto refused = run_command(command);
        EXPECT_EQ(refused.code, 1) << command;
        EXPECT_NE(refused.err.find("idol.class.json"), std::string::npos) << refused.err;
        EXPECT_NE(refused.err.find("triangles differ"), std::string::npos) << refused.err;
    }
    const auto none = run_command(fit + " --class " + quoted(scratch / "class" / "missing.class.json"));
    EXPECT_EQ(none.code, 1);
    EXPECT_NE(none.err.find("missing.class.json"), std::string::npos) << none.err;
}

TEST_F(ClassCommand, PropagateWritesProvenance) {
    ASSERT_EQ(run_command("template propagate " + known() + " " + member(2) + " --output " + quoted(scratch / "carried")).code,
              0);
    for (const char* name : {"statuette-2.ant.json", "statuette-2.fitted.ant.json"}) {
        const Json file = read_json(scratch / "carried" / name);
        ASSERT_TRUE(file.HasMember("provenance")) << name;
        const std::string text = to_text(file["provenance"]);
        for (const char* word : {"template propagate", "correspondence", "s.template.json", "statuette-1.ply", "statuette-2.ply"})
            EXPECT_NE(text.find(word), std::string::npos) << name << ": " << text;
    }
    EXPECT_NE(read_file(scratch / "carried" / "statuette-2.fitted.ply").substr(0, 2000).find("template propagate"),
              std::string::npos);
}

TEST_F(ClassCommand, PropagateReportsWhereTheTemplateDoesNotLie) {
    write_file(scratch / "one.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    const std::string output_options = " --json --output " + quoted(scratch / "carried");
    const auto good = run_command("template propagate " + known() + " " + member(3) + output_options);
    EXPECT_EQ(good.code, 0) << good.err;
    const auto bad = run_command("template propagate " + known() + " " + quoted(scratch / "one.off") +
                                 " " OSTRAKA_SOURCE_DIR "/data/teapot.ply" + output_options);
    EXPECT_EQ(bad.code, 3) << bad.err;
    const Json report = parse_json(bad.out, "report");
    for (const auto& member_report : report["result"]["members"].GetArray()) {
        EXPECT_FALSE(member_report["liesOn"].GetBool()) << member_report["name"].GetString();
        EXPECT_GT(member_report["unmatched"].GetDouble() + member_report["unexplained"].GetDouble(), 0.25)
            << member_report["name"].GetString();
        EXPECT_NE(std::string(member_report["notes"][0].GetString()).find("does not lie on it"), std::string::npos);
    }
    EXPECT_GT(report["result"]["members"][0]["lost"].GetInt(), 0) << "a triangle has no room for them";
    EXPECT_NE(bad.err.find("teapot: the template does not lie on it"), std::string::npos) << bad.err;
    // The limit is the user's.
    EXPECT_EQ(run_command("template propagate " + known() + " " OSTRAKA_SOURCE_DIR "/data/teapot.ply --max-off 1 --quiet" +
                          output_options)
                  .err.find("does not lie"),
              std::string::npos);
}

TEST_F(ClassCommand, AnUnreadableFileDoesNotStopTheOthers) {
    const std::string vase = "'" OSTRAKA_SOURCE_DIR "/data/vase.ply'";
    const auto learnt = run_command("template learn " + known() + " " + member(2) + " " + member(3) + " " + member(4) +
                                    " --out-of-class " + vase + " --name idol --quiet --output " + quoted(scratch / "class"));
    ASSERT_EQ(learnt.code, 0) << learnt.err;
    const Json file = read_json(scratch / "class" / "idol.class.json");
    validate(file, "class", "class");
    ASSERT_EQ(file["outOfClass"].Size(), 1U);
    EXPECT_STREQ(file["outOfClass"][0].GetString(), "vase");
    write_file(scratch / "broken.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
    const std::string idol = "template classify " + quoted(scratch / "class" / "idol.class.json") + " ",
                      report = " --report " + quoted(scratch / "answer.json");
    const auto classified = run_command(idol + quoted(scratch / "broken.ply") + " " + vase + report);
    EXPECT_EQ(classified.code, 3) << classified.err;
    EXPECT_NE(classified.err.find("broken.ply"), std::string::npos) << classified.err;
    EXPECT_NE(classified.err.find("1 of 2 objects"), std::string::npos) << classified.err;
    const Json classification = read_json(scratch / "answer.json");
    validate(classification, "classification", "answer");
    ASSERT_EQ(classification["objects"].Size(), 2U);
    EXPECT_TRUE(classification["objects"][0].HasMember("problem"));
    const auto& last = classification["objects"][1];
    EXPECT_FALSE(last.HasMember("problem"));
    EXPECT_STRNE(last["verdict"].GetString(), "member") << "a vase is no statuette";
    EXPECT_TRUE(last["answers"][0]["explained"].HasMember("liesOn"));
    EXPECT_NE(classified.out.find("the template explains"), std::string::npos) << classified.out;
    // If no file is readable, the command fails.
    EXPECT_EQ(run_command(idol + quoted(scratch / "broken.ply")).code, 1);
    // A missing file is detected before any work.
    EXPECT_EQ(run_command(idol + vase + " " + quoted(scratch / "missing.ply")).code, 1);
}

TEST_F(ClassCommand, WrongArgumentsAndFilesAreReported) {
    // Before any work, and without leaving a folder.
    const std::string learn = "template learn " + known() + " " + quoted(scratch / "missing.ply");
    EXPECT_EQ(run_command(learn).code, 2) << "no --output";
    EXPECT_EQ(run_command(learn + " --name ../../evil --output " + quoted(scratch / "evil")).code, 2);
    EXPECT_FALSE(std::filesystem::exists(scratch / "evil"));
    write_file(scratch / "file", "no folder");
    const auto unmade = run_command(learn + " --output " + quoted(scratch / "file" / "class"));
    EXPECT_NE(unmade.err.find("folder cannot be created"), std::string::npos) << unmade.err;
    const auto empty = run_command("template learn " + known() + " --output " + quoted(scratch / "class"));
    EXPECT_EQ(empty.code, 2);
    EXPECT_NE(empty.err.find("empty"), std::string::npos) << empty.err;
    const auto other = run_command("template learn " + known() + " " OSTRAKA_SOURCE_DIR "/data/vase.ply --given --output " +
                                   quoted(scratch / "class"));
    EXPECT_EQ(other.code, 1);
    EXPECT_NE(other.err.find("correspondence"), std::string::npos) << other.err;
    EXPECT_EQ(run_command("template classify " + member(1)).code, 2);
    const auto stranger = run_command("template learn " + known() + " " + member(2) + " --out-of-class " +
                                      quoted(scratch / "missing.ply") + " --output " + quoted(scratch / "class"));
    EXPECT_EQ(stranger.code, 1);
    EXPECT_NE(stranger.err.find("missing.ply"), std::string::npos) << stranger.err;
    EXPECT_EQ(
        run_command("template learn " + known() + " " + member(2) + " --accept 0.7 --output " + quoted(scratch / "class")).code,
        2)
        << "more than half of strangers is no limit";
    const auto folder =
        run_command("template learn " + known() + " " + quoted(scratch / "made") + " --output " + quoted(scratch / "class"));
    EXPECT_EQ(folder.code, 1);
    EXPECT_NE(folder.err.find("is a folder"), std::string::npos) << folder.err;
    EXPECT_FALSE(std::filesystem::exists(scratch / "class" / "s.template.json")) << "nothing is written by what fails";
}

}  // namespace
}  // namespace ostraka
