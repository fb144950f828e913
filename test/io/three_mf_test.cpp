// 3MF files: objects, components, colours, images; damaged and hostile archives.
#include "three_mf_examples.h"

#include "io_examples.h"
#include "ostraka/core/error.h"
#include "scratch.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

PolygonSoup read(const std::string& bytes) {
    const Scratch scratch;
    return read_polygons(scratch.file("a.3mf", bytes));
}

PolygonSoup read_model_text(const std::string& model) { return read(zip_of({{"3D/3dmodel.model", model}})); }

std::string refusal(const std::string& bytes) {
    try {
        read(bytes);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

bool has_note(const PolygonSoup& soup, const std::string& part) {
    return std::any_of(soup.notes.begin(), soup.notes.end(),
                       [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

const std::string tetrahedron_object =
    "<object id=\"1\">" + tetrahedron_mesh + "<triangles><triangle v1=\"0\" v2=\"2\" v3=\"1\"/></triangles></mesh></object>";

}  // namespace

TEST(ThreeMf, ColoursOfTriangles) {
    const auto soup = read_model_text(coloured_model);
    EXPECT_EQ(soup.points.size(), 4U);
    EXPECT_EQ(soup.polygon_count(), 4U);
    EXPECT_EQ(soup.extras.face_colours,
              (std::vector<Colour>{{128, 64, 32, 255}, {255, 0, 0, 128}, {0, 255, 0, 255}, {0, 255, 0, 255}}));
    EXPECT_TRUE(has_note(soup, "1 triangles have different colours at their corners"));
    EXPECT_TRUE(has_note(soup, "the unit of length is centimeter"));
}

TEST(ThreeMf, ComponentsArePlacedAndMirroredOnesKeepTheirOrientation) {
    // Object 2 has object 1 twice: moved by (10, 0, 0), and mirrored in x.
    const auto soup =
        read_model_text(model_start + tetrahedron_object +
                        "<object id=\"2\"><components>"
                        "<component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 10 0 0\"/>"
                        "<component objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\"/></components></object>"
                        "</resources><build><item objectid=\"2\" transform=\"2 0 0 0 2 0 0 0 2 0 0 5\"/></build></model>");
    ASSERT_EQ(soup.points.size(), 8U);
    EXPECT_EQ(soup.points[1], (std::array<double, 3>{22, 0, 5}));
    EXPECT_EQ(soup.points[5], (std::array<double, 3>{-2, 0, 5}));
    EXPECT_EQ(soup.corners, (std::vector<Index>{0, 2, 1, 4, 5, 6}));
}

TEST(ThreeMf, OtherPartsAndModelsWithoutBuild) {
    const auto soup = read(
        zip_of({{"_rels/.rels",
                 "<Relationships><Relationship Target=\"/3D/main.model\" Id=\"r\" Type=\"http://x/3dmodel\"/></Relationships>"},
                {"3D/main.model",
                 model_start + "</resources><build><item objectid=\"1\" p:path=\"/3D/Objects/a.model\"/></build></model>"},
                {"3D/Objects/a.model", model_start + tetrahedron_object + "</resources><build/></model>"}}));
    EXPECT_EQ(soup.polygon_count(), 1U);
    const auto unbuilt = read_model_text(model_start + tetrahedron_object + "</resources></model>");
    EXPECT_EQ(unbuilt.polygon_count(), 1U);
    EXPECT_TRUE(has_note(unbuilt, "builds nothing"));
}

TEST(ThreeMf, ImagesBecomeMaterials) {
    const std::string png = one_pixel_png(200);
    const std::string model =
        model_start +
        "<m:texture2d id=\"5\" path=\"/3D/Textures/skin.png\" contenttype=\"image/png\" tilestyleu=\"mirror\"/>"
        "<m:texture2dgroup id=\"6\" texid=\"5\"><m:tex2coord u=\"0\" v=\"0\"/><m:tex2coord u=\"1\" v=\"0\"/><m:tex2coord u=\"0\" "
        "v=\"0.5\"/></m:texture2dgroup><object id=\"1\">" +
        tetrahedron_mesh +
        "<triangles><triangle v1=\"0\" v2=\"2\" v3=\"1\" pid=\"6\" p1=\"0\" p2=\"2\" p3=\"1\"/><triangle v1=\"0\" v2=\"1\" "
        "v3=\"3\"/></triangles></mesh></object></resources><build><item objectid=\"1\"/></build></model>";
    const auto soup = read(zip_of({{"3D/3dmodel.model", model}, {"3D/Textures/skin.png", png}}));
    ASSERT_EQ(soup.extras.appearance.images.size(), 1U);
    EXPECT_EQ(soup.extras.appearance.images[0]->bytes, png);
    EXPECT_EQ(soup.extras.appearance.materials[0].wrap_u, TextureWrap::mirror);
    EXPECT_EQ(soup.extras.face_materials, (std::vector<Index>{0, no_index}));
    EXPECT_EQ(soup.extras.corner_texture[1], (TexturePoint{0, 0.5F}));
    EXPECT_EQ(soup.extras.corner_texture.size(), 6U);
    EXPECT_TRUE(has_note(read_model_text(model), "an image is not kept")) << "the image is not in the archive";
}

TEST(ThreeMf, DamagedFilesAreRefusedWithPartAndLine) {
    const std::string tail = "</resources><build><item objectid=\"1\"/></build></model>";
    const auto model_refusal = [](const std::string& model) { return refusal(zip_of({{"3D/3dmodel.model", model}})); };
    const auto contains = [](const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; };
    EXPECT_TRUE(contains(model_refusal(model_start), "3D/3dmodel.model, line 3"));
    EXPECT_TRUE(contains(model_refusal(model_start + "<object id=\"x\"/>" + tail), "id of a object is not a whole number"));
    EXPECT_TRUE(contains(model_refusal(model_start + tail), "names object 1"));
    EXPECT_TRUE(contains(model_refusal(model_start + tetrahedron_object + tetrahedron_object + tail), "defined twice"));
    EXPECT_TRUE(
        contains(model_refusal(model_start + "<object id=\"1\"><mesh><vertices><vertex x=\"nan\" y=\"0\" z=\"0\"/>" + tail),
                 "not a finite number"));
    EXPECT_TRUE(contains(
        model_refusal(model_start +
                      "<object id=\"1\"><mesh><triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh></object>" +
                      tail),
        "names vertex 0 of 0"));
    EXPECT_TRUE(contains(model_refusal("<!DOCTYPE x [<!ENTITY a \"b\">]>" + model_start + tail), "document type"));
    EXPECT_TRUE(contains(refusal("PK\3\4 and no more"), "not a zip archive"));
    EXPECT_TRUE(contains(refusal(zip_of({{"other", "x"}})), "has no part 3D/3dmodel.model"));
}

TEST(ThreeMf, CutFilesAreRefused) {
    const std::string bytes = zip_of({{"3D/3dmodel.model", coloured_model}});
    const Scratch scratch;
    for (std::size_t size = 1; size + 3 < bytes.size(); ++size) {  // the length of the comment at the end may be missing
        std::FILE* stream = std::fopen((scratch / "a.3mf").c_str(), "wb");
        std::fwrite(bytes.data(), 1, size, stream);
        std::fclose(stream);
        EXPECT_THROW(read_polygons(scratch / "a.3mf"), Error) << size;
    }
}

TEST(ThreeMf, BombsAreRefused) {
    // 80 MB of blanks in 80 KB; a part that claims 4 GB; a part that claims less than it has.
    const std::string blanks = model_start + std::string(80'000'000, ' ');
    EXPECT_NE(refusal(zip_of({{"3D/3dmodel.model", blanks}})).find("exhaust memory"), std::string::npos);
    EXPECT_NE(refusal(zip_of({{"3D/3dmodel.model", coloured_model}}, 4'000'000'000U)).find("exhaust memory"), std::string::npos);
    EXPECT_FALSE(refusal(zip_of({{"3D/3dmodel.model", coloured_model}}, 100)).empty());
    // Each object has the one before ten times.
    std::string model = model_start + tetrahedron_object;
    for (int object = 2; object < 30; ++object) {
        model += fmt::format("<object id=\"{}\"><components>", object);
        for (int k = 0; k < 10; ++k) model += fmt::format("<component objectid=\"{}\"/>", object - 1);
        model += "</components></object>";
    }
    const auto built = [&](int object) {
        return zip_of(
            {{"3D/3dmodel.model", model + fmt::format("</resources><build><item objectid=\"{}\"/></build></model>", object)}});
    };
    EXPECT_NE(refusal(built(29)).find("repeats its objects"), std::string::npos);
    EXPECT_EQ(read(built(4)).polygon_count(), 1000U);
    const std::string cycle = model_start +
                              "<object id=\"1\"><components><component objectid=\"2\"/></components></object>"
                              "<object id=\"2\"><components><component objectid=\"1\"/></components></object></resources>"
                              "<build><item objectid=\"1\"/></build></model>";
    EXPECT_NE(refusal(zip_of({{"3D/3dmodel.model", cycle}})).find("contain each other"), std::string::npos);
}

TEST(ThreeMf, FilesOfOtherPrograms) {
    const Path folder = Path(OSTRAKA_SHARED_DATA) / "textured" / "odd-3mf-colour";
    if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "no " << folder;
    for (const char* name : {"box.3mf", "box_prod.3mf"}) {
        const auto box = read_polygons(folder / name);
        EXPECT_EQ(box.points.size(), 8U);
        EXPECT_EQ(box.polygon_count(), 12U);
    }
    const auto chain = read_polygons(folder / "dodeca_chain_loop_color.3mf");
    EXPECT_EQ(chain.points.size(), 3040U);
    EXPECT_EQ(chain.polygon_count(), 7680U);
    EXPECT_EQ(chain.extras.face_colours.size(), 7680U);
}
