// Pages: their data equal the input, in its order, and text stays text.
#include "ostraka/page/page.h"
#include "meshes.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/core/error.h"
#include "ostraka/io/glb.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/page/content_policy.h"
#include "ostraka/select/recipe.h"
#include "scratch.h"

#include <meshoptimizer.h>
#include <zlib.h>

#include <cmath>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// The content of an element of a page.
std::string inside(const std::string& html, const std::string& id) {
    const std::size_t begin = html.find('>', html.find("id=\"" + id + "\"")) + 1;
    return html.substr(begin, html.find("</script>", begin) - begin);
}

std::string from_base64(const std::string& text) {
    const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t word = 0;
    int bits = 0;
    for (const char c : text) {
        if (c == '=') break;
        word = word << 6U | static_cast<std::uint32_t>(letters.find(c));
        bits += 6;
        if (bits >= 8) bytes += static_cast<char>(word >> static_cast<unsigned>(bits -= 8) & 255U);
    }
    return bytes;
}

/// The contents of a page, decoded with its own script.
struct ReadPage {
    Json data;
    std::string bytes;

    explicit ReadPage(const std::string& html) : data(parse_json(inside(html, "ostraka-data"), "data")) {
        const std::string packed = from_base64(inside(html, "ostraka-bytes"));
        std::size_t size = 1024;
        for (int status = Z_BUF_ERROR; status == Z_BUF_ERROR;) {
            bytes.resize(size *= 4);
            uLongf unpacked_size = size;
            status = ::uncompress(reinterpret_cast<Bytef*>(bytes.data()), &unpacked_size,
                                  reinterpret_cast<const Bytef*>(packed.data()), packed.size());
            if (status == Z_OK) bytes.resize(unpacked_size);
        }
    }
    [[nodiscard]] std::string blob(const JsonValue& index) const {
        const JsonValue& place = data["blobs"][index.GetUint()];
        return bytes.substr(place[0].GetUint64(), place[1].GetUint64());
    }
};

std::string bytes_of_view(const std::string& glb, const JsonValue& packed) {
    const std::uint32_t json_size = *reinterpret_cast<const std::uint32_t*>(glb.data() + 12);
    return glb.substr(20 + json_size + 8 + packed["byteOffset"].GetUint64(), packed["byteLength"].GetUint64());
}

/// A sphere far from the origin with a region, a region in it, a line and a point.
struct Annotated : AnnotatedMesh {
    TriangleSoup soup = octahedron_sphere(4);

    explicit Annotated(const std::string& tag = "cap") {
        for (auto& p : soup.points)
            for (std::size_t k = 0; k < 3; ++k) p[k] = 7 * p[k] + 1000.0 * static_cast<double>(k + 1);
        mesh = build_mesh(soup);
        annotations.unit = "mm";
        annotations.annotations.reserve(4);  // the parts are named below
        Annotation& upper = annotations.annotations.emplace_back();
        upper.id = 4;
        upper.tag = tag;
        for (Index f = 0; f < soup.triangles.size(); ++f)
            if (soup.points[soup.triangles[f][0]][2] > 3002) upper.faces.push_back(f);
        Attribute& measure = upper.attributes.emplace_back();
        measure.value = Measure();
        measure.name = "width";
        measure.measure()->tool = "ruler";
        measure.measure()->points = {0, 1};
        measure.measure()->value = 14;
        measure.measure()->unit = "mm";
        Annotation& top = annotations.annotations.emplace_back();
        top.id = 9;
        top.tag = "top";
        for (const Index f : upper.faces)
            if (soup.points[soup.triangles[f][0]][2] > 3006) top.faces.push_back(f);
        Annotation& line = annotations.annotations.emplace_back();
        line.id = 11;
        line.type = AnnotationType::line;
        line.polylines = {{soup.triangles[0][0], soup.triangles[0][1]}};
        Annotation& point = annotations.annotations.emplace_back();
        point.id = 12;
        point.type = AnnotationType::point;
        point.points = {5};
    }
    [[nodiscard]] PageObject object() const {
        PageObject page_object;
        page_object.name = "sphere";
        page_object.mesh = &mesh;
        page_object.annotations = &annotations;
        return page_object;
    }
};

}  // namespace

