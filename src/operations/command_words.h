// Command-line words of a call.
#pragma once

#include "ostraka/operations/table.h"

namespace ostraka {

/// The words after "ostraka" that call `operation` with these settings (names of inputs, outputs and options, as for
/// Call::set). Settings are not checked: missing arguments are omitted, unknown names become flags. Throws Error (usage) for an
/// unknown operation.
std::vector<std::string> command_words(const std::string& operation, const JsonValue& settings);

}  // namespace ostraka
