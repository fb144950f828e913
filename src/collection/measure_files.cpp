#include "ostraka/collection/measure_definitions.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/files/csv.h"
#include "ostraka/files/json_build.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace ostraka {

namespace {

constexpr double no_measure = std::numeric_limits<double>::quiet_NaN();

/// A heading "name [unit]": the measure, and the unit of length if the brackets hold one.
struct Heading {
    MeasureColumn column;
    std::string length_unit;
};

Heading heading_of(const std::string& text) {
    Heading heading;
    const std::size_t open = text.rfind('[');
    if (open == std::string::npos || text.back() != ']') {
        heading.column.name = text;
        return heading;
    }
    heading.column.name = std::string(trimmed(text.substr(0, open)));
    std::string unit(trimmed(text.substr(open + 1, text.size() - open - 2)));
    int power = 1;
    if (const std::size_t caret = unit.find('^'); caret != std::string::npos) {
        if (const auto number = parse_int(unit.substr(caret + 1)); number && *number >= 1 && *number <= 3) {
            power = *number;
            unit.resize(caret);
        }
    }
    static const std::set<std::string> lengths{"mm", "cm", "m", "um", "km", "in", "ft", "unit"};
    if (lengths.contains(lower_case(unit))) {
        heading.column.power = power;
        heading.length_unit = unit == "unit" ? "" : lower_case(unit);
    } else {
        heading.column.power = 0;
        heading.column.unit = unit == "-" ? "" : unit;
    }
    return heading;
}

}  // namespace

Json object_measures_to_json(const ObjectMeasures& measures) {
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    add_members(document, allocator, "unit", measures.unit, "values", measures.values, "powers", measures.powers, "units",
                measures.units, "notes", measures.notes);
    return document;
}

ObjectMeasures object_measures_from_json(const JsonValue& value) {
    ObjectMeasures measures;
    measures.unit = value["unit"].GetString();
    for (const JsonValue& entry : value["values"].GetArray())
        measures.values.push_back(entry.IsNull() ? std::nullopt : std::optional(entry.GetDouble()));
    for (const JsonValue& entry : value["powers"].GetArray()) measures.powers.push_back(entry.GetInt());
    for (const JsonValue& entry : value["units"].GetArray()) measures.units.emplace_back(entry.GetString());
    for (const JsonValue& entry : value["notes"].GetArray()) measures.notes.emplace_back(entry.GetString());
    return measures;
}

MeasureTable measure_table(const std::vector<std::string>& names, const std::vector<std::optional<ObjectMeasures>>& objects,
                           const MeasureDefinitions& definitions, std::vector<std::string>& notes) {
    MeasureTable table;
    std::vector<const ObjectMeasures*> rows;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (!objects[i]) continue;
        table.objects.push_back(names[i]);
        table.units.push_back(objects[i]->unit);
        rows.push_back(&*objects[i]);
    }
    table.values.setConstant(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(definitions.measures.size()),
                             no_measure);
    for (std::size_t j = 0; j < definitions.measures.size(); ++j) {
        std::map<std::pair<int, std::string>, std::size_t> kinds;
        for (const ObjectMeasures* row : rows)
            if (row->values[j]) ++kinds[{row->powers[j], row->units[j]}];
        std::pair<int, std::string> kind{1, ""};
        std::size_t maximum = 0;
        for (const auto& [key, count] : kinds)
            if (count > maximum) kind = key, maximum = count;
        table.measures.push_back({definitions.measures[j].name, kind.first, kind.second});
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (!rows[i]->values[j]) continue;
            if (std::pair(rows[i]->powers[j], rows[i]->units[j]) == kind)
                table.values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = *rows[i]->values[j];
            else
                notes.push_back(fmt::format("'{}' of '{}' has a different unit from most objects and is left out",
                                            definitions.measures[j].name, table.objects[i]));
        }
    }
    return table;
}

std::vector<ObjectResult> take_measures(const Collection& collection, const MeasureDefinitions& definitions,
                                        const ResultStore& store, const TagMatcher* words, const std::string& words_checksum) {
    std::vector<std::string> key_parts{"measures", definitions.text};
    if (words != nullptr) key_parts.push_back("words " + words_checksum);
    return for_each_object(collection, store, key_parts, [&](const CollectionObject& object) {
        return object_measures_to_json(take_measures(object, definitions, words));
    });
}

MeasureTable measure_table(const Collection& collection, const std::vector<ObjectResult>& results,
                           const MeasureDefinitions& definitions, std::vector<std::string>& notes, const std::string& where) {
    std::vector<std::string> names, order;
    std::vector<std::optional<ObjectMeasures>> objects;
    std::map<std::string, std::vector<std::string>> reported;  // note -> objects
    for (std::size_t i = 0; i < results.size(); ++i) {
        names.push_back(collection.objects[i].name);
        objects.emplace_back();
        if (!results[i].problem.empty()) continue;
        objects.back() = object_measures_from_json(results[i].result);
        for (const auto& note : objects.back()->notes) {
            if (reported[note].empty()) order.push_back(note);
            reported[note].push_back(names.back());
        }
    }
    for (const auto& note : order) {
        const auto& object_names = reported[note];
        notes.push_back(fmt::format("{}{}: {}", object_names.front(),
                                    object_names.size() == 1 ? "" : fmt::format(" and {} more", object_names.size() - 1), note));
    }
    if (std::none_of(results.begin(), results.end(), [](const ObjectResult& result) { return result.problem.empty(); }))
        fail_input(where, "no object could be measured", "the first error: " + results.front().problem);
    return measure_table(names, objects, definitions, notes);
}

