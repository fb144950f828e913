// The built command, as people run it.
#include "ostraka/files/json.h"
#include "scratch.h"

#include <gtest/gtest.h>

using namespace ostraka;
using ostraka::test::count_files;
using ostraka::test::run_command;
using ostraka::test::Scratch;

namespace {
const std::string data = OSTRAKA_SOURCE_DIR "/data/";
const std::string pot = data + "teapot.ply " + data + "teapot.ant.json ";
}  // namespace

TEST(AxisCommand, OfAPartWithFiles) {
    const Scratch scratch;
    const std::string obj = (scratch / "a.obj").string(), json = (scratch / "a.json").string();
    const auto body = run_command("axis --json " + pot + "--annotation 1 --output " + json);
    ASSERT_EQ(body.code, 0) << body.err << body.out;
    const Json report = parse_json(body.out, "report");
    validate(report, "report", "report");
    EXPECT_NEAR(report["result"]["direction"][2].GetDouble(), 1, 1e-3);
    EXPECT_EQ(std::string(read_json(scratch / "a.json")["format"].GetString()), "ostraka-axis");
    const std::string first = read_file(scratch / "a.json");
    ASSERT_EQ(run_command("axis --threads 1 " + pot + "--annotation 1 --output " + json).code, 0);
    EXPECT_EQ(read_file(scratch / "a.json"), first);
    const auto spout = run_command("axis " + pot + "--annotation 5 --method slices --output " + obj);
    EXPECT_EQ(spout.code, 0) << spout.out;
    EXPECT_NE(read_file(scratch / "a.obj").find("\nl 1 2 3"), std::string::npos);
    // A tag is equivalent to an id.
    const auto tagged = run_command("axis --json " + pot + "--annotation body");
    EXPECT_EQ(parse_json(tagged.out, "report")["result"], report["result"]) << tagged.err;
    // A line has the axis of its circle.
    const auto girth = run_command("axis " + pot + "--annotation 12");
    EXPECT_EQ(girth.code, 0) << girth.out;
    EXPECT_NE(girth.out.find(" 100 %"), std::string::npos) << girth.out;
}

TEST(AxisCommand, AMissingAxisIsAResultAndInvalidInputIsAnError) {
    const Scratch scratch;
    const std::string ball = (scratch / "ball.ply").string(), out = (scratch / "o.obj").string();
    ASSERT_EQ(run_command("mesh make sphere " + ball + " --vertices 500").code, 0);
    const auto no_axis = run_command("axis " + ball);
    EXPECT_EQ(no_axis.code, 3);
    EXPECT_NE(no_axis.out.find("has no axis: it resembles a part of a sphere"), std::string::npos) << no_axis.out;
    const auto expect_failure = [&](const std::string& line, int code, const std::string& message) {
        const auto result = run_command(line);
        EXPECT_EQ(result.code, code) << line << result.err;
        EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    };
    expect_failure("axis " + pot + "--annotation 99", 1, "has no annotation '99'");
    expect_failure("axis " + pot, 2, "no annotation is named");
    expect_failure("axis " + ball + " --annotation 1", 2, "there are no annotations");
    expect_failure("axis " + ball + " --output " + (scratch / "o.txt").string(), 2, ".json or .obj");
    expect_failure("axis " + ball + " --method guess", 2, "guess");
    expect_failure("axis " + ball + " --tolerance -1", 2, "tolerance");
    expect_failure("axis " + pot + "--annotation 1 --annotation 12", 2, "no axis together");
    EXPECT_EQ(count_files(scratch.path()), 1U);
}
