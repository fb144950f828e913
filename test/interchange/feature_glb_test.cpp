// GLB with features: round trip, other meshes, the rules of the extensions, the public validator, damage.
#include "ostraka/interchange/feature_glb.h"
#include "mutate.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/annotation/fair_outlines.h"
#include "ostraka/core/error.h"
#include "ostraka/io/glb.h"
#include "scratch.h"
#include "sets.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cstring>
#include <map>

using namespace ostraka;
using namespace ostraka::example;

namespace {

std::string written(AnnotatedMeshView object) {
    std::vector<std::string> notes;
    return feature_glb(object, "m <1>.ply", {}, notes);
}

std::uint32_t word_at(const std::string& bytes, std::size_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + offset, 4);
    return value;
}

Json json_of(const std::string& glb) { return parse_json(glb.substr(20, word_at(glb, 12)), "glb"); }

std::string message(const std::string& bytes, const Mesh& mesh) {
    try {
        read_feature_glb(bytes, mesh, "file");
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

/// The file with another JSON chunk.
std::string with_json(const std::string& glb, std::string json) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::size_t rest = 20 + word_at(glb, 12);
    std::string head = glb.substr(0, 20);
    const auto size = static_cast<std::uint32_t>(json.size()), total = static_cast<std::uint32_t>(20 + size + glb.size() - rest);
    std::memcpy(head.data() + 8, &total, 4);
    std::memcpy(head.data() + 12, &size, 4);
    return head + json + glb.substr(rest);
}

std::string with(const std::string& glb, const std::string& from, const std::string& to) {
    std::string json = glb.substr(20, word_at(glb, 12));
    const std::size_t position = json.find(from);
    EXPECT_NE(position, std::string::npos) << from;
    if (position != std::string::npos) json.replace(position, from.size(), to);
    return with_json(glb, json);
}

}  // namespace

TEST(FeatureGlb, RoundTripKeepsEverything) {
    const Mesh mesh = spheres(3);
    const AnnotationSet set = wild_set(mesh);
    const std::string glb = written({mesh, set});
    const PlacedAnnotations read = read_feature_glb(glb, mesh, "file");
    EXPECT_EQ(as_file(read.set, mesh), as_file(set, mesh));
    for (const PlacedAnnotation& placement : read.placements) EXPECT_EQ(placement.how, "indices");
    EXPECT_EQ(written({mesh, set}), glb);
    EXPECT_EQ(as_file(read_feature_glb(written({mesh, {}}), mesh, "f").set, mesh), as_file({}, mesh));
}

