#include "ostraka/registration/pose_search.h"
#include "ostraka/core/angles.h"

#include "grid_pose.h"

#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/text.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/plane_motion.h"
#include "ostraka/registration/pair_votes.h"
#include "ostraka/registration/part_alignment.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

using detail::Nearness;
using detail::refined_on;
using detail::score_on;
using detail::thinned;
using Eigen::Vector3d;

namespace {

constexpr double scale_step = 1.0 / 12;
// Poses that differ by less are equal: radians, shares of the part's size, logarithm of the scale ratio.
constexpr double angle_apart = pi / 15, length_apart = 0.1, scale_apart = 0.15;

/// Centroid and size of a point cloud: three times the root mean square distance from the centroid, close to its diameter.
struct Extent {
    Vector3d middle = Vector3d::Zero();
    double size = 0;
};

Extent extent_of(const SurfacePoints& points) {
    Extent extent;
    const auto count = static_cast<double>(points.size());
    for (const Vector3d& p : points.places) extent.middle += p / count;
    for (const Vector3d& p : points.places) extent.size += (p - extent.middle).squaredNorm() / count;
    extent.size = 3 * std::sqrt(extent.size);
    return extent;
}

/// Diagonal of the bounding box of the marked faces, or of all faces if there are no marks.
double marked_diagonal(const Mesh& mesh, const std::vector<bool>& marks) {
    Eigen::AlignedBox3d box;
    for (const Face face : mesh.faces())
        if (marks.empty() || marks[face])
            for (const Vertex v : corners(mesh, face)) box.extend(eigen(mesh.point(v)));
    return box.isEmpty() ? 0 : box.diagonal().norm();
}

struct Proposal {
    Motion pose;  ///< maps the part, scaled down by the scale of the whole, onto the unscaled whole
    double scale = 1, score = 0;
};

/// Converts a pose on the scaled whole to one on the unscaled whole.
Motion on_unscaled(Motion pose, double scale) {
    pose.scale /= scale;
    pose.translation /= scale;
    return pose;
}

double angle_between(const Motion& a, const Motion& b) {
    return std::acos(std::clamp(((a.rotation.transpose() * b.rotation).trace() - 1) / 2, -1.0, 1.0));
}

// Logistic regression of whether the best pose is right, on the margin and the score, for fragments of the same object, of
// other objects of its class and of out-of-class objects (ostraka_experiments pose-search; doc/pose-search.md).
constexpr double confidence_at_rest = -6.5, confidence_of_margin = 14, confidence_of_score = 6, max_margin = 3;

}  // namespace

struct PoseSearch::State {
    const SurfaceSearch& whole;
    PoseSearchOptions options;
    double spacing = 0, radius = 0;
    SurfacePoints fine;
    std::unique_ptr<detail::NearestGrid> grid;
    std::unique_ptr<PairTable> table;

    State(const SurfaceSearch& search, const PoseSearchOptions& given) : whole(search), options(given) {}

    [[nodiscard]] std::vector<double> scales(double minimum, double maximum) const {
        if (!(maximum > minimum * (1 + 1e-9))) return {minimum};
        const int steps = std::max(1, static_cast<int>(std::ceil(std::log(maximum / minimum) / std::log(1 + scale_step))));
        std::vector<double> list;
        for (int k = 0; k <= steps; ++k) list.push_back(minimum * std::pow(maximum / minimum, static_cast<double>(k) / steps));
        return list;
    }

    /// The part's points in its own unit, about its centroid, with the density of the whole's points.
    [[nodiscard]] SurfacePoints points_of(const Mesh& part, const std::vector<bool>& of_part, double scale) const {
        constexpr double minimum = 300;
        const double own = std::sqrt(0.7 * marked_area(part, of_part) / minimum);
        return spread_points(part, of_part, std::min(spacing * scale, own), radius * scale, options.seed);
    }

