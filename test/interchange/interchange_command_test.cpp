// The built command: export, import, edit, diff and merge on good and bad input, and on real landmarks.
#include "ostraka/files/json.h"
#include "ostraka/interchange/interchange.h"
#include "ostraka/io/mesh_file.h"
#include "scratch.h"
#include "sets.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::example;
using ostraka::test::run_command;
using ostraka::test::Scratch;

namespace {

struct Folder : Scratch {
    Mesh mesh = spheres(3);
    Folder() {
        write_mesh(*this / "ball.ply", mesh);
        write(wild_set(mesh), "a.ant.json");
    }
    void write(const AnnotationSet& set, const std::string& name) const {
        write_annotations(*this / name, {mesh, set}, "ball.ply", {});
    }
    [[nodiscard]] std::string at(const std::string& name) const { return (*this / name).string(); }
    [[nodiscard]] test::CommandResult run(const std::string& verb, const std::vector<std::string>& files,
                                          const std::string& flags = {}) const {
        std::string line = "annotation " + verb + " " + at("ball.ply");
        for (const auto& file : files) line += " " + at(file);
        return run_command(line + " " + flags);
    }
    [[nodiscard]] AnnotationSet read(const std::string& name) const { return read_annotations(*this / name, mesh); }
};

}  // namespace

TEST(InterchangeCommand, EveryFormatIsExportedAndImported) {
    const Folder folder;
    const std::vector<std::pair<std::string, std::string>> formats{{"t.csv", ""},      {"l.csv", "--format landmarks-csv"},
                                                                   {"l.tps", ""},      {"l.pp", ""},
                                                                   {"l.mrk.json", ""}, {"l.fcsv", ""},
                                                                   {"w.jsonld", ""},   {"f.glb", ""},
                                                                   {"p.ant", ""},      {"p.fct", ""}};
    EXPECT_EQ(formats.size(), interchange_formats().size());
    for (const auto& [file, flags] : formats) {
        const auto out = folder.run("export", {"a.ant.json", file}, flags);
        ASSERT_EQ(out.code, 0) << file << out.err;
        const std::string bytes = read_file(folder / file);
        ASSERT_EQ(folder.run("export", {"a.ant.json", file}, flags + " --threads 1 --json").code, 0);
        EXPECT_EQ(read_file(folder / file), bytes);
        EXPECT_EQ(bytes.find(folder.path().string()), std::string::npos) << "no folder in a result";
        const std::string onto = file == "t.csv" ? "--onto " + folder.at("a.ant.json") : "";
        const auto in = folder.run("import", {file, "back.ant.json"}, onto + " --json");
        ASSERT_EQ(in.code, 0) << file << in.err;
        validate(parse_json(in.out, "report"), "report", "report");
        const bool lossless = file == "t.csv" || file == "w.jsonld" || file == "f.glb";
        const auto diff = folder.run("diff", {"a.ant.json", "back.ant.json"});
        EXPECT_EQ(diff.code, lossless ? 0 : 3) << file << diff.out;
        EXPECT_EQ(diff.out.find('\x01'), std::string::npos) << "no control character reaches a terminal";
    }
}

TEST(InterchangeCommand, ImportOntoAddsWithFreeIds) {
    const Folder folder;
    ASSERT_EQ(folder.run("export", {"a.ant.json", "l.csv"}, "--format landmarks-csv").code, 0);
    ASSERT_EQ(folder.run("import", {"l.csv", "both.ant.json"}, "--onto " + folder.at("a.ant.json")).code, 0);
    const AnnotationSet before = folder.read("a.ant.json"), both = folder.read("both.ant.json");
    EXPECT_GT(both.annotations.size(), before.annotations.size());
    for (std::size_t i = 0; i < before.annotations.size(); ++i) EXPECT_EQ(both.annotations[i].id, before.annotations[i].id);
}

