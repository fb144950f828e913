// Sources of the rows of a study's tables.
#pragma once

#include "ostraka/workflow/plan.h"

namespace ostraka {

/// "STEP" or "STEP.TABLE".
struct RowSource {
    std::size_t step = 0;
    std::string table;
};

/// Whether a quick run omits this step of the file.
bool is_left_out(const Study& study, const std::string& step);

/// Sources named in "rows" of a table; `place`: place of the table in the file. Throws Error (input) if a step does not exist.
std::vector<RowSource> row_sources(const Study& study, const JsonValue& table, const std::string& place);

}  // namespace ostraka
