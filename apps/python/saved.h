// Objects as bytes and back: what Python pickles.
#pragma once

#include "objects.h"

namespace ostraka::python {

/// All that the object is: its type, name and checksum, its numbers to the bit, and what its file would hold. Throws Error
/// (usage) for an object that is none of the toolkit's types.
std::string state_of(const Held& held);

/// The object again: with the same arrays, writing the same bytes. Throws Error (input) for bytes that are damaged, of another
/// version, or no object.
Held held_of(const std::string& state);

}  // namespace ostraka::python
