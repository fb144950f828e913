// The baroque chair of figures 5.5 to 5.7 and 5.18 of the thesis: its arm is lengthened, and the support below it follows.
#pragma once

#include "semantics.h"

namespace ostraka::experiments {

struct Chair {
    Subject subject;
    std::vector<Point> edited;  ///< left arm lengthened, its support rotated about its foot to meet the arm as before
    std::vector<Index>
        segment;                ///< vertices of the left support that continue the leg; also the annotation "foot of the support"
    std::vector<int> stations;  ///< for each vertex of `segment`: slice along the leg's axis
    int count = 0;              ///< number of slices
    Eigen::Vector3d point, direction;  ///< axis of the undeformed leg
};
/// The synthetic chair; the upper halves of the supports are bent backwards, so that only their feet continue the legs.
Chair make_chair(const Path& data, std::uint64_t vertices);

struct AxisDeviation {
    double angle = 0, distance = 0;  ///< degrees, mm
};
/// Deviation of the means of the segment's slices from the axis of the deformed leg.
AxisDeviation deviation(const Chair& chair, const std::vector<Point>& points);

/// As in the thesis: co-axiality of surface points with the leg, and Laplacians on the arm, with equal weights.
Constraints thesis_constraints(const Chair& chair, const std::vector<Index>& constrained);
/// As in this library: structural continuity of the support and the leg; with `shape` its foot also keeps its shape.
RelationGraph continuity_graph(const Chair& chair, bool hard, bool shape = false);
DeformOptions continuity_options(const SolveOptions& solve);

}  // namespace ostraka::experiments
