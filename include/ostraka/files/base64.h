// Bytes as text in base64 (RFC 4648).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace ostraka {

/// The bytes in base64, with padding.
std::string to_base64(std::string_view bytes);
/// The bytes of a text in base64; nullopt if the text has other characters or a wrong length.
std::optional<std::string> from_base64(std::string_view text);

}  // namespace ostraka
