// Rejects requests of the page.
#pragma once

#include "ostraka/core/error.h"

#include <string>

namespace ostraka::workbench {

[[noreturn]] inline void fail_request(const std::string& what, const std::string& remedy = "load the page again") {
    throw Error(ErrorKind::usage, "the workbench", what, remedy);
}

}  // namespace ostraka::workbench
