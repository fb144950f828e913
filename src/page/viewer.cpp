#include "viewer.h"

#include "ostraka/core/error.h"

#include <string_view>

// The built page (web/README.md) as it lies in the project.
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

std::string viewer_with(const std::string& data, const std::string& bytes, bool beside) {
    const std::string_view page(ostraka_viewer_begin, static_cast<std::size_t>(ostraka_viewer_end - ostraka_viewer_begin));
    // What a policy says of scripts and pictures, and what it says where there is a folder beside the page.
    constexpr std::string_view scripts = "script-src ", pictures = "img-src ";
    struct Place {
        std::string_view mark;
        std::string text;
    };
    const std::string allowed = beside ? "'self' " : "";
    const Place places[] = {{scripts, std::string(scripts) + allowed},
                            {pictures, std::string(pictures) + allowed},
                            {"@OSTRAKA-DATA@", data},
                            {"@OSTRAKA-BYTES@", bytes}};
    std::string made;
    made.reserve(page.size() + data.size() + bytes.size());
    std::size_t at = 0;
    for (const auto& [mark, text] : places) {
        const std::size_t place = page.find(mark, at);
        if (place == std::string_view::npos || page.find(mark, place + mark.size()) != std::string_view::npos)
            fail_work("the viewer", "has not one place '" + std::string(mark) + "'", "build it again (web/README.md)");
        made += page.substr(at, place - at);
        made += text;
        at = place + mark.size();
    }
    made += page.substr(at);
    return made;
}

}  // namespace ostraka
