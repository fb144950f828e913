#include "scratch.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/json.h"
#include "ostraka/io/mesh_file.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

using test::run_command;
using test::Scratch;

std::string quoted(const Path& path) { return "'" + path.string() + "'"; }

/// Made statuettes, one of them as a template.
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

    const auto asked = run_command("template classify " + quoted(scratch / "class" / "idol.class.json") + " " + member(1) +
                                   " --report " + quoted(scratch / "answer.json"));
    EXPECT_TRUE(asked.code == 0 || asked.code == 3) << asked.err;
    const Json answer = read_json(scratch / "answer.json");
    validate(answer, "classification", "answer");
    EXPECT_STREQ(answer["objects"][0]["answers"][0]["class"].GetString(), "idol");

    const auto drawn = run_command("template sample " + quoted(scratch / "class" / "idol.class.json") +
                                   " --count 2 --seed 4 --output " + quoted(scratch / "drawn"));
    EXPECT_TRUE(drawn.code == 0 || drawn.code == 3) << drawn.err;
    const Json samples = read_json(scratch / "drawn" / "idol.samples.json");
    validate(samples, "samples", "samples");
    EXPECT_EQ(samples["accepted"].GetUint(), samples["samples"].Size());

    const auto carried =
        run_command("template propagate " + known() + " " + member(2) + " --output " + quoted(scratch / "carried"));
    ASSERT_EQ(carried.code, 0) << carried.err;
    const MeshFile own = read_mesh(scratch / "made" / "statuette-2.ply");
    EXPECT_GT(read_annotations(scratch / "carried" / "statuette-2.ant.json", own.mesh).annotations.size(), 10U);
}

TEST_F(ClassCommand, WrongWordsAndFilesAreSaid) {
    const auto empty = run_command("template learn " + known() + " --output " + quoted(scratch / "class"));
    EXPECT_EQ(empty.code, 2);
    EXPECT_NE(empty.err.find("empty"), std::string::npos) << empty.err;
    const auto other = run_command("template learn " + known() + " " OSTRAKA_SOURCE_DIR "/data/vase.ply --given --output " +
                                   quoted(scratch / "class"));
    EXPECT_EQ(other.code, 1);
    EXPECT_NE(other.err.find("correspondence"), std::string::npos) << other.err;
    EXPECT_EQ(run_command("template classify " + member(1)).code, 2);
    EXPECT_FALSE(std::filesystem::exists(scratch / "class" / "s.template.json")) << "nothing is written by what fails";
}

}  // namespace
}  // namespace ostraka
