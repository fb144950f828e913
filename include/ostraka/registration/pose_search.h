// Where a part lies on a whole, when nothing is known: a search over all poses, with how sure it is.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/registration/slippable_motions.h"

#include <memory>
#include <string>
#include <vector>

namespace ostraka {

struct PoseSearchOptions {
    double min_scale = 1, max_scale = 1;  ///< of the whole; equal: known
    double tolerance = 0.02;              ///< what lies nearer is on the whole, as a share of the part's size
    double min_confidence = 0.5;          ///< below: cannot decide
    int points = 2000;                    ///< spread over the whole; as dense on the part
    int references = 120;                 ///< points of the part for which places are sought
    int partners = 300;                   ///< other points of the part that vote for each
    int candidates = 10;                  ///< poses that are refined on the whole's own faces
    std::uint64_t seed = 1;

    void describe(OptionList& visit);
};

/// A place of the part on the whole.
struct PoseCandidate {
    Motion pose;       ///< rigid, of the part onto the scaled whole
    double scale = 1;  ///< of the whole, about its origin
    /// 0 to 1: mean over the part's area of how near it lies, on a logarithmic scale from a quarter of the tolerance (1) to
    /// two and a half times it (0); 0 where normals differ by more than 60 degrees.
    double score = 0;
    double share = 0;     ///< of the part's area that lies within the tolerance
    double inside = 0;    ///< of the part's area that lies farther than the tolerance inside the whole
    double residual = 0;  ///< root mean square distance of what lies within the tolerance, in the part's unit
};

/// How far the part can be moved from its pose along a slippable motion.
struct SlippableRange {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< of the line, on the scaled whole
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< of the line
    bool rotates = false;                                  ///< about the line; else along it
    double minimum = 0, maximum = 0;  ///< how far either way it lies as well as in the pose: radians, or in the part's unit
};

struct PoseSearchResult {
    std::vector<PoseCandidate> candidates;  ///< best first, each really another place than those before it
    double margin = 0;      ///< how much better the best explains the part than the second does: log ratio of what they leave
    double confidence = 0;  ///< that the first is right, but for what `slippable` leaves open
    bool decided = false;
    std::string reason;          ///< why not decided, in words; empty if it is
    SlippableMotions slippable;  ///< of the first candidate, on the scaled whole
    std::vector<SlippableRange> ways;
};

/// What is kept of a whole to search poses on it.
class PoseSearch {
public:
    /// `whole` must outlive it. Throws Error (usage) for options out of range, (input) for a whole without area.
    explicit PoseSearch(const SurfaceSearch& whole, const PoseSearchOptions& options = {});
    ~PoseSearch();
    PoseSearch(PoseSearch&&) noexcept;

    /// Poses of the faces marked in `of_part` (all if empty) on the whole. Points are spread over both surfaces; pairs of them
    /// vote (`PairTable`), at each scale of the range in steps of a twelfth; what they propose is scored, the better ones refined
    /// on the points and scored anew, the best of those that are really different refined on the faces (`align_part`). Throws
    /// Error (input) for a part without area. Same result for any number of threads.
    [[nodiscard]] PoseSearchResult find(const Mesh& part, const std::vector<bool>& of_part = {}) const;
    /// The same for another range of scales.
    [[nodiscard]] PoseSearchResult find(const Mesh& part, const std::vector<bool>& of_part, double min_scale,
                                        double max_scale) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace ostraka
