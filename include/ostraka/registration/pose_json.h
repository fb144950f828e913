// A rigid motion as JSON: the rows of a 4 x 4 matrix.
#pragma once

#include "ostraka/files/json.h"
#include "ostraka/geom/rigid_fit.h"

namespace ostraka {

/// Writes a pose as the rows of a 4 x 4 matrix.
JsonValue pose_to_json(const Motion& pose, JsonAllocator& allocator);

}  // namespace ostraka
