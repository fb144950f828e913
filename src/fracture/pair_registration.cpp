#include "ostraka/fracture/pair_registration.h"
#include "ostraka/core/angles.h"

#include "fracture/fracture_align.h"
#include "fracture/prepared_fracture.h"
#include "fracture/rim_stretches.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/files/json_build.h"
#include "ostraka/geom/plane_motion.h"
#include "ostraka/registration/pose_json.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <tuple>

namespace ostraka {

namespace {

/// Indices of about `count` elements at equal steps.
std::vector<std::size_t> thinned(std::size_t size, std::size_t count) {
    std::vector<std::size_t> indices;
    const std::size_t wanted = std::min(size, count);
    for (std::size_t i = 0; i < wanted; ++i) indices.push_back((2 * i + 1) * size / (2 * wanted));
    return indices;
}

/// Whether two poses are similar: small relative rotation, and a small displacement at the second fragment.
bool similar_poses(const Motion& a, const Motion& b, const Vector3d& middle, double shift, double angle) {
    if ((a(middle) - b(middle)).norm() > shift) return false;
    return Eigen::AngleAxisd(a.rotation.transpose() * b.rotation).angle() < angle;
}

struct ScoredPose {
    Motion pose;
    double score;
};

/// The best poses that are pairwise dissimilar.
std::vector<ScoredPose> distinct(std::vector<ScoredPose> poses, std::size_t count, const Vector3d& middle, double shift,
                                 double angle) {
    std::stable_sort(poses.begin(), poses.end(), [](const ScoredPose& x, const ScoredPose& y) { return x.score > y.score; });
    std::vector<ScoredPose> kept;
    std::vector<Vector3d> middles;
    const double trace = 1 + 2 * std::cos(angle);  // of a rotation by the angle
    for (const ScoredPose& candidate : poses) {
        if (kept.size() == count) break;
        const Vector3d position = candidate.pose(middle);
        bool is_duplicate = false;
        for (std::size_t k = 0; k < kept.size() && !is_duplicate; ++k)
            is_duplicate = (middles[k] - position).squaredNorm() <= shift * shift &&
                           kept[k].pose.rotation.cwiseProduct(candidate.pose.rotation).sum() > trace;
        if (is_duplicate) continue;
        kept.push_back(candidate);
        middles.push_back(position);
    }
    return kept;
}

/// Scores poses quickly, with few points of the second side.
class QuickScore {
public:
    QuickScore(const PreparedFracture::Parts& on, const PreparedFracture::Parts& from, double search_radius)
        : on_(on),
          from_(from),
          fracture_count_on_(on.side.fracture.places.size()),
          side_(from.side),
          search_radius_(search_radius),
          fracture_samples_(thinned(side_.fracture.places.size(), 160)),
          intact_samples_(thinned(side_.intact.places.size(), 120)),
          fracture_sample_area_(fracture_samples_.empty() ? 0
                                                          : side_.fracture.area / static_cast<double>(fracture_samples_.size())),
          intact_sample_area_(intact_samples_.empty() ? 0 : side_.intact.area / static_cast<double>(intact_samples_.size())) {}

