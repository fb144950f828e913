#include "ostraka/fields/detection_level.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/stats/summary.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka {

namespace {

constexpr double two_sided_95 = 1.959963984540054;  // quantile of the normal distribution

/// A vertex lies on the scanned surface itself, so that no facet stands between them.
bool is_at_vertex(const std::array<double, 3>& weights) { return std::count(weights.begin(), weights.end(), 0.0) == 2; }

}  // namespace

std::vector<double> detection_levels(const std::vector<PlaceDistance>& places, const NoisySurface& from, const NoisySurface& to,
                                     double registration_error) {
    if (!(registration_error >= 0)) fail_usage("the registration error is negative", "give a length of 0 or more");
    std::vector<double> levels(places.size(), std::numeric_limits<double>::quiet_NaN());
    parallel_for(places.size(), 1024, [&](std::size_t i) {
        const PlaceDistance& place = places[i];
        if (place.face == no_index || place.nearest.face == no_index) return;
        const PlaceNoise own = noise_at(from.mesh, from.noise, place.face, place.weights);
        const PlaceNoise other = noise_at(to.mesh, to.noise, place.nearest.face, place.nearest.barycentric);
        const double facets = (is_at_vertex(place.weights) ? 0 : own.facet_height) +
                              (is_at_vertex(place.nearest.barycentric) ? 0 : other.facet_height);
        levels[i] = two_sided_95 * (std::sqrt(own.variance + other.variance) + registration_error) + facets;
    });
    return levels;
}

SignificantShares significant_shares(const std::vector<PlaceDistance>& places, const std::vector<double>& levels) {
    if (levels.size() != places.size())
        fail_usage(fmt::format("there are {} levels for {} places", levels.size(), places.size()));
    SignificantShares shares;
    std::vector<double> known;
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (!std::isfinite(levels[i]) || !std::isfinite(places[i].distance) || places[i].beyond) continue;
        known.push_back(levels[i]);
        if (places[i].distance > levels[i]) ++shares.above;
        else if (places[i].distance < -levels[i]) ++shares.below;
    }
    if (!places.empty()) shares.assessed = static_cast<double>(known.size()) / static_cast<double>(places.size());
    shares.level = std::numeric_limits<double>::quiet_NaN();
    if (known.empty()) return shares;
    shares.above /= static_cast<double>(known.size());
    shares.below /= static_cast<double>(known.size());
    shares.level = upper_median(std::move(known));
    return shares;
}

std::vector<std::string> doubts_about(const SignificantShares& shares, const NoisySurface& from, const NoisySurface& to,
                                      double registration_error) {
    std::vector<std::string> doubts;
    const auto percent = [](double share) { return digits(100 * share, 3) + " %"; };
    if (shares.assessed == 0) {
        doubts.emplace_back(
            "the significance of the distances cannot be assessed: there are too few vertices within the radius of "
            "the noise; a larger --noise-radius may help");
        return doubts;
    }
    if (shares.assessed < 0.9)
        doubts.push_back(
            fmt::format("the significance is known for {} of the area only: elsewhere the surface is beyond a border, "
                        "or there are too few vertices to estimate the noise",
                        percent(shares.assessed)));
    for (const auto& [surface, name] : {std::pair{&from, "mesh"}, std::pair{&to, "reference"}})
        if (surface->noise.correlation > 0.3)
            doubts.push_back(fmt::format(
                "neighbouring vertices of the {} deviate alike (correlation {}): it was smoothed, so that its noise is larger "
                "than "
                "estimated, or it has relief smaller than the radius of the noise, so that its noise is smaller than estimated",
                name, digits(surface->noise.correlation, 2)));
    if (shares.above + shares.below > 0.5)
        doubts.push_back(
            fmt::format("{} of the area differs significantly: the meshes may not be registered exactly, or the noise "
                        "is underestimated",
                        percent(shares.above + shares.below)));
    if (registration_error == 0)
        doubts.emplace_back(
            "the levels of detection do not include the error of the registration: give it with "
            "--registration-error ('mesh register' reports it)");
    return doubts;
}

}  // namespace ostraka
