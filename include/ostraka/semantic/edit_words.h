// Edits and constraints of named parts as short texts, for the command line (doc/deformation.md).
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"
#include "ostraka/relation/graph.h"
#include "ostraka/semantic/edit.h"

namespace ostraka {

/// Edits and constraints as short texts. Each text names parts and, if needed, a value or a measure: "back=1.2", "seat
/// thickness", "legs".
struct EditWords {
    /// stretch: PART=FACTOR; raise: PART=LENGTH; rotate: PART=DEGREES; each optionally followed by ,AXIS.
    std::vector<std::string> stretch, raise, rotate;
    std::vector<std::string> keep, level;  ///< keep: PART or PART MEASURE; level: PARTS
    /// True if at least one text is an edit and not a constraint.
    [[nodiscard]] bool is_edit() const { return stretch.size() + raise.size() + rotate.size() > 0; }
    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// The annotations that a text refers to, in the order of the set. For one word: the annotation with this id; otherwise the
/// annotations with this tag; otherwise the annotations whose tag ends in the word, or in the word without a plural "s" (for
/// "legs": "front left leg" and "leg 2"); among these only the regions, or if there are no regions only the lines. Words
/// separated by commas refer to the annotations of each word. Throws Error (input), naming the nearest tag, if a word refers to
/// no annotation.
std::vector<const Annotation*> parts_named(const AnnotationSet& set, const std::string& words);

/// An edit with one step for each text. The parts named in one text are treated as one object: it is stretched along the axis
/// from its base, moved along the axis by a length, or rotated about the axis through the mean of its handles. The axis is up,
/// x, y, z, -x, -y or -z, by default up. Throws Error (usage) for a text without "=", an invalid number, a stretch that is not
/// positive, an unknown axis, and a missing upward direction; the errors of parts_named.
Edit parse_edit(const EditWords& words, const AnnotationSet& set);

/// Adds the measures "height" and "thickness" (extent along up) to the parts that lack them, if a text in `keep` names them.
void add_missing_measures(const EditWords& words, const Mesh& mesh, AnnotationSet& set);

/// Adds constraints to the graph. "keep": a measure of the parts keeps its rest value, or without a measure the parts keep their
/// shape. "level": the bases of the parts stay on one level. All constraints are soft, with a weight (1000) far above the weight
/// of the surface. Throws the same errors as edit_of.
void add_constraints(const EditWords& words, const AnnotationSet& set, RelationGraph& graph);

}  // namespace ostraka
