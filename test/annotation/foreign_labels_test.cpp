// Labels as other programs write them: whole numbers in real fields, groups, materials, colours, arrays.
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/files/npy.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/io/obj_parts.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <fmt/core.h>

namespace ostraka {
namespace {

using test::run_command;

/// A strip of four quads, each two triangles.
constexpr int quads = 4;
std::string ply(const std::string& vertex_property, const std::string& face_property,
                const std::vector<std::string>& vertex_words, const std::vector<std::string>& face_words) {
    std::string text = fmt::format(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n{}"
        "element face {}\nproperty list uchar int vertex_indices\n{}end_header\n",
        2 * (quads + 1), vertex_property, 2 * quads, face_property);
    for (int i = 0; i <= quads; ++i)
        for (int k = 0; k < 2; ++k)
            text += fmt::format("{} {} 0 {}\n", i, k, vertex_words.empty() ? "" : vertex_words[static_cast<std::size_t>(i)]);
    for (int i = 0; i < quads; ++i)
        for (int k = 0; k < 2; ++k) {
            const int a = 2 * i, b = 2 * i + 2;
            text += k == 0 ? fmt::format("3 {} {} {} ", a, b, b + 1) : fmt::format("3 {} {} {} ", a, b + 1, a + 1);
            text += (face_words.empty() ? "" : face_words[static_cast<std::size_t>(2 * i + k)]) + "\n";
        }
    return text;
}

class ForeignLabels : public testing::Test {
protected:
    AnnotationSet apply(const std::string& mesh, const std::string& arguments, int code = 0) const {
        const Path out = scratch / "out.ant.json";
        const auto result = run_command("annotation apply " + arguments + " " + mesh + " " + out.string());
        EXPECT_EQ(result.code, code) << arguments << ": " << result.err;
        if (code != 0 || result.code != 0) return {};
        return read_annotations(out, read_mesh(mesh).mesh);
    }
    static std::map<std::string, std::size_t> sizes(const AnnotationSet& set) {
        std::map<std::string, std::size_t> result;
        for (const Annotation& annotation : set.annotations) result[annotation.tag] = annotation.faces.size();
        return result;
    }
    using Sizes = std::map<std::string, std::size_t>;
    test::Scratch scratch;
};

TEST_F(ForeignLabels, WholeNumbersInRealFields) {
    const std::vector<std::string> words{"1.0", "1.0", "1.0", "1.0", "7", "7", "nan", "nan"};
    const std::string faces = scratch.file("f.ply", ply("", "property float part_label\n", {}, words)).string();
    EXPECT_EQ(sizes(apply(faces, "--from-ply-labels")), (Sizes{{"part 1", 4}, {"part 7", 2}}));
    EXPECT_EQ(sizes(apply(faces, "--from values:part_label")), (Sizes{{"part 1", 4}, {"part 7", 2}}));
    // CloudCompare's scalar field of vertices.
    const std::string cloud =
        scratch.file("c.ply", ply("property float scalar_Classification\n", "", {"2", "2", "2", "5", "5"}, {})).string();
    EXPECT_EQ(sizes(apply(cloud, "--from-ply-labels")).size(), 2U);
    EXPECT_EQ(sizes(apply(cloud, "--from values:Classification")), sizes(apply(cloud, "--from values:scalar_Classification")));
    const std::string height =
        scratch.file("h.ply", ply("property float scalar_Height\n", "", {"0.1", "0.2", "0.3", "0.4", "0.5"}, {})).string();
    apply(height, "--from values:Height", 1);
    apply(height, "--from-ply-labels", 1);
    apply(height, "--from values:Depth", 1);
    apply(height, "--from nonsense", 2);
}

TEST_F(ForeignLabels, ColoursOfFaces) {
    const std::string colours = "property uchar red\nproperty uchar green\nproperty uchar blue\n", r = "255 0 0", b = "0 0 255";
    const std::string mesh = scratch.file("k.ply", ply("", colours, {}, {r, r, r, b, b, b, b, b})).string();
    EXPECT_EQ(sizes(apply(mesh, "--from colour")), (Sizes{{"#0000ff", 5}, {"#ff0000", 3}}));
    apply(mesh, "--from material", 1);
}

TEST_F(ForeignLabels, GroupsObjectsAndMaterialsOfObj) {
    const Path mesh = scratch.file("m.obj",
                                   "mtllib missing.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n"
                                   "o pot\ng body outer\nusemtl red clay\nf 1 2 3 4\n"
                                   "g \\\nrim\nf 2 5 3\nusemtl slip\nf 5 6 3\n");
    const ObjParts groups = read_obj_parts(mesh, ObjStatement::group);
    EXPECT_EQ(groups.of_polygon, (std::vector<std::int32_t>{0, 1, 1}));
    EXPECT_EQ(sizes(apply(mesh.string(), "--from group")).at("body outer"), 2U) << "a quad is two triangles";
    EXPECT_EQ(sizes(apply(mesh.string(), "--from material")), (Sizes{{"red clay", 3}, {"slip", 1}}));
    EXPECT_EQ(sizes(apply(mesh.string(), "--from object")), (Sizes{{"pot", 4}}));
    const Path plain = scratch.file("p.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
    apply(plain.string(), "--from group", 1);
}

TEST_F(ForeignLabels, ArraysOfFacesAndVertices) {
    const std::string mesh = scratch.file("n.ply", ply("", "", {}, {})).string();
    const auto array = [&](const std::string& name, const std::vector<double>& values) {
        write_npy(scratch / name, std::span<const double>(values), {values.size()});
        return (scratch / name).string();
    };
    const std::vector<std::int64_t> whole{0, 0, 0, 1, 1, 1, 2, 2};
    write_npy(scratch / "i.npy", std::span<const std::int64_t>(whole), {whole.size()});
    const auto with = [&](const std::string& labels, int code) {
        const Path out = scratch / "out.ant.json";
        const auto result = run_command("annotation apply " + mesh + " " + labels + " " + out.string());
        EXPECT_EQ(result.code, code) << labels << ": " << result.err;
        return code == 0 ? sizes(read_annotations(out, read_mesh(mesh).mesh)) : Sizes();
    };
    EXPECT_EQ(with((scratch / "i.npy").string(), 0), (Sizes{{"part 0", 3}, {"part 1", 3}, {"part 2", 2}}));
    EXPECT_EQ(with(array("real.npy", {3, 3, 3, 3, 4, 4, 4, 4}), 0), (Sizes{{"part 3", 4}, {"part 4", 4}}));
    EXPECT_EQ(with(array("vertex.npy", {3, 3, 3, 3, 3, 3, 4, 4, 4, 4}), 0).size(), 2U);
    with(array("half.npy", {0.5, 0, 0, 0, 0, 0, 0, 0}), 1);
    with(array("short.npy", {0, 1, 2}), 1);
}

TEST_F(ForeignLabels, ImportReadsLabelledCopies) {
    const std::string mesh = scratch.file("o.ply", ply("", "", {}, {})).string();
    const std::string copy =
        scratch.file("copy.ply", ply("property float scalar_Label\n", "", {"2", "2", "2", "5", "5"}, {})).string();
    const Path out = scratch / "in.ant.json";
    const auto result = run_command("annotation import " + mesh + " " + copy + " " + out.string());
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(sizes(read_annotations(out, read_mesh(mesh).mesh)).size(), 2U);
    const std::string other = OSTRAKA_SOURCE_DIR "/data/conformance/inputs/box.ply";
    EXPECT_EQ(run_command("annotation import " + other + " " + copy + " " + out.string()).code, 1);
}

}  // namespace
}  // namespace ostraka
