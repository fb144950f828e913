// mesh bake and the texture of mesh remesh, with objects in memory.
#include "ostraka/core/error.h"
#include "ostraka/operations/table.h"
#include "texture/textured.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// Runs an operation on meshes in memory and returns its output.
MeshFile output_of(const std::string& operation, const std::vector<std::pair<std::string, MeshFile>>& inputs,
                   const std::vector<std::pair<std::string, std::string>>& options, Json* result = nullptr) {
    Context context;
    Call call(find_operation(operation));
    for (const auto& [name, mesh] : inputs) {
        MeshFile copy = mesh;
        call.set_object(name, Object::of(std::move(copy), name + ".ply"));
    }
    for (const auto& [name, value] : options) call.parameters().options.find(name)->set({value});
    const Report report = call.run(context);
    if (result != nullptr) *result = report.to_json();
    return *call.object("output").as<MeshFile>();
}

MeshFile plain(const TriangleSoup& soup) {
    MeshFile file;
    file.mesh = build_mesh(soup);
    return file;
}

}  // namespace

TEST(BakeCommand, AnImageForAnotherMesh) {
    Json report;
    const MeshFile result = output_of("mesh bake", {{"target", plain(box(5))}, {"source", textured_box(6, 64, waves)}}, {}, &report);
    EXPECT_LT(mean_error(result.mesh, result.extras, waves), 3);
    const auto& values = report["result"];
    EXPECT_NEAR(values["texel"].GetDouble(), 1.0 / 64, 1e-3);
    EXPECT_EQ(values["charts"].GetInt(), 6);
    EXPECT_EQ(values["without_source"].GetInt(), 0);
    EXPECT_EQ(values["image_width"].GetInt(), result.extras.appearance.images[0]->width);
}

TEST(BakeCommand, ColoursOfVerticesAndOwnTextureCoordinates) {
    const MeshFile source = textured_box(6, 64, waves);
    const MeshFile coloured = output_of("mesh bake", {{"target", plain(box(8))}, {"source", source}}, {{"to", "vertices"}});
    EXPECT_EQ(coloured.extras.vertex_colours.size(), coloured.mesh.number_of_vertices());
    EXPECT_TRUE(coloured.extras.corner_texture.empty());
    const MeshFile target = textured_box(4, 48, waves);
    const MeshFile kept = output_of("mesh bake", {{"target", target}, {"source", source}}, {{"layout", "own"}});
    EXPECT_EQ(kept.extras.corner_texture, target.extras.corner_texture);
    EXPECT_LT(mean_error(kept.mesh, kept.extras, waves), 3);
}

TEST(BakeCommand, RemeshKeepsTheTexture) {
    const MeshFile source = textured_box(6, 64, waves);
    const std::vector<std::pair<std::string, std::string>> options{{"vertices", "500"}, {"feature-angle", "45"}};
    const MeshFile result = output_of("mesh remesh", {{"input", source}}, options);
    EXPECT_EQ(result.mesh.number_of_vertices(), 500U);
    EXPECT_LT(mean_error(result.mesh, result.extras, waves), 3);
    auto without = options;
    without.emplace_back("texture", "none");
    EXPECT_TRUE(output_of("mesh remesh", {{"input", source}}, without).extras.appearance.empty());
    auto vertices = options;
    vertices.emplace_back("texture", "vertices");
    EXPECT_EQ(output_of("mesh remesh", {{"input", source}}, vertices).extras.vertex_colours.size(), 500U);
    EXPECT_TRUE(output_of("mesh remesh", {{"input", plain(box(6))}}, options).extras.appearance.empty());
}

TEST(BakeCommand, RefusesWhatMakesNoSense) {
    const MeshFile source = textured_box(3, 16, waves), target = plain(box(2));
    EXPECT_THROW(output_of("mesh bake", {{"target", source}, {"source", target}}, {}), Error);  // no colours to bake
    EXPECT_THROW(output_of("mesh bake", {{"target", target}, {"source", source}}, {{"layout", "own"}}), Error);
    EXPECT_THROW(output_of("mesh bake", {{"target", target}, {"source", source}}, {{"layout", "own"}, {"texel", "1"}}), Error);
    EXPECT_THROW(output_of("mesh bake", {{"target", target}, {"source", source}}, {{"to", "vertices"}, {"layout", "own"}}), Error);
    EXPECT_NO_THROW(output_of("mesh bake", {{"target", source}, {"source", target}}, {{"of", "relief"}}));
}
