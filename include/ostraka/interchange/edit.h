// Edits of a set of annotations: change tags, colours, ids and attributes; remove, duplicate, merge, split.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/files/file.h"

namespace ostraka {

/// Refers to an annotation or an attribute by its id, or by its tag or name if only one annotation or attribute has it.
struct EntryName {
    std::optional<int> id;  ///< id of the annotation or attribute; none: identified by `text`
    std::string text;       ///< tag of the annotation or name of the attribute; used if there is no id
};

/// One step of an edit list, on one annotation. The parts of a step are carried out in the order of the members.
struct AnnotationEdit {
    EntryName annotation;          ///< the annotation to edit
    std::vector<EntryName> merge;  ///< annotations of the same type that are merged into `annotation` and removed
    /// True: the annotation is copied. The copy gets an unused id and is placed after the original in the set; the following
    /// members apply to the copy.
    bool duplicate = false;
    std::optional<std::string> tag, note;      ///< new tag; new note; none: unchanged
    std::optional<std::array<int, 3>> colour;  ///< new colour; none: unchanged
    std::optional<int> id;                     ///< new id; none: unchanged
    /// Information to add; an entry replaces the information of the same kind and value, if any.
    std::vector<Information> information;
    std::vector<std::string> remove_information;  ///< values of the information to remove
    std::vector<EntryName> remove_attributes;     ///< attributes to remove
    /// Attributes to add; an entry replaces the attribute with the same id, if any; pins are mesh vertex indices.
    std::vector<Attribute> attributes;
    /// (name, text): changes the text of the semantic attribute of this name, or adds the attribute.
    std::vector<std::pair<std::string, std::string>> texts;
    /// True: connected patches of a region, poly-lines of a line, or points become separate annotations.
    bool split = false;
    bool remove = false;  ///< true: the annotation is removed
};

/// Reads an edit list (doc/schema/annotation-edits.schema.json). Throws Error (input).
std::vector<AnnotationEdit> read_edits(const Path& file);
/// Reads an edit list from a JSON document; `where` names the document in error messages.
std::vector<AnnotationEdit> edits_from_json(const JsonValue& document, const std::string& where);

/// Carries out the steps of an edit list in order; `where` and the number of the step are part of error messages. If the
/// selection of an annotation changes, values measured on the annotation are recomputed, or marked stale if recomputing is not
/// possible. The parts of a split are ordered by their smallest element; the first part keeps the id, and the other parts get
/// unused ids. Each part keeps all attributes except measures; a measure goes to the part that contains one of its pins (to the
/// first part if no part does). Returns notes about changes that were not requested by a step. Throws Error (input) for an
/// unknown annotation or attribute, an ambiguous tag, an id in use, incompatible types, or invalid pins.
std::vector<std::string> edit_annotations(const Mesh& mesh, AnnotationSet& set, const std::vector<AnnotationEdit>& edits,
                                          const std::string& where);

/// Changes the name of the unit of length ("": none) without changing any number. The units of measures change too, as do the
/// units of descriptors that are computed from the coordinates or whose unit is derived from the old unit ("mm^2", "1/mm").
void change_length_unit(const Mesh& mesh, AnnotationSet& set, const std::string& unit);

}  // namespace ostraka
