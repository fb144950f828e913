#include "catalogue/capacity.h"

#include "ostraka/slicing/capacity.h"

namespace ostraka::detail {

VesselCapacity capacity_of(const Mesh& mesh) {
    VesselCapacity result;
    const Capacity capacity = find_capacity(mesh, Vector(0, 0, 1), {{FillRequest::Kind::share, 1.0, {}}});
    result.reason = capacity.reason;
    if (!capacity.known()) return result;
    result.volume = capacity.full.volume;
    const LiquidVolume& full = capacity.levels.empty() ? capacity.full : capacity.levels.front();
    result.deviation = full.uncertainty();
    return result;
}

}  // namespace ostraka::detail
