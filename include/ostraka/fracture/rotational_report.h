// Turns decided by breaks, in the assembly.
#pragma once

#include "ostraka/core/json.h"
#include "ostraka/fracture/rotational_matching.h"

namespace ostraka {

/// "joints" of an assembly.
JsonValue joints_to_json(const BreakTurns& turns, const std::vector<std::string>& names, JsonAllocator& allocator);
/// "turn" of a fragment.
JsonValue turn_to_json(const BreakTurns& turns, std::size_t fragment, const std::vector<std::string>& names,
                       JsonAllocator& allocator);

}  // namespace ostraka
