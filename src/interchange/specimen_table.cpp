// Tables of landmarks of several specimens: one row per landmark, or one row per specimen.
#include "interchange/landmark_formats.h"
#include "interchange/specimen_formats.h"
#include "interchange/text.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

namespace ostraka::interchange {

namespace {

std::string cell_of(const CsvRow& row, std::size_t column) {
    return column < row.cells.size() ? as_utf8(unescape_formula(std::string(trimmed(row.cells[column])))) : std::string();
}

/// The column of one coordinate in a table with one row per specimen.
struct CoordinateColumn {
    std::string landmark;
    std::size_t axis = 0;
};

/// "X1", "x_1", "1.X", "nasion.x", "nasion x": the landmark and the axis; none for other names.
std::optional<CoordinateColumn> coordinate_column(const std::string& heading) {
    const std::string name(trimmed(heading)), lower = lower_case(name);
    if (name.size() < 2) return {};
    const auto axis_of = [](char c) -> std::optional<std::size_t> {
        if (c < 'x' || c > 'z') return {};
        return static_cast<std::size_t>(c - 'x');
    };
    const auto is_separator = [](char c) { return c == '.' || c == '_' || c == ' ' || c == '-'; };
    const auto is_number = [](const std::string& text) {
        return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
    };
    if (const auto axis = axis_of(lower.front())) {
        std::string rest = name.substr(1);
        if (is_separator(rest.front())) rest.erase(0, 1);
        if (is_number(rest)) return CoordinateColumn{rest, *axis};
    }
    if (const auto axis = axis_of(lower.back())) {
        std::string rest = name.substr(0, name.size() - 1);
        if (is_number(rest)) return CoordinateColumn{rest, *axis};
        if (rest.size() > 1 && is_separator(rest.back())) return CoordinateColumn{rest.substr(0, rest.size() - 1), *axis};
    }
    return {};
}

LandmarkSpecimens one_row_per_specimen(const std::vector<CsvRow>& rows, const std::string& where) {
    const CsvRow& header = rows.front();
    std::vector<std::string> landmarks;
    std::map<std::string, std::array<std::size_t, 3>> columns;  // column of each axis plus one; 0: absent
    std::vector<std::size_t> others;
    bool spatial = false;
    for (std::size_t c = 0; c < header.cells.size(); ++c) {
        const auto coordinate = coordinate_column(cell_of(header, c));
        if (!coordinate) {
            others.push_back(c);
            continue;
        }
        const auto [entry, is_new] = columns.try_emplace(coordinate->landmark);
        if (is_new) landmarks.push_back(coordinate->landmark);
        entry->second.at(coordinate->axis) = c + 1;
        spatial = spatial || coordinate->axis == 2;
    }
    LandmarkSpecimens result;
    result.dimension = spatial ? 3 : 2;
    for (const std::string& landmark : landmarks)
        for (std::size_t axis = 0; axis < static_cast<std::size_t>(result.dimension); ++axis)
            if (columns[landmark].at(axis) == 0)
                fail_input(fmt::format("{}, line {}", where, header.line),
                           fmt::format("landmark '{}' has no column for {}", one_line(landmark), "xyz"[axis]),
                           "name the columns X1, Y1, Z1, X2 ... or 1.X, 1.Y, 1.Z, 2.X ...");
    for (std::size_t r = 1; r < rows.size(); ++r) {
        LandmarkSpecimen& specimen = result.specimens.emplace_back();
        if (!others.empty()) specimen.name = cell_of(rows[r], others.front());
        for (std::size_t k = 1; k < others.size(); ++k)
            specimen.properties[cell_of(header, others[k])] = cell_of(rows[r], others[k]);
        specimen.landmarks = landmarks;
        for (const std::string& landmark : landmarks) {
            std::vector<std::string> cells;
            for (std::size_t axis = 0; axis < static_cast<std::size_t>(result.dimension); ++axis)
                cells.push_back(cell_of(rows[r], columns[landmark].at(axis) - 1));
            specimen.positions.push_back(
                point_of_words({cells.begin(), cells.end()}, fmt::format("{}, line {}", where, rows[r].line)));
        }
    }
    return result;
}

constexpr std::size_t no_column = static_cast<std::size_t>(-1);

std::size_t column_named(const CsvRow& header, std::initializer_list<const char*> names) {
    for (const char* name : names)
        for (std::size_t c = 0; c < header.cells.size(); ++c)
            if (lower_case(cell_of(header, c)) == name) return c;
    return no_column;
}

LandmarkSpecimens one_row_per_landmark(const std::vector<CsvRow>& rows, const std::string& where) {
    const CsvRow& header = rows.front();
    const std::size_t specimen_column = column_named(header, {"specimen", "individual", "object", "file", "image"}),
                      name_column = column_named(header, {"landmark", "name", "label", "point", "tag"}),
                      z = column_named(header, {"z"});
    std::vector<std::size_t> axes{column_named(header, {"x"}), column_named(header, {"y"})};
    if (z != no_column) axes.push_back(z);
    LandmarkSpecimens result;
    result.dimension = static_cast<int>(axes.size());
    std::map<std::string, std::size_t> index;
    for (std::size_t r = 1; r < rows.size(); ++r) {
        const std::string name = specimen_column == no_column ? std::string() : cell_of(rows[r], specimen_column);
        const auto [entry, is_new] = index.try_emplace(name, result.specimens.size());
        if (is_new) result.specimens.emplace_back().name = name;
        LandmarkSpecimen& specimen = result.specimens[entry->second];
        std::vector<std::string> cells;
        for (const std::size_t axis : axes) cells.push_back(cell_of(rows[r], axis));
        const std::string location = fmt::format("{}, line {}", where, rows[r].line);
        const std::string landmark =
            name_column == no_column ? std::to_string(specimen.positions.size() + 1) : cell_of(rows[r], name_column);
        specimen.landmarks.push_back(landmark);
        specimen.positions.push_back(point_of_words({cells.begin(), cells.end()}, location));
    }
    return result;
}

}  // namespace

LandmarkSpecimens read_specimen_table(const std::string& bytes, const std::string& where) {
    const std::vector<CsvRow> rows = csv_rows(bytes, csv_separator(bytes), where);
    if (rows.empty()) fail_input(where, "contains no rows", "give a table of landmarks");
    std::size_t coordinates = 0;
    for (std::size_t c = 0; c < rows.front().cells.size(); ++c)
        coordinates += coordinate_column(cell_of(rows.front(), c)) ? 1 : 0;
    if (coordinates >= 4) return one_row_per_specimen(rows, where);
    const bool planar = column_named(rows.front(), {"z"}) == no_column,
               with_specimens = column_named(rows.front(), {"specimen", "individual", "object", "file", "image"}) != no_column;
    if (column_named(rows.front(), {"x"}) != no_column && column_named(rows.front(), {"y"}) != no_column &&
        (planar || with_specimens || column_named(rows.front(), {"defined"}) == no_column))
        return one_row_per_landmark(rows, where);
    // Tables of one specimen in other forms: without a header, or with the axes of an anatomical space.
    return one_specimen(read_landmark_table(bytes, where, {}));
}

}  // namespace ostraka::interchange
