#include "catalogue/capacity.h"

#include "ostraka/slicing/capacity.h"

namespace ostraka::detail {

VesselCapacity capacity_of(const Mesh& mesh) {
    VesselCapacity result;
    const std::vector<FillRequest> to_the_rim{FillRequest{FillRequest::Kind::share, 1.0, {}}};  // with its uncertainty
    const Capacity capacity = find_capacity(mesh, Vector(0, 0, 1), to_the_rim);
    result.reason = capacity.reason;
    if (!capacity.known()) return result;
    result.volume = capacity.full.volume;
    if (!capacity.levels.empty()) result.deviation = capacity.levels.front().uncertainty();
    return result;
}

}  // namespace ostraka::detail
