// Programs that stand beside the command, as steps of studies.
#pragma once

#include "ostraka/core/file.h"

#include <functional>
#include <string>
#include <vector>

namespace ostraka {

/// Runs it in `folder`, with what it prints in FOLDER/output.txt, and returns its exit code (128 + N where signal N ended it). It
/// is told to end (SIGTERM) once `cancelled` says so. Throws Error (failure) where it cannot be started.
int run_program(const Path& program, const std::vector<std::string>& words, const Path& folder, int threads,
                const std::function<bool()>& cancelled);

/// The folder of the program that is running.
Path own_program_folder();

}  // namespace ostraka
