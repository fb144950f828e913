// Global search for the pose of a part on a whole, with a confidence.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/registration/slippable_motions.h"

#include <memory>
#include <string>
#include <vector>

namespace ostraka {

struct PoseSearchOptions {
    /// Range in which the scale of the whole is searched; if both are equal, the scale is known.
    double min_scale = 1, max_scale = 1;
    /// A point of the part lies on the whole if its distance is at most this share of the part's size.
    double tolerance = 0.02;
    double min_confidence = 0.5;  ///< min confidence of a decided pose
    int points = 2000;            ///< number of points on the whole; points on the part have the same density
    int references = 120;         ///< number of reference points of the part
    int partners = 300;           ///< number of other points of the part that vote with each reference point
    int candidates = 10;          ///< number of poses that are refined on the whole's own faces
    std::uint64_t seed = 1;       ///< random seed

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A pose of the part on the whole.
struct PoseCandidate {
    Motion pose;       ///< rigid motion from the part onto the scaled whole
    double scale = 1;  ///< scale of the whole, about the origin of its coordinates
    /// Quality of the pose, 0 to 1: the mean closeness over the part's area. Closeness is 1 at distances from the whole up to a
    /// quarter of the tolerance, decreases with the logarithm of the distance, and is 0 from two and a half times the tolerance
    /// on and where the normals differ by more than 60 degrees.
    double score = 0;
    double share = 0;   ///< share of the part's area within the tolerance
    double inside = 0;  ///< share of the part's area that lies inside the whole by more than the tolerance
    /// Root mean square distance from the whole, over the part's area within the tolerance, in the part's unit.
    double residual = 0;
};

/// Range over which the part can be moved along a slippable motion without a worse fit.
struct SlippableRange {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< a point of the line, on the scaled whole
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< direction of the line
    bool rotates = false;                                  ///< true: rotation about the line; false: translation along the line
    double minimum = 0, maximum = 0;                       ///< range of the motion: radians, or a length in the part's unit
};

/// Result of a pose search.
struct PoseSearchResult {
    std::vector<PoseCandidate> candidates;  ///< poses, best first, pairwise distinct
    /// Margin of the best pose over the second: logarithm of the ratio of the shares of the part that do not lie on the whole.
    double margin = 0;
    double confidence = 0;       ///< confidence, 0 to 1, that the best pose is correct up to the motions in `slippable`
    bool decided = false;        ///< true: the confidence is sufficient
    std::string reason;          ///< reason why the pose is undecided; empty if it is decided
    SlippableMotions slippable;  ///< slippable motions of the best pose, on the scaled whole
    std::vector<SlippableRange> slippable_ranges;  ///< for each slippable motion, the range in which the part can be moved
};

/// Searches poses of parts on one whole; data of the whole are precomputed.
class PoseSearch {
public:
    /// `whole` must outlive this object. Throws Error (usage) for options out of range, (input) for a whole without area.
    explicit PoseSearch(const SurfaceSearch& whole, const PoseSearchOptions& options = {});
    ~PoseSearch();
    PoseSearch(PoseSearch&&) noexcept;

    /// Searches poses of the faces marked in `of_part` (all faces if empty) on the whole. Spreads points over both surfaces;
    /// pairs of points vote for poses (`PairTable`) at each scale of the range in steps of a twelfth; the proposed poses are
    /// scored, the better poses are refined on the points and scored again, and the best distinct poses are refined on the faces
    /// (`align_part`). Throws Error (input) for a part without area. The result is the same for any number of threads.
    [[nodiscard]] PoseSearchResult find(const Mesh& part, const std::vector<bool>& of_part = {}) const;
    /// Like the other overload, but with this range of scales instead of the range in the options.
    [[nodiscard]] PoseSearchResult find(const Mesh& part, const std::vector<bool>& of_part, double min_scale,
                                        double max_scale) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace ostraka
