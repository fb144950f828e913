// `ostraka study proportions` as users run it.
#include "meshes.h"
#include "scratch.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/collection/measure_definitions.h"
#include "ostraka/collection/measure_table.h"
#include "ostraka/core/text.h"
#include "ostraka/files/csv.h"
#include "ostraka/files/json.h"
#include "ostraka/io/mesh_file.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

using test::count_files;
using test::run_command;
using test::Scratch;

std::string quoted(const Path& path) { return "'" + path.string() + "'"; }

/// Boxes stretched along their axes, with three parts: the sides of each are its measures.
void write_boxes(const Scratch& scratch, const Path& folder, const MeasureTable& table) {
    std::filesystem::create_directories(folder);
    const TriangleSoup unit = test::octahedron_sphere(2);
    for (std::size_t i = 0; i < table.objects.size(); ++i) {
        TriangleSoup soup;
        AnnotationSet set;
        set.unit = "mm";
        std::vector<std::vector<Index>> faces;
        for (Eigen::Index part = 0; part < 3; ++part) {
            const Index base = static_cast<Index>(soup.points.size());
            std::vector<Index> part_faces;
            for (const auto& p : unit.points) {
                std::array<double, 3> q{};
                for (std::size_t c = 0; c < 3; ++c)
                    q[c] = 0.5 * p[c] *
                           (3 * part + static_cast<Eigen::Index>(c) < table.values.cols()
                                ? table.values(static_cast<Eigen::Index>(i), 3 * part + static_cast<Eigen::Index>(c))
                                : 1);
                q[0] += 1000.0 * static_cast<double>(part);
                soup.points.push_back(q);
            }
            for (const auto& [a, b, c] : unit.triangles) {
                part_faces.push_back(static_cast<Index>(soup.triangles.size()));
                soup.triangles.push_back({a + base, b + base, c + base});
            }
            faces.push_back(part_faces);
        }
        const Mesh mesh = build_mesh(soup);
        for (int part = 0; part < 3; ++part) {
            Annotation annotation;
            annotation.id = part;
            annotation.tag = "part " + std::to_string(part + 1);
            annotation.faces = faces[static_cast<std::size_t>(part)];
            set.annotations.push_back(annotation);
        }
        write_mesh(folder / (table.objects[i] + ".ply"), mesh);
        write_annotations(folder / (table.objects[i] + ".ant.json"), {mesh, set}, table.objects[i] + ".ply", {});
    }
    std::string definitions;
    for (int part = 1; part <= 3; ++part)
        for (int c = 0; c < 3 && 3 * (part - 1) + c < 8; ++c)
            definitions += (definitions.empty() ? "" : ",") + std::string("{\"name\": \"measure ") +
                           std::to_string(3 * (part - 1) + c + 1) + "\", \"tool\": \"bounding\", \"annotation\": \"part " +
                           std::to_string(part) + "\", \"direction\": [" +
                           (c == 0   ? "1,0,0"
                            : c == 1 ? "0,1,0"
                                     : "0,0,1") +
                           "]}";
    (void)scratch.file("boxes.measures.json",
                       R"({"format": "ostraka-measures", "version": 1, "measures": [)" + definitions + "]}");
}

struct Boxes {
    Scratch scratch;
    SyntheticMeasures measures;
    std::string command;

    explicit Boxes(std::uint64_t seed = 3) {
        SyntheticMeasuresOptions options;
        options.objects = 24;
        options.seed = seed;
        measures = make_measures(options);
        write_boxes(scratch, scratch / "boxes", measures.table);
        command = "study proportions " + quoted(scratch / "boxes") + " --measures " + quoted(scratch / "boxes.measures.json") +
                  " --output " + quoted(scratch / "out") + " --permutations 999";
    }
};

