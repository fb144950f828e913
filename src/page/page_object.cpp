#include "ostraka/page/page.h"

#include "page/appearance.h"
#include "page/geometry.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/core/message_text.h"
#include "ostraka/files/json_build.h"
#include "ostraka/files/provenance.h"
#include "ostraka/geom/shortest_path.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/measure/measure.h"
#include "ostraka/mesh/limits.h"
#include "ostraka/relation/layout.h"
#include "ostraka/render/colour_scale.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace ostraka {

namespace {

constexpr std::uint16_t no_value = 65535;

using Keep = KeepBytes;
using Relative = std::function<std::array<double, 3>(std::array<double, 3>)>;

using Triple = std::array<double, 3>;

Triple triple(const Point& p) { return {p.x(), p.y(), p.z()}; }

struct Box {
    Triple low{0, 0, 0}, size{0, 0, 0};
    [[nodiscard]] double largest() const { return *std::max_element(size.begin(), size.end()); }
};

Box box_of(const TriangleSoup& soup) {
    Box box;
    Triple high = box.low = soup.points.front();
    for (const Triple& p : soup.points)
        for (std::size_t k = 0; k < 3; ++k) {
            box.low[k] = std::min(box.low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    for (std::size_t k = 0; k < 3; ++k) box.size[k] = high[k] - box.low[k];
    return box;
}

/// Colours at equal steps of a scale, to be interpolated linearly.
std::vector<std::array<int, 3>> colours_of(const ColourScale& scale) {
    constexpr int steps = 8;
    std::vector<std::array<int, 3>> colours;
    for (int i = 0; i <= steps; ++i) {
        const Rgb colour = colour_of(scale, scale.minimum + (scale.maximum - scale.minimum) * i / steps);
        colours.push_back({colour.red, colour.green, colour.blue});
    }
    return colours;
}

/// Range of the colours: all values or, if there are outliers, the range that contains 98 % of them.
std::pair<double, double> coloured_range(const std::vector<double>& values, const ColourScale& scale) {
    std::vector<double> sorted;
    for (const double value : values)
        if (std::isfinite(value)) sorted.push_back(value);
    std::sort(sorted.begin(), sorted.end());
    const auto last = static_cast<double>(sorted.size() - 1);
    double low = sorted[static_cast<std::size_t>(0.01 * last)], high = sorted[static_cast<std::size_t>(std::ceil(0.99 * last))];
    if (scale.diverging) high = std::max(std::abs(low), std::abs(high)), low = -high;
    return 2 * (high - low) < scale.maximum - scale.minimum && high > low ? std::pair(low, high)
                                                                          : std::pair(scale.minimum, scale.maximum);
}

std::string values_text(const Descriptor& descriptor) {
    if (!descriptor.file.empty()) return descriptor.file;
    constexpr std::size_t max_values = 12;
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < std::min(max_values, descriptor.values.size()); ++i)
        texts.push_back(digits(descriptor.values[i], 5));
    if (descriptor.values.size() > max_values) texts.emplace_back("...");
    return joined(texts, ", ") + (descriptor.unit.empty() ? "" : " " + descriptor.unit);
}

std::string_view bytes_of(const auto& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof values.front()};
}

/// Adds exact positions, in single precision relative to the box, and triangles.
void add_exact(JsonValue& entry, const TriangleSoup& soup, const Triple& low, const Keep& keep, JsonAllocator& allocator) {
    std::vector<float> places;
    places.reserve(3 * soup.points.size());
    for (const Triple& p : soup.points)
        for (std::size_t k = 0; k < 3; ++k) places.push_back(static_cast<float>(p[k] - low[k]));
    add_members(entry, allocator, "positions", keep(bytes_of(places)), "triangles", keep(bytes_of(soup.triangles)));
}

/// The points of a curve, lifted slightly off the surface so that the curve is not partly inside.
std::vector<Point> lifted_points(const Mesh& mesh, const SurfaceCurve& curve) {
    const double step = 0.002 * box_diagonal(mesh);
    std::vector<Point> places;
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
        const Point p = position(mesh, curve.points[i]);
        Vector normal(0, 0, 0);
        if (curve.faces.empty()) {
            for (const Face f : faces_of(mesh, curve.points[i])) normal += area_vector(mesh, f);
        } else {
            const auto [a, b, c] = corners(mesh, Face(curve.faces[std::min(i, curve.faces.size() - 1)]));
            const auto weight = nearest_barycentric(mesh.point(a), mesh.point(b), mesh.point(c), p);
            normal = weight[0] * vertex_normal(mesh, a) + weight[1] * vertex_normal(mesh, b) + weight[2] * vertex_normal(mesh, c);
        }
        places.push_back(p + step * unit_vector(normal));
    }
    return places;
}

