// Colours and textures of objects on pages.
#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/io/glb.h"
#include "ostraka/page/page.h"
#include "page/appearance.h"
#include "page/geometry.h"

#include <meshoptimizer.h>

#include <gtest/gtest.h>

#include <set>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// Pixels that no format compresses well.
SharedImage noise(int side, ImageFormat format = ImageFormat::png) {
    Pixels pixels{side, side, {}};
    std::uint32_t state = 12345;
    for (int i = 0; i < side * side; ++i) {
        state = state * 1664525U + 1013904223U;
        pixels.rgba.push_back({static_cast<std::uint8_t>(state >> 24U), static_cast<std::uint8_t>(state >> 16U),
                               static_cast<std::uint8_t>(state >> 8U), 255});
    }
    return std::make_shared<const Image>(encode(pixels, format, "noise"));
}

/// A sphere whose corners have texture coordinates that differ from face to face, and two materials.
struct Textured {
    TriangleSoup soup = octahedron_sphere(3);
    Mesh mesh = build_mesh(soup);
    MeshExtras extras;

    explicit Textured(const SharedImage& image) {
        for (std::size_t face = 0; face < soup.triangles.size(); ++face) {
            const bool upper = soup.points[soup.triangles[face][0]][2] > 0;
            for (const Index v : soup.triangles[face])
                extras.corner_texture.push_back({static_cast<float>(0.5 + 0.25 * soup.points[v][0] + (upper ? 0.2 : -0.2)),
                                                 static_cast<float>(0.5 + 0.25 * soup.points[v][1])});
            extras.face_materials.push_back(upper ? 1 : face % 7 == 0 ? no_index : 0);
        }
        extras.appearance.images = {nullptr, image};
        extras.appearance.materials.resize(2);
        extras.appearance.materials[0].base_colour = {0.5, 0.25, 0.125, 1};
        extras.appearance.materials[1].image = 1;
        extras.appearance.materials[1].wrap_v = TextureWrap::mirror;
        extras.appearance.materials[1].alpha = Material::Alpha::mask;
        extras.appearance.materials[1].gltf_rest = R"({"extensions":{"KHR_materials_unlit":{}}})";
    }
    [[nodiscard]] PageObject object() const {
        PageObject page_object;
        page_object.name = "sphere";
        page_object.mesh = &mesh;
        page_object.extras = &extras;
        return page_object;
    }
};

/// The data of a page and its bytes.
struct PageContent {
    Json data;
    std::string bytes;
    explicit PageContent(const Page& page) {
        Page::Content content = page.content("made by a test");
        data = parse_json(content.data, "data");
        bytes = std::move(content.bytes);
    }
    [[nodiscard]] std::string blob(const JsonValue& index) const {
        const JsonValue& place = data["blobs"][index.GetUint()];
        return bytes.substr(place[0].GetUint64(), place[1].GetUint64());
    }
};

template <class Value>
std::vector<Value> values_of(const std::string& bytes) {
    std::vector<Value> values(bytes.size() / sizeof(Value));
    std::copy_n(bytes.data(), values.size() * sizeof(Value), reinterpret_cast<char*>(values.data()));
    return values;
}

/// The faces of a material, from gaps and runs.
std::set<Index> faces_of_runs(const std::string& bytes) {
    std::set<Index> faces;
    std::size_t place = 0;
    const auto next = [&] {
        std::size_t value = 0, factor = 1;
        for (;; factor *= 128) {
            const auto byte = static_cast<std::uint8_t>(bytes[place++]);
            value += (byte & 127U) * factor;
            if (byte < 128) return value;
        }
    };
    for (std::size_t face = 0; place < bytes.size();) {
        face += next();
        for (std::size_t run = next(); run > 0; --run) faces.insert(static_cast<Index>(face++));
    }
    return faces;
}

/// A decoded stream of the GLB of a page.
struct GlbStreams {
    explicit GlbStreams(const std::string& glb)
        : glb_(glb),
          json_size_(*reinterpret_cast<const std::uint32_t*>(glb.data() + 12)),
          document(parse_json(glb.substr(20, json_size_), "glb")) {}