    [[nodiscard]] double operator()(const Motion& pose) const {
        const auto [touching, inside] = touching_and_inside(pose);
        return touching - inside;
    }
    /// A few ICP steps with few points while the search radius falls to `close`, and the score of the result, where contact is
    /// measured within `close` across the surface.
    [[nodiscard]] ScoredPose refined_coarsely(Motion pose, const PointTree& frames, double close) const {
        constexpr int steps = 6;
        for (int step = 0; step < steps; ++step) {
            const double radius = search_radius_ * std::pow(close / search_radius_, static_cast<double>(step) / (steps - 1));
            std::vector<PlanePoint> planes;
            for (const std::size_t i : fracture_samples_) {
                const Vector3d p = pose(side_.fracture.places[i]);
                const Index k = on_.grid->near(p);
                if (k == no_index || k >= fracture_count_on_) continue;
                const double distance = on_.normals[k].dot(on_.places[k] - p), ratio = distance * distance / (radius * radius);
                if (ratio >= 1 || (on_.places[k] - p).squaredNorm() > search_radius_ * search_radius_ ||
                    -on_.normals[k].dot(pose.rotation * side_.fracture.normals[i]) < 0.3)
                    continue;
                planes.push_back({p, on_.normals[k], distance, (1 - ratio) * (1 - ratio)});
            }
            for (std::size_t i = 0; i < side_.frames.size(); i += 3) {
                const RimFrame& frame = side_.frames[i];
                const Vector3d p = pose(frame.place);
                const PointTree::Near near = frames.nearest(point_of(p), 1.5 * radius);
                if (near.index == no_index) continue;
                const RimFrame& other = on_.side.frames[near.index];
                if (other.facet != frame.facet || other.side.dot(pose.rotation * frame.side) < 0.5 ||
                    other.fracture.dot(pose.rotation * frame.fracture) > -min_facing)
                    continue;
                const double weight = std::pow(1 - near.squared / (2.25 * radius * radius), 2);
                planes.push_back({p, other.side, other.side.dot(other.place - p), weight});
                planes.push_back({p, other.fracture, other.fracture.dot(other.place - p), weight});
            }
            if (planes.size() < 6 || !step_onto_planes(planes, pose)) break;
        }
        double touching = 0;
        for (const std::size_t i : fracture_samples_) {
            const Vector3d p = pose(side_.fracture.places[i]);
            const Index k = on_.grid->near(p);
            if (k == no_index || k >= fracture_count_on_) continue;
            const double ratio = on_.normals[k].dot(p - on_.places[k]) / close,
                         facing = -on_.normals[k].dot(pose.rotation * side_.fracture.normals[i]);
            if (std::abs(ratio) < 1 && facing > 0.3 && (on_.places[k] - p).squaredNorm() < search_radius_ * search_radius_)
                touching += fracture_sample_area_ * (1 - ratio * ratio) * facing;
        }
        const double score = touching - touching_and_inside(pose).second;
        return {pose, score > 0 ? score * shares_axis(pose) : score};
    }

private:
    [[nodiscard]] std::pair<double, double> touching_and_inside(const Motion& pose) const {
        double touching = 0, inside = 0;
        const auto add_sample = [&](const Vector3d& place, const Vector3d& normal, double area, bool fracture) {
            const Vector3d p = pose(place);
            const Index i = on_.grid->near(p);
            if (i == no_index) return;
            const Vector3d offset = p - on_.places[i];
            const double above = on_.normals[i].dot(offset), squared = offset.squaredNorm() / (search_radius_ * search_radius_);
            if (fracture && i < fracture_count_on_ && squared < 1) {
                const double facing = -on_.normals[i].dot(pose.rotation * normal);
                if (facing > 0.3) touching += area * (1 - squared) * facing;
            }
            // Far from its nearest sample a point counts as inside only if it lies straight below it, as the normals are
            // inexact.
            if (above < -0.5 * search_radius_ && above < -0.9 * offset.norm())
                inside += area * std::min(1.0, -above / search_radius_ - 0.5);
        };
        for (const std::size_t i : fracture_samples_)
            add_sample(side_.fracture.places[i], side_.fracture.normals[i], fracture_sample_area_, true);
        for (const std::size_t i : intact_samples_)
            add_sample(side_.intact.places[i], side_.intact.normals[i], intact_sample_area_, false);
        return {touching, inside};
    }

    /// 1 if the normals of both fragments meet a common axis as well as each fragment's its own; less otherwise.
    [[nodiscard]] double shares_axis(const Motion& pose) const {
        const double deviation = common_axis_deviation(on_, from_, pose) / std::min(on_.size, from_.size);
        return std::sqrt(0.02 / (0.02 + deviation));
    }