    void propose(const SurfacePoints& points, const Extent& extent, double scale, bool free, std::vector<Proposal>& all) const {
        constexpr std::size_t refined = 300, judged = 300;
        SurfacePoints small = thinned(points, 1500);
        small.spacing /= scale;
        for (Vector3d& p : small.places) p = (p - extent.middle) / scale;
        const SurfacePoints some = thinned(small, judged);
        const double tolerance = options.tolerance * extent.size / scale;
        const Nearness near(tolerance);
        const auto voted = table->vote(small, options.references, options.partners, 8, options.seed);
        std::vector<std::pair<double, std::size_t>> order(voted.size());
        const Nearness wide(2 * tolerance);
        parallel_for(
            voted.size(),
            [&](std::size_t i) {
                order[i] = {-score_on(*grid, some, voted[i].motion, wide), i};
            },
            16);
        std::sort(order.begin(), order.end());
        if (order.size() > refined) order.resize(refined);
        const std::size_t first = all.size();
        all.resize(first + order.size());
        parallel_for(
            order.size(),
            [&](std::size_t k) {
                Proposal& one = all[first + k];
                one.pose = refined_on(*grid, some, voted[order[k].second].motion, tolerance, 14, free);
                one.scale = scale / one.pose.scale;
                one.score = score_on(*grid, some, one.pose, near);
            },
            8);
    }

    /// Whether two poses of the part are distinct.
    [[nodiscard]] static bool differ(const Motion& a, const Motion& b, const Vector3d& middle, double size) {
        return angle_between(a, b) > angle_apart || (a(middle) - b(middle)).norm() > length_apart * size ||
               std::abs(std::log(a.scale / b.scale)) > scale_apart;
    }

    void judge(PoseCandidate& one, const SurfacePoints& points, double tolerance, double scale) const {
        const Nearness near(tolerance / scale);
        struct Sample {
            double score = 0, squared = -1;
            bool inside = false;
        };
        std::vector<Sample> samples(points.size());
        const Motion onto = on_unscaled(one.pose, scale);
        parallel_for(points.size(), [&](std::size_t i) {
            const Vector3d p = onto(points.places[i]), n = onto.rotation * points.normals[i];
            const auto hit = whole.closest_compatible(point_of(p), vector_of(n), 0.5, 2.5 * tolerance / scale);
            if (hit) {
                samples[i].score = near(hit->distance);
                if (hit->distance < tolerance / scale) samples[i].squared = hit->distance * hit->distance;
            }
            if (samples[i].squared < 0) {
                const SurfaceHit any = whole.closest(point_of(p));
                samples[i].inside =
                    any.distance > tolerance / scale && eigen(whole.normal(any.face)).dot(p - eigen(any.point)) < 0;
            }
        });
        double squares = 0;
        std::size_t on = 0, inside = 0;
        one.score = 0;
        for (const Sample& sample : samples) {
            one.score += sample.score / static_cast<double>(samples.size());
            if (sample.squared >= 0) squares += sample.squared, ++on;
            if (sample.inside) ++inside;
        }
        one.share = static_cast<double>(on) / static_cast<double>(samples.size());
        one.inside = static_cast<double>(inside) / static_cast<double>(samples.size());
        one.residual = on > 0 ? scale * std::sqrt(squares / static_cast<double>(on)) : 0;
    }

    /// Registers the part to the faces, if this improves the score.
    void settle(const Mesh& part, const std::vector<bool>& of_part, const SurfacePoints& judges, double tolerance,
                PoseCandidate& one) const {
        PartAlignmentOptions how;
        how.samples = 500;
        how.iterations = 12;
        how.angle = 95;  // normals of a rough scan vary widely; only the other side of a wall must be excluded
        how.search_radius = std::min(10.0, 2.5 * tolerance / one.scale / whole.diagonal());
        const Motion start = on_unscaled(one.pose, one.scale);
        PoseCandidate other = one;
        const PartAlignment aligned = align_part(part, of_part, whole, start, {}, how);
        other.pose.rotation = aligned.pose.rotation;
        other.pose.translation = one.scale * aligned.pose.translation;
        judge(other, judges, tolerance, one.scale);
        if (other.score > one.score) one = other;
    }