JsonValue annotations_json(AnnotatedMeshView object, const ContainmentOrder& order, const Relative& relative, const Keep& keep,
                           JsonAllocator& allocator) {
    const auto& parents = order.parent;
    PathSearch paths(object.mesh);
    JsonValue annotations(rapidjson::kArrayType);
    for (std::size_t i = 0; i < object.annotations.annotations.size(); ++i) {
        const Annotation& annotation = object.annotations.annotations[i];
        JsonValue measures(rapidjson::kArrayType), attributes(rapidjson::kArrayType);
        for (const Attribute& attribute : annotation.attributes) {
            if (const Measure* measure = attribute.measure()) {
                JsonValue entry = json_object(
                    allocator, "name", attribute.name, "tool", measure->tool, "value", measure->value, "unit", measure->unit,
                    "pins",
                    json_list(pins_of(object.mesh, *measure), allocator, [&](const Point& p) { return relative(triple(p)); }));
                const auto measured_path = json_list(path_of_measure(paths, object.mesh, *measure), allocator,
                                                     [&](const Point& at) { return relative(triple(at)); });
                add_nonempty_members(entry, allocator, "way", measured_path);
                if (measure->uncertainty) add_members(entry, allocator, "uncertainty", *measure->uncertainty);
                add_nonempty_members(entry, allocator, "stale", measure->stale);
                measures.PushBack(entry, allocator);
            } else {
                const Note* note = attribute.note();
                attributes.PushBack(json_object(allocator, "name", attribute.name, "text",
                                                note != nullptr ? note->text : values_text(*attribute.descriptor())),
                                    allocator);
            }
        }
        JsonValue entry = json_object(allocator, "id", annotation.id, "tag", annotation.tag, "type", to_string(annotation.type),
                                      "colour", annotation.colour, "parent", parents[i] ? static_cast<int>(*parents[i]) : -1,
                                      "attributes", std::move(attributes), "measures", std::move(measures));
        add_nonempty_members(entry, allocator, "note", annotation.note);
        if (annotation.type == AnnotationType::region)
            add_members(entry, allocator, "faces",
                        json_object(allocator, "count", annotation.faces.size(), "blob", keep(runs_of(annotation.faces))));
        else if (annotation.type == AnnotationType::line) add_members(entry, allocator, "lines", annotation.polylines);
        else add_members(entry, allocator, "points", annotation.points);
        if (is_free(annotation))
            add_members(entry, allocator, "curves",
                        json_list(curves_on(object.mesh, annotation), allocator, [&](const SurfaceCurve& curve) {
                            return json_list(lifted_points(object.mesh, curve), allocator,
                                             [&](const Point& p) { return relative(triple(p)); });
                        }));
        annotations.PushBack(entry, allocator);
    }
    return annotations;
}