TEST(StudyProportionsCommand, FindsPlantedProportionsOfAnnotatedMeshes) {
    const Boxes boxes;
    const auto result = run_command(boxes.command + " --json");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    validate(report, "report", "report");
    EXPECT_EQ(report["result"]["objects"].GetInt(), 24);
    const Json study_file = read_json(boxes.scratch / "out" / "proportions.json");
    validate(study_file, "proportions", "proportions.json");
    for (const JsonValue& ratio : study_file["ratios"].GetArray()) {
        const auto number = [&](const char* name) {
            return static_cast<std::size_t>(std::stoi(std::string(ratio[name].GetString()).substr(8)) - 1);
        };
        const int a = boxes.measures.groups[number("numerator")], b = boxes.measures.groups[number("denominator")];
        if (a >= 0 && a == b) {
            EXPECT_STREQ(ratio["verdict"].GetString(), "fixed");
        }
    }
    for (const char* name : {"table-3-1.md", "table-3-1.csv", "table-3-1.tex", "ratios.md", "values.csv", "variation.svg",
                             "deviations.svg", "measures.svg"})
        EXPECT_TRUE(std::filesystem::exists(boxes.scratch / "out" / name)) << name;
    // The values are those of the table from which the boxes were made, and the table alone gives the same result.
    const auto from_table = run_command("study proportions " + quoted(boxes.scratch / "out" / "values.csv") + " --output " +
                                        quoted(boxes.scratch / "other") + " --permutations 999 --json");
    ASSERT_EQ(from_table.code, 0) << from_table.err;
    const Json other = parse_json(from_table.out, "report");
    for (rapidjson::SizeType r = 0; r < other["result"]["ratios"].Size(); ++r)
        EXPECT_EQ(other["result"]["ratios"][r]["q"].GetDouble(), study_file["ratios"][r]["q"].GetDouble());
}

TEST(StudyProportionsCommand, ResumesAndGivesTheSameForAnyNumberOfThreads) {
    const Boxes boxes;
    ASSERT_EQ(run_command(boxes.command + " --threads 1").code, 0);
    const std::string first = read_file(boxes.scratch / "out" / "proportions.json");
    const std::size_t file_count = count_files(boxes.scratch / "out" / "objects");
    EXPECT_EQ(file_count, 24u);
    ASSERT_EQ(run_command(boxes.command + " --threads 2").code, 0);
    EXPECT_EQ(read_file(boxes.scratch / "out" / "proportions.json"), first);
    std::filesystem::remove_all(boxes.scratch / "out");
    ASSERT_EQ(run_command(boxes.command + " --threads 2").code, 0);
    EXPECT_EQ(read_file(boxes.scratch / "out" / "proportions.json"), first);
}

TEST(StudyProportionsCommand, FailedObjectsAreReportedAndOthersRemain) {
    const Boxes boxes;
    (void)boxes.scratch.file("boxes/broken.ply", "ply\nnonsense");
    write_mesh(boxes.scratch / "boxes" / "bare.ply", build_mesh(test::octahedron_sphere(1)));
    std::filesystem::remove(boxes.scratch / "boxes" / "object 1.ant.json");
    const auto result = run_command(boxes.command + " --json");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    EXPECT_EQ(report["result"]["failed"].Size(), 3u);
    EXPECT_EQ(report["result"]["objects"].GetInt(), 23);
    EXPECT_NE(result.err.find("left out: broken"), std::string::npos);
    EXPECT_NE(result.err.find("left out: bare"), std::string::npos);
}

TEST(StudyProportionsCommand, RemovesOnlyItsOwnOutputs) {
    const Boxes boxes;
    ASSERT_EQ(run_command(boxes.command).code, 0);
    (void)boxes.scratch.file("out/remarks.txt", "mine");
    ASSERT_EQ(run_command(boxes.command + " --plots png").code, 0);
    for (const char* name : {"variation", "deviations", "measures"}) {
        EXPECT_FALSE(std::filesystem::exists(boxes.scratch / "out" / (std::string(name) + ".svg"))) << name;
        EXPECT_TRUE(std::filesystem::exists(boxes.scratch / "out" / (std::string(name) + ".png"))) << name;
    }
    EXPECT_TRUE(std::filesystem::exists(boxes.scratch / "out" / "remarks.txt"));
    EXPECT_EQ(count_files(boxes.scratch / "out" / "objects"), 24U);
}

