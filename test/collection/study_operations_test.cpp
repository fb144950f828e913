// Studies as operations, on collections in memory.
#include "meshes.h"

#include "ostraka/collection/landmark_shapes.h"
#include "ostraka/collection/technique_objects.h"
#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/operations/table.h"
#include "ostraka/synthetic/statuettes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ostraka {
namespace {

/// Markups of four points; `height` of the last one.
std::string markups(double height, const std::string& unit = "mm") {
    std::string points;
    const double places[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, height}};
    for (int i = 0; i < 4; ++i) {
        points += (i == 0 ? "" : ",") + std::string("{\"label\": \"p") + std::to_string(i) + "\", \"position\": [";
        for (int c = 0; c < 3; ++c) points += (c == 0 ? "" : ",") + std::to_string(places[i][c]);
        points += "], \"positionStatus\": \"defined\"}";
    }
    return R"({"markups": [{"type": "Fiducial", "coordinateSystem": "LPS", "coordinateUnits": ")" + unit +
           R"(", "controlPoints": [)" + points + "]}]}";
}

struct MemoryFolder {
    Path path = "memory:study-operations-test";
    ~MemoryFolder() { remove_memory_files(path); }
};

TEST(StudyOperations, ReadAndWriteFoldersInMemory) {
    const MemoryFolder folder;
    for (const auto& [name, height] : {std::pair{"a", 1.0}, {"b", 1.2}, {"c", 0.9}})
        write_file(folder.path / (std::string(name) + ".mrk.json"), markups(height));
    write_file(folder.path / "odd.mrk.json", "{\"markups\": 3}");
    write_file("memory:study-operations-test-truth.csv", "name,label\na,x\nb,y\nc,x\n");
    Context context;
    Call call(find_operation("study landmarks"));
    call.set_object("collection", Object::of(folder.path, "markups"));
    call.set_file("truth", "memory:study-operations-test-truth.csv");
    const Report report = call.run(context);
    remove_memory_files("memory:study-operations-test-truth.csv");
    EXPECT_EQ(report.result()["objects"].GetInt(), 3);
    EXPECT_EQ(report.result()["truth"]["labelled"].GetInt(), 3);
    ASSERT_EQ(report.result()["failed"].Size(), 1U);
    EXPECT_STREQ(report.result()["failed"][0]["name"].GetString(), "odd");
    const auto out = call.object("output").as<Path>();
    ASSERT_TRUE(out);
    for (const char* name : {"mean.mrk.json", "objects.csv", "components.svg", "landmarks/a.json"})
        EXPECT_TRUE(file_exists(*out / name)) << name;
    const auto& inputs = report.provenance().inputs;
    for (const char* name : {"a", "b", "c", "odd"}) {
        const auto input_entry =
            std::find_if(inputs.begin(), inputs.end(), [&](const auto& input) { return input.first == name; });
        ASSERT_NE(input_entry, inputs.end()) << name;
        EXPECT_EQ(input_entry->second.size(), 64U);
    }
}

TEST(StudyOperations, TheFolderOfTheCollectionIsNotAnOutput) {
    const MemoryFolder folder;
    write_file(folder.path / "a.mrk.json", markups(1));
    Context context;
    Call call(find_operation("study landmarks"));
    call.set_file("collection", folder.path);
    call.set_file("output", folder.path / "x" / "..");
    EXPECT_THROW(call.run(context), Error);
}

TEST(StudyOperations, ShardsAreGatheredToTheResultOfOneRun) {
    const MemoryFolder folder;
    for (int i = 1; i <= 5; ++i) write_file(folder.path / (std::to_string(i) + ".mrk.json"), markups(i));
    const Path whole_folder = folder.path / "one", parts = folder.path / "parts";
    const auto run = [&](const Path& output, const std::string& shard) {
        Context context;
        Call call(find_operation("study landmarks"));
        call.set_file("collection", folder.path);
        call.set_file("output", output);
        if (!shard.empty()) call.set("shard", shard);
        return to_text(call.run(context).result());
    };
    const std::string expected = run(whole_folder, "");
    EXPECT_NE(run(parts, "2/2").find("\"objects\": 2"), std::string::npos);
    EXPECT_FALSE(file_exists(parts / "objects.csv"));
    run(parts, "1/2");
    EXPECT_EQ(run(parts, ""), expected);
    EXPECT_EQ(read_file(parts / "objects.csv"), read_file(whole_folder / "objects.csv"));
    EXPECT_THROW(run(parts, "3/2"), Error);
    EXPECT_THROW(run(parts, "all"), Error);
}

