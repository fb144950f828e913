// Edits of a set of annotations: change tags, colours, ids and attributes; remove, duplicate, merge, split.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/files/file.h"

namespace ostraka {

/// Identifies an annotation or an attribute by its id, or by its tag or name if that is unique.
struct EntryName {
    std::optional<int> id;
    std::string text;  ///< tag or name, used if there is no id
};

/// One step. Its parts are carried out in the order of the fields.
struct AnnotationEdit {
    EntryName annotation;
    std::vector<EntryName> merge;  ///< annotations of the same type to be merged into this one and removed
    bool duplicate = false;        ///< the copy gets an unused id and follows the original; the fields below apply to the copy
    std::optional<std::string> tag, note;
    std::optional<std::array<int, 3>> colour;
    std::optional<int> id;
    std::vector<Information> information;         ///< each replaces the information of the same kind and value, or is appended
    std::vector<std::string> remove_information;  ///< by their values
    std::vector<EntryName> remove_attributes;
    std::vector<Attribute> attributes;  ///< each replaces the one with its id, or is appended; pins are mesh vertex indices
    std::vector<std::pair<std::string, std::string>>
        texts;           ///< name and text: changes the semantic attribute of that name, or adds it
    bool split = false;  ///< patches of a region, poly-lines of a line or points become separate annotations
    bool remove = false;
};

/// Reads an edit list (doc/schema/annotation-edits.schema.json). Throws Error (input).
std::vector<AnnotationEdit> read_edits(const Path& file);
std::vector<AnnotationEdit> edits_from_json(const JsonValue& document, const std::string& where);

/// Carries out the steps in order; `where` and the number of the step are part of error messages. If a selection changes, the
/// values measured on it are recomputed, or marked stale if that is not possible. The parts of a split are ordered by their
/// smallest element; the first keeps the id, the others get unused ones. Each part keeps all attributes except measures, which
/// stay with the part that contains a pin (the first part if none does). Returns notes on changes beyond those requested.
/// Throws Error (input) for an unknown annotation or attribute, an ambiguous tag, an id in use, incompatible types, or invalid
/// pins.
std::vector<std::string> edit_annotations(const Mesh& mesh, AnnotationSet& set, const std::vector<AnnotationEdit>& edits,
                                          const std::string& where);

/// Changes the name of the unit of length ("": none); no number changes. The units of measures follow, and those of descriptors
/// that are computed from the coordinates or whose unit is derived from the old one ("mm^2", "1/mm").
void rename_unit(const Mesh& mesh, AnnotationSet& set, const std::string& unit);

}  // namespace ostraka
