// 'ostraka cage make', 'cage check' and 'deform' as users run them.
#include "ostraka/annotation/annotation.h"
#include "ostraka/files/json.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/operations/table.h"
#include "scratch.h"

#include <CGAL/boost/graph/Euler_operations.h>
#include <gtest/gtest.h>

using namespace ostraka;
using ostraka::test::count_files;
using ostraka::test::run_command;
using ostraka::test::Scratch;

namespace {

const std::string data = OSTRAKA_SOURCE_DIR "/data/";
const std::string pot = data + "teapot.ply ", parts = data + "teapot.ant.json ";

/// A folder with a cage of the synthetic teapot and its weights.
struct Caged : Scratch {
    [[nodiscard]] std::string at(const std::string& name) const { return (*this / name).string(); }
    Caged() {
        const auto command = run_command("cage make " + pot + at("cage.ply") + " --vertices 80");
        EXPECT_EQ(command.code, 0) << command.err;
        const auto weights = run_command("cage weights " + pot + at("cage.ply") + " " + at("w.npy"));
        EXPECT_EQ(weights.code, 0) << weights.err;
        static_cast<void>(file("lift.edit.json", R"({"format": "ostraka-edit", "version": 1, "steps": [
            {"select": {"annotation": "spout", "threshold": 0.15}, "translate": [0, 0, 12]}]})"));
        const auto stated = run_command("relation add " + pot + parts + at("k.graph.json") +
                                        " --type 'same level' --annotation 7 --annotation 8 --annotation 9 --annotation 10 "
                                        "--annotation 11 --constraint --weight 20");
        EXPECT_EQ(stated.code, 0) << stated.err;
    }
    [[nodiscard]] std::string handles() const { return " --cage " + at("cage.ply") + " --weights " + at("w.npy"); }
};

}  // namespace

TEST(CageCommand, MakesAndChecks) {
    const Scratch scratch;
    const std::string cage = (scratch / "cage.ply").string();
    const auto result = run_command("cage make " + pot + cage + " --levels 120,60 --mirror auto --json");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    validate(report, "report", "report");
    EXPECT_EQ(report["result"]["cages"].Size(), 2U);
    const std::string fine = (scratch / "cage-120.ply").string(), coarse = (scratch / "cage-60.ply").string();
    EXPECT_EQ(run_command("cage check " + pot + fine).code, 0);
    EXPECT_EQ(run_command("cage check " + fine + " " + coarse).code, 0);
    const auto wrong = run_command("cage check " + coarse + " " + fine);
    EXPECT_EQ(wrong.code, 3);
    EXPECT_NE(wrong.out.find("outside near face"), std::string::npos) << wrong.out;
    const std::string first = read_file(fine);
    ASSERT_EQ(run_command("cage make " + pot + cage + " --levels 120,60 --mirror auto --threads 1").code, 0);
    EXPECT_EQ(read_file(fine), first);
}