    const PreparedFracture::Parts &on_, &from_;
    std::size_t fracture_count_on_;  ///< number of fracture samples, the first of the places
    const FractureSide& side_;
    double search_radius_;
    std::vector<std::size_t> fracture_samples_, intact_samples_;
    double fracture_sample_area_, intact_sample_area_;
};

/// The best of all poses that map a frame onto a frame; `tried` counts them.
std::vector<ScoredPose> best_frame_poses(const PreparedFracture::Parts& on, const PreparedFracture::Parts& from,
                                         double search_radius, std::size_t count, std::size_t& tried) {
    const QuickScore quick_score(on, from, search_radius);
    const FractureSide &a = on.side, &b = from.side;
    const std::size_t columns = b.frames.size();
    std::vector<double> scores(a.frames.size() * columns);
    const double not_tried = -std::numeric_limits<double>::infinity();
    parallel_for(scores.size(), [&](std::size_t k) {
        const RimFrame &f = a.frames[k / columns], &g = b.frames[k % columns];
        scores[k] = f.facet == g.facet ? quick_score(g.onto(f)) : not_tried;
    });
    tried = static_cast<std::size_t>(std::count_if(scores.begin(), scores.end(), [&](double s) { return s > not_tried; }));
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < scores.size(); ++k)
        if (scores[k] > 0) order.push_back(k);
    std::sort(order.begin(), order.end(),
              [&](std::size_t x, std::size_t y) { return std::pair(-scores[x], x) < std::pair(-scores[y], y); });
    if (order.size() > count) order.resize(count);
    std::vector<ScoredPose> poses;
    for (const std::size_t k : order) poses.push_back({b.frames[k % columns].onto(a.frames[k / columns]), scores[k]});
    return poses;
}

/// Poses that register stretches of the rims, most informative first.
std::vector<ScoredPose> best_stretch_poses(const PreparedFracture::Parts& on, const FractureSide& b, double tolerance,
                                           std::size_t count) {
    const double shortest = 0.05 * std::min(on.side.rim_length, b.rim_length);
    std::vector<ScoredPose> poses;
    for (const StretchFit& fit : matching_stretches(on.side.loops, b.loops, shortest, tolerance, count))
        poses.push_back({fit.pose, fit.information});
    return poses;
}

/// The confidence of the best candidate, or the reason why there is no answer.
void decide(PairRegistration& result, const PairOptions& options) {
    if (result.candidates.empty()) {
        result.undecided = "no pose brings the fractures into contact";
        return;
    }
    const double best = result.candidates.front().log_odds;
    result.confidence = join_probability(
        best, result.candidates.size() > 1 ? best - result.candidates[1].log_odds : std::numeric_limits<double>::infinity());
    if (result.confidence < options.min_confidence)
        result.undecided = fmt::format("the evidence is as strong for unrelated fragments or for another pose: {}",
                                       weakest_evidence(result.candidates.front().evidence));
}

}  // namespace

PreparedFracture::PreparedFracture(const Fragment& fragment, const PairOptions& options) : parts_(std::make_unique<Parts>()) {
    check_options(options, "pair");
    Parts& parts = *parts_;
    parts.mesh = fragment.mesh;
    parts.name = fragment.name;
    parts.size = fragment_size(parts.mesh);
    if (!(parts.size > 0)) fail_input("fragment " + fragment.name, "has no area", "check its faces");
    const double search_radius = options.search_radius * parts.size;
    parts.side = FractureSide(fragment, 0.75 * search_radius, options.frames, options.samples);
    parts.width = 2 * parts.side.fracture.area / parts.side.rim_length;
    parts.faces = static_cast<std::size_t>(std::count(fragment.facets.begin(), fragment.facets.end(), Facet::fracture));
    parts.relief = deviations(parts.side.fracture.places).second;
    parts.noise = surface_noise(parts.side.intact);
    parts.edge = mean_edge_length(parts.mesh);
    const SurfaceSamples& intact = parts.side.intact;
    const double each = 1 / static_cast<double>(std::max<std::size_t>(1, intact.places.size()));
    for (const Vector3d& p : intact.places) parts.middle += each * p;
    for (std::size_t k = 0; k < intact.places.size(); ++k)
        parts.lines.add(intact.places[k] - parts.middle, intact.normals[k], each);
    parts.off_axis = parts.lines.off_axis();
    parts.fracture = PointTree(points_of(parts.side.fracture.places));
    parts.frames = PointTree(places_of(parts.side.frames));
    parts.places = parts.side.fracture.places;
    parts.normals = parts.side.fracture.normals;
    parts.places.insert(parts.places.end(), parts.side.intact.places.begin(), parts.side.intact.places.end());
    parts.normals.insert(parts.normals.end(), parts.side.intact.normals.begin(), parts.side.intact.normals.end());
    // About as fine as the spacing of the samples.
    const int cells = std::clamp(static_cast<int>(std::lround(64 * std::sqrt(options.samples / 2000.0))), 16, 64);
    parts.grid = std::make_unique<SampleGrid>(parts.places, 2 * search_radius, cells);
    parts.surface = std::make_unique<SurfaceSearch>(parts.mesh);
}

