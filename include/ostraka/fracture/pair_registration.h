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

/// Options of `register_fractures`.
struct PairOptions {
    int frames = 160;    ///< number of frames along the rim of each fracture
    int samples = 2000;  ///< number of points on each fracture, and on the intact surface of each fragment
    int starts = 200;    ///< number of initial poses (those with the highest scores) that are refined coarsely
    int refined = 32;    ///< number of poses (the best after coarse refinement) that are refined to convergence
    /// Initial max distance of facing fracture points, as a fraction of the smaller fragment's size.
    double search_radius = 0.05;
    /// Final max distance of facing fracture points, as a fraction of join_scale.
    double last_search_radius = 0.025;
    double edges = 1;             ///< weight of matches between rims relative to matches between fracture surfaces
    double min_confidence = 0.5;  ///< min confidence of an answer; below it the pair is reported as undecided
    int candidates = 5;           ///< max number of candidates reported

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Data for matching a fragment's fracture, precomputed once: samples of the fracture and of the intact surface, frames along the
/// rim, search trees. The object stores a copy of the mesh; the size of all other data does not depend on the mesh.
class PreparedFracture {
public:
    /// Prepares a fragment whose facets are known (facets.h, or annotations). Throws Error (input) if the fragment has no area,
    /// no fracture or no rim.
    explicit PreparedFracture(const Fragment& fragment, const PairOptions& options = {});
    ~PreparedFracture();
    PreparedFracture(PreparedFracture&&) noexcept;
    PreparedFracture& operator=(PreparedFracture&&) noexcept;

    [[nodiscard]] const std::string& name() const;  ///< name of the fragment
    [[nodiscard]] const Mesh& mesh() const;
    [[nodiscard]] double size() const;           ///< square root of the surface area
    [[nodiscard]] double fracture_area() const;  ///< area of the fracture surface
    [[nodiscard]] double rim_length() const;     ///< length of the fracture's rim
    /// Twice the area of the fracture divided by the length of its rim: for a sherd, the thickness of its wall.
    [[nodiscard]] double width() const;
    /// Root mean square deviation of the fracture from a quadric fitted to it.
    [[nodiscard]] double relief() const;
    [[nodiscard]] std::size_t fracture_faces() const;  ///< number of faces on the fracture

    struct Parts;
    [[nodiscard]] const Parts& parts() const { return *parts_; }

private:
    std::unique_ptr<Parts> parts_;
};

/// Length scale for comparing two fracture surfaces: the size of the smaller fragment, or six times the width of the narrower
/// fracture if that is less, so that the contact tolerance stays below the thickness of a thin wall. The scale is at least 240
/// times the noise of the two intact surfaces, so that noisy or coarse fracture surfaces can still be in contact.
double join_scale(const PreparedFracture& a, const PreparedFracture& b);

/// A candidate pose of the second fragment relative to the first.
struct PairCandidate {
    Motion pose;       ///< rigid motion that maps the second fragment onto the first
    double score = 0;  ///< score of the pose: contact + rim - penetration (dimensionless)
    /// Fraction of the smaller fracture's area that faces the other fracture within the last search radius.
    double contact = 0;
    /// Fraction of the shorter rim that lies within the last search radius of the other rim, where the other fragment continues
    /// the intact side.
    double rim = 0;
    /// Root mean square distance between the fracture surfaces where they are in contact, in the unit of the fragments.
    double residual = 0;
    /// Area of both fragments that lies inside the other fragment by more than the last search radius, as a fraction of the
    /// smaller fracture's area.
    double penetration = 0;
    /// Largest depth of a point of one fragment inside the other fragment, in the unit of the fragments.
    double depth = 0;
    JoinEvidence evidence;  ///< features of the join
    double log_odds = 0;    ///< log odds of a true join from the evidence alone
};

/// Result of the registration of two fragments.
struct PairRegistration {
    std::vector<PairCandidate> candidates;  ///< candidate poses, most likely first; near-duplicates are removed
    double confidence = 0;                  ///< 0 to 1: calibrated probability that the first candidate is correct
    std::string undecided;                  ///< reason why the pair cannot be decided; empty: the first candidate is the answer
    double fracture_a = 0, fracture_b = 0;  ///< areas of the fractures
    double size = 0;                        ///< square root of the area of the smaller fragment
    double scale = 0;                       ///< length scale of the comparison (join_scale)
    std::size_t tried = 0;                  ///< number of poses tried
    [[nodiscard]] bool decided() const { return undecided.empty(); }
};

/// Registers two fragments along their fractures. Frames are placed along the rims. A frame consists of the normal of the outer
/// (or inner) surface, the normal of the fracture surface and the direction of the rim. Each frame of the second fragment is
/// aligned with each frame of the first on the same side, so that the fractures face each other; this gives the initial poses.
/// The score of an initial pose is the fracture area in contact minus the area that lies inside the other fragment. The poses
/// with the highest scores are refined by ICP (point to plane) between fractures that face each other and between rims whose
/// sides continue each other, while the search radius decreases to its last value. The features of each refined pose
/// (join_evidence.h) determine its probability. The result is deterministic and does not depend on the poses of the fragments
/// or on their order: swapping the fragments gives the inverse poses.
PairRegistration register_fractures(const PreparedFracture& a, const PreparedFracture& b, const PairOptions& options = {});
/// Prepares two fragments and registers them along their fractures.
PairRegistration register_fractures(const Fragment& a, const Fragment& b, const PairOptions& options = {});

/// Highest score of the initial poses of a pair, with `places` frames along each rim and without refinement; dimensionless,
/// higher is better. Used to choose the pairs that are registered.
double initial_pair_score(const PreparedFracture& a, const PreparedFracture& b, const PairOptions& options = {},
                          std::size_t places = 64);

/// Features of the join of two fragments when `pose` maps b onto a; `tolerance` is a length. `samples`: max number of sample
/// points of each fracture, and of the surface that is tested for penetration.
JoinEvidence measure_join(const PreparedFracture& a, const PreparedFracture& b, const Motion& pose, double tolerance,
                          std::size_t samples = std::numeric_limits<std::size_t>::max());

/// A point on the fracture or rim of fragment b, matched to a tangent plane of the fracture or rim of fragment a. Each is given
/// in the coordinates of its own fragment.
struct ContactPoint {
    Eigen::Vector3d on_a, normal, on_b;  ///< point on a; unit normal of the plane on a; point on b
    double weight = 1;                   ///< weight of the match; falls from 1 to 0 with the distance
};
/// Point-to-plane matches where the fractures face each other within `search_radius` and where one rim continues the other;
/// `pose` maps b onto a. At most `samples` points of the fracture are used.
std::vector<ContactPoint> contact_points(const PreparedFracture& a, const PreparedFracture& b, const Motion& pose,
                                         double search_radius, std::size_t samples);

/// The report on a pair (doc/schema/pair.schema.json): verdict, confidence, candidates with their poses (4 x 4).
JsonValue pair_to_json(const PairRegistration& pair, const std::string& a, const std::string& b, JsonAllocator& allocator);

}  // namespace ostraka