/// Values as 16-bit steps: numbers between the ends of the scale, or indices of categories.
JsonValue map_json(const PageMap& map, const Keep& keep, JsonAllocator& allocator) {
    std::vector<std::uint16_t> steps;
    const auto bytes_of_steps = [&] { return std::string_view(reinterpret_cast<const char*>(steps.data()), 2 * steps.size()); };
    JsonValue entry = json_object(allocator, "name", map.name, "label", map.label.empty() ? map.name : map.label);
    if (!map.categories.empty()) {
        std::vector<std::size_t> counts(map.categories.size(), 0);
        for (const double value : map.values) {
            const bool has_category = value >= 0 && value < static_cast<double>(counts.size());
            steps.push_back(has_category ? static_cast<std::uint16_t>(value) : no_value);
            if (has_category) ++counts[steps.back()];
        }
        const auto last = static_cast<double>(counts.size() - 1);
        add_members(entry, allocator, "blob", keep(bytes_of_steps()), "minimum", 0, "maximum", last, "from", 0, "to", last,
                    "colours", std::vector<int>(), "histogram", counts, "categories",
                    json_list(map.categories, allocator, [&](const PageMap::Category& category) {
                        return json_object(allocator, "text", category.text, "colour", category.colour);
                    }));
        return entry;
    }
    const ColourScale scale = scale_of({&map.values}, map.name);
    const double range = scale.maximum - scale.minimum;
    const auto [coloured_low, coloured_high] = coloured_range(map.values, scale);
    std::vector<std::size_t> histogram(40, 0);
    for (const double value : map.values) {
        if (!std::isfinite(value)) {
            steps.push_back(no_value);
            continue;
        }
        const double fraction = range > 0 ? std::clamp((value - scale.minimum) / range, 0.0, 1.0) : 0.5;
        steps.push_back(static_cast<std::uint16_t>(std::lround(fraction * (no_value - 1))));
        const double place =
            coloured_high > coloured_low ? std::clamp((value - coloured_low) / (coloured_high - coloured_low), 0.0, 1.0) : 0.5;
        ++histogram[std::min(histogram.size() - 1, static_cast<std::size_t>(place * static_cast<double>(histogram.size())))];
    }
    add_members(entry, allocator, "blob", keep(bytes_of_steps()), "minimum", scale.minimum, "maximum", scale.maximum, "from",
                coloured_low, "to", coloured_high, "colours", colours_of(scale), "histogram", histogram);
    return entry;
}

JsonValue relations_json(const PageObject& object, const AnnotationSet& set, const GraphLayout& layout,
                         JsonAllocator& allocator) {
    JsonValue relations(rapidjson::kArrayType);
    if (object.graph != nullptr)
        for (std::size_t r = 0; r < object.graph->relationships.size(); ++r) {
            const Relationship& relationship = object.graph->relationships[r];
            std::vector<std::size_t> members;
            for (const int id : relationship.annotations)
                for (std::size_t i = 0; i < set.annotations.size(); ++i)
                    if (set.annotations[i].id == id) members.push_back(i);
            JsonValue entry = json_object(allocator, "id", relationship.id, "type", relationship.type, "members", members,
                                          "directed", relationship.directed, "constraint", relationship.is_constraint, "weight",
                                          relationship.weight, "text", "");
            if (layout.lanes[r]) add_members(entry, allocator, "lane", *layout.lanes[r]);
            if (r < object.checks.size() && object.checks[r].verdict != Verdict::unknown) {
                add_members(entry, allocator, "holds", object.checks[r].verdict == Verdict::holds);
                entry["text"] = json_string(object.checks[r].text, allocator);
            }
            relations.PushBack(entry, allocator);
        }
    return relations;
}

JsonValue constraint_json(const PageConstraint& constraint, JsonAllocator& allocator) {
    JsonValue entry =
        json_object(allocator, "type", constraint.type, "members", constraint.members, "weight", constraint.weight, "hard",
                    constraint.hard, "before", constraint.before, "verdict", constraint.verdict, "text", constraint.text,
                    "deviations", json_list(constraint.deviations, allocator, [&](const PageConstraint::Deviation& d) {
                        return json_object(allocator, "quantity", d.quantity, "before", d.before, "value", d.value, "tolerance",
                                           d.tolerance, "unit", d.unit);
                    }));
    if (constraint.holds) add_members(entry, allocator, "holds", *constraint.holds);
    if (constraint.residual)
        add_members(entry, allocator, "residual",
                    json_object(allocator, "mean", (*constraint.residual)[0], "largest", (*constraint.residual)[1]));
    return entry;
}

JsonValue verdict_json(const PageVerdict& verdict, JsonAllocator& allocator) {
    JsonValue entry =
        json_object(allocator, "kind", verdict.kind, "name", verdict.name, "members", verdict.members, "text", verdict.text);
    if (verdict.holds) add_members(entry, allocator, "holds", *verdict.holds);
    return entry;
}

