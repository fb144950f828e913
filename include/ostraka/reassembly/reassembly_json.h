// Reassemblies and the pairs they are made of as JSON.
#pragma once

#include "ostraka/core/json.h"
#include "ostraka/reassembly/reassembly.h"

namespace ostraka {

/// What was found of a pair, to the bit; `pair_from_json` gives it back. Throws Error (input) for anything else.
JsonValue pair_of_many_to_json(const PairOfMany& pair, JsonAllocator& allocator);
PairOfMany pair_of_many_from_json(const JsonValue& value, std::size_t first, std::size_t second);

/// What a pair of fragments depends on beside the options: SHA-256 of the mesh and its facets.
std::string fragment_checksum(const Fragment& fragment);

/// Members of doc/schema/reassembly.schema.json: groups, joins, joins undone; `names` of the fragments.
JsonValue reassembly_to_json(const Reassembly& result, const std::vector<std::string>& names, JsonAllocator& allocator);

}  // namespace ostraka
