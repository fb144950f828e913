#include "ostraka/operations/page_results.h"

#include "ostraka/core/message_text.h"
#include "ostraka/files/csv.h"
#include "ostraka/slicing/slice_descriptors.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

using Cells = std::vector<std::pair<std::string, Json>>;

std::string title_of(std::string name) {
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

Json copy_of(const JsonValue& value) {
    Json cell;
    cell.CopyFrom(value, cell.GetAllocator());
    return cell;
}

/// Adds the single values of a record; names of nested records are joined by '.'.
void add_cells(const JsonValue& record, const std::string& prefix, Cells& cells) {
    for (const auto& [key, value] : record.GetObject()) {
        const std::string name = prefix + key.GetString();
        if (value.IsObject()) {
            add_cells(value, name + ".", cells);
        } else if (value.IsBool()) {
            cells.emplace_back(name, cell_of(std::string(value.GetBool() ? "yes" : "no")));
        } else if (value.IsArray()) {
            std::vector<std::string> texts;
            for (const JsonValue& element : value.GetArray())
                if (element.IsString()) texts.push_back(element.GetString());
            if (texts.size() == value.Size() && !texts.empty()) cells.emplace_back(name, cell_of(joined(texts, ", ")));
        } else {
            cells.emplace_back(name, copy_of(value));
        }
    }
}

std::optional<double> finite_in(const JsonValue& object, const char* name) {
    const JsonValue* member = find_member(object, name);
    return member != nullptr && member->IsNumber() ? std::optional(member->GetDouble()) : std::nullopt;
}

/// Mean of the finite values added for each element; NaN if there are none.
class Means {
public:
    explicit Means(std::size_t elements) : sums_(elements, 0), counts_(elements, 0) {}
    void add(std::size_t element, double value) {
        if (std::isfinite(value)) sums_[element] += value, counts_[element] += 1;
    }
    [[nodiscard]] std::vector<double> values() const {
        std::vector<double> means;
        for (std::size_t i = 0; i < sums_.size(); ++i) means.push_back(counts_[i] > 0 ? sums_[i] / counts_[i] : std::nan(""));
        return means;
    }

private:
    std::vector<double> sums_, counts_;
};

constexpr std::size_t origins = 3;

/// For each vertex, the most frequent origin of its faces; ties go to the lowest.
std::vector<double> origin_of_vertices(const MeshFile& file) {
    std::vector<std::array<std::size_t, origins>> votes(file.mesh.number_of_vertices(), {0, 0, 0});
    for (const Face face : file.mesh.faces())
        for (const Vertex v : corners(file.mesh, face))
            ++votes[v.idx()][static_cast<std::size_t>(file.extras.face_labels[face.idx()])];
    std::vector<double> values;
    for (const auto& vote : votes)
        values.push_back(static_cast<double>(std::max_element(vote.begin(), vote.end()) - vote.begin()));
    return values;
}

}  // namespace

PageSlices page_slices(const JsonValue& document, const std::string& where) {
    validate(document, "slices", where);
    PageSlices slices;
    slices.unit = text_in(document, "unit");
    const auto& levels = document["slices"].GetArray();
    for (const NamedDescriptor& descriptor : list_descriptors(SliceDescriptors{})) {
        const bool is_defined = std::any_of(levels.begin(), levels.end(), [&](const JsonValue& level) {
            return finite_in(level["descriptors"], descriptor.name).has_value();
        });
        const std::string_view kind = descriptor.unit;
        const std::string unit = slices.unit.empty() || kind.empty() ? "" : kind == "area" ? slices.unit + "²" : slices.unit;
        if (is_defined) slices.columns.push_back({descriptor.name, title_of(descriptor.name), unit});
    }
    for (const JsonValue& source : levels) {
        PageSlices::Level& level = slices.levels.emplace_back();
        level.height = source["height"].GetDouble();
        const JsonValue& frame = source["frame"];
        level.origin = triple_of(frame["origin"]);
        const std::array<double, 3> normal = triple_of(frame["normal"]);
        for (std::size_t k = 0; k < 3; ++k) level.origin[k] += level.height * normal[k];
        level.u = triple_of(frame["u"]);
        level.v = triple_of(frame["v"]);
        for (const PageSlices::Column& column : slices.columns)
            level.values.push_back(finite_in(source["descriptors"], column.name.c_str()));
        for (const JsonValue& contour : source["contours"].GetArray()) {
            PageSlices::Contour& target = level.contours.emplace_back();
            target.closed = flag_in(contour, "closed");
            target.hole = flag_in(contour, "hole");
            for (const JsonValue& point : contour["points"].GetArray())
                target.points.push_back({point[0].GetDouble(), point[1].GetDouble()});
        }
    }
    std::stable_sort(slices.levels.begin(), slices.levels.end(),
                     [](const PageSlices::Level& a, const PageSlices::Level& b) { return a.height < b.height; });
    if (const JsonValue* tube = find_member(document, "tube"); tube != nullptr && flag_in(*tube, "found"))
        slices.tube = {number_or(*tube, "lowest", 0), number_or(*tube, "highest", 0)};
    return slices;
}

