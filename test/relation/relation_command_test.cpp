// The built command, as people run it.
#include "ostraka/core/json.h"
#include "scratch.h"

#include <gtest/gtest.h>

using namespace ostraka;
using ostraka::test::count_files;
using ostraka::test::run_command;
using ostraka::test::Scratch;

namespace {

const std::string data = OSTRAKA_SOURCE_DIR "/data/";
const std::string pot = data + "teapot.ply " + data + "teapot.ant.json ";

Json report_of(const std::string& text) {
    Json report = parse_json(text, "report");
    validate(report, "report", "report");
    return report;
}

}  // namespace

TEST(RelationCommand, ExtractAddCheckExport) {
    const Scratch scratch;
    const auto at = [&](const char* name) { return (scratch / name).string(); };
    const auto extracted = run_command("relation extract " + pot + at("a.graph.json"));
    ASSERT_EQ(extracted.code, 0) << extracted.err;
    EXPECT_NE(extracted.out.find("  0 teapot (region)\n    1 body (region)"), std::string::npos) << extracted.out;
    EXPECT_EQ(extracted.out.find(scratch.path().string()), std::string::npos);
    const std::string first = read_file(scratch / "a.graph.json");
    ASSERT_EQ(run_command("relation extract --threads 1 " + pot + at("a.graph.json")).code, 0);
    EXPECT_EQ(read_file(scratch / "a.graph.json"), first);

    // A constraint, a type of one's own, and one that is not so.
    const std::string add = "relation add " + pot;
    ASSERT_EQ(run_command(add + at("b.graph.json") + " --graph " + at("a.graph.json") +
                          " --type Proportion --annotation spout --annotation 6 --weight 4 --directed --parameters "
                          "'{\"measure1\": 0, \"minValue\": 0.5}'")
                  .code,
              0);
    ASSERT_EQ(run_command(add + at("c.graph.json") + " --graph " + at("b.graph.json") +
                          " --type 'glazed before' --own-type --directed --annotation body --annotation lid --annotation knob")
                  .code,
              0);
    const auto held = run_command("relation check " + pot + at("c.graph.json"));
    EXPECT_EQ(held.code, 0) << held.out;
    EXPECT_NE(held.out.find(" 0 fail, 2 unknown"), std::string::npos) << held.out;
    ASSERT_EQ(run_command(add + at("d.graph.json") + " --graph " + at("c.graph.json") +
                          " --type containment --annotation knob --annotation body")
                  .code,
              0);
    const auto failed = run_command("relation check --json " + pot + at("d.graph.json"));
    EXPECT_EQ(failed.code, 3);
    const Json report = report_of(failed.out);
    EXPECT_EQ(report["result"]["fails"].GetInt(), 1);
    const auto& last = report["result"]["relationships"][report["result"]["relationships"].Size() - 1];
    EXPECT_STREQ(last["verdict"].GetString(), "fails");
    EXPECT_EQ(last["parameters"]["deviations"][0]["value"].GetDouble(), 100) << "no face of the body lies in the knob";

    // Stated relationships survive another extraction; extracted ones are not doubled.
    const auto again = run_command("relation extract --json " + pot + at("e.graph.json") + " --graph " + at("c.graph.json"));
    ASSERT_EQ(again.code, 0) << again.err;
    const Json before = parse_json(first, "a"), after = read_json(scratch / "e.graph.json");
    EXPECT_EQ(after["relationships"].Size(), before["relationships"].Size() + 2);
    EXPECT_GT(report_of(again.out)["result"]["tree"].Size(), 10U);

    ASSERT_EQ(run_command("relation export " + pot + at("c.graph.json") + " " + at("c.dot")).code, 0);
    EXPECT_NE(read_file(scratch / "c.dot").find("label=\"glazed before\""), std::string::npos);
}

TEST(RelationCommand, BadInput) {
    const Scratch scratch;
    const std::string out = (scratch / "o.graph.json").string(), add = "relation add " + pot + out;
    const auto expect = [&](const std::string& line, int code, const std::string& words) {
        const auto result = run_command(line);
        EXPECT_EQ(result.code, code) << line << "\n" << result.err;
        EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
        EXPECT_EQ(count_files(scratch.path()), 0U) << "nothing is left behind";
    };
    expect(add + " --type adjacency --annotation body --annotation 77", 1, "annotation 77, which does not exist");
    expect(add + " --type adjacency --annotation body --annotation wing", 1, "has no annotation 'wing'");
    expect(add + " --type adjacency --annotation body", 1, "is said of 1 annotation");
    expect(add + " --type adjacensy --annotation body --annotation lid", 2, "did you mean 'adjacency'?");
    expect(add + " --type 'same level' --annotation body --annotation lid --tolerance height=-1", 2, "negative");
    expect(add + " --type 'same level' --annotation body --annotation lid --tolerance height", 2, "not a tolerance");
    expect(add + " --type line --annotation body --parameters '[1]'", 1, "not a JSON object");
    expect(add + " --type line --annotation body --weight -3", 2, "weight");
    expect("relation extract " + pot + "nowhere/o.graph.json", 1, "nowhere");
    expect("relation check " + pot + out, 1, "o.graph.json");
    expect("relation extract " + data + "vase.ply " + data + "teapot.ant.json " + out, 1, "teapot.ant.json");
}
