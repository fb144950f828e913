#include "ostraka/reconstruction/search_placement.h"
#include "ostraka/core/angles.h"
#include "ostraka/stats/summary.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

bool few_landmarks(const FragmentPlacement& placement) { return !placement.problem.empty() && placement.landmarks.size() < 3; }

}  // namespace

std::vector<std::optional<PoseSearchResult>> place_by_search(PoseSearches& searches,
                                                             const std::vector<const Fragment*>& fragments,
                                                             const SearchOptions& options, double& scale,
                                                             std::vector<FragmentPlacement>& placed) {
    std::vector<std::optional<PoseSearchResult>> results(fragments.size());
    std::vector<std::size_t> searched;
    bool has_scale = false;
    for (std::size_t k = 0; k < fragments.size(); ++k) {
        if (options.search == SearchOptions::Search::always ||
            (options.search == SearchOptions::Search::automatic && few_landmarks(placed[k])))
            searched.push_back(k);
        else has_scale = has_scale || placed[k].problem.empty();
    }
    if (searched.empty()) return results;
    const auto search_all = [&](double minimum, double maximum) {
        for (const std::size_t k : searched) results[k] = searches.find(*fragments[k], minimum, maximum);
    };
    if (has_scale) {
        search_all(scale, scale);
    } else {
        const double minimum = options.poses.min_scale, maximum = options.poses.max_scale;
        search_all(minimum, maximum);
        std::vector<double> scales;
        for (const std::size_t k : searched)
            if (results[k] && results[k]->decided) scales.push_back(results[k]->candidates.front().scale);
        if (!scales.empty()) scale = upper_median(scales);
        if (maximum > minimum && !scales.empty()) {
            for (const std::size_t k : searched)
                if (results[k] && results[k]->decided) placed[k].own_scale = results[k]->candidates.front().scale;
            search_all(scale, scale);
        }
    }
    for (const std::size_t k : searched) {
        FragmentPlacement& placement = placed[k];
        if (!results[k]) {
            placement.problem = "its whole surface is fracture: nothing can be registered to the template";
        } else if (!results[k]->decided) {
            placement.problem =
                fmt::format("{}the search for its pose cannot decide where it belongs, because {}",
                            few_landmarks(placement) ? "has fewer than three landmarks in common with the template, and " : "",
                            results[k]->reason);
        } else {
            placement.problem.clear();
            placement.mirrored = false;
            placement.pose = results[k]->candidates.front().pose;
            if (!(placement.own_scale > 0)) placement.own_scale = scale;
            // One or two landmarks are reported, but were not used.
            for (LandmarkResidual& landmark : placement.landmarks) landmark.used = false;
        }
    }
    return results;
}

bool resolve_open_motions(const std::vector<LandmarkPair>& pairs, double scale, double limit, PoseSearchResult& search,
                          FragmentPlacement& placed) {
    if (pairs.empty() || search.slippable_ranges.empty()) return false;
    Motion pose = placed.pose;
    for (const SlippableRange& range : search.slippable_ranges) {
        const Vector3d d = range.direction.normalized();
        double sine = 0, cosine = 0, along = 0;
        for (const LandmarkPair& pair : pairs) {
            const Vector3d p = pose(pair.on_fragment) - range.point, t = scale * pair.on_template - range.point;
            const Vector3d a = p - p.dot(d) * d, b = t - t.dot(d) * d;
            sine += d.dot(a.cross(b));
            cosine += a.dot(b);
            along += (t - p).dot(d) / static_cast<double>(pairs.size());
        }
        Motion move;
        if (range.rotates) {
            const bool round = range.maximum - range.minimum >= 2 * pi - 0.2;
            const double angle = std::atan2(sine, cosine);
            move.rotation =
                Eigen::AngleAxisd(round ? angle : std::clamp(angle, range.minimum, range.maximum), d).toRotationMatrix();
            move.translation = range.point - move.rotation * range.point;
        } else {
            move.translation = std::clamp(along, range.minimum, range.maximum) * d;
        }
        pose = move.after(pose);
    }
    for (const LandmarkPair& pair : pairs)
        if ((pose(pair.on_fragment) - scale * pair.on_template).norm() > limit) return false;
    placed.pose = pose;
    for (LandmarkResidual& landmark : placed.landmarks) landmark.used = true;
    search.slippable.kind = SlippableKind::none;
    search.slippable_ranges.clear();
    return true;
}

std::vector<std::optional<PoseSearchResult>> place_by_search(const Mesh& mesh, const std::vector<const Fragment*>& fragments,
                                                             const SearchOptions& options, double& scale,
                                                             std::vector<FragmentPlacement>& placed) {
    PoseSearches searches(mesh, options.poses);
    return place_by_search(searches, fragments, options, scale, placed);
}

void SearchOptions::declare_options(OptionList& list) {
    list("search", search,
         "pose search by shape, without landmarks: always, never, or only for fragments with fewer than three landmarks (auto)",
         Choices{"auto", "always", "never"});
    poses.declare_options(list);
}

}  // namespace ostraka