    [[nodiscard]] const JsonValue& packed(const JsonValue& accessor) const {
        const auto view = document["accessors"][accessor.GetUint()]["bufferView"].GetUint();
        return document["bufferViews"][view]["extensions"]["EXT_meshopt_compression"];
    }
    [[nodiscard]] std::string bytes(const JsonValue& view) const {
        return glb_.substr(20 + json_size_ + 8 + view["byteOffset"].GetUint64(), view["byteLength"].GetUint64());
    }
    template <class Element>
    std::vector<Element> attribute(const char* name) const {
        const JsonValue& view = packed(document["meshes"][0]["primitives"][0]["attributes"][name]);
        std::vector<Element> elements(view["count"].GetUint64());
        const std::string encoded = bytes(view);
        EXPECT_EQ(meshopt_decodeVertexBuffer(elements.data(), elements.size(), sizeof(Element),
                                             reinterpret_cast<const unsigned char*>(encoded.data()), encoded.size()),
                  0);
        return elements;
    }
    [[nodiscard]] std::vector<std::uint32_t> indices() const {
        const JsonValue& view = packed(document["meshes"][0]["primitives"][0]["indices"]);
        std::vector<std::uint32_t> list(view["count"].GetUint64());
        const std::string encoded = bytes(view);
        EXPECT_EQ(meshopt_decodeIndexBuffer(list.data(), list.size(), 4, reinterpret_cast<const unsigned char*>(encoded.data()),
                                            encoded.size()),
                  0);
        return list;
    }

private:
    std::string glb_;
    std::size_t json_size_;

public:
    Json document;
};

}  // namespace

TEST(PageLook, CornersHaveTheirTextureCoordinatesInThePackedGeometry) {
    const Textured textured(noise(16));
    Page page("a sphere");
    page.add(textured.object());
    const PageContent content(page);
    const JsonValue& object = content.data["objects"][0];
    const GlbStreams glb(content.blob(object["geometry"]));
    const auto vertices = glb.attribute<std::uint32_t>("_VERTEX");
    const auto places = glb.attribute<std::array<std::uint16_t, 2>>("TEXCOORD_0");
    const auto indices = glb.indices();
    ASSERT_EQ(indices.size(), 3 * textured.soup.triangles.size());
    ASSERT_EQ(vertices.size(), places.size());
    EXPECT_LT(vertices.size(), textured.soup.points.size() + 100);  // only the vertices of the seam are doubled
    for (std::size_t face = 0; face < textured.soup.triangles.size(); ++face) {
        const auto& triangle = textured.soup.triangles[face];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t pair = indices[3 * face + k];
            // The codec may rotate the corners.
            const auto corner = std::find(triangle.begin(), triangle.end(), vertices[pair]) - triangle.begin();
            ASSERT_LT(corner, 3);
            const TexturePoint& expected = textured.extras.corner_texture[3 * face + static_cast<std::size_t>(corner)];
            for (std::size_t side = 0; side < 2; ++side) EXPECT_NEAR(places[pair][side] / 65535.0, expected[side], 1e-5);
        }
    }
}

TEST(PageLook, MaterialsKeepTheirFacesImagesAndSampling) {
    const auto image = noise(16);
    const Textured textured(image);
    Page page("a sphere");
    page.add(textured.object());
    const PageContent content(page);
    const JsonValue& texture = content.data["objects"][0]["texture"];
    ASSERT_EQ(texture["materials"].Size(), 2U);
    const JsonValue &plain = texture["materials"][0], &pictured = texture["materials"][1];
    EXPECT_EQ(plain["colour"][1].GetDouble(), 0.25);
    EXPECT_FALSE(plain.HasMember("image"));
    EXPECT_EQ(pictured["image"].GetUint(), 0U);
    EXPECT_STREQ(pictured["wrap"][0].GetString(), "repeat");
    EXPECT_STREQ(pictured["wrap"][1].GetString(), "mirror");
    EXPECT_EQ(pictured["cutoff"].GetDouble(), 0.5);
    EXPECT_TRUE(pictured["unlit"].GetBool());
    std::array<std::set<Index>, 2> expected;
    for (Index face = 0; face < textured.soup.triangles.size(); ++face)
        if (textured.extras.face_materials[face] != no_index) expected[textured.extras.face_materials[face]].insert(face);
    EXPECT_EQ(faces_of_runs(content.blob(plain["faces"])), expected[0]);
    EXPECT_EQ(faces_of_runs(content.blob(pictured["faces"])), expected[1]);
    ASSERT_EQ(texture["images"].Size(), 1U);
    EXPECT_EQ(content.blob(texture["images"][0]["blob"]), image->bytes);  // small enough: unchanged
    EXPECT_STREQ(texture["images"][0]["type"].GetString(), "image/png");
    EXPECT_EQ(content.data["notes"].Size(), 0U);
}

