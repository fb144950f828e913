// Components of a synthetic statuette.
#pragma once

#include "synthetic/warp.h"

#include "ostraka/synthetic/statuettes.h"

#include <array>

namespace ostraka::shapes {

/// Main sizes, mm.
struct StatuetteFrame {
    explicit StatuetteFrame(const StatuetteParameters& parameters);
    double neck_radius;
    /// Height of the head joint: at the back of the neck, its distance from the topmost point is head_height.
    double joint_height;
    double tube_radius;
    double cavity_depth;                   ///< scanned depth
    std::vector<Eigen::Vector2d> outline;  ///< radius and height of the body before warping, from the rim to the neck
};

/// Deviations of the body from a surface of revolution.
struct StatuetteBody {
    explicit StatuetteBody(const StatuetteParameters& parameters);
    StatuetteFrame frame;
    std::shared_ptr<const Warp> outside, inside;
    double direction;  ///< direction of the ovality at height 0
    double ragged;     ///< phase of the line where the scanned part of the cavity ends
};

/// A rolled arm. Its length along the outside, up to a free tip, is the length given by the parameters.
class Arm {
public:
    Arm(const StatuetteParameters& parameters, const StatuetteBody& body, double side);
    /// Points along the outside, evenly spaced from the joint to the hand, and the tip of the hand unless it is in a bowl.
    [[nodiscard]] std::vector<Eigen::Vector3d> outside(int pieces) const;
    [[nodiscard]] double outside_length() const;
    [[nodiscard]] double side() const { return side_; }
    std::vector<Bead> beads;

private:
    double side_;
    bool bare_;  ///< whether the tip of the hand is free
};
/// Right (negative y, because the face looks along x), left.
std::array<Arm, 2> body_arms(const StatuetteParameters& parameters, const StatuetteBody& body);

void check_parameters(const StatuetteParameters& parameters);
std::unique_ptr<SyntheticObject> build_statuette(const StatuetteParameters& parameters, const StatuetteBody& body);

}  // namespace ostraka::shapes
