#include "interchange/attribute_table.h"

#include "interchange/text.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <map>
#include <set>

namespace ostraka {

namespace {

using namespace interchange;
using std::to_string;

const std::vector<std::string>& column_names() {
    static const std::vector<std::string> names{"annotation",  "tag",       "type",  "colour", "attribute", "name",
                                                "kind",        "value",     "unit",  "note",   "tool",      "points",
                                                "direction",   "locations", "file",  "stale",  "geodesic",  "repeats",
                                                "uncertainty", "origin",    "sha256"};
    return names;
}

/// Face index and all three weights, so that they are restored exactly.
std::string cell_text(const std::vector<SurfacePoint>& locations) {
    std::string text;
    for (const SurfacePoint& location : locations)
        text += fmt::format("{}{} {}", text.empty() ? "" : " ", location.element[0], joined_numbers(location.weights));
    return text;
}

std::string cell_text(const std::vector<std::vector<Index>>& pickings) {
    std::string text;
    for (const auto& pins : pickings) text += (text.empty() ? "" : " | ") + joined_numbers(pins);
    return text;
}

class TableReader {
public:
    TableReader(const std::string& bytes, const std::string& where)
        : where_(where), rows_(csv_rows(bytes, csv_separator(bytes), where)) {
        if (rows_.empty()) fail_at(1, "the file is empty", "give a table that 'annotation export' wrote");
        const auto& header = rows_.front().cells;
        for (std::size_t i = 0; i < header.size(); ++i)
            if (!columns_.emplace(lower_case(trimmed(header[i])), i).second)
                fail_at(rows_.front().line, fmt::format("the column '{}' appears twice", one_line(header[i])), "remove one");
        for (const char* required : {"annotation", "attribute", "name", "kind"})
            if (!columns_.contains(required))
                fail_at(rows_.front().line, fmt::format("there is no column '{}'", required),
                        "keep the header that 'annotation export' wrote");
    }

    std::size_t apply(AnnotationSet& set) {
        std::map<int, Annotation> edited;
        for (std::size_t i = 1; i < rows_.size(); ++i) {
            row_ = &rows_[i];
            const int id = integer_cell("annotation");
            const Annotation* existing = set.find(id);
            if (existing == nullptr)
                fail("annotation", "there is no annotation " + to_string(id),
                     "give the annotations from which the table was exported");
            const auto [entry, is_first] = edited.try_emplace(id, *existing);
            Annotation& annotation = entry->second;
            if (is_first) annotation.attributes.clear();
            read_annotation_columns(annotation, is_first);
            if (!cell("attribute").empty()) annotation.attributes.push_back(attribute());
        }
        std::size_t count = 0;
        for (Annotation& annotation : set.annotations) {
            const auto edited_annotation = edited.find(annotation.id);
            if (edited_annotation == edited.end()) continue;
            std::set<int> ids;
            for (const Attribute& attribute : edited_annotation->second.attributes)
                if (!ids.insert(attribute.id).second)
                    fail_input(where_, fmt::format("annotation {} has the attribute {} twice", annotation.id, attribute.id),
                               "give each attribute of an annotation its own id");
            annotation = std::move(edited_annotation->second);
            ++count;
        }
        return count;
    }

private:
    [[noreturn]] void fail_at(std::size_t line, const std::string& problem, const std::string& remedy) const {
        fail_input(fmt::format("{}, line {}", where_, line), problem, remedy);
    }
    [[noreturn]] void fail(const std::string& column, const std::string& problem, const std::string& remedy) const {
        fail_at(row_->line, fmt::format("column '{}': {}", column, problem), remedy);
    }