TEST(Page, HoldsTheShapeInItsOrderWithinTheQuantisation) {
    const Annotated annotated;
    Page page("a sphere");
    page.add(annotated.object());
    const ReadPage read(page.html("made by a test"));
    const JsonValue& object = read.data["objects"][0];
    EXPECT_EQ(object["vertices"].GetUint64(), annotated.soup.points.size());
    const std::string glb = read.blob(object["geometry"]);
    const Json document = glb::Reader(glb, "glb").document().GetObject().MemberCount() > 0
                              ? parse_json(glb.substr(20, *reinterpret_cast<const std::uint32_t*>(glb.data() + 12)), "glb")
                              : Json();
    const auto packed = [&](const char* accessor) -> const JsonValue& {
        const JsonValue& primitive = document["meshes"][0]["primitives"][0];
        const auto index =
            std::string(accessor) == "POSITION" ? primitive["attributes"]["POSITION"].GetUint() : primitive["indices"].GetUint();
        const auto view = document["accessors"][index]["bufferView"].GetUint();
        return document["bufferViews"][view]["extensions"]["EXT_meshopt_compression"];
    };
    std::vector<std::array<std::uint16_t, 4>> points(annotated.soup.points.size());
    const std::string point_bytes = bytes_of_view(glb, packed("POSITION"));
    ASSERT_EQ(meshopt_decodeVertexBuffer(points.data(), points.size(), 8,
                                         reinterpret_cast<const unsigned char*>(point_bytes.data()), point_bytes.size()),
              0);
    const double step = document["nodes"][0]["scale"][0].GetDouble();
    EXPECT_NEAR(step, 14.0 / 65535, 1e-12);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_NEAR(object["origin"][static_cast<rapidjson::SizeType>(k)].GetDouble() + step * points[i][k],
                        annotated.soup.points[i][k], 0.5001 * step);
    std::vector<std::array<Index, 3>> triangles(annotated.soup.triangles.size());
    const std::string index_bytes = bytes_of_view(glb, packed("indices"));
    ASSERT_EQ(meshopt_decodeIndexBuffer(triangles.front().data(), 3 * triangles.size(), 4,
                                        reinterpret_cast<const unsigned char*>(index_bytes.data()), index_bytes.size()),
              0);
    for (std::size_t f = 0; f < triangles.size(); ++f) {
        auto rotated = triangles[f];  // the codec may rotate the corners
        for (int k = 0; k < 3 && rotated != annotated.soup.triangles[f]; ++k)
            std::rotate(rotated.begin(), rotated.begin() + 1, rotated.end());
        EXPECT_EQ(rotated, annotated.soup.triangles[f]);
    }
}

TEST(Page, HoldsAnnotationsWithTheirTreeMeasuresAndFaces) {
    const Annotated annotated;
    Page page("a sphere");
    page.add(annotated.object());
    page.add(annotation_table(annotated, 0, "sphere"));
    const ReadPage read(page.html(""));
    const JsonValue& annotations = read.data["objects"][0]["annotations"];
    ASSERT_EQ(annotations.Size(), 4U);
    EXPECT_EQ(annotations[0]["parent"].GetInt(), -1);
    EXPECT_EQ(annotations[1]["parent"].GetInt(), 0);
    for (rapidjson::SizeType i = 0; i < 2; ++i) {
        const std::string runs = read.blob(annotations[i]["faces"]["blob"]);
        std::vector<Index> faces;
        std::size_t at = 0;
        Index face = 0;
        const auto next = [&] {
            std::size_t value = 0;
            for (std::size_t scale = 1;; scale *= 128) {
                const auto byte = static_cast<unsigned char>(runs.at(at++));
                value += byte % 128 * scale;
                if (byte < 128) return static_cast<Index>(value);
            }
        };
        while (at < runs.size()) {
            face += next();
            for (Index run = next(); run > 0; --run) faces.push_back(face++);
        }
        EXPECT_EQ(faces, annotated.annotations.annotations[i].faces);
    }
    const JsonValue& pins = annotations[0]["measures"][0]["pins"];
    const JsonValue& origin = read.data["objects"][0]["origin"];
    EXPECT_NEAR(pins[0][0].GetDouble() + origin[0].GetDouble(), 1007, 1e-9);
    EXPECT_NEAR(pins[1][0].GetDouble() + origin[0].GetDouble(), 993, 1e-9);
    EXPECT_EQ(annotations[2]["lines"][0][1].GetUint(), annotated.soup.triangles[0][1]);
    EXPECT_EQ(annotations[3]["points"][0].GetUint(), 5U);
    const JsonValue& rows = read.data["tables"][0]["rows"];
    EXPECT_NEAR(rows[0][4].GetDouble(), area_of(annotated.mesh, annotated.annotations.annotations[0].faces), 1e-9);
    EXPECT_EQ(read.data["tables"][0]["annotations"][1].GetInt(), 1);
}