TEST(CageCommand, CagesWithinACageAreEditedLevelByLevel) {
    const Scratch scratch;
    const auto at = [&](const std::string& name) { return (scratch / name).string(); };
    const auto result = run_command("cage make " + pot + at("cage.ply") + " --vertices 80 --annotations " + parts +
                                    "--parts spout handle --part-vertices 30 --json");
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    validate(report, "report", "report");
    const auto& cages = report["result"]["cages"];
    ASSERT_EQ(cages.Size(), 3U);
    for (rapidjson::SizeType i = 0; i < 3; ++i) EXPECT_EQ(cages[i]["level"].GetInt(), static_cast<int>(i));
    EXPECT_STREQ(cages[0]["part"].GetString(), "");
    EXPECT_STREQ(cages[1]["part"].GetString(), "spout");
    EXPECT_EQ(read_mesh(at("cage.ply")).mesh.number_of_vertices(), 140U);
    EXPECT_NE(run_command("cage check " + pot + at("cage.ply")).out.find("2 cages within the outermost"), std::string::npos);
    const auto weights = run_command("cage weights " + pot + at("cage.ply") + " " + at("w.npy"));
    ASSERT_EQ(weights.code, 0) << weights.err;
    EXPECT_NE(weights.out.find("fit for deformation"), std::string::npos);
    // The spout alone: nothing outside its cage moves.
    static_cast<void>(scratch.file("spout.edit.json", R"({"format": "ostraka-edit", "version": 1, "steps": [
        {"select": {"annotation": "spout"}, "translate": [3, 0, 2]}]})"));
    const std::string handles = " --cage " + at("cage.ply") + " --weights " + at("w.npy");
    const auto edited = run_command("deform " + pot + parts + at("spout.edit.json") + " " + at("out.ply") + handles + " --json");
    ASSERT_EQ(edited.code, 0) << edited.err << edited.out;
    const Mesh before = read_mesh(data + "teapot.ply").mesh, after = read_mesh(at("out.ply")).mesh;
    std::size_t moved = 0;
    for (const Vertex v : before.vertices()) moved += CGAL::squared_distance(before.point(v), after.point(v)) > 1e-18;
    EXPECT_GT(moved, before.number_of_vertices() / 50);
    EXPECT_LT(moved, before.number_of_vertices() / 4);
    // Levels of the whole in one file.
    const auto levels = run_command("cage make " + pot + at("levels.ply") + " --levels 120,60 --together");
    ASSERT_EQ(levels.code, 0) << levels.err;
    EXPECT_EQ(read_mesh(at("levels.ply")).mesh.number_of_vertices(), 180U);
    EXPECT_EQ(count_files(scratch.path()), 6U);  // no file for each level
    const auto moves = [&](int level) {
        static_cast<void>(scratch.file("all.edit.json", R"({"format": "ostraka-edit", "version": 1, "steps": [
            {"select": {"all": true, "level": )" + std::to_string(level) +
                                                            R"(}, "translate": [1, 0, 0]}]})"));
        EXPECT_EQ(run_command("cage edit " + at("levels.ply") + " " + at("all.edit.json") + " " + at("moved.ply")).code, 0);
        const Mesh cage = read_mesh(at("levels.ply")).mesh, to = read_mesh(at("moved.ply")).mesh;
        std::size_t count = 0;
        for (const Vertex v : cage.vertices()) count += to.point(v).x() > cage.point(v).x() + 0.5;
        return count;
    };
    EXPECT_EQ(moves(0), 180U) << "the inner one is carried along";
    EXPECT_EQ(moves(1), 120U);
}

TEST(CageCommand, OnlyASymmetryOfTheWholeMirrorsTheCage) {
    const Scratch scratch;
    const auto at = [&](const std::string& name) { return (scratch / name).string(); };
    ASSERT_EQ(run_command("cage make " + pot + at("plain.ply") + " --vertices 60 --annotations " + parts).code, 0);
    const auto with_graph = [&](const std::string& members) {
        const auto stated =
            run_command("relation add " + pot + parts + at("s.graph.json") + " --type 'mirror symmetry' " + members);
        EXPECT_EQ(stated.code, 0) << stated.err;
        const auto result = run_command("cage make " + pot + at("c.ply") + " --vertices 60 --annotations " + parts + "--graph " +
                                        at("s.graph.json"));
        EXPECT_EQ(result.code, 0) << result.err;
        return read_mesh(at("c.ply")).mesh;
    };
    const Mesh plain = read_mesh(at("plain.ply")).mesh;
    // Two flowers mirror each other in a plane that is not a symmetry plane of the pot.
    EXPECT_EQ(mesh_checksum(with_graph("--annotation 7 --annotation 8")), mesh_checksum(plain));
    EXPECT_NE(mesh_checksum(with_graph("--annotation 0")), mesh_checksum(plain));
}

