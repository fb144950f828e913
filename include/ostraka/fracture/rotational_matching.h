// Determines the rotations of sherds about the axis of their vessel by matching their fractures.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/fracture/fragment.h"

#include <string>
#include <vector>

namespace ostraka {

/// Options of `match_rotations`.
struct RotationMatchOptions {
    /// Whether rotations are determined from the fractures: automatic (where undetermined) or never.
    enum class Turns { automatic, never } rotations = Turns::automatic;
    int frames = 200;        ///< number of frames along the rim of each sherd's fracture
    int samples = 2000;      ///< number of points on each fracture
    int candidates = 16;     ///< number of rotations per pair of sherds that are refined
    int beam = 64;           ///< number of assemblies kept at each step of the beam search
    double hold = 0.5;       ///< weight of the distance from the template relative to the distance between fractures
    double min_joint = 0.5;  ///< min confidence of a joint; joints of lower confidence are reported as undecided

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A sherd registered to the template vessel, except for an unknown rotation about the axis of the vessel.
struct SherdOnAxis {
    const Fragment* fragment = nullptr;  ///< must not be null
    Motion pose;                         ///< maps the sherd onto the template; correct except for the rotation about the axis
    /// True: the rotation is known too (from landmarks), and other sherds are rotated to fit this sherd.
    bool fixed = false;
};

/// Two sherds that meet along a fracture.
struct FractureJoint {
    int first = 0, second = 0;  ///< indices of the sherds
    /// Rotation of the second sherd about the axis minus the rotation of the first, in degrees.
    double rotation = 0;
    /// Fraction of the smaller fracture that meets the other fracture within half of the wall thickness.
    double contact = 0;
    double rim = 0;       ///< fraction of the shorter rim along which the other sherd continues the intact side
    double residual = 0;  ///< root mean square distance of the area in contact, in the unit of the sherds
    double score = 0;     ///< contact (weighted by closeness) + rim - fraction of the area inside the other sherd (dimensionless)
    /// True: the joint is an edge of the spanning tree of the assembly; false: the joint closes a cycle.
    bool carries = false;
    /// Confidence of a joint of the spanning tree. All sherds on one side of the joint are rotated against all sherds on the
    /// other side. share: fraction of the smaller side's fracture area that meets the other side plus fraction of its rim that
    /// does (0 to 2). lead: margin over the best other rotation (0 to 1). confidence: resulting confidence (0 to 1).
    double share = 0, lead = 0, confidence = 0;
    bool decided = false;  ///< true: the confidence is at least min_joint
};

/// Result of `match_rotations`.
struct RotationMatch {
    std::vector<Motion> poses;  ///< per sherd: maps the sherd onto the vessel
    /// Per sherd: number of its group; sherds of a group are connected by decided joints, or fixed.
    std::vector<int> group;
    /// Joints of the assembly: first those of the spanning tree, then the others; each by descending score.
    std::vector<FractureJoint> joints;
    /// Per sherd: area that another sherd overlaps, as a fraction of the sherd's area.
    std::vector<double> overlap;
    std::vector<std::string> notes;  ///< per sherd: why the sherd has no decided joint; empty if it has one
    /// Median width of the fractures, an estimate of the wall thickness; closeness is measured relative to it.
    double wall = 0;
};

/// Finds the rotations of sherds on a vessel. `vessel` is a surface of revolution about the line through `point` along
/// `direction`, and the sherds lie on the vessel up to a rotation about that line. Every relative rotation of each pair of sherds
/// has a score: the fracture area that is close to and faces the other fracture, minus the surface area that both sherds would
/// cover. The rotations of highest score are refined by ICP as in register_fractures, with all six degrees of freedom, the
/// sherd's own surface constrained to the template. The assembly maximises the sum over all pairs, including cycles, by a beam
/// search that starts from the largest sherd; then all sherds are refined together. A joint of the spanning tree is decided if
/// no other rotation of its two sides about the axis has nearly the same score. Sherds without a decided joint are reported
/// and, if possible, placed where they overlap no other sherd. The result is deterministic. Throws Error (usage) without sherds
/// or for options out of range.
RotationMatch match_rotations(const Mesh& vessel, const Eigen::Vector3d& point, const Eigen::Vector3d& direction,
                              const std::vector<SherdOnAxis>& sherds, const RotationMatchOptions& options = {});

}  // namespace ostraka