TEST(Page, HoldsCurvesThatRunThroughTheTriangles) {
    Annotated annotated;
    const std::string recipe = R"({"format": "ostraka-recipe", "version": 1, "annotations": [{"id": 20, "tag": "cap",
        "type": "region", "outline": "free", "select": {"sphere": {"centre": [1007, 2000, 3000], "radius": 5.3}}}]})";
    annotated.annotations = apply_recipe(parse_json(recipe, "r"), annotated.mesh, {}, "r");
    ASSERT_TRUE(is_free(annotated.annotations.annotations[0]));
    Page page("a sphere");
    page.add(annotated.object());
    const ReadPage read(page.html(""));
    const JsonValue &entry = read.data["objects"][0]["annotations"][0], &origin = read.data["objects"][0]["origin"];
    const auto curves = curves_on(annotated.mesh, annotated.annotations.annotations[0]);
    ASSERT_EQ(entry["curves"].Size(), curves.size());
    ASSERT_EQ(entry["curves"][0].Size(), curves[0].points.size());
    for (rapidjson::SizeType i = 0; i < curves[0].points.size(); ++i) {
        const JsonValue& place = entry["curves"][0][i];
        const Point shown(place[0].GetDouble() + origin[0].GetDouble(), place[1].GetDouble() + origin[1].GetDouble(),
                          place[2].GetDouble() + origin[2].GetDouble());
        const double distance = std::sqrt(CGAL::squared_distance(shown, position(annotated.mesh, curves[0].points[i])));
        EXPECT_NEAR(distance, 0.002 * box_diagonal(annotated.mesh), 1e-4 * box_diagonal(annotated.mesh));
        EXPECT_GT(std::sqrt(CGAL::squared_distance(shown, Point(1000, 2000, 3000))),
                  std::sqrt(CGAL::squared_distance(position(annotated.mesh, curves[0].points[i]), Point(1000, 2000, 3000))));
    }
    EXPECT_FALSE(entry.HasMember("lines"));
}

TEST(Page, QuantisesMapsAndMarksMissingValues) {
    const Annotated annotated;
    PageObject object = annotated.object();
    PageMap& map = object.maps.emplace_back();
    map.name = "height";
    for (const auto& p : annotated.soup.points) map.values.push_back(p[2]);
    map.values[3] = std::nan("");
    Page page("a sphere");
    page.add(object);
    const ReadPage read(page.html(""));
    const JsonValue& map_entry = read.data["objects"][0]["maps"][0];
    const std::string bytes = read.blob(map_entry["blob"]);
    ASSERT_EQ(bytes.size(), 2 * map.values.size());
    const auto* steps = reinterpret_cast<const std::uint16_t*>(bytes.data());
    const double low = map_entry["minimum"].GetDouble(), range = map_entry["maximum"].GetDouble() - low;
    EXPECT_EQ(steps[3], 65535);
    for (std::size_t i = 0; i < map.values.size(); ++i) {
        if (i == 3) continue;
        EXPECT_NEAR(low + steps[i] / 65534.0 * range, map.values[i], range / 131068 * 1.001);
    }
    EXPECT_EQ(map_entry["colours"].Size(), 9U);
    EXPECT_EQ(map_entry["colours"][0][0].GetInt(), 68);
    EXPECT_EQ(map_entry["colours"][8][2].GetInt(), 37);
    std::size_t counted = 0;
    for (const auto& count : map_entry["histogram"].GetArray()) counted += count.GetUint64();
    EXPECT_EQ(counted, map.values.size() - 1);
}