TEST(StudyProportionsCommand, AnInvalidNameDoesNotStopTheRun) {
    const Boxes boxes;
    for (const std::string name : {"new\nline", "back\\slash", "no utf-8 \xff"})
        std::filesystem::copy_file(boxes.scratch / "boxes" / "object 1.ply", boxes.scratch / "boxes" / (name + ".ply"));
    const auto result = run_command(boxes.command + " --json");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    EXPECT_EQ(report["result"]["failed"].Size(), 3U);
    EXPECT_EQ(report["result"]["objects"].GetInt(), 24);
    EXPECT_NE(result.err.find("left out: new?line"), std::string::npos) << result.err;
}

TEST(StudyProportionsCommand, ProposesConstraintsForATemplate) {
    const Boxes boxes;
    const Path folder = boxes.scratch / "boxes";
    const auto result =
        run_command(boxes.command + " --template-mesh " + quoted(folder / "object 1.ply") + " --template-annotations " +
                    quoted(folder / "object 1.ant.json") + " --graph " + quoted(boxes.scratch / "g.graph.json") +
                    " --annotations-out " + quoted(boxes.scratch / "t.ant.json") + " --json");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report"), graph = read_json(boxes.scratch / "g.graph.json");
    validate(graph, "graph", "graph");
    EXPECT_EQ(graph["relationships"].Size(), report["result"]["proposed"].GetUint());
    const auto check = run_command("relation check " + quoted(folder / "object 1.ply") + " " +
                                   quoted(boxes.scratch / "t.ant.json") + " " + quoted(boxes.scratch / "g.graph.json"));
    EXPECT_EQ(check.code, 0) << check.err << check.out;
}

TEST(StudyMakeProportionsCommand, MeasuresMatchTheDrawnValues) {
    const Scratch scratch;
    const std::string make = "study make proportions --objects 3 --vertices 4000 --seed 5 ";
    ASSERT_EQ(run_command(make + quoted(scratch / "made")).code, 0);
    const auto study =
        run_command("study proportions " + quoted(scratch / "made") + " --measures " +
                    quoted(scratch / "made" / "statuettes.measures.json") + " --output " + quoted(scratch / "out"));
    ASSERT_EQ(study.code, 3) << "three objects tell nothing: " << study.err;
    const MeasureTable truth = read_measure_table(scratch / "made" / "truth.csv"),
                       measured = read_measure_table(scratch / "out" / "values.csv");
    ASSERT_EQ(measured.objects, truth.objects);
    for (Eigen::Index i = 0; i < 3; ++i)
        for (Eigen::Index j = 0; j < 5; ++j)
            EXPECT_NEAR(measured.values(i, j), truth.values(i, j), (j == 0 ? 0.02 : 0.1) * truth.values(i, j))
                << truth.measures[static_cast<std::size_t>(j)].name;
    ASSERT_EQ(run_command(make + quoted(scratch / "again") + " --threads 1").code, 0);
    for (const char* name : {"truth.csv", "statuette-2.ply", "statuette-2.ant.json"})
        EXPECT_EQ(read_file(scratch / "again" / name), read_file(scratch / "made" / name)) << name;
    const auto chosen = run_command(make + quoted(scratch / "chosen") + " --fixed 'arm length,head height' --json");
    ASSERT_EQ(chosen.code, 0) << chosen.err;
    EXPECT_STREQ(parse_json(chosen.out, "report")["result"]["fixed"].GetString(), "arm length, head height");
    EXPECT_EQ(run_command(make + quoted(scratch / "x") + " --fixed 'arm length'").code, 2);
    EXPECT_EQ(run_command(make + quoted(scratch / "x") + " --fixed 'nose,chin'").code, 2);
}

TEST(StudyProportionsCommand, AnswersNoWithoutFixedRatios) {
    const Scratch scratch;
    const Path single_file = scratch.file("one.csv", "name,arm [cm],height [cm]\na,8,20\n"),
               same = scratch.file("same.csv", "name,arm,height,base\na,8,20,5\nb,8,20,5\nc,8,20,5\nd,8,20,5\ne,8,20,5\n");
    for (const Path& file : {single_file, same}) {
        const auto result = run_command("study proportions " + quoted(file) + " --output " + quoted(scratch / "out"));
        EXPECT_EQ(result.code, 3) << result.err;
        EXPECT_NE(result.out.find("0 of "), std::string::npos);
    }
}

