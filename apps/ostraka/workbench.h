#pragma once

#include <string>
#include <vector>

namespace ostraka::app {

inline constexpr const char* workbench_help =
    "open the workbench in the browser: select, annotate, measure, relate, deform, and save, without a command";

/// Runs 'ostraka workbench' with these arguments; returns the exit code.
int run_workbench(const std::vector<std::string>& words);

}  // namespace ostraka::app