TEST(Page, CategoriesAreCounted) {
    const Annotated annotated;
    PageObject object = annotated.object();
    PageMap& map = object.maps.emplace_back();
    map.name = map.label = "origin";
    map.categories = {{"observed", {1, 2, 3}}, {"guessed", {4, 5, 6}}};
    map.values.assign(annotated.soup.points.size(), 0);
    map.values[2] = map.values[7] = 1;
    map.values[3] = std::nan("");
    Page page("a sphere");
    page.add(object);
    const ReadPage read(page.html(""));
    const JsonValue& map_entry = read.data["objects"][0]["maps"][0];
    const std::string bytes = read.blob(map_entry["blob"]);
    const auto* steps = reinterpret_cast<const std::uint16_t*>(bytes.data());
    EXPECT_EQ(steps[2], 1);
    EXPECT_EQ(steps[3], 65535);
    EXPECT_EQ(steps[4], 0);
    ASSERT_EQ(map_entry["histogram"].Size(), 2U);
    EXPECT_EQ(map_entry["histogram"][0].GetUint64(), annotated.soup.points.size() - 3);
    EXPECT_EQ(map_entry["histogram"][1].GetUint64(), 2U);
    EXPECT_STREQ(map_entry["categories"][1]["text"].GetString(), "guessed");
    EXPECT_EQ(map_entry["categories"][1]["colour"][2].GetInt(), 6);
}

TEST(Page, HoldsSlicesConstraintsAndPartsInTheFrameOfTheObject) {
    const Annotated annotated;
    PageObject object = annotated.object();
    PageSlices slices;
    slices.unit = "mm";
    slices.columns = {{"area", "area", "mm\xC2\xB2"}};
    for (const double height : {2998.0, 3001.0}) {
        PageSlices::Level& level = slices.levels.emplace_back();
        level.height = height;
        level.origin = {1000, 2000, height};
        level.u = {1, 0, 0};
        level.v = {0, 1, 0};
        level.values = {height > 3000 ? std::optional(12.5) : std::nullopt};
        level.contours = {{true, false, {{1, 2}, {3, 4}, {5, height}}}};
    }
    slices.tube = {2998, 3001};
    object.slices = &slices;
    object.constraints = {
        {"same level", {0, 3}, 2, true, "holds", "fails", false, "by 3 mm", {{"height", 1, 4, {}, "mm"}}, {{0.5, 0.75}}}};
    object.conflicts = {"this against that"};
    object.parts = {0, 1};
    Page page("a sphere");
    page.add(object);
    const ReadPage read(page.html(""));
    const JsonValue& object_entry = read.data["objects"][0];
    const JsonValue& level = object_entry["slices"]["levels"][1];
    EXPECT_NEAR(level["origin"][2].GetDouble() + object_entry["origin"][2].GetDouble(), 3001, 1e-9);
    EXPECT_EQ(level["values"][0].GetDouble(), 12.5);
    EXPECT_TRUE(object_entry["slices"]["levels"][0]["values"][0].IsNull());
    const std::string bytes = read.blob(object_entry["slices"]["blob"]);
    ASSERT_EQ(bytes.size(), 2 * 3 * 2 * sizeof(float));
    EXPECT_EQ(reinterpret_cast<const float*>(bytes.data())[11], 3001.0F);
    EXPECT_EQ(level["contours"][0]["points"].GetInt(), 3);
    EXPECT_EQ(object_entry["slices"]["tube"][1].GetDouble(), 3001);
    const JsonValue& constraint = object_entry["constraints"][0];
    EXPECT_EQ(constraint["members"][1].GetInt(), 3);
    EXPECT_FALSE(constraint["holds"].GetBool());
    EXPECT_EQ(constraint["deviations"][0]["value"].GetDouble(), 4);
    EXPECT_TRUE(constraint["deviations"][0]["tolerance"].IsNull());
    EXPECT_EQ(constraint["residual"]["largest"].GetDouble(), 0.75);
    EXPECT_STREQ(object_entry["conflicts"][0].GetString(), "this against that");
    EXPECT_EQ(object_entry["parts"].Size(), 2U);
}

TEST(Page, PageOfACollectionLoadsObjectsFromItsFolder) {
    const Annotated annotated;
    Page alone("sphere");
    alone.add(annotated.object());
    const std::string script = alone.script("objects/0001.js", "");
    const std::string begin = "ostrakaObject(\"objects/0001.js\", ";
    ASSERT_TRUE(script.starts_with(begin));
    EXPECT_TRUE(script.ends_with("\");\n"));
    Page index("two");
    index.add({"sphere", "objects/0001.js", "objects/0001.png", 5, 6, {"cap", "top"}});
    const std::string html = index.html("");
    EXPECT_STREQ(ReadPage(html).data["collection"][0]["tags"][1].GetString(), "top");
    const auto policy = [](const std::string& text) {
        const std::size_t at = text.find("Content-Security-Policy");
        return text.substr(at, text.find('>', at) - at);
    };
    EXPECT_EQ(policy(alone.html("")).find("'self'"), std::string::npos) << "one file needs nothing else";
    EXPECT_NE(policy(html), policy(alone.html("")));
}