TEST(FeatureGlb, ConformsToTheFormat) {
    const Mesh mesh = spheres(3);
    const AnnotationSet set = wild_set(mesh);
    const std::string glb = written({mesh, set});
    EXPECT_EQ(glb.substr(0, 4), "glTF");
    EXPECT_EQ(word_at(glb, 8), glb.size());
    const std::size_t json_size = word_at(glb, 12), binary = 20 + json_size + 8;
    EXPECT_EQ(binary % 8, 0U) << "eight-byte values in the binary chunk are aligned in the file";
    EXPECT_EQ(glb.substr(20, json_size).find_first_of("<>&"), std::string::npos);
    const Json document = json_of(glb);
    std::size_t end = 0;
    for (const auto& view : document["bufferViews"].GetArray()) {
        EXPECT_EQ(view["byteOffset"].GetUint() % 8, 0U);
        EXPECT_GE(view["byteOffset"].GetUint(), end);
        EXPECT_GE(view["byteLength"].GetUint(), 1U);
        end = view["byteOffset"].GetUint() + view["byteLength"].GetUint();
    }
    EXPECT_LE(end, document["buffers"][0]["byteLength"].GetUint());
    // String offsets ascend, begin with 0 and end within the values.
    const JsonValue& metadata = document["extensions"]["EXT_structural_metadata"];
    const JsonValue& table = metadata["propertyTables"][0];
    EXPECT_EQ(table["count"].GetUint(), set.annotations.size());
    const JsonValue& described = metadata["schema"]["classes"][table["class"].GetString()]["properties"];
    std::size_t columns = 0;
    for (const auto& property : table["properties"].GetObject()) {
        ++columns;
        ASSERT_TRUE(described.HasMember(property.name));
        const JsonValue& type = described[property.name.GetString()];
        const JsonValue& values = document["bufferViews"][property.value["values"].GetUint()];
        if (std::string(type["type"].GetString()) != "STRING") {
            const std::map<std::string, std::size_t> sizes{{"INT32", 4}, {"UINT8", 3}, {"FLOAT64", 8}};
            const std::size_t size = type.HasMember("componentType") ? sizes.at(type["componentType"].GetString()) : 1;
            EXPECT_EQ(values["byteLength"].GetUint(), size * set.annotations.size()) << property.name.GetString();
            continue;
        }
        const JsonValue& offsets = document["bufferViews"][property.value["stringOffsets"].GetUint()];
        ASSERT_EQ(offsets["byteLength"].GetUint(), 4 * (set.annotations.size() + 1));
        const std::size_t at = binary + offsets["byteOffset"].GetUint();
        EXPECT_EQ(word_at(glb, at), 0U);
        for (std::size_t i = 0; i < set.annotations.size(); ++i)
            EXPECT_LE(word_at(glb, at + 4 * i), word_at(glb, at + 4 * i + 4));
        EXPECT_LE(word_at(glb, at + 4 * set.annotations.size()), values["byteLength"].GetUint());
    }
    EXPECT_EQ(columns, described.MemberCount());
    // Features: each id that occurs has a row, counts are right, 16 bit values are four bytes apart.
    for (const auto& primitive : document["meshes"][0]["primitives"].GetArray())
        for (const auto& id : primitive["extensions"]["EXT_mesh_features"]["featureIds"].GetArray()) {
            const std::string name = "_FEATURE_ID_" + std::to_string(id["attribute"].GetUint());
            const JsonValue& accessor = document["accessors"][primitive["attributes"][name.c_str()].GetUint()];
            EXPECT_EQ(accessor["componentType"].GetUint(), 5123U);
            const JsonValue& view = document["bufferViews"][accessor["bufferView"].GetUint()];
            EXPECT_EQ(view["byteStride"].GetUint(), 4U);
            std::set<std::uint32_t> seen;
            for (std::size_t i = 0; i < accessor["count"].GetUint(); ++i)
                seen.insert(word_at(glb, binary + view["byteOffset"].GetUint() + 4 * i));
            seen.erase(id["nullFeatureId"].GetUint());
            EXPECT_EQ(seen.size(), id["featureCount"].GetUint());
            EXPECT_LT(*seen.rbegin(), set.annotations.size());
        }
}

