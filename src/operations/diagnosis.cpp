#include "diagnosis.h"

#include <algorithm>

namespace ostraka {

namespace {

constexpr std::size_t listed = 100;

JsonValue whole(std::size_t value) { return JsonValue(static_cast<std::uint64_t>(value)); }

template <class Range>
JsonValue numbers(const Range& values, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    for (const double value : values) list.PushBack(value, allocator);
    return list;
}

JsonValue component_json(const ComponentDiagnosis& part, JsonAllocator& allocator) {
    JsonValue value(rapidjson::kObjectType);
    add_member(value, "first_vertex", whole(part.first_vertex), allocator);
    add_member(value, "vertices", whole(part.vertices), allocator);
    add_member(value, "triangles", whole(part.triangles), allocator);
    add_member(value, "closed", JsonValue(part.closed()), allocator);
    add_member(value, "manifold", JsonValue(part.manifold()), allocator);
    add_member(value, "orientable", JsonValue(part.orientable), allocator);
    add_member(value, "inside_out", JsonValue(part.inside_out), allocator);
    add_member(value, "cavity", JsonValue(part.cavity), allocator);
    add_member(value, "euler", JsonValue(static_cast<std::int64_t>(part.euler())), allocator);
    add_member(value, "genus", part.genus() < 0 ? JsonValue() : JsonValue(static_cast<std::int64_t>(part.genus())), allocator);
    add_member(value, "area", JsonValue(part.area), allocator);
    add_member(value, "volume", part.closed() ? JsonValue(part.volume) : JsonValue(), allocator);
    return value;
}

JsonValue size_json(const MeshDiagnosis& d, JsonAllocator& allocator) {
    JsonValue size(rapidjson::kObjectType);
    add_member(size, "area", JsonValue(d.area), allocator);
    add_member(size, "volume", JsonValue(d.volume), allocator);
    if (!d.closed() || !d.oriented())
        add_member(size, "volume_note", "a signed sum only: the mesh is not closed and oriented", allocator);
    add_member(size, "shortest_edge", JsonValue(d.shortest_edge), allocator);
    add_member(size, "mean_edge", JsonValue(d.mean_edge), allocator);
    add_member(size, "longest_edge", JsonValue(d.longest_edge), allocator);
    if (d.edges > 0) {
        JsonValue box(rapidjson::kObjectType), oriented(rapidjson::kObjectType), axes(rapidjson::kArrayType);
        add_member(box, "min", numbers(std::array{d.box.xmin(), d.box.ymin(), d.box.zmin()}, allocator), allocator);
        add_member(box, "max", numbers(std::array{d.box.xmax(), d.box.ymax(), d.box.zmax()}, allocator), allocator);
        add_member(size, "box", std::move(box), allocator);
        add_member(oriented, "centre", numbers(d.oriented_box.centre, allocator), allocator);
        for (const auto& axis : d.oriented_box.axes) axes.PushBack(numbers(axis, allocator), allocator);
        add_member(oriented, "axes", std::move(axes), allocator);
        add_member(oriented, "sides", numbers(d.oriented_box.sides, allocator), allocator);
        add_member(size, "oriented_box", std::move(oriented), allocator);
    }
    add_member(size, "diagonal", JsonValue(d.diagonal), allocator);
    JsonValue unit(rapidjson::kObjectType);
    add_member(unit, "guess", d.unit.unit, allocator);
    add_member(unit, "reason", d.unit.reason, allocator);
    add_member(size, "unit", std::move(unit), allocator);
    return size;
}

}  // namespace

JsonValue to_json(const MeshDiagnosis& d, JsonAllocator& allocator) {
    JsonValue result(rapidjson::kObjectType), defects(rapidjson::kArrayType), components(rapidjson::kArrayType),
        loops(rapidjson::kArrayType), pairs(rapidjson::kArrayType);
    for (const auto& defect : d.defects()) defects.PushBack(json_string(defect, allocator), allocator);
    add_member(result, "sound", JsonValue(d.defects().empty()), allocator);
    add_member(result, "defects", std::move(defects), allocator);
    for (const auto& [name, count] :
         std::initializer_list<std::pair<const char*, std::size_t>>{{"vertices", d.vertices},
                                                                    {"edges", d.edges},
                                                                    {"triangles", d.triangles},
                                                                    {"isolated_vertices", d.isolated_vertices},
                                                                    {"duplicate_vertices", d.duplicate_vertices},
                                                                    {"repeated_corner_triangles", d.repeated_corners},
                                                                    {"degenerate_triangles", d.degenerate_triangles},
                                                                    {"thin_triangles", d.thin_triangles},
                                                                    {"duplicate_triangles", d.duplicate_triangles},
                                                                    {"border_edges", d.border_edges},
                                                                    {"nonmanifold_edges", d.nonmanifold_edges},
                                                                    {"nonmanifold_vertices", d.nonmanifold_vertices},
                                                                    {"misoriented_edges", d.misoriented_edges},
                                                                    {"nonorientable_components", d.nonorientable_components},
                                                                    {"inside_out_components", d.inside_out_components},
                                                                    {"cavities", d.cavities}})
        add_member(result, name, whole(count), allocator);
    add_member(result, "closed", JsonValue(d.closed()), allocator);
    add_member(result, "manifold", JsonValue(d.manifold()), allocator);
    add_member(result, "oriented", JsonValue(d.oriented()), allocator);
    add_member(result, "euler", JsonValue(static_cast<std::int64_t>(d.euler())), allocator);
    add_member(result, "self_intersections", d.self_intersections_checked ? whole(d.self_intersections) : JsonValue(), allocator);
    add_member(result, "self_intersections_complete", JsonValue(d.self_intersections_complete), allocator);
    for (const auto& [a, b] : d.self_intersection_examples) {
        JsonValue pair(rapidjson::kArrayType);
        pair.PushBack(a, allocator).PushBack(b, allocator);
        pairs.PushBack(std::move(pair), allocator);
    }
    add_member(result, "self_intersection_examples", std::move(pairs), allocator);
    add_member(result, "component_count", whole(d.components.size()), allocator);
    for (std::size_t i = 0; i < std::min(listed, d.components.size()); ++i)
        components.PushBack(component_json(d.components[i], allocator), allocator);
    add_member(result, "components", std::move(components), allocator);
    add_member(result, "border_loop_count", whole(d.border_loops.size()), allocator);
    for (std::size_t i = 0; i < std::min(listed, d.border_loops.size()); ++i) {
        JsonValue loop(rapidjson::kObjectType);
        add_member(loop, "edges", whole(d.border_loops[i].edges), allocator);
        add_member(loop, "length", JsonValue(d.border_loops[i].length), allocator);
        loops.PushBack(std::move(loop), allocator);
    }
    add_member(result, "border_loops", std::move(loops), allocator);
    add_member(result, "size", size_json(d, allocator), allocator);
    return result;
}

std::vector<std::pair<std::string, std::string>> rows_of(const MeshDiagnosis& d) {
    std::vector<std::pair<std::string, std::string>> rows;
    const auto add = [&](const char* name, const std::string& value) { rows.emplace_back(name, value); };
    const auto count = [&](const char* name, std::size_t value) { add(name, std::to_string(value)); };
    const auto triple = [](const std::array<double, 3>& v) { return number(v[0]) + " x " + number(v[1]) + " x " + number(v[2]); };
    count("vertices", d.vertices);
    count("edges", d.edges);
    count("triangles", d.triangles);
    count("components", d.components.size());
    add("Euler number", std::to_string(d.euler()));
    std::string genus;
    for (std::size_t i = 0; i < std::min<std::size_t>(8, d.components.size()); ++i)
        genus += (i > 0 ? ", " : "") + (d.components[i].genus() < 0 ? std::string("-") : std::to_string(d.components[i].genus()));
    add("genus", genus + (d.components.size() > 8 ? ", ..." : ""));
    count("border loops", d.border_loops.size());
    if (!d.border_loops.empty()) {
        std::string loops;
        for (std::size_t i = 0; i < std::min<std::size_t>(5, d.border_loops.size()); ++i)
            loops += (i > 0 ? ", " : "") + std::string("length ") + number(d.border_loops[i].length) + " in " +
                     std::to_string(d.border_loops[i].edges) + " edges";
        add("the longest", loops);
    }
    count("non-manifold edges", d.nonmanifold_edges);
    count("non-manifold vertices", d.nonmanifold_vertices);
    count("inconsistently oriented edges", d.misoriented_edges);
    if (d.nonorientable_components > 0) count("components that cannot be oriented", d.nonorientable_components);
    count("components inside out", d.inside_out_components);
    if (d.cavities > 0) count("cavities", d.cavities);
    count("duplicate triangles", d.duplicate_triangles);
    count("triangles without area", d.degenerate_triangles + d.repeated_corners);
    count("thin triangles", d.thin_triangles);
    count("duplicate vertices", d.duplicate_vertices);
    count("isolated vertices", d.isolated_vertices);
    add("self-intersections", !d.self_intersections_checked
                                  ? "not checked"
                                  : (d.self_intersections_complete ? "" : "at least ") + std::to_string(d.self_intersections));
    add("area", number(d.area, 8));
    add("volume", number(d.volume, 8) + (d.closed() && d.oriented() ? "" : " (a signed sum: not closed and oriented)"));
    add("edge length", number(d.shortest_edge) + " to " + number(d.longest_edge) + ", mean " + number(d.mean_edge));
    if (d.edges > 0) {
        add("box", triple({d.box.xmax() - d.box.xmin(), d.box.ymax() - d.box.ymin(), d.box.zmax() - d.box.zmin()}) + " from (" +
                       number(d.box.xmin()) + ", " + number(d.box.ymin()) + ", " + number(d.box.zmin()) + ")");
        add("oriented box", triple(d.oriented_box.sides));
    }
    add("diagonal", number(d.diagonal));
    add("unit, a guess", d.unit.unit + " (" + d.unit.reason + ")");
    std::string verdict;
    for (const auto& defect : d.defects()) verdict += (verdict.empty() ? "" : "; ") + defect;
    add("verdict", verdict.empty() ? (d.self_intersections_checked ? "closed, oriented, manifold, no self-intersection"
                                                                   : "closed, oriented, manifold; self-intersections not checked")
                                   : verdict);
    return rows;
}

void declare_diagnosis(ReportLayout& layout) {
    layout.values(boolean("sound"), texts("defects"));
    for (const char* name :
         {"vertices", "edges", "triangles", "isolated_vertices", "duplicate_vertices", "repeated_corner_triangles",
          "degenerate_triangles", "thin_triangles", "duplicate_triangles", "border_edges", "nonmanifold_edges",
          "nonmanifold_vertices", "misoriented_edges", "nonorientable_components", "inside_out_components", "cavities", "euler",
          "component_count", "border_loop_count"})
        layout.values(integer(name));
    for (const char* name : {"closed", "manifold", "oriented", "self_intersections_complete"}) layout.values(boolean(name));
    for (const char* name : {"self_intersections", "self_intersection_examples", "components", "border_loops", "size"})
        layout.values(any(name));
}

void add_diagnosis(Report& report, const MeshDiagnosis& diagnosis) {
    JsonValue all = to_json(diagnosis, report.allocator());
    for (auto& member : all.GetObject()) report(member.name.GetString(), std::move(member.value));
}

}  // namespace ostraka
