// Collects results of a study: tables and plots from the reports of its steps, and one page.
#pragma once

#include "ostraka/figures/table.h"
#include "ostraka/workflow/run.h"

namespace ostraka {

/// Checks the tables, plots and the page of a study against the report declarations of its steps. Throws Error (input) with the
/// place and a remedy.
void check_collected(const StudyPlan& plan);

/// A table that keeps the values of its cells, for plots.
struct StudyTable {
    std::string name, title, note;
    std::vector<std::string> columns;
    std::vector<std::vector<Json>> cells;  ///< null: empty cell
    std::vector<int> digits;
    std::vector<bool> percent;

    [[nodiscard]] TextTable text() const;
    [[nodiscard]] std::size_t column(const std::string& title) const;
};

/// Builds the tables from the reports in the run folder; uses instances that are done or unchanged.
std::vector<StudyTable> collect_tables(const StudyPlan& plan, const std::vector<InstanceResult>& results, const Path& folder);

/// Writes NAME.csv, .md and .tex of each table, NAME.svg of each plot that has points, and page.md. `write`: maps a file name
/// to the path to write. Returns the names of the files written.
std::vector<std::string> write_collected(const StudyPlan& plan, const std::vector<InstanceResult>& results, const Path& folder,
                                         const std::function<Path(const std::string&)>& write);

}  // namespace ostraka