TEST(StudyProportionsCommand, TablesForMachinesHoldPlainNumbers) {
    const Scratch scratch;
    const Path file = scratch.file("t.csv",
                                   "name,arm [cm],height [cm],base [cm],hat [cm]\na,8,20,5,\nb,9,21,6,\nc,7,19,5,3\nd,8,22,6,\n"
                                   "e,8,21,7,1e308\n");
    const auto result = run_command("study proportions " + quoted(file) + " --output " + quoted(scratch / "out"));
    ASSERT_NE(result.code, 1) << result.err;
    EXPECT_NE(result.err.find("1e+308"), std::string::npos) << result.err;
    for (const std::string name : {"table-3-1", "ratios"}) {
        const std::string text = read_file(scratch / "out" / (name + ".csv"));
        const auto rows = csv_rows(text, ',', name);
        ASSERT_GT(rows.size(), 3U);
        const std::size_t first = name == "ratios" ? 1 : 2, last = rows[0].cells.size() - (name == "ratios" ? 2 : 0);
        std::size_t empty = 0, full = 0;
        for (std::size_t r = 1; r < rows.size(); ++r)
            for (std::size_t c = first; c < last; ++c) {
                const std::string& cell = rows[r].cells.at(c);
                empty += cell.empty() ? 1 : 0;
                full += cell.size() > 12 ? 1 : 0;
                EXPECT_TRUE(cell.empty() || number_of(cell)) << name << " " << rows[0].cells[c] << " " << cell;
            }
        EXPECT_GT(full, 0U) << name;
        if (name == "table-3-1") {
            EXPECT_GT(empty, 0U);
        }
        EXPECT_NE(read_file(scratch / "out" / (name + ".md")).find("%"), std::string::npos);
        for (const char* ending : {".csv", ".md", ".tex"}) {
            const std::string written = read_file(scratch / "out" / (name + ending));
            EXPECT_EQ(written.find("inf"), std::string::npos);
            EXPECT_EQ(written.find("nan"), std::string::npos);
        }
    }
    EXPECT_EQ(read_file(scratch / "out" / "proportions.json").find("null,null"), std::string::npos);
}

TEST(StudyProportionsCommand, ATableNeedsItsHeadings) {
    const Scratch scratch;
    const Path bare = scratch.file("bare.csv", "a,8,20\nb,9,21\nc,7,19\n");
    const auto result = run_command("study proportions " + quoted(bare) + " --output " + quoted(scratch / "out"));
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(result.err.find("line 1: the first line contains the number 8"), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(scratch / "out"));
    // The folder of the table is not written to: its own values.csv might be the table.
    EXPECT_EQ(run_command("study proportions " + quoted(bare) + " --output " + quoted(scratch.path())).code, 2);
}

TEST(StudyProportionsCommand, RefusesWrongUsage) {
    const Boxes boxes;
    const std::string folder =
        "study proportions " + quoted(boxes.scratch / "boxes") + " --output " + quoted(boxes.scratch / "out");
    EXPECT_EQ(run_command(folder).code, 2) << "no measures";
    EXPECT_EQ(run_command(folder + " --measures nowhere.json").code, 1);
    EXPECT_EQ(run_command(boxes.command + " --graph g.json").code, 2) << "no template";
    EXPECT_EQ(run_command(boxes.command + " --template-mesh m.ply").code, 2) << "no graph";
    EXPECT_EQ(
        run_command("study proportions " + quoted(boxes.scratch / "no.csv") + " --output " + quoted(boxes.scratch / "out")).code,
        1);
    EXPECT_EQ(run_command(boxes.command + " --false-discoveries 2").code, 2);
    const Path wrong = boxes.scratch.file(
        "wrong.measures.json",
        R"({"format": "ostraka-measures", "version": 1, "measures": [{"name": "x", "descriptor": "beauty"}]})");
    const auto none = run_command(folder + " --measures " + quoted(wrong));
    EXPECT_EQ(none.code, 1);
    EXPECT_NE(none.err.find("no object could be measured"), std::string::npos) << none.err;
}

}  // namespace
}  // namespace ostraka
