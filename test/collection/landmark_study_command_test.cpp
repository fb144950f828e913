// `ostraka study landmarks` and `ostraka study shape` with files of morphometrics, as users run them.
#include "scratch.h"

#include "ostraka/files/json.h"
#include "ostraka/interchange/specimens.h"
#include "ostraka/stats/random.h"

#include <fmt/core.h>

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

using test::run_command;
using test::Scratch;

std::string quoted(const Path& path) { return "'" + path.string() + "'"; }

/// Forty specimens of ten planar landmarks: two species and two sites that differ, and sizes.
LandmarkSpecimens planar_specimens() {
    Random random(17);
    LandmarkSpecimens set;
    set.dimension = 2;
    std::array<std::array<double, 2>, 10> mean{}, species{}, slope{};
    for (auto* x : {&mean, &species, &slope})
        for (auto& p : *x) p = {random.normal(), random.normal()};
    for (int s = 0; s < 40; ++s) {
        LandmarkSpecimen& specimen = set.specimens.emplace_back();
        specimen.name = "fish" + std::to_string(s + 1);
        const double log_size = random.uniform(-0.5, 0.5), angle = random.uniform(0, 6);
        for (std::size_t k = 0; k < 10; ++k) {
            std::array<double, 2> p{};
            for (std::size_t c = 0; c < 2; ++c)
                p[c] = std::exp(log_size) * (mean[k][c] + (s % 2 == 0 ? 0.1 : -0.1) * species[k][c] +
                                             0.2 * log_size * slope[k][c] + 0.03 * random.normal());
            specimen.landmarks.push_back(std::to_string(k + 1));
            specimen.positions.push_back(std::array<double, 3>{std::cos(angle) * p[0] - std::sin(angle) * p[1] + 5,
                                                               std::sin(angle) * p[0] + std::cos(angle) * p[1], 0});
        }
    }
    return set;
}

Json report_of(const std::string& command, int code = 0) {
    const auto result = run_command(command + " --json");
    EXPECT_EQ(result.code, code) << result.err;
    Json report = parse_json(result.out, "report");
    if (code == 0) validate(report, "report", "report");
    return report;
}

TEST(LandmarkStudyCommand, ReadsOneFileWithManySpecimens) {
    const Scratch scratch;
    LandmarkSpecimens set = planar_specimens();
    std::swap(set.specimens[6].positions[2], set.specimens[6].positions[7]);
    set.specimens[9].positions[4].reset();
    write_file(scratch / "fish.tps", specimens_to_tps(set));
    const std::string command = "study landmarks " + quoted(scratch / "fish.tps") + " --output ";
    const Json left_out = report_of(command + quoted(scratch / "a"));
    EXPECT_EQ(left_out["result"]["objects"].GetInt(), 40);
    EXPECT_EQ(left_out["result"]["landmarks"].GetInt(), 9);
    EXPECT_EQ(left_out["result"]["dimension"].GetInt(), 2);
    ASSERT_EQ(left_out["result"]["missing"].Size(), 1U);
    EXPECT_STREQ(left_out["result"]["missing"][0]["specimen"].GetString(), "fish10");
    EXPECT_STREQ(left_out["result"]["missing"][0]["landmark"].GetString(), "5");
    ASSERT_EQ(left_out["result"]["odd"].Size(), 1U);
    EXPECT_STREQ(left_out["result"]["odd"][0]["name"].GetString(), "fish7");
    EXPECT_STREQ(left_out["result"]["odd"][0]["cause"].GetString(), "exchanged");
    EXPECT_STREQ(left_out["result"]["odd"][0]["landmarks"][1].GetString(), "8");
    for (const char* method : {"tps", "regression"}) {
        const Json estimated =
            report_of(command + quoted(scratch / method) + " --missing " + method + " --scaling --leave-odd-out");
        EXPECT_EQ(estimated["result"]["landmarks"].GetInt(), 10);
        EXPECT_EQ(estimated["result"]["objects"].GetInt(), 39);
        EXPECT_STREQ(estimated["result"]["missing"][0]["how"].GetString(), method);
        for (const char* name : {"aligned.csv", "aligned.tps", "shapes.svg", "shapes.tps", "components.svg", "objects.csv"})
            EXPECT_TRUE(file_exists(scratch / method / name)) << name;
        // What is written for other programs is read back with the same result.
        const Json again = report_of("study landmarks " + quoted(scratch / method / "aligned.csv") + " --scaling --output " +
                                     quoted(scratch / method / "again"));
        EXPECT_NEAR(again["result"]["sumOfSquares"].GetDouble(), estimated["result"]["sumOfSquares"].GetDouble(), 1e-10);
    }
    EXPECT_EQ(run_command(command + quoted(scratch / "b") + " --missing mirror").code, 1) << "no pairs";
}

