#include "ostraka/workbench/server.h"

// The page as built in the project.
asm(".section .rodata\n"
    ".global ostraka_workbench_begin, ostraka_workbench_end\n"
    "ostraka_workbench_begin:\n"
    ".incbin \"" OSTRAKA_WORKBENCH
    "\"\n"
    "ostraka_workbench_end:\n"
    ".byte 0\n"
    ".section .note.GNU-stack,\"\",@progbits\n"
    ".text\n");

extern "C" {
extern const char ostraka_workbench_begin[];
extern const char ostraka_workbench_end[];
}

namespace ostraka {

std::string_view workbench_page() {
    return {ostraka_workbench_begin, static_cast<std::size_t>(ostraka_workbench_end - ostraka_workbench_begin)};
}

}  // namespace ostraka