TEST(CageCommand, BadInput) {
    const Scratch scratch;
    const std::string cage = (scratch / "cage.ply").string();
    const auto refused = [&](const std::string& arguments, int code, const std::string& words) {
        const auto result = run_command("cage make " + arguments);
        EXPECT_EQ(result.code, code) << arguments << result.err;
        EXPECT_NE(result.err.find(words), std::string::npos) << arguments << ": " << result.err;
    };
    refused(pot + cage + " --vertices 3", 2, "vertices");
    refused(pot + cage + " --levels 10,10", 2, "twice");
    refused(pot + cage + " --levels 10,x", 2, "levels");
    refused(pot + cage + " --mirror 1,2,3", 2, "six numbers");
    refused(pot + cage + " --mirror 0,0,0,0,0,0", 2, "normal is zero");
    refused(pot + cage + " --detail spout=4", 2, "--annotations");
    refused(pot + cage + " --annotations " + parts + "--detail nose=4", 2, "not an annotation");
    refused(pot + cage + " --parts spout", 2, "--annotations");
    refused(pot + cage + " --annotations " + parts + "--parts nose", 1, "nose");
    refused(pot + cage + " --annotations " + parts + "--parts spout --levels 100,50", 2, "--together");
    refused(pot + cage + " --annotations " + parts + "--parts spout --part-vertices 3", 2, "part-vertices");
    refused(pot + pot, 2, "input");
    EXPECT_EQ(count_files(scratch.path()), 0U);
}

TEST(DeformCommand, SatisfiesTheConstraints) {
    const Caged folder;
    const std::string base = "deform " + pot + parts + folder.at("lift.edit.json") + " ";
    const auto plain = run_command(base + folder.at("plain.ply") + folder.handles());
    EXPECT_EQ(plain.code, 0) << plain.err;
    EXPECT_NE(plain.out.find("no constraints"), std::string::npos);
    const auto result =
        run_command(base + folder.at("out.ply") + folder.handles() + " --graph " + folder.at("k.graph.json") +
                    " --annotations-out " + folder.at("out.ant.json") + " --cage-out " + folder.at("out-cage.ply") + " --json");
    ASSERT_EQ(result.code, 0) << result.err << result.out;
    const Json report = parse_json(result.out, "report");
    validate(report, "report", "report");
    const JsonValue& constraint = report["result"]["constraints"][0];
    EXPECT_STREQ(constraint["verdict"].GetString(), "holds");
    EXPECT_TRUE(constraint["used"].GetBool());
    EXPECT_EQ(constraint["residual"]["constraints"].GetInt(), 6);
    EXPECT_EQ(run_command("annotation check " + folder.at("out.ply") + " " + folder.at("out.ant.json")).code, 0);
    // The same to the bit with other threads.
    const std::string first = read_file(folder / "out.ply");
    ASSERT_EQ(
        run_command(base + folder.at("out.ply") + folder.handles() + " --graph " + folder.at("k.graph.json") + " --threads 1")
            .code,
        0);
    EXPECT_EQ(read_file(folder / "out.ply"), first);
    // With and without the cage.
    EXPECT_NE(
        run_command(base + folder.at("c.ply") + folder.handles() + " --graph " + folder.at("k.graph.json") + " --space cage")
            .code,
        1);
    EXPECT_EQ(run_command(base + folder.at("d.ply")).code, 0);
}

TEST(DeformCommand, ADeformedCageIsAnEdit) {
    const Caged folder;
    Mesh cage = read_mesh(folder.at("cage.ply")).mesh;
    for (const Vertex v : cage.vertices()) cage.point(v) = cage.point(v) + Vector(3, -2, 1);
    write_mesh(folder.at("there.obj"), cage);
    const std::string base = "deform " + pot + folder.at("there.ply") + folder.handles() + " --deformed-cage ";
    const auto moved = run_command(base + folder.at("there.obj"));
    ASSERT_EQ(moved.code, 0) << moved.err << moved.out;
    const Mesh was = read_mesh(data + "teapot.ply").mesh, is = read_mesh(folder.at("there.ply")).mesh;
    for (const Vertex v : was.vertices())
        EXPECT_LT(CGAL::squared_distance(was.point(v) + Vector(3, -2, 1), is.point(v)), 1e-16) << v;
    EXPECT_NE(run_command(base + folder.at("cage.ply")).err.find("has the shape of the cage"), std::string::npos);
    EXPECT_NE(run_command(base + data + "teapot.ply").err.find("the cage 80"), std::string::npos);
    EXPECT_EQ(run_command("deform " + pot + folder.at("x.ply") + " --deformed-cage " + folder.at("there.obj")).code, 2);
}

