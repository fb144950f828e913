// Command-line interface of the table of operations.
#pragma once

namespace ostraka::app {

/// Exit codes of the tool: 0 done, 1 failed, 2 wrong usage, 3 done but the answer is "no", 130 cancelled.
inline constexpr int done = 0, failed = 1, wrong_usage = 2, answer_is_no = 3, cancelled = 130;

/// Parses the arguments, runs the operation, prints its report. Returns the exit code; throws Error.
int run_command_line(int argc, char** argv);

}  // namespace ostraka::app
