// Where the rows of a study's tables come from.
#pragma once

#include "ostraka/workflow/plan.h"

namespace ostraka {

/// "STEP" or "STEP.TABLE".
struct RowSource {
    std::size_t step = 0;
    std::string table;
};

/// Steps that a quick run leaves out stand in the file all the same.
bool is_left_out(const Study& study, const std::string& step);

/// What "rows" of a table names; `place`: of the table in the file. Throws Error (input) where there is no such step.
std::vector<RowSource> row_sources(const Study& study, const JsonValue& table, const std::string& place);

}  // namespace ostraka
