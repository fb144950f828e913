// The baroque chair of figures 5.5 to 5.7 and 5.18 of the thesis: its arm is stretched, the support below it follows.
#pragma once

#include "semantics.h"

namespace ostraka::experiments {

struct Chair {
    Subject subject;
    std::vector<Point> edited;  ///< the left arm longer, its support turned about its foot so that it meets the arm where it did
    std::vector<Index>
        segment;                ///< vertices of the left support that continue the leg; also the annotation "foot of the support"
    std::vector<int> stations;  ///< slice along the leg's axis for each of them
    int count = 0;              ///< slices
    Eigen::Vector3d point, direction;  ///< the leg's axis at rest
};
/// The synthetic chair with supports that are bent backwards at their upper half: only their feet continue the legs.
Chair make_chair(const Path& data, std::uint64_t vertices);

struct AxisDeviation {
    double angle = 0, distance = 0;  ///< degrees, mm
};
/// Between the axis of the leg as it is now and the means of the segment's slices.
AxisDeviation deviation(const Chair& chair, const std::vector<Point>& points);

/// As in the thesis: co-axiality of surface points with the leg and Laplacians on the arm, of equal weight.
Constraints thesis_constraints(const Chair& chair, const std::vector<Index>& constrained);
/// As here: structural continuity of the support and the leg; with `shape` its foot also keeps its shape.
RelationGraph continuity_graph(const Chair& chair, bool hard, bool shape = false);
DeformOptions continuity_options(const SolveOptions& solve);

}  // namespace ostraka::experiments
