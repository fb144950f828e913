// The built command, as people run it.
#include "annotation/example_meshes.h"
#include "ostraka/files/json.h"
#include "ostraka/io/mesh_file.h"
#include "scratch.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::example;
using ostraka::test::run_command;
using ostraka::test::Scratch;

namespace {

const char* const simple_recipe =
    R"({"format": "ostraka-recipe", "version": 1, "class": "tile", "unit": "mm", "frame": "box", "annotations": [
  {"id": 1, "tag": "left", "type": "region", "select": {"box": {"min": [0, 0, 0], "max": [0.5, 1, 1]}},
   "attributes": [{"id": 0, "name": "height", "type": "measure", "measure": {"tool": "bounding", "direction": [0, 1, 0]}},
                  {"id": 1, "name": "area", "type": "descriptor"}]},
  {"id": 2, "tag": "way", "type": "line", "select": {"path": {"points": [[0, 0, 0], [1, 1, 0]]}}},
  {"id": 3, "tag": "corner", "type": "point", "select": {"nearest": [1, 0, 0]}}]})";

struct Folder : Scratch {
    Folder() { write_mesh(*this / "tile.ply", grid(4)); }
    [[nodiscard]] std::string at(const std::string& name) const { return (*this / name).string(); }
    [[nodiscard]] std::string apply() const {
        (void)file("r.recipe.json", simple_recipe);
        return "annotation apply " + at("tile.ply") + " " + at("r.recipe.json") + " " + at("out.ant.json");
    }
};

}  // namespace

TEST(AnnotationCommand, ARecipeIsReplayedToTheByte) {
    const Folder folder;
    const auto result = run_command(folder.apply() + " --ply " + folder.at("c.ply") + " --labels-out " + folder.at("l.seg"));
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.out.find("left"), std::string::npos);
    EXPECT_NE(result.out.find("height 4 mm"), std::string::npos) << result.out;
    const std::string first = read_file(folder / "out.ant.json");
    EXPECT_EQ(first.find(folder.path().string()), std::string::npos) << "no folder in a result";
    ASSERT_EQ(run_command(folder.apply() + " --threads 1").code, 0);
    EXPECT_EQ(read_file(folder / "out.ant.json"), first);
    const MeshFile coloured = read_mesh(folder / "c.ply");
    EXPECT_EQ(coloured.extras.face_colours.size(), 32U);
    EXPECT_NE(coloured.extras.face_colours[0], coloured.extras.face_colours[31]);
    EXPECT_EQ(read_file(folder / "l.seg").substr(0, 4), "1\n1\n");
}

TEST(AnnotationCommand, ListAndCheck) {
    const Folder folder;
    ASSERT_EQ(run_command(folder.apply()).code, 0);
    const std::string pair = folder.at("tile.ply") + " " + folder.at("out.ant.json");
    const auto list = run_command("annotation list " + pair + " --json");
    ASSERT_EQ(list.code, 0) << list.err;
    const Json report = parse_json(list.out, "report");
    validate(report, "report", "report");
    EXPECT_EQ(report["result"]["annotations"].Size(), 4U);
    EXPECT_EQ(report["result"]["annotations"][1]["area"].GetDouble(), 8);
    const auto check = run_command("annotation check " + pair);
    EXPECT_EQ(check.code, 0) << check.out;
    EXPECT_NE(check.out.find("no defects"), std::string::npos);
    // An outdated value.
    std::string text = read_file(folder / "out.ant.json");
    text.replace(text.find("\"value\": 4"), 10, "\"value\": 5");
    write_file(folder / "bad.ant.json", text);
    const auto bad = run_command("annotation check " + folder.at("tile.ply") + " " + folder.at("bad.ant.json"));
    EXPECT_EQ(bad.code, 3);
    EXPECT_NE(bad.out.find("is 5 but measures 4"), std::string::npos) << bad.out;
    // Another mesh: the answer is no, and with --force-mesh the indices are checked.
    write_mesh(folder / "other.ply", grid(4, 2));
    const std::string other = folder.at("other.ply") + " " + folder.at("out.ant.json");
    EXPECT_EQ(run_command("annotation check " + other).code, 3);
    const auto refused = run_command("annotation list " + other);
    EXPECT_EQ(refused.code, 1);
    EXPECT_NE(refused.err.find("checksum"), std::string::npos) << refused.err;
    EXPECT_EQ(run_command("annotation list --force-mesh " + other).code, 0);
}

