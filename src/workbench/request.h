// Rejects a request of the page.
#pragma once

#include "ostraka/core/error.h"

#include <string>

namespace ostraka::workbench {

/// Throws Error (usage) with the problem and the remedy.
[[noreturn]] inline void fail_request(const std::string& problem, const std::string& remedy = "load the page again") {
    throw Error(ErrorKind::usage, "the workbench", problem, remedy);
}

}  // namespace ostraka::workbench
