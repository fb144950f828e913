// Texts of documents.
#pragma once

#include "ostraka/core/json.h"

#include <string>

namespace ostraka {

/// The text in a member; empty where there is none.
inline std::string text_of(const JsonValue& object, const char* member) {
    const JsonValue* value = find_member(object, member);
    return value == nullptr || !value->IsString() ? std::string() : std::string(value->GetString(), value->GetStringLength());
}

}  // namespace ostraka
