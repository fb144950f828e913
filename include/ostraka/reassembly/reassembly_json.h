// Reassemblies and pair results as JSON.
#pragma once

#include "ostraka/files/json.h"
#include "ostraka/reassembly/reassembly.h"

namespace ostraka {

/// The result of a pair, exact to the bit; `pair_result_from_json` reads it. Throws Error (input) for any other JSON.
JsonValue pair_result_to_json(const PairResult& pair, JsonAllocator& allocator);
PairResult pair_result_from_json(const JsonValue& value, std::size_t first, std::size_t second);

/// SHA-256 of the mesh and its facets: all that a pair result depends on besides the options.
std::string fragment_checksum(const Fragment& fragment);

/// Members of doc/schema/reassembly.schema.json: groups, joins, rejected joins; `names` of the fragments.
JsonValue reassembly_to_json(const Reassembly& result, const std::vector<std::string>& names, JsonAllocator& allocator);

}  // namespace ostraka
