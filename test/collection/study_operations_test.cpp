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
    ~MemoryFolder() { forget_memory(path); }
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
    forget_memory("memory:study-operations-test-truth.csv");
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
        const auto found = std::find_if(inputs.begin(), inputs.end(), [&](const auto& input) { return input.first == name; });
        ASSERT_NE(found, inputs.end()) << name;
        EXPECT_EQ(found->second.size(), 64U);
    }
}

TEST(StudyOperations, TheFolderOfTheCollectionIsNoOutput) {
    const MemoryFolder folder;
    write_file(folder.path / "a.mrk.json", markups(1));
    Context context;
    Call call(find_operation("study landmarks"));
    call.set_file("collection", folder.path);
    call.set_file("output", folder.path / "x" / "..");
    EXPECT_THROW(call.run(context), Error);
}

TEST(LandmarkShapes, AreOfTheLandmarksInCommon) {
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

TEST(TechniqueObjects, SayWhereTheirDirectionIsFrom) {
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
