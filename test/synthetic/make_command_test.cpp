// `ostraka mesh make` as people run it.
#include "ostraka/files/json.h"
#include "ostraka/io/mesh_file.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <sstream>

namespace ostraka {
namespace {
using test::run_command;
using test::Scratch;

TEST(MakeCommand, WritesMeshAndLabelsThatAgree) {
    Scratch scratch;
    const Path mesh = scratch / "pot.ply", labels = scratch / "pot.txt";
    const auto result =
        run_command("mesh make teapot " + mesh.string() + " --vertices 3000 --labels " + labels.string() + " --json");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    EXPECT_STREQ(report["command"].GetString(), "mesh make");
    const MeshFile read = read_mesh(mesh);
    EXPECT_EQ(read.mesh.number_of_vertices(), report["result"]["vertices"].GetUint64());
    EXPECT_NEAR(static_cast<double>(read.mesh.number_of_vertices()), 3000, 30);
    ASSERT_EQ(read.extras.face_labels.size(), read.mesh.number_of_faces());
    EXPECT_EQ(read.extras.vertex_labels.size(), read.mesh.number_of_vertices());
    EXPECT_EQ(read.extras.face_colours.size(), read.mesh.number_of_faces());
    std::istringstream lines(read_file(labels));
    std::int32_t label = -1;
    std::size_t count = 0;
    for (; lines >> label; ++count) {
        ASSERT_LT(count, read.extras.face_labels.size());
        ASSERT_EQ(label, read.extras.face_labels[count]);
    }
    EXPECT_EQ(count, read.mesh.number_of_faces());
}

TEST(MakeCommand, SameBytesForAnyNumberOfThreads) {
    Scratch scratch;
    const Path first_file = scratch / "one.ply", second_file = scratch / "two.ply";
    ASSERT_EQ(run_command("mesh make torus " + first_file.string() + " --vertices 2000 --threads 1").code, 0);
    ASSERT_EQ(run_command("mesh make torus " + second_file.string() + " --vertices 2000 --threads 2").code, 0);
    EXPECT_EQ(read_file(first_file), read_file(second_file));
}

TEST(MakeCommand, ListsObjectsPartsAndLabels) {
    const auto result = run_command("mesh make --list --json");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    bool teapot = false;
    for (const auto& object : report["result"]["objects"].GetArray()) {
        teapot = teapot || std::string(object["name"].GetString()) == "teapot";
        EXPECT_GT(object["parts"].Size(), 1U);
    }
    EXPECT_TRUE(teapot);
    EXPECT_NE(run_command("mesh make --list").out.find("flower 5"), std::string::npos);
}

TEST(MakeCommand, RefusesWithoutWritingFiles) {
    Scratch scratch;
    const Path mesh = scratch / "m.ply";
    const auto refused = [&](const std::string& words, int code, const std::string& message) {
        const auto result = run_command("mesh make " + words);
        EXPECT_EQ(result.code, code) << words << result.err;
        EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_FALSE(std::filesystem::exists(mesh));
    };
    refused("tepot " + mesh.string(), 2, "did you mean 'teapot'");
    refused("teapot " + mesh.string() + " --thraeds 2", 2, "did you mean 'threads'");
    refused("teapot " + mesh.string() + " --vertices 100", 2, "at least");
    refused("teapot " + mesh.string() + " --vertices -5", 2, "vertices");
    refused("sphere " + mesh.string() + " --noise 3", 2, "noise");
    refused("sphere " + (scratch / "m.xyz").string(), 2, ".xyz");
    refused("sphere " + (scratch / "nowhere" / "m.ply").string(), 1, "nowhere");
    refused("sphere " + mesh.string() + " --vertices 1000 --labels " + (scratch / "nowhere" / "l.txt").string(), 1, "nowhere");
    refused("sphere " + mesh.string() + " --labels " + mesh.string(), 2, "m.ply");
    refused("sphere", 2, "output");
    refused("", 2, "object");
}

}  // namespace
}  // namespace ostraka
