// The built command, as people run it.
#include "meshes.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/files/json.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/synthetic/make_mesh.h"
#include "scratch.h"

using namespace ostraka;
using namespace ostraka::test;

namespace {

class TransferCommand : public ::testing::Test {
protected:
    void SetUp() override {
        const Mesh source = build_mesh(octahedron_sphere(4)), target = build_mesh(octahedron_sphere(5));
        write_mesh(scratch / "s.ply", source);
        write_mesh(scratch / "t.ply", target);
        AnnotationSet set;
        Annotation cap;
        cap.tag = "cap";
        for (const Face f : source.faces())
            if (centroid(source, f).z() > 0.5) cap.faces.push_back(f);
        set.annotations.push_back(cap);
        write_annotations(scratch / "s.ant.json", {source, set}, "s.ply", {});
    }
    [[nodiscard]] std::string at(const std::string& name) const { return (scratch / name).string(); }
    [[nodiscard]] CommandResult transfer(const std::string& more, const std::string& target = "t.ply",
                                         const std::string& out = "o.ant.json", const std::string& before = {}) const {
        return run_command(
            "annotation transfer " + at("s.ply") + " " + at("s.ant.json") + " " + at(target) + " " + at(out) + " " + more,
            before);
    }
    Scratch scratch;
};

}  // namespace

TEST_F(TransferCommand, ThereAndBack) {
    const CommandResult result = transfer("--json --back " + at("b.ant.json"));
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    validate(report, "report", "report");
    const JsonValue& scores = report["result"]["annotations"];
    ASSERT_EQ(scores.Size(), 1U);
    EXPECT_STREQ(scores[0]["outcome"].GetString(), "kept");
    EXPECT_GT(scores[0]["overlap"].GetDouble(), 0.95);
    EXPECT_TRUE(report["result"].HasMember("back"));
    const Mesh source = read_mesh(at("s.ply")).mesh;
    EXPECT_EQ(read_annotations(at("b.ant.json"), source).annotations.size(), 1U);
}

TEST_F(TransferCommand, OptionsThatFreeOutlinesDoNotUseAreReported) {
    const std::string note = "free outlines, which do not depend on --rounding";
    EXPECT_NE(transfer("--outlines free --rounding area").err.find(note), std::string::npos);
    EXPECT_EQ(transfer("--outlines edges --rounding area", "t.ply", "e.ant.json").err.find(note), std::string::npos);
    EXPECT_EQ(transfer("--outlines free", "t.ply", "f.ant.json").err.find("do not depend on"), std::string::npos);
}

TEST_F(TransferCommand, RegistersMeshesWithOtherUnitsAndPoses) {
    MakeOptions options;
    options.vertices = 3000;
    const SyntheticMesh hand = make_mesh(synthetic_object("hand"), options);
    options.vertices = 6000;
    options.seed = 2;
    const SyntheticMesh finer = make_mesh(synthetic_object("hand"), options);
    Mesh target = finer.mesh;  // in metres, lying on its side far away
    for (const Vertex v : target.vertices()) {
        const Point p = target.point(v);
        target.point(v) = Point(0.001 * p.y() + 3, 0.001 * p.z() - 20, 0.001 * p.x());
    }
    AnnotationSet set;
    set.unit = "mm";
    set.up = {0, 0, 1};
    Annotation part;
    part.tag = "part";
    for (const Face f : hand.mesh.faces())
        if (centroid(hand.mesh, f).z() > 100) part.faces.push_back(f);
    ASSERT_FALSE(part.faces.empty());
    part.attributes.push_back({0, "area", Descriptor{{area_of(hand.mesh, part.faces)}, false, {}, "mm^2", false}});
    set.annotations.push_back(part);
    write_mesh(scratch / "s.ply", hand.mesh);
    write_mesh(scratch / "t.ply", target);
    write_annotations(scratch / "s.ant.json", {hand.mesh, set}, "s.ply", {});
    EXPECT_EQ(transfer("").code, 1);  // without a registration they are refused
    const CommandResult result = transfer("--register --json --back " + at("b.ant.json"));
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    EXPECT_NEAR(report["result"]["registration"]["scale"].GetDouble(), 0.001, 1e-6);
    EXPECT_GT(report["result"]["annotations"][0]["overlap"].GetDouble(), 0.95);
    const AnnotationSet transferred = read_annotations(at("o.ant.json"), target),
                        back = read_annotations(at("b.ant.json"), hand.mesh);
    EXPECT_EQ(transferred.unit, "m");
    ASSERT_TRUE(transferred.up);
    EXPECT_NEAR((*transferred.up)[1], 1, 1e-3);
    const Descriptor& area = *transferred.annotations[0].attributes[0].descriptor();
    EXPECT_EQ(area.unit, "m^2");
    EXPECT_NEAR(area.values[0], area_of(target, transferred.annotations[0].faces), 1e-12);
    EXPECT_EQ(back.unit, "mm");
    EXPECT_NEAR((*back.up)[2], 1, 1e-9);
    EXPECT_EQ(back.annotations[0].attributes[0].descriptor()->unit, "mm^2");
    EXPECT_NEAR(back.annotations[0].attributes[0].descriptor()->values[0], area_of(hand.mesh, part.faces),
                0.02 * area_of(hand.mesh, part.faces));
    // Another object is no target.
    options.vertices = 3000;
    write_mesh(scratch / "t.ply", make_mesh(synthetic_object("chair"), options).mesh);
    const CommandResult refused = transfer("--register");
    EXPECT_EQ(refused.code, 1);
    EXPECT_NE(refused.err.find("not the same object"), std::string::npos) << refused.err;
}

