// Sherds of a vessel whose turns about its axis are open, turned so that their breaks meet.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/fracture/fragment.h"

#include <string>
#include <vector>

namespace ostraka {

struct BreakTurnOptions {
    enum class Turns { automatic, never } turns = Turns::automatic;  ///< decided where they are open
    int frames = 200;                                                ///< places along the rim of each sherd's fracture
    int samples = 2000;                                              ///< points on each fracture
    int candidates = 16;                                             ///< turns of a pair that are refined
    int beam = 64;                                                   ///< assemblies that are followed
    double hold = 0.5;                                               ///< weight of the place on the template against the breaks
    double least_confidence = 0.5;                                   ///< of a joint; below it is not decided

    void describe(OptionList& visit);
};

/// A sherd on the template. Fixed: its turn is known (landmarks), the others come to it.
struct TurnableSherd {
    const Fragment* fragment = nullptr;
    Motion pose;  ///< onto the template: axis and height
    bool fixed = false;
};

/// Two sherds that meet in a break.
struct BreakJoint {
    int first = 0, second = 0;  ///< sherds
    double turn = 0;            ///< degrees about the axis that the second was turned, less those of the first
    double contact = 0;         ///< share of the smaller fracture that meets the other's within half of the wall
    double rim = 0;             ///< share of the shorter rim whose side the other continues
    double residual = 0;        ///< root mean square distance of what is in contact, in the unit of the sherds
    double score = 0;           ///< contact, weighed by closeness, + rim - what lies inside the other
    bool carries = false;       ///< of the tree that holds the sherds together; else it closes a cycle
    /// Of a joint that carries, with all sherds on its one side turned against all on the other: what meets across, as a share of
    /// the fractures of the lesser side (rims count as much, so up to 2); how far the best other turn falls behind (0 to 1); and
    /// the confidence that follows.
    double share = 0, lead = 0, confidence = 0;
    bool decided = false;
};

struct BreakTurns {
    std::vector<Motion> poses;       ///< of each sherd
    std::vector<int> group;          ///< of each: those of one number hold together by decided joints (or are fixed)
    std::vector<BreakJoint> joints;  ///< of the assembly, those that carry first, best first
    std::vector<double> overlap;     ///< of each sherd: area that lies where another one does, share of its own
    std::vector<std::string> notes;  ///< of each sherd: why it has no decided joint; else empty
    double wall = 0;                 ///< width of the fractures, middle one: the length by which closeness is measured
};

/// `whole` is a surface of revolution about the line through `point` along `direction`, and the sherds lie on it up to a turn
/// about that line. For each pair every turn is tried: what of the fractures comes close, facing each other, less the area of the
/// surface on which both would lie. The best turns are refined by closest points as in pair_breaks, with all six degrees of
/// freedom, held to the template by the sherd's own surface. The assembly is the one of largest sum over all pairs at once, so
/// that cycles speak with it, followed from the largest sherd by a beam search; then all sherds are refined together. A joint
/// that carries is decided if turning its two sides against each other about the axis finds no other turn nearly as good. Sherds
/// without a decided joint are named and stand where they overlap nothing, if there is such a place. No chance is involved.
/// Throws Error (usage) without sherds or for options out of range.
BreakTurns turn_by_breaks(const Mesh& whole, const Eigen::Vector3d& point, const Eigen::Vector3d& direction,
                          const std::vector<TurnableSherd>& sherds, const BreakTurnOptions& options = {});

}  // namespace ostraka
