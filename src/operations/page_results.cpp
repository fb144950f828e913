#include "ostraka/operations/page_results.h"

#include "ostraka/core/csv.h"
#include "ostraka/core/words.h"
#include "ostraka/io/ply.h"
#include "ostraka/slicing/slice_descriptors.h"

#include <algorithm>
#include <cmath>
#include <functional>

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
void add_cells(const JsonValue& record, const std::string& before, Cells& cells) {
    for (const auto& [key, value] : record.GetObject()) {
        const std::string name = before + key.GetString();
        if (value.IsObject()) {
            add_cells(value, name + ".", cells);
        } else if (value.IsBool()) {
            cells.emplace_back(name, cell_of(std::string(value.GetBool() ? "yes" : "no")));
        } else if (value.IsArray()) {
            std::vector<std::string> texts;
            for (const JsonValue& one : value.GetArray())
                if (one.IsString()) texts.push_back(one.GetString());
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

/// Value per triangle, taken from its polygon.
std::vector<double> of_triangles(const std::vector<double>& of_polygons, const MeshFile& mesh) {
    if (mesh.triangle_polygon.empty()) return of_polygons;
    std::vector<double> values;
    for (const Index polygon : mesh.triangle_polygon)
        values.push_back(polygon < of_polygons.size() ? of_polygons[polygon] : std::nan(""));
    return values;
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
        const bool told = std::any_of(levels.begin(), levels.end(), [&](const JsonValue& level) {
            return finite_in(level["descriptors"], descriptor.name).has_value();
        });
        const std::string_view kind = descriptor.unit;
        const std::string unit = slices.unit.empty() || kind.empty() ? "" : kind == "area" ? slices.unit + "²" : slices.unit;
        if (told) slices.columns.push_back({descriptor.name, title_of(descriptor.name), unit});
    }
    for (const JsonValue& from : levels) {
        PageSlices::Level& level = slices.levels.emplace_back();
        level.height = from["height"].GetDouble();
        const JsonValue& frame = from["frame"];
        level.origin = triple_of(frame["origin"]);
        const std::array<double, 3> normal = triple_of(frame["normal"]);
        for (std::size_t k = 0; k < 3; ++k) level.origin[k] += level.height * normal[k];
        level.u = triple_of(frame["u"]);
        level.v = triple_of(frame["v"]);
        for (const PageSlices::Column& column : slices.columns)
            level.values.push_back(finite_in(from["descriptors"], column.name.c_str()));
        for (const JsonValue& contour : from["contours"].GetArray()) {
            PageSlices::Contour& to = level.contours.emplace_back();
            to.closed = flag_in(contour, "closed");
            to.hole = flag_in(contour, "hole");
            for (const JsonValue& point : contour["points"].GetArray())
                to.points.push_back({point[0].GetDouble(), point[1].GetDouble()});
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
    for (const JsonValue& from : list_in(result, "constraints")) {
        if (!from.IsObject() || find_member(from, "parts") == nullptr || find_member(from, "verdict") == nullptr) continue;
        PageConstraint& one = constraints.emplace_back();
        one.type = text_in(from, "type");
        for (const JsonValue& part : list_in(from, "parts"))
            for (std::size_t i = 0; i < set.annotations.size(); ++i)
                if (set.annotations[i].tag == text_of(part)) one.members.push_back(i);
        one.weight = number_or(from, "weight", 1);
        one.hard = flag_in(from, "hard");
        one.before = text_in(from, "before");
        one.verdict = text_in(from, "verdict");
        if (one.verdict == "holds" || one.verdict == "fails") one.holds = one.verdict == "holds";
        one.text = text_in(from, "text");
        for (const JsonValue& deviation : list_in(from, "deviations"))
            if (deviation.IsObject())
                one.deviations.push_back({text_in(deviation, "quantity"), finite_in(deviation, "before"),
                                          finite_in(deviation, "value"), finite_in(deviation, "tolerance"),
                                          text_in(deviation, "unit")});
        if (const JsonValue* residual = find_member(from, "residual"); residual != nullptr && residual->IsObject())
            if (const auto mean = finite_in(*residual, "mean"), largest = finite_in(*residual, "max"); mean && largest)
                one.residual = {*mean, *largest};
    }
    return constraints;
}

std::vector<PageVerdict> page_conformance(const JsonValue& result, const AnnotationSet& set) {
    std::vector<PageVerdict> verdicts;
    const auto place_of = [&](const JsonValue& id, std::vector<std::size_t>& members) {
        for (std::size_t i = 0; i < set.annotations.size(); ++i)
            if (id.IsInt() && set.annotations[i].id == id.GetInt()) members.push_back(i);
    };
    for (const JsonValue& from : list_in(result, "rules")) {
        if (!from.IsObject()) continue;
        PageVerdict& one = verdicts.emplace_back(PageVerdict{"rule", text_in(from, "rule"), {}, false, text_in(from, "text")});
        if (const JsonValue* id = find_member(from, "annotation")) place_of(*id, one.members);
    }
    for (const JsonValue& from : list_in(result, "relationships")) {
        if (!from.IsObject() || find_member(from, "verdict") == nullptr) continue;
        const bool constraint = flag_in(from, "isConstraint");
        const std::string type = text_in(from, "type");
        PageVerdict& one = verdicts.emplace_back();
        one.kind = !constraint ? "relation" : type == "proportion" ? "canon" : "constraint";
        one.name = type;
        for (const JsonValue& id : list_in(from, "annotations")) place_of(id, one.members);
        if (const std::string verdict = text_in(from, "verdict"); verdict != "unknown") one.holds = verdict == "holds";
        if (const JsonValue* parameters = find_member(from, "parameters"); parameters != nullptr && parameters->IsObject())
            for (const JsonValue& deviation : list_in(*parameters, "deviations")) {
                const auto value = deviation.IsObject() ? finite_in(deviation, "value") : std::nullopt;
                if (!value) continue;
                const auto tolerance = finite_in(deviation, "tolerance");
                const std::string unit = text_in(deviation, "unit");
                one.text += (one.text.empty() ? "" : "; ") + text_in(deviation, "quantity") + " " + number(*value, 4) +
                            (tolerance ? " (at most " + number(*tolerance, 4) + ")" : "") + (unit.empty() ? "" : " " + unit);
            }
        if (const std::string text = text_in(from, "text"); !text.empty()) one.text += (one.text.empty() ? "" : "; ") + text;
    }
    return verdicts;
}

std::vector<std::string> page_conflicts(const JsonValue& result) {
    std::vector<std::string> texts;
    const auto constraints = list_in(result, "constraints");
    const auto name = [&](int id) {
        for (const JsonValue& one : constraints)
            if (one.IsObject() && number_or(one, "id", -1) == id) {
                std::vector<std::string> parts;
                for (const JsonValue& part : list_in(one, "parts")) parts.push_back(text_of(part));
                return text_in(one, "type") + " of " + joined(parts, ", ");
            }
        return "constraint " + std::to_string(id);
    };
    for (const JsonValue& conflict : list_in(result, "conflicts")) {
        if (!conflict.IsObject()) continue;
        std::vector<std::string> freed;
        for (const JsonValue& id : list_in(conflict, "freed"))
            if (id.IsNumber()) freed.push_back(name(static_cast<int>(id.GetDouble())));
        const std::string subject = name(static_cast<int>(number_or(conflict, "id", -1)));
        texts.push_back(freed.empty() ? subject + " cannot hold" : subject + " would hold without " + joined(freed, "; "));
    }
    return texts;
}

std::vector<PageTable> record_tables(const JsonValue& result, const std::string& title, const std::set<std::string>& but) {
    std::vector<PageTable> tables;
    PageTable single;
    single.title = title;
    single.columns = {"quantity", "value"};
    Cells singles;
    JsonAllocator allocator;
    JsonValue rest(rapidjson::kObjectType);
    for (const auto& [key, value] : result.GetObject()) {
        const std::string name = key.GetString();
        if (but.contains(name) || name == "format" || name == "version" || name == "provenance") continue;
        const bool records = value.IsArray() && !value.Empty() &&
                             std::all_of(value.Begin(), value.End(), [](const JsonValue& one) { return one.IsObject(); });
        if (!records) {
            add_member(rest, name, JsonValue(value, allocator), allocator);
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
                const auto found = std::find_if(cells.begin(), cells.end(), [&](const auto& one) { return one.first == column; });
                if (found == cells.end()) row.cells.emplace_back();
                else row.cells.push_back(std::move(found->second));
            }
        }
    }
    add_cells(rest, "", singles);
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
        if (const auto [found, fresh] = annotations_.try_emplace(tag, place, static_cast<int>(i)); !fresh)
            found->second = {-1, -1};
    }
}

void PageNames::link(PageTable& table) const {
    for (PageTable::Row& row : table.rows) {
        for (const Json& cell : row.cells)
            if (cell.IsString() && row.object < 0) row.object = object(cell.GetString());
        for (const Json& cell : row.cells) {
            if (!cell.IsString() || row.annotation >= 0) continue;
            const auto found = annotations_.find(cell.GetString());
            if (found == annotations_.end() || found->second.first < 0) continue;
            if (row.object < 0) row.object = found->second.first;
            if (row.object == found->second.first) row.annotation = found->second.second;
        }
    }
}

int PageNames::object(const std::string& text) const {
    auto found = objects_.find(text);
    if (found == objects_.end() && is_mesh_name(text)) found = objects_.find(Path(text).stem().string());
    return found == objects_.end() ? -1 : found->second;
}

PageTable csv_table(const Path& file, const std::string& name) {
    const std::string content = read_file(file);
    const auto rows = csv_rows(content, csv_separator(content), name);
    PageTable table;
    table.title = Path(name).stem().string();
    if (rows.empty()) return table;
    for (const std::string& cell : rows.front().cells) table.columns.push_back(unguarded(cell));
    for (std::size_t r = 1; r < rows.size(); ++r) {
        PageTable::Row& row = table.rows.emplace_back();
        for (std::size_t k = 0; k < table.columns.size(); ++k) {
            const std::string value = k < rows[r].cells.size() ? unguarded(rows[r].cells[k]) : std::string();
            if (const auto x = number_of(value)) row.cells.push_back(cell_of(*x));
            else row.cells.push_back(value.empty() ? Json() : cell_of(value));
        }
    }
    return table;
}

std::vector<PageMap> ply_maps(const Path& file, const MeshFile& mesh) {
    std::vector<PageMap> maps;
    PlyNumbers numbers = read_ply_numbers(file);
    const auto add = [&](const std::string& name, std::vector<double> values, std::size_t elements) {
        const bool varied = std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) != values.end();
        const bool finite = std::any_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
        if (values.size() == elements && varied && finite) maps.push_back({name, title_of(name), std::move(values)});
    };
    const std::size_t vertices = mesh.mesh.number_of_vertices();
    const auto has = [&](const char* name) {
        return std::any_of(numbers.faces.begin(), numbers.faces.end(), [&](const PlyColumn& one) { return one.name == name; });
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
    for (PlyColumn& column : numbers.vertices) add(column.name, std::move(column.values), vertices);
    for (PlyColumn& column : numbers.faces) {
        const std::vector<double> values = of_triangles(column.values, mesh);
        if (values.size() == mesh.mesh.number_of_faces()) add(column.name, vertex_means(mesh.mesh, values), vertices);
    }
    return maps;
}

PageMap simplified_map(const PageMap& map, const std::vector<Index>& to, std::size_t vertices) {
    PageMap made{map.name, map.label, {}, map.categories};
    if (!map.categories.empty()) {
        // Majority vote of the merged vertices; ties go to the lowest category.
        const std::size_t count = map.categories.size();
        std::vector<std::uint32_t> votes(vertices * count, 0);
        for (std::size_t i = 0; i < map.values.size(); ++i)
            if (to[i] != no_index && map.values[i] >= 0 && map.values[i] < static_cast<double>(count))
                ++votes[to[i] * count + static_cast<std::size_t>(map.values[i])];
        for (std::size_t v = 0; v < vertices; ++v) {
            const auto begin = votes.begin() + static_cast<std::ptrdiff_t>(v * count);
            const auto most = std::max_element(begin, begin + static_cast<std::ptrdiff_t>(count));
            made.values.push_back(*most > 0 ? static_cast<double>(most - begin) : std::nan(""));
        }
        return made;
    }
    Means means(vertices);
    for (std::size_t i = 0; i < map.values.size(); ++i)
        if (to[i] != no_index) means.add(to[i], map.values[i]);
    made.values = means.values();
    return made;
}

bool is_completed(const std::vector<PageMap>& maps) {
    return !maps.empty() && maps.front().name == "origin" && !maps.front().categories.empty();
}

std::vector<double> vertex_means(const Mesh& mesh, const std::vector<double>& of_faces) {
    Means means(mesh.number_of_vertices());
    for (const Face face : mesh.faces())
        for (const Vertex v : corners(mesh, face)) means.add(v.idx(), of_faces[face.idx()]);
    return means.values();
}

bool are_apart(const Mesh& mesh, const AnnotationSet& regions) {
    constexpr int none = -1;
    std::vector<int> of(mesh.number_of_vertices(), none);
    std::size_t covered = 0;
    for (const Annotation& region : regions.annotations) {
        if (region.type != AnnotationType::region) return false;
        covered += region.faces.size();
        for (const Index face : region.faces)
            for (const Vertex v : corners(mesh, Face(face))) {
                if (of[v.idx()] != none && of[v.idx()] != region.id) return false;
                of[v.idx()] = region.id;
            }
    }
    return regions.annotations.size() > 1 && covered == mesh.number_of_faces();
}

}  // namespace ostraka