TEST(DeformCommand, AnInvalidCageIsReported) {
    const Caged folder;
    // One vertex of the cage is moved through the object: faces cross, and vertices of the mesh are outside.
    Mesh cage = read_mesh(folder.at("cage.ply")).mesh;
    const Mesh mesh = read_mesh(data + "teapot.ply").mesh;
    const CGAL::Bbox_3 box = bounding_box(mesh);
    const Point middle((box.xmin() + box.xmax()) / 2, (box.ymin() + box.ymax()) / 2, (box.zmin() + box.zmax()) / 2);
    cage.point(Vertex(7)) = cage.point(Vertex(7)) + 1.5 * (middle - cage.point(Vertex(7)));
    write_mesh(folder.at("bad.ply"), cage);
    const auto weights = run_command("cage weights " + pot + folder.at("bad.ply") + " " + folder.at("bad.npy") + " --json");
    EXPECT_EQ(weights.code, 3) << weights.err;
    const Json report = parse_json(weights.out, "report");
    validate(report, "report", "report");
    EXPECT_FALSE(report["result"]["holds"].GetBool());
    EXPECT_GT(report["result"]["outside"].GetInt(), 0);
    EXPECT_GT(report["result"]["cageIntersections"].GetInt(), 0);
    const auto bent = run_command("deform " + pot + parts + folder.at("lift.edit.json") + " " + folder.at("o.ply") + " --cage " +
                                  folder.at("bad.ply") + " --weights " + folder.at("bad.npy"));
    EXPECT_EQ(bent.code, 3) << bent.out;
    EXPECT_NE(bent.out.find("the cage is not fit for deformation"), std::string::npos) << bent.out;
    // An object with a hole may be treated as a solid: a note reports it.
    Mesh open = mesh;
    CGAL::Euler::remove_face(open.halfedge(Face(0)), open);
    open.collect_garbage();
    write_mesh(folder.at("open.ply"), open);
    EXPECT_NE(run_command("cage make " + folder.at("open.ply") + " " + folder.at("oc.ply")).err.find("3 border edges"),
              std::string::npos);
}

TEST(DeformCommand, EveryDocumentedConstraintCanBeStated) {
    const Scratch scratch;
    // The first column of the table in the page.
    const std::string page = read_file(Path(OSTRAKA_SOURCE_DIR) / "doc/deformation.md");
    const std::size_t begin = page.find("| type | members | parameters"), end = page.find("\n\n", begin);
    ASSERT_NE(begin, std::string::npos);
    std::vector<std::string> types;
    std::istringstream table(page.substr(begin, end - begin));
    for (std::string line; std::getline(table, line);) {
        std::string cell = line.substr(1, line.find('|', 1) - 1);
        if (const auto colon = cell.find(':'); colon != std::string::npos) cell = cell.substr(colon + 1);
        std::istringstream names(cell);
        for (std::string name; std::getline(names, name, ',');) {
            const auto first = name.find_first_not_of(" -"), last = name.find_last_not_of(" -");
            if (first != std::string::npos) types.push_back(name.substr(first, last - first + 1));
        }
    }
    types.erase(types.begin());  // the head
    EXPECT_GT(types.size(), 30U);
    for (const std::string& type : types) {
        const std::string graph = (scratch / (type + ".graph.json")).string();
        const bool has_one_member = type == "keep measure" || type == "keep position";
        const auto added = run_command("relation add " + pot + parts + "'" + graph + "' --type '" + type + "' --annotation 5" +
                                       (has_one_member ? "" : " --annotation 1") +
                                       (type == "equal attributes" ? " --attribute height" : "") + " --constraint");
        EXPECT_EQ(added.code, 0) << type << added.err;
    }
}

