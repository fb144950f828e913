#include "ostraka/fitting/search_placement.h"

#include <algorithm>

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
        if (options.search == "always" || (options.search == "auto" && few_landmarks(placed[k]))) wanted.push_back(k);
        else known = known || placed[k].problem.empty();
    }
    if (wanted.empty()) return results;
    const auto all = [&](double least, double most) {
        for (const std::size_t k : wanted) results[k] = searches.find(*fragments[k], least, most);
    };
    if (known) {
        all(scale, scale);
    } else {
        const double least = options.poses.least_scale, most = options.poses.most_scale;
        all(least, most);
        std::vector<double> scales;
        for (const std::size_t k : wanted)
            if (results[k] && results[k]->decided) scales.push_back(results[k]->candidates.front().scale);
        std::sort(scales.begin(), scales.end());
        if (!scales.empty()) scale = scales[scales.size() / 2];
        if (most > least && !scales.empty()) {
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
            one.problem = (few_landmarks(one) ? one.problem + "; searched for: " : std::string()) +
                          "cannot decide where it belongs, because " + results[k]->reason;
        } else {
            one.problem.clear();
            one.mirrored = false;
            one.pose = results[k]->candidates.front().pose;
            if (!(one.own_scale > 0)) one.own_scale = scale;
            // Landmarks, if it has one or two, are shown but did not speak.
            for (LandmarkResidual& landmark : one.landmarks) landmark.used = false;
        }
    }
    return results;
}

std::vector<std::optional<PoseSearchResult>> place_by_search(const Mesh& mesh, const std::vector<const Fragment*>& fragments,
                                                             const SearchOptions& options, double& scale,
                                                             std::vector<FragmentPlacement>& placed) {
    PoseSearches searches(mesh, options.poses);
    return place_by_search(searches, fragments, options, scale, placed);
}

}  // namespace ostraka