    /// Slippable motions of the part that the whole confirms from this pose on, in the part's frame. `ways`, if not null, gets
    /// the ranges on the scaled whole.
    [[nodiscard]] SlippableMotions slippable_from(const SurfacePoints& points, const PoseCandidate& at, double tolerance,
                                                  std::vector<SlippableRange>* ways) const {
        constexpr double min_rotation = pi / 12;
        const SurfacePoints some = thinned(points, 300);
        const Extent extent = extent_of(points);
        const Nearness near(tolerance / at.scale);
        const Motion onto = on_unscaled(at.pose, at.scale);
        // Estimated from the whole's points under the part: more points, and smoother than the scan of a sherd.
        std::vector<Vector3d> places, normals;
        const Motion back = onto.inverse();
        for (std::size_t i = 0; i < some.size(); ++i) {
            const Vector3d p = onto(some.places[i]);
            const int j = grid->find(p, onto.rotation * some.normals[i]);
            if (j < 0 || (grid->points().places[static_cast<std::size_t>(j)] - p).norm() > 0.5 * grid->search_radius()) continue;
            places.push_back(back(grid->points().places[static_cast<std::size_t>(j)]));
            normals.push_back(back.rotation * grid->points().normals[static_cast<std::size_t>(j)]);
        }
        SlippableMotions slippable;
        // A flat bowl is nearly a plane and nearly a sphere: a stricter threshold reveals which motions are slippable.
        for (const double slide : {0.1, 0.06, 0.035}) {
            slippable = slippable_motions_of(places, normals, slide);
            if (slippable.kind != SlippableKind::more) break;
        }
        if (slippable.kind == SlippableKind::none || slippable.kind == SlippableKind::more) return slippable;
        const double missing = 1 - score_on(*grid, some, onto, near);
        const auto list = slippable.ways(pi, whole.diagonal() * at.scale, 72);
        bool any_rotation = false, any_translation = false;
        for (const auto& way : list) {
            double reached = 0;
            for (const SlippableMotions::Step& step : way) {
                if (1 - score_on(*grid, some, onto.after(step.motion), near) > 1.2 * missing + 0.03) break;
                reached = step.amount;
            }
            const bool rotates = way.front().rotates;
            if (std::abs(reached) >= (rotates ? min_rotation : length_apart * extent.size))
                (rotates ? any_rotation : any_translation) = true;
            if (ways == nullptr) continue;
            // The ways of positive sign come first, then those of negative sign.
            const auto number = static_cast<std::size_t>(&way - list.data());
            if (number >= list.size() / 2) {
                (*ways)[number - list.size() / 2].minimum = reached;
            } else {
                SlippableRange& one = ways->emplace_back();
                one.rotates = rotates;
                one.maximum = reached;
                one.point = at.pose(slippable.point);
                one.direction = at.pose.rotation * (rotates ? Vector3d(Eigen::AngleAxisd(way.front().motion.rotation).axis())
                                                            : Vector3d(way.front().motion.translation.normalized()));
            }
        }
        if (slippable.kind == SlippableKind::cylinder && any_rotation != any_translation)
            slippable.kind = any_rotation ? SlippableKind::rotation : SlippableKind::translation;
        if (!any_rotation && !any_translation) slippable.kind = SlippableKind::none;
        if (ways != nullptr)
            std::erase_if(*ways, [&](const SlippableRange& one) {
                return one.maximum - one.minimum < (one.rotates ? min_rotation : length_apart * extent.size);
            });
        return slippable;
    }

    void decide(const SurfacePoints& points, double tolerance, PoseSearchResult& result) const;
};

