// The segment of a part that continues another part's axis.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/axis/axis.h"

#include <Eigen/Geometry>

namespace ostraka::semantic {

struct AxisSegment {
    std::vector<int> vertices;   ///< of the part, ascending
    std::vector<int> stations;   ///< for each, the last station before it along the axis, from 0 at the reference on
    std::vector<double> shares;  ///< for each, how far it is from that station to the next, 0 to 1
    int count = 0;               ///< stations
    std::string reason;          ///< why there is none, if there is none
    bool turned = false;         ///< there is none since the part leaves the axis at once
};

/// Where the stations are on deformed points: means of the vertices around each, weighted by hat functions along the axis.
std::vector<Eigen::Vector3d> stations_of(const AxisSegment& segment, const Eigen::Matrix3Xd& points);

/// Walks the mean curvature skeleton of the capped part from the end that is nearer to the reference, as long as its direction
/// (over a twentieth of its length) differs from `axis` by at most `angle` degrees (the thesis, section 5.2.2), and takes the
/// vertices beside it.
AxisSegment continuing_segment(const Mesh& mesh, const Annotation& part, const Annotation& reference, const Vector& axis,
                               double angle);

}  // namespace ostraka::semantic