TEST(AnnotationCommand, LabelsInAndOut) {
    const Folder folder;
    std::string labels;
    for (int i = 0; i < 32; ++i) labels += std::to_string(i / 10) + "\n";
    const std::string seg = folder.file("tile.seg", labels).string(),
                      names = folder.file("names.json", R"(["head", "arm"])").string();
    const auto result = run_command("annotation apply " + folder.at("tile.ply") + " " + seg + " " + folder.at("o.ant.json") +
                                    " --names " + names + " --labels-out " + folder.at("back.seg"));
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.out.find("arm"), std::string::npos);
    EXPECT_NE(result.out.find("part 3"), std::string::npos);
    EXPECT_EQ(read_file(folder / "back.seg"), labels);
    // The same with the labels of a PLY file.
    MeshExtras extras;
    for (int i = 0; i < 32; ++i) extras.face_labels.push_back(i / 10);
    write_mesh(folder / "labelled.ply", grid(4), extras);
    const auto ply = run_command("annotation apply --from-ply-labels " + folder.at("labelled.ply") + " " +
                                 folder.at("p.ant.json") + " --labels-out " + folder.at("ply.seg"));
    ASSERT_EQ(ply.code, 0) << ply.err;
    EXPECT_EQ(read_file(folder / "ply.seg"), labels);
    EXPECT_EQ(run_command("annotation apply --from-ply-labels " + folder.at("tile.ply") + " " + folder.at("p.ant.json")).code, 1);
}

TEST(AnnotationCommand, RemapFollowsTheMaps) {
    const Folder folder;
    ASSERT_EQ(run_command(folder.apply()).code, 0);
    TriangleSoup soup = to_soup(grid(4));
    soup.triangles.resize(30);
    write_mesh(folder / "after.ply", build_mesh(soup));
    std::string vertices, faces, labels;
    for (int i = 0; i < 25; ++i) vertices += (i ? ", " : "") + std::to_string(i);
    for (int i = 0; i < 32; ++i) faces += (i ? ", " : "") + std::to_string(i < 30 ? i : -1), labels += std::to_string(i) + "\n";
    const auto map = [&](const std::string& kind, int from, int to, const std::string& list) {
        return folder
            .file(kind + ".json", R"({"format": "ostraka-map", "version": 1, "kind": ")" + kind + R"(", "from": )" +
                                      std::to_string(from) + R"(, "to": )" + std::to_string(to) + R"(, "map": [)" + list + "]}")
            .string();
    };
    const std::string maps = " --vertex-map " + map("vertex", 25, 25, vertices) + " --face-map " + map("face", 32, 30, faces);
    const auto result = run_command("annotation remap " + folder.at("tile.ply") + " " + folder.at("out.ant.json") + " " +
                                    folder.at("after.ply") + " " + folder.at("moved.ant.json") + maps);
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(run_command("annotation check " + folder.at("after.ply") + " " + folder.at("moved.ant.json")).code, 0);
    EXPECT_NE(read_file(folder / "moved.ant.json").find("cut"), std::string::npos) << "the way ran to a corner that is gone";
    const std::string seg = folder.file("old.seg", labels).string();
    ASSERT_EQ(run_command("annotation remap " + folder.at("tile.ply") + " " + seg + " " + folder.at("after.ply") + " " +
                          folder.at("new.seg") + maps)
                  .code,
              0);
    EXPECT_EQ(read_file(folder / "new.seg"), labels.substr(0, labels.size() - 6));
    EXPECT_EQ(run_command("annotation remap " + folder.at("tile.ply") + " " + seg + " " + folder.at("after.ply") + " " +
                          folder.at("new.seg"))
                  .code,
              2);
}

TEST(AnnotationCommand, WrongInputLeavesNothingBehind) {
    const Folder folder;
    const std::string recipe = folder.file("r.recipe.json", simple_recipe).string(), mesh = folder.at("tile.ply"),
                      out = folder.at("o.ant.json");
    const std::size_t before = test::count_files(folder.path());
    const auto expect = [&](const std::string& arguments, int code, const std::string& message) {
        const auto result = run_command("annotation " + arguments);
        EXPECT_EQ(result.code, code) << arguments << "\n" << result.err;
        EXPECT_NE((result.err + result.out).find(message), std::string::npos) << arguments << "\n" << result.err << result.out;
        EXPECT_EQ(test::count_files(folder.path()), before) << arguments;
    };
    expect("apply " + mesh, 2, "give mesh recipe output, or mesh output");
    expect("apply " + mesh + " " + recipe, 2, "output");
    expect("apply " + folder.at("none.ply") + " " + recipe + " " + out, 1, "none.ply");
    expect("apply " + mesh + " " + folder.at("none.json") + " " + out, 1, "none.json");
    expect("apply " + mesh + " " + recipe + " " + mesh, 2, "tile.ply");
    expect("apply " + mesh + " " + recipe + " " + folder.at("missing/o.ant.json"), 1, "missing");
    expect("apply " + mesh + " " + recipe + " " + out + " --ply " + folder.at("c.xyz"), 2, "xyz");
    expect("apply " + recipe + " " + recipe + " " + out, 2, "r.recipe.json");
    expect("list " + mesh + " " + recipe, 1, "ostraka-recipe");
    expect("check " + mesh + " " + mesh, 1, "check the order of the files");
    expect("check " + mesh + " " + recipe, 3, "ostraka-recipe");
}
