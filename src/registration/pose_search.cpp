#include "ostraka/registration/pose_search.h"
#include "ostraka/core/angles.h"

#include "registration/grid_pose.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/plane_motion.h"
#include "ostraka/registration/part_alignment.h"
#include "registration/pair_votes.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

using detail::Nearness;
using detail::refined_on;
using detail::score_on;
using detail::thinned;

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

    State(const SurfaceSearch& search, const PoseSearchOptions& search_options) : whole(search), options(search_options) {}

    [[nodiscard]] std::vector<double> scales(double minimum, double maximum) const {
        if (!(maximum > minimum * (1 + 1e-9))) return {minimum};
        const int steps = std::max(1, static_cast<int>(std::ceil(std::log(maximum / minimum) / std::log(1 + scale_step))));
        std::vector<double> result;
        for (int k = 0; k <= steps; ++k) result.push_back(minimum * std::pow(maximum / minimum, static_cast<double>(k) / steps));
        return result;
    }

    /// The part's points in its own unit, about its centroid, with the density of the whole's points.
    [[nodiscard]] SurfacePoints points_of(const Mesh& part, const std::vector<bool>& of_part, double scale) const {
        constexpr double minimum = 300;
        const double part_spacing = std::sqrt(0.7 * marked_area(part, of_part) / minimum);
        return spread_points(part, of_part, std::min(spacing * scale, part_spacing), radius * scale, options.seed);
    }

    void propose(const SurfacePoints& points, const Extent& extent, double scale, bool free,
                 std::vector<Proposal>& proposals) const {
        constexpr std::size_t refined_count = 300, scored_count = 300;
        SurfacePoints small = thinned(points, 1500);
        small.spacing /= scale;
        for (Vector3d& p : small.places) p = (p - extent.middle) / scale;
        const SurfacePoints scored_sample = thinned(small, scored_count);
        const double tolerance = options.tolerance * extent.size / scale;
        const Nearness near(tolerance);
        const auto voted = table->vote(small, options.references, options.partners, 8, options.seed);
        std::vector<std::pair<double, std::size_t>> order(voted.size());
        const Nearness wide(2 * tolerance);
        parallel_for(voted.size(), 16, [&](std::size_t i) {
            order[i] = {-score_on(*grid, scored_sample, voted[i].motion, wide), i};
        });
        std::sort(order.begin(), order.end());
        if (order.size() > refined_count) order.resize(refined_count);
        const std::size_t first = proposals.size();
        proposals.resize(first + order.size());
        parallel_for(order.size(), 8, [&](std::size_t k) {
            Proposal& proposal = proposals[first + k];
            proposal.pose = refined_on(*grid, scored_sample, voted[order[k].second].motion, tolerance, 14, free);
            proposal.scale = scale / proposal.pose.scale;
            proposal.score = score_on(*grid, scored_sample, proposal.pose, near);
        });
    }

    /// Whether two poses of the part are distinct.
    [[nodiscard]] static bool differ(const Motion& a, const Motion& b, const Vector3d& middle, double size) {
        return angle_between(a, b) > angle_apart || (a(middle) - b(middle)).norm() > length_apart * size ||
               std::abs(std::log(a.scale / b.scale)) > scale_apart;
    }

    void judge(PoseCandidate& candidate, const SurfacePoints& points, double tolerance, double scale) const {
        const Nearness near(tolerance / scale);
        struct Sample {
            double score = 0, squared = -1;
            bool inside = false;
        };
        std::vector<Sample> samples(points.size());
        const Motion onto = on_unscaled(candidate.pose, scale);
        parallel_for(points.size(), [&](std::size_t i) {
            const Vector3d p = onto(points.places[i]), n = onto.rotation * points.normals[i];
            const auto hit = whole.closest_compatible(point_of(p), vector_of(n), 0.5, 2.5 * tolerance / scale);
            if (hit) {
                samples[i].score = near(hit->distance);
                if (hit->distance < tolerance / scale) samples[i].squared = hit->distance * hit->distance;
            }
            if (samples[i].squared < 0) {
                const SurfaceHit nearest = whole.closest(point_of(p));
                samples[i].inside =
                    nearest.distance > tolerance / scale && eigen(whole.normal(nearest.face)).dot(p - eigen(nearest.point)) < 0;
            }
        });
        double squares = 0;
        std::size_t on_count = 0, inside_count = 0;
        candidate.score = 0;
        for (const Sample& sample : samples) {
            candidate.score += sample.score / static_cast<double>(samples.size());
            if (sample.squared >= 0) squares += sample.squared, ++on_count;
            if (sample.inside) ++inside_count;
        }
        candidate.share = static_cast<double>(on_count) / static_cast<double>(samples.size());
        candidate.inside = static_cast<double>(inside_count) / static_cast<double>(samples.size());
        candidate.residual = on_count > 0 ? scale * std::sqrt(squares / static_cast<double>(on_count)) : 0;
    }

    /// Registers the part to the faces, if this improves the score.
    void refine_on_faces(const Mesh& part, const std::vector<bool>& of_part, const SurfacePoints& judges, double tolerance,
                         PoseCandidate& candidate) const {
        PartAlignmentOptions alignment_options;
        alignment_options.samples = 500;
        alignment_options.iterations = 12;
        alignment_options.angle = 95;  // normals of a rough scan vary widely; only the other side of a wall must be excluded
        alignment_options.search_radius = std::min(10.0, 2.5 * tolerance / candidate.scale / whole.diagonal());
        const Motion start = on_unscaled(candidate.pose, candidate.scale);
        PoseCandidate refined = candidate;
        const PartAlignment aligned = align_part(part, of_part, whole, start, {}, alignment_options);
        refined.pose.rotation = aligned.pose.rotation;
        refined.pose.translation = candidate.scale * aligned.pose.translation;
        judge(refined, judges, tolerance, candidate.scale);
        if (refined.score > candidate.score) candidate = refined;
    }

    /// Slippable motions of the part that the whole confirms from this pose on, in the part's frame. `ways`, if not null, gets
    /// the ranges on the scaled whole.
    [[nodiscard]] SlippableMotions slippable_from(const SurfacePoints& points, const PoseCandidate& candidate, double tolerance,
                                                  std::vector<SlippableRange>* ways) const {
        constexpr double min_rotation = pi / 12;
        const SurfacePoints sample = thinned(points, 300);
        const Extent extent = extent_of(points);
        const Nearness near(tolerance / candidate.scale);
        const Motion onto = on_unscaled(candidate.pose, candidate.scale);
        // Estimated from the whole's points under the part: more points, and smoother than the scan of a sherd.
        std::vector<Vector3d> places, normals;
        const Motion back = onto.inverse();
        for (std::size_t i = 0; i < sample.size(); ++i) {
            const Vector3d p = onto(sample.places[i]);
            const int j = grid->find(p, onto.rotation * sample.normals[i]);
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
        const double missing = 1 - score_on(*grid, sample, onto, near);
        const auto sampled_ways = slippable.sampled_motions(pi, whole.diagonal() * candidate.scale, 72);
        bool any_rotation = false, any_translation = false;
        for (const auto& way : sampled_ways) {
            double reached = 0;
            for (const SlippableMotions::Step& step : way) {
                if (1 - score_on(*grid, sample, onto.after(step.motion), near) > 1.2 * missing + 0.03) break;
                reached = step.amount;
            }
            const bool rotates = way.front().rotates;
            if (std::abs(reached) >= (rotates ? min_rotation : length_apart * extent.size))
                (rotates ? any_rotation : any_translation) = true;
            if (ways == nullptr) continue;
            // The ways of positive sign come first, then those of negative sign.
            const auto number = static_cast<std::size_t>(&way - sampled_ways.data());
            if (number >= sampled_ways.size() / 2) {
                (*ways)[number - sampled_ways.size() / 2].minimum = reached;
            } else {
                SlippableRange& range = ways->emplace_back();
                range.rotates = rotates;
                range.maximum = reached;
                range.point = candidate.pose(slippable.point);
                range.direction =
                    candidate.pose.rotation * (rotates ? Vector3d(Eigen::AngleAxisd(way.front().motion.rotation).axis())
                                                       : Vector3d(way.front().motion.translation.normalized()));
            }
        }
        if (slippable.kind == SlippableKind::cylinder && any_rotation != any_translation)
            slippable.kind = any_rotation ? SlippableKind::rotation : SlippableKind::translation;
        if (!any_rotation && !any_translation) slippable.kind = SlippableKind::none;
        if (ways != nullptr)
            std::erase_if(*ways, [&](const SlippableRange& range) {
                return range.maximum - range.minimum < (range.rotates ? min_rotation : length_apart * extent.size);
            });
        return slippable;
    }

    void decide(const SurfacePoints& points, double tolerance, PoseSearchResult& result) const;
};

