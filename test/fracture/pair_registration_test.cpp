#include "ostraka/fracture/pair_registration.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/fracture/facets.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/reconstruction/fragment_file.h"
#include "ostraka/stats/random.h"
#include "scratch.h"
#include "sherds.h"

namespace ostraka {
namespace {

using test::synthetic_bar;
using test::synthetic_sherd;
using test::SyntheticSherd;

Fragment fragment_of(const SyntheticSherd& sherd, const std::string& name, const Motion& motion = {}) {
    Fragment fragment;
    fragment.name = name;
    fragment.mesh = moved(sherd.mesh, motion);
    fragment.facets = sherd.facets;
    return fragment;
}

Motion random_motion(std::uint64_t seed, double size) {
    Random random(seed);
    Motion motion;
    motion.rotation =
        Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal()).normalized().toRotationMatrix();
    motion.translation = size * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    return motion;
}

/// Degrees, and the largest distance of a vertex from its true position as a share of the diagonal.
std::pair<double, double> errors(const Mesh& mesh, const Motion& pose, const Motion& truth) {
    double farthest = 0;
    for (const Vertex v : mesh.vertices())
        farthest = std::max(farthest, (pose(eigen(mesh.point(v))) - truth(eigen(mesh.point(v)))).norm());
    return {Eigen::AngleAxisd(pose.rotation.transpose() * truth.rotation).angle() * 180 / M_PI, farthest / box_diagonal(mesh)};
}

PairOptions quick() {
    PairOptions options;
    options.frames = 80;
    options.samples = 600;
    options.starts = 60;
    options.refined = 10;
    return options;
}

TEST(PairRegistration, NeighboursAreRegisteredFromAnyPose) {
    const SyntheticSherd a = synthetic_sherd(1, 2, 0, 1), b = synthetic_sherd(2, 3, 1, 2);
    for (const double scale : {1.0, 1e-6, 1e6}) {
        Motion unit;
        unit.scale = scale;
        const Motion away = random_motion(7, 30 * scale).after(unit);
        const Fragment first = fragment_of(a, "a", unit), second = fragment_of(b, "b", away);
        const PairRegistration pair = register_fractures(first, second, quick());
        ASSERT_TRUE(pair.decided()) << pair.undecided;
        Motion truth = unit.after(away.inverse());
        EXPECT_NEAR(truth.scale, 1, 1e-9);
        const auto [angle, shift] = errors(second.mesh, pair.candidates.front().pose, truth);
        EXPECT_LT(angle, 2) << scale << ", with half of the usual places along the rims";
        EXPECT_LT(shift, 0.02) << scale;
        EXPECT_EQ(pair.candidates.front().pose.scale, 1);
    }
}

TEST(PairRegistration, ABrokenSolid) {
    const SyntheticSherd below = synthetic_bar(), above = synthetic_bar(1, true);
    const Motion away = random_motion(3, 20);
    const Fragment first = fragment_of(below, "below"), second = fragment_of(above, "above", away);
    const PairRegistration pair = register_fractures(first, second, quick());
    ASSERT_TRUE(pair.decided()) << pair.undecided;
    const auto [angle, shift] = errors(second.mesh, pair.candidates.front().pose, away.inverse());
    EXPECT_LT(angle, 0.5);
    EXPECT_LT(shift, 0.01);
    EXPECT_GT(pair.candidates.front().contact, 0.9);
    EXPECT_LT(pair.candidates.front().penetration, 0.01);
    for (std::size_t i = 1; i < pair.candidates.size(); ++i) EXPECT_LE(pair.candidates[i].score, pair.candidates[i - 1].score);
}

TEST(PairRegistration, UnrelatedFragmentsScoreLower) {
    const Fragment a = fragment_of(synthetic_bar(), "a");
    const Fragment mate = fragment_of(synthetic_bar(1, true), "mate");
    // A bar with another fracture.
    SyntheticSherd unrelated = synthetic_bar(1, true);
    for (const Vertex v : unrelated.mesh.vertices()) {
        const Point p = unrelated.mesh.point(v);
        const double fade = (8 - p.z()) / 4;
        unrelated.mesh.point(v) = Point(p.x(), p.y(), p.z() + fade * 0.2 * std::sin(7 * p.x() - 2 * p.y()));
    }
    const double with_mate = register_fractures(a, mate, quick()).candidates.front().score,
                 with_unrelated = register_fractures(a, fragment_of(unrelated, "other"), quick()).candidates.front().score;
    EXPECT_GT(with_mate, with_unrelated + 0.2);
}

TEST(PairRegistration, TheOrderOfTheFragmentsDoesNotMatter) {
    // Right pairs and a wrong one, with the larger fragment given first or second.
    const Fragment a = fragment_of(synthetic_sherd(1, 2, 0, 1), "a"),
                   b = fragment_of(synthetic_sherd(2, 3, 1, 2), "b", random_motion(7, 30)),
                   c = fragment_of(synthetic_sherd(4, 5, 0, 1), "c", random_motion(8, 30));
    for (const auto& [x, y] : {std::pair(&a, &b), std::pair(&b, &c), std::pair(&a, &c)}) {
        const PairRegistration forward = register_fractures(*x, *y, quick()), backward = register_fractures(*y, *x, quick());
        EXPECT_EQ(forward.confidence, backward.confidence);
        EXPECT_EQ(forward.undecided, backward.undecided);
        EXPECT_EQ(forward.fracture_a, backward.fracture_b);
        EXPECT_EQ(forward.tried, backward.tried);
        ASSERT_EQ(forward.candidates.size(), backward.candidates.size());
        ASSERT_FALSE(forward.candidates.empty());
        for (std::size_t i = 0; i < forward.candidates.size(); ++i) {
            EXPECT_EQ(forward.candidates[i].log_odds, backward.candidates[i].log_odds);
            EXPECT_EQ(forward.candidates[i].score, backward.candidates[i].score);
            const Motion round = forward.candidates[i].pose.after(backward.candidates[i].pose);
            EXPECT_LT((round.rotation - Eigen::Matrix3d::Identity()).norm(), 1e-12);
            EXPECT_LT(round.translation.norm(), 1e-9);
        }
    }
}

TEST(JoinEvidence, TheCommonAxisIsMeasuredFarFromTheOriginToo) {
    Motion far;
    far.translation = {1e6, -2e6, 1e6};
    const auto axis_of = [](const Motion& motion) {
        const PreparedFracture a(fragment_of(synthetic_sherd(1, 2, 0, 1), "a", motion), quick()),
            b(fragment_of(synthetic_sherd(2, 3, 1, 2), "b", motion), quick());
        return measure_join(a, b, {}, 0.01 * join_scale(a, b));
    };
    const JoinEvidence near = axis_of({}), far_away = axis_of(far);
    EXPECT_NEAR(near.own_axis, far_away.own_axis, 1e-5);
    EXPECT_NEAR(near.axis, far_away.axis, 1e-3);
}

TEST(PairRegistration, ThreadsDoNotMatter) {
    const Fragment a = fragment_of(synthetic_bar(), "a"), b = fragment_of(synthetic_bar(1, true), "b", random_motion(4, 5));
    PairOptions options = quick();
    options.frames = 30;
    const int before = threads();
    set_threads(1);
    const PairRegistration single_threaded = register_fractures(a, b, options);
    set_threads(3);
    const PairRegistration three = register_fractures(a, b, options);
    set_threads(before);
    ASSERT_EQ(single_threaded.candidates.size(), three.candidates.size());
    for (std::size_t i = 0; i < single_threaded.candidates.size(); ++i) {
        EXPECT_EQ(single_threaded.candidates[i].pose.rotation, three.candidates[i].pose.rotation);
        EXPECT_EQ(single_threaded.candidates[i].pose.translation, three.candidates[i].pose.translation);
        EXPECT_EQ(single_threaded.candidates[i].score, three.candidates[i].score);
    }
}

TEST(PairRegistration, ReportsWhatCannotBeRegistered) {
    const Fragment a = fragment_of(synthetic_bar(), "a");
    Fragment unbroken = fragment_of(synthetic_bar(1, true), "whole");
    unbroken.facets.assign(unbroken.facets.size(), Facet::outer);
    EXPECT_THROW(register_fractures(a, unbroken, quick()), Error);
    unbroken.facets.clear();
    EXPECT_THROW(register_fractures(a, unbroken, quick()), Error) << "no facets: all outer";
    unbroken.facets.assign(unbroken.mesh.number_of_faces(), Facet::fracture);
    EXPECT_THROW(register_fractures(a, unbroken, quick()), Error) << "no rim";
    EXPECT_THROW(register_fractures(a, Fragment(), quick()), Error);
    PairOptions options;
    options.search_radius = 2;
    EXPECT_THROW(register_fractures(a, a, options), Error);
    // An unrelated, far smaller fragment: cannot be determined.
    options = quick();
    Motion smaller;
    smaller.scale = 0.2;
    const PairRegistration pair = register_fractures(a, fragment_of(synthetic_sherd(4, 5, 0, 1), "small", smaller), options);
    EXPECT_FALSE(pair.decided());
    EXPECT_FALSE(pair.undecided.empty());
}

TEST(PairRegistration, ScannedBottle) {
    const Path folder = Path(OSTRAKA_SHARED_DATA) / "fragments-bottle-pair";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "THE BOTTLE IS NOT THERE: " << folder;
    const FragmentFile first = read_fragment(folder / "obj1_challenge.ply");
    FragmentFile second = read_fragment(folder / "obj2_challenge.ply");
    EXPECT_TRUE(first.points);
    EXPECT_EQ(first.facets_from, "shape");
    // The motion applied to the second half: the true pose is its inverse.
    const Json solution = read_json(folder / "solution.json");
    Motion moved_by;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            moved_by.rotation(i, j) = solution["r"][static_cast<unsigned>(i)][static_cast<unsigned>(j)].GetDouble();
        moved_by.translation[i] = solution["t"][static_cast<unsigned>(i)].GetDouble();
    }
    const Motion away = random_motion(11, 1);
    second.fragment.mesh = moved(second.fragment.mesh, away);
    const PairRegistration pair = register_fractures(first.fragment, second.fragment);
    ASSERT_TRUE(pair.decided()) << pair.undecided;
    const auto [angle, shift] =
        errors(second.fragment.mesh, pair.candidates.front().pose, moved_by.inverse().after(away.inverse()));
    EXPECT_LT(angle, 0.5);
    EXPECT_LT(shift, 0.005);
    EXPECT_LT(pair.candidates.front().residual, 0.004755) << "as published for this pair";
}

