// What a study shows: tables and plots over the reports of its steps, and one page.
#pragma once

#include "ostraka/report/table.h"
#include "ostraka/workflow/run.h"

namespace ostraka {

/// Checks the tables, plots and the page of a study against the reports that its steps declare. Throws Error (input) with the
/// place and a remedy.
void check_collected(const StudyPlan& plan);

/// A table with the values of its cells, for plots.
struct StudyTable {
    std::string name, title, note;
    std::vector<std::string> columns;
    std::vector<std::vector<Json>> cells;  ///< null: nothing there
    std::vector<int> digits;
    std::vector<bool> percent;

    [[nodiscard]] TextTable text() const;
    [[nodiscard]] std::size_t column(const std::string& title) const;
};

/// The tables, from the reports in the run folder of what is done or unchanged.
std::vector<StudyTable> collect_tables(const StudyPlan& plan, const std::vector<InstanceResult>& results, const Path& folder);

/// Writes NAME.csv, .md and .tex of each table, NAME.svg of each plot that has points, and page.md. `write`: where a file goes.
/// Returns the names of what was written.
std::vector<std::string> write_collected(const StudyPlan& plan, const std::vector<InstanceResult>& results, const Path& folder,
                                         const std::function<Path(const std::string&)>& write);

}  // namespace ostraka