std::vector<PageConstraint> page_constraints(const JsonValue& result, const AnnotationSet& set) {
    std::vector<PageConstraint> constraints;
    for (const JsonValue& record : list_in(result, "constraints")) {
        if (!record.IsObject() || find_member(record, "parts") == nullptr || find_member(record, "verdict") == nullptr) continue;
        PageConstraint& constraint = constraints.emplace_back();
        constraint.type = text_in(record, "type");
        for (const JsonValue& part : list_in(record, "parts"))
            for (std::size_t i = 0; i < set.annotations.size(); ++i)
                if (set.annotations[i].tag == text_of(part)) constraint.members.push_back(i);
        constraint.weight = number_or(record, "weight", 1);
        constraint.hard = flag_in(record, "hard");
        constraint.before = text_in(record, "before");
        constraint.verdict = text_in(record, "verdict");
        if (constraint.verdict == "holds" || constraint.verdict == "fails") constraint.holds = constraint.verdict == "holds";
        constraint.text = text_in(record, "text");
        for (const JsonValue& deviation : list_in(record, "deviations"))
            if (deviation.IsObject())
                constraint.deviations.push_back({text_in(deviation, "quantity"), finite_in(deviation, "before"),
                                                 finite_in(deviation, "value"), finite_in(deviation, "tolerance"),
                                                 text_in(deviation, "unit")});
        if (const JsonValue* residual = find_member(record, "residual"); residual != nullptr && residual->IsObject())
            if (const auto mean = finite_in(*residual, "mean"), largest = finite_in(*residual, "max"); mean && largest)
                constraint.residual = {*mean, *largest};
    }
    return constraints;
}

std::vector<PageVerdict> page_conformance(const JsonValue& result, const AnnotationSet& set) {
    std::vector<PageVerdict> verdicts;
    const auto find_members = [&](const JsonValue& id, std::vector<std::size_t>& members) {
        for (std::size_t i = 0; i < set.annotations.size(); ++i)
            if (id.IsInt() && set.annotations[i].id == id.GetInt()) members.push_back(i);
    };
    for (const JsonValue& record : list_in(result, "rules")) {
        if (!record.IsObject()) continue;
        PageVerdict& entry =
            verdicts.emplace_back(PageVerdict{"rule", text_in(record, "rule"), {}, false, text_in(record, "text")});
        if (const JsonValue* id = find_member(record, "annotation")) find_members(*id, entry.members);
    }
    for (const JsonValue& record : list_in(result, "relationships")) {
        if (!record.IsObject() || find_member(record, "verdict") == nullptr) continue;
        const bool constraint = flag_in(record, "isConstraint");
        const std::string type = text_in(record, "type");
        PageVerdict& entry = verdicts.emplace_back();
        entry.kind = !constraint ? "relation" : type == "proportion" ? "canon" : "constraint";
        entry.name = type;
        for (const JsonValue& id : list_in(record, "annotations")) find_members(id, entry.members);
        if (const std::string verdict = text_in(record, "verdict"); verdict != "unknown") entry.holds = verdict == "holds";
        if (const JsonValue* parameters = find_member(record, "parameters"); parameters != nullptr && parameters->IsObject())
            for (const JsonValue& deviation : list_in(*parameters, "deviations")) {
                const auto value = deviation.IsObject() ? finite_in(deviation, "value") : std::nullopt;
                if (!value) continue;
                const auto tolerance = finite_in(deviation, "tolerance");
                const std::string unit = text_in(deviation, "unit");
                entry.text += fmt::format("{}{} {}{}{}", entry.text.empty() ? "" : "; ", text_in(deviation, "quantity"),
                                          number(*value, 4), tolerance ? fmt::format(" (at most {})", number(*tolerance, 4)) : "",
                                          unit.empty() ? "" : " " + unit);
            }
        if (const std::string text = text_in(record, "text"); !text.empty())
            entry.text += (entry.text.empty() ? "" : "; ") + text;
    }
    return verdicts;
}