JsonValue slices_json(const PageSlices& slices, const Relative& relative, const Keep& keep, JsonAllocator& allocator) {
    std::vector<float> places;
    JsonValue levels(rapidjson::kArrayType);
    for (const PageSlices::Level& level : slices.levels) {
        JsonValue contours(rapidjson::kArrayType);
        for (const PageSlices::Contour& contour : level.contours) {
            for (const auto& [u, v] : contour.points) {
                places.push_back(static_cast<float>(u));
                places.push_back(static_cast<float>(v));
            }
            contours.PushBack(
                json_object(allocator, "points", contour.points.size(), "closed", contour.closed, "hole", contour.hole),
                allocator);
        }
        levels.PushBack(json_object(allocator, "height", level.height, "origin", relative(level.origin), "u", level.u, "v",
                                    level.v, "values", level.values, "contours", std::move(contours)),
                        allocator);
    }
    JsonValue columns = json_list(slices.columns, allocator, [&](const PageSlices::Column& column) {
        return json_object(allocator, "name", column.name, "title", column.title, "unit", column.unit);
    });
    const std::string_view bytes(reinterpret_cast<const char*>(places.data()), places.size() * sizeof(float));
    JsonValue entry = json_object(allocator, "unit", slices.unit, "columns", std::move(columns), "levels", std::move(levels),
                                  "blob", keep(bytes));
    if (slices.tube) add_members(entry, allocator, "tube", *slices.tube);
    return entry;
}

}  // namespace

void Page::add_look(JsonValue& entry, const MeshExtras& extras, const std::optional<io::TexturedVertices>& textured, bool exact,
                    const std::string& name) {
    auto& allocator = document_.GetAllocator();
    const Keep keep = [this](std::string_view bytes) { return add_bytes(bytes); };
    if (JsonValue colours = colours_json(extras, keep, allocator); colours.IsObject())
        add_members(entry, allocator, "colours", std::move(colours));
    if (!has_texture(extras)) return;
    std::vector<std::string> notes;
    JsonValue texture = materials_json(extras, name, keep, allocator, notes);
    if (textured && exact)
        add_members(texture, allocator, "vertices", keep(bytes_of(textured->vertex)), "places", keep(bytes_of(textured->texture)),
                    "corners", keep(bytes_of(textured->pair_of_corner)));
    add_members(entry, allocator, "texture", std::move(texture));
    for (const std::string& text : notes) note(text);
}