    [[nodiscard]] bool has(const std::string& column) const { return columns_.contains(column); }
    [[nodiscard]] std::string cell(const std::string& column) const {
        const auto column_entry = columns_.find(column);
        if (column_entry == columns_.end() || column_entry->second >= row_->cells.size()) return {};
        return as_utf8(unescape_formula(row_->cells[column_entry->second]));
    }
    [[nodiscard]] int integer_cell(const std::string& column) const {
        const auto value = parse_int(cell(column));
        if (!value)
            fail(column, fmt::format("'{}' is not a whole number", one_line(cell(column)).substr(0, 40)), "correct the cell");
        return *value;
    }
    [[nodiscard]] std::vector<double> numbers(const std::string& column) const { return numbers(column, cell(column)); }
    [[nodiscard]] std::vector<double> numbers(const std::string& column, const std::string& text) const {
        std::vector<double> values;
        for (const std::string_view word : split_words(text)) {
            const auto value = number_of(word);
            if (!value)
                fail(column, fmt::format("'{}' is not a number", one_line(word.substr(0, 40))),
                     "give numbers with a decimal point, separated by blanks");
            values.push_back(*value);
        }
        return values;
    }
    [[nodiscard]] Index index(const std::string& column, double value) const {
        if (!(value >= 0 && value < no_index) || value != static_cast<double>(static_cast<Index>(value)))
            fail(column, digits(value) + " is not an index", "give indices of the mesh, from 0");
        return static_cast<Index>(value);
    }

    /// Repeated pickings: indices separated by blanks, pickings by '|'.
    [[nodiscard]] std::vector<std::vector<Index>> pickings() const {
        std::vector<std::vector<Index>> result;
        const std::string text = cell("repeats");
        for (std::size_t begin = 0; begin < text.size();) {
            const std::size_t end = std::min(text.find('|', begin), text.size());
            std::vector<Index>& pins = result.emplace_back();
            for (const double value : numbers("repeats", text.substr(begin, end - begin)))
                pins.push_back(index("repeats", value));
            begin = end + 1;
        }
        return result;
    }

    /// Tag, type and colour, which are repeated in each row of an annotation and must agree.
    void read_annotation_columns(Annotation& annotation, bool is_first) const {
        if (has("type") && !cell("type").empty() && cell("type") != to_string(annotation.type))
            fail("type", fmt::format("annotation {} is a {}", annotation.id, to_string(annotation.type)),
                 "a table cannot change what is selected");
        std::string tag = has("tag") ? cell("tag") : annotation.tag;
        std::array<int, 3> colour = annotation.colour;
        if (has("colour") && !cell("colour").empty()) {
            const auto channels = numbers("colour");
            bool valid = channels.size() == 3;
            for (std::size_t k = 0; valid && k < 3; ++k) {
                valid = channels[k] >= 0 && channels[k] <= 255 && channels[k] == static_cast<int>(channels[k]);
                if (valid) colour[k] = static_cast<int>(channels[k]);
            }
            if (!valid) fail("colour", "is not three whole numbers from 0 to 255", "give red, green and blue, e.g. 200 30 60");
        }
        if (!is_first && (tag != annotation.tag || colour != annotation.colour))
            fail(tag != annotation.tag ? "tag" : "colour",
                 fmt::format("annotation {} has a different value on an earlier row", annotation.id),
                 "give the same value on all its rows");
        annotation.tag = std::move(tag);
        annotation.colour = colour;
    }

    [[nodiscard]] Attribute attribute() const {
        Attribute attribute;
        attribute.id = integer_cell("attribute");
        attribute.name = cell("name");
        const std::string kind = cell("kind"), stale = cell("stale");
        if (!stale.empty() && lower_case(stale) != "true" && lower_case(stale) != "false")
            fail("stale", "is neither true nor false", "correct the cell");
        const bool is_stale = lower_case(stale) == "true";
        if (kind == "semantic") {
            attribute.value = Note{cell("note"), cell("origin")};
        } else if (kind == "measure") {
            attribute.value = measure(is_stale);
        } else if (kind == "descriptor" || kind == "list") {
            attribute.value = Descriptor{numbers("value"), kind == "list", cell("file"), cell("unit"), is_stale, cell("sha256")};
            if (kind == "descriptor" && attribute.descriptor()->values.size() > 1)
                fail("value", "more than one number", "write 'list' as the kind");
        } else {
            fail("kind", fmt::format("'{}' is not a known kind", one_line(kind).substr(0, 40)),
                 "use semantic, measure, descriptor or list");
        }
        return attribute;
    }

