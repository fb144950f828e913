// Calls as words of a command line.
#pragma once

#include "ostraka/operations/table.h"

namespace ostraka {

/// The words behind "ostraka" that call an operation with these settings (names of inputs, outputs and options, as Call::set
/// takes them), right or wrong: what is missing is left out, what is unknown becomes a flag. Throws Error (usage) for an unknown
/// operation.
std::vector<std::string> command_words(const std::string& operation, const JsonValue& settings);

}  // namespace ostraka
