// Components of a synthetic statuette.
#pragma once

#include "synthetic/warp.h"

#include "ostraka/synthetic/statuettes.h"

#include <array>

namespace ostraka::shapes {

/// Main sizes of a statuette, mm.
struct StatuetteFrame {
    explicit StatuetteFrame(const StatuetteParameters& parameters);
    double neck_radius;  ///< radius of the neck
    /// Height of the head joint, chosen so that the distance of the joint, at the back of the neck, from the topmost point is
    /// head_height.
    double joint_height;
    double tube_radius;                    ///< radius of the body's tube
    double cavity_depth;                   ///< depth of the scanned part of the cavity
    std::vector<Eigen::Vector2d> outline;  ///< points (radius, height) of the body before warping, from the rim to the neck
};

/// The body of a statuette: its deviations from a surface of revolution.
struct StatuetteBody {
    explicit StatuetteBody(const StatuetteParameters& parameters);
    StatuetteFrame frame;                         ///< main sizes
    std::shared_ptr<const Warp> outside, inside;  ///< warps of the outer surface and of the cavity
    double direction;                             ///< direction of the ovality at height 0
    double cavity_end_phase;                      ///< phase of the irregular line where the scanned part of the cavity ends
};

/// A rolled arm. The length of the arm along the outside, up to a free tip, is the length in the parameters.
class Arm {
public:
    Arm(const StatuetteParameters& parameters, const StatuetteBody& body, double side);
    /// Points along the outside of the arm, evenly spaced from the joint to the hand, and the tip of the hand unless the hand is
    /// in a bowl.
    [[nodiscard]] std::vector<Eigen::Vector3d> outside(int pieces) const;
    [[nodiscard]] double outside_length() const;         ///< length along the outside, from the joint to the tip
    [[nodiscard]] double side() const { return side_; }  ///< -1: right, 1: left
    std::vector<Bead> beads;                             ///< balls along the arm

private:
    double side_;    ///< -1: right, 1: left
    bool free_tip_;  ///< true: the tip of the hand is free
};
/// The right arm (at negative y, because the face looks along x), then the left arm.
std::array<Arm, 2> body_arms(const StatuetteParameters& parameters, const StatuetteBody& body);

/// Throws Error (usage) for parameters out of range or inconsistent parameters.
void check_parameters(const StatuetteParameters& parameters);
std::unique_ptr<SyntheticObject> build_statuette(const StatuetteParameters& parameters, const StatuetteBody& body);

}  // namespace ostraka::shapes