TEST_F(TransferCommand, SameBytesForAnyNumberOfThreads) {
    ASSERT_EQ(transfer("--threads 1", "t.ply", "one.ant.json").code, 0);
    ASSERT_EQ(transfer("--threads 2", "t.ply", "two.ant.json").code, 0);
    EXPECT_EQ(read_file(at("one.ant.json")), read_file(at("two.ant.json")));
}

TEST_F(TransferCommand, RefinesTheTarget) {
    const CommandResult result = transfer("--refine --refined-mesh " + at("r.ply") + " --map " + at("m.json"));
    ASSERT_EQ(result.code, 0) << result.err;
    const Mesh refined = read_mesh(at("r.ply")).mesh;
    EXPECT_EQ(read_annotations(at("o.ant.json"), refined).annotations.size(), 1U);
    const Json map = read_json(at("m.json"));
    EXPECT_EQ(map["map"].Size(), refined.number_of_faces());
}

TEST_F(TransferCommand, WrongUsageExitsWithTwoAndWritesNothing) {
    write_file(scratch / "o.ant.json", "earlier");
    for (const std::string& more :
         {std::string("--metric manhattan"), std::string("--refine"), "--map " + at("m.json"), std::string("--max-angle 1000"),
          "--refine --cover enclosing --refined-mesh " + at("r.ply"), "--back " + at("s.ant.json"), std::string("--nonsense")}) {
        const CommandResult result = transfer(more);
        EXPECT_EQ(result.code, 2) << more << result.err;
        EXPECT_FALSE(result.err.empty()) << more;
        EXPECT_EQ(read_file(at("o.ant.json")), "earlier") << more;
    }
}

TEST_F(TransferCommand, InvalidInputExitsWithOneNamesTheFileAndWritesNothing) {
    write_file(scratch / "o.ant.json", "earlier");
    const auto fails = [&](const CommandResult& result, const std::string& word) {
        EXPECT_EQ(result.code, 1) << result.err;
        EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
        EXPECT_EQ(read_file(at("o.ant.json")), "earlier");
    };
    fails(transfer("", "missing.ply"), "missing.ply");
    write_mesh(scratch / "big.ply", build_mesh(moved(octahedron_sphere(5), 1000, {0, 0, 0})));
    fails(transfer("", "big.ply"), "1000 times");
    write_mesh(scratch / "away.ply", build_mesh(moved(octahedron_sphere(5), 1, {9, 0, 0})));
    fails(transfer("", "away.ply"), "not aligned");
    fails(run_command("annotation transfer " + at("t.ply") + " " + at("s.ant.json") + " " + at("s.ply") + " " + at("o.ant.json")),
          "s.ant.json");
    fails(transfer("", "t.ply", "no/such/folder.json"), "folder");
    write_file(scratch / "cut.ply", read_file(at("t.ply")).substr(0, 5000));
    fails(transfer("", "cut.ply"), "cut.ply");
}

TEST_F(TransferCommand, SmallMisalignmentIsNoted) {
    const CommandResult good = transfer("");
    EXPECT_EQ(good.err.find("apart on average"), std::string::npos) << good.err;
    write_mesh(scratch / "swollen.ply", build_mesh(moved(octahedron_sphere(5), 1.05, {0, 0, 0})));
    const CommandResult result = transfer("--json --max-distance 0.1", "swollen.ply");
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.err.find("apart on average"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("scaled by 1.05"), std::string::npos) << result.err;
    EXPECT_NEAR(parse_json(result.out, "report")["result"]["meanDistance"].GetDouble(), 0.05, 0.005);
}

TEST_F(TransferCommand, FullDiskLeavesTheEarlierFile) {
    write_file(scratch / "o.ant.json", "earlier");
    const CommandResult result = transfer("", "t.ply", "o.ant.json", "ulimit -f 1;");
    EXPECT_EQ(result.code, 1) << result.err;
    EXPECT_EQ(read_file(at("o.ant.json")), "earlier");
}

TEST_F(TransferCommand, SurvivalListsEveryAnnotation) {
    const CommandResult result = run_command("annotation survival --json " + at("s.ply") + " " + at("s.ant.json"));
    ASSERT_EQ(result.code, 0) << result.err;
    const Json report = parse_json(result.out, "report");
    ASSERT_EQ(report["result"]["annotations"].Size(), 1U);
    EXPECT_LT(report["result"]["annotations"][0]["vertices"].GetUint(), 1026U);
}

TEST(TransferCommandOnScans, BunniesInOtherUnitsAreRefusedByTheirRatio) {
    const Path folder = Path(OSTRAKA_SHARED_DATA) / "multires";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no real meshes at " << folder;
    const Scratch scratch;
    // The scans are open and hold isolated vertices; repaired they can be annotated.
    const std::string small = (scratch / "small.ply").string(), large = (scratch / "large.ply").string();
    run_command("mesh repair " + (folder / "bunny10k.ply").string() + " " + small);
    run_command("mesh repair " + (folder / "bunny70k.ply").string() + " " + large);
    const Path recipe = scratch.file(
        "r.json",
        R"({"format": "ostraka-recipe", "version": 1, "frame": "box", "annotations": [{"id": 1, "tag": "left half", "colour": [9, 9, 9],
        "type": "region", "select": {"box": {"min": [0, 0, 0], "max": [0.5, 1, 1]}}}]})");
    ASSERT_EQ(run_command("annotation apply " + small + " " + recipe.string() + " " + (scratch / "a.ant.json").string()).code, 0);
    const CommandResult result = run_command("annotation transfer " + small + " " + (scratch / "a.ant.json").string() + " " +
                                             large + " " + (scratch / "o.ant.json").string());
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(result.err.find("1000"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("times as large"), std::string::npos) << result.err;
}
