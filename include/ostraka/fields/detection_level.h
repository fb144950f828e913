// Which distances between two scans exceed the noise of both.
#pragma once

#include "ostraka/fields/scan_noise.h"
#include "ostraka/fields/surface_distance.h"

#include <string>
#include <vector>

namespace ostraka {

/// A scanned surface with its noise; both must outlive this object.
struct NoisySurface {
    NoisySurface(const Mesh& surface, const ScanNoise& estimate) : mesh(surface), noise(estimate) {}
    const Mesh& mesh;
    const ScanNoise& noise;
};

/// Level of detection at 95 % of each distance: 1.96 (sqrt(s^2 + t^2) + e) + h, where s and t are the standard deviations of the
/// place and of the nearest place, e is `registration_error` (Lague, Brodu and Leroux 2013, equation 1, for single places), and h
/// the heights of the curved surfaces over the flat faces on which the two places lie (none at a vertex). NaN where the noise of
/// one surface is unknown.
std::vector<double> detection_levels(const std::vector<PlaceDistance>& places, const NoisySurface& from, const NoisySurface& to,
                                     double registration_error);

/// Shares of the places with known levels whose distance exceeds the level.
struct SignificantShares {
    double assessed = 0;          ///< share of all places whose level is known and that are not beyond the border
    double above = 0, below = 0;  ///< of the assessed places: positive and negative distances that exceed the level
    double level = 0;             ///< median level; NaN if no place is assessed
};
SignificantShares significant_shares(const std::vector<PlaceDistance>& places, const std::vector<double>& levels);

/// Reasons to doubt the shares, as sentences: unassessed places, noise that is correlated or mostly relief, change nearly
/// everywhere.
std::vector<std::string> doubts_about(const SignificantShares& shares, const NoisySurface& from, const NoisySurface& to,
                                      double registration_error);

}  // namespace ostraka
