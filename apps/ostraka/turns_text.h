// Turns decided by breaks, in words.
#pragma once

#include "ostraka/fitting/break_turns.h"

namespace ostraka::app {

/// The joints as a table, and the fragments without one.
std::string turns_text(const BreakTurns& turns, const std::vector<std::string>& names);

}  // namespace ostraka::app
