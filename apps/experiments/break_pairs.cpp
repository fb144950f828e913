// Registers two halves of a bottle, and neighbouring scanned sherds, by their fracture surfaces.
#include "sherds.h"

#include "ostraka/files/json.h"
#include "ostraka/fracture/pair_registration.h"
#include "ostraka/geom/point_tree.h"
#include "ostraka/reconstruction/fragment_file.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>

namespace ostraka::experiments {

using Eigen::Vector3d;

namespace {

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

std::vector<double> distances(const std::vector<Point>& from, const std::vector<Point>& to) {
    const PointTree tree(to);
    std::vector<double> result;
    for (const Point& p : from) result.push_back(std::sqrt(tree.nearest(p).squared));
    return result;
}

/// Root mean square distance from the moved second cloud to the first, and the mean of the two mean distances (Chamfer).
std::pair<double, double> rmse_and_chamfer(const std::vector<Point>& first, const std::vector<Point>& second,
                                           const Motion& pose) {
    std::vector<Point> there;
    for (const Point& p : second) there.push_back(point_of(pose(eigen(p))));
    double square = 0, to = 0, from = 0;
    for (const double d : distances(there, first)) square += d * d, to += d;
    for (const double d : distances(first, there)) from += d;
    const auto n = static_cast<double>(there.size()), m = static_cast<double>(first.size());
    return {std::sqrt(square / n), 0.5 * (to / n + from / m)};
}

/// The second matrix of the best published registration (transf_icp), which maps the second cloud to the first.
Motion published_pose(const Path& file) {
    const std::string text = read_file(file);
    std::size_t at = text.find("[[");
    if (at != std::string::npos) at = text.find("[[", at + 2);
    Motion motion;
    for (int i = 0; i < 3 && at != std::string::npos; ++i)
        for (int j = 0; j < 4; ++j) {
            at = text.find_first_of("-0123456789", at);
            if (at == std::string::npos) return motion;
            char* end = nullptr;
            const double value = std::strtod(text.c_str() + at, &end);
            (j < 3 ? motion.rotation(i, j) : motion.translation[i]) = value;
            at = static_cast<std::size_t>(end - text.c_str());
        }
    return motion;
}

void bottle(const SherdOptions& options, Rows& csv) {
    const Path folder = Path(options.data) / "fragments-bottle-pair";
    if (!std::filesystem::exists(folder / "solution.json")) {
        std::cerr << "SKIPPED: " << folder.string() << " is not there; name the folder above it with --data\n";
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

void sherd_pairs(const SherdOptions& options, Rows& csv) {
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
        const Motion motion = random_motion(random, 20);
        Fragment there = b;
        there.mesh = moved(b.mesh, motion);
        const Stopwatch watch;
        const PairRegistration pair = register_fractures(a, there);
        const double seconds = watch.seconds().processor;
        double degrees = 180, percent = 100;
        if (!pair.candidates.empty()) {
            const Motion off = pair.candidates.front().pose.after(motion);
            degrees = degrees_of(off), percent = 100 * off_of(b.mesh, off) / box_diagonal(b.mesh);
        }
        const bool touch = i != 2 || j != 4, right = touch && degrees < 5 && percent < 10;
        table.row("{} {} | {} | {} | {:.2f} | {} | {:.1f}", i, j,
                  !touch  ? "-"
                  : right ? "yes"
                          : "no",
                  pair.decided() ? "yes" : "no", pair.confidence,
                  right ? fmt::format("{:.1f} | {:.1f}", degrees, percent) : " | ", seconds);
        csv("sherds", fmt::format("{}-{}", i, j), degrees, percent, pair.confidence, pair.decided());
    }
}

/// Registers two halves of a bottle, and neighbouring sherds of five.
void break_pairs(const SherdOptions& options) {
    Rows csv("what,case,degrees,percent,confidence,decided");
    bottle(options, csv);
    sherd_pairs(options, csv);
    csv.write(Path(options.output) / "break-pairs.csv");
}

const Registration registered("break-pairs", "two halves of a bottle, and neighbours among scanned sherds", break_pairs);

}  // namespace

}  // namespace ostraka::experiments
