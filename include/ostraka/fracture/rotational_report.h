// Rotations decided by breaks, in the assembly.
#pragma once

#include "ostraka/core/json.h"
#include "ostraka/fracture/rotational_matching.h"

namespace ostraka {

/// "joints" of an assembly.
JsonValue joints_to_json(const RotationMatch& rotations, const std::vector<std::string>& names, JsonAllocator& allocator);
/// "turn" of a fragment.
JsonValue rotation_to_json(const RotationMatch& rotations, std::size_t fragment, const std::vector<std::string>& names,
                           JsonAllocator& allocator);

}  // namespace ostraka
