// The segment of a part that continues the axis of another part.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/axis/axis.h"

#include <Eigen/Geometry>

namespace ostraka::semantic {

struct AxisSegment {
    std::vector<int> vertices;   ///< vertices of the part, ascending
    std::vector<int> stations;   ///< for each vertex the station before it along the axis, counted from 0 at the reference
    std::vector<double> shares;  ///< for each vertex its position between that station and the next, 0 to 1
    int count = 0;               ///< number of stations
    std::string reason;          ///< reason if there is no segment
    bool turned = false;         ///< no segment, since the part leaves the axis immediately
};

/// Positions of the stations on deformed points: means of the vertices around each, weighted by hat functions along the axis.
std::vector<Eigen::Vector3d> stations_of(const AxisSegment& segment, const Eigen::Matrix3Xd& points);

/// Follows the mean curvature skeleton of the capped part from the end closer to the reference while its direction (over a
/// twentieth of its length) deviates from `axis` by at most `angle` degrees (the thesis, section 5.2.2), and returns the
/// vertices along it.
AxisSegment continuing_segment(const Mesh& mesh, const Annotation& part, const Annotation& reference, const Vector& axis,
                               double angle);

}  // namespace ostraka::semantic
