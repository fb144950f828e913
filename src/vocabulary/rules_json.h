// JSON form of inference rules, which SKOS files store in one literal.
#pragma once

#include "ostraka/vocabulary/vocabulary.h"

namespace ostraka {

/// Reads inference rules from JSON. The list is checked against the schema, but references to concepts and attributes are not
/// checked.
std::vector<InferenceRule> rules_from_json(const JsonValue& rule_list, const std::string& where);

}  // namespace ostraka
