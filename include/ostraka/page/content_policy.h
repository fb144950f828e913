// Content security policy entries for the scripts and styles embedded in a page.
#pragma once

#include <string>
#include <string_view>

namespace ostraka {

/// Policy entries for the embedded scripts or styles of a page: "'sha256-...'" for the text of each `element` ("script" or
/// "style"), separated by blanks. A policy with these entries allows the code that the page was built with and no code added
/// later. Data scripts and scripts in external files are omitted.
std::string inline_hashes(std::string_view page, std::string_view element);

}  // namespace ostraka