TEST(InterchangeCommand, BadInputLeavesOutputsAlone) {
    const Folder folder;
    (void)folder.file("out.ant.json", "old");
    const auto refused = [&](const test::CommandResult& result, int code, const std::string& text) {
        EXPECT_EQ(result.code, code) << result.err;
        EXPECT_NE(result.err.find(text), std::string::npos) << result.err;
        EXPECT_EQ(read_file(folder / "out.ant.json"), "old");
    };
    (void)folder.file("bad.pp", "<PickedPoints><point x=\"1\"");
    refused(folder.run("import", {"bad.pp", "out.ant.json"}), 1, "bad.pp, line 1");
    for (const char* name : {"no.csv", "no.fcsv", "no.pp", "no.tps", "no.mrk.json", "no.fct", "no.jsonld"}) {
        (void)folder.file(name, "");
        refused(folder.run("import", {name, "out.ant.json"}), 1, std::string(name) + ": is empty");
    }
    (void)folder.file("no.pp", "<PickedPoints></PickedPoints>");
    refused(folder.run("import", {"no.pp", "out.ant.json"}), 1, "no.pp: contains no landmarks");
    (void)folder.file("no.csv", "name,x,y,z\n");
    refused(folder.run("import", {"no.csv", "out.ant.json"}), 1, "no.csv: contains no landmarks");
    (void)folder.file("no.fcsv", "# CoordinateSystem = LPS\n");
    refused(folder.run("import", {"no.fcsv", "out.ant.json"}), 1, "no.fcsv: contains no landmarks");
    (void)folder.file("flat.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n");
    (void)folder.file("one.csv", "name,x,y,z\na,0,0,0\n");
    const auto flat =
        run_command("annotation import " + folder.at("flat.off") + " " + folder.at("one.csv") + " " + folder.at("out.ant.json"));
    refused(flat, 1, folder.at("flat.off") + ": has no face with an area");
    (void)folder.file("far.csv", "name,x,y,z\nnose,50,0,0\n");
    refused(folder.run("import", {"far.csv", "out.ant.json"}), 1, "'nose'");
    refused(folder.run("import", {"far.csv", "out.ant.json"}, "--tolerance 2"), 2, "tolerance");
    (void)folder.file("x.odd", "1");
    refused(folder.run("import", {"x.odd", "out.ant.json"}), 2, "--format");
    ASSERT_EQ(folder.run("export", {"a.ant.json", "t.csv"}).code, 0);
    refused(folder.run("import", {"t.csv", "out.ant.json"}), 2, "--onto");
    refused(folder.run("export", {"a.ant.json", "a.ant.json"}, "--format web"), 2, "a.ant.json");
    refused(folder.run("edit", {"a.ant.json", "out.ant.json"}), 2, "--annotation");
    refused(folder.run("edit", {"a.ant.json", "out.ant.json"}, "--annotation none"), 1, "'none'");
    refused(folder.run("edit", {"a.ant.json", "out.ant.json"}, "--annotation 3 --colour red"), 2, "red");
}

TEST(InterchangeCommand, EditByFlagsAndByList) {
    const Folder folder;
    const auto flags = folder.run("edit", {"a.ant.json", "b.ant.json"},
                                  "--annotation 3 --tag '<new>' --colour '#ff0010' --attribute 'age=old, \"very\"' --json");
    ASSERT_EQ(flags.code, 0) << flags.err;
    const AnnotationSet edited = folder.read("b.ant.json");
    EXPECT_EQ(edited.find(3)->tag, "<new>");
    EXPECT_EQ(edited.find(3)->colour, (std::array<int, 3>{255, 0, 16}));
    EXPECT_EQ(edited.find(3)->attributes.back().note()->text, "old, \"very\"");
    // An option given twice leaves a file that can be read.
    ASSERT_EQ(folder.run("edit", {"a.ant.json", "twice.ant.json"}, "--annotation 3 --attribute a=1 --attribute b=2").code, 0);
    EXPECT_EQ(folder.read("twice.ant.json").find(3)->attributes.back().note()->text, "2");
    (void)folder.file("e.json",
                      R"({"format": "ostraka-annotation-edits", "edits": [{"annotation": "two patches", "split": true}]})");
    const auto list = folder.run("edit", {"a.ant.json", "c.ant.json"}, "--edits " + folder.at("e.json"));
    ASSERT_EQ(list.code, 0) << list.err;
    EXPECT_EQ(folder.read("c.ant.json").annotations.size(), folder.read("a.ant.json").annotations.size() + 1);
    EXPECT_NE(list.out.find("added"), std::string::npos) << list.out;
}

