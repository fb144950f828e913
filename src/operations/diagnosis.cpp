#include "operations/diagnosis.h"

#include "ostraka/core/message_text.h"
#include "ostraka/files/json_build.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace ostraka {

using namespace fields;

namespace {

constexpr std::size_t max_listed = 100;

struct DiagnosisCount {
    const char* name;
    std::size_t MeshDiagnosis::*count;
};
using M = MeshDiagnosis;
constexpr DiagnosisCount diagnosis_counts[]{
    {"vertices", &M::vertices},
    {"edges", &M::edges},
    {"triangles", &M::triangles},
    {"isolated_vertices", &M::isolated_vertices},
    {"duplicate_vertices", &M::duplicate_vertices},
    {"repeated_corner_triangles", &M::repeated_corners},
    {"degenerate_triangles", &M::degenerate_triangles},
    {"thin_triangles", &M::thin_triangles},
    {"duplicate_triangles", &M::duplicate_triangles},
    {"border_edges", &M::border_edges},
    {"nonmanifold_edges", &M::nonmanifold_edges},
    {"nonmanifold_vertices", &M::nonmanifold_vertices},
    {"misoriented_edges", &M::misoriented_edges},
    {"nonorientable_components", &M::nonorientable_components},
    {"inside_out_components", &M::inside_out_components},
    {"cavities", &M::cavities},
};

JsonValue component_json(const ComponentDiagnosis& part, JsonAllocator& allocator) {
    return json_object(allocator, "first_vertex", part.first_vertex, "vertices", part.vertices, "triangles", part.triangles,
                       "closed", part.closed(), "manifold", part.manifold(), "orientable", part.orientable, "inside_out",
                       part.inside_out, "cavity", part.cavity, "euler", part.euler(), "genus",
                       part.genus() < 0 ? std::nullopt : std::optional(part.genus()), "area", part.area, "volume",
                       part.closed() ? std::optional(part.volume) : std::nullopt);
}

JsonValue size_json(const MeshDiagnosis& d, JsonAllocator& allocator) {
    JsonValue size = json_object(allocator, "area", d.area, "volume", d.volume);
    if (!d.closed() || !d.oriented())
        add_members(size, allocator, "volume_note", "a signed sum only: the mesh is not closed and oriented");
    add_members(size, allocator, "shortest_edge", d.shortest_edge, "mean_edge", d.mean_edge, "longest_edge", d.longest_edge);
    if (d.edges > 0)
        add_members(
            size, allocator, "box",
            json_object(allocator, "min", std::array{d.box.xmin(), d.box.ymin(), d.box.zmin()}, "max",
                        std::array{d.box.xmax(), d.box.ymax(), d.box.zmax()}),
            "oriented_box",
            json_object(allocator, "centre", d.oriented_box.centre, "axes", d.oriented_box.axes, "sides", d.oriented_box.sides));
    add_members(size, allocator, "diagonal", d.diagonal, "unit",
                json_object(allocator, "guess", d.unit.unit, "reason", d.unit.reason));
    return size;
}

}  // namespace

JsonValue to_json(const MeshDiagnosis& d, JsonAllocator& allocator) {
    JsonValue result = json_object(allocator, "sound", d.defects().empty(), "defects", d.defects());
    for (const auto& [name, count] : diagnosis_counts) add_members(result, allocator, name, d.*count);
    const auto pair = [&](const auto& crossing) { return json_value(std::array{crossing.first, crossing.second}, allocator); };
    const auto component = [&](const ComponentDiagnosis& part) { return component_json(part, allocator); };
    const auto loop = [&](const auto& border_loop) {
        return json_object(allocator, "edges", border_loop.edges, "length", border_loop.length);
    };
    const auto first = [](const auto& items) { return std::span(items).first(std::min(max_listed, items.size())); };
    add_members(result, allocator, "closed", d.closed(), "manifold", d.manifold(), "oriented", d.oriented(), "euler", d.euler(),
                "self_intersections", d.self_intersections_checked ? std::optional(d.self_intersections) : std::nullopt,
                "self_intersections_complete", d.self_intersections_complete, "self_intersection_examples",
                json_list(d.self_intersection_examples, allocator, pair), "component_count", d.components.size(), "components",
                json_list(first(d.components), allocator, component), "border_loop_count", d.border_loops.size(), "border_loops",
                json_list(first(d.border_loops), allocator, loop), "size", size_json(d, allocator));
    return result;
}

