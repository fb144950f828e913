// Sherds as one mesh, and their axes aligned with their mean.
#pragma once

#include "ostraka/revolution/surface_of_revolution.h"

namespace ostraka {

struct JoinedSherds {
    Mesh mesh;
    std::vector<Index> faces;                     ///< that are not of a break
    std::vector<std::vector<Index>> of_fragment;  ///< the same, fragment by fragment
};

JoinedSherds joined(const std::vector<const Fragment*>& sherds, const std::vector<Motion>& motions);

/// Each sherd's own axis is aligned with the mean of all: sherds put together by hand stand off each other by their joints. Fills
/// in axis, sherds and notes of the template. The motions, one a sherd.
std::vector<Motion> common_axis(const std::vector<const Fragment*>& sherds, const RevolutionOptions& options,
                                RevolutionTemplate& result);

}  // namespace ostraka
