// Edits and constraints of named parts as short texts, for the command line (doc/deformation.md).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"
#include "ostraka/relation/graph.h"
#include "ostraka/semantic/edit.h"

namespace ostraka {

/// Each text names parts and an operation on them: "back=1.2", "seat thickness", "legs".
struct EditWords {
    std::vector<std::string> stretch, raise, rotate;  ///< PART=FACTOR, PART=LENGTH, PART=DEGREES, each optionally followed by
                                                      ///< ,AXIS
    std::vector<std::string> keep, level;             ///< PART or PART MEASURE; PARTS
    [[nodiscard]] bool is_edit() const { return stretch.size() + raise.size() + rotate.size() > 0; }
    void list_options(OptionList& list);
};

/// The annotations that a word refers to, in the order of the set: the one with this id; otherwise those with this tag;
/// otherwise those whose tag ends in the word, or in the word without a plural "s" ("legs": "front left leg", "leg 2"): of
/// these only the regions, if any, otherwise only the lines. For words separated by commas, the annotations of each. Throws
/// Error (input), naming the nearest tag, if there are none.
std::vector<const Annotation*> parts_named(const AnnotationSet& set, const std::string& words);

/// An edit with one step per text. The parts of a text are together stretched along the
/// axis from their base, moved along it by a length, or rotated about it through the mean of their handles. The axis is up, x,
/// y, z, -x, -y or -z, by default up. Throws Error (usage) for a text without "=", an invalid number, a stretch that is not
/// positive, an unknown axis, and a missing upward direction; Error (input) as parts_named.
Edit edit_of(const EditWords& words, const AnnotationSet& set);

/// Adds the measures "height" and "thickness" (extent along up) if the words keep them and parts lack them.
void take_measures(const EditWords& words, const Mesh& mesh, AnnotationSet& set);

/// Adds constraints. "keep": a measure of the parts keeps its rest value, or without a measure their shape is kept. "level":
/// the bases of the parts stay on one level. All are soft, with a weight (1000) far above that of the surface. Throws as
/// edit_of.
void add_constraints(const EditWords& words, const AnnotationSet& set, RelationGraph& graph);

}  // namespace ostraka
