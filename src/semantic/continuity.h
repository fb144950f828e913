// The segment of a part that continues the axis of a reference part.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/axis/axis.h"

#include <Eigen/Geometry>

namespace ostraka::semantic {

/// Vertices of a part along the continued axis, and stations along the axis.
struct AxisSegment {
    std::vector<int> vertices;  ///< indices of the part's vertices, ascending
    /// For each vertex, the index of the station before it along the axis, counted from 0 at the reference part.
    std::vector<int> stations;
    std::vector<double> shares;  ///< for each vertex, its position between that station and the next, 0 to 1
    int count = 0;               ///< number of stations
    std::string reason;          ///< why there is no segment; empty if there is one
    bool is_empty = false;       ///< true: there is no segment, since the part leaves the axis immediately
};

/// Positions of the stations on deformed points: for each station, the mean of the vertices around it, weighted by hat functions
/// along the axis.
std::vector<Eigen::Vector3d> stations_of(const AxisSegment& segment, const Eigen::Matrix3Xd& points);

/// Follows the mean curvature skeleton of the capped part from the end closer to the reference part as long as the direction of
/// the skeleton (over a twentieth of its length) deviates from `axis` by at most `angle` degrees (thesis, section 5.2.2), and
/// returns the vertices along this stretch.
AxisSegment continuing_segment(const Mesh& mesh, const Annotation& part, const Annotation& reference, const Vector& axis,
                               double angle);

}  // namespace ostraka::semantic
