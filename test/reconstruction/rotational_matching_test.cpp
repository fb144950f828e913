#include "ostraka/fracture/rotational_matching.h"

#include "meshes.h"
#include "sherds.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/reconstruction/open_rotations.h"
#include "ostraka/stats/random.h"
#include "shatter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ostraka {
namespace {

using Eigen::Vector3d;

constexpr double degree = std::numbers::pi / 180;

PotOptions small_pot(std::uint64_t shape) {
    PotOptions options;
    options.shape = shape;
    options.edge = 0.5;
    return options;
}

/// Sherds of a synthetic pot, each rotated about the axis at random and slightly displaced, as after a search.
struct BrokenPot {
    Mesh vessel;
    std::vector<Fragment> fragments;
    std::vector<SherdOnAxis> sherds;
    Motion frame;  ///< of everything

    BrokenPot(const PotOptions& pot, const ShatterOptions& breaking, double noise = 0.003, Motion placement = {})
        : frame(placement) {
        const Mesh upright = make_pot(pot);
        vessel = moved(upright, frame);
        std::vector<Sherd> pieces = shatter(upright, breaking);
        fragments.resize(pieces.size());
        Random random(breaking.seed, 21);
        for (std::size_t k = 0; k < pieces.size(); ++k) add(k, pieces[k], pot, noise, random);
    }
    void add(std::size_t k, const Sherd& piece, const PotOptions& pot, double noise, Random& random) {
        Fragment& fragment = fragments[k];
        fragment.name = std::to_string(k + 1);
        for (const Face f : piece.mesh.faces()) {
            const Vector3d n = eigen(area_vector(piece.mesh, f)), p = eigen(centroid(piece.mesh, f));
            const bool floor = p.z() < 1.2 * pot.wall, out = floor ? n.z() < 0 : n.head<2>().dot(p.head<2>()) > 0;
            fragment.facets.push_back(piece.broken[f] ? Facet::fracture : out ? Facet::outer : Facet::inner);
        }
        fragment.mesh = moved(piece.mesh, frame);
        Motion rotated, lean, back = frame.inverse();
        rotated.rotation = Eigen::AngleAxisd(random.uniform(-3, 3), Vector3d::UnitZ()).toRotationMatrix();
        lean.rotation = Eigen::AngleAxisd(noise * random.normal(), Vector3d(random.normal(), random.normal(), 0).normalized())
                            .toRotationMatrix();
        lean.translation = noise * pot.height * Vector3d(random.normal(), random.normal(), random.normal()) / 3;
        sherds.push_back({&fragments[k], frame.after(rotated.after(lean)).after(back), false});
    }
    [[nodiscard]] RotationMatch match(const RotationMatchOptions& options = {}) const {
        return match_rotations(vessel, frame(Vector3d::Zero()), frame.rotation * Vector3d::UnitZ(), sherds, options);
    }
    /// Root mean square distance of the second sherd's vertices from their true position relative to the first.
    [[nodiscard]] double displacement(const RotationMatch& result, int a, int b) const {
        const Motion between =
            result.poses[static_cast<std::size_t>(a)].inverse().after(result.poses[static_cast<std::size_t>(b)]);
        const Mesh& mesh = fragments[static_cast<std::size_t>(b)].mesh;
        double squares = 0;
        for (const Vertex v : mesh.vertices()) squares += (between(eigen(mesh.point(v))) - eigen(mesh.point(v))).squaredNorm();
        return std::sqrt(squares / static_cast<double>(mesh.number_of_vertices()));
    }
};

ShatterOptions breaking(std::uint64_t seed, int pieces = 5) {
    ShatterOptions options;
    options.seed = seed;
    options.pieces = pieces;
    return options;
}

void expect_together(const BrokenPot& pot, const RotationMatch& result) {
    for (std::size_t k = 0; k < pot.sherds.size(); ++k) {
        EXPECT_EQ(result.group[k], result.group[0]) << "sherd " << k + 1 << ": " << result.notes[k];
        EXPECT_LT(result.overlap[k], 0.03);
    }
    std::size_t carry = 0;
    for (const FractureJoint& joint : result.joints) {
        carry += joint.carries ? 1 : 0;
        // To within the wall thickness: the given poses are off by a third of it.
        if (!joint.decided) continue;
        EXPECT_LT(pot.displacement(result, joint.first, joint.second), result.wall);
    }
    EXPECT_EQ(carry + 1, pot.sherds.size()) << "a tree";
}

TEST(RotationMatch, SherdsOfAPotAreAssembled) {
    for (const std::uint64_t seed : {1, 2}) {
        const BrokenPot pot(small_pot(seed), breaking(seed));
        const RotationMatch result = pot.match();
        expect_together(pot, result);
        EXPECT_NEAR(result.wall, 0.6, 0.2);
    }
}

TEST(RotationMatch, AssemblesWornAndNoisySherds) {
    ShatterOptions worn = breaking(3);
    worn.erosion = 0.002;
    worn.noise = 0.0005;
    const BrokenPot pot(small_pot(3), worn);
    expect_together(pot, pot.match());
}

TEST(RotationMatch, DoesNotDependOnPoseOrUnit) {
    Motion far;
    far.rotation = Eigen::AngleAxisd(1.1, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    far.translation = Vector3d(300, -200, 500);
    const BrokenPot pot(small_pot(1), breaking(1)), far_pot(small_pot(1), breaking(1), 0.003, far);
    expect_together(far_pot, far_pot.match());
    PotOptions tiny = small_pot(1);
    tiny.height *= 1e-3, tiny.radius *= 1e-3, tiny.wall *= 1e-3, tiny.edge *= 1e-3;
    const BrokenPot small(tiny, breaking(1));
    expect_together(small, small.match());
}

TEST(RotationMatch, IsTheSameForAnyNumberOfThreads) {
    const BrokenPot pot(small_pot(2), breaking(2, 4));
    const int before = threads();
    set_threads(1);
    const RotationMatch single_threaded = pot.match();
    set_threads(3);
    const RotationMatch three = pot.match();
    set_threads(before);
    ASSERT_EQ(single_threaded.poses.size(), three.poses.size());
    for (std::size_t k = 0; k < single_threaded.poses.size(); ++k) {
        EXPECT_EQ(single_threaded.poses[k].rotation, three.poses[k].rotation);
        EXPECT_EQ(single_threaded.poses[k].translation, three.poses[k].translation);
    }
}

TEST(RotationMatch, FixedSherdsStay) {
    BrokenPot pot(small_pot(1), breaking(1));
    pot.sherds[1].fixed = true;
    const RotationMatch result = pot.match();
    EXPECT_LT((result.poses[1].rotation - pot.sherds[1].pose.rotation).norm(), 1e-9);
    expect_together(pot, result);
}

TEST(RotationMatch, AnUnrelatedSherdIsReportedAndOverlapsNothing) {
    const PotOptions shape = small_pot(4);
    BrokenPot pot(shape, breaking(4, 6));
    const std::vector<Sherd> others = shatter(make_pot(shape), breaking(77, 12));
    // Two are removed, so that there is room for an unrelated one.
    const auto smallest = static_cast<std::size_t>(
        std::min_element(others.begin(), others.end(),
                         [](const Sherd& x, const Sherd& y) { return surface_area(x.mesh) < surface_area(y.mesh); }) -
        others.begin());
    pot.sherds.resize(pot.sherds.size() - 2);
    pot.fragments.resize(pot.sherds.size());
    pot.fragments.emplace_back();
    Random random(5);
    pot.sherds.clear();
    for (std::size_t k = 0; k + 1 < pot.fragments.size(); ++k) pot.sherds.push_back({&pot.fragments[k], Motion(), false});
    pot.add(pot.fragments.size() - 1, others[smallest], shape, 0.003, random);
    const RotationMatch result = pot.match();
    EXPECT_FALSE(result.notes.back().empty());
    for (const FractureJoint& joint : result.joints)
        EXPECT_FALSE(joint.decided && joint.second + 1 == static_cast<int>(pot.sherds.size()));
}

TEST(RotationMatch, OneSherdAndNoFractures) {
    BrokenPot pot(small_pot(1), breaking(1, 2));
    pot.sherds.resize(1);
    const RotationMatch alone = pot.match();
    ASSERT_EQ(alone.poses.size(), 1U);
    EXPECT_TRUE(alone.joints.empty());
    EXPECT_LT((alone.poses[0].rotation - pot.sherds[0].pose.rotation).norm(), 1e-9);

    BrokenPot unbroken(small_pot(1), breaking(1, 3));
    for (Fragment& fragment : unbroken.fragments) fragment.facets.assign(fragment.mesh.number_of_faces(), Facet::outer);
    const RotationMatch none = unbroken.match();
    EXPECT_TRUE(none.joints.empty());
    for (const std::string& note : none.notes) EXPECT_NE(note.find("no fracture surface"), std::string::npos);

    EXPECT_THROW((void)match_rotations(unbroken.vessel, Vector3d::Zero(), Vector3d::UnitZ(), {}), Error);
    EXPECT_THROW((void)match_rotations(unbroken.vessel, Vector3d::Zero(), Vector3d::Zero(), unbroken.sherds), Error);
}

TEST(OpenRotations, OnlyWhereASearchLeftThemOpen) {
    const BrokenPot pot(small_pot(1), breaking(1, 3));
    std::vector<const Fragment*> fragments;
    std::vector<FragmentPlacement> placed;
    std::vector<std::optional<PoseSearchResult>> searched;
    for (const SherdOnAxis& sherd : pot.sherds) {
        fragments.push_back(sherd.fragment);
        placed.emplace_back();
        placed.back().pose = sherd.pose;
        searched.emplace_back();
    }
    EXPECT_FALSE(decide_open_rotations(pot.vessel, fragments, searched, placed)) << "none was searched";
    for (auto& search : searched) {
        search.emplace();
        search->decided = true;
    }
    EXPECT_FALSE(decide_open_rotations(pot.vessel, fragments, searched, placed)) << "nothing is open";
    for (auto& search : searched) search->slippable.kind = SlippableKind::rotation;
    RotationMatchOptions never;
    never.rotations = RotationMatchOptions::Turns::never;
    EXPECT_FALSE(decide_open_rotations(pot.vessel, fragments, searched, placed, never));
    placed[1].problem = "lost";
    const auto rotations = decide_open_rotations(pot.vessel, fragments, searched, placed);
    ASSERT_TRUE(rotations);
    EXPECT_EQ(rotations->group[1], -1);
    for (const FractureJoint& joint : rotations->joints) EXPECT_TRUE(joint.first != 1 && joint.second != 1);
    const Mesh box = build_mesh(test::octahedron_sphere(3));
    EXPECT_FALSE(decide_open_rotations(box, fragments, searched, placed)) << "a ball has no axis";
}

}  // namespace
}  // namespace ostraka