TEST(LandmarkStudyCommand, FoldersMayMixFormats) {
    const Scratch scratch;
    std::filesystem::create_directories(scratch / "in");
    const LandmarkSpecimens set = planar_specimens();
    for (std::size_t s = 0; s < 3; ++s) {
        LandmarkSpecimens one = set;
        one.specimens = {set.specimens[s]};
        write_file(scratch / "in" / (set.specimens[s].name + ".tps"), specimens_to_tps(one));
    }
    std::string table = "landmark,x,y\n", pts = "version: 1\nn_points: 10\n{\n";
    for (std::size_t k = 0; k < 10; ++k) {
        const auto& p = *set.specimens[3].positions[k];
        table += std::to_string(k + 1) + "," + fmt::format("{:.17g}", p[0]) + "," + fmt::format("{:.17g}", p[1]) + "\n";
        pts += fmt::format("{:.17g}", p[0]) + " " + fmt::format("{:.17g}", p[1]) + "\n";
    }
    write_file(scratch / "in" / "fish4.csv", table);
    write_file(scratch / "in" / "fish5.pts", pts + "}\n");
    write_file(scratch / "in" / "truth.csv", "name,label\nfish1,x\nfish2,y\n");
    const Json report =
        report_of("study landmarks " + quoted(scratch / "in") + " --own-truth --output " + quoted(scratch / "out"));
    EXPECT_EQ(report["result"]["objects"].GetInt(), 5);
    EXPECT_EQ(report["result"]["landmarks"].GetInt(), 10);
    EXPECT_EQ(report["result"]["truth"]["labelled"].GetInt(), 2);
}

TEST(StudyShapeCommand, TestsModelsAndAllometry) {
    const Scratch scratch;
    const LandmarkSpecimens set = planar_specimens();
    write_file(scratch / "fish.tps", specimens_to_tps(set));
    std::string table = "specimen,species,site,weight\n";
    for (std::size_t s = 0; s < 40; ++s)
        table += set.specimens[s].name + (s % 2 == 0 ? ",a," : ",b,") + (s % 4 < 2 ? "x," : "y,") + std::to_string(s * s) + "\n";
    write_file(scratch / "fish.csv", table);
    const std::string command = "study shape " + quoted(scratch / "fish.tps") + " --table " + quoted(scratch / "fish.csv") +
                                " --permutations 199 --output " + quoted(scratch / "out");
    const Json report = report_of(command + " --model 'log(size) + species * site' --groups species");
    const auto& rows = report["result"]["anova"];
    ASSERT_EQ(rows.Size(), 6U);
    EXPECT_STREQ(rows[1]["term"].GetString(), "species");
    EXPECT_LE(rows[0]["p"].GetDouble(), 0.01) << "shape depends on size";
    EXPECT_LE(rows[1]["p"].GetDouble(), 0.01) << "shape depends on species";
    EXPECT_GT(rows[2]["p"].GetDouble(), 0.01) << "sites do not differ";
    EXPECT_STREQ(rows[3]["term"].GetString(), "species:site");
    EXPECT_EQ(rows[4]["freedom"].GetInt(), 35);
    EXPECT_GT(report["result"]["allometry"]["share"].GetDouble(), 0.3);
    for (const char* name : {"anova.csv", "anova.md", "allometry.csv", "allometry.svg", "allometry-shapes.tps", "aligned.csv",
                             "corrected-for-size.tps"})
        EXPECT_TRUE(file_exists(scratch / "out" / name)) << name;
    EXPECT_EQ(run_command(command).code, 2) << "nothing to analyse";
    const auto unknown = run_command(command + " --model colour");
    EXPECT_EQ(unknown.code, 2);
    EXPECT_NE(unknown.err.find("species, site, weight"), std::string::npos) << unknown.err;
}

