#include "ostraka/reassembly/reassembly.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/reassembly/suspicious_fragments.h"
#include "ostraka/stats/random.h"
#include "scratch.h"
#include "sherds.h"

#include <set>

namespace ostraka {
namespace {

using test::synthetic_bar;
using test::synthetic_sherd;
using test::SyntheticSherd;

Motion random_motion(std::uint64_t seed) {
    Random random(seed);
    Motion motion;
    motion.rotation =
        Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal()).normalized().toRotationMatrix();
    motion.translation = 30 * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    return motion;
}

Fragment fragment_of(const SyntheticSherd& sherd, const std::string& name, const Motion& motion) {
    Fragment fragment;
    fragment.name = name;
    fragment.mesh = moved(sherd.mesh, motion);
    fragment.facets = sherd.facets;
    return fragment;
}

/// Three adjacent sherds of a pot, and the two halves of a bar, each in a random pose.
struct Mixture {
    std::vector<Fragment> fragments;
    std::vector<Motion> motions;

    Mixture() {
        add(synthetic_sherd(1, 2, 0, 1), "left");
        add(synthetic_bar(), "below");
        add(synthetic_sherd(2, 3, 1, 2), "middle");
        add(synthetic_bar(1, true), "above");
        add(synthetic_sherd(3, 4, 2, 3), "right");
    }
    /// Largest distance of a vertex of fragment k, as placed, from its true position in the frame of fragment r.
    [[nodiscard]] double error(const Reassembly& result, std::size_t r, std::size_t k) const {
        const Motion motion = motions[r].inverse().after(result.poses[r].inverse()).after(result.poses[k]);
        double farthest = 0;
        for (const Vertex v : fragments[k].mesh.vertices()) {
            const Eigen::Vector3d p = eigen(fragments[k].mesh.point(v));
            farthest = std::max(farthest, (motion(p) - motions[k].inverse()(p)).norm());
        }
        return farthest;
    }

private:
    void add(const SyntheticSherd& sherd, const std::string& name) {
        motions.push_back(random_motion(motions.size() + 1));
        fragments.push_back(fragment_of(sherd, name, motions.back()));
    }
};

ReassemblyOptions quick() {
    ReassemblyOptions options;
    options.pairs.frames = 80;
    options.pairs.samples = 600;
    options.pairs.starts = 60;
    options.pairs.refined = 10;
    return options;
}

TEST(Reassembly, TwoObjectsInOneBox) {
    const Mixture box;
    const Reassembly result = reassemble(box.fragments, quick());
    EXPECT_EQ(result.pairs_tried, 10u);
    ASSERT_EQ(result.groups(), 2);
    EXPECT_EQ(result.group[0], result.group[2]);
    EXPECT_EQ(result.group[0], result.group[4]);
    EXPECT_EQ(result.group[1], result.group[3]);
    EXPECT_NE(result.group[0], result.group[1]) << "unrelated fragments stay apart";
    EXPECT_LT(box.error(result, 2, 0), 0.1) << "of a diagonal of 9";
    EXPECT_LT(box.error(result, 2, 4), 0.1);
    for (const std::string& text : result.reasons_not_joined) EXPECT_TRUE(text.empty());
    std::set<std::pair<std::size_t, std::size_t>> tree;
    for (const FragmentJoin& join : result.joins) {
        EXPECT_EQ(result.group[join.first], result.group[join.second]);
        EXPECT_GE(join.confidence, 0.5);
        EXPECT_LE(join.confidence, 1);
        if (join.carries) tree.insert({join.first, join.second});
    }
    EXPECT_EQ(tree, (std::set<std::pair<std::size_t, std::size_t>>{{0, 2}, {1, 3}, {2, 4}}));
}

void same(const Reassembly& x, const Reassembly& y) {
    EXPECT_EQ(x.group, y.group);
    ASSERT_EQ(x.poses.size(), y.poses.size());
    for (std::size_t k = 0; k < x.poses.size(); ++k) {
        EXPECT_EQ(x.poses[k].rotation, y.poses[k].rotation);
        EXPECT_EQ(x.poses[k].translation, y.poses[k].translation);
    }
    ASSERT_EQ(x.joins.size(), y.joins.size());
    for (std::size_t k = 0; k < x.joins.size(); ++k) EXPECT_EQ(x.joins[k].confidence, y.joins[k].confidence);
}

TEST(Reassembly, WithManyFragmentsOnlyPromisingPairsAreTried) {
    const Mixture box;
    ReassemblyOptions options = quick();
    options.partners = 1;
    const int before = threads();
    set_threads(1);
    const Reassembly result = reassemble(box.fragments, options);
    set_threads(3);
    const Reassembly parallel = reassemble(box.fragments, options);
    set_threads(before);
    same(result, parallel);
    EXPECT_EQ(result.pairs_tried, 2u);
    EXPECT_EQ(result.pairs_left, 1u) << "the bars' fractures are too smooth to be distinguished among many";
    ASSERT_EQ(result.groups(), 1);
    EXPECT_EQ(result.group[0], result.group[2]);
    EXPECT_EQ(result.group[0], result.group[4]);
    for (const std::size_t bar : {1, 3})
        EXPECT_NE(result.reasons_not_joined[bar].find("smooth"), std::string::npos) << result.reasons_not_joined[bar];
    EXPECT_LT(box.error(result, 2, 0), 0.1) << "of a diagonal of 9";
    EXPECT_LT(box.error(result, 2, 4), 0.1);
}

TEST(Reassembly, ThreadsAndCachedPairsDoNotMatter) {
    std::vector<Fragment> three = Mixture().fragments;
    three = {three[1], three[2], three[3]};
    std::vector<PairResult> pairs;
    std::size_t tried = 0;
    PairMemory memory;
    memory.store = [&](const PairResult& pair, const PairOptions&) { pairs.push_back(pair), ++tried; };
    const int before = threads();
    set_threads(1);
    const Reassembly single_threaded = reassemble(three, quick(), memory);
    set_threads(3);
    const Reassembly parallel = reassemble(three, quick());
    set_threads(before);
    same(single_threaded, parallel);
    EXPECT_EQ(tried, 3u);
    memory.load = [&](std::size_t i, std::size_t j, const PairOptions&) -> std::optional<PairResult> {
        for (const PairResult& pair : pairs)
            if (pair.first == i && pair.second == j) return pair;
        return {};
    };
    same(single_threaded, reassemble(three, quick(), memory));
    EXPECT_EQ(tried, 3u) << "none was tried again";
}

TEST(Reassembly, UnjoinableFragmentsStayAloneWithAReason) {
    EXPECT_THROW(reassemble({}), Error);
    std::vector<Fragment> fragments(4);
    fragments[0] = fragment_of(synthetic_bar(), "bar", {});
    fragments[1] = fragment_of(synthetic_bar(1, true), "whole", {});
    fragments[1].facets.assign(fragments[1].facets.size(), Facet::outer);
    fragments[2].name = "nothing";
    TriangleSoup chip;
    chip.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    chip.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    fragments[3].name = "chip";
    fragments[3].mesh = build_mesh(chip);
    const Reassembly result = reassemble(fragments, quick());
    EXPECT_EQ(result.groups(), 0);
    EXPECT_EQ(result.pairs_tried, 0u);
    EXPECT_TRUE(result.joins.empty());
    EXPECT_NE(result.reasons_not_joined[0].find("no other"), std::string::npos) << result.reasons_not_joined[0];
    EXPECT_NE(result.reasons_not_joined[1].find("fracture"), std::string::npos) << result.reasons_not_joined[1];
    EXPECT_NE(result.reasons_not_joined[2].find("0 faces"), std::string::npos) << result.reasons_not_joined[2];
    EXPECT_NE(result.reasons_not_joined[3].find("4 faces"), std::string::npos) << result.reasons_not_joined[3];
    ReassemblyOptions options;
    options.min_join = 2;
    EXPECT_THROW(reassemble(fragments, options), Error);
}

TEST(SuspiciousFragments, CopiesMirrorImagesUnitsAndInsideOut) {
    const SyntheticSherd bar = synthetic_bar();
    std::vector<Fragment> fragments;
    for (int k = 0; k < 3; ++k) fragments.push_back(fragment_of(synthetic_sherd(k, k + 1, k, k + 1), std::to_string(k), {}));
    EXPECT_TRUE(suspicious_fragments(fragments).empty());
    fragments.push_back(fragment_of(synthetic_sherd(1, 2, 1, 2), "copy", random_motion(5)));
    Mesh mirrored = fragments[0].mesh;
    for (const Vertex v : mirrored.vertices()) {
        const Point p = mirrored.point(v);
        mirrored.point(v) = Point(-p.x(), p.y(), p.z());
    }
    TriangleSoup reversed = to_soup(mirrored);
    for (auto& t : reversed.triangles) std::swap(t[1], t[2]);
    fragments.push_back(fragment_of({build_mesh(reversed), fragments[0].facets}, "mirror", {}));
    Motion inch;
    inch.scale = 1 / 25.4;
    fragments.push_back(fragment_of(synthetic_sherd(6, 7, 1, 2), "inches", inch));
    reversed = to_soup(bar.mesh);
    for (auto& t : reversed.triangles) std::swap(t[1], t[2]);
    fragments.push_back(fragment_of({build_mesh(reversed), bar.facets}, "turned", {}));
    std::map<std::size_t, SuspiciousFragment> suspicious;
    for (const SuspiciousFragment& fragment : suspicious_fragments(fragments)) suspicious[fragment.fragment] = fragment;
    ASSERT_EQ(suspicious.size(), 4u);
    EXPECT_EQ(suspicious[3].text, "is a copy of 1");
    EXPECT_TRUE(suspicious[3].left_out);
    EXPECT_EQ(suspicious[4].text, "is a mirror image of 0");
    EXPECT_TRUE(suspicious[4].left_out);
    EXPECT_NE(suspicious[5].text.find("times smaller than most"), std::string::npos) << suspicious[5].text;
    EXPECT_FALSE(suspicious[5].left_out);
    EXPECT_NE(suspicious[6].text.find("inside out"), std::string::npos) << suspicious[6].text;
}

TEST(SuspiciousFragments, WallThicknessRevealsAnotherUnitWhereSizesAreSimilar) {
    std::vector<Fragment> two{fragment_of(synthetic_sherd(1, 2, 0, 1), "centimetres", {}),
                              fragment_of(synthetic_sherd(2, 3, 1, 2), "other", {})};
    const auto scaled = [&](double scale) {
        Fragment other = two[1];
        other.mesh = scaled_by(other.mesh, scale);
        return suspicious_fragments({two[0], other});
    };
    EXPECT_TRUE(suspicious_fragments(two).empty());
    EXPECT_TRUE(scaled(3).empty()) << "sherds differ";
    const double equal = std::sqrt(surface_area(two[0].mesh) / surface_area(two[1].mesh));
    const auto suspicious = scaled(6.5 * equal);
    ASSERT_EQ(suspicious.size(), 1u);
    EXPECT_NE(suspicious[0].text.find("in another unit"), std::string::npos) << suspicious[0].text;
    // Larger by the same factor with the same wall thickness: not another unit.
    for (Facet& facet : two[0].facets) facet = Facet::outer;
    EXPECT_TRUE(scaled(6.5 * equal).empty()) << "no wall thickness to compare";
}

std::string quoted(const Path& path) { return "'" + path.string() + "'"; }

TEST(AssembleCommand, RepeatsARunAndReportsAnUnreadableFile) {
    const test::Scratch scratch;
    std::filesystem::create_directory(scratch / "box");
    const Mixture box;
    const Colour red{200, 30, 30, 255};
    for (const std::size_t k : {1, 2, 3}) {
        MeshExtras extras;
        if (box.fragments[k].name == "above") extras.vertex_colours.assign(box.fragments[k].mesh.number_of_vertices(), red);
        write_mesh(scratch / "box" / (box.fragments[k].name + ".ply"), box.fragments[k].mesh, extras);
    }
    write_file(scratch / "box" / "broken.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
    const std::string small = " --frames 60 --samples 500 --starts 40 --refined 6",
                      command = "assemble " + quoted(scratch / "box") + " --output " + quoted(scratch / "out") + small;
    const auto run = test::run_command(command);
    ASSERT_EQ(run.code, 0) << run.err << run.out;
    const Json report = read_json(scratch / "out" / "assembly.json");
    validate(report, "reassembly", "assembly.json");
    ASSERT_EQ(report["groups"].Size(), 1u);
    ASSERT_EQ(report["fragments"].Size(), 4u);
    for (const auto& fragment : report["fragments"].GetArray()) {
        const std::string name = fragment["name"].GetString();
        EXPECT_EQ(fragment["group"].GetInt(), name == "above" || name == "below" ? 1 : 0) << name;
        EXPECT_EQ(fragment.HasMember("alone"), name == "middle" || name == "broken") << name;
    }
    for (const char* name : {"group-1.ply", "group-1.png", "group-1.exploded.png", "above.placed.ply", "below.placed.ply"})
        EXPECT_TRUE(std::filesystem::exists(scratch / "out" / name)) << name;
    EXPECT_FALSE(std::filesystem::exists(scratch / "out" / "middle.placed.ply"));
    EXPECT_NE(run.err.find("broken.ply"), std::string::npos) << run.err;
    EXPECT_NE(run.out.find("cannot be read: "), std::string::npos) << run.out;
    const Mesh above = read_mesh(scratch / "out" / "above.placed.ply").mesh;
    const Mesh below = read_mesh(scratch / "out" / "below.placed.ply").mesh;
    const MeshFile joined_group = read_mesh(scratch / "out" / "group-1.ply");
    EXPECT_EQ(joined_group.mesh.number_of_faces(), above.number_of_faces() + below.number_of_faces());
    const std::vector<Colour>& colours = joined_group.extras.face_colours;
    ASSERT_EQ(colours.size(), joined_group.mesh.number_of_faces());
    EXPECT_EQ(std::count(colours.begin(), colours.end(), red), static_cast<std::ptrdiff_t>(above.number_of_faces()));
    EXPECT_EQ(read_mesh(scratch / "out" / "above.placed.ply").extras.face_colours.size(), above.number_of_faces());
    EXPECT_TRUE(read_mesh(scratch / "out" / "below.placed.ply").extras.face_colours.empty());
    const auto again = test::run_command(command);
    EXPECT_EQ(again.code, 0);
    EXPECT_NE((again.out + again.err).find("3 of 3 pairs were tried by an earlier run"), std::string::npos)
        << again.out << again.err;
    Json second = read_json(scratch / "out" / "assembly.json");
    EXPECT_EQ(to_text(second["joins"]), to_text(report["joins"]));
    EXPECT_EQ(to_text(second["fragments"]), to_text(report["fragments"]));
}

TEST(AssembleCommand, TheOrderOfTheNamesAndThreadsDoNotMatter) {
    const test::Scratch scratch;
    const Mixture box;
    std::vector<std::string> files;
    for (const std::size_t k : {1, 2, 3}) {
        files.push_back(quoted(scratch / (box.fragments[k].name + ".ply")));
        write_mesh(scratch / (box.fragments[k].name + ".ply"), box.fragments[k].mesh);
    }
    const auto joins = [&](const std::string& in_order, const std::string& folder, const std::string& further) {
        const auto run = test::run_command("assemble " + in_order + " --output " + quoted(scratch / folder) +
                                           " --frames 60 --samples 500 --starts 40 --refined 6 --no-pictures" + further);
        EXPECT_EQ(run.code, 0) << run.err << run.out;
        const Json report = read_json(scratch / folder / "assembly.json");
        return to_text(report["fragments"]) + to_text(report["joins"]) + to_text(report["undone"]);
    };
    const std::string expected_joins = joins(files[0] + " " + files[1] + " " + files[2], "one", " --threads 1");
    EXPECT_EQ(joins(files[2] + " " + files[0] + " " + files[1], "two", " --threads 2"), expected_joins);
}

TEST(AssembleCommand, RejectsInvalidInput) {
    const test::Scratch scratch;
    std::filesystem::create_directory(scratch / "empty");
    write_mesh(scratch / "bar.ply", synthetic_bar().mesh);
    const std::string out = " --output " + quoted(scratch / "out");
    const auto empty = test::run_command("assemble " + quoted(scratch / "empty") + out);
    EXPECT_EQ(empty.code, 1);
    EXPECT_NE(empty.err.find("holds no mesh files"), std::string::npos) << empty.err;
    const auto single = test::run_command("assemble " + quoted(scratch / "bar.ply") + out);
    EXPECT_EQ(single.code, 2);
    EXPECT_NE(single.err.find("one fragment"), std::string::npos) << single.err;
    const auto twice = test::run_command("assemble " + quoted(scratch / "bar.ply") + " " + quoted(scratch / "bar.ply") + out);
    EXPECT_EQ(twice.code, 2);
    EXPECT_NE(twice.err.find("two fragments are called"), std::string::npos) << twice.err;
    std::filesystem::copy(scratch / "bar.ply", scratch / "copy.ply");
    const auto copies = test::run_command("assemble " + quoted(scratch / "bar.ply") + " " + quoted(scratch / "copy.ply") + out +
                                          " --no-pictures");
    EXPECT_EQ(copies.code, 3) << copies.err << copies.out;
    EXPECT_NE((copies.out + copies.err).find("is a copy of"), std::string::npos) << copies.out << copies.err;
    const auto itself = test::run_command("pair " + quoted(scratch / "bar.ply") + " " + quoted(scratch / "copy.ply") + out +
                                          " --frames 40 --samples 300 --starts 20 --refined 4");
    EXPECT_EQ(itself.code, 3) << itself.err << itself.out;
    EXPECT_NE(itself.out.find("because the second is a copy of bar"), std::string::npos) << itself.out;
    EXPECT_EQ(test::run_command("assemble " + quoted(scratch / "bar.ply") + " " + quoted(scratch / "gone.ply") + out).code, 1);
    EXPECT_EQ(test::run_command("assemble " + quoted(scratch / "bar.ply") + " --min-join 7" + out).code, 2);
}

}  // namespace
}  // namespace ostraka
