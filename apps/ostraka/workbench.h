#pragma once

#include <string>
#include <vector>

namespace ostraka::app {

inline constexpr const char* workbench_help =
    "open the workbench in the browser: select, annotate, measure, relate, deform, and save, without a command";

/// 'ostraka workbench' with these words behind it; returns the exit code.
int run_workbench(const std::vector<std::string>& words);

}  // namespace ostraka::app
