// What a content policy says of the scripts and styles that stand in a page itself.
#pragma once

#include <string>
#include <string_view>

namespace ostraka {

/// "'sha256-...'" for each `element` ("script" or "style") whose text stands in the page, separated by blanks: a policy that
/// lists these runs what the page was built with, and nothing that came into it later. Scripts that are data and those in files
/// of their own are left out.
std::string inline_hashes(std::string_view page, std::string_view element);

}  // namespace ostraka