MeasureTable read_measure_table(const Path& file) {
    const std::string text = read_file(file);
    const auto rows = csv_rows(text, csv_separator(text), file.string());
    if (rows.size() < 2) fail_input(file.string(), "the table has no rows", "give one line of headings and one line per object");
    MeasureTable table;
    std::vector<std::size_t> columns;
    std::optional<std::size_t> unit_column;
    std::string unit;
    const auto& headings = rows.front().cells;
    std::set<std::string> measure_names;
    for (std::size_t c = 1; c < headings.size(); ++c) {
        const std::string name(trimmed(unescape_formula(headings[c])));
        const std::string at = fmt::format("{}, line {}", file.string(), rows.front().line);
        if (name == "unit") {
            unit_column = c;
            continue;
        }
        if (name.empty()) fail_input(at, fmt::format("column {} has no heading", c + 1), "give the name of its measure");
        if (number_of(name))
            fail_input(at, fmt::format("the first line contains the number {} instead of the name of a measure", name),
                       "write a line of headings first: 'name', then the name of each measure");
        const Heading heading = heading_of(name);
        if (!measure_names.insert(heading.column.name).second)
            fail_input(at, fmt::format("the measure '{}' has two columns", heading.column.name),
                       "give each measure its own name");
        if (heading.column.power != 0 && !heading.length_unit.empty()) {
            if (!unit.empty() && unit != heading.length_unit)
                fail_input(at, fmt::format("the headings give lengths in both {} and {}", unit, heading.length_unit),
                           "use one unit, or add a column 'unit'");
            unit = heading.length_unit;
        }
        table.measures.push_back(heading.column);
        columns.push_back(c);
    }
    if (columns.empty())
        fail_input(file.string(), "the table has no column with a measure",
                   "put names in the first column and measures in the others");
    table.values.resize(static_cast<Eigen::Index>(rows.size() - 1), static_cast<Eigen::Index>(columns.size()));
    std::set<std::string> names;
    for (std::size_t r = 1; r < rows.size(); ++r) {
        const std::string at = fmt::format("{}, line {}", file.string(), rows[r].line);
        if (rows[r].cells.size() != headings.size())
            fail_input(at, fmt::format("there are {} cells for {} headings", rows[r].cells.size(), headings.size()),
                       "check the line for a missing separator");
        const std::string name = unescape_formula(rows[r].cells[0]);
        if (!names.insert(name).second)
            fail_input(at, fmt::format("the object '{}' occurs twice", name), "give one line per object");
        table.objects.push_back(name);
        table.units.push_back(unit_column ? std::string(trimmed(rows[r].cells[*unit_column])) : unit);
        for (std::size_t c = 0; c < columns.size(); ++c) {
            const std::string cell(trimmed(rows[r].cells[columns[c]]));
            std::optional<double> value;
            if (cell.empty() || cell == "-") value = no_measure;
            else value = number_of(cell);
            if (!value) {
                std::string with_decimal_point = cell;
                std::replace(with_decimal_point.begin(), with_decimal_point.end(), ',', '.');
                fail_input(at, fmt::format("'{}' under '{}' is not a number", cell, headings[columns[c]]),
                           with_decimal_point != cell && number_of(with_decimal_point)
                               ? "use a decimal point: " + with_decimal_point
                               : "leave the cell empty if the measure is missing");
            }
            table.values(static_cast<Eigen::Index>(r - 1), static_cast<Eigen::Index>(c)) = *value;
        }
    }
    return table;
}

std::string measure_table_to_csv(const MeasureTable& table) {
    std::vector<std::string> headings{"name", "unit"};
    for (const MeasureColumn& column : table.measures) {
        const std::string power = column.power == 1 ? "" : "^" + std::to_string(column.power);
        headings.push_back(column.name + (column.power == 0 ? fmt::format(" [{}]", column.unit.empty() ? "-" : column.unit)
                                                            : fmt::format(" [unit{}]", power)));
    }
    std::string text = csv_row(headings);
    for (std::size_t i = 0; i < table.objects.size(); ++i) {
        std::vector<std::string> cells{table.objects[i], table.units[i]};
        for (std::size_t j = 0; j < table.measures.size(); ++j) {
            const double value = table.values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
            cells.push_back(std::isnan(value) ? "" : digits(value));
        }
        text += csv_row(cells);
    }
    return text;
}

}  // namespace ostraka