TEST(Page, EscapesMarkupInTexts) {
    const std::string evil = "</script><img src=x onerror=alert(1)><!--";
    Annotated annotated(evil);
    annotated.annotations.unit = evil;
    annotated.annotations.annotations[0].note = evil;
    annotated.annotations.annotations[0].attributes[0].name = evil;
    Page page(evil);
    PageObject object = annotated.object();
    object.name = evil;
    page.add(object);
    page.add(annotation_table(annotated, 0, evil));
    page.add_drawing(evil, "<svg/>");
    page.note(evil);
    const std::string html = page.html(evil), plain = Page("").html("");
    EXPECT_EQ(html.find(evil), std::string::npos);
    const auto count = [](const std::string& text, const std::string& substring) {
        std::size_t n = 0;
        for (std::size_t at = text.find(substring); at != std::string::npos; at = text.find(substring, at + 1)) ++n;
        return n;
    };
    EXPECT_EQ(count(html, "</script"), count(plain, "</script"));
    EXPECT_EQ(count(html, "<img"), count(plain, "<img"));
    EXPECT_EQ(count(html, "<!--"), count(plain, "<!--"));
    const ReadPage read(html);
    EXPECT_EQ(read.data["objects"][0]["annotations"][0]["tag"].GetString(), evil);
    EXPECT_EQ(read.data["notes"][0].GetString(), evil);
}

TEST(Page, RunsOnlyTheScriptOfTheViewer) {
    const auto policy_of = [](const std::string& html) {
        const std::size_t begin = html.find("content=\"default-src");
        return html.substr(begin, html.find('>', begin) - begin);
    };
    Page index("many");
    index.add({"sphere", "objects/0001.js", "objects/0001.png", 5, 6, {}});
    for (const std::string& html : {Page("one").html(""), index.html("")}) {
        const std::string policy = policy_of(html);
        EXPECT_EQ(policy.find("unsafe-inline"), std::string::npos) << policy;
        // The checksum is that of the only script that does not contain data.
        const std::string script_tag = "<script type=\"module\"";
        const std::size_t script = html.find('>', html.find(script_tag)) + 1;
        EXPECT_EQ(html.find(script_tag, script), std::string::npos);
        const std::string script_hash = sha256(html.substr(script, html.find("</script>", script) - script));
        const std::size_t hash = policy.find("'sha256-", policy.find("script-src ")) + 8;
        std::string allowed_hash;
        for (const char byte : from_base64(policy.substr(hash, 44))) {
            char digits[3];
            std::snprintf(digits, sizeof digits, "%02x", static_cast<unsigned>(static_cast<unsigned char>(byte)));
            allowed_hash += digits;
        }
        EXPECT_EQ(allowed_hash, script_hash);
    }
}

TEST(Page, HashesOfInlineScripts) {
    const std::string of_a = "'sha256-ypeBEsobvcr6wjGzmiPcTaeG7/gUfE5yuYB3ha/uSLs='";
    EXPECT_EQ(inline_hashes("<script>a</script>", "script"), of_a);
    EXPECT_EQ(inline_hashes("<p><script type=\"module\" crossorigin>a</script><style x>a</style>", "script"), of_a);
    EXPECT_EQ(inline_hashes("<p><script>b</script><style x>a</style>", "style"), of_a);
    EXPECT_EQ(inline_hashes("<script>a</script><script>a</script>", "script"), of_a + " " + of_a);
    EXPECT_EQ(inline_hashes("<script type=\"application/json\" id=\"x\">a</script><script src=\"a.js\"></script>", "script"), "");
    EXPECT_EQ(inline_hashes("", "script"), "");
    EXPECT_EQ(inline_hashes("<script", "script"), "'sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU='");
}

