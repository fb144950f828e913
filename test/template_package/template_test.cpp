#include "ostraka/template_package/template.h"

#include "annotation/example_meshes.h"
#include "mutate.h"
#include "ostraka/core/error.h"
#include "ostraka/vocabulary/skos.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <cstring>
#include <fstream>

using namespace ostraka;
using namespace ostraka::example;
using ostraka::test::mutate;
using ostraka::test::run_command;
using ostraka::test::Scratch;

namespace {

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// A .npy file of float64.
std::string array(std::size_t rows, std::size_t columns, double value = 0.5, const std::string& type = "<f8") {
    std::string head = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" + std::to_string(rows) + ", " +
                       std::to_string(columns) + "), }";
    head.resize(118 - 1, ' ');
    head += '\n';
    std::string text = std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(118) + '\0' + head;
    for (std::size_t i = 0; i < rows * columns; ++i) text.append(reinterpret_cast<const char*>(&value), sizeof value);
    return text;
}

Annotation point_at(int id, const std::string& tag, Index vertex) {
    Annotation annotation;
    annotation.id = id;
    annotation.tag = tag;
    annotation.type = AnnotationType::point;
    annotation.points = {vertex};
    return annotation;
}

/// A ball with two eyes and a cage around it, in a folder.
struct Ball : Scratch {
    Mesh mesh = spheres(2), cage = spheres(1, {{0, 0, 0}}, 1.5);
    Ball() {
        write_mesh(*this / "ball.ply", mesh);
        write_mesh(*this / "cage.ply", cage);
        AnnotationSet set;
        set.unit = "mm";
        set.object_class = "ball";
        set.up = {0, 0, 1};
        set.annotations = {point_at(1, "eye", 3), point_at(2, "eye 2", 5)};
        ensure_root(set, mesh);
        write_annotations(*this / "ball.ant.json", {mesh, set}, "ball.ply", {});
        (void)file("ball.graph.json", R"({"format": "ostraka-graph", "version": 1, "relationships": [
            {"id": 0, "type": "same level", "isDirected": false, "annotations": [1, 2], "isConstraint": false}]})");
        (void)file("ball.vocabulary.json", R"({"format": "ostraka-vocabulary", "version": 1, "concepts": [
            {"id": "ball", "label": "ball"}, {"id": "eye", "label": "eye"}]})");
        (void)file("ball.rules.json", R"({"format": "ostraka-rules", "version": 1, "rules": [
            {"id": "two eyes", "count": {"of": "eye", "min": 2, "max": 2}},
            {"id": "level", "relation": {"of": "eye", "is": "same level", "to": "eye"}}]})");
        (void)file("ball.npy", array(mesh.number_of_vertices(), cage.number_of_vertices()));
        (void)file("ranges.json", "{}");
    }
    [[nodiscard]] std::string at(const std::string& name) const { return (*this / name).string(); }
    [[nodiscard]] std::string arguments(const std::string& output = "ball.template.json") const {
        return "template pack " + at(output) + " --mesh " + at("ball.ply") + " --annotations " + at("ball.ant.json") +
               " --graph " + at("ball.graph.json") + " --cage " + at("cage.ply") + " --coordinates " + at("ball.npy") +
               " --vocabulary " + at("ball.vocabulary.json") + " --rules " + at("ball.rules.json") + " --ranges " +
               at("ranges.json") + " --landmarks " + at("ball.ant.json") + " --class ball --unit mm --up 0,0,2";
    }
    void pack() const {
        const auto result = run_command(arguments());
        EXPECT_EQ(result.code, 0) << result.out << result.err;
    }
    /// Findings of loading after a change.
    [[nodiscard]] std::string findings(bool defects) const {
        std::string text;
        for (const Finding& finding : load_template(read_template(*this / "ball.template.json")).findings)
            if (finding.defect == defects) text += finding.where + ": " + finding.text + "\n";
        return text;
    }
    /// Without checksums, so that the effect of a change is tested.
    void forget_checksums() const {
        std::string text = read_file(*this / "ball.template.json");
        const std::size_t begin = text.find("  \"checksums\""), end = text.find("},\n", begin) + 3;
        write_file(*this / "ball.template.json", text.erase(begin, end - begin));
    }
    void replace(const std::string& name, const std::string& from, const std::string& to) const {
        std::string text = read_file(*this / name);
        const std::size_t position = text.find(from);
        ASSERT_NE(position, std::string::npos) << from;
        write_file(*this / name, text.replace(position, from.size(), to));
    }
};

}  // namespace

