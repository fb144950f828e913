// Collects the results of a study: tables and plots from the reports of its steps, and one page.
#pragma once

#include "ostraka/figures/table.h"
#include "ostraka/workflow/run.h"

namespace ostraka {

/// Checks the tables, plots and page that a study requests against the report declarations of its steps. Throws Error (input)
/// with the place in the study file and a remedy.
void check_collected(const StudyPlan& plan);

/// A table of a study; it keeps the values of its cells, for plots.
struct StudyTable {
    std::string name, title, note;         ///< name of the files, title, and remark below the table
    std::vector<std::string> columns;      ///< titles of the columns
    std::vector<std::vector<Json>> cells;  ///< cells of each row; null: empty cell
    std::vector<int> digits;               ///< for each column, number of significant digits
    std::vector<bool> percent;             ///< for each column: true if values are shown in per cent

    /// Converts the cells to texts.
    [[nodiscard]] TextTable text() const;
    /// Index of the column with this title; the number of columns if there is none.
    [[nodiscard]] std::size_t column(const std::string& title) const;
};

/// Builds the tables of a study from the reports in the run folder; only instances with the state done or unchanged are used.
std::vector<StudyTable> collect_tables(const StudyPlan& plan, const std::vector<InstanceResult>& results, const Path& folder);

/// Writes NAME.csv, .md and .tex of each table, NAME.svg of each plot that has points, and page.md. `write`: returns the path to
/// write for a file name. Returns the names of the files written.
std::vector<std::string> write_study_tables(const StudyPlan& plan, const std::vector<InstanceResult>& results, const Path& folder,
                                            const std::function<Path(const std::string&)>& write);

}  // namespace ostraka
