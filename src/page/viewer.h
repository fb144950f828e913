// The page without its data.
#pragma once

#include <string>

namespace ostraka {

/// web/report.html, built, with the data (JSON, escaped for HTML) and the bytes (base64) in their places. Throws Error (failure)
/// where the built page has not each place once. `beside`: the page reads scripts and pictures that lie beside it.
std::string viewer_with(const std::string& data, const std::string& bytes, bool beside);

}  // namespace ostraka
