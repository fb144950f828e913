#include "ostraka/fracture/break_pair.h"
#include "ostraka/core/angles.h"

#include "break_align.h"
#include "break_side.h"
#include "ostraka/core/error.h"
#include "ostraka/core/json_build.h"
#include "ostraka/core/parallel.h"
#include "ostraka/registration/pose_json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace ostraka {

using Eigen::Vector3d;

namespace {

/// All of the first fragment, for quick questions.
struct QuickTarget {
    std::vector<Vector3d> places, normals;
    std::size_t fractures = 0;  ///< these come first
    std::unique_ptr<SampleGrid> grid;

    QuickTarget(const BreakSide& side, double margin) : places(side.fracture.places), normals(side.fracture.normals) {
        fractures = places.size();
        places.insert(places.end(), side.intact.places.begin(), side.intact.places.end());
        normals.insert(normals.end(), side.intact.normals.begin(), side.intact.normals.end());
        grid = std::make_unique<SampleGrid>(places, margin);
    }
};

/// Every n-th element so that about `count` remain.
std::vector<std::size_t> thinned(std::size_t size, std::size_t count) {
    std::vector<std::size_t> list;
    const std::size_t wanted = std::min(size, count);
    for (std::size_t i = 0; i < wanted; ++i) list.push_back((2 * i + 1) * size / (2 * wanted));
    return list;
}

/// Poses that are alike: turned by little, and moved by little where the second fragment is.
bool alike(const Motion& a, const Motion& b, const Vector3d& middle, double shift, double angle) {
    if ((a(middle) - b(middle)).norm() > shift) return false;
    return Eigen::AngleAxisd(a.rotation.transpose() * b.rotation).angle() < angle;
}

struct Scored {
    Motion pose;
    double score;
};

/// The best, each unlike those before it.
std::vector<Scored> distinct(std::vector<Scored> list, std::size_t count, const Vector3d& middle, double shift, double angle) {
    std::stable_sort(list.begin(), list.end(), [](const Scored& x, const Scored& y) { return x.score > y.score; });
    std::vector<Scored> kept;
    for (const Scored& one : list) {
        if (kept.size() == count) break;
        if (std::none_of(kept.begin(), kept.end(),
                         [&](const Scored& k) { return alike(k.pose, one.pose, middle, shift, angle); }))
            kept.push_back(one);
    }
    return kept;
}

/// Scores poses quickly, by a few places of the second side.
class QuickScore {
public:
    QuickScore(const BreakSide& on, const BreakSide& of, double search_radius)
        : target_(on, 2 * search_radius),
          of_(of),
          search_radius_(search_radius),
          fractures_(thinned(of.fracture.places.size(), 160)),
          others_(thinned(of.intact.places.size(), 120)),
          each_fracture_(fractures_.empty() ? 0 : of.fracture.area / static_cast<double>(fractures_.size())),
          each_other_(others_.empty() ? 0 : of.intact.area / static_cast<double>(others_.size())) {}

    [[nodiscard]] double operator()(const Motion& pose) const {
        double score = 0;
        const auto look = [&](const Vector3d& place, const Vector3d& normal, double area, bool fracture) {
            const Vector3d p = pose(place);
            const Index i = target_.grid->near(p);
            if (i == no_index) return;
            const Vector3d off = p - target_.places[i];
            const double above = target_.normals[i].dot(off), squared = off.squaredNorm() / (search_radius_ * search_radius_);
            if (fracture && i < target_.fractures && squared < 1) {
                const double against = -target_.normals[i].dot(pose.rotation * normal);
                if (against > 0.3) score += area * (1 - squared) * against;
            }
            if (above < -0.5 * search_radius_) score -= area * std::min(1.0, -above / search_radius_ - 0.5);
        };
        for (const std::size_t i : fractures_) look(of_.fracture.places[i], of_.fracture.normals[i], each_fracture_, true);
        for (const std::size_t i : others_) look(of_.intact.places[i], of_.intact.normals[i], each_other_, false);
        return score;
    }

private:
    QuickTarget target_;
    const BreakSide& of_;
    double search_radius_;
    std::vector<std::size_t> fractures_, others_;
    double each_fracture_, each_other_;
};

/// The best of all poses that lay a frame onto a frame; `tried` counts them.
std::vector<Scored> best_of_frames(const BreakSide& a, const BreakSide& b, double search_radius, std::size_t count,
                                   std::size_t& tried) {
    const QuickScore quick_score(a, b, search_radius);
    const std::size_t columns = b.frames.size();
    std::vector<double> scores(a.frames.size() * columns);
    const double none = -std::numeric_limits<double>::infinity();
    parallel_for(scores.size(), [&](std::size_t k) {
        const RimFrame &f = a.frames[k / columns], &g = b.frames[k % columns];
        scores[k] = f.facet == g.facet ? quick_score(g.onto(f)) : none;
    });
    tried = static_cast<std::size_t>(std::count_if(scores.begin(), scores.end(), [&](double s) { return s > none; }));
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < scores.size(); ++k)
        if (scores[k] > 0) order.push_back(k);
    std::sort(order.begin(), order.end(),
              [&](std::size_t x, std::size_t y) { return std::pair(-scores[x], x) < std::pair(-scores[y], y); });
    if (order.size() > count) order.resize(count);
    std::vector<Scored> poses;
    for (const std::size_t k : order) poses.push_back({b.frames[k % columns].onto(a.frames[k / columns]), scores[k]});
    return poses;
}