PreparedFracture::~PreparedFracture() = default;
PreparedFracture::PreparedFracture(PreparedFracture&&) noexcept = default;
PreparedFracture& PreparedFracture::operator=(PreparedFracture&&) noexcept = default;
const std::string& PreparedFracture::name() const { return parts_->name; }
const Mesh& PreparedFracture::mesh() const { return parts_->mesh; }
double PreparedFracture::size() const { return parts_->size; }
double PreparedFracture::fracture_area() const { return parts_->side.fracture.area; }
double PreparedFracture::rim_length() const { return parts_->side.rim_length; }
double PreparedFracture::width() const { return parts_->width; }
double PreparedFracture::relief() const { return parts_->relief; }
std::size_t PreparedFracture::fracture_faces() const { return parts_->faces; }

double join_scale(const PreparedFracture& a, const PreparedFracture& b) {
    constexpr double noise_factor = 240;  // the tolerance, a fortieth, is six times the noise
    const double smaller = std::min(a.size(), b.size()), noise = std::hypot(a.parts().noise, b.parts().noise);
    return std::min(smaller, std::max(std::min(6 * a.width(), 6 * b.width()), noise_factor * noise));
}

namespace {

/// An order that depends neither on the arguments' order nor on the poses.
bool goes_first(const PreparedFracture& a, const PreparedFracture& b) {
    const auto key = [](const PreparedFracture& fragment) {
        return std::tuple(fragment.fracture_area(), fragment.size(), fragment.rim_length(), fragment.name());
    };
    return key(a) > key(b);
}

/// Candidates ordered by their evidence from at most `samples` points; `aligned` refines a pose before it is measured.
template <class Align>
std::vector<PairCandidate> measured_candidates(const PreparedFracture& a, const PreparedFracture& b,
                                               const std::vector<ScoredPose>& poses, double tolerance, std::size_t samples,
                                               Align&& aligned) {
    std::vector<PairCandidate> candidates(poses.size());
    parallel_for(poses.size(), 1, [&](std::size_t i) {
        candidates[i].pose = aligned(poses[i].pose);
        candidates[i].evidence = measure_join(a, b, candidates[i].pose, tolerance, samples);
        candidates[i].log_odds = join_log_odds(candidates[i].evidence);
    });
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const PairCandidate& x, const PairCandidate& y) { return x.log_odds > y.log_odds; });
    return candidates;
}

std::vector<ScoredPose> scored(const std::vector<PairCandidate>& candidates) {
    std::vector<ScoredPose> result;
    for (const PairCandidate& candidate : candidates) result.push_back({candidate.pose, candidate.log_odds});
    return result;
}

