#include "ostraka/reconstruction/search_placement.h"
#include "ostraka/core/angles.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

bool few_landmarks(const FragmentPlacement& one) { return !one.problem.empty() && one.landmarks.size() < 3; }

}  // namespace

std::vector<std::optional<PoseSearchResult>> place_by_search(PoseSearches& searches,
                                                             const std::vector<const Fragment*>& fragments,
                                                             const SearchOptions& options, double& scale,
                                                             std::vector<FragmentPlacement>& placed) {
    std::vector<std::optional<PoseSearchResult>> results(fragments.size());
    std::vector<std::size_t> wanted;
    bool known = false;
    for (std::size_t k = 0; k < fragments.size(); ++k) {
        if (options.search == SearchOptions::Search::always ||
            (options.search == SearchOptions::Search::automatic && few_landmarks(placed[k])))
            wanted.push_back(k);
        else known = known || placed[k].problem.empty();
    }
    if (wanted.empty()) return results;
    const auto all = [&](double minimum, double maximum) {
        for (const std::size_t k : wanted) results[k] = searches.find(*fragments[k], minimum, maximum);
    };
    if (known) {
        all(scale, scale);
    } else {
        const double minimum = options.poses.min_scale, maximum = options.poses.max_scale;
        all(minimum, maximum);
        std::vector<double> scales;
        for (const std::size_t k : wanted)
            if (results[k] && results[k]->decided) scales.push_back(results[k]->candidates.front().scale);
        if (!scales.empty()) scale = upper_median(scales);
        if (maximum > minimum && !scales.empty()) {
            const auto alone = results;
            all(scale, scale);
            for (const std::size_t k : wanted)
                if (alone[k] && alone[k]->decided) placed[k].own_scale = alone[k]->candidates.front().scale;
        }
    }
    for (const std::size_t k : wanted) {
        FragmentPlacement& one = placed[k];
        if (!results[k]) {
            one.problem = "all of it is of breaks: nothing can be laid onto the template";
        } else if (!results[k]->decided) {
            one.problem =
                (few_landmarks(one) ? "has fewer than three landmarks in common with the template, and the search for its pose "
                                    : "the search for its pose ") +
                std::string("cannot decide where it belongs, because ") + results[k]->reason;
        } else {
            one.problem.clear();
            one.mirrored = false;
            one.pose = results[k]->candidates.front().pose;
            if (!(one.own_scale > 0)) one.own_scale = scale;
            // One or two landmarks are reported, but were not used.
            for (LandmarkResidual& landmark : one.landmarks) landmark.used = false;
        }
    }
    return results;
}

bool close_by_landmarks(const std::vector<LandmarkPair>& pairs, double scale, double limit, PoseSearchResult& search,
                        FragmentPlacement& placed) {
    using Eigen::Vector3d;
    if (pairs.empty() || search.ways.empty()) return false;
    Motion pose = placed.pose;
    for (const SlippableRange& way : search.ways) {
        const Vector3d d = way.direction.normalized();
        double sine = 0, cosine = 0, along = 0;
        for (const LandmarkPair& pair : pairs) {
            const Vector3d p = pose(pair.on_fragment) - way.point, t = scale * pair.on_template - way.point;
            const Vector3d a = p - p.dot(d) * d, b = t - t.dot(d) * d;
            sine += d.dot(a.cross(b));
            cosine += a.dot(b);
            along += (t - p).dot(d) / static_cast<double>(pairs.size());
        }
        Motion move;
        if (way.rotates) {
            const bool round = way.maximum - way.minimum >= 2 * pi - 0.2;
            const double angle = std::atan2(sine, cosine);
            move.rotation = Eigen::AngleAxisd(round ? angle : std::clamp(angle, way.minimum, way.maximum), d).toRotationMatrix();
            move.translation = way.point - move.rotation * way.point;
        } else {
            move.translation = std::clamp(along, way.minimum, way.maximum) * d;
        }
        pose = move.after(pose);
    }
    for (const LandmarkPair& pair : pairs)
        if ((pose(pair.on_fragment) - scale * pair.on_template).norm() > limit) return false;
    placed.pose = pose;
    for (LandmarkResidual& landmark : placed.landmarks) landmark.used = true;
    search.slippable.kind = SlippableKind::none;
    search.ways.clear();
    return true;
}

std::vector<std::optional<PoseSearchResult>> place_by_search(const Mesh& mesh, const std::vector<const Fragment*>& fragments,
                                                             const SearchOptions& options, double& scale,
                                                             std::vector<FragmentPlacement>& placed) {
    PoseSearches searches(mesh, options.poses);
    return place_by_search(searches, fragments, options, scale, placed);
}

void SearchOptions::describe(OptionList& visit) {
    visit("search", search, "poses are searched without landmarks: auto is where a fragment has fewer than three",
          Choices{"auto", "always", "never"});
    poses.describe(visit);
}

}  // namespace ostraka