TEST(Page, ReportsObjectsWithTheSameTriangles) {
    const Annotated annotated;
    Annotated moved;
    for (const Vertex v : moved.mesh.vertices()) moved.mesh.point(v) = moved.mesh.point(v) + Vector(0, 0, 0.1 * v.idx());
    const Mesh other = build_mesh(octahedron_sphere(3));
    Page page("three");
    page.add(annotated.object());
    PageObject third;
    third.name = "other";
    third.mesh = &other;
    page.add(third);
    page.add(moved.object());
    const ReadPage read(page.html(""));
    EXPECT_EQ(read.data["objects"][0]["blend"].GetInt(), 0);
    EXPECT_FALSE(read.data["objects"][1].HasMember("blend"));
    EXPECT_EQ(read.data["objects"][2]["blend"].GetInt(), 0);
}

TEST(Page, RefusesObjectsThatCannotBeShown) {
    Page page("none");
    const Mesh empty;
    PageObject object;
    object.name = "empty";
    object.mesh = &empty;
    EXPECT_THROW(page.add(object), Error);
    const Annotated annotated;
    PageObject mapped = annotated.object();
    mapped.maps.push_back({"short", "", {1, 2, 3}});
    EXPECT_THROW(page.add(mapped), Error);
}

TEST(Page, OneTriangleAndAFlatObjectAreShown) {
    TriangleSoup soup;
    soup.points = {{0, 0, 0}, {1e-9, 0, 0}, {0, 1e-9, 0}};
    soup.triangles = {{0, 1, 2}};
    const Mesh mesh = build_mesh(soup);
    PageObject object;
    object.name = "triangle";
    object.mesh = &mesh;
    Page page("one");
    page.add(object);
    const ReadPage read(page.html(""));
    EXPECT_EQ(read.data["objects"][0]["faces"].GetInt(), 1);
    EXPECT_EQ(page.html(""), page.html(""));
}

TEST(ReportCommand, MakesTheSamePageTwiceAndRefusesWrongInput) {
    const Scratch scratch;
    const std::string data = std::string(OSTRAKA_SOURCE_DIR) + "/data/";
    const auto make = [&](const std::string& words) { return run_command("report " + words); };
    ASSERT_EQ(make(data + "vase.ply " + (scratch / "a.html").string()).code, 0);
    ASSERT_EQ(make(data + "vase.ply " + (scratch / "b.html").string()).code, 0);
    EXPECT_EQ(read_file(scratch / "a.html"), read_file(scratch / "b.html"));
    const ReadPage read(read_file(scratch / "a.html"));
    EXPECT_GT(read.data["objects"][0]["annotations"].Size(), 0U) << "annotations beside the mesh";
    const auto refuse = [&](const std::string& words, int code, const std::string& message) {
        const auto result = make(words + " " + (scratch / "c.html").string());
        EXPECT_EQ(result.code, code) << words << ": " << result.err;
        EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
        EXPECT_FALSE(file_exists(scratch / "c.html"));
    };
    refuse((scratch / "none.ply").string(), 1, "none.ply");
    refuse(data + "vase.ant.json", 1, "comes before any mesh");
    refuse(data + "vase.recipe.json", 1, "cannot be shown on a page");
    refuse(data + "vase.ply " + data + "teapot.ant.json", 1, "teapot.ant.json");
    std::filesystem::create_directory(scratch / "empty");
    refuse((scratch / "empty").string(), 1, "nothing that a page can show");
    EXPECT_EQ(make(data + "vase.ply " + (scratch / "c.png").string()).code, 2);
    // A folder: its cage is not a separate object, and an unreadable file is not a result.
    write_file(scratch / "empty/broken.json", "[1,");
    for (const char* name : {"vase.ply", "vase.ant.json"})
        write_file(scratch / ("empty/" + std::string(name)), read_file(data + name));
    write_file(scratch / "empty/vase.cage.ply", read_file(data + "vase.ply"));
    ASSERT_EQ(make((scratch / "empty").string() + " " + (scratch / "d.html").string()).code, 0);
    const ReadPage folder(read_file(scratch / "d.html"));
    ASSERT_EQ(folder.data["objects"].Size(), 1U);
    EXPECT_GT(folder.data["objects"][0]["annotations"].Size(), 0U);
    EXPECT_NE(std::string(folder.data["notes"][0].GetString()).find("broken.json"), std::string::npos);
}

