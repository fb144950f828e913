// Capacity of a vessel for its catalogue entry.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <limits>
#include <string>

namespace ostraka::detail {

/// Capacity of an upright vessel, in cubic units of the mesh; or why it is not known.
struct VesselCapacity {
    double volume = std::numeric_limits<double>::quiet_NaN();     ///< volume to the overflow; NaN: unknown
    double deviation = std::numeric_limits<double>::quiet_NaN();  ///< standard deviation of the volume; NaN: unknown
    std::string reason;                                           ///< why the volume is unknown; empty: it is known
};
/// Capacity of a vessel whose z axis points up.
VesselCapacity capacity_of(const Mesh& mesh);

}  // namespace ostraka::detail