TEST(Template, PackedCheckedShown) {
    const Ball ball;
    ball.pack();
    const std::string first = read_file(ball / "ball.template.json");
    EXPECT_FALSE(holds(first, ball.path().string())) << "no folder in a result";
    validate(parse_json(first, "t"), "template", "t");
    ball.pack();
    EXPECT_EQ(read_file(ball / "ball.template.json"), first);
    const auto check = run_command("template check " + ball.at("ball.template.json"));
    EXPECT_EQ(check.code, 0) << check.out << check.err;
    EXPECT_TRUE(holds(check.out, "no defects"));
    const auto show = run_command("template show --json " + ball.at("ball.template.json"));
    EXPECT_EQ(show.code, 0);
    const Json report = parse_json(show.out, "report");
    validate(report, "report", "report");
    EXPECT_EQ(report["result"]["parts"].Size(), 9U);
    const Template package = load_template(read_template(ball / "ball.template.json"));
    EXPECT_TRUE(package.sound());
    ASSERT_EQ(package.entries.size(), 9U);
    EXPECT_EQ(package.entries[0].text, "66 vertices, 128 faces");
    EXPECT_EQ(package.entries[2].text, "1 relationship, 0 constraints");
    EXPECT_EQ(package.entries[3].text, "18 vertices, 32 faces, encloses the mesh");
    EXPECT_EQ(package.entries[4].text, "66 x 18");
    EXPECT_EQ(package.entries[8].text, "2 landmarks");
    EXPECT_EQ((*package.annotations->up)[2], 2) << "the template's";
}

TEST(Template, ClassUnitAndUpAreThoseOfTheAnnotations) {
    const Ball ball;
    const std::string pack = "template pack " + ball.at("bare.template.json") + " --mesh " + ball.at("ball.ply") +
                             " --annotations " + ball.at("ball.ant.json");
    const auto packed = run_command(pack);
    ASSERT_EQ(packed.code, 0) << packed.out << packed.err;
    EXPECT_TRUE(holds(packed.out, "ball, in mm")) << packed.out;
    const TemplateFile file = read_template(ball / "bare.template.json");
    EXPECT_EQ(file.object_class, "ball");
    EXPECT_EQ(file.unit, "mm");
    ASSERT_TRUE(file.up);
    EXPECT_EQ((*file.up)[2], 1);
    const std::string before = read_file(ball / "bare.template.json");
    const auto with_other_unit = run_command(pack + " --unit cm");
    EXPECT_EQ(with_other_unit.code, 3);
    EXPECT_TRUE(holds(with_other_unit.out, "a mesh has only one unit")) << with_other_unit.out;
    EXPECT_EQ(read_file(ball / "bare.template.json"), before);
    EXPECT_EQ(run_command(pack + " --class globe").code, 0) << "another class is a remark";
    EXPECT_EQ(read_template(ball / "bare.template.json").object_class, "globe");
}

TEST(Template, TheFolderMayMove) {
    const Ball ball;
    ball.pack();
    const Scratch other;
    std::filesystem::copy(ball.path(), other.path() / "elsewhere", std::filesystem::copy_options::recursive);
    EXPECT_EQ(run_command("template check " + (other / "elsewhere/ball.template.json").string()).code, 0);
    const auto here = run_command("template check ball.template.json", "cd " + (other / "elsewhere").string() + " &&");
    EXPECT_EQ(here.code, 0) << here.err << here.out;
}