    [[nodiscard]] Measure measure(bool is_stale) const {
        Measure measure;
        measure.stale = is_stale;
        measure.tool = cell("tool");
        for (const double value : numbers("points")) measure.points.push_back(index("points", value));
        const auto direction = numbers("direction");
        if (!direction.empty() && direction.size() != 3) fail("direction", "is not three numbers", "give x, y and z");
        if (!direction.empty()) measure.direction = {direction[0], direction[1], direction[2]};
        const auto locations = numbers("locations");
        if (locations.size() % 4 != 0) fail("locations", "is not a face and three weights per point", "correct the cell");
        for (std::size_t i = 0; i < locations.size(); i += 4)
            measure.locations.push_back(
                face_point(index("locations", locations[i]), {locations[i + 1], locations[i + 2], locations[i + 3]}));
        const auto value = numbers("value");
        if (value.size() > 1) fail("value", "more than one number", "a measure has one value");
        if (!value.empty()) measure.value = value.front();
        measure.unit = cell("unit");
        measure.exact = cell("geodesic") == "exact";
        if (!measure.exact && !cell("geodesic").empty())
            fail("geodesic", "is not 'exact'", "leave it empty for a path along edges");
        measure.repeats = pickings();
        const auto uncertainty = numbers("uncertainty");
        if (uncertainty.size() > 1) fail("uncertainty", "more than one number", "a measure has one uncertainty");
        if (!uncertainty.empty()) measure.uncertainty = uncertainty.front();
        return measure;
    }

    std::string where_;
    std::vector<CsvRow> rows_;
    std::map<std::string, std::size_t> columns_;
    const CsvRow* row_ = nullptr;
};

}  // namespace

std::string attribute_table(const AnnotationSet& set) {
    std::string text = csv_row(column_names());
    for (const Annotation& annotation : set.annotations) {
        const std::vector<std::string> annotation_cells{to_string(annotation.id), annotation.tag, to_string(annotation.type),
                                                        joined_numbers(annotation.colour)};
        const auto add = [&](const std::vector<std::string>& attribute_cells) {
            std::vector<std::string> cells = annotation_cells;
            cells.insert(cells.end(), attribute_cells.begin(), attribute_cells.end());
            cells.resize(column_names().size());
            text += csv_row(cells);
        };
        if (annotation.attributes.empty()) add({});
        for (const Attribute& attribute : annotation.attributes) {
            const std::string id = to_string(attribute.id);
            if (const Note* note = attribute.note())
                add({id, attribute.name, "semantic", "", "", note->text, "", "", "", "", "", "", "", "", "", note->origin});
            else if (const Measure* m = attribute.measure())
                add({id, attribute.name, "measure", m->value ? digits(*m->value) : "", m->unit, "", m->tool,
                     joined_numbers(m->points), m->direction ? joined_numbers(*m->direction) : "", cell_text(m->locations), "",
                     m->stale ? "true" : "", m->exact ? "exact" : "", cell_text(m->repeats),
                     m->uncertainty ? digits(*m->uncertainty) : ""});
            else if (const Descriptor* d = attribute.descriptor())
                add({id, attribute.name, d->is_list ? "list" : "descriptor", joined_numbers(d->values), d->unit, "", "", "", "",
                     "", d->file, d->stale ? "true" : "", "", "", "", "", d->sha256});
        }
    }
    return text;
}

bool is_attribute_table(const std::string& bytes) {
    std::string_view header = std::string_view(bytes).substr(0, bytes.find('\n'));
    if (header.starts_with("\xEF\xBB\xBF")) header.remove_prefix(3);
    return header.find("annotation") != std::string_view::npos && header.find("attribute") != std::string_view::npos &&
           header.find("kind") != std::string_view::npos;
}

std::size_t apply_attribute_table(const std::string& bytes, AnnotationSet& set, const std::string& where) {
    return TableReader(bytes, where).apply(set);
}

}  // namespace ostraka