std::vector<std::string> page_conflicts(const JsonValue& result) {
    std::vector<std::string> texts;
    const auto constraints = list_in(result, "constraints");
    const auto name = [&](int id) {
        for (const JsonValue& constraint : constraints)
            if (constraint.IsObject() && number_or(constraint, "id", -1) == id) {
                std::vector<std::string> parts;
                for (const JsonValue& part : list_in(constraint, "parts")) parts.push_back(text_of(part));
                return fmt::format("{} of {}", text_in(constraint, "type"), joined(parts, ", "));
            }
        return "constraint " + std::to_string(id);
    };
    for (const JsonValue& conflict : list_in(result, "conflicts")) {
        if (!conflict.IsObject()) continue;
        std::vector<std::string> freed;
        for (const JsonValue& id : list_in(conflict, "freed"))
            if (id.IsNumber()) freed.push_back(name(static_cast<int>(id.GetDouble())));
        const std::string subject = name(static_cast<int>(number_or(conflict, "id", -1)));
        texts.push_back(freed.empty() ? subject + " cannot hold"
                                      : fmt::format("{} would hold without {}", subject, joined(freed, "; ")));
    }
    return texts;
}

std::vector<PageTable> record_tables(const JsonValue& result, const std::string& title, const std::set<std::string>& omitted) {
    std::vector<PageTable> tables;
    PageTable single;
    single.title = title;
    single.columns = {"quantity", "value"};
    Cells singles;
    JsonAllocator allocator;
    JsonValue single_values(rapidjson::kObjectType);
    for (const auto& [key, value] : result.GetObject()) {
        const std::string name = key.GetString();
        if (omitted.contains(name) || name == "format" || name == "version" || name == "provenance") continue;
        const bool records = value.IsArray() && !value.Empty() &&
                             std::all_of(value.Begin(), value.End(), [](const JsonValue& element) { return element.IsObject(); });
        if (!records) {
            add_member(single_values, name, JsonValue(value, allocator), allocator);
            continue;
        }
        PageTable& table = tables.emplace_back();
        table.title = title + ": " + title_of(name);
        std::vector<Cells> rows;
        for (const JsonValue& record : value.GetArray()) {
            add_cells(record, "", rows.emplace_back());
            for (const auto& [column, cell] : rows.back())
                if (std::find(table.columns.begin(), table.columns.end(), column) == table.columns.end())
                    table.columns.push_back(column);
        }
        for (Cells& cells : rows) {
            PageTable::Row& row = table.rows.emplace_back();
            for (const std::string& column : table.columns) {
                const auto match =
                    std::find_if(cells.begin(), cells.end(), [&](const auto& named_cell) { return named_cell.first == column; });
                if (match == cells.end()) row.cells.emplace_back();
                else row.cells.push_back(std::move(match->second));
            }
        }
    }
    add_cells(single_values, "", singles);
    for (auto& [name, cell] : singles) {
        PageTable::Row& row = single.rows.emplace_back();
        row.cells.push_back(cell_of(title_of(name)));
        row.cells.push_back(std::move(cell));
    }
    if (!single.rows.empty()) tables.insert(tables.begin(), std::move(single));
    return tables;
}

bool is_mesh_name(const std::string& name) {
    const std::string kind = extension(name);
    return kind == ".ply" || kind == ".obj" || kind == ".off" || kind == ".stl";
}

void PageNames::add(const std::string& object, const AnnotationSet* set) {
    const int place = count_++;
    objects_.try_emplace(object, place);
    if (set == nullptr) return;
    for (std::size_t i = 0; i < set->annotations.size(); ++i) {
        const std::string& tag = set->annotations[i].tag;
        // A tag of several objects links to none.
        if (const auto [position, inserted] = annotations_.try_emplace(tag, place, static_cast<int>(i)); !inserted)
            position->second = {-1, -1};
    }
}

void PageNames::link(PageTable& table) const {
    for (PageTable::Row& row : table.rows) {
        for (const Json& cell : row.cells)
            if (cell.IsString() && row.object < 0) row.object = object(cell.GetString());
        for (const Json& cell : row.cells) {
            if (!cell.IsString() || row.annotation >= 0) continue;
            const auto position = annotations_.find(cell.GetString());
            if (position == annotations_.end() || position->second.first < 0) continue;
            if (row.object < 0) row.object = position->second.first;
            if (row.object == position->second.first) row.annotation = position->second.second;
        }
    }
}

int PageNames::object(const std::string& text) const {
    auto entry = objects_.find(text);
    if (entry == objects_.end() && is_mesh_name(text)) entry = objects_.find(Path(text).stem().string());
    return entry == objects_.end() ? -1 : entry->second;
}

