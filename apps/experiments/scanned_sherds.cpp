// Scanned sherds and two halves of a bottle: pairs registered by their fracture surfaces, and sherds, moved at random, on the
// surface of revolution made of them.
#include "boxes.h"

#include "ostraka/core/text.h"
#include "ostraka/files/json.h"
#include "ostraka/fracture/pair_registration.h"
#include "ostraka/geom/point_tree.h"
#include "ostraka/io/diagnose.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/reconstruction/assembly.h"
#include "ostraka/reconstruction/fragment_file.h"
#include "ostraka/reconstruction/reconstruct.h"
#include "ostraka/revolution/surface_of_revolution.h"

#include <CGAL/boost/graph/helpers.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

namespace ostraka::experiments {

using Eigen::Vector3d;

namespace {

struct ScannedOptions {
    std::string output = "experiments-output/breaks";
    std::string data = "../shared/data";
    int motions = 3;
    void declare_options(OptionList& list) {
        list("output", output, "folder for tables and meshes").positional();
        list("data", data, "folder with fragments-bottle-pair and fragments-vessel-sherds");
        list("motions", motions, "number of random motions of all sherds", Range{1, 1000});
    }
};

/// The five scanned sherds of a vessel with their numbers as names; if the files are missing, none, with a message.
std::vector<Fragment> scanned_sherds(const std::string& data) {
    std::vector<Fragment> sherds;
    for (int k = 1; k <= 5; ++k) {
        const Path file = Path(data) / "fragments-vessel-sherds" / fmt::format("TU_96_2_5f_piece0{}.obj", k);
        if (!std::filesystem::exists(file)) {
            fmt::print(stderr, "SKIPPED: {} is not there; name the folder with --data\n", file.string());
            return {};
        }
        sherds.emplace_back();
        sherds.back().name = std::to_string(k);
        sherds.back().mesh = read_mesh(file).mesh;
    }
    return sherds;
}

/// Thins points to their mean in each cell of a grid that starts half a cell below the lowest corner.
std::vector<Point> thinned(const std::vector<Point>& points, double cell) {
    Vector3d low = eigen(points.front());
    for (const Point& p : points) low = low.cwiseMin(eigen(p));
    low.array() -= 0.5 * cell;
    std::map<std::array<long, 3>, std::pair<Vector3d, double>> cells;
    for (const Point& p : points) {
        const Vector3d at = (eigen(p) - low) / cell;
        auto& [sum, count] = cells[{static_cast<long>(at.x()), static_cast<long>(at.y()), static_cast<long>(at.z())}];
        if (count == 0) sum.setZero();
        sum += eigen(p);
        ++count;
    }
    std::vector<Point> result;
    for (const auto& [key, mean] : cells) result.push_back(point_of(mean.first / mean.second));
    return result;
}

/// Root mean square distance from the moved second cloud to the first, and the mean of the two mean distances (Chamfer).
std::pair<double, double> rmse_and_chamfer(const std::vector<Point>& first, const std::vector<Point>& second,
                                           const Motion& pose) {
    const std::vector<Point> there = warped(second, pose);
    const PointTree on_first(first), on_second(there);
    double square = 0, to = 0, from = 0;
    for (const Point& p : there) {
        const double d = std::sqrt(on_first.nearest(p).squared);
        square += d * d, to += d;
    }
    for (const Point& p : first) from += std::sqrt(on_second.nearest(p).squared);
    const auto n = static_cast<double>(there.size()), m = static_cast<double>(first.size());
    return {std::sqrt(square / n), 0.5 * (to / n + from / m)};
}

/// The second matrix of the best published registration (transf_icp), which maps the second cloud to the first.
Motion published_pose(const Path& file) {
    const std::string text = read_file(file);
    std::size_t at = text.find("[[");
    if (at != std::string::npos) at = text.find("[[", at + 2);
    Motion motion;
    if (at == std::string::npos) return motion;
    const std::vector<std::string_view> numbers = split_words(std::string_view(text).substr(at), "[], \n\r\t\"");
    for (unsigned i = 0; i < 3; ++i)
        for (unsigned j = 0; j < 4; ++j)
            (j < 3 ? motion.rotation(i, j) : motion.translation[i]) = number_of(numbers.at(4 * i + j)).value_or(0);
    return motion;
}

void bottle(const ScannedOptions& options, Rows& csv) {
    const Path folder = Path(options.data) / "fragments-bottle-pair";
    if (!std::filesystem::exists(folder / "solution.json")) {
        fmt::print(stderr, "SKIPPED: {} is not there; name the folder above it with --data\n", folder.string());
        return;
    }
    const Fragment first = read_fragment(folder / "obj1_challenge.ply").fragment,
                   second = read_fragment(folder / "obj2_challenge.ply").fragment;
    const Json solution = read_json(folder / "solution.json");
    const Motion truth = motion_of(solution["T"]).inverse(), published = published_pose(folder / "best_registration.csv");
    const Stopwatch watch;
    const PairRegistration pair = register_fractures(first, second);
    const double seconds = watch.seconds().processor;
    if (pair.candidates.empty()) {
        fmt::print("bottle: no pose\n");
        return;
    }
    const auto a = read_point_cloud(folder / "segmented" / "obj1_challenge_part_1_.ply"),
               b = read_point_cloud(folder / "segmented" / "obj2_challenge_part_1_.ply");
    const std::vector<Point> thin_a = thinned(a->points, 0.011), thin_b = thinned(b->points, 0.011);
    fmt::print("Bottle: {}, confidence {:.2f}; {:.1f} s of processor. Breaks thinned to {} and {} points.\n\n",
               pair.decided() ? "decided" : "not decided", pair.confidence, seconds, thin_a.size(), thin_b.size());
    Table table("pose | degrees off the truth | % of the diagonal | RMSE, thinned | chamfer, thinned | RMSE, all | chamfer, all");
    for (const auto& [name, pose] : {std::pair("ostraka pair", pair.candidates.front().pose),
                                     std::pair("published registration", published), std::pair("truth", truth)}) {
        const Motion off = truth.inverse().after(pose);
        const double degrees = degrees_of(off), percent = 100 * off_of(second.mesh, off) / box_diagonal(second.mesh);
        const auto [rmse, chamfer] = rmse_and_chamfer(thin_a, thin_b, pose);
        const auto [rmse_all, chamfer_all] = rmse_and_chamfer(a->points, b->points, pose);
        table.row("{} | {:.2f} | {:.2f} | {:.5f} | {:.5f} | {:.5f} | {:.5f}", name, degrees, percent, rmse, chamfer, rmse_all,
                  chamfer_all);
        csv("bottle", name, degrees, percent, pair.confidence, pair.decided());
    }
}

void sherd_pairs(const ScannedOptions& options, Rows& csv) {
    std::vector<Fragment> fragments = scanned_sherds(options.data);
    if (fragments.empty()) return;
    for (Fragment& fragment : fragments) fragment.facets = find_facets(fragment.mesh).of_face;
    fmt::print("\n");
    Table table("sherds | right pose is first | decided | confidence | degrees | % of the diagonal | s of processor");
    // Pairs in contact, and the last one, which is not.
    const std::vector<std::pair<std::size_t, std::size_t>> pairs{{5, 2}, {3, 4}, {1, 4}, {2, 3}, {1, 2},
                                                                 {4, 5}, {3, 5}, {1, 5}, {2, 4}};
    for (const auto& [i, j] : pairs) {
        const Fragment &a = fragments[i - 1], &b = fragments[j - 1];
        Random random(10 * i + j, 8);
        Fragment there = b;
        const Motion motion = move_at_random(there, random, 20);
        const Stopwatch watch;
        const PairRegistration pair = register_fractures(a, there);
        const double seconds = watch.seconds().processor;
        double degrees = 180, percent = 100;
        if (!pair.candidates.empty()) {
            const Motion off = pair.candidates.front().pose.after(motion);
            degrees = degrees_of(off), percent = 100 * off_of(b.mesh, off) / box_diagonal(b.mesh);
        }
        const bool touch = i != 2 || j != 4, right = touch && degrees < 5 && percent < 10;
        const char* first = !touch ? "-" : right ? "yes" : "no";
        table.row("{} {} | {} | {} | {:.2f} | {} | {:.1f}", i, j, first, pair.decided() ? "yes" : "no", pair.confidence,
                  right ? fmt::format("{:.1f} | {:.1f}", degrees, percent) : " | ", seconds);
        csv("sherds", fmt::format("{}-{}", i, j), degrees, percent, pair.confidence, pair.decided());
    }
}

void break_pairs(const ScannedOptions& options) {
    Rows csv("what,case,degrees,percent,confidence,decided");
    bottle(options, csv);
    sherd_pairs(options, csv);
    csv.write(Path(options.output) / "break-pairs.csv");
}

const Registration registered_pairs("break-pairs", "two halves of a bottle, and neighbours among scanned sherds", break_pairs);

/// Decided joints, right if within 5 degrees, and the largest relative rotation of them.
struct JudgedJoints {
    Hits decided;
    double worst = 0;
};

JudgedJoints judge_joints(const std::vector<FractureJoint>& joints, const std::vector<Motion>& back, int round) {
    JudgedJoints result;
    for (const FractureJoint& joint : joints) {
        const double off =
            degrees_of(back[static_cast<std::size_t>(joint.first)].inverse().after(back[static_cast<std::size_t>(joint.second)]));
        fmt::print(stderr,
                   "motion {}: {} - {}: {:.2f} degrees, contact {:.2f}, rim {:.2f}, share {:.2f}, lead {:.2f}, confidence "
                   "{:.2f}{}{}\n",
                   round, joint.first + 1, joint.second + 1, off, joint.contact, joint.rim, joint.share, joint.lead,
                   joint.confidence, joint.carries ? ", carries" : "", joint.decided ? ", decided" : "");
        if (!joint.decided) continue;
        result.decided.add(off < 5);
        result.worst = std::max(result.worst, off);
    }
    return result;
}

/// Places sherds on the surface of revolution made of them: errors of axes, heights and rotations.
void sherd_rotations(const ScannedOptions& options) {
    std::vector<Fragment> given = scanned_sherds(options.data);
    if (given.empty()) return;
    const double diagonal = diagonal_of(given);
    const RevolutionTemplate turned = template_of_revolution(pointers_to(given));
    const Vector3d axis = eigen(turned.axis.direction), on_axis = eigen(turned.axis.point);
    for (Fragment& sherd : given) sherd.facets = find_facets(sherd.mesh).of_face;
    Rows csv("motion,sherd,decided,degrees,percent,axis_degrees,height,overlap");
    Table table(
        "motion | joints decided, of these right | worst relative turn of decided joints, degrees | sherds off as a whole: "
        "degrees, % of the diagonal | overlap % | closed | crossings | s");
    for (int round = 1; round <= options.motions; ++round) {
        Random random(static_cast<std::uint64_t>(round), 5);
        std::vector<Fragment> away = given;
        std::vector<Motion> motions;
        for (Fragment& sherd : away) motions.push_back(move_at_random(sherd, random, diagonal));
        const Stopwatch watch;
        const Reconstruction result = reconstruct(turned, {}, pointers_to(away));
        const double seconds = watch.seconds().processor;
        std::vector<Vector3d> from, to;
        std::vector<Motion> back(given.size());
        for (std::size_t k = 0; k < given.size(); ++k) {
            if (!result.placement.fragments[k].problem.empty()) continue;
            back[k] = result.placement.fragments[k].pose.after(motions[k]);
            for (const Vertex v : given[k].mesh.vertices()) {
                from.push_back(eigen(given[k].mesh.point(v)));
                to.push_back(back[k](from.back()));
            }
        }
        if (from.empty()) {
            table.row("{} | none placed", round);
            continue;
        }
        const Motion common = fit_motion(from, to).inverse();
        const JudgedJoints joints =
            judge_joints(result.rotations ? result.rotations->joints : std::vector<FractureJoint>(), back, round);
        double degrees = 0, percent = 0, overlap = 0;
        for (std::size_t k = 0; k < given.size(); ++k) {
            const Motion off = common.after(back[k]);
            const double d = degrees_of(off), p = 100 * off_of(given[k].mesh, off) / diagonal,
                         shared = result.rotations ? result.rotations->overlap[k] : 0;
            degrees = std::max(degrees, d), percent = std::max(percent, p), overlap = std::max(overlap, 100 * shared);
            const Vector3d turned_axis = back[k].rotation * axis;
            csv(round, given[k].name, result.placement.fragments[k].problem.empty(), d, p,
                180 / std::numbers::pi * std::acos(std::min(1.0, std::abs(turned_axis.dot(axis)))),
                (back[k](on_axis) - on_axis).dot(axis), shared);
        }
        table.row("{} | {}, {} | {:.1f} | {:.1f}, {:.2f} | {:.1f} | {} | {} | {:.1f}", round, joints.decided.all,
                  joints.decided.hits, joints.worst, degrees, percent, overlap,
                  CGAL::is_closed(result.object.mesh) ? "yes" : "no", result.crossings, seconds);
        MeshExtras extras;
        for (const int fragment : result.object.fragment) extras.face_labels.push_back(fragment + 1);
        write_mesh(Path(options.output) / fmt::format("completed-{}.ply", round), result.object.mesh, extras);
    }
    csv.write(Path(options.output) / "sherd-turns.csv");
}

const Registration registered_turns("sherd-turns", "scanned sherds on the template turned from them, turns by breaks",
                                    sherd_rotations);

}  // namespace

}  // namespace ostraka::experiments