TEST(Template, EachInconsistentPartIsReported) {
    const auto after = [](auto&& change, bool defects = true) {
        const Ball ball;
        ball.pack();
        ball.forget_checksums();
        EXPECT_EQ(ball.findings(true), "");
        change(ball);
        return ball.findings(defects);
    };
    const auto text = [](const std::string& name, const std::string& from, const std::string& to) {
        return [=](const Ball& ball) { ball.replace(name, from, to); };
    };
    EXPECT_TRUE(holds(after([](const Ball& b) { std::filesystem::remove(b / "cage.ply"); }), "cage.ply: cannot be opened"));
    EXPECT_TRUE(holds(after([](const Ball& b) { write_file(b / "ball.ply", "not a mesh"); }), "ball.ply: "));
    EXPECT_TRUE(holds(after([](const Ball& b) { write_mesh(b / "ball.ply", spheres(3)); }),
                      "ball.ant.json: at /mesh: made for another mesh"));
    EXPECT_TRUE(holds(after([](const Ball& b) { write_mesh(b / "ball.ply", spheres(3)); }),
                      "ball.npy: the coordinates have 66 rows, but the mesh has 258"));
    EXPECT_TRUE(holds(after(text("ball.graph.json", "[1, 2]", "[1, 7]")), "ball.graph.json: "));
    EXPECT_TRUE(holds(after(text("ball.vocabulary.json", "\"id\": \"eye\", \"label\": \"eye\"", "\"id\": \"eyes\"")),
                      "ball.ant.json: at /annotations/1/tag: the tag 'eye' is not in the vocabulary: did you mean 'eyes'?"));
    EXPECT_TRUE(holds(after(text("ball.vocabulary.json", "\"id\": \"eye\"", "\"id\": \"ball\"")),
                      "ball.vocabulary.json: at /concepts/1/id"));
    EXPECT_TRUE(holds(after(text("ball.rules.json", "\"min\": 2, \"max\": 2", "\"min\": 3")),
                      "ball.ant.json: rule 'two eyes': there must be at least 3"));
    EXPECT_TRUE(holds(after(text("ball.graph.json", "same level", "adjacency")), "rule 'level': 'eye' (id 1)"));
    EXPECT_TRUE(holds(after([](const Ball& b) { write_mesh(b / "cage.ply", grid(3)); }), "cage.ply: the cage is not closed"));
    EXPECT_TRUE(holds(after([](const Ball& b) { write_file(b / "ball.npy", array(66, 17)); }),
                      "ball.npy: the coordinates have 17 columns"));
    EXPECT_TRUE(holds(after([](const Ball& b) { write_file(b / "ball.npy", array(66, 32)); }).append("none"), "none"))
        << "columns are the faces of the cage";
    EXPECT_TRUE(holds(after([](const Ball& b) { write_file(b / "ball.npy", array(66, 18, 0.5, "<f4")); }), "float64"));
    EXPECT_TRUE(holds(after([](const Ball& b) { write_file(b / "ball.npy", array(66, 18, std::nan(""))); }), "not finite"));
    EXPECT_TRUE(holds(after([](const Ball& b) { write_file(b / "ball.npy", array(66, 18).substr(0, 1000)); }),
                      "does not match the size"));
    EXPECT_TRUE(holds(after([](const Ball& b) { write_file(b / "ranges.json", "{"); }), "ranges.json: line 1"));
    // Contradictions that are not defects.
    EXPECT_TRUE(holds(after(text("ball.template.json", "\"unit\": \"mm\"", "\"unit\": \"cm\"")),
                      "the unit of the annotations is 'mm', that of the template 'cm': a mesh has only one unit"));
    EXPECT_TRUE(holds(after(text("ball.template.json", "\"up\": [0.0, 0.0, 2.0]", "\"up\": [0, 1, 0]"), false),
                      "the upward direction of the annotations is (0, 0, 1), that of the template (0, 1, 0)"));
    EXPECT_TRUE(holds(after(text("ball.template.json", "\"class\": \"ball\"", "\"class\": \"globe\""), false),
                      "'globe' is not a concept"));
    EXPECT_TRUE(holds(after(
                          [](const Ball& b) {
                              write_mesh(b / "cage.ply", spheres(1, {{1, 0, 0}}, 1.5));
                          },
                          false),
                      "the cage does not enclose the mesh: "));
}

TEST(Template, ChecksumsRevealChangedFiles) {
    const Ball ball;
    ball.pack();
    write_file(ball / "ranges.json", "{\"changed\": true}");
    EXPECT_EQ(ball.findings(true), "ranges.json: the file has changed since the template was packed (its checksum differs)\n");
    const auto check = run_command("template check " + ball.at("ball.template.json"));
    EXPECT_EQ(check.code, 3);
    EXPECT_TRUE(holds(check.out, "checksum differs"));
}

