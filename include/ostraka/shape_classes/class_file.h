// A learnt class as files: NAME.class.json (doc/schema/class.schema.json), its mean and modes as NumPy arrays beside it.
#pragma once

#include "ostraka/shape_classes/classify.h"
#include "ostraka/template_package/template.h"

namespace ostraka {

/// Throws Error (usage) for a name that no file can have. To be called before any work.
void check_class_name(const std::string& name);

/// Writes FOLDER/NAME.class.json, NAME.mean.npy (a row a vertex) and, where there are modes, NAME.modes.npy (a row a mode), each
/// atomically; `NAME` is the class's. Throws Error (usage) for a name that is no file's name.
void write_class(const Path& folder, const ShapeClass& learnt, const Provenance& provenance);

/// Reads a class; its arrays stand beside it. Throws Error (input) naming file and place: a schema that is not met, an array that
/// is missing or has other sizes, a mean, modes or coefficients that do not go together, an archetype that is no member.
ShapeClass read_class(const Path& file);

/// The report of a classification (doc/schema/classification.schema.json).
JsonValue classification_to_json(const Classification& answer, JsonAllocator& allocator);

}  // namespace ostraka
