// Content security policy entries for the scripts and styles embedded in a page.
#pragma once

#include <string>
#include <string_view>

namespace ostraka {

/// "'sha256-...'" for the text of each embedded `element` ("script" or "style") of the page, separated by blanks. A policy with
/// these entries allows the code the page was built with and nothing added later. Data scripts and scripts in external files
/// are left out.
std::string inline_hashes(std::string_view page, std::string_view element);

}  // namespace ostraka
