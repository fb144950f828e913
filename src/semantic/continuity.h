// The segment of a part that continues another part's axis.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/axis/axis.h"

namespace ostraka::semantic {

struct AxisSegment {
    std::vector<int> vertices;  ///< of the part, ascending
    std::vector<int> stations;  ///< for each, the station along the axis it belongs to, from 0 at the reference on
    int count = 0;              ///< stations
    std::string reason;         ///< why there is none, if there is none
};

/// Walks the mean curvature skeleton of the capped part from the end that is nearer to the reference, as long as its direction
/// (over a twentieth of its length) differs from `axis` by at most `angle` degrees (the thesis, section 5.2.2), and takes the
/// vertices beside it.
AxisSegment continuing_segment(const Mesh& mesh, const Annotation& part, const Annotation& reference, const Vector& axis,
                               double angle);

}  // namespace ostraka::semantic
