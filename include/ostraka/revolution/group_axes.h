// Do fragments that were joined by their breaks agree on one axis of revolution?
#pragma once

#include "ostraka/revolution/surface_of_revolution.h"

#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// What two joined fragments say of one axis.
enum class AxesAgree {
    yes,
    no,       ///< their axes are farther apart than their errors and a join's error allow
    unknown,  ///< one of them has no axis of its own
};
std::string to_string(AxesAgree agree);

struct JoinAxes {
    std::size_t first = 0, second = 0;  ///< of the group
    AxesAgree agree = AxesAgree::unknown;
    double angle = 0;   ///< degrees between their own axes where they lie
    double offset = 0;  ///< distance of the two in the middle between them, as a share of the group's diagonal
};

struct GroupAxis {
    Axis axis;  ///< common; not found where the group is no vessel turned on the wheel, with the reason
    double direction_error = 0, place_error = 0;
    double diameter = 0;                    ///< the largest that a fragment's own profile about its axis tells; 0: none does
    double round = 0;                       ///< share of the area (but for breaks) that belongs to fragments round about the axis
    double diagonal = 0;                    ///< of the group
    std::vector<SherdOnProfile> fragments;  ///< own axis, lean, aside, weight, use; as far as the axis goes
    std::vector<JoinAxes> joins;
};

/// Fragments where they lie in a group, breaks known as facets, and pairs of them that are joined. The group's axis is sought as
/// `template_of_revolution` does; it is taken for that of a turned vessel where fragments with 70 % of the area
/// (`AxisOptions::min_quality`) are round about it. Two joined fragments contradict each other where their own axes are more than
/// 10 degrees or 10 % of the diagonal apart, and three of their standard errors more. Nothing is moved.
GroupAxis axis_of_group(const std::vector<Fragment>& placed, const std::vector<std::pair<std::size_t, std::size_t>>& joins,
                        const RevolutionOptions& options = {});

}  // namespace ostraka
