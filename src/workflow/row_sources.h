// Sources of the rows of a study's tables.
#pragma once

#include "ostraka/workflow/plan.h"

namespace ostraka {

/// A source of rows, "STEP" or "STEP.TABLE": the reports of a step, or a table in these reports.
struct RowSource {
    std::size_t step = 0;  ///< index of the step
    std::string table;     ///< name of the table in the reports; empty: the report itself
};

/// Whether a quick run omits this step of the study file.
bool is_left_out(const Study& study, const std::string& step);

/// Sources named in the member "rows" of a table; `place`: JSON pointer of the table in the study file. Throws Error (input) if a
/// step does not exist.
std::vector<RowSource> row_sources(const Study& study, const JsonValue& table, const std::string& place);

}  // namespace ostraka