TEST(InterchangeCommand, EditOfClassUnitAndUp) {
    const Folder folder;
    AnnotationSet set;
    set.unit = "mm";
    Annotation& cap = set.annotations.emplace_back();
    cap.tag = "cap";
    cap.faces = {0, 1, 2};
    const auto descriptor = [&](int id, const char* name, const char* unit) {
        Attribute attribute;
        attribute.id = id;
        attribute.name = name;
        attribute.value = Descriptor{{2}, false, "", unit, false};
        cap.attributes.push_back(attribute);
    };
    descriptor(0, "area", "mm^2");
    descriptor(1, "bend", "1/mm");
    descriptor(2, "weight", "g");
    folder.write(set, "m.ant.json");
    const auto edited = folder.run("edit", {"m.ant.json", "n.ant.json"}, "--set-class jar --set-unit cm --set-up=0,0,-1");
    ASSERT_EQ(edited.code, 0) << edited.err;
    EXPECT_NE(edited.out.find("jar"), std::string::npos) << edited.out;
    const AnnotationSet after = folder.read("n.ant.json");
    EXPECT_EQ(after.object_class, "jar");
    EXPECT_EQ(after.unit, "cm");
    EXPECT_EQ(*after.up, (std::array<double, 3>{0, 0, -1}));
    const auto& attributes = after.annotations.at(0).attributes;
    EXPECT_EQ(attributes.at(0).descriptor()->unit, "cm^2");
    EXPECT_EQ(attributes.at(1).descriptor()->unit, "1/cm");
    EXPECT_EQ(attributes.at(2).descriptor()->unit, "g");
    EXPECT_EQ(attributes.at(0).descriptor()->values.at(0), 2) << "no number changes";
    ASSERT_EQ(folder.run("edit", {"n.ant.json", "o.ant.json"}, "--set-unit '' --annotation cap --tag lid").code, 0);
    const AnnotationSet bare = folder.read("o.ant.json");
    EXPECT_EQ(bare.unit, "");
    EXPECT_EQ(bare.annotations.at(0).tag, "lid");
    EXPECT_EQ(bare.annotations.at(0).attributes.at(0).descriptor()->unit, "");
    EXPECT_EQ(folder.run("edit", {"n.ant.json", "p.ant.json"}, "--set-up=0,0,0").code, 2);
    EXPECT_EQ(folder.run("edit", {"n.ant.json", "p.ant.json"}, "--set-up=0,0").code, 2);
    EXPECT_FALSE(std::filesystem::exists(folder / "p.ant.json"));
}

