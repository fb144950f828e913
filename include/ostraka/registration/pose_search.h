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
    double min_scale = 1, max_scale = 1;  ///< range of scales of the whole; equal: known
    double tolerance = 0.02;              ///< points nearer than this are on the whole, as a share of the part's size
    double min_confidence = 0.5;          ///< min confidence of an answer; below it the pose is undecided
    int points = 2000;                    ///< number of points on the whole; the part gets the same density
    int references = 120;                 ///< number of reference points of the part
    int partners = 300;                   ///< number of other points of the part that vote with each reference point
    int candidates = 10;                  ///< number of poses that are refined on the whole's own faces
    std::uint64_t seed = 1;

    void describe(OptionList& visit);
};

/// A pose of the part on the whole.
struct PoseCandidate {
    Motion pose;       ///< rigid, maps the part onto the scaled whole
    double scale = 1;  ///< scale of the whole, about its origin
    /// 0 to 1: mean nearness over the part's area, on a logarithmic scale from a quarter of the tolerance (1) to two and a half
    /// times the tolerance (0); 0 where normals differ by more than 60 degrees.
    double score = 0;
    double share = 0;     ///< share of the part's area within the tolerance
    double inside = 0;    ///< share of the part's area that is deeper inside the whole than the tolerance
    double residual = 0;  ///< root mean square distance of the area within the tolerance, in the part's unit
};

/// How far the part can be moved from its pose along a slippable motion.
struct SlippableRange {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< point of the line, on the scaled whole
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< direction of the line
    bool rotates = false;                                  ///< rotation about the line; else translation along it
    double minimum = 0, maximum = 0;  ///< range in which the part fits as well as in the pose: radians, or in the part's unit
};

struct PoseSearchResult {
    std::vector<PoseCandidate> candidates;  ///< best first, pairwise distinct
    double margin = 0;      ///< lead of the best over the second candidate: log ratio of their unexplained shares of the part
    double confidence = 0;  ///< confidence that the first is right, up to the motions in `slippable`
    bool decided = false;
    std::string reason;          ///< reason why the pose is undecided; empty if it is decided
    SlippableMotions slippable;  ///< slippable motions of the first candidate, on the scaled whole
    std::vector<SlippableRange> ways;
};

/// Precomputed data of a whole for pose searches on it.
class PoseSearch {
public:
    /// `whole` must outlive it. Throws Error (usage) for options out of range, (input) for a whole without area.
    explicit PoseSearch(const SurfaceSearch& whole, const PoseSearchOptions& options = {});
    ~PoseSearch();
    PoseSearch(PoseSearch&&) noexcept;

    /// Poses of the faces marked in `of_part` (all if empty) on the whole. Spreads points over both surfaces; pairs of points
    /// vote (`PairTable`) at each scale of the range in steps of a twelfth; the proposed poses are scored, the better ones
    /// refined on the points and scored again, the best distinct ones refined on the faces (`align_part`). Throws Error (input)
    /// for a part without area. Same result for any number of threads.
    [[nodiscard]] PoseSearchResult find(const Mesh& part, const std::vector<bool>& of_part = {}) const;
    /// The same with another range of scales.
    [[nodiscard]] PoseSearchResult find(const Mesh& part, const std::vector<bool>& of_part, double min_scale,
                                        double max_scale) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace ostraka