PairRegistration search(const PreparedFracture& a, const PreparedFracture& b, const PairOptions& options) {
    const PreparedFracture::Parts &first = a.parts(), &second = b.parts();
    PairRegistration result;
    result.size = std::min(first.size, second.size);
    result.scale = join_scale(a, b);
    const double search_radius = options.search_radius * result.size, tolerance = options.last_search_radius * result.scale;
    result.fracture_a = first.side.fracture.area;
    result.fracture_b = second.side.fracture.area;
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& p : second.side.fracture.places) middle += p / static_cast<double>(second.side.fracture.places.size());
    const auto starts = static_cast<std::size_t>(options.starts), samples = static_cast<std::size_t>(options.samples),
               refined = static_cast<std::size_t>(options.refined);
    const auto distinct_poses = [&](std::vector<ScoredPose> candidates, std::size_t count, double degrees) {
        return distinct(std::move(candidates), count, middle, 0.5 * search_radius, degrees * pi / 180);
    };
    // Briefly refines the best poses of each kind and keeps the best of them.
    std::vector<ScoredPose> by_stretches =
                                distinct_poses(best_stretch_poses(first, second.side, tolerance, 20 * starts), starts, 6),
                            by_frames = distinct_poses(best_frame_poses(first, second, search_radius, 40 * starts, result.tried),
                                                       6 * starts, 6);
    std::vector<ScoredPose> coarse = by_stretches;
    coarse.insert(coarse.end(), by_frames.begin(), by_frames.end());
    const QuickScore quick_score(first, second, search_radius);
    parallel_for(coarse.size(), 8, [&](std::size_t k) {
        coarse[k] = quick_score.refined_coarsely(coarse[k].pose, first.frames, std::max(0.4 * search_radius, 1.5 * tolerance));
    });
    coarse = distinct_poses(std::move(coarse), starts + starts / 2, 5);
    std::vector<ScoredPose> poses, reserve;
    for (std::size_t k = 0; k < coarse.size(); ++k) (k < starts / 2 ? poses : reserve).push_back(coarse[k]);

    // Refines the best: quickly, better, then to the end, each time ranked by their evidence.
    const FractureAligner::Target target{first.side, first.fracture, first.frames, first.surface.get()};
    const FractureAligner rough(target, second.side, search_radius, tolerance, options.edges);
    constexpr double fine_radius = 4;  // in tolerances
    const FractureAligner fine(target, second.side, std::min(search_radius, fine_radius * tolerance), tolerance, options.edges);
    const auto few_samples = std::min<std::size_t>(300, samples), more_samples = std::min<std::size_t>(800, samples);
    const auto align_quickly = [&](const Motion& pose) { return rough.align(pose, few_samples, 10); };
    std::vector<ScoredPose> ranked = scored(measured_candidates(a, b, poses, tolerance, few_samples, align_quickly));
    // If the best of them are hopeless, so are the others; one is still reported, to give the reason.
    constexpr double min_log_odds = -7;  // log odds
    const bool hopeless = ranked.empty() || ranked.front().score < min_log_odds;
    if (!hopeless) {
        const std::vector<ScoredPose> ranked_reserve =
            scored(measured_candidates(a, b, reserve, tolerance, few_samples, align_quickly));
        ranked.insert(ranked.end(), ranked_reserve.begin(), ranked_reserve.end());
        ranked = scored(measured_candidates(a, b, distinct_poses(ranked, refined, 5), tolerance, more_samples,
                                            [&](const Motion& pose) { return rough.align(pose, more_samples, 20); }));
    }
    const std::size_t final_count =
        hopeless ? 1 : std::max<std::size_t>(static_cast<std::size_t>(options.candidates), refined / 3);
    for (PairCandidate& candidate : measured_candidates(a, b, distinct_poses(ranked, final_count, 5), tolerance, samples,
                                                        [&](const Motion& pose) { return fine.align(pose, samples, 30); })) {
        if (result.candidates.size() == static_cast<std::size_t>(options.candidates)) break;
        if (!(candidate.evidence.area > 0) ||
            std::any_of(result.candidates.begin(), result.candidates.end(), [&](const PairCandidate& accepted) {
                return similar_poses(accepted.pose, candidate.pose, middle, search_radius, 10 * pi / 180);
            }))
            continue;
        PairCandidate judged = fine.judge(candidate.pose, samples, 0.25);
        judged.evidence = candidate.evidence;
        judged.log_odds = candidate.log_odds;
        result.candidates.push_back(std::move(judged));
    }
    decide(result, options);
    return result;
}

}  // namespace