std::vector<std::pair<std::string, std::string>> rows_of(const MeshDiagnosis& d) {
    std::vector<std::pair<std::string, std::string>> rows;
    const auto add = [&](const char* name, const ReportText& value) { rows.emplace_back(name, value.text); };
    const auto triple = [](const std::array<double, 3>& v) {
        return fmt::format("{} x {} x {}", number(v[0]), number(v[1]), number(v[2]));
    };
    // Coordinates show digits down to a hundred thousandth of the object's size, however far it lies from the origin.
    const auto place = [&](double x) {
        const double places = d.diagonal > 0 && x != 0 ? std::ceil(std::log10(std::abs(x) / d.diagonal)) : 0;
        return number(x, 5 + static_cast<int>(std::clamp(places, 0.0, 12.0)));
    };
    const auto first = [](const auto& items, std::size_t maximum, const auto& text_of) {
        std::vector<std::string> texts;
        for (std::size_t i = 0; i < std::min(maximum, items.size()); ++i) texts.push_back(text_of(items[i]));
        return joined(texts);
    };
    const auto genus = [](const auto& part) { return part.genus() < 0 ? "-" : std::to_string(part.genus()); };
    const auto loop = [](const auto& border_loop) {
        return fmt::format("length {} in {} edges", number(border_loop.length), border_loop.edges);
    };
    add("vertices", d.vertices);
    add("edges", d.edges);
    add("triangles", d.triangles);
    add("components", d.components.size());
    add("Euler number", d.euler());
    add("genus", first(d.components, 8, genus) + (d.components.size() > 8 ? ", ..." : ""));
    add("border loops", d.border_loops.size());
    if (!d.border_loops.empty()) add("the longest", first(d.border_loops, 5, loop));
    add("non-manifold edges", d.nonmanifold_edges);
    add("non-manifold vertices", d.nonmanifold_vertices);
    add("inconsistently oriented edges", d.misoriented_edges);
    if (d.nonorientable_components > 0) add("components that cannot be oriented", d.nonorientable_components);
    add("components inside out", d.inside_out_components);
    if (d.cavities > 0) add("cavities", d.cavities);
    add("duplicate triangles", d.duplicate_triangles);
    add("triangles without area", d.degenerate_triangles + d.repeated_corners);
    add("thin triangles", d.thin_triangles);
    add("duplicate vertices", d.duplicate_vertices);
    add("isolated vertices", d.isolated_vertices);
    add("self-intersections", !d.self_intersections_checked
                                  ? "not checked"
                                  : (d.self_intersections_complete ? "" : "at least ") + std::to_string(d.self_intersections));
    add("area", number(d.area, 8));
    add("volume", number(d.volume, 8) + (d.closed() && d.oriented() ? "" : " (a signed sum: not closed and oriented)"));
    add("edge length", fmt::format("{} to {}, mean {}", number(d.shortest_edge), number(d.longest_edge), number(d.mean_edge)));
    if (d.edges > 0) {
        add("box", fmt::format("{} from ({}, {}, {})",
                               triple({d.box.xmax() - d.box.xmin(), d.box.ymax() - d.box.ymin(), d.box.zmax() - d.box.zmin()}),
                               place(d.box.xmin()), place(d.box.ymin()), place(d.box.zmin())));
        add("oriented box", triple(d.oriented_box.sides));
    }
    add("diagonal", number(d.diagonal));
    add("unit (guessed)", fmt::format("{} ({})", d.unit.unit, d.unit.reason));
    const std::string verdict = joined(d.defects(), "; ");
    add("verdict", verdict.empty() ? (d.self_intersections_checked ? "closed, oriented, manifold, no self-intersection"
                                                                   : "closed, oriented, manifold; self-intersections not checked")
                                   : verdict);
    return rows;
}

void declare_diagnosis(ReportLayout& layout) {
    layout.values(boolean("sound"), texts("defects"));
    for (const auto& diagnosis_count : diagnosis_counts) layout.values(integer(diagnosis_count.name));
    layout.values(integer("euler"), integer("component_count"), integer("border_loop_count"), boolean("closed"),
                  boolean("manifold"), boolean("oriented"), boolean("self_intersections_complete"), any("self_intersections"),
                  any("self_intersection_examples"), any("components"), any("border_loops"), any("size"));
}

std::vector<std::string> attributes_in_words(const MeshExtras& extras) {
    std::vector<std::string> names;
    if (!extras.vertex_colours.empty()) names.emplace_back("vertex colours");
    if (!extras.face_colours.empty()) names.emplace_back("face colours");
    if (!extras.vertex_labels.empty()) names.emplace_back("vertex labels");
    if (!extras.face_labels.empty()) names.emplace_back("face labels");
    if (!extras.corner_texture.empty()) names.emplace_back("texture coordinates");
    if (!extras.appearance.materials.empty()) names.push_back(counted(extras.appearance.materials.size(), "material"));
    for (const SharedImage& image : extras.appearance.images) {
        if (!image) names.emplace_back("an image that is missing");
        else
            names.push_back(fmt::format("{} of {} x {}", image->name.empty() ? "an image" : "image " + printable(image->name, 60),
                                        image->width, image->height));
    }
    for (const NamedValues& column : extras.vertex_values)
        names.push_back(fmt::format("values '{}' of vertices", printable(column.name, 60)));
    for (const NamedValues& column : extras.face_values)
        names.push_back(fmt::format("values '{}' of faces", printable(column.name, 60)));
    return names;
}

}  // namespace ostraka
