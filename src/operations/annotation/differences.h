// Differences of two sets of annotations in reports.
#pragma once

#include "ostraka/framework/report.h"
#include "ostraka/interchange/difference.h"

namespace ostraka {

/// Declares a table of differences.
void declare_differences(ReportLayout& layout, const std::string& table);
/// Fills the table; without differences, people see the text `none`.
void add_differences(Report& report, const std::string& table, const std::vector<Difference>& changes, const std::string& none);

}  // namespace ostraka