PairRegistration register_fractures(const PreparedFracture& a, const PreparedFracture& b, const PairOptions& options) {
    check_options(options, "pair");
    if (!goes_first(b, a)) return search(a, b, options);
    PairRegistration result = search(b, a, options);
    std::swap(result.fracture_a, result.fracture_b);
    for (PairCandidate& candidate : result.candidates) candidate.pose = candidate.pose.inverse();
    return result;
}

double initial_pair_score(const PreparedFracture& a, const PreparedFracture& b, const PairOptions& options, std::size_t places) {
    if (goes_first(b, a)) return initial_pair_score(b, a, options, places);
    const PreparedFracture::Parts &first = a.parts(), &second = b.parts();
    const double size = std::min(first.size, second.size);
    const QuickScore quick_score(first, second, options.search_radius * size);
    const auto rows = thinned(first.side.frames.size(), places), columns = thinned(second.side.frames.size(), places);
    std::vector<double> best(rows.size(), 0);
    parallel_for(rows.size(), 4, [&](std::size_t r) {
        const RimFrame& frame = first.side.frames[rows[r]];
        for (const std::size_t c : columns) {
            const RimFrame& other = second.side.frames[c];
            if (other.facet == frame.facet) best[r] = std::max(best[r], quick_score(other.onto(frame)));
        }
    });
    const double max_score = best.empty() ? 0 : *std::max_element(best.begin(), best.end());
    return max_score / std::min(first.side.fracture.area, second.side.fracture.area);
}

PairRegistration register_fractures(const Fragment& a, const Fragment& b, const PairOptions& options) {
    return register_fractures(PreparedFracture(a, options), PreparedFracture(b, options), options);
}

JsonValue pair_to_json(const PairRegistration& pair, const std::string& a, const std::string& b, JsonAllocator& allocator) {
    JsonValue result = json_object(allocator, "format", "ostraka-pair", "version", 1, "first", a, "second", b, "verdict",
                                   pair.decided() ? "together" : "undecided");
    if (!pair.decided()) add_members(result, allocator, "because", pair.undecided);
    const auto candidate_to_json = [&](const PairCandidate& candidate) {
        return json_object(allocator, "pose", pose_to_json(candidate.pose, allocator), "score", candidate.score, "contact",
                           candidate.contact, "rim", candidate.rim, "residual", candidate.residual, "penetration",
                           candidate.penetration, "depth", candidate.depth);
    };
    add_members(result, allocator, "confidence", pair.confidence, "size", pair.size, "fractureOfFirst", pair.fracture_a,
                "fractureOfSecond", pair.fracture_b, "tried", pair.tried, "candidates",
                json_list(pair.candidates, allocator, candidate_to_json));
    return result;
}

void PairOptions::declare_options(OptionList& list) {
    list("frames", frames, "number of local frames along each rim, from which initial poses are made", Range{4, 2000});
    list("samples", samples, "number of sample points on the fracture surface of each fragment, and on its intact surface",
         Range{50, 1e6});
    list("starts", starts, "number of initial poses, best first, that are refined coarsely", Range{1, 10000});
    list("refined", refined, "number of coarsely refined poses, best first, that are refined fully", Range{1, 1000});
    list("reach", search_radius, "initial search radius between two fracture surfaces", Range{1e-4, 1},
         "share of the root of the smaller fragment's area");
    list("last-reach", last_search_radius, "final search radius; fragments that penetrate each other more deeply are not joined",
         Range{1e-4, 1});
    list("edges", edges, "weight of the rims relative to the interiors of the fracture surfaces", Range{0, 1000});
    list("min-confidence", min_confidence, "minimum confidence of a joint; with a lower confidence there is no answer",
         Range{0, 1});
    list("candidates", candidates, "maximum number of poses reported, best first", Range{1, 1000});
}

}  // namespace ostraka