TEST(InterchangeCommand, WrittenAnnotationsAreCounted) {
    const Folder folder;
    AnnotationSet set;
    set.unit = "mm";
    const auto add = [&](AnnotationType type, const char* tag) -> Annotation& {
        Annotation& annotation = set.annotations.emplace_back();
        annotation.id = static_cast<int>(set.annotations.size());
        annotation.type = type;
        annotation.tag = tag;
        annotation.attributes = {semantic(0, "note", tag)};
        return annotation;
    };
    add(AnnotationType::region, "cap").faces = {0, 1};
    add(AnnotationType::point, "tip").points = {3};
    const Vertex from = folder.mesh.source(Halfedge(0)), to = folder.mesh.target(Halfedge(0));
    add(AnnotationType::line, "rim").polylines = {{Index(from), Index(to)}};
    folder.write(set, "m.ant.json");
    const auto exported = [&](const std::string& file, const std::string& flags = "") {
        const auto result = folder.run("export", {"m.ant.json", file}, flags);
        EXPECT_EQ(result.code, 0) << file << result.err;
        return result.out + result.err;
    };
    for (const auto& [file, flags] :
         {std::pair{"l.csv", "--format landmarks-csv"}, {"l.tps", ""}, {"l.pp", ""}, {"l.fcsv", ""}}) {
        const std::string text = exported(file, flags);
        EXPECT_EQ(text.find("1 of 3 annotations as "), 0U) << text;
        EXPECT_NE(text.find("1 attribute left out"), std::string::npos) << "that of the point alone: " << text;
        EXPECT_NE(text.find("1 poly-line left out"), std::string::npos) << text;
    }
    const std::string markups = exported("l.mrk.json");
    EXPECT_EQ(markups.find("2 of 3 annotations as mrk"), 0U) << markups;
    EXPECT_NE(markups.find("2 attributes left out"), std::string::npos) << markups;
    EXPECT_EQ(exported("l.fct").find("1 of 3 annotations as fct"), 0U);
    EXPECT_EQ(exported("l.jsonld").find("3 annotations as web"), 0U);
    const auto report = folder.run("export", {"m.ant.json", "l.tps"}, "--json");
    EXPECT_EQ(parse_json(report.out, "report")["result"]["annotations"].GetInt(), 1);
}

TEST(InterchangeCommand, TablesKeepLongTexts) {
    const Folder folder;
    const std::string text = std::string(150, 'x') + "end";
    const auto edited = folder.run("edit", {"a.ant.json", "b.ant.json"}, "--annotation 3 --attribute note=" + text);
    ASSERT_EQ(edited.code, 0) << edited.err;
    EXPECT_NE(edited.out.find(text), std::string::npos) << edited.out;
    EXPECT_NE(folder.run("list", {"b.ant.json"}).out.find(text), std::string::npos);
    // A long cell does not widen other rows.
    const auto tagged = folder.run("edit", {"a.ant.json", "c.ant.json"}, "--annotation 3 --tag " + text + text);
    const auto list = folder.run("list", {"c.ant.json"});
    EXPECT_NE(list.out.find(text + text), std::string::npos);
    EXPECT_LT(list.out.find('\n'), 250U) << "the header keeps its width";
}