TEST(ReportCommand, ShowsOutputsOfOtherCommands) {
    const Scratch scratch;
    const std::string data = std::string(OSTRAKA_SOURCE_DIR) + "/data/", vase = data + "vase.ply ";
    const auto file = [&](const std::string& name) { return (scratch / name).string(); };
    const auto run = [&](const std::string& words) {
        const auto result = run_command(words);
        EXPECT_EQ(result.code, 0) << words << ": " << result.err;
    };
    const auto page_of = [&](const std::string& words) {
        run("report " + words + " " + file("page.html"));
        return ReadPage(read_file(scratch / "page.html"));
    };
    run("slice " + vase + "--output " + file("slices") + " --count 7");
    const ReadPage sliced = page_of(vase + file("slices/slices.json"));
    const JsonValue& slices = sliced.data["objects"][0]["slices"];
    const Json written = read_json(scratch / "slices/slices.json");
    ASSERT_EQ(slices["levels"].Size(), 7U);
    EXPECT_EQ(slices["levels"][3]["height"].GetDouble(), written["slices"][3]["height"].GetDouble());
    // A deformation: the outcome of its constraints is shown with its parts, the rest as tables.
    write_file(scratch / "moved.json", R"({"format": "ostraka-report", "command": "deform", "result": {"rounds": 17,
        "constraints": [{"id": 4, "type": "same level", "parts": ["belly", "neck"], "weight": 1, "hard": true, "before": "holds",
                         "verdict": "fails", "text": "", "deviations": [{"quantity": "height", "before": 0, "value": 3,
                         "tolerance": 1, "unit": "mm"}], "residual": {"mean": 0.5, "max": 2}}],
        "conflicts": [{"id": 4, "freed": []}], "moved": [{"tag": "neck", "share": 0.25}, {"tag": "belly", "share": 0.5}]}})");
    const ReadPage deformed = page_of(vase + file("moved.json"));
    const JsonValue& object = deformed.data["objects"][0];
    const JsonValue& constraint = object["constraints"][0];
    ASSERT_EQ(constraint["members"].Size(), 2U);
    EXPECT_STREQ(object["annotations"][constraint["members"][1].GetUint()]["tag"].GetString(), "neck");
    EXPECT_FALSE(constraint["holds"].GetBool());
    EXPECT_STREQ(object["conflicts"][0].GetString(), "same level of belly, neck cannot hold");
    const JsonValue& tables = deformed.data["tables"];
    const JsonValue& moved = tables[tables.Size() - 1];
    EXPECT_STREQ(moved["title"].GetString(), "moved: moved");
    EXPECT_EQ(moved["annotations"][0].GetInt(), static_cast<int>(constraint["members"][1].GetUint())) << "by its tag";
    // Output of 'relation check': a broken rule, relations, and a proportion that is a constraint (a canon).
    write_file(scratch / "checked.json", R"({"format": "ostraka-report", "command": "relation check", "result": {
        "relationships": [{"id": 0, "type": "adjacency", "annotations": [2, 5], "isConstraint": false, "verdict": "holds",
                           "text": "", "parameters": {}},
                          {"id": 1, "type": "proportion", "annotations": [5, 2], "isConstraint": true, "verdict": "fails",
                           "text": "", "parameters": {"deviations": [{"quantity": "ratio", "value": 12.5, "tolerance": 1,
                           "unit": "%"}]}},
                          {"id": 2, "type": "my own", "annotations": [], "isConstraint": true, "verdict": "unknown",
                           "text": "nothing is known of it", "parameters": {}}],
        "rules": [{"rule": "two handles", "annotation": 5, "part": "neck", "text": "there must be exactly 2"}],
        "holds": 1, "fails": 1, "unknown": 1, "conforms": false}})");
    const ReadPage checked = page_of(vase + file("checked.json"));
    const JsonValue& verdicts = checked.data["objects"][0]["conformance"];
    ASSERT_EQ(verdicts.Size(), 4U);
    EXPECT_STREQ(verdicts[0]["kind"].GetString(), "rule");
    EXPECT_STREQ(verdicts[0]["name"].GetString(), "two handles");
    EXPECT_FALSE(verdicts[0]["holds"].GetBool());
    EXPECT_STREQ(verdicts[1]["kind"].GetString(), "relation");
    EXPECT_TRUE(verdicts[1]["holds"].GetBool());
    EXPECT_STREQ(verdicts[2]["kind"].GetString(), "canon");
    EXPECT_STREQ(verdicts[2]["text"].GetString(), "ratio 12.5 (at most 1) %");
    EXPECT_STREQ(checked.data["objects"][0]["annotations"][verdicts[2]["members"][0].GetUint()]["tag"].GetString(), "neck");
    EXPECT_EQ(verdicts[3].FindMember("holds"), verdicts[3].MemberEnd()) << "it cannot be told";
    // Labels of faces are parts, which can be moved apart where they share no vertex; real properties are maps.
    TriangleSoup two = octahedron_sphere(2);
    const auto count = static_cast<Index>(two.points.size());
    const std::size_t faces = two.triangles.size();
    for (Index i = 0; i < count; ++i) two.points.push_back({two.points[i][0] + 3, two.points[i][1], two.points[i][2]});
    MeshExtras extras;
    for (std::size_t f = 0; f < 2 * faces; ++f) extras.face_labels.push_back(f < faces ? 1 : 2);
    for (std::size_t f = 0; f < faces; ++f) {
        const auto [a, b, c] = two.triangles[f];
        two.triangles.push_back({a + count, b + count, c + count});
    }
    write_mesh(scratch / "group-1.ply", build_mesh(two), extras);
    const ReadPage apart = page_of(file("group-1.ply"));
    EXPECT_EQ(apart.data["objects"][0]["parts"].Size(), 2U);
    write_file(scratch / "assembly.json",
               R"({"format": "ostraka-reassembly", "fragments": [{"name": "rim"}, {"name": "foot"}]})");
    const ReadPage named = page_of(file("group-1.ply") + " " + file("assembly.json"));
    EXPECT_STREQ(named.data["objects"][0]["annotations"][1]["tag"].GetString(), "foot");
    // A collection: the page is an index, and each object is an independent file.
    const auto collected =
        run_command("report " + vase + data + "statuette.ply " + file("all.html") + " --beside '" + file("all of it") + "'");
    ASSERT_EQ(collected.code, 0) << collected.err;
    const ReadPage all_objects(read_file(scratch / "all.html"));
    ASSERT_EQ(all_objects.data["collection"].Size(), 2U);
    EXPECT_EQ(all_objects.data["objects"].Size(), 0U);
    EXPECT_STREQ(all_objects.data["collection"][1]["file"].GetString(), "all%20of%20it/0002.js");
    EXPECT_TRUE(read_file(scratch / "all of it/0002.js").starts_with("ostrakaObject(\"all%20of%20it/0002.js\", "));
    EXPECT_TRUE(read_file(scratch / "all of it/0002.png").starts_with("\x89PNG"));
    EXPECT_EQ(all_objects.data["tables"][0]["objects"][1].GetInt(), 1);
}

