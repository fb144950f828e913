// Inserts the data of a page into the HTML viewer.
#pragma once

#include <string>
#include <string_view>

namespace ostraka {

/// The built web/report.html with the data (JSON, escaped for HTML) and the bytes (base64) inserted, and a content policy that
/// allows only the viewer's own script. Throws Error (failure) unless the built page has each placeholder exactly once.
/// `allow_self`: true if the page loads scripts and pictures from its own folder.
std::string viewer_with(const std::string& data, const std::string& bytes, bool allow_self);

}  // namespace ostraka