TEST(PageLook, ImagesAreReducedToTheBudgetAndANoteSaysSo) {
    const Textured textured(noise(1200));
    ASSERT_GT(textured.extras.appearance.images[1]->bytes.size(), 2 * page_image_bytes);
    Page page("a sphere");
    page.add(textured.object());
    const PageContent content(page);
    const JsonValue& image = content.data["objects"][0]["texture"]["images"][0];
    EXPECT_LE(content.blob(image["blob"]).size(), page_image_bytes);
    const Image shown = parse_image(content.blob(image["blob"]), "shown", "page");
    EXPECT_EQ(shown.width, image["width"].GetInt());
    EXPECT_STREQ(media_type(shown.format).c_str(), image["type"].GetString());
    ASSERT_EQ(content.data["notes"].Size(), 1U);
    EXPECT_NE(std::string(content.data["notes"][0].GetString()).find("noise"), std::string::npos);
}

TEST(PageLook, ExactShapesAreSentOnceWithTheirTexture) {
    const Textured textured(noise(16));
    PageObject object = textured.object();
    object.exact = {"key", true};
    Page page("a sphere");
    page.add(object);
    object.exact = {"key", false};
    page.add(object);
    const PageContent content(page);
    const JsonValue &first = content.data["objects"][0]["shape"], &second = content.data["objects"][1]["shape"];
    const auto vertices = values_of<std::uint32_t>(content.blob(first["texture"]["vertices"]));
    const auto places = values_of<TexturePoint>(content.blob(first["texture"]["places"]));
    const auto corners = values_of<std::uint32_t>(content.blob(first["texture"]["corners"]));
    ASSERT_EQ(corners.size(), 3 * textured.soup.triangles.size());
    for (std::size_t corner = 0; corner < corners.size(); ++corner) {
        EXPECT_EQ(vertices[corners[corner]], textured.soup.triangles[corner / 3][corner % 3]);
        EXPECT_EQ(places[corners[corner]], textured.extras.corner_texture[corner]);
    }
    EXPECT_FALSE(second.HasMember("texture"));
    EXPECT_FALSE(content.data["objects"][0].HasMember("texture"));
}

TEST(PageLook, OwnColoursOfVerticesAndFacesAreKept) {
    Textured textured(nullptr);
    textured.extras = {};
    for (std::size_t v = 0; v < textured.soup.points.size(); ++v)
        textured.extras.vertex_colours.push_back(
            {static_cast<std::uint8_t>(v), 2, static_cast<std::uint8_t>(255 - v % 256), 255});
    PageObject object = textured.object();
    object.colouring = "clay";
    Page page("a sphere");
    page.add(object);
    textured.extras.face_colours.assign(textured.soup.triangles.size(), Colour{9, 8, 7, 255});
    page.add(object);
    const PageContent content(page);
    const std::string vertices = content.blob(content.data["objects"][0]["colours"]["vertices"]);
    ASSERT_EQ(vertices.size(), 3 * textured.soup.points.size());
    for (std::size_t v = 0; v < textured.soup.points.size(); ++v)
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_EQ(static_cast<std::uint8_t>(vertices[3 * v + k]), textured.extras.vertex_colours[v][k]);
    EXPECT_STREQ(content.data["objects"][0]["colouring"].GetString(), "clay");
    EXPECT_FALSE(content.data["objects"][0].HasMember("texture"));
    EXPECT_EQ(content.blob(content.data["objects"][1]["colours"]["faces"]).substr(0, 3), "\x09\x08\x07");
}

TEST(PageLook, ListsThatDoNotFitAreRefused) {
    for (int which = 0; which < 5; ++which) {
        Textured textured(noise(4));
        MeshExtras& extras = textured.extras;
        if (which == 0) extras.corner_texture.pop_back();
        if (which == 1) extras.face_materials.pop_back();
        if (which == 2) extras.face_materials[3] = 2;
        if (which == 3) extras.vertex_colours.resize(1);
        if (which == 4) extras.face_colours.resize(1);
        Page page("a sphere");
        EXPECT_THROW(page.add(textured.object()), Error) << which;
    }
    Textured damaged(noise(4));
    Image cut = *damaged.extras.appearance.images[1];
    cut.bytes.resize(cut.bytes.size() / 2);
    cut.width = cut.height = 20000;  // what its header claims is above the limit of a page
    damaged.extras.appearance.images[1] = std::make_shared<const Image>(cut);
    Page page("a sphere");
    EXPECT_THROW(page.add(damaged.object()), Error);
}
