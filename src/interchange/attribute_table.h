// Export and import of all attributes of a set as one CSV table.
#pragma once

#include "ostraka/annotation/annotation.h"

namespace ostraka {

/// All attributes of a set as a CSV table: one row per attribute, and one row for each annotation without attributes; UTF-8,
/// separated by commas (RFC 4180). Columns: annotation, tag, type, colour, attribute, name, kind, value, unit, note, tool,
/// points, direction, locations, file, stale, geodesic, repeats, uncertainty, origin, sha256. Lists occupy one cell, separated by
/// blanks; repeated pickings are separated by |. Text that a spreadsheet would read as a formula gets an apostrophe in front;
/// reading removes the apostrophe.
std::string attribute_table(const AnnotationSet& set);

/// True if the first row is the header of an attribute table.
bool is_attribute_table(const std::string& bytes);

/// Applies an attribute table to the set from which the table was exported: the tag, colour and attributes of each annotation in
/// the table are replaced; other annotations are unchanged. Selections of annotations never change. Returns the number of changed
/// annotations. Throws Error (input) with line and column for an annotation that is not in the set, a different type, or an
/// invalid cell.
std::size_t apply_attribute_table(const std::string& bytes, AnnotationSet& set, const std::string& where);

}  // namespace ostraka