TEST(StudyShapeCommand, SeparatesSymmetricAndAsymmetricShape) {
    const Scratch scratch;
    Random random(2);
    LandmarkSpecimens set;
    std::string table = "specimen,individual\n";
    for (int s = 0; s < 20; ++s) {
        LandmarkSpecimen& specimen = set.specimens.emplace_back();
        specimen.name = "face" + std::to_string(s);
        table += specimen.name + ",p" + std::to_string(s / 2) + "\n";
        const double places[6][3] = {{1, 2, 0}, {-1, 2, 0}, {3, 1, -2}, {-3, 1, -2}, {0, 0, 2}, {0, -3, 1}};
        const char* names[6] = {"left eye", "right eye", "left ear", "right ear", "nose", "chin"};
        for (int k = 0; k < 6; ++k) {
            specimen.landmarks.emplace_back(names[k]);
            specimen.positions.push_back(std::array<double, 3>{places[k][0] + 0.05 * random.normal(),
                                                               places[k][1] + 0.05 * random.normal() + (k == 0 ? 0.3 : 0),
                                                               places[k][2] + 0.05 * random.normal()});
        }
    }
    write_file(scratch / "faces.tps", specimens_to_tps(set));
    write_file(scratch / "faces.csv", table);
    const Json report =
        report_of("study shape " + quoted(scratch / "faces.tps") + " --table " + quoted(scratch / "faces.csv") +
                  " --symmetry object --individual individual --permutations 99 --output " + quoted(scratch / "out"));
    const auto& rows = report["result"]["anova"];
    ASSERT_EQ(rows.Size(), 5U);
    EXPECT_STREQ(rows[1]["term"].GetString(), "side");
    EXPECT_LE(rows[1]["p"].GetDouble(), 0.02) << "one eye is higher";
    EXPECT_STREQ(rows[1]["error"].GetString(), "individual:side");
    EXPECT_TRUE(report["result"].HasMember("repeatability"));
    for (const char* name : {"symmetric.tps", "asymmetric.tps", "asymmetry.csv", "anova.csv", "mean.tps"})
        EXPECT_TRUE(file_exists(scratch / "out" / name)) << name;
}

TEST(TemplateLearnCommand, LearnsAClassFromOneFileOfManySpecimens) {
    const Scratch scratch;
    LandmarkSpecimens set = planar_specimens();
    set.specimens[3].positions[2].reset();
    write_file(scratch / "fish.tps", specimens_to_tps(set));
    const std::string command =
        "template learn " + quoted(scratch / "fish.tps") + " --name fish --output " + quoted(scratch / "class");
    const auto refused = run_command(command);
    EXPECT_EQ(refused.code, 1);
    EXPECT_NE(refused.err.find("fish4"), std::string::npos) << refused.err;
    const Json report = report_of(command + " --missing regression");
    EXPECT_EQ(report["result"]["members"].GetInt(), 40);
    LandmarkSpecimens mirrored = set;
    mirrored.specimens = {set.specimens[0]};
    write_file(scratch / "same.tps", specimens_to_tps(mirrored));
    for (auto& position : mirrored.specimens[0].positions) (*position)[0] *= -1;
    write_file(scratch / "mirrored.tps", specimens_to_tps(mirrored));
    const std::string ask = "template classify " + quoted(scratch / "class" / "fish.class.json") + " ";
    EXPECT_EQ(run_command(ask + quoted(scratch / "same.tps")).code, 0);
    EXPECT_EQ(run_command(ask + quoted(scratch / "mirrored.tps")).code, 3) << "a planar shape is not turned over";
}

}  // namespace
}  // namespace ostraka
