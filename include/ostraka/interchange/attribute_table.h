// All attributes of a set as one CSV table, and back.
#pragma once

#include "ostraka/annotation/annotation.h"

namespace ostraka {

/// A row an attribute, a row an annotation without any; UTF-8, comma separated (RFC 4180). Columns: annotation, tag, type,
/// colour, attribute, name, kind, value, unit, note, tool, points, direction, locations, file, stale, geodesic, repeats,
/// uncertainty, origin. Lists stand in one cell, separated by blanks, pins picked again by |. Text that a spreadsheet would take
/// for a formula gets an apostrophe in front, which reading takes off again.
std::string attribute_table(const AnnotationSet& set);

/// True if the first row is that of an attribute table.
bool is_attribute_table(const std::string& bytes);

/// Puts a table onto the set it was made of: tag, colour and attributes of each annotation that the table names become the
/// table's; the others stay as they are. Selections never change. Returns how many annotations changed. Throws Error (input)
/// naming line and column: an annotation that the set does not have, another type, a cell that does not fit.
std::size_t apply_attribute_table(const std::string& bytes, AnnotationSet& set, const std::string& where);

}  // namespace ostraka