TEST(Template, PartsStayInItsFolder) {
    const Ball ball;
    std::filesystem::create_directory(ball / "inner");
    const std::string file = ball.at("inner/t.template.json");
    const auto with = [&](const std::string& mesh, const std::string& options = {}) {
        write_file(file, R"({"format": "ostraka-template", "version": 1, "mesh": ")" + mesh + "\"}");
        return run_command("template check " + file + options);
    };
    for (const std::string& mesh :
         {std::string("../ball.ply"), ball.at("ball.ply"), std::string("x/../../ball.ply"), std::string("link.ply")}) {
        if (mesh == "link.ply") std::filesystem::create_symlink(ball / "ball.ply", ball / "inner/link.ply");
        const auto refused = with(mesh);
        EXPECT_EQ(refused.code, 1) << mesh;
        EXPECT_TRUE(holds(refused.err, "t.template.json: at /mesh: '")) << refused.err;
        EXPECT_TRUE(holds(refused.err, "--allow-outside")) << refused.err;
    }
    EXPECT_EQ(with("../ball.ply", " --allow-outside").code, 0);
    // Arrays named by attributes are kept as well, and a pipe is not a valid file.
    AnnotationSet set = read_annotations(ball / "ball.ant.json", ball.mesh);
    for (const std::string& name : {std::string("../secret.npy"), ball.at("cage.ply"), std::string("cage.ply")}) {
        set.annotations[0].attributes.resize(1);
        set.annotations[0].attributes[0].name = "map";
        set.annotations[0].attributes[0].value = Descriptor();
        set.annotations[0].attributes[0].descriptor()->file = name;
        write_annotations(ball / "o.ant.json", {ball.mesh, set}, "ball.ply", {});
        write_file(ball / "o.template.json",
                   R"({"format": "ostraka-template", "version": 1, "mesh": "ball.ply", "annotations": "o.ant.json"})");
        const auto checked = run_command("template check " + ball.at("o.template.json"));
        EXPECT_EQ(checked.code, name == "cage.ply" ? 0 : 3) << checked.out << checked.err;
        EXPECT_EQ(run_command("template check " + ball.at("o.template.json") + " --allow-outside").code, 0);
    }
    ASSERT_EQ(::mkfifo((ball / "inner/pipe.ply").c_str(), 0600), 0);
    const auto piped = with("pipe.ply");
    EXPECT_EQ(piped.code, 3) << piped.err;
    EXPECT_TRUE(holds(piped.out, "is a pipe")) << piped.out;
    // Packing from elsewhere: refused, allowed, or copied.
    const std::string pack = "template pack " + ball.at("inner/p.template.json") + " --mesh " + ball.at("ball.ply") +
                             " --annotations " + ball.at("ball.ant.json");
    EXPECT_EQ(run_command(pack).code, 1);
    EXPECT_FALSE(std::filesystem::exists(ball / "inner/p.template.json"));
    EXPECT_EQ(run_command(pack + " --allow-outside").code, 0);
    EXPECT_TRUE(holds(read_file(ball / "inner/p.template.json"), "\"../ball.ply\""));
    EXPECT_EQ(run_command(pack + " --copy").code, 0);
    EXPECT_TRUE(holds(read_file(ball / "inner/p.template.json"), "\"ball.ply\""));
    EXPECT_EQ(read_file(ball / "inner/ball.ply"), read_file(ball / "ball.ply"));
    EXPECT_EQ(run_command("template check " + ball.at("inner/p.template.json")).code, 0);
    // A copy never replaces an input.
    EXPECT_EQ(run_command(pack + " --copy --landmarks " + ball.at("inner/ball.ply")).code, 2);
}

TEST(Template, NothingIsWrittenIfThePartsAreInconsistent) {
    const Ball ball;
    (void)ball.file("ball.template.json", "earlier");
    ball.replace("ball.vocabulary.json", "\"id\": \"eye\", \"label\": \"eye\"", "\"id\": \"ear\"");
    const auto result = run_command(ball.arguments());
    EXPECT_EQ(result.code, 3);
    EXPECT_TRUE(holds(result.out, "the tag 'eye' is not in the vocabulary")) << result.out;
    EXPECT_EQ(read_file(ball / "ball.template.json"), "earlier");
    EXPECT_EQ(run_command("template pack " + ball.at("x.template.json")).code, 2) << "no mesh";
    EXPECT_EQ(run_command("template pack " + ball.at("x.template.json") + " --mesh " + ball.at("none.ply")).code, 1);
    EXPECT_EQ(run_command("template pack " + ball.at("ball.ply") + " --mesh " + ball.at("ball.ply")).code, 2);
    EXPECT_EQ(run_command("template pack " + ball.at("x.template.json") + " --mesh " + ball.at("ball.ply") + " --up 0,0,0").code,
              2);
}

TEST(Template, DamagedFiles) {
    const Ball ball;
    ball.pack();
    const std::string text = read_file(ball / "ball.template.json");
    std::size_t sound = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        try {
            const TemplateFile file = template_from_json(parse_json(mutate(text, seed), "t"), ball.path(), "t");
            sound += load_template(file).sound();
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
        }
    }
    EXPECT_LT(sound, 200U);
    // Damaged arrays, in a template of mesh, cage and coordinates.
    const TemplateFile bare = template_from_json(
        parse_json(
            R"({"format": "ostraka-template", "version": 1, "mesh": "ball.ply", "cage": "cage.ply", "coordinates": "damaged.npy"})",
            "t"),
        ball.path(), "t");
    const std::string matrix = array(66, 18);
    sound = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const std::string head = mutate(matrix.substr(0, 128), seed);
        std::ofstream(ball / "damaged.npy", std::ios::binary) << head + matrix.substr(128);
        sound += load_template(bare).sound();
    }
    EXPECT_LT(sound, 200U);
}
