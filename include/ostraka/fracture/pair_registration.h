// Registers two fragments along their common fracture.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/files/json.h"
#include "ostraka/fracture/fragment.h"
#include "ostraka/fracture/join_evidence.h"

#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace ostraka {

struct PairOptions {
    int frames = 160;                   ///< number of frames along the rim of each fracture
    int samples = 2000;                 ///< number of points on each fracture, and on the intact surface of each fragment
    int starts = 200;                   ///< number of best poses that get a quick refinement
    int refined = 32;                   ///< number of poses that are refined to the end
    double search_radius = 0.05;        ///< initial max distance of facing fracture points, share of the smaller size
    double last_search_radius = 0.025;  ///< final search radius, as a share of join_scale
    double edges = 1;                   ///< weight of the rims relative to the fracture surfaces
    double min_confidence = 0.5;        ///< min confidence of an answer; below it the pair is undecided
    int candidates = 5;                 ///< number of candidates reported

    void describe(OptionList& visit);
};

/// Data for matching a fragment's fracture, precomputed once: samples of the fracture and of the intact surface, frames along
/// the rim, search trees. Holds a copy of the mesh; apart from it, the size is fixed.
class PreparedFracture {
public:
    /// The facets must be known (facets.h, or annotations). Throws Error (input) if the fragment has no area, no fracture or no
    /// rim.
    explicit PreparedFracture(const Fragment& fragment, const PairOptions& options = {});
    ~PreparedFracture();
    PreparedFracture(PreparedFracture&&) noexcept;
    PreparedFracture& operator=(PreparedFracture&&) noexcept;

    [[nodiscard]] const std::string& name() const;
    [[nodiscard]] const Mesh& mesh() const;
    [[nodiscard]] double size() const;  ///< square root of the surface area
    [[nodiscard]] double fracture_area() const;
    [[nodiscard]] double rim_length() const;
    /// Twice the area of the fracture divided by the length of its rim: for a sherd, the thickness of its wall.
    [[nodiscard]] double width() const;
    /// Root mean square deviation of the fracture from a quadric fitted to it.
    [[nodiscard]] double relief() const;
    [[nodiscard]] std::size_t fracture_faces() const;

    struct Parts;
    [[nodiscard]] const Parts& parts() const { return *parts_; }

private:
    std::unique_ptr<Parts> parts_;
};

/// Length scale for comparing two fracture surfaces: the size of the smaller fragment, or six times the width of the narrower
/// fracture if that is less, so that the contact tolerance stays below the thickness of a thin wall. At least 240 times the
/// noise of the two intact surfaces, so that noisy or coarse fractures can still touch.
double join_scale(const PreparedFracture& a, const PreparedFracture& b);

/// A candidate pose of the second fragment relative to the first.
struct PairCandidate {
    Motion pose;         ///< rigid; maps the second fragment onto the first
    double score = 0;    ///< contact + rim - penetration
    double contact = 0;  ///< share of the smaller fracture's area that faces the other fracture within the last search radius
    double rim = 0;      ///< share of the shorter rim that lies within the last search radius of the other rim and whose side the
                         ///< other continues
    double residual = 0;     ///< root mean square distance of the area in contact, in the unit of the fragments
    double penetration = 0;  ///< area of each fragment that is deeper inside the other than the last search radius, as a share of
                             ///< the smaller fracture
    double depth = 0;        ///< depth of the deepest point, in the unit of the fragments
    JoinEvidence evidence;   ///< features of the join
    double log_odds = 0;     ///< log odds of a true join from the evidence alone
};

struct PairRegistration {
    std::vector<PairCandidate> candidates;  ///< most likely first, with distinct poses
    double confidence = 0;                  ///< 0 to 1: calibrated probability that the first candidate is correct
    std::string undecided;                  ///< reason why the pair cannot be decided; empty: the first candidate is the answer
    double fracture_a = 0, fracture_b = 0;  ///< areas of the fractures
    double size = 0;                        ///< square root of the area of the smaller fragment
    double scale = 0;                       ///< join_scale
    std::size_t tried = 0;                  ///< number of poses tried
    [[nodiscard]] bool decided() const { return undecided.empty(); }
};

/// Places frames along the rims of the fractures: normals of the outer (or inner) surface and of the fracture, and the rim
/// direction. Aligning each frame of the second fragment with each frame of the first on the same side, fractures facing each
/// other, gives the initial poses; each is scored by the fracture area that comes into contact less the area that would lie
/// inside the other fragment. The best poses are refined by ICP, point to plane, between fractures that face each other and
/// between rims whose sides continue each other, while the search radius falls to its last value. The evidence of each refined
/// pose (join_evidence.h) gives its probability. Deterministic, and independent of the poses of the fragments and of their
/// order: swapping them gives the inverse poses.
PairRegistration register_fractures(const PreparedFracture& a, const PreparedFracture& b, const PairOptions& options = {});
/// As above; prepares the fragments first.
PairRegistration register_fractures(const Fragment& a, const Fragment& b, const PairOptions& options = {});

/// Best score of a pair of fractures with `places` frames along each rim, before any pose is refined: to choose which pairs to
/// try. Higher is better; dimensionless.
double initial_pair_score(const PreparedFracture& a, const PreparedFracture& b, const PairOptions& options = {},
                          std::size_t places = 64);

/// Features of the join if `pose` maps b onto a; `tolerance` is a length. Uses at most `samples` points of each fracture and of
/// the surface that is tested for penetration.
JoinEvidence measure_join(const PreparedFracture& a, const PreparedFracture& b, const Motion& pose, double tolerance,
                          std::size_t samples = std::numeric_limits<std::size_t>::max());

/// A point of b's fracture or rim matched to a plane of a's; each in its own fragment's frame.
struct ContactPoint {
    Eigen::Vector3d on_a, normal, on_b;  ///< the unit normal is a's
    double weight = 1;                   ///< falls from 1 to 0 with the distance
};
/// Point-to-plane pairs where the fractures face each other within `search_radius` and where one rim continues the other;
/// `pose` maps b onto a. Uses at most `samples` points of the fracture.
std::vector<ContactPoint> contact_points(const PreparedFracture& a, const PreparedFracture& b, const Motion& pose,
                                         double search_radius, std::size_t samples);

/// The report on a pair (doc/schema/pair.schema.json): verdict, confidence, candidates with their poses (4 x 4).
JsonValue pair_to_json(const PairRegistration& pair, const std::string& a, const std::string& b, JsonAllocator& allocator);

}  // namespace ostraka