void PoseSearch::State::decide(const SurfacePoints& points, double tolerance, PoseSearchResult& result) const {
    const PoseCandidate& best = result.candidates.front();
    const SlippableMotions open = slippable_from(points, best, tolerance, &result.ways);
    result.slippable = open;
    result.slippable.point = best.pose(open.point);
    result.slippable.direction = best.pose.rotation * open.direction;
    const bool alone = result.candidates.size() < 2;
    const double second = alone ? 0 : result.candidates[1].score;
    result.margin = std::min(max_margin, std::log((1 - second + 0.02) / (1 - best.score + 0.02)));
    const double rated = confidence_at_rest + confidence_of_margin * result.margin + confidence_of_score * best.score;
    result.confidence = 1 / (1 + std::exp(-rated));
    const auto per_cent = [](double share) { return digits(100 * share, 3) + " %"; };
    const SurfacePoints some = thinned(points, 300);
    const SlippableKind own = slippable_motions_of(some.places, some.normals, 0.02).kind;
    if (own == SlippableKind::plane) {
        result.confidence = 0;
        result.reason = "it is flat: it lies as well in any flat place";
    } else if (open.kind == SlippableKind::more || own == SlippableKind::more || points.size() < 30) {
        result.confidence = 0;
        result.reason = "it has too little shape: it lies as well nearly anywhere";
    } else if (result.confidence >= options.min_confidence) {
        result.decided = true;
    } else if (!alone && result.margin < 0.1) {
        const PoseCandidate& other = result.candidates[1];
        result.reason = "it lies as well in another place, turned by " +
                        digits(angle_between(best.pose, other.pose) * 180 / pi, 3) + " degrees: " + per_cent(best.share) +
                        " of it within the tolerance here, " + per_cent(other.share) + " there";
    } else {
        result.reason = "the best place explains " + per_cent(best.share) + " of it (score " + digits(best.score, 3) +
                        "), another one nearly as much (score " + digits(second, 3) + "): too little to tell";
    }
}

PoseSearch::~PoseSearch() = default;
PoseSearch::PoseSearch(PoseSearch&&) noexcept = default;

PoseSearch::PoseSearch(const SurfaceSearch& whole, const PoseSearchOptions& options) {
    check_options(options, "pose search");
    if (options.min_scale > options.max_scale)
        fail_usage("the smallest scale searched is larger than the largest", "exchange them");
    state_ = std::make_unique<State>(whole, options);
    State& s = *state_;
    const double area = surface_area(whole.mesh());
    if (!(area > 0)) fail_input("template", "has no area, so that nothing can be laid onto it", "is it the right file?");
    s.spacing = std::sqrt(0.7 * area / options.points);
    s.radius = s.spacing;
    SurfacePoints coarse = spread_points(whole.mesh(), {}, s.spacing, s.radius, options.seed);
    s.fine = spread_points(whole.mesh(), {}, s.spacing / 2, s.radius, options.seed);
    s.grid = std::make_unique<detail::NearestGrid>(s.fine, 0.06 * whole.diagonal());
    if (coarse.size() > 4096) coarse = thinned(coarse, 4096);
    s.table = std::make_unique<PairTable>(std::move(coarse), whole.diagonal(), 0.03 * whole.diagonal());
}

PoseSearchResult PoseSearch::find(const Mesh& part, const std::vector<bool>& of_part) const {
    return find(part, of_part, state_->options.min_scale, state_->options.max_scale);
}

