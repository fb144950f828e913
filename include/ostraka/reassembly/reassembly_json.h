// Reassemblies and pair results as JSON.
#pragma once

#include "ostraka/files/json.h"
#include "ostraka/reassembly/reassembly.h"

namespace ostraka {

/// JSON of the result of a pair; `pair_result_from_json` restores the result bit by bit.
JsonValue pair_result_to_json(const PairResult& pair, JsonAllocator& allocator);
/// Reads the result of the pair of fragments `first` and `second`. Throws Error (input) for any other JSON.
PairResult pair_result_from_json(const JsonValue& value, std::size_t first, std::size_t second);

/// SHA-256 of a fragment's mesh and facets. The result of a pair depends only on these data of both fragments and on the
/// options.
std::string fragment_checksum(const Fragment& fragment);

/// JSON of a reassembly (members of doc/schema/reassembly.schema.json): groups, joins, rejected joins. `names`: names of the
/// fragments.
JsonValue reassembly_to_json(const Reassembly& result, const std::vector<std::string>& names, JsonAllocator& allocator);

}  // namespace ostraka
