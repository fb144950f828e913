// Landmarks in line-based formats: CSV, tps, fcsv.
#include "interchange/landmark_formats.h"
#include "interchange/specimen_formats.h"
#include "interchange/text.h"

#include "ostraka/core/error.h"
#include "ostraka/files/json_build.h"
#include "ostraka/mesh/limits.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

namespace ostraka::interchange {

namespace {

using std::to_string;

std::string at_line(const std::string& where, std::size_t line) { return fmt::format("{}, line {}", where, line); }

/// Column names as written by common tools.
struct Columns {
    std::array<std::size_t, 3> position{};
    std::optional<std::size_t> name, id, defined;
    std::optional<AnatomicalSpace> space;
};

constexpr std::size_t not_found = static_cast<std::size_t>(-1);

std::optional<Columns> columns_of(const std::vector<std::string>& header) {
    std::map<std::string, std::size_t> column_indices;
    for (std::size_t i = 0; i < header.size(); ++i)
        column_indices.try_emplace(lower_case(trimmed(unescape_formula(header[i]))), i);
    const auto find = [&](std::initializer_list<const char*> names) -> std::size_t {
        for (const char* name : names)
            if (const auto column = column_indices.find(name); column != column_indices.end()) return column->second;
        return not_found;
    };
    Columns columns;
    const auto find_axes = [&](const char* a, const char* b, const char* c, std::optional<AnatomicalSpace> space) {
        columns.position = {find({a}), find({b}), find({c})};
        columns.space = space;
        return std::find(columns.position.begin(), columns.position.end(), not_found) == columns.position.end();
    };
    if (!find_axes("x", "y", "z", {}) && !find_axes("l", "p", "s", AnatomicalSpace::lps) &&
        !find_axes("r", "a", "s", AnatomicalSpace::ras))
        return {};
    if (const std::size_t column = find({"name", "label", "landmark", "tag"}); column != not_found) columns.name = column;
    if (const std::size_t column = find({"id"}); column != not_found) columns.id = column;
    if (const std::size_t column = find({"defined"}); column != not_found) columns.defined = column;
    return columns;
}

double coordinate(const CsvRow& row, std::size_t column, const std::string& where) {
    const std::string location = at_line(where, row.line);
    if (column >= row.cells.size())
        fail_input(location, fmt::format("has {} cells", row.cells.size()), "give a number for x, y and z in each row");
    if (const auto value = number_of(unescape_formula(row.cells[column]))) return *value;
    fail_input(location, fmt::format("'{}' is not a number", one_line(row.cells[column]).substr(0, 40)),
               "give x, y and z with a decimal point");
}

}  // namespace

std::array<double, 3> in_mesh_space(std::array<double, 3> position, std::optional<AnatomicalSpace> file_space,
                                    AnatomicalSpace mesh_space) {
    if (file_space && *file_space != mesh_space)
        for (const std::size_t k : {0U, 1U}) position[k] = position[k] == 0 ? 0 : -position[k];
    return position;
}

void check_position(const std::array<double, 3>& position, const std::string& location) {
    if (!is_place(position[0], position[1], position[2]))
        fail_input(location,
                   fmt::format("the position exceeds the supported range (coordinates up to {})", digits(max_coordinate)),
                   "check its numbers, or choose another unit");
}

LandmarkSet read_landmark_table(const std::string& bytes, const std::string& where, const LandmarkFileOptions& options) {
    std::vector<CsvRow> rows = csv_rows(bytes, csv_separator(bytes), where);
    LandmarkSet set;
    if (rows.empty()) fail_input(where, "contains no rows", "give a table with the columns x, y and z");
    Columns columns;
    std::size_t first = 0;
    if (const auto header_columns = columns_of(rows.front().cells)) {
        columns = *header_columns;
        first = 1;
    } else {  // without a header: three numbers, optionally preceded by a name
        const std::size_t cells = rows.front().cells.size();
        if ((cells != 3 && cells != 4) || !number_of(unescape_formula(rows.front().cells.back())))
            fail_input(at_line(where, rows.front().line), "is not a header with the columns x, y and z",
                       "name the columns, e.g. name,x,y,z");
        columns.position = {cells - 3, cells - 2, cells - 1};
        if (cells == 4) columns.name = 0;
    }
    std::size_t undefined = 0;
    for (std::size_t i = first; i < rows.size(); ++i) {
        const CsvRow& row = rows[i];
        const auto cell = [&](std::optional<std::size_t> column) {
            return column && *column < row.cells.size() ? unescape_formula(row.cells[*column]) : std::string();
        };
        if (columns.defined && trimmed(cell(columns.defined)) == "0") {
            ++undefined;
            continue;
        }
        Landmark landmark;
        landmark.name = columns.name ? as_utf8(cell(columns.name)) : to_string(i - first + 1);
        for (std::size_t k = 0; k < 3; ++k) landmark.position[k] = coordinate(row, columns.position[k], where);
        check_position(landmark.position, at_line(where, row.line));
        landmark.position = in_mesh_space(landmark.position, columns.space, options.mesh_space);
        landmark.group = parse_int(cell(columns.id));
        set.landmarks.push_back(std::move(landmark));
    }
    if (undefined > 0) set.notes.push_back(counted(undefined, "landmark") + " not yet placed in the file, left out");
    return set;
}

std::string write_landmark_table(const LandmarkSet& set) {
    std::string text = "id,name,x,y,z\n";
    for (const Landmark& landmark : set.landmarks)
        text += csv_row({landmark.group ? to_string(*landmark.group) : "", landmark.name, digits(landmark.position[0]),
                         digits(landmark.position[1]), digits(landmark.position[2])});
    return text;
}

namespace {

/// The only specimen, or the one requested by its ID or number.
const TpsSpecimen& chosen_specimen(const std::vector<TpsSpecimen>& specimens, const std::string& requested,
                                   const std::string& where) {
    if (specimens.size() == 1 && requested.empty()) return specimens.front();
    for (const TpsSpecimen& specimen : specimens)
        if (!requested.empty() && specimen.id == requested) return specimen;
    if (const auto index = parse_int(requested); index && *index >= 1 && static_cast<std::size_t>(*index) <= specimens.size())
        return specimens[static_cast<std::size_t>(*index) - 1];
    fail_input(where,
               requested.empty() ? fmt::format("contains {} specimens", specimens.size())
                                 : fmt::format("contains no specimen '{}'", requested),
               "choose one with --specimen, by its ID or its number from 1 to " + to_string(specimens.size()));
}

}  // namespace

// tps (Rohlf).
LandmarkSet read_tps(const std::string& bytes, const std::string& where, const LandmarkFileOptions& options) {
    const std::vector<TpsSpecimen> specimens = tps_specimens(bytes, where);
    const TpsSpecimen& specimen = chosen_specimen(specimens, options.specimen, where);
    if (specimen.dimension != 3)
        fail_input(where, "contains two-dimensional landmarks", "give a file with LM3=; 'study landmarks' reads both");
    const std::vector<std::string> names = tps_names(specimen, where);
    LandmarkSet set;
    std::size_t missing = 0;
    for (std::size_t i = 0; i < specimen.points.size(); ++i) {
        if (!specimen.points[i]) {
            ++missing;
            continue;
        }
        Landmark landmark;
        landmark.name = names.empty() ? to_string(i + 1) : names[i];
        for (std::size_t k = 0; k < 3; ++k) landmark.position[k] = specimen.scale * (*specimen.points[i])[k];
        check_position(landmark.position, at_line(where, specimen.lines[i]));
        set.landmarks.push_back(std::move(landmark));
    }
    if (missing > 0) set.notes.push_back(counted(missing, "missing landmark") + " (NA) left out");
    for (std::size_t c = 0; c < specimen.curves.size(); ++c) {
        LandmarkCurve curve{fmt::format("curve {}", c + 1), false, {}, {}};
        for (const auto& point : specimen.curves[c]) {
            if (!point) continue;
            std::array<double, 3> position = *point;
            for (double& x : position) x *= specimen.scale;
            check_position(position, where);
            curve.points.push_back(position);
        }
        if (curve.points.size() > 1) set.curves.push_back(std::move(curve));
    }
    if (names.empty() && !set.landmarks.empty()) set.notes.emplace_back("tps stores no landmark names; they are numbered");
    return set;
}

std::string write_tps(const LandmarkSet& set, const std::string& mesh_file) {
    std::string text = fmt::format("LM3={}\n", set.landmarks.size());
    for (const Landmark& landmark : set.landmarks) text += joined_numbers(landmark.position) + "\n";
    Json comment(rapidjson::kObjectType);
    add_members(comment, comment.GetAllocator(), "names",
                json_list(set.landmarks, comment.GetAllocator(), [](const Landmark& landmark) { return landmark.name; }));
    std::string line = json_text(comment);  // its line breaks are between values
    std::replace(line.begin(), line.end(), '\n', ' ');
    text += fmt::format("COMMENT={}\n", trimmed(line));
    return fmt::format("{}ID={}\n", text, one_line(Path(mesh_file).stem().string()));
}

// fcsv: comment lines with the version, the space and the columns, then one row per point.
LandmarkSet read_fcsv(const std::string& bytes, const std::string& where, const LandmarkFileOptions& options) {
    LandmarkSet set;
    std::optional<AnatomicalSpace> space;
    std::vector<std::string> header;
    std::string body;  // comment lines become blank, so that line numbers are preserved
    for (std::size_t i = 0; i < bytes.size();) {
        const std::string_view raw_line = line_at(bytes, i), line = trimmed(raw_line);
        if (line.starts_with('#')) {
            const std::size_t equals = line.find('=');
            const std::string key = lower_case(trimmed(line.substr(1, equals == std::string_view::npos ? 0 : equals - 1)));
            const std::string_view value = equals == std::string_view::npos ? "" : trimmed(line.substr(equals + 1));
            if (key == "coordinatesystem") {
                if (value == "0" || value == "RAS") space = AnatomicalSpace::ras;
                else if (value == "1" || value == "LPS") space = AnatomicalSpace::lps;
                else
                    fail_input(where, fmt::format("unknown coordinate system '{}'", one_line(value).substr(0, 20)),
                               "use LPS (1) or RAS (0)");
            } else if (key == "columns") {
                const auto rows = csv_rows(value, ',', where);
                if (!rows.empty()) header = rows.front().cells;
            }
        } else {
            body += raw_line;
        }
        body += '\n';
    }
    if (!space) {
        space = AnatomicalSpace::ras;
        set.notes.emplace_back("the file states no coordinate system: RAS is assumed, as in old versions");
    }
    if (header.empty())
        header = {"id", "x", "y", "z", "ow", "ox", "oy", "oz", "vis", "sel", "lock", "label", "desc", "associatedNodeID"};
    const auto columns = columns_of(header);
    if (!columns) fail_input(where, "its columns do not include x, y and z", "correct the line '# columns = id,x,y,z,...'");
    const auto rows = csv_rows(body, ',', where);
    for (const CsvRow& row : rows) {
        Landmark landmark;
        landmark.name = columns->name && *columns->name < row.cells.size() ? as_utf8(unescape_formula(row.cells[*columns->name]))
                                                                           : to_string(set.landmarks.size() + 1);
        for (std::size_t k = 0; k < 3; ++k) landmark.position[k] = coordinate(row, columns->position[k], where);
        check_position(landmark.position, at_line(where, row.line));
        landmark.position = in_mesh_space(landmark.position, space, options.mesh_space);
        set.landmarks.push_back(std::move(landmark));
    }
    set.unit = "mm";
    return set;
}

std::string write_fcsv(const LandmarkSet& set, const LandmarkFileOptions& options, Notes& notes) {
    std::string text = fmt::format(
        "# Markups fiducial file version = 4.11\n# CoordinateSystem = {}\n# columns = "
        "id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID\n",
        option_text(options, "mesh-space"));
    std::size_t number = 0, changed = 0;
    for (const Landmark& landmark : set.landmarks) {
        changed += has_control(landmark.name) ? 1 : 0;
        text += csv_row({"ostraka_" + to_string(++number), digits(landmark.position[0]), digits(landmark.position[1]),
                         digits(landmark.position[2]), "0", "0", "0", "1", "1", "1", "0", one_line(landmark.name), "", ""});
    }
    if (changed > 0)
        notes.push_back(counted(changed, "name") +
                        " contained line breaks or control characters, which were replaced by blanks in fcsv");
    return text;
}

}  // namespace ostraka::interchange
