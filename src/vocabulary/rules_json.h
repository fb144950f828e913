// Rules by themselves, as SKOS files hold them in one literal.
#pragma once

#include "ostraka/vocabulary/vocabulary.h"

namespace ostraka {

/// `list` is checked against the schema first; what the rules speak of is not.
std::vector<InferenceRule> rules_from_json(const JsonValue& list, const std::string& where);

}  // namespace ostraka
