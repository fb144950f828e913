// `ostraka study technique` and `ostraka study segments` as users run them.
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/files/csv.h"
#include "ostraka/files/json.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/synthetic/statuettes.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <set>

namespace ostraka {
namespace {
using test::run_command;
using test::Scratch;

/// Eight statuettes of level 1, made once.
const Path& population() {
    static const Scratch scratch;
    static const Path folder = [] {
        const Path path = scratch / "population";
        const auto result =
            run_command("study make technique " + path.string() + " --objects 8 --vertices 4000 --interior closed");
        EXPECT_EQ(result.code, 0) << result.err;
        return path;
    }();
    return folder;
}

TEST(StudyTechniqueCommand, AnswersWithTablesPlotsAndReasons) {
    Scratch scratch;
    const std::string out = (scratch / "out").string();
    const auto result = run_command("study technique " + population().string() + " --truth " +
                                    (population() / "truth.csv").string() + " --output " + out + " --answer-by roundness --json");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    const Json file = read_json(Path(out) / "technique.json");
    validate(file, "technique", "technique.json");
    EXPECT_STREQ(file["positive"].GetString(), "wheel");
    ASSERT_EQ(file["objects"].Size(), 8U);
    for (const auto& object : file["objects"].GetArray()) {
        EXPECT_STREQ(object["answer"].GetString(), object["label"].GetString());
        EXPECT_NE(std::string(object["words"].GetString()).find("threshold"), std::string::npos);
    }
    for (const char* name : {"descriptors.csv", "descriptors.md", "classifiers.csv", "divisions.csv", "answers.csv",
                             "answers.tex", "roundness.svg", "eccentricity.svg", "ovality.svg", "classifiers.svg", "roc.svg"})
        EXPECT_TRUE(std::filesystem::exists(Path(out) / name)) << name;
    EXPECT_EQ(csv_rows(read_file(Path(out) / "answers.csv"), ',', "answers.csv").size(), 9U);
}

TEST(StudyTechniqueCommand, AnInvalidObjectDoesNotStopTheRunWhichCanBeResumed) {
    Scratch scratch;
    const Path folder = scratch / "mixed", out = scratch / "out";
    std::filesystem::copy(population(), folder);
    write_file(folder / "broken.ply", "ply\nnot a mesh");
    write_file(folder / "flat.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    const std::string words = "study technique " + folder.string() + " --output " + out.string() + " --truth " +
                              (folder / "truth.csv").string() + " --threads ";
    const auto first = run_command(words + "1");
    EXPECT_EQ(first.code, 0) << first.err;
    EXPECT_NE(first.err.find("left out: broken"), std::string::npos) << first.err;
    EXPECT_NE(first.err.find("left out: flat"), std::string::npos) << first.err;
    EXPECT_NE(first.out.find("8 objects studied, 2 left out"), std::string::npos) << first.out;
    const std::string report = read_file(out / "technique.json");
    std::filesystem::remove(out / "objects" / "statuette-3.json");
    std::filesystem::remove(out / "technique.json");
    const auto resumed = run_command(words + "2");
    EXPECT_EQ(resumed.code, 0) << resumed.err;
    EXPECT_EQ(read_file(out / "technique.json"), report);
}

TEST(StudyTechniqueCommand, WithoutTruthReportsWhetherThereAreTwoGroups) {
    Scratch scratch;
    const auto result = run_command("study technique " + population().string() + " --output " + (scratch / "out").string());
    EXPECT_TRUE(result.code == 0 || result.code == 3) << result.err;
    EXPECT_NE(result.out.find("no answers are known"), std::string::npos);
    EXPECT_EQ(result.out.find("there are not two groups") != std::string::npos, result.code == 3);
}

TEST(StudyTechniqueCommand, ReportsTheNumberOfKnownAnswers) {
    Scratch scratch;
    const std::string start =
        "study technique " + population().string() + " --output " + (scratch / "out").string() + " --json --truth ";
    const auto report = [&](const std::string& table) {
        const auto result = run_command(start + scratch.file("truth.csv", "name,label\n" + table).string());
        EXPECT_TRUE(result.code == 0 || result.code == 3) << result.err;
        Json document = parse_json(result.out, "report");
        validate(read_json(scratch / "out" / "technique.json"), "technique", "technique.json");
        return document;
    };
    const auto scored = [](const Json& document) {
        bool any = false;
        for (const char* member : {"classifiers", "divisions"})
            for (const auto& each : document["result"][member].GetArray()) any = any || each.HasMember("f1");
        return any;
    };
    const Json one_label = report("statuette-1,wheel\nstatuette-3,wheel\nstatuette-5,wheel\n");
    EXPECT_EQ(one_label["result"]["truth"]["labelled"].GetInt(), 3);
    EXPECT_EQ(one_label["result"]["truth"]["objects"].GetInt(), 8);
    EXPECT_FALSE(scored(one_label)) << "answers of one kind";
    EXPECT_TRUE(scored(report("statuette-1,wheel\nstatuette-2,hand\nstatuette-3,wheel\nstatuette-4,hand\n")));
    const auto text = run_command("study technique " + population().string() + " --output " + (scratch / "out").string() +
                                  " --truth " + scratch.file("two.csv", "name,label\nstatuette-1,wheel\n").string());
    EXPECT_NE(text.out.find("answers are known for 1 of 8 objects: too few"), std::string::npos) << text.out;
    const auto none = run_command(start + scratch.file("none.csv", "name,label\nstatuette-1.ply,wheel\n").string());
    EXPECT_EQ(none.code, 1);
    EXPECT_NE(none.err.find("'statuette-1.ply'"), std::string::npos) << none.err;
}

TEST(StudyTechniqueCommand, RefusesInvalidOptions) {
    Scratch scratch;
    const std::string start = "study technique " + population().string() + " --output " + (scratch / "out").string();
    EXPECT_EQ(run_command(start + " --answer-by weight").code, 2);
    EXPECT_EQ(run_command(start + " --from 0.5 --to 0.4").code, 2);
    EXPECT_EQ(run_command(start + " --up 0,0,0").code, 2);
    EXPECT_EQ(run_command(start + " --positive cast").code, 2);
    EXPECT_EQ(run_command("study technique " + (scratch / "nowhere").string() + " --output " + (scratch / "o").string()).code, 1);
    // No slice is usable: all slices lie above the objects' lower parts.
    EXPECT_EQ(run_command(start + " --min-slices 101").code, 1);
}

TEST(StudyTechniqueCommand, ReportsClassifiersThatDoNotDistinguish) {
    Scratch scratch;
    const std::string folder = (scratch / "alike").string();
    ASSERT_EQ(run_command("study make technique " + folder + " --objects 16 --level 5 --vertices 4000 --seed 7").code, 0);
    const auto result = run_command("study technique " + folder + " --truth " + folder + "/truth.csv --output " +
                                    (scratch / "out").string() + " --answer-by \"eccentricity mean and variance\"");
    EXPECT_EQ(result.code, 3) << result.err;
    EXPECT_NE(result.out.find("this classifier does not distinguish the classes here"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("0.667"), std::string::npos) << "the F1 of calling all of them wheel-made";
    EXPECT_EQ(result.out.find("clear"), std::string::npos) << result.out;
}

TEST(StudyTechniqueCommand, OutOfClassObjectsGetNoAnswer) {
    Scratch scratch;
    const Path folder = scratch / "mixed", out = scratch / "out";
    std::filesystem::copy(population(), folder);
    ASSERT_EQ(run_command("mesh make hand " + (folder / "hand.ply").string() + " --vertices 5000").code, 0);
    const auto result = run_command("study technique " + folder.string() + " --truth " + (folder / "truth.csv").string() +
                                    " --answer-by roundness --output " + out.string());
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.err.find("the upward direction is unknown and z is used"), std::string::npos) << result.err;
    EXPECT_NE(result.out.find("8 of 8 right\nno answer, because they are too dissimilar to the labelled objects"),
              std::string::npos)
        << result.out;
    const Json report = read_json(out / "technique.json");
    validate(report, "technique", "technique.json");
    for (const auto& object : report["objects"].GetArray())
        EXPECT_EQ(object.HasMember("unlike"), std::string(object["name"].GetString()) == "hand");
    EXPECT_NE(read_file(out / "roundness.svg").find("<svg"), std::string::npos);
}

TEST(StudyTechniqueCommand, ReportsThatTheOptionOverridesTheAnnotations) {
    Scratch scratch;
    const std::string start = "study technique " + population().string() + " --output ";
    const auto same = run_command(start + (scratch / "same").string() + " --up 0,0,2");
    EXPECT_EQ(same.err.find("--up is used"), std::string::npos) << same.err;
    EXPECT_EQ(same.err.find("is unknown"), std::string::npos) << same.err;
    for (int run = 0; run < 2; ++run) {  // also where the results are kept from an earlier run
        const auto other = run_command(start + (scratch / "other").string() + " --up 0,0.2,1");
        EXPECT_NE(other.err.find("--up is used, although the annotations have a different"), std::string::npos) << other.err;
    }
}

TEST(StudySegmentsCommand, ReportsClustersWithoutSegments) {
    Scratch scratch;
    const Path mesh = population() / "statuette-1.ply", out = scratch / "segments.ant.json";
    for (const int minimum : {1, 30}) {
        const std::string words = "study segments " + mesh.string() + " " + out.string() + " --size --clusters 6 --unit mm " +
                                  "--min-run " + std::to_string(minimum);
        const auto result = run_command(words);
        ASSERT_EQ(result.code, 0) << result.err;
        const auto report = run_command(words + " --json");
        std::set<int> clusters;
        const Json json = parse_json(report.out, "report");
        for (const auto& each : json["result"]["segments"].GetArray()) clusters.insert(each["cluster"].GetInt());
        EXPECT_EQ(result.out.find("of the 6 clusters") != std::string::npos, clusters.size() < 6) << result.out;
        EXPECT_EQ(clusters.size() == 6, minimum == 1);
        EXPECT_EQ(result.out.find("of one cluster, and therefore of one colour") != std::string::npos,
                  json["result"]["segments"].Size() > clusters.size());
        EXPECT_NE(result.out.find("area mm^2"), std::string::npos) << result.out;
        EXPECT_EQ(read_annotations(out, read_mesh(mesh).mesh).unit, "mm");
    }
}

TEST(StudySegmentsCommand, WritesRegionsAndComparesThem) {
    Scratch scratch;
    const Path mesh = population() / "statuette-1.ply", out = scratch / "segments.ant.json", curve = scratch / "curve.svg";
    const auto result = run_command("study segments " + mesh.string() + " " + out.string() + " --size --clusters 4 --curve " +
                                    curve.string() + " --json");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    EXPECT_EQ(report["result"]["clusters"].GetInt(), 4);
    EXPECT_LT(report["result"]["adjustedRandIndex"].GetDouble(), 1);
    EXPECT_TRUE(std::filesystem::exists(curve));
    const MeshFile file = read_mesh(mesh);
    const AnnotationSet set = read_annotations(out, file.mesh);
    std::size_t faces = 0;
    for (const Annotation& region : set.annotations) faces += region.faces.size();
    EXPECT_EQ(faces, file.mesh.number_of_faces());
    // Compared with themselves.
    const auto same = run_command("study segments " + mesh.string() + " " + (scratch / "again.ant.json").string() +
                                  " --size --clusters 4 --json --compare " + out.string());
    ASSERT_EQ(same.code, 0) << same.err;
    EXPECT_DOUBLE_EQ(parse_json(same.out, "report")["result"]["adjustedRandIndex"].GetDouble(), 1);
    EXPECT_EQ(run_command("study segments " + mesh.string() + " " + mesh.string()).code, 2);
    EXPECT_EQ(run_command("study segments " + mesh.string() + " " + out.string() + " --clusters -1").code, 2);
}

}  // namespace
}  // namespace ostraka