TEST(FeatureGlb, IsShownUprightInMetres) {
    const Mesh mesh = spheres(3);
    AnnotationSet set = wild_set(mesh);
    const Json json = json_of(written({mesh, set}));
    const JsonValue& node = json["nodes"][json["scenes"][0]["nodes"][0].GetUint()];
    EXPECT_EQ(node["children"][0].GetInt(), 0);
    EXPECT_NEAR(node["scale"][0].GetDouble(), 0.001, 1e-15);
    // The quaternion takes z, up in the set, to y.
    const auto& q = node["rotation"];
    const Eigen::Quaterniond rotation(q[3].GetDouble(), q[0].GetDouble(), q[1].GetDouble(), q[2].GetDouble());
    EXPECT_LT((rotation * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
    set.up.reset();
    set.unit = "";
    EXPECT_EQ(json_of(written({mesh, set}))["nodes"].Size(), 1U);
    set.up = {0, -1, 0};  // upside down
    const Json turned = json_of(written({mesh, set}));
    EXPECT_NEAR(std::abs(turned["nodes"][1]["rotation"][3].GetDouble()), 0, 1e-12);
}

TEST(FeatureGlb, TheSmallestRegionLiesInTheFirstSet) {
    const Mesh mesh = grid(4);
    AnnotationSet set;
    for (const Index count : {32U, 8U, 2U}) {
        Annotation region;
        region.id = static_cast<int>(count);
        for (Index f = 0; f < count; ++f) region.faces.push_back(f);
        set.annotations.push_back(region);
    }
    const Json document = json_of(written({mesh, set}));
    const JsonValue& ids = document["meshes"][0]["primitives"][0]["extensions"]["EXT_mesh_features"]["featureIds"];
    EXPECT_EQ(ids.Size(), 3U);
    // Disjoint regions need one set; vertices on their border are duplicated, others are not.
    AnnotationSet halves;
    for (const Index half : {0U, 1U}) {
        Annotation region;
        region.id = static_cast<int>(half);
        for (Index f = 0; f < 16; ++f) region.faces.push_back(16 * half + f);
        halves.annotations.push_back(region);
    }
    const Json flat = json_of(written({mesh, halves}));
    const JsonValue& primitive = flat["meshes"][0]["primitives"][0];
    EXPECT_EQ(primitive["extensions"]["EXT_mesh_features"]["featureIds"].Size(), 1U);
    EXPECT_EQ(flat["accessors"][primitive["attributes"]["POSITION"].GetUint()]["count"].GetUint(), 25U + 5U);
}

TEST(FeatureGlb, ManyAnnotationsHaveFloatIds) {
    const Mesh mesh = grid(2);
    AnnotationSet set;
    for (int i = 0; i < 66000; ++i) {
        Annotation point;
        point.id = i;
        point.type = AnnotationType::point;
        point.points = {static_cast<Index>(i % 9)};
        set.annotations.push_back(std::move(point));
    }
    const PlacedAnnotations read = read_feature_glb(written({mesh, set}), mesh, "f");
    ASSERT_EQ(read.set.annotations.size(), set.annotations.size());
    for (std::size_t i = 0; i < set.annotations.size(); i += 997)
        EXPECT_EQ(read.set.annotations[i].points, set.annotations[i].points);
}

TEST(FeatureGlb, AnotherMeshTakesTheNearestFeatures) {
    const Mesh mesh = spheres(4);
    const AnnotationSet set = wild_set(mesh);
    const std::string glb = written({mesh, set});
    TriangleSoup soup = to_soup(spheres(5));
    for (auto& p : soup.points) p = {0.8 * p[0] - 0.6 * p[1], 0.6 * p[0] + 0.8 * p[1], p[2]};
    const Mesh other = build_mesh(soup);
    const PlacedAnnotations read = read_feature_glb(glb, other, "file");
    ASSERT_EQ(read.set.annotations.size(), set.annotations.size());
    for (std::size_t i = 0; i < set.annotations.size(); ++i) {
        const Annotation &before = set.annotations[i], &after = read.set.annotations[i];
        EXPECT_EQ(after.tag, before.tag);
        ASSERT_EQ(after.type, before.type);
        EXPECT_EQ(read.placements[i].how, "places");
        if (before.type != AnnotationType::region) continue;
        double expected_area = 0, area = 0;
        for (const Index f : before.faces) expected_area += face_area(mesh, Face(f));
        for (const Index f : after.faces) area += face_area(other, Face(f));
        EXPECT_NEAR(area, expected_area, 0.03 * expected_area) << before.tag;
    }
    EXPECT_NE(message(glb, spheres(2, {{40, 0, 0}})).find("farther than"), std::string::npos);
}

TEST(FeatureGlb, InvalidFilesAreRefusedWithTheirPosition) {
    const Mesh mesh = spheres(3);
    const std::string glb = written({mesh, wild_set(mesh)});
    EXPECT_NE(message("solid", mesh).find("not a GLB"), std::string::npos);
    EXPECT_NE(message(glb.substr(0, glb.size() / 2), mesh).find("truncated"), std::string::npos);
    EXPECT_EQ(message(with(glb, "\"scene\":0", "\"scene\":0"), mesh), "");
    const auto expect = [&](const char* from, const char* to, const char* expected) {
        const std::string text = message(with(glb, from, to), mesh);
        EXPECT_NE(text.find(expected), std::string::npos) << to << ": " << text;
    };
    expect(R"("nodes":[{"mesh":0})", R"("nodes":[{"mesh":0,"scale":[2,2,2]})", "/nodes/0/scale");
    expect(R"("type":"VEC3","min")", R"("type":"VEC2","min")", "/accessors/0/type");
    expect(R"("componentType":5126)", R"("componentType":5199)", "/accessors/0/componentType");
    expect(R"("bufferView":0)", R"("bufferView":4000)", "bufferViews");
    expect(R"("byteLength":)", R"("byteLength":9)", "exceeds the buffer");
    expect(R"("propertyTable":0)", R"("propertyTable":7)", "several tables");
    expect(R"("asset")", R"("extensionsRequired":["KHR_draco_mesh_compression"],"asset")", "extensionsRequired");
    expect(R"("stringOffsets":)", R"("stringOffsets":1)", "");
}

TEST(FeatureGlb, ThePublicValidatorFindsNoError) {
    // The Khronos validator is not a package of the distribution: this test runs if it is installed.
    const char* const module = std::getenv("OSTRAKA_GLTF_VALIDATOR");
    if (module == nullptr || !std::filesystem::exists(module))
        GTEST_SKIP() << "set OSTRAKA_GLTF_VALIDATOR to the folder of the npm package gltf-validator";
    const Mesh mesh = spheres(3);
    const test::Scratch scratch;
    const Path glb = scratch.file("a.glb", written({mesh, wild_set(mesh)}));
    const Path script = scratch.file(
        "check.js",
        std::string("const v = require(") + '"' + module + "\");\n" +
            "v.validateBytes(new Uint8Array(require('fs').readFileSync(process.argv[2]))).then(r => {\n" +
            "  console.log(JSON.stringify(r.issues)); process.exit(r.issues.numErrors + r.issues.numWarnings);\n}, e => { "
            "console.log(e); process.exit(99); });\n");
    const std::string out = (scratch / "out").string();
    const int status = std::system(("node " + script.string() + " " + glb.string() + " > " + out + " 2>&1").c_str());
    EXPECT_EQ(status, 0) << read_file(out);
}

TEST(FeatureGlb, DamagedFilesAreRefusedWithAMessage) {
    const Mesh mesh = spheres(3), other = spheres(2);
    const std::string glb = written({mesh, wild_set(mesh)});
    std::size_t successes = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        try {
            PlaceOptions skip;
            skip.skip_far = seed % 4 == 1;
            // Most damage falls into the binary part: half of the copies are damaged in the JSON only.
            const std::string json = glb.substr(20, word_at(glb, 12));
            const std::string copy = seed % 3 == 0 ? test::mutate(glb, seed) : with_json(glb, test::mutate(json, seed));
            read_feature_glb(copy, seed % 2 == 0 ? mesh : other, "file", skip);
            ++successes;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
            EXPECT_FALSE(error.problem().empty());
        }
    }
    EXPECT_LT(successes, 400U);
}

TEST(FeatureGlb, SharedDataAreReadOnceAndLimited) {
    glb::Builder builder;
    const std::size_t count = 30000;
    std::string positions;
    for (std::size_t i = 0; i < 3 * count; ++i) glb::append(positions, static_cast<float>(i % 7));
    builder.add_accessor(positions, 0, 0, glb::single, count, "VEC3");
    const std::string file = builder.finish("file", "");
    const auto with_primitives = [&](std::size_t primitives) {
        std::string list;
        for (std::size_t i = 0; i < primitives; ++i) list += std::string(i > 0 ? "," : "") + "{\"attributes\":{\"POSITION\":0}}";
        std::string json = file.substr(20, word_at(file, 12));
        json.resize(json.rfind('}'));
        return with_json(file, json + ",\"meshes\":[{\"primitives\":[" + list + "]}]}");
    };
    // Some copies are read; whether they can be placed on the mesh is another question.
    const Mesh mesh = spheres(3);
    EXPECT_EQ(message(with_primitives(20), mesh).find("repeatedly"), std::string::npos);
    const std::string refused = message(with_primitives(100000), mesh);
    EXPECT_NE(refused.find("at /meshes/0/primitives/"), std::string::npos) << refused;
    EXPECT_NE(refused.find("refer to the same data repeatedly"), std::string::npos) << refused;
}

TEST(FeatureGlb, FreeOutlinesRoundTripExactly) {
    const Mesh mesh = spheres(3);
    AnnotationSet set;
    set.annotations.resize(2);
    for (int i = 0; i < 2; ++i) {
        set.annotations[static_cast<std::size_t>(i)].id = i;
        set.annotations[static_cast<std::size_t>(i)].tag = "part " + std::to_string(i);
        set.annotations[static_cast<std::size_t>(i)].information = {{Information::Kind::text, "cracked", "", ""}};
    }
    for (const Face f : mesh.faces())
        if (const Point p = centroid(mesh, f); std::abs(p.z()) < 0.7) set.annotations[p.z() > 0.1 ? 0 : 1].faces.push_back(f);
    fair_outlines(mesh, set, {});
    ASSERT_TRUE(is_free(set.annotations[0]) && is_free(set.annotations[1]));
    const std::string glb = written({mesh, set});
    const PlacedAnnotations read = read_feature_glb(glb, mesh, "file");
    EXPECT_EQ(as_file(read.set, mesh), as_file(set, mesh));
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(read.set.annotations.at(i).curves, set.annotations[i].curves);
    EXPECT_EQ(written({mesh, read.set}), glb);
    // A feature renamed by another tool is accepted: its faces are then those in the file.
    const std::string renamed = with(glb, "\"tag\":\"part 0\"", "\"tag\":\"past 0\"");
    EXPECT_EQ(read_feature_glb(renamed, mesh, "file").set.annotations.size(), 2U);
    // Elements that the mesh does not have are refused by name.
    const std::size_t at = glb.find("\"face\":");
    ASSERT_NE(at, std::string::npos);
    const std::string digits_ = glb.substr(at + 7, glb.find_first_of(",}", at) - at - 7);
    const std::string beyond =
        message(with(glb, "\"face\":" + digits_ + ",", "\"face\":" + std::string(digits_.size(), '9') + "999,"), mesh);
    EXPECT_NE(beyond.find("/annotations/"), std::string::npos) << beyond;
}

TEST(FeatureGlb, KeepsTextureAndOwnColours) {
    const Mesh mesh = spheres(3);
    const AnnotationSet set = wild_set(mesh);
    MeshExtras extras;
    Pixels pixels{2, 2, {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {9, 9, 9, 255}}};
    extras.appearance.images = {std::make_shared<const Image>(encode(pixels, ImageFormat::png, "pot.png")),
                                std::make_shared<const Image>(encode(pixels, ImageFormat::webp, "other.webp", 100))};
    extras.appearance.materials.resize(2);
    extras.appearance.materials[0].image = 0;
    extras.appearance.materials[0].wrap_u = TextureWrap::clamp;
    extras.appearance.materials[1].image = 1;
    extras.appearance.materials[1].gltf_rest = R"({"extensions":{"KHR_materials_unlit":{}}})";
    for (const Face face : mesh.faces()) {
        extras.face_materials.push_back(face.idx() % 2);
        for (const Vertex v : corners(mesh, face))
            extras.corner_texture.push_back({static_cast<float>(mesh.point(v).x()), static_cast<float>(face.idx())});
    }
    std::vector<std::string> notes;
    const std::string glb = feature_glb({mesh, set}, "m.ply", {}, notes, extras);
    EXPECT_NE(std::find_if(notes.begin(), notes.end(),
                           [](const std::string& note) { return note.find("texture") != std::string::npos; }),
              notes.end());
    const glb::Reader reader(glb, "glb");
    const Json& document = reader.document();
    const auto& primitives = document["meshes"][0]["primitives"];
    ASSERT_GE(primitives.Size(), 2U);
    for (rapidjson::SizeType i = 0; i < 2; ++i) {
        const auto& attributes = primitives[i]["attributes"];
        EXPECT_EQ(primitives[i]["material"].GetUint(), i + 1);
        const auto places = reader.accessor(attributes["TEXCOORD_0"].GetUint(), 2, "");
        const auto points = reader.accessor(attributes["POSITION"].GetUint(), 3, "");
        const auto indices = reader.accessor(primitives[i]["indices"].GetUint(), 1, "");
        // Triangle t of this primitive is face 2 t + i of the mesh.
        for (std::size_t corner = 0; corner < indices->size(); ++corner) {
            const auto vertex = static_cast<std::size_t>((*indices)[corner]);
            EXPECT_EQ((*places)[2 * vertex], (*points)[3 * vertex]);
            EXPECT_EQ((*places)[2 * vertex + 1], 1 - static_cast<float>(2 * (corner / 3) + i));
        }
    }
    const auto image = [&](unsigned index) {
        return std::string(reader.view(document["images"][index]["bufferView"].GetUint(), ""));
    };
    EXPECT_EQ(image(0), extras.appearance.images[0]->bytes);
    EXPECT_EQ(image(1), extras.appearance.images[1]->bytes);
    EXPECT_EQ(document["samplers"][0]["wrapS"].GetUint(), 33071U);
    EXPECT_TRUE(document["materials"][2]["extensions"].HasMember("KHR_materials_unlit"));
    // The annotations come back as they were, although the triangles are ordered by material.
    EXPECT_EQ(as_file(read_feature_glb(glb, mesh, "file").set, mesh), as_file(set, mesh));

    MeshExtras coloured;
    coloured.vertex_colours.assign(mesh.number_of_vertices(), Colour{255, 128, 0, 255});
    const std::string own = feature_glb({mesh, set}, "m.ply", {}, notes, coloured);
    const glb::Reader own_reader(own, "glb");
    const auto colours =
        own_reader.accessor(own_reader.document()["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"].GetUint(), 4, "");
    for (std::size_t i = 0; i < colours->size(); i += 4) {
        EXPECT_GT((*colours)[i], (*colours)[i + 1]);
        EXPECT_EQ((*colours)[i + 2], 0);
    }
    EXPECT_EQ(as_file(read_feature_glb(own, mesh, "file").set, mesh), as_file(set, mesh));
}
