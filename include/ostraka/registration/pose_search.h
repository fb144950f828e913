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
    double tolerance = 0.02;      ///< max distance of a point of the part that lies on the whole, as a share of the part's size
    double min_confidence = 0.5;  ///< min confidence of a decided pose
    int points = 2000;            ///< number of points on the whole; points on the part have the same density
    int references = 120;         ///< number of reference points of the part
    int partners = 300;           ///< number of other points of the part that vote with each reference point
    int candidates = 10;          ///< number of poses that are refined on the whole's own faces
    std::uint64_t seed = 1;       ///< random seed

    void list_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A pose of the part on the whole.
struct PoseCandidate {
    Motion pose;       ///< rigid motion from the part onto the scaled whole
    double scale = 1;  ///< scale of the whole, about the origin of its coordinates
    /// Quality of the pose, 0 to 1: mean nearness over the part's area, on a logarithmic scale of the distance from the whole: 1
    /// up to a quarter of the tolerance, 0 from two and a half times the tolerance on, and 0 where normals differ by more than 60
    /// degrees.
    double score = 0;
    double share = 0;   ///< share of the part's area within the tolerance
    double inside = 0;  ///< share of the part's area that is deeper inside the whole than the tolerance
    /// Root mean square distance of the part's area within the tolerance from the whole, in the part's unit.
    double residual = 0;
};

/// How far the part can be moved from its pose along a slippable motion without fitting worse.
struct SlippableRange {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< a point of the line, on the scaled whole
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< direction of the line
    bool rotates = false;                                  ///< true: rotation about the line; false: translation along the line
    double minimum = 0, maximum = 0;                       ///< range of the motion: radians, or a length in the part's unit
};

/// Result of a pose search.
struct PoseSearchResult {
    std::vector<PoseCandidate> candidates;  ///< poses, best first, pairwise distinct
    /// Lead of the best pose over the second: log ratio of the shares of the part that they leave unexplained.
    double margin = 0;
    double confidence = 0;             ///< confidence that the best pose is right, up to the motions in `slippable`
    bool decided = false;              ///< true: the confidence is sufficient
    std::string reason;                ///< reason why the pose is undecided; empty if it is decided
    SlippableMotions slippable;        ///< slippable motions of the best pose, on the scaled whole
    std::vector<SlippableRange> ways;  ///< for each slippable motion, the range in which the part can be moved
};

/// Precomputed data of a whole for pose searches on it.
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
    /// Searches poses of the marked faces of a part, as the other overload, in this range of scales instead of the options'
    /// range.
    [[nodiscard]] PoseSearchResult find(const Mesh& part, const std::vector<bool>& of_part, double min_scale,
                                        double max_scale) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace ostraka
