// Files of a learnt class: NAME.class.json (doc/schema/class.schema.json), and in the same folder the mean shape and the modes
// of variation as NumPy arrays.
#pragma once

#include "ostraka/shape_classes/classify.h"
#include "ostraka/template_package/template.h"

namespace ostraka {

/// Throws Error (usage) if the class name is not a valid file name. Call this function before the class is learnt.
void check_class_name(const std::string& name);

/// Writes FOLDER/NAME.class.json, NAME.mean.npy (one row per vertex) and, if there are modes, NAME.modes.npy (one row per
/// mode), each atomically; NAME is the name of the class. Throws Error (usage) if the name is not a valid file name.
void write_class(const Path& folder, const ShapeClass& learnt, const Provenance& provenance);

/// Reads a class and the arrays that are stored in the same folder. Throws Error (input), naming file and place, if the schema is
/// violated, an array is missing or has the wrong size, the mean, modes and coefficients are inconsistent, or the archetype (the
/// member closest to the mean) is not in the list of members.
ShapeClass read_class(const Path& file);

/// JSON of a classification (doc/schema/classification.schema.json).
JsonValue classification_to_json(const Classification& classification, JsonAllocator& allocator);

}  // namespace ostraka
