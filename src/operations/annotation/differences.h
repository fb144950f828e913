// Differences of two sets of annotations in reports.
#pragma once

#include "ostraka/framework/report.h"
#include "ostraka/interchange/difference.h"

namespace ostraka {

/// Declares a table of differences.
void declare_differences(ReportLayout& layout, const std::string& table);
/// Fills the table; without differences, people see the text `none`.
void add_differences(Report& report, const std::string& table, const std::vector<Difference>& changes, const std::string& none);

/// Adds a row for a difference or conflict of an annotation, or of the set as a whole.
template <class Change>
Report::Row named_row(Report& report, const std::string& table, const Change& change) {
    Report::Row row = report.row(table);
    if (change.id) row("id", *change.id)("tag", change.tag);
    else row.shown("id", "set").shown("tag", change.tag);
    return row("field", change.field);
}

}  // namespace ostraka
