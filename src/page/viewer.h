// The page without its data.
#pragma once

#include <string>
#include <string_view>

namespace ostraka {

/// web/report.html, built, with the data (JSON, escaped for HTML) and the bytes (base64) in their places, and a content policy
/// that runs the viewer's own script only. Throws Error (failure) where the built page has not each place once. `beside`: the
/// page reads scripts and pictures that lie beside it.
std::string viewer_with(const std::string& data, const std::string& bytes, bool beside);

std::string base64(std::string_view bytes);

}  // namespace ostraka
