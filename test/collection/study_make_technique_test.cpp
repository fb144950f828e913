// `ostraka study make technique` as users run it.
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/collection/objects.h"
#include "ostraka/files/csv.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/operations/table.h"
#include "scratch.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {
using test::run_command;
using test::Scratch;

TEST(MakeTechniqueCommand, WritesACollectionWithItsTruth) {
    Scratch scratch;
    const Path folder = scratch / "population";
    const auto result =
        run_command("study make technique " + folder.string() + " --objects 3 --vertices 5000 --interior closed --json");
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(parse_json(result.out, "report")["result"]["objects"].GetInt(), 3);
    Collection collection = read_collection(folder);
    ASSERT_EQ(collection.objects.size(), 3U);
    const auto labels = read_labels(folder / "truth.csv");
    EXPECT_EQ(labels.at("statuette-1"), "wheel");
    EXPECT_EQ(labels.at("statuette-2"), "hand");
    const auto rows = csv_rows(read_file(folder / "truth.csv"), ',', "truth.csv");
    ASSERT_EQ(rows.size(), 4U);
    const auto column = [&](const std::string& name) {
        const auto& header = rows[0].cells;
        return static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin());
    };
    for (std::size_t i = 0; i < 3; ++i) {
        const CollectionObject& object = collection.objects[i];
        const MeshFile file = read_mesh(object.mesh);
        const AnnotationSet set = read_annotations(object.annotations, file.mesh);
        const auto planted = [&](const std::string& name) { return std::stod(rows[i + 1].cells.at(column(name))); };
        std::map<std::string, double> measured;
        for (const Annotation& annotation : set.annotations)
            for (const Attribute& attribute : annotation.attributes)
                measured[attribute.name] = attribute.measure()->value.value_or(0);
        EXPECT_NEAR(measured["total height"], planted("height"), 0.01 * planted("height"));
        EXPECT_NEAR(measured["base diameter"], planted("base-diameter"), 0.02 * planted("base-diameter"));
        EXPECT_NEAR(measured["head height"], planted("head-height"), 0.03 * planted("head-height"));
        EXPECT_NEAR(measured["arm length right"], planted("arm-length"), 0.06 * planted("arm-length"));
        EXPECT_NEAR(measured["arm length left"], planted("arm-length"), 0.06 * planted("arm-length"));
    }
}

TEST(MakeTechniqueCommand, GivesTheSameBytesInEveryRunAndForAnyNumberOfThreads) {
    Scratch scratch;
    const std::string words = " --objects 2 --vertices 4000 --holes 2 --level 3 --seed 9";
    ASSERT_EQ(run_command("study make technique " + (scratch / "a").string() + words + " --threads 1").code, 0);
    ASSERT_EQ(run_command("study make technique " + (scratch / "b").string() + words + " --threads 2").code, 0);
    for (const char* name : {"truth.csv", "statuette-1.ply", "statuette-2.ply", "statuette-1.ant.json"})
        EXPECT_EQ(read_file(scratch / "a" / name), read_file(scratch / "b" / name)) << name;
}

TEST(MakeTechniqueCommand, RefusesInvalidOptions) {
    Scratch scratch;
    const std::string folder = (scratch / "p").string();
    EXPECT_EQ(run_command("study make technique " + folder + " --level 6").code, 2);
    EXPECT_EQ(run_command("study make technique " + folder + " --objects 0").code, 2);
    EXPECT_EQ(run_command("study make technique " + folder + " --interior unknown").code, 2);
    const Path file = scratch.file("taken", "x");
    const auto refused = run_command("study make technique " + file.string() + " --objects 1");
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("is a file"), std::string::npos) << refused.err;
}

TEST(MakeCollections, InMemory) {
    for (const std::string kind : {"technique", "proportions", "moulds"}) {
        Context context;
        Call call(find_operation("study make " + kind));
        call.set("objects", 2.0);
        call.set("vertices", 4000.0);
        const Report report = call.run(context);
        EXPECT_EQ(report.result()["objects"].GetInt(), 2);
        const Path folder = *call.object("folder").as<Path>();
        EXPECT_TRUE(is_memory(folder));
        EXPECT_TRUE(file_exists(folder / "truth.csv")) << kind;
        const std::vector<std::string> files = files_in(folder);
        EXPECT_EQ(std::count_if(files.begin(), files.end(), [](const auto& name) { return name.ends_with(".ply"); }), 2) << kind;
        const std::string mesh =
            *std::find_if(files.begin(), files.end(), [](const auto& name) { return name.ends_with(".ply"); });
        EXPECT_GT(read_mesh(folder / mesh).mesh.number_of_faces(), 1000U);
    }
}

TEST(MakeCollections, DoNotMixWithExistingFiles) {
    Scratch scratch;
    for (const char* name : {"old.ply", "old.OBJ", "old.ant.json", "truth.csv"}) {
        const Path folder = scratch / (std::string("with ") + name);
        std::filesystem::create_directories(folder);
        write_file(folder / name, "x");
        write_file(folder / "notes.txt", "x");
        for (const std::string kind : {"technique", "proportions", "moulds"}) {
            const auto result = run_command("study make " + kind + " '" + folder.string() + "' --objects 2");
            EXPECT_EQ(result.code, 1) << kind << name;
            EXPECT_NE(result.err.find(name), std::string::npos) << result.err;
            EXPECT_NE(result.err.find("new or empty"), std::string::npos) << result.err;
            EXPECT_EQ(test::count_files(folder), 2U) << kind << name;
        }
    }
    std::filesystem::create_directories(scratch / "other");
    write_file(scratch / "other" / "notes.txt", "x");
    EXPECT_EQ(run_command("study make technique " + (scratch / "other").string() + " --objects 1 --vertices 4000").code, 0);
}

}  // namespace
}  // namespace ostraka