TEST(Publish, AcceptsOnlyWebAddresses) {
    const Scratch scratch;
    const std::string mesh = (scratch / "vase.ply").string(), set = (scratch / "vase.ant.json").string();
    ASSERT_EQ(run_command("mesh make vase " + mesh + " --vertices 2500 --quiet").code, 0);
    ASSERT_EQ(run_command("annotation apply " + mesh + " " OSTRAKA_SOURCE_DIR "/data/vase.recipe.json " + set + " --quiet").code,
              0);
    const auto publish = [&](const std::string& address, const std::string& rights) {
        return run_command("publish " + mesh + " " + set + " " + (scratch / "out").string() + " --quiet --address '" + address +
                           "'" + (rights.empty() ? "" : " --rights '" + rights + "'"));
    };
    const std::string good = "https://museum.example/ball", rights = "http://creativecommons.org/licenses/by/4.0/";
    for (const std::string bad :
         {"javascript:alert(1)", "data:text/html,x", "file:///etc/passwd", "//museum.example", "https://", "HTTPS", "https://a b",
          "https://a\"onload=", "https://a/<img>", "https://a\rb", "https://a\x7f", "java\tscript:x"}) {
        EXPECT_EQ(publish(bad, rights).code, 2) << bad;
        EXPECT_EQ(publish(good, bad).code, 2) << bad;
        EXPECT_FALSE(file_exists(scratch / "out" / "manifest.json"));
    }
    const auto published = publish(good, rights);
    ASSERT_EQ(published.code, 0) << published.err;
    EXPECT_NE(read_file(scratch / "out" / "manifest.json").find(rights), std::string::npos);
}