PageTable csv_table(const Path& file, const std::string& name) {
    const std::string content = read_file(file);
    const auto rows = csv_rows(content, csv_separator(content), name);
    PageTable table;
    table.title = Path(name).stem().string();
    if (rows.empty()) return table;
    for (const std::string& cell : rows.front().cells) table.columns.push_back(unescape_formula(cell));
    for (std::size_t r = 1; r < rows.size(); ++r) {
        PageTable::Row& row = table.rows.emplace_back();
        for (std::size_t k = 0; k < table.columns.size(); ++k) {
            const std::string value = k < rows[r].cells.size() ? unescape_formula(rows[r].cells[k]) : std::string();
            if (const auto x = number_of(value)) row.cells.push_back(cell_of(*x));
            else row.cells.push_back(value.empty() ? Json() : cell_of(value));
        }
    }
    return table;
}

std::vector<PageMap> value_maps(const MeshFile& mesh) {
    std::vector<PageMap> maps;
    const auto add = [&](const std::string& name, std::vector<double> values, std::size_t elements) {
        const bool varied = std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) != values.end();
        const bool finite = std::any_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
        if (values.size() == elements && varied && finite) maps.push_back({name, title_of(name), std::move(values)});
    };
    const std::size_t vertices = mesh.mesh.number_of_vertices();
    const auto has = [&](const char* name) {
        return std::any_of(mesh.extras.face_values.begin(), mesh.extras.face_values.end(),
                           [&](const NamedValues& column) { return column.name == name; });
    };
    const std::vector<std::int32_t>& labels = mesh.extras.face_labels;
    const bool completed = has("distance") && has("confidence") && labels.size() == mesh.mesh.number_of_faces() &&
                           std::all_of(labels.begin(), labels.end(), [](std::int32_t label) {
                               return label >= 0 && label < static_cast<std::int32_t>(origins);
                           });
    if (completed)
        maps.push_back({"origin",
                        "observed, interpolated or hypothesis",
                        origin_of_vertices(mesh),
                        {{"observed", {186, 120, 82}}, {"interpolated", {214, 180, 120}}, {"hypothesis", {170, 180, 190}}}});
    for (const NamedValues& column : mesh.extras.vertex_values) add(column.name, column.values, vertices);
    for (const NamedValues& column : mesh.extras.face_values) add(column.name, vertex_means(mesh.mesh, column.values), vertices);
    return maps;
}

PageMap simplified_map(const PageMap& map, const std::vector<Index>& new_index, std::size_t vertices) {
    PageMap simplified{map.name, map.label, {}, map.categories};
    if (!map.categories.empty()) {
        // Majority vote of the merged vertices; ties go to the lowest category.
        const std::size_t count = map.categories.size();
        std::vector<std::uint32_t> votes(vertices * count, 0);
        for (std::size_t i = 0; i < map.values.size(); ++i)
            if (new_index[i] != no_index && map.values[i] >= 0 && map.values[i] < static_cast<double>(count))
                ++votes[new_index[i] * count + static_cast<std::size_t>(map.values[i])];
        for (std::size_t v = 0; v < vertices; ++v) {
            const auto begin = votes.begin() + static_cast<std::ptrdiff_t>(v * count);
            const auto winner = std::max_element(begin, begin + static_cast<std::ptrdiff_t>(count));
            simplified.values.push_back(*winner > 0 ? static_cast<double>(winner - begin) : std::nan(""));
        }
        return simplified;
    }
    Means means(vertices);
    for (std::size_t i = 0; i < map.values.size(); ++i)
        if (new_index[i] != no_index) means.add(new_index[i], map.values[i]);
    simplified.values = means.values();
    return simplified;
}

bool is_completed(const std::vector<PageMap>& maps) {
    return !maps.empty() && maps.front().name == "origin" && !maps.front().categories.empty();
}

std::vector<double> vertex_means(const Mesh& mesh, const std::vector<double>& face_values) {
    Means means(mesh.number_of_vertices());
    for (const Face face : mesh.faces())
        for (const Vertex v : corners(mesh, face)) means.add(v.idx(), face_values[face.idx()]);
    return means.values();
}

bool are_apart(AnnotatedMeshView object) {
    constexpr int no_region = -1;
    std::vector<int> region_of_vertex(object.mesh.number_of_vertices(), no_region);
    std::size_t covered = 0;
    for (const Annotation& region : object.annotations.annotations) {
        if (region.type != AnnotationType::region) return false;
        covered += region.faces.size();
        for (const Index face : region.faces)
            for (const Vertex v : corners(object.mesh, Face(face))) {
                if (region_of_vertex[v.idx()] != no_region && region_of_vertex[v.idx()] != region.id) return false;
                region_of_vertex[v.idx()] = region.id;
            }
    }
    return object.annotations.annotations.size() > 1 && covered == object.mesh.number_of_faces();
}

}  // namespace ostraka
