// Sherds of a vessel whose rotations about its axis are open, rotated so that their breaks meet.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/fracture/fragment.h"

#include <string>
#include <vector>

namespace ostraka {

struct RotationMatchOptions {
    enum class Turns { automatic, never } rotations = Turns::automatic;  ///< decided where they are open
    int frames = 200;                                                    ///< places along the rim of each sherd's fracture
    int samples = 2000;                                                  ///< points on each fracture
    int candidates = 16;                                                 ///< rotations of a pair that are refined
    int beam = 64;                                                       ///< assemblies that are followed
    double hold = 0.5;       ///< weight of the place on the template against the breaks
    double min_joint = 0.5;  ///< of a joint; below it is not decided

    void describe(OptionList& visit);
};

/// A sherd on the template. Fixed: its rotation is known (landmarks), the others come to it.
struct SherdOnAxis {
    const Fragment* fragment = nullptr;
    Motion pose;  ///< onto the template: axis and height
    bool fixed = false;
};

/// Two sherds that meet in a break.
struct BreakJoint {
    int first = 0, second = 0;  ///< sherds
    double rotation = 0;        ///< degrees about the axis that the second was rotated, less those of the first
    double contact = 0;         ///< share of the smaller fracture that meets the other's within half of the wall
    double rim = 0;             ///< share of the shorter rim whose side the other continues
    double residual = 0;        ///< root mean square distance of what is in contact, in the unit of the sherds
    double score = 0;           ///< contact, weighed by closeness, + rim - what lies inside the other
    bool carries = false;       ///< of the tree that holds the sherds together; else it closes a cycle
    /// Of a joint that carries, with all sherds on its one side rotated against all on the other: what meets across, as a share
    /// of the fractures of the lesser side (rims count as much, so up to 2); how far the best other rotation falls behind (0 to
    /// 1); and the confidence that follows.
    double share = 0, lead = 0, confidence = 0;
    bool decided = false;
};

struct RotationMatch {
    std::vector<Motion> poses;       ///< of each sherd
    std::vector<int> group;          ///< of each: those of one number hold together by decided joints (or are fixed)
    std::vector<BreakJoint> joints;  ///< of the assembly, those that carry first, best first
    std::vector<double> overlap;     ///< of each sherd: area that lies where another one does, share of its own
    std::vector<std::string> notes;  ///< of each sherd: why it has no decided joint; else empty
    double wall = 0;                 ///< width of the fractures, middle one: the length by which closeness is measured
};

/// `whole` is a surface of revolution about the line through `point` along `direction`, and the sherds lie on it up to a rotation
/// about that line. For each pair every rotation is tried: what of the fractures comes close, facing each other, less the area of
/// the surface on which both would lie. The best rotations are refined by closest points as in pair_breaks, with all six degrees
/// of freedom, held to the template by the sherd's own surface. The assembly is the one of largest sum over all pairs at once, so
/// that cycles speak with it, followed from the largest sherd by a beam search; then all sherds are refined together. A joint
/// that carries is decided if rotating its two sides against each other about the axis finds no other rotation nearly as good.
/// Sherds without a decided joint are named and stand where they overlap nothing, if there is such a place. No chance is
/// involved. Throws Error (usage) without sherds or for options out of range.
RotationMatch match_rotations(const Mesh& whole, const Eigen::Vector3d& point, const Eigen::Vector3d& direction,
                              const std::vector<SherdOnAxis>& sherds, const RotationMatchOptions& options = {});

}  // namespace ostraka
