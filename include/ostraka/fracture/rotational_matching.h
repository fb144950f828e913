// Rotates the sherds of a vessel about its axis so that their fractures meet.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/fracture/fragment.h"

#include <string>
#include <vector>

namespace ostraka {

struct RotationMatchOptions {
    enum class Turns { automatic, never } rotations = Turns::automatic;  ///< automatic: where the rotations are undetermined
    int frames = 200;        ///< number of frames along the rim of each sherd's fracture
    int samples = 2000;      ///< number of points on each fracture
    int candidates = 16;     ///< number of rotations per pair that are refined
    int beam = 64;           ///< width of the beam search over assemblies
    double hold = 0.5;       ///< weight of the sherd's position on the template relative to the fractures
    double min_joint = 0.5;  ///< min confidence of a joint; below it the joint is not decided

    void describe(OptionList& visit);
};

/// A sherd on the template. Fixed: its rotation is known (landmarks); the others are aligned with it.
struct SherdOnAxis {
    const Fragment* fragment = nullptr;
    Motion pose;  ///< maps the sherd onto the template: axis and height
    bool fixed = false;
};

/// Two sherds that meet along a fracture.
struct FractureJoint {
    int first = 0, second = 0;  ///< indices of the sherds
    double rotation = 0;        ///< rotation of the second sherd about the axis less that of the first, in degrees
    double contact = 0;         ///< share of the smaller fracture that meets the other within half of the wall thickness
    double rim = 0;             ///< share of the shorter rim whose side the other sherd continues
    double residual = 0;        ///< root mean square distance of the area in contact, in the unit of the sherds
    double score = 0;           ///< contact, weighted by closeness, + rim - area inside the other sherd
    bool carries = false;       ///< edge of the spanning tree of the assembly; else it closes a cycle
    /// Of a joint that carries, with all sherds on one side of it rotated against all on the other: the area that meets across,
    /// as a share of the fractures of the smaller side (rims count as much, so up to 2); the margin over the best other
    /// rotation (0 to 1); and the resulting confidence.
    double share = 0, lead = 0, confidence = 0;
    bool decided = false;
};

struct RotationMatch {
    std::vector<Motion> poses;          ///< per sherd
    std::vector<int> group;             ///< per sherd: sherds with equal numbers are connected by decided joints (or fixed)
    std::vector<FractureJoint> joints;  ///< joints of the assembly; carrying ones first, best first
    std::vector<double> overlap;        ///< per sherd: area that another sherd overlaps, as a share of its own area
    std::vector<std::string> notes;     ///< per sherd: why it has no decided joint; else empty
    double wall = 0;                    ///< median width of the fractures: the unit of closeness
};

/// `vessel` is a surface of revolution about the line through `point` along `direction`, and the sherds lie on it up to a
/// rotation about that line. Every rotation of each pair is scored by the fracture area that comes close, facing the other,
/// less the surface area that both would cover. The best rotations are refined by ICP as in register_fractures, with all six
/// degrees of freedom, the sherd's own surface constrained to the template. The assembly maximises the sum over all pairs,
/// including cycles, by a beam search that starts from the largest sherd; then all sherds are refined together. A joint that
/// carries is decided if no other rotation of its two sides about the axis is nearly as good. Sherds without a decided joint are
/// reported and placed where they overlap nothing, if possible. Deterministic. Throws Error (usage) without sherds or for options
/// out of range.
RotationMatch match_rotations(const Mesh& vessel, const Eigen::Vector3d& point, const Eigen::Vector3d& direction,
                              const std::vector<SherdOnAxis>& sherds, const RotationMatchOptions& options = {});

}  // namespace ostraka
