// Edits and constraints of named parts in a few words, as a person gives them on a line (doc/deformation.md).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/json.h"
#include "ostraka/core/options.h"
#include "ostraka/relation/graph.h"

namespace ostraka {

/// Each text names parts and says what is to become of them: "back=1.2", "seat thickness", "legs".
struct EditWords {
    std::vector<std::string> stretch, raise, rotate;  ///< PART=FACTOR, PART=LENGTH, PART=DEGREES, each with ,AXIS behind it
    std::vector<std::string> keep, level;             ///< PART or PART MEASURE; PARTS
    [[nodiscard]] bool is_edit() const { return stretch.size() + raise.size() + rotate.size() > 0; }
    void describe(OptionList& visit);
};

/// The annotations that a word means, in the order of the set: the one of that id; else those of that tag; else those whose tag
/// ends in it as a word, or in it without a plural's "s" ("legs": "front left leg", "leg 2"), regions only where there are any,
/// else lines. With commas between words, those of each.
/// Throws Error (input), naming the nearest tag, where there are none.
std::vector<const Annotation*> parts_named(const AnnotationSet& set, const std::string& words);

/// An edit (the format of doc/schema/edit.schema.json) with a step for each text: its parts together are stretched along the axis
/// from their base, moved by a length along it, or rotated about it through the middle of their handles. The axis is up, x, y, z,
/// -x, -y, -z, by default up. Throws Error (usage) for a text without "=", a number that is none, a stretch that is not positive,
/// an unknown axis and where no direction is up; (input) as parts_named.
Json edit_of(const EditWords& words, const AnnotationSet& set);

/// Adds the measures "height" and "thickness" that the words keep and parts have not: the extent along up.
void take_measures(const EditWords& words, const Mesh& mesh, AnnotationSet& set);

/// Adds constraints: "keep" a measure of the parts as it is at rest, or their shape where no measure is named; "level" parts
/// among each other, by their bases. All are soft, with a weight (1000) far above the surface's. Throws as edit_of.
void add_constraints(const EditWords& words, const AnnotationSet& set, RelationGraph& graph);

}  // namespace ostraka
