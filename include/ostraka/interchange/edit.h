// Edits of a set of annotations: tags, colours, ids, attributes; remove, duplicate, merge, split.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/file.h"

namespace ostraka {

/// An annotation or an attribute by its id, or by its tag or name where no other has it.
struct EntryName {
    std::optional<int> id;
    std::string text;  ///< used where there is no id
};

/// One step. What it asks for is done in the order of the fields here.
struct AnnotationEdit {
    EntryName annotation;
    std::vector<EntryName> merge;  ///< annotations of the same type that become part of this one and vanish
    bool duplicate = false;        ///< the copy gets a free id and comes after the original; what follows is done to the copy
    std::optional<std::string> tag, note;
    std::optional<std::array<int, 3>> colour;
    std::optional<int> id;
    std::vector<Information> information;         ///< each replaces the one of its kind and value, or comes last
    std::vector<std::string> remove_information;  ///< by their values
    std::vector<EntryName> remove_attributes;
    std::vector<Attribute> attributes;  ///< each replaces the one with its id, or comes last; its pins are indices of the mesh
    std::vector<std::pair<std::string, std::string>>
        texts;           ///< name and text: changes the semantic attribute of that name, or adds one
    bool split = false;  ///< the patches of a region, poly-lines of a line, points become annotations of their own
    bool remove = false;
};

/// Reads an edit list (doc/schema/annotation-edits.schema.json). Throws Error (input).
std::vector<AnnotationEdit> read_edits(const Path& file);
std::vector<AnnotationEdit> edits_from_json(const JsonValue& document, const std::string& where);

/// Takes the steps in turn; `where` and the number of the step stand in errors. Where a selection changes, the values measured on
/// it are computed anew, and marked stale where that cannot be. Parts of a split come in the order of their smallest element; the
/// first keeps the id, the others get free ones; each has all attributes but measures, which stay with the part that holds a pin
/// (the first if none does). Returns notes on what was done beyond the words of an edit. Throws Error (input): no such annotation
/// or attribute, a tag that several have, an id that is taken, types that do not go together, pins that do not fit.
std::vector<std::string> edit_annotations(const Mesh& mesh, AnnotationSet& set, const std::vector<AnnotationEdit>& edits,
                                          const std::string& where);

/// Calls the unit of length another ("": none); no number changes. The units of measures, and of descriptors that are computed
/// from the coordinates or whose unit is made of the old one ("mm^2", "1/mm"), follow.
void rename_unit(const Mesh& mesh, AnnotationSet& set, const std::string& unit);

}  // namespace ostraka