void PoseSearch::State::decide(const SurfacePoints& points, double tolerance, PoseSearchResult& result) const {
    const PoseCandidate& best = result.candidates.front();
    const SlippableMotions open = slippable_from(points, best, tolerance, &result.slippable_ranges);
    result.slippable = open;
    result.slippable.point = best.pose(open.point);
    result.slippable.direction = best.pose.rotation * open.direction;
    const bool single_candidate = result.candidates.size() < 2;
    const double second = single_candidate ? 0 : result.candidates[1].score;
    result.margin = std::min(max_margin, std::log((1 - second + 0.02) / (1 - best.score + 0.02)));
    const double log_odds = confidence_at_rest + confidence_of_margin * result.margin + confidence_of_score * best.score;
    result.confidence = 1 / (1 + std::exp(-log_odds));
    const auto per_cent = [](double share) { return digits(100 * share, 3) + " %"; };
    const SurfacePoints sample = thinned(points, 300);
    const SlippableKind part_kind = slippable_motions_of(sample.places, sample.normals, 0.02).kind;
    if (part_kind == SlippableKind::plane) {
        result.confidence = 0;
        result.reason = "it is flat: it fits equally well in any flat place";
    } else if (open.kind == SlippableKind::more || part_kind == SlippableKind::more || points.size() < 30) {
        result.confidence = 0;
        result.reason = "it has too little shape: it fits equally well nearly anywhere";
    } else if (result.confidence >= options.min_confidence) {
        result.decided = true;
    } else if (!single_candidate && result.margin < 0.1) {
        const PoseCandidate& second_candidate = result.candidates[1];
        result.reason = fmt::format(
            "it fits equally well in another place, rotated by {} degrees: {} of it is within the tolerance here, {} there",
            digits(angle_between(best.pose, second_candidate.pose) * 180 / pi, 3), per_cent(best.share),
            per_cent(second_candidate.share));
    } else {
        result.reason = fmt::format(
            "the best place explains {} of it (score {}), another one nearly as much (score {}): too little to decide",
            per_cent(best.share), digits(best.score, 3), digits(second, 3));
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
    if (!(area > 0)) fail_input("template", "has no area, so nothing can be registered to it", "check that it is the right file");
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
        fail_usage(fmt::format("there are {} marks for {} faces", of_part.size(), part.number_of_faces()));
    if (!(marked_area(part, of_part) > 0))
        fail_input("fragment", "has no area that could be registered to a template", "check its faces and facets");
    // A part is no larger than its whole, and a tiny part cannot be distinguished from noise.
    constexpr double too_large = 1.8, too_small = 0.01;  // ratios of box diagonals, which vary with rotation
    const double ratio = marked_diagonal(part, of_part) / s.whole.diagonal();
    if (ratio > too_large * max_scale || ratio < too_small * min_scale) {
        PoseSearchResult result;
        result.reason = fmt::format("it is {} the template, of which it should be a part: is it in another unit?",
                                    ratio > max_scale ? digits(ratio / max_scale, 3) + " times as large as"
                                                      : "1/" + digits(min_scale / ratio, 3) + " of the size of");
        return result;
    }
    const auto scales = s.scales(min_scale, max_scale);
    const bool free = scales.size() > 1;

    std::vector<Proposal> proposals;
    const SurfacePoints middling = s.points_of(part, of_part, std::sqrt(min_scale * max_scale));
    const Extent extent = extent_of(middling);
    for (const double scale : scales) {
        if (scales.size() == 1) s.propose(middling, extent, scale, free, proposals);
        else s.propose(s.points_of(part, of_part, scale), extent, scale, free, proposals);
    }
    if (proposals.empty()) {
        PoseSearchResult result;
        result.reason = "it has too little shape: no pair of its points is found on the template";
        return result;
    }
    std::stable_sort(proposals.begin(), proposals.end(), [](const Proposal& a, const Proposal& b) { return a.score > b.score; });

    // Proposals are relative to the part's centroid and in the whole's unit: converts them to the part's file and the scaled
    // whole.
    const auto in_file = [&](const Motion& proposal, double scale) {
        Motion pose;
        pose.rotation = proposal.rotation;
        pose.translation = scale * proposal.translation - pose.rotation * extent.middle;
        return pose;
    };
    const auto poses_differ = [&](const PoseCandidate& a, const PoseCandidate& b) {
        return State::differ(on_unscaled(a.pose, a.scale), on_unscaled(b.pose, b.scale), extent.middle,
                             extent.size / std::sqrt(a.scale * b.scale));
    };
    const double tolerance = s.options.tolerance * extent.size;
    const auto pose_of = [&](const Proposal& proposal) {
        return PoseCandidate{in_file(proposal.pose, proposal.scale), proposal.scale, proposal.score, 0, 0, 0};
    };
    // Poses that differ by a slippable motion of the part, as far as the whole confirms it at the first proposal, count as
    // equal.
    const SlippableMotions open = s.slippable_from(middling, pose_of(proposals.front()), tolerance, nullptr);
    const auto is_distinct = [&](const PoseCandidate& candidate, const PoseCandidate& other) {
        if (!poses_differ(candidate, other)) return false;
        if (open.kind == SlippableKind::none || std::abs(std::log(candidate.scale / other.scale)) > scale_apart) return true;
        return !open.contains(other.pose.inverse().after(candidate.pose), extent.middle, angle_apart, length_apart * extent.size);
    };
    const auto add_if_distinct = [&](std::vector<PoseCandidate>& accepted, const PoseCandidate& candidate) {
        if (std::all_of(accepted.begin(), accepted.end(), [&](const auto& other) { return is_distinct(candidate, other); }))
            accepted.push_back(candidate);
    };
    PoseSearchResult result;
    std::vector<PoseCandidate> kept;
    for (const Proposal& proposal : proposals)
        if (kept.size() < static_cast<std::size_t>(s.options.candidates)) add_if_distinct(kept, pose_of(proposal));
    const SurfacePoints judges = thinned(middling, 800);
    const auto sort_kept = [&] {
        std::stable_sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
    };
    for (PoseCandidate& candidate : kept) s.judge(candidate, judges, tolerance, candidate.scale);
    sort_kept();
    for (std::size_t k = 0; k < std::min<std::size_t>(4, kept.size()); ++k)
        s.refine_on_faces(part, of_part, judges, tolerance, kept[k]);
    sort_kept();
    for (const PoseCandidate& candidate : kept) add_if_distinct(result.candidates, candidate);
    s.decide(middling, tolerance, result);
    return result;
}

void PoseSearchOptions::declare_options(OptionList& list) {
    list("search-min-scale", min_scale, "minimum scale of the template in the search for poses", Range{1e-6, 1e6});
    list("search-max-scale", max_scale, "maximum scale of the template in the search for poses", Range{1e-6, 1e6});
    list("search-tolerance", tolerance,
         "search for poses: points of a fragment within this distance of the template count as lying on it", Range{1e-6, 1},
         "share of the fragment's size");
    list("min-confidence", min_confidence, "minimum confidence of a searched pose; below it, the fragment is not placed",
         Range{0, 1});
    list("search-points", points, "number of points sampled on the template in the search for poses", Range{50, 4000});
    list("search-references", references, "number of reference points of a fragment in the search for poses", Range{1, 4000});
    list("search-partners", partners, "number of further points of the fragment that vote for each reference point",
         Range{1, 100000});
    list("search-candidates", candidates, "number of candidate poses of a fragment that are refined", Range{1, 1000});
    list("search-seed", seed, "random seed of the search for poses", Range{0, 9007199254740992.0});
}

}  // namespace ostraka
