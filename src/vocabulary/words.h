// Texts and numbers of rules and vocabularies, as messages show them.
#pragma once

#include "ostraka/core/json.h"
#include "ostraka/core/text.h"

#include <string>

namespace ostraka::detail {

inline std::string text_of(const JsonValue& value) { return {value.GetString(), value.GetStringLength()}; }

inline std::string text_of(double value) { return digits(value, 9); }

inline std::string in_quotes(const std::string& text) { return "'" + text + "'"; }

}  // namespace ostraka::detail
