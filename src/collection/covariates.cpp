#include "ostraka/collection/covariates.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/files/csv.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

namespace ostraka {

namespace {

bool is_unknown(const std::string& cell) {
    const std::string lower = lower_case(cell);
    return lower.empty() || lower == "na" || lower == "nan";
}

}  // namespace

CovariateTable read_covariates(const Path& file) {
    const std::string text = read_file(file), where = file.string();
    const auto rows = csv_rows(text, csv_separator(text), where);
    if (rows.size() < 2)
        fail_input(where, "contains no specimens", "write one row with the column names, then one row per specimen");
    const auto clean = [](const std::string& cell) { return unescape_formula(std::string(trimmed(cell))); };
    CovariateTable table;
    table.where = where;
    for (std::size_t c = 1; c < rows.front().cells.size(); ++c) table.columns.push_back(clean(rows.front().cells[c]));
    if (table.columns.empty()) fail_input(where, "has one column", "give the name of each specimen, then its values");
    for (std::size_t r = 1; r < rows.size(); ++r) {
        const std::string at = fmt::format("{}, line {}", where, rows[r].line);
        if (rows[r].cells.size() != rows.front().cells.size())
            fail_input(at, fmt::format("has {} cells, the first row {}", rows[r].cells.size(), rows.front().cells.size()),
                       "give every row one cell for each column");
        const std::string name = clean(rows[r].cells.front());
        if (std::find(table.specimens.begin(), table.specimens.end(), name) != table.specimens.end())
            fail_input(at, fmt::format("the specimen '{}' has two rows", printable(name, 60)), "remove one of them");
        table.specimens.push_back(name);
        auto& cells = table.cells.emplace_back();
        for (std::size_t c = 1; c < rows[r].cells.size(); ++c) cells.push_back(clean(rows[r].cells[c]));
    }
    return table;
}

const ModelVariable& SpecimenVariables::named(const std::string& name) const {
    for (const ModelVariable& variable : variables)
        if (variable.name == name) return variable;
    fail_usage(fmt::format("there is no variable '{}'", printable(name, 60)),
               "use one of: " + joined(variables, ", ", &ModelVariable::name));
}

SpecimenVariables variables_of(const CovariateTable& table, const std::vector<std::string>& specimens,
                               const std::vector<std::string>& needed, const std::vector<std::string>& factors) {
    std::vector<std::size_t> columns;
    for (const std::string& name : needed.empty() ? table.columns : needed) {
        const auto place = std::find(table.columns.begin(), table.columns.end(), name);
        if (place == table.columns.end())
            fail_usage(fmt::format("{} has no column '{}'", table.where, printable(name, 60)),
                       "use one of: " + joined(table.columns));
        columns.push_back(static_cast<std::size_t>(place - table.columns.begin()));
    }
    std::map<std::string, std::size_t> row_of;
    for (std::size_t r = 0; r < table.specimens.size(); ++r) row_of.emplace(table.specimens[r], r);
    SpecimenVariables result;
    std::vector<std::size_t> rows;
    for (std::size_t s = 0; s < specimens.size(); ++s) {
        const auto row = row_of.find(specimens[s]);
        if (row == row_of.end()) {
            result.left_out.emplace_back(specimens[s], "has no row in " + table.where);
            continue;
        }
        const auto unknown =
            std::find_if(columns.begin(), columns.end(), [&](std::size_t c) { return is_unknown(table.cells[row->second][c]); });
        if (unknown != columns.end()) {
            result.left_out.emplace_back(specimens[s], fmt::format("its '{}' is unknown", table.columns[*unknown]));
            continue;
        }
        result.kept.push_back(s);
        rows.push_back(row->second);
    }
    if (rows.empty())
        fail_input(table.where, "has no complete row for any specimen",
                   fmt::format("name specimens as the landmark files do, such as '{}'",
                               specimens.empty() ? std::string() : printable(specimens.front(), 60)));
    for (const std::size_t c : columns) {
        ModelVariable variable;
        variable.name = table.columns[c];
        for (const std::size_t r : rows) variable.labels.push_back(table.cells[r][c]);
        const bool numeric = std::all_of(variable.labels.begin(), variable.labels.end(),
                                         [](const std::string& cell) { return number_of(cell).has_value(); });
        variable.factor = !numeric || std::find(factors.begin(), factors.end(), variable.name) != factors.end();
        if (numeric)
            for (const std::string& cell : variable.labels) variable.values.push_back(*number_of(cell));
        result.variables.push_back(std::move(variable));
    }
    return result;
}

}  // namespace ostraka