TEST(LandmarkShapes, UseTheCommonLandmarks) {
    const MemoryFolder folder;
    write_file(folder.path / "a.mrk.json", markups(1));
    write_file(folder.path / "b.mrk.json", markups(2, "cm"));
    Collection collection = read_collection(folder.path);
    const auto read = read_object_landmarks(collection);
    EXPECT_THROW(common_landmarks(collection, read, false, "here"), Error) << "mm and cm";
    const LandmarkShapes shapes = common_landmarks(collection, read, true, "here");
    EXPECT_EQ(shapes.names.size(), 4U);
    EXPECT_EQ(shapes.unit, "");
    EXPECT_DOUBLE_EQ(shapes.configurations[1](3, 2), 2);
    collection.objects[0].unit = "cm";
    EXPECT_EQ(common_landmarks(collection, read, false, "here").unit, "cm") << "the collection's word counts";
}

/// Eight landmarks that no mirror maps onto each other, perturbed by `seed`, scaled by `scale`, mirrored or not.
std::string skull(int seed, double scale = 1, bool mirrored = false, int count = 8, const std::string& unit = "mm") {
    std::string points;
    const double places[8][3] = {{0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {0, 0, 2}, {4, 3, 1}, {1, 3, 2}, {4, 1, 2}, {2, 2, 3}};
    for (int i = 0; i < count; ++i) {
        points += (i == 0 ? "" : ",") + std::string("{\"label\": \"p") + std::to_string(i) + "\", \"position\": [";
        for (int c = 0; c < 3; ++c) {
            const double x = scale * (places[i][c] + 0.02 * ((seed * (i + 2) * (c + 3)) % 5 - 2));
            points += (c == 0 ? "" : ",") + std::to_string(mirrored && c == 1 ? -x : x);
        }
        points += "], \"positionStatus\": \"defined\"}";
    }
    return R"({"markups": [{"type": "Fiducial", "coordinateSystem": "LPS", "coordinateUnits": ")" + unit +
           R"(", "controlPoints": [)" + points + "]}]}";
}

TEST(LandmarkShapes, OutliersAreReportedAndDoNotStopTheStudy) {
    const MemoryFolder folder;
    for (int i = 1; i <= 5; ++i) write_file(folder.path / ("s" + std::to_string(i) + ".mrk.json"), skull(i));
    write_file(folder.path / "large.mrk.json", skull(6, 10));
    write_file(folder.path / "mirrored.mrk.json", skull(7, 1, true));
    write_file(folder.path / "poor.mrk.json", skull(8, 1, false, 2));
    write_file(folder.path / "inches.mrk.json", skull(9, 1, false, 8, "in"));
    write_file(folder.path / "unreadable.mrk.json", "{");
    const auto report_of = [&](const char* option) {
        Context context;
        Call call(find_operation("study landmarks"));
        call.set_object("collection", Object::of(folder.path, "markups"));
        if (option != nullptr) call.set(option, true);
        return call.run(context);
    };
    const Report report = report_of(nullptr);
    EXPECT_EQ(report.result()["failed"].Size(), 1U);
    EXPECT_EQ(report.result()["objects"].GetInt(), 7);
    EXPECT_EQ(report.result()["landmarks"].GetInt(), 8) << "one poor object takes no landmark from the others";
    std::map<std::string, std::pair<std::string, bool>> outliers;
    for (const auto& outlier : report.result()["odd"].GetArray())
        outliers[outlier["name"].GetString()] = {outlier["why"].GetString(), outlier["leftOut"].GetBool()};
    ASSERT_EQ(outliers.size(), 4U);
    EXPECT_NE(outliers["poor"].first.find("2 of the 8"), std::string::npos) << outliers["poor"].first;
    EXPECT_NE(outliers["inches"].first.find("in in"), std::string::npos) << outliers["inches"].first;
    EXPECT_NE(outliers["mirrored"].first.find("mirror"), std::string::npos);
    EXPECT_NE(outliers["large"].first.find("times as large"), std::string::npos);
    EXPECT_TRUE(outliers["poor"].second && outliers["inches"].second);
    EXPECT_FALSE(outliers["mirrored"].second || outliers["large"].second);
    EXPECT_EQ(report_of("leave-odd-out").result()["objects"].GetInt(), 5);
}

TEST(TechniqueObjects, ReportTheSourceOfTheirDirection) {
    const MemoryFolder folder;
    StatuetteParameters parameters;
    parameters.vertices = 4000;
    write_mesh(folder.path / "a.ply", generate_statuette(parameters).mesh);
    write_mesh(folder.path / "ball.ply", Mesh());
    const Collection collection = read_collection(folder.path);
    const auto measured = measure_technique(collection, std::nullopt);
    EXPECT_FALSE(measured[1].problem.empty());
    EXPECT_EQ(technique_objects(collection, measured).size(), 1U);
    const auto notes = notes_on_directions(collection, measured);
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_NE(notes[0].find("(1 objects: a)"), std::string::npos) << notes[0];
    EXPECT_TRUE(notes_on_directions(collection, measure_technique(collection, std::array<double, 3>{0, 0, 1})).empty());
}

}  // namespace
}  // namespace ostraka
