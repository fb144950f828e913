// The file behind an input of an operation.
#pragma once

#include "ostraka/framework/objects.h"

namespace ostraka {

/// The path of the i-th file of a slot; an object in memory is first written to an in-memory file.
Path path_of(const Slot& slot, std::size_t i);

}  // namespace ostraka
