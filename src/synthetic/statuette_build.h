// The parts a generated statuette is built from.
#pragma once

#include "warp.h"

#include "ostraka/synthetic/statuettes.h"

#include <array>

namespace ostraka::shapes {

/// Main sizes, mm.
struct StatuetteFrame {
    explicit StatuetteFrame(const StatuetteParameters& parameters);
    double neck_radius;
    double joint_height;  ///< of the head's joint: at the back of the neck it is head_height away from the topmost point
    double tube_radius;
    double cavity_depth;                   ///< as seen
    std::vector<Eigen::Vector2d> outline;  ///< radius and height of the body before it is warped, from the rim to the neck
};

/// How the body deviates from a turned one.
struct StatuetteBody {
    explicit StatuetteBody(const StatuetteParameters& parameters);
    StatuetteFrame frame;
    std::shared_ptr<const Warp> outside, inside;
    double direction;  ///< of the ovality at height 0
    double ragged;     ///< phase of the line where sight into the cavity ends
};

/// A rolled arm; its length along the outside, to the tip where that is free, is the parameter's.
class Arm {
public:
    Arm(const StatuetteParameters& parameters, const StatuetteBody& body, double side);
    /// Places along the outside, evenly spread from the joint to the hand, and the hand's tip unless it is in a bowl.
    [[nodiscard]] std::vector<Eigen::Vector3d> outside(int pieces) const;
    [[nodiscard]] double outside_length() const;
    [[nodiscard]] double side() const { return side_; }
    std::vector<Bead> beads;

private:
    double side_;
    bool bare_;  ///< the hand's tip is free
};
/// Right (at negative y, for the face looks along x), left.
std::array<Arm, 2> body_arms(const StatuetteParameters& parameters, const StatuetteBody& body);

void check_parameters(const StatuetteParameters& parameters);
std::unique_ptr<SyntheticObject> build_statuette(const StatuetteParameters& parameters, const StatuetteBody& body);

}  // namespace ostraka::shapes