TEST(InterchangeCommand, DiffAndMerge) {
    const Folder folder;
    EXPECT_EQ(folder.run("diff", {"a.ant.json", "a.ant.json"}).code, 0);
    ASSERT_EQ(folder.run("edit", {"a.ant.json", "ours.ant.json"}, "--annotation 3 --tag ours").code, 0);
    ASSERT_EQ(folder.run("edit", {"a.ant.json", "theirs.ant.json"}, "--annotation 3 --colour 1,2,3").code, 0);
    const auto diff = folder.run("diff", {"a.ant.json", "ours.ant.json"}, "--json");
    EXPECT_EQ(diff.code, 3);
    const Json report = parse_json(diff.out, "report");
    ASSERT_EQ(report["result"]["differences"].Size(), 1U);
    EXPECT_STREQ(report["result"]["differences"][0]["field"].GetString(), "tag");
    const auto merged = folder.run("merge", {"a.ant.json", "ours.ant.json", "theirs.ant.json", "m.ant.json"});
    ASSERT_EQ(merged.code, 0) << merged.err;
    EXPECT_EQ(folder.read("m.ant.json").find(3)->tag, "ours");
    EXPECT_EQ(folder.read("m.ant.json").find(3)->colour, (std::array<int, 3>{1, 2, 3}));
    ASSERT_EQ(folder.run("edit", {"a.ant.json", "theirs.ant.json"}, "--annotation 3 --tag theirs").code, 0);
    const auto conflict = folder.run("merge", {"a.ant.json", "ours.ant.json", "theirs.ant.json", "n.ant.json"});
    EXPECT_EQ(conflict.code, 3);
    EXPECT_NE(conflict.out.find("1 conflict"), std::string::npos) << conflict.out;
    EXPECT_EQ(conflict.out.find("--renumber"), std::string::npos) << conflict.out;
    EXPECT_FALSE(std::filesystem::exists(folder / "n.ant.json"));
    // Two annotations with one id: the remedy is named.
    for (const char* name : {"ours", "theirs"}) {
        const std::string file = std::string(name) + "2.ant.json";
        ASSERT_EQ(
            folder.run("edit", {"a.ant.json", file}, "--annotation 3 --duplicate --id 9977 --tag " + std::string(name)).code, 0);
    }
    const auto twice = folder.run("merge", {"a.ant.json", "ours2.ant.json", "theirs2.ant.json", "n.ant.json"});
    EXPECT_EQ(twice.code, 3);
    EXPECT_NE(twice.out.find("--renumber keeps both"), std::string::npos) << twice.out;
    EXPECT_EQ(folder.run("merge", {"a.ant.json", "ours2.ant.json", "theirs2.ant.json", "both.ant.json"}, "--renumber").code, 0);
    EXPECT_EQ(folder.read("both.ant.json").annotations.size(), folder.read("a.ant.json").annotations.size() + 2);
    ASSERT_EQ(folder.run("merge", {"a.ant.json", "ours.ant.json", "theirs.ant.json", "n.ant.json"}, "--prefer theirs").code, 0);
    EXPECT_EQ(folder.read("n.ant.json").find(3)->tag, "theirs");
}

TEST(InterchangeCommand, RealSkullsWithTheirLandmarks) {
    const Path data = Path(OSTRAKA_SHARED_DATA) / "landmarks-mouse-skulls";
    if (!std::filesystem::exists(data)) GTEST_SKIP() << "no real landmarks: " << data << " is not there";
    const Scratch scratch;
    for (const std::string name : {"PWK", "LEWES"}) {
        // The scans are not manifold: landmarks are imported onto the repaired meshes.
        const std::string mesh = (scratch / (name + ".ply")).string(), source = (data / (name + ".ply")).string(),
                          points = (data / "LMs" / (name + ".mrk.json")).string(), out = (scratch / "a.ant.json").string();
        (void)run_command("mesh repair " + source + " " + mesh);
        ASSERT_TRUE(std::filesystem::exists(mesh));
        const auto result = run_command("annotation import " + mesh + " " + points + " " + out + " --json");
        ASSERT_EQ(result.code, 0) << result.err;
        const Json report = parse_json(result.out, "report");
        const JsonValue& placed = report["result"]["placed"];
        EXPECT_EQ(placed.Size(), 51U);
        double sum = 0;
        for (const auto& place : placed.GetArray()) sum += place["toVertex"].GetDouble();
        EXPECT_LT(sum / 51, 0.15) << "the data's own note says 0.10 mm on average";
        EXPECT_EQ(run_command("annotation import " + mesh + " " + points + " " + out + " --mesh-space RAS").code, 1);
        for (const std::string file : {"b.mrk.json", "b.fcsv", "b.pp", "b.tps"}) {
            const std::string other = (scratch / file).string(), back = (scratch / "b.ant.json").string();
            ASSERT_EQ(run_command("annotation export " + mesh + " " + out + " " + other).code, 0);
            ASSERT_EQ(run_command("annotation import " + mesh + " " + other + " " + back).code, 0);
            const auto diff = run_command("annotation diff " + mesh + " " + out + " " + back + " --json");
            const Json differences = parse_json(diff.out, "report");
            for (const auto& difference : differences["result"]["differences"].GetArray())
                EXPECT_STREQ(difference["field"].GetString(), "unit") << file;
        }
    }
}