std::size_t Page::add(const PageObject& object) {
    auto& allocator = document_.GetAllocator();
    const Mesh& mesh = *object.mesh;
    const TriangleSoup soup = to_soup(mesh);
    if (soup.triangles.empty()) fail_input(object.name, "has no triangles", "give a mesh");
    const Box box = box_of(soup);
    const Relative relative = [&](Triple p) {
        for (std::size_t k = 0; k < 3; ++k) p[k] -= box.low[k];
        return p;
    };
    const Keep keep = [this](std::string_view bytes) { return add_bytes(bytes); };
    const AnnotationSet no_annotations;
    const AnnotationSet& set = object.annotations != nullptr ? *object.annotations : no_annotations;
    const ContainmentOrder order = topology({mesh, set}).order;
    JsonValue annotations = annotations_json({mesh, set}, order, relative, keep, allocator);
    JsonValue maps(rapidjson::kArrayType);
    for (const PageMap& map : object.maps) {
        if (map.values.size() != soup.points.size())
            fail_input(map.name, fmt::format("holds {} values for {} vertices", map.values.size(), soup.points.size()),
                       "give a map with one number per vertex");
        maps.PushBack(map_json(map, keep, allocator), allocator);
    }
    const std::string unit = !object.unit.empty() ? object.unit : set.unit;
    const RelationGraph empty_graph;
    const GraphLayout layout = layout_of(object.graph != nullptr ? *object.graph : empty_graph, set, order);
    JsonValue tree = json_list(layout.rows, allocator, [&](const TreeEntry& row) {
        return json_object(allocator, "annotation", row.annotation, "depth", row.depth);
    });
    JsonValue entry =
        json_object(allocator, "name", printable(object.name, 200), "unit", unit, "vertices",
                    object.whole ? object.whole->vertices : soup.points.size(), "faces",
                    object.whole ? object.whole->faces : soup.triangles.size(), "origin", box.low, "size", box.size, "up",
                    set.up ? *set.up : object.up, "annotations", std::move(annotations), "maps", std::move(maps), "tree",
                    std::move(tree), "relations", relations_json(object, set, layout, allocator));
    const MeshExtras no_extras;
    const MeshExtras& extras = object.extras != nullptr ? *object.extras : no_extras;
    check_extras(extras, soup, object.name);
    // Packed, or exact for the viewer started by the command.
    const auto add_shape = [&](JsonValue& target, const TriangleSoup& shape, const Box& bounding_box, const std::string& part,
                               const MeshExtras& look) {
        std::optional<io::TexturedVertices> textured;
        if (has_texture(look) && !look.corner_texture.empty() && (!object.exact || object.exact->sends_shape))
            textured = io::textured_vertices(shape, look.corner_texture);
        JsonValue exact(rapidjson::kObjectType);
        JsonValue& holder = object.exact ? exact : target;  // of what is sent once
        if (!object.exact) {
            add_members(
                target, allocator, "geometry",
                add_bytes(quantised_glb(shape, bounding_box.low, bounding_box.largest(), textured ? &*textured : nullptr)));
        } else {
            add_members(exact, allocator, "key", object.exact->key + part);
            if (object.exact->sends_shape) add_exact(exact, shape, bounding_box.low, keep, allocator);
        }
        if (!object.exact || object.exact->sends_shape) add_look(holder, look, textured, object.exact.has_value(), object.name);
        if (object.exact) add_members(target, allocator, "shape", std::move(exact));
    };
    add_shape(entry, soup, box, "", extras);
    if (object.colouring != "auto") add_members(entry, allocator, "colouring", object.colouring);
    add_nonempty_members(entry, allocator, "constraints",
                         json_list(object.constraints, allocator,
                                   [&](const PageConstraint& constraint) { return constraint_json(constraint, allocator); }));
    add_nonempty_members(entry, allocator, "conflicts", object.conflicts);
    add_nonempty_members(
        entry, allocator, "conformance",
        json_list(object.conformance, allocator, [&](const PageVerdict& verdict) { return verdict_json(verdict, allocator); }));
    add_nonempty_members(entry, allocator, "parts", object.parts);
    if (object.slices != nullptr) add_members(entry, allocator, "slices", slices_json(*object.slices, relative, keep, allocator));
    if (object.whole)
        add_members(entry, allocator, "simplified",
                    json_object(allocator, "vertices", soup.points.size(), "deviation", object.whole->deviation));
    if (object.cage != nullptr) {
        // Relative to the object's box; the positions of the cage start below its lower corner.
        TriangleSoup cage = to_soup(*object.cage);
        const Box bounding_box = box_of(cage);
        JsonValue cage_entry = json_object(allocator, "vertices", cage.points.size(), "origin", relative(bounding_box.low));
        add_shape(cage_entry, cage, bounding_box, "-cage", no_extras);
        add_members(entry, allocator, "cage", std::move(cage_entry));
    }
    const std::string_view corner_bytes(reinterpret_cast<const char*>(soup.triangles.data()),
                                        soup.triangles.size() * sizeof soup.triangles.front());
    const std::string checksum = sha256(std::string(corner_bytes));
    if (const auto same_triangles = std::find(triangles_.begin(), triangles_.end(), checksum);
        same_triangles != triangles_.end()) {
        const auto first = static_cast<rapidjson::SizeType>(same_triangles - triangles_.begin());
        if (!objects_[first].HasMember("blend")) add_members(objects_[first], allocator, "blend", first);
        add_members(entry, allocator, "blend", first);
    }
    triangles_.push_back(checksum);
    objects_.PushBack(entry, allocator);
    return objects_.Size() - 1;
}

}  // namespace ostraka