TEST(DeformCommand, ATemplateIsSufficientInput) {
    const Caged folder;
    const std::string package = folder.at("pot.template.json");
    const auto packed = run_command("template pack " + package + " --mesh " + pot + " --annotations " + parts + " --graph " +
                                    folder.at("k.graph.json") + " --cage " + folder.at("cage.ply") + " --coordinates " +
                                    folder.at("w.npy") + " --copy");
    ASSERT_EQ(packed.code, 0) << packed.err;
    const auto whole = run_command("deform " + package + " " + folder.at("lift.edit.json") + " " + folder.at("whole.ply") +
                                   " --cage-out " + folder.at("whole-cage.ply"));
    EXPECT_EQ(whole.code, 0) << whole.err;
    ASSERT_EQ(run_command("deform " + pot + parts + folder.at("lift.edit.json") + " " + folder.at("pieces.ply") +
                          folder.handles() + " --graph " + folder.at("k.graph.json"))
                  .code,
              0);
    // The files differ in their recorded inputs.
    EXPECT_EQ(mesh_checksum(read_mesh(folder / "whole.ply").mesh), mesh_checksum(read_mesh(folder / "pieces.ply").mesh));
    // A template without a cage is deformed by its own vertices.
    ASSERT_EQ(
        run_command("template pack " + folder.at("bare.template.json") + " --mesh " + pot + " --annotations " + parts + " --copy")
            .code,
        0);
    const auto bare = run_command("deform " + folder.at("bare.template.json") + " " + folder.at("lift.edit.json") + " " +
                                  folder.at("bare.ply"));
    EXPECT_EQ(bare.code, 0) << bare.err;
    EXPECT_EQ(run_command("deform " + folder.at("bare.template.json") + " " + folder.at("lift.edit.json") + " " +
                          folder.at("b.ply") + " --cage-out " + folder.at("c.ply"))
                  .code,
              2);
    EXPECT_EQ(run_command("deform " + pot + folder.at("lift.edit.json") + " " + folder.at("b.ply")).code, 1);
    EXPECT_EQ(run_command("deform " + folder.at("lift.edit.json")).code, 2);
}

TEST(DeformCommand, StatesAndEditedCages) {
    const Caged folder;
    static_cast<void>(folder.file("two.edit.json", R"({"format": "ostraka-edit", "version": 1, "steps": [
        {"select": {"all": true}, "translate": [1, 0, 0]}, {"select": {"cageVertices": [0, 5]}, "translate": [0, 2, 0]}]})"));
    const std::string two = folder.at("two.edit.json");
    ASSERT_EQ(run_command("deform " + pot + parts + two + " " + folder.at("out.ply") + folder.handles() + " --states").code, 0);
    const Mesh rest = read_mesh(data + "teapot.ply").mesh, first = read_mesh(folder / "out-step1.ply").mesh;
    for (const Vertex v : rest.vertices()) ASSERT_NEAR(first.point(v).x(), rest.point(v).x() + 1, 1e-9);
    EXPECT_EQ(read_file(folder / "out-step2.ply"), read_file(folder / "out.ply"));
    const auto refused = run_command("deform " + pot + parts + two + " " + folder.at("out.ply") + folder.handles() +
                                     " --states --cage-out " + folder.at("out-step2.ply"));
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("two outputs have the name"), std::string::npos) << refused.err;
    ASSERT_EQ(run_command("cage edit " + folder.at("cage.ply") + " " + two + " " + folder.at("moved.ply")).code, 0);
    const Mesh cage = read_mesh(folder / "cage.ply").mesh, moved = read_mesh(folder / "moved.ply").mesh;
    EXPECT_NEAR(moved.point(Vertex(5)).y(), cage.point(Vertex(5)).y() + 2, 1e-12);
    EXPECT_NEAR(moved.point(Vertex(6)).y(), cage.point(Vertex(6)).y(), 1e-12);
    EXPECT_EQ(run_command("cage edit " + folder.at("cage.ply") + " " + two + " " + folder.at("cage.ply")).code, 2);
}

