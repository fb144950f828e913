#include "page/viewer.h"

#include "ostraka/core/error.h"
#include "ostraka/files/base64.h"
#include "ostraka/files/file.h"
#include "ostraka/page/content_policy.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>

// The built page (web/README.md), embedded as data.
asm(".section .rodata\n"
    ".global ostraka_viewer_begin, ostraka_viewer_end\n"
    "ostraka_viewer_begin:\n"
    ".incbin \"" OSTRAKA_VIEWER
    "\"\n"
    "ostraka_viewer_end:\n"
    ".byte 0\n"
    ".section .note.GNU-stack,\"\",@progbits\n"
    ".text\n");

extern "C" {
extern const char ostraka_viewer_begin[];
extern const char ostraka_viewer_end[];
}

namespace ostraka {

namespace {

std::string_view built_page() {
    return {ostraka_viewer_begin, static_cast<std::size_t>(ostraka_viewer_end - ostraka_viewer_begin)};
}

std::string bytes_of_hexadecimal(const std::string& digits) {
    std::string bytes;
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
        bytes += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
    return bytes;
}

/// Whether a browser executes a script with these attributes.
bool runs(std::string_view attributes) {
    if (attributes.find(" src=") != std::string_view::npos) return false;
    return attributes.find("type=") == std::string_view::npos || attributes.find("type=\"module\"") != std::string_view::npos;
}

/// The allowed sources before those of the data; they depend only on `allow_self`.
std::string sources(std::string_view element, bool allow_self) {
    return (allow_self ? "'self' " : "") + inline_hashes(built_page(), element) + " ";
}

}  // namespace

std::string inline_hashes(std::string_view page, std::string_view element) {
    const std::string begin = "<" + std::string(element), end = "</" + std::string(element);
    std::string hashes;
    for (std::size_t at = page.find(begin); at != std::string_view::npos; at = page.find(begin, at)) {
        const std::size_t text = std::min(page.find('>', at), page.size() - 1) + 1;
        const std::size_t stop = std::min(page.find(end, text), page.size());
        if (element != "script" || runs(page.substr(at, text - at)))
            hashes += (hashes.empty() ? "'sha256-" : " 'sha256-") +
                      to_base64(bytes_of_hexadecimal(sha256(page.substr(text, stop - text)))) + "'";
        at = stop;
    }
    return hashes;
}

std::string viewer_with(const std::string& data, const std::string& bytes, bool allow_self) {
    static const std::string cached_sources[] = {sources("script", false), sources("script", true), sources("style", false)};
    // Adds the sources of scripts, styles and pictures to the policy.
    constexpr std::string_view scripts = "script-src ", styles = "style-src ", pictures = "img-src ";
    struct Place {
        std::string_view placeholder;
        std::string_view kept, text;
    };
    const Place places[] = {{scripts, scripts, cached_sources[allow_self ? 1 : 0]},
                            {styles, styles, cached_sources[2]},
                            {pictures, pictures, allow_self ? "'self' " : ""},
                            {"@OSTRAKA-DATA@", "", data},
                            {"@OSTRAKA-BYTES@", "", bytes}};
    const std::string_view page = built_page();
    std::string html;
    html.reserve(page.size() + data.size() + bytes.size() + 1000);
    std::size_t at = 0;
    for (const auto& [placeholder, kept, text] : places) {
        const std::size_t place = page.find(placeholder, at);
        if (place == std::string_view::npos || page.find(placeholder, place + placeholder.size()) != std::string_view::npos)
            fail_work("the viewer", fmt::format("does not contain exactly one placeholder '{}'", placeholder),
                      "build it again (web/README.md)");
        html += page.substr(at, place - at);
        html += kept;
        html += text;
        at = place + placeholder.size();
    }
    html += page.substr(at);
    return html;
}

}  // namespace ostraka
