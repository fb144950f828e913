// `ostraka study landmarks` as users run it.
#include "scratch.h"

#include "ostraka/files/json.h"
#include "ostraka/interchange/landmarks.h"
#include "ostraka/registration/procrustes.h"
#include "ostraka/stats/random.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

using test::run_command;
using test::Scratch;

std::string quoted(const Path& path) { return "'" + path.string() + "'"; }

void write_landmarks(const Path& file, const Landmarks& x, const std::string& unit = "mm") {
    LandmarkSet set;
    set.unit = unit;
    for (Eigen::Index i = 0; i < x.rows(); ++i)
        set.landmarks.push_back({"L" + std::to_string(i + 1), {x(i, 0), x(i, 1), x(i, 2)}, std::nullopt});
    std::vector<std::string> notes;
    write_file(file, landmarks_to_text(set, LandmarkFormat::mrk, "", {}, notes));
}

std::vector<Landmarks> random_configurations(int count) {
    Random random(3);
    Landmarks base(8, 3);
    for (Eigen::Index i = 0; i < 24; ++i) base(i / 3, i % 3) = random.normal(0, 10);
    std::vector<Landmarks> configurations;
    for (int k = 0; k < count; ++k) {
        Landmarks x = base;
        for (Eigen::Index i = 0; i < 24; ++i) x(i / 3, i % 3) += random.normal() + 100 * k;
        configurations.push_back(x);
    }
    return configurations;
}

TEST(StudyLandmarksCommand, GivesWhatTheLibraryComputes) {
    const Scratch scratch;
    std::filesystem::create_directories(scratch / "in");
    const std::vector<Landmarks> shapes = random_configurations(5);
    for (std::size_t k = 0; k < shapes.size(); ++k)
        write_landmarks(scratch / "in" / ("s" + std::to_string(k) + ".mrk.json"), shapes[k]);
    (void)scratch.file("in/t.mrk.json", "{\"markups\": 3}");
    const auto result =
        run_command("study landmarks " + quoted(scratch / "in") + " --output " + quoted(scratch / "out") + " --json");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    validate(report, "report", "report");
    const GeneralisedProcrustes expected = generalised_procrustes(shapes);
    EXPECT_EQ(report["result"]["objects"].GetInt(), 5);
    EXPECT_EQ(report["result"]["failed"].Size(), 1u) << "the damaged file is reported and does not stop the rest";
    EXPECT_DOUBLE_EQ(report["result"]["sumOfSquares"].GetDouble(), expected.sum_of_squares);
    const LandmarkSet mean = read_landmarks(scratch / "out" / "mean.mrk.json", LandmarkFormat::mrk);
    ASSERT_EQ(mean.landmarks.size(), 8u);
    EXPECT_NEAR(mean.landmarks[3].position[1], expected.mean(3, 1), 1e-9);
    for (const char* name : {"objects.csv", "objects.md", "components.svg"})
        EXPECT_TRUE(std::filesystem::exists(scratch / "out" / name)) << name;
}

TEST(StudyLandmarksCommand, ReportsUncommonLandmarksAndLeavesUnusualSpecimensOut) {
    const Scratch scratch;
    std::filesystem::create_directories(scratch / "in");
    const std::vector<Landmarks> shapes = random_configurations(3);
    write_landmarks(scratch / "in" / "a.mrk.json", shapes[0]);
    write_landmarks(scratch / "in" / "b.mrk.json", shapes[1].topRows(6));
    const std::string command = "study landmarks " + quoted(scratch / "in") + " --output " + quoted(scratch / "out");
    const auto fewer = run_command(command + " --json");
    ASSERT_EQ(fewer.code, 0) << fewer.err;
    EXPECT_EQ(parse_json(fewer.out, "report")["result"]["landmarks"].GetInt(), 6);
    EXPECT_NE(fewer.err.find("'L7', 'L8'"), std::string::npos) << fewer.err;
    write_landmarks(scratch / "in" / "c.mrk.json", shapes[2], "cm");
    const auto left_out = [&](const std::string& extra_options) {
        const auto run = run_command(command + extra_options + " --json");
        EXPECT_EQ(run.code, 0) << run.err;
        const Json report = parse_json(run.out, "report");
        std::string text;
        for (const auto& entry : report["result"]["odd"].GetArray())
            if (entry["leftOut"].GetBool()) text += std::string(entry["name"].GetString()) + ": " + entry["why"].GetString();
        return text;
    };
    const std::string other_unit = left_out("");
    EXPECT_EQ(other_unit.substr(0, 2), "c:") << "two of three are in one unit";
    EXPECT_NE(other_unit.find("--scaling"), std::string::npos) << other_unit;
    EXPECT_EQ(left_out(" --scaling"), "");
    write_landmarks(scratch / "in" / "c.mrk.json", shapes[2].topRows(2));
    EXPECT_NE(left_out("").find("2 of the 6"), std::string::npos) << left_out("");
    for (const char* name : {"a.mrk.json", "b.mrk.json"}) write_landmarks(scratch / "in" / name, shapes[0].topRows(2));
    EXPECT_EQ(run_command(command).code, 1) << "two landmarks in all";
}

}  // namespace
}  // namespace ostraka
