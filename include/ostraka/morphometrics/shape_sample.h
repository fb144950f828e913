// Samples of landmark configurations: specimens with the same landmarks, some of which may be missing.
#pragma once

#include "ostraka/registration/procrustes.h"

#include <array>
#include <string>
#include <vector>

namespace ostraka {

/// Landmark configurations of several specimens.
struct ShapeSample {
    int dimension = 3;                      ///< 2: all z are 0, and rotations are about the z axis
    std::vector<std::string> landmarks;     ///< name of each landmark
    std::vector<std::string> specimens;     ///< name of each specimen
    std::vector<Landmarks> configurations;  ///< for each specimen, its landmarks; NaN in the row of a missing landmark

    /// Options of a Procrustes fit of these configurations.
    [[nodiscard]] ProcrustesOptions procrustes_options(bool scaling = true, bool reflection = false) const {
        return {scaling, reflection, dimension == 2};
    }
};

/// Whether a landmark of a configuration is missing.
inline bool is_missing(const Landmarks& configuration, std::size_t landmark) {
    return !configuration.row(static_cast<Eigen::Index>(landmark)).allFinite();
}
/// Whether no landmark is missing.
inline bool is_complete(const Landmarks& configuration) { return configuration.allFinite(); }

/// The rows of a configuration with these indices.
Landmarks rows_of(const Landmarks& configuration, const std::vector<std::size_t>& rows);

/// The bilateral symmetry of one object: landmarks that a mirror exchanges. All other landmarks lie on the plane of symmetry.
struct LandmarkPairs {
    std::vector<std::array<std::size_t, 2>> pairs;  ///< indices of a landmark and of its counterpart on the other side
};
/// The configuration mirrored (x negated), with the landmarks of each pair exchanged. Throws Error (input) if a pair names a
/// landmark that does not exist, or a landmark is in two pairs.
Landmarks relabelled_mirror(const Landmarks& configuration, const LandmarkPairs& pairs);

/// Pairs of landmarks by their names: two names that differ in one place alone, where one has "left" or "l" and the other "right"
/// or "r" as a word (case ignored; words are separated by blanks and . _ -).
LandmarkPairs pairs_by_name(const std::vector<std::string>& landmarks);

}  // namespace ostraka
