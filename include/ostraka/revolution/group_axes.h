// Checks whether fragments joined along their fractures agree on one axis of revolution.
#pragma once

#include "ostraka/revolution/surface_of_revolution.h"

#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// Whether two joined fragments agree on one axis of revolution.
enum class AxesAgree {
    yes,
    no,       ///< the deviation between the fragments' axes exceeds the errors of the axes and of a join
    unknown,  ///< at least one of the fragments does not have an axis of its own
};
std::string to_string(AxesAgree agree);

/// Axes of two joined fragments.
struct JoinAxes {
    std::size_t first = 0, second = 0;     ///< indices of the fragments in the group
    AxesAgree agree = AxesAgree::unknown;  ///< whether the two axes agree
    double angle = 0;                      ///< angle between the fragments' own axes, in the poses of the group, degrees
    double offset = 0;  ///< distance between the two axes midway between the fragments, as a share of the group's diagonal
};

/// Axis of revolution of a group of joined fragments.
struct GroupAxis {
    Axis axis;  ///< common axis; not found, with the reason, if the group is no wheel-thrown vessel
    /// Standard errors of the axis: of its direction in degrees, of its position at the centroid as a length.
    double direction_error = 0, place_error = 0;
    double diameter = 0;  ///< largest diameter of a fragment's own profile about its own axis; 0: none
    /// Share of the area (without fractures) that belongs to fragments that are rotationally symmetric about the axis.
    double round = 0;
    double diagonal = 0;  ///< diagonal of the group
    /// For each fragment: own axis, lean, aside, weight and use; members that need a template are not set.
    std::vector<SherdOnProfile> fragments;
    std::vector<JoinAxes> joins;  ///< agreement of the axes for each join
};

/// Estimates the axis of revolution of a group, as `template_of_revolution` does. `placed`: fragments in the poses of the group,
/// with their facets; `joins`: pairs of fragments that are joined. The axis is found if fragments with 70 % of the area
/// (`AxisOptions::min_quality`) are rotationally symmetric about it. Two joined fragments contradict each other if their own axes
/// differ by more than 10 degrees or 10 % of the diagonal plus three of their standard errors. No fragment is moved.
GroupAxis axis_of_group(const std::vector<Fragment>& placed, const std::vector<std::pair<std::size_t, std::size_t>>& joins,
                        const RevolutionOptions& options = {});

}  // namespace ostraka
