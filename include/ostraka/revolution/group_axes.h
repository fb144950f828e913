// Checks whether fragments joined along their fractures agree on one axis of revolution.
#pragma once

#include "ostraka/revolution/surface_of_revolution.h"

#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// Agreement of two joined fragments on one axis.
enum class AxesAgree {
    yes,
    no,       ///< the deviation of their axes exceeds their errors and that of a join
    unknown,  ///< at least one of them does not have its own axis
};
std::string to_string(AxesAgree agree);

struct JoinAxes {
    std::size_t first = 0, second = 0;  ///< indices in the group
    AxesAgree agree = AxesAgree::unknown;
    double angle = 0;   ///< degrees between their own axes, as placed
    double offset = 0;  ///< distance of the two axes midway between the fragments, as a share of the group's diagonal
};

struct GroupAxis {
    Axis axis;  ///< common axis; not found if the group is no wheel-thrown vessel, with the reason
    double direction_error = 0, place_error = 0;
    double diameter = 0;  ///< largest diameter from a fragment's own profile about its axis; 0: none
    double round = 0;     ///< share of the area (without fractures) on fragments that are rotationally symmetric about the axis
    double diagonal = 0;  ///< diagonal of the group
    std::vector<SherdOnProfile> fragments;  ///< own axis, lean, aside, weight, use; only members that depend on the axis
    std::vector<JoinAxes> joins;
};

/// Input: fragments as placed in a group, with their facets, and the pairs that are joined. Estimates the axis of the group as
/// `template_of_revolution` does. The axis is found if fragments with 70 % of the area (`AxisOptions::min_quality`) are
/// rotationally symmetric about it. Two joined fragments contradict each other if their own axes differ by more than 10 degrees
/// or 10 % of the diagonal plus three of their standard errors. No fragment is moved.
GroupAxis axis_of_group(const std::vector<Fragment>& placed, const std::vector<std::pair<std::size_t, std::size_t>>& joins,
                        const RevolutionOptions& options = {});

}  // namespace ostraka