/// How sure the best candidate is, or why it is not.
void decide(BreakPair& result, const PairOptions& options) {
    if (result.candidates.empty() || result.candidates.front().contact < options.min_contact) {
        result.undecided = "no pose brings " + std::to_string(static_cast<int>(std::lround(100 * options.min_contact))) +
                           " % of the smaller fracture into contact with the other";
        return;
    }
    const PairCandidate& best = result.candidates.front();
    const double next = result.candidates.size() > 1 ? std::max(0.0, result.candidates[1].score) : 0;
    const double ahead = best.score > 0 ? std::clamp(1 - next / best.score, 0.0, 1.0) : 0;
    // Even a half of the fracture in contact, a third ahead, is sure.
    result.confidence = std::min(1.0, 2 * best.contact) * std::min(1.0, 3 * ahead) * std::max(0.0, 1 - best.penetration);
    if (result.confidence < options.min_confidence)
        result.undecided = "the best pose is not far enough ahead of the next, or little of the fracture is in contact";
}

}  // namespace

BreakPair pair_breaks(const Fragment& a, const Fragment& b, const PairOptions& options) {
    check_options(options, "pair");
    BreakPair result;
    result.size = std::min(fragment_size(a.mesh), fragment_size(b.mesh));
    if (!(result.size > 0)) fail_input("fragment", "has no area", "look at its faces");
    const double search_radius = options.search_radius * result.size, radius = 0.75 * search_radius;
    const BreakSide side_a(a, radius, options.frames, std::max(4 * options.samples, 4000)),
        side_b(b, radius, options.frames, options.samples);
    result.fracture_a = side_a.fracture.area;
    result.fracture_b = side_b.fracture.area;
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& p : side_b.fracture.places) middle += p / static_cast<double>(side_b.fracture.places.size());
    const auto starts = static_cast<std::size_t>(options.starts), samples = static_cast<std::size_t>(options.samples);
    std::vector<Scored> poses = distinct(best_of_frames(side_a, side_b, search_radius, 40 * starts, result.tried), starts, middle,
                                         0.5 * search_radius, 6 * pi / 180);

    // The best refined: quickly, then to the end.
    const BreakAligner aligner(a.mesh, side_a, side_b, search_radius, options.last_search_radius * result.size, options.edges);
    parallel_for(
        poses.size(),
        [&](std::size_t i) {
            poses[i].pose = aligner.align(poses[i].pose, 200, 8);
            poses[i].score = aligner.judge(poses[i].pose, 300, 0.6).score;
        },
        1);
    poses = distinct(poses, static_cast<std::size_t>(options.refined), middle, 0.5 * search_radius, 5 * pi / 180);
    std::vector<PairCandidate> candidates(poses.size());
    parallel_for(
        poses.size(),
        [&](std::size_t i) { candidates[i] = aligner.judge(aligner.align(poses[i].pose, samples, 40), samples, 0.25); }, 1);
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const PairCandidate& x, const PairCandidate& y) { return x.score > y.score; });
    for (const PairCandidate& one : candidates) {
        if (result.candidates.size() == static_cast<std::size_t>(options.candidates)) break;
        if (std::none_of(result.candidates.begin(), result.candidates.end(),
                         [&](const PairCandidate& k) { return alike(k.pose, one.pose, middle, search_radius, 10 * pi / 180); }))
            result.candidates.push_back(one);
    }
    decide(result, options);
    return result;
}

JsonValue pair_to_json(const BreakPair& pair, const std::string& a, const std::string& b, JsonAllocator& allocator) {
    JsonValue result = json_object(allocator, "format", "ostraka-pair", "version", 1, "first", a, "second", b, "verdict",
                                   pair.decided() ? "together" : "undecided");
    if (!pair.decided()) add_members(result, allocator, "because", pair.undecided);
    const auto of_candidate = [&](const PairCandidate& one) {
        return json_object(allocator, "pose", pose_to_json(one.pose, allocator), "score", one.score, "contact", one.contact,
                           "rim", one.rim, "residual", one.residual, "penetration", one.penetration, "depth", one.depth);
    };
    add_members(result, allocator, "confidence", pair.confidence, "size", pair.size, "fractureOfFirst", pair.fracture_a,
                "fractureOfSecond", pair.fracture_b, "tried", pair.tried, "candidates",
                json_list(pair.candidates, allocator, of_candidate));
    return result;
}

void PairOptions::describe(OptionList& visit) {
    visit("frames", frames, "places along the rim of each fracture that are laid onto each other", Range{4, 2000});
    visit("samples", samples, "points on the fracture, and as many on the rest of the surface", Range{50, 1e6});
    visit("starts", starts, "poses that are refined quickly: the best of all tried", Range{1, 10000});
    visit("refined", refined, "poses that are refined to the end", Range{1, 1000});
    visit("reach", search_radius, "farthest that two fractures lie apart at first", Range{1e-4, 1},
          "share of the root of the smaller fragment's area");
    visit("last-reach", last_search_radius, "the same at the end; deeper in each other than this they do not go together",
          Range{1e-4, 1});
    visit("edges", edges, "weight of the fractures' rims against their surfaces", Range{0, 1000});
    visit("least-contact", min_contact, "share of the smaller fracture that must be in contact", Range{0, 1});
    visit("least-confidence", min_confidence, "below this it cannot be told how they go together", Range{0, 1});
    visit("candidates", candidates, "poses told, best first", Range{1, 1000});
}

}  // namespace ostraka