PoseSearchResult PoseSearch::find(const Mesh& part, const std::vector<bool>& of_part, double min_scale, double max_scale) const {
    const State& s = *state_;
    if (!(min_scale > 0 && max_scale >= min_scale)) fail_usage("the range of scales is empty", "give two scales above 0");
    if (!of_part.empty() && of_part.size() != part.number_of_faces())
        fail_usage("there are " + std::to_string(of_part.size()) + " marks for " + std::to_string(part.number_of_faces()) +
                   " faces");
    if (!(marked_area(part, of_part) > 0))
        fail_input("fragment", "has no area that could be laid onto a template", "look at its faces and facets");
    // A part is no larger than its whole, and a tiny part cannot be distinguished from noise.
    constexpr double too_large = 1.8, too_small = 0.01;  // ratios of box diagonals, which vary with rotation
    const double ratio = marked_diagonal(part, of_part) / s.whole.diagonal();
    if (ratio > too_large * max_scale || ratio < too_small * min_scale) {
        PoseSearchResult result;
        result.reason = "it is " +
                        (ratio > max_scale ? digits(ratio / max_scale, 3) + " times as large as"
                                           : "1/" + digits(min_scale / ratio, 3) + " of") +
                        " the template, a part of which it is to be: is it in another unit?";
        return result;
    }
    const auto scales = s.scales(min_scale, max_scale);
    const bool free = scales.size() > 1;

    std::vector<Proposal> all;
    const SurfacePoints middling = s.points_of(part, of_part, std::sqrt(min_scale * max_scale));
    const Extent extent = extent_of(middling);
    for (const double scale : scales) {
        if (scales.size() == 1) s.propose(middling, extent, scale, free, all);
        else s.propose(s.points_of(part, of_part, scale), extent, scale, free, all);
    }
    if (all.empty()) {
        PoseSearchResult result;
        result.reason = "it has too little shape: no pair of its places is found on the template";
        return result;
    }
    std::stable_sort(all.begin(), all.end(), [](const Proposal& a, const Proposal& b) { return a.score > b.score; });

    // Proposals are relative to the part's centroid and in the whole's unit: converts them to the part's file and the scaled
    // whole.
    const auto in_file = [&](const Motion& proposal, double scale) {
        Motion pose;
        pose.rotation = proposal.rotation;
        pose.translation = scale * proposal.translation - pose.rotation * extent.middle;
        return pose;
    };
    const auto really_different = [&](const PoseCandidate& a, const PoseCandidate& b) {
        return State::differ(on_unscaled(a.pose, a.scale), on_unscaled(b.pose, b.scale), extent.middle,
                             extent.size / std::sqrt(a.scale * b.scale));
    };
    const double tolerance = s.options.tolerance * extent.size;
    const auto pose_of = [&](const Proposal& one) {
        return PoseCandidate{in_file(one.pose, one.scale), one.scale, one.score, 0, 0, 0};
    };
    // Poses that differ by a slippable motion of the part, as far as the whole confirms it at the first proposal, count as
    // equal.
    const SlippableMotions open = s.slippable_from(middling, pose_of(all.front()), tolerance, nullptr);
    const auto another = [&](const PoseCandidate& one, const PoseCandidate& than) {
        if (!really_different(one, than)) return false;
        if (open.kind == SlippableKind::none || std::abs(std::log(one.scale / than.scale)) > scale_apart) return true;
        return !open.contains(than.pose.inverse().after(one.pose), extent.middle, angle_apart, length_apart * extent.size);
    };
    const auto keep_others = [&](std::vector<PoseCandidate>& list, const PoseCandidate& one) {
        if (std::all_of(list.begin(), list.end(), [&](const auto& other) { return another(one, other); })) list.push_back(one);
    };
    PoseSearchResult result;
    std::vector<PoseCandidate> kept;
    for (const Proposal& proposal : all)
        if (kept.size() < static_cast<std::size_t>(s.options.candidates)) keep_others(kept, pose_of(proposal));
    const SurfacePoints judges = thinned(middling, 800);
    const auto sort_kept = [&] {
        std::stable_sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
    };
    for (PoseCandidate& one : kept) s.judge(one, judges, tolerance, one.scale);
    sort_kept();
    for (std::size_t k = 0; k < std::min<std::size_t>(4, kept.size()); ++k) s.settle(part, of_part, judges, tolerance, kept[k]);
    sort_kept();
    for (const PoseCandidate& one : kept) keep_others(result.candidates, one);
    s.decide(middling, tolerance, result);
    return result;
}

void PoseSearchOptions::describe(OptionList& visit) {
    visit("search-least-scale", min_scale, "smallest scale of the template that is searched", Range{1e-6, 1e6});
    visit("search-most-scale", max_scale, "largest scale of the template that is searched", Range{1e-6, 1e6});
    visit("search-tolerance", tolerance, "maximum distance from the template of what lies on it", Range{1e-6, 1},
          "share of the fragment's size");
    visit("min-confidence", min_confidence, "minimum confidence of a searched pose; below it the fragment is not placed",
          Range{0, 1});
    visit("search-points", points, "number of points sampled on the template", Range{50, 4000});
    visit("search-references", references, "number of reference points of a fragment", Range{1, 4000});
    visit("search-partners", partners, "number of further points of the fragment that vote for each reference point",
          Range{1, 100000});
    visit("search-candidates", candidates, "number of candidate poses that are refined", Range{1, 1000});
    visit("search-seed", seed, "random seed of the search", Range{0, 9007199254740992.0});
}

}  // namespace ostraka
