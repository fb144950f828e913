// Serialisation of objects for Python pickles.
#pragma once

#include "objects.h"

namespace ostraka::python {

/// Serialises an object completely: type, name, checksum, exact numbers, and the content of its file. Throws Error (usage) for
/// an object of an unsupported type.
std::string state_of(const Held& held);

/// Restores an object with the same arrays, which writes the same files. Throws Error (input) if the bytes are damaged, of
/// another version, or not an object.
Held held_of(const std::string& state);

}  // namespace ostraka::python