TEST(DeformCommand, StatesInMemory) {
    Context context;
    Call call(find_operation("deform"));
    call.set_file("mesh", data + "teapot.ply");
    call.set_file("annotations", data + "teapot.ant.json");
    call.set_object("edit", Object::of(parse_json(R"({"format": "ostraka-edit", "version": 1, "steps": [
        {"select": {"all": true}, "translate": [1, 0, 0]}, {"select": {"vertices": [5]}, "translate": [0, 2, 0]}]})",
                                                  "edit")));
    call.set("states", true);
    call.want("annotations-out");
    const Report report = call.run(context);
    EXPECT_TRUE(report.result()["acceptable"].GetBool());
    const Mesh rest = read_mesh(data + "teapot.ply").mesh;
    const auto x = [&](std::size_t i) { return call.object("output", i).as<MeshFile>()->mesh.point(Vertex(5)); };
    EXPECT_NEAR(x(1).x(), rest.point(Vertex(5)).x() + 1, 1e-9);
    EXPECT_NEAR(x(1).y(), rest.point(Vertex(5)).y(), 1e-9);
    for (const std::size_t i : {0, 2}) EXPECT_NEAR(x(i).y(), rest.point(Vertex(5)).y() + 2, 1e-9);
    EXPECT_THROW(static_cast<void>(call.object("output", 3)), Error);
    EXPECT_NE(call.object("annotations-out").as<AnnotationSet>(), nullptr);
    // No edit is given; or a part is named without annotations.
    Call half(find_operation("deform"));
    half.set_file("mesh", data + "teapot.ply");
    EXPECT_THROW(static_cast<void>(half.run(context)), Error);
    half.set("stretch", "spout=1.2,x");
    EXPECT_THROW(static_cast<void>(half.run(context)), Error);
}

TEST(DeformCommand, BadInput) {
    const Caged folder;
    const std::size_t before = count_files(folder.path());
    const auto refused = [&](const std::string& arguments, int code, const std::string& words) {
        const auto result = run_command("deform " + arguments);
        EXPECT_EQ(result.code, code) << arguments << result.err;
        EXPECT_NE(result.err.find(words), std::string::npos) << arguments << ": " << result.err;
    };
    const std::string edit = folder.at("lift.edit.json") + " ", out = folder.at("out.ply") + " ";
    refused(pot + parts + edit + out + "--space cage", 2, "there is none");
    refused(pot + parts + edit + out + "--cage " + folder.at("cage.ply"), 2, "need each other");
    refused(pot + parts + parts + out, 1, "teapot.ant.json");
    refused(pot + parts + edit + data + "teapot.ply", 2, "input");
    refused(data + "vase.ply " + data + "vase.ant.json " + edit + out + folder.handles(), 1, "w.coordinates.json");
    const auto graph = [&](const std::string& constraint) {
        return "--graph " +
               folder
                   .file("bad.graph.json", R"({"format": "ostraka-graph", "version": 1, "relationships": [)" + constraint + "]}")
                   .string();
    };
    const auto stated = [&](const std::string& type, const std::string& members, const std::string& parameters) {
        return graph(R"({"id": 0, "type": ")" + type + R"(", "isDirected": false, "annotations": )" + members +
                     R"(, "isConstraint": true, "weight": 1, "constraint": )" + parameters + "}");
    };
    const std::string all = pot + parts + edit + out + folder.handles() + " ";
    refused(all + stated("proportion", "[5, 1]", R"({"minValue": 2, "maxValue": 1})"), 1, "minValue is greater");
    refused(all + stated("proportion", "[5, 1]", R"({"minValue": 1})"), 1, "maxValue is missing");
    refused(all + stated("proportion", "[7, 8]", R"({"minValue": 1, "maxValue": 2})"), 1, "no measure");
    refused(all + stated("keep shape", "[7]", R"({"mode": "soft"})"), 1, "rigid, similar, seat");
    refused(all + stated("keep shape", "[99]", "{}"), 1, "99");
    refused(all + stated("same level", "[7, 8]", R"({"direction": [0, 0, 0]})"), 1, "direction is zero");
    refused(all + stated("same level", "[7, 8]", R"({"shape": "seat"})"), 1, "'shape', which it does not know");
    refused(all + stated("same level", "[7, 8]", R"({"shapes": "seat", "bend": 2})"), 1, "bend");
    refused(all + stated("mirror symmetry", "[7]", R"({"direction": [0, 0, 1]})"), 1, "alone");
    refused(all + stated("parallel axes", "[7, 8]", "{}"), 1, "has no axis");
    refused(all + stated("plane", "[7]", R"({"minValue": -1})"), 1, "minValue");
    EXPECT_EQ(count_files(folder.path()), before + 1);  // bad.graph.json
}