std::string quoted(const Path& path) { return "'" + path.string() + "'"; }

TEST(PairCommand, MovesTheSecondOntoTheFirst) {
    const test::Scratch scratch;
    const SyntheticSherd below = synthetic_bar(), above = synthetic_bar(1, true);
    const Motion away = random_motion(5, 10);
    write_mesh(scratch / "a.ply", below.mesh);
    write_mesh(scratch / "b.ply", moved(above.mesh, away));
    const std::string command = "pair " + quoted(scratch / "a.ply") + " " + quoted(scratch / "b.ply") +
                                " --frames 60 --samples 500 --starts 40 --refined 6";
    const auto run = test::run_command(command + " --output " + quoted(scratch / "out"));
    ASSERT_EQ(run.code, 0) << run.err << run.out;
    EXPECT_NE(run.out.find("facets by shape"), std::string::npos) << run.out;
    const Json report = read_json(scratch / "out" / "pair.json");
    validate(report, "pair", "pair");
    EXPECT_STREQ(report["verdict"].GetString(), "together");
    EXPECT_TRUE(report.HasMember("provenance"));
    const MeshFile second = read_mesh(scratch / "out" / "second.ply");
    EXPECT_EQ(second.extras.face_labels.size(), second.mesh.number_of_faces());
    for (const Vertex v : second.mesh.vertices())
        EXPECT_LT((eigen(second.mesh.point(v)) - eigen(above.mesh.point(v))).norm(), 0.05);
    EXPECT_EQ(test::run_command(command).code, 2) << "no folder";
    // Names of outputs that are inputs.
    std::filesystem::create_directory(scratch / "own");
    for (const char* name : {"first.ply", "second.ply"}) {
        std::filesystem::copy(scratch / "b.ply", scratch / "own" / name);
        const std::string before = read_file(scratch / "own" / name);
        const auto onto_input =
            test::run_command("pair " + quoted(scratch / "a.ply") + " " + quoted(scratch / "own" / name) +
                              " --frames 60 --samples 500 --starts 40 --refined 6 --output " + quoted(scratch / "own"));
        EXPECT_EQ(onto_input.code, 2);
        EXPECT_NE(onto_input.err.find("also an input"), std::string::npos) << onto_input.err;
        EXPECT_EQ(read_file(scratch / "own" / name), before);
        std::filesystem::remove(scratch / "own" / name);
    }
    EXPECT_EQ(test::run_command(command + " --reach 2 --output " + quoted(scratch / "out2")).code, 2);
    const auto none = test::run_command(command + " --facets none --output " + quoted(scratch / "out2"));
    EXPECT_EQ(none.code, 1);
    EXPECT_NE(none.err.find("fracture"), std::string::npos) << none.err;
    EXPECT_FALSE(std::filesystem::exists(scratch / "out2"));
}

}  // namespace
}  // namespace ostraka
