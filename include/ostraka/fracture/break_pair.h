// Two fragments that share a break, fitted together by it.
#pragma once

#include "ostraka/core/json.h"
#include "ostraka/core/options.h"
#include "ostraka/fracture/fragment.h"
#include "ostraka/fracture/join_evidence.h"

#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace ostraka {

struct PairOptions {
    int frames = 160;             ///< places along the rim of each fragment's fracture
    int samples = 2000;           ///< points on each fracture, and on the rest of each surface
    int starts = 200;             ///< poses that are refined quickly, the best of all
    int refined = 32;             ///< poses that are refined to the end
    double search_radius = 0.05;  ///< farthest that faces of a break lie apart at first, share of the smaller fragment's size
    double last_search_radius = 0.025;  ///< at the end, share of join_scale
    double edges = 1;                   ///< weight of the rims against the fracture surfaces
    double min_confidence = 0.5;        ///< below it cannot be determined how the fragments go together
    int candidates = 5;                 ///< reported

    void describe(OptionList& visit);
};

/// All that is asked of a fragment when its break is laid against others, made once: samples of the fracture and of the rest of
/// its surface, frames along the rim, search trees. Holds a copy of the mesh; of fixed size beside it.
class PreparedBreak {
public:
    /// Facets must be known (facets.h, or annotations). Throws Error (input) for a fragment without area, without fracture, or
    /// without a rim.
    explicit PreparedBreak(const Fragment& fragment, const PairOptions& options = {});
    ~PreparedBreak();
    PreparedBreak(PreparedBreak&&) noexcept;
    PreparedBreak& operator=(PreparedBreak&&) noexcept;

    [[nodiscard]] const std::string& name() const;
    [[nodiscard]] const Mesh& mesh() const;
    [[nodiscard]] double size() const;  ///< square root of the surface's area
    [[nodiscard]] double fracture_area() const;
    [[nodiscard]] double rim_length() const;
    /// Twice the area of the fracture by the length of its rim: of a sherd the thickness of its wall.
    [[nodiscard]] double width() const;
    /// Root mean square deviation of the fracture from a quadric over it.
    [[nodiscard]] double relief() const;
    [[nodiscard]] std::size_t fracture_faces() const;

    struct Parts;
    [[nodiscard]] const Parts& parts() const { return *parts_; }

private:
    std::unique_ptr<Parts> parts_;
};

/// What two breaks are compared in units of: the size of the smaller fragment, or six times the width of the narrower break if
/// that is less, so that a thin wall is not as thick as what counts as contact; but no less than 240 times the noise of the two
/// intact surfaces, so that noisy or coarse ones may touch at all.
double join_scale(const PreparedBreak& a, const PreparedBreak& b);

/// A way to lay the second fragment onto the first.
struct PairCandidate {
    Motion pose;             ///< rigid: the second fragment onto the first
    double score = 0;        ///< contact + rim - penetration, as shares of the smaller fracture and its rim
    double contact = 0;      ///< share of the smaller fracture's area within the last search radius of the other, facing it
    double rim = 0;          ///< share of the shorter rim within the last search radius of the other, sides continued
    double residual = 0;     ///< root mean square distance of what is in contact, in the unit of the fragments
    double penetration = 0;  ///< area of each fragment deeper in the other than the last search radius, share of the smaller
                             ///< fracture
    double depth = 0;        ///< of the deepest point, in the unit of the fragments
    JoinEvidence evidence;   ///< what is seen of the join
    double log_odds = 0;     ///< of the evidence alone: that this is how they were joined, against chance
};

struct BreakPair {
    std::vector<PairCandidate> candidates;  ///< most likely first, each of another place
    double confidence = 0;  ///< 0 to 1: calibrated probability that the first candidate is how the fragments were joined
    std::string undecided;  ///< why it cannot be determined, in words; empty: the first candidate is the answer
    double fracture_a = 0, fracture_b = 0;  ///< areas
    double size = 0;                        ///< square root of the area of the smaller fragment
    double scale = 0;                       ///< join_scale
    std::size_t tried = 0;                  ///< poses
    [[nodiscard]] bool decided() const { return undecided.empty(); }
};

/// Along the rims of the fractures stand frames: the normal of the outer (or inner) surface, that of the fracture, and the rim.
/// Each frame of the second fragment aligned with each of the first with the same side, fractures facing each other, is a pose;
/// all are scored by the fracture that comes into contact and by what would lie inside the other fragment. The best are refined
/// by closest points, point to plane, between fractures that face each other, and between rims, whose sides continue each other;
/// the search radius falls to its last value. What is then seen of each (join_evidence.h) says how likely it is. No chance is
/// involved; places and poses of the fragments do not matter, nor which is named first: the other order gives inverse poses.
BreakPair pair_breaks(const PreparedBreak& a, const PreparedBreak& b, const PairOptions& options = {});
/// The same, with the fragments prepared on the way.
BreakPair pair_breaks(const Fragment& a, const Fragment& b, const PairOptions& options = {});

/// How well two breaks fit at best by `places` along the rim of each, before any pose is refined: to choose which pairs to try.
/// More is better; of no unit.
double quick_fit(const PreparedBreak& a, const PreparedBreak& b, const PairOptions& options = {}, std::size_t places = 64);

/// What is seen when `pose` lays b onto a; `tolerance` is a length. By at most `samples` places of each fracture, and of what may
/// lie inside.
JoinEvidence measure_join(const PreparedBreak& a, const PreparedBreak& b, const Motion& pose, double tolerance,
                          std::size_t samples = std::numeric_limits<std::size_t>::max());

/// A place of b's fracture or rim on a plane of a's; both in their own frames.
struct ContactPoint {
    Eigen::Vector3d on_a, normal, on_b;  ///< the unit normal is a's
    double weight = 1;                   ///< falls with the distance from 1 to 0
};
/// Where the fractures lie within `search_radius` of each other, facing, and where the one rim continues the other; `pose` lays
/// b onto a. At most `samples` places of the fracture.
std::vector<ContactPoint> contact_points(const PreparedBreak& a, const PreparedBreak& b, const Motion& pose, double search_radius,
                                         std::size_t samples);

/// The report of a pair (doc/schema/pair.schema.json): verdict, confidence, candidates with their poses (4 x 4).
JsonValue pair_to_json(const BreakPair& pair, const std::string& a, const std::string& b, JsonAllocator& allocator);

}  // namespace ostraka
