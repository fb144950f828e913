#include "ostraka/page/page.h"

#include "geometry.h"
#include "viewer.h"

#include "ostraka/core/json_build.h"
#include "ostraka/core/markup.h"
#include "ostraka/core/provenance.h"
#include "ostraka/core/words.h"
#include "ostraka/geom/shortest_path.h"
#include "ostraka/measure/measure.h"
#include "ostraka/relation/topology.h"
#include "ostraka/render/colour_scale.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

constexpr std::uint16_t no_value = 65535;

std::string deflated(std::string_view bytes) {
    uLongf size = ::compressBound(bytes.size());
    std::string packed(size, '\0');
    const int done = ::compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                                 bytes.size(), 6);
    if (done != Z_OK) fail_work("the page", "its bytes cannot be compressed", "show less on one page");
    packed.resize(size);
    return packed;
}

std::string base64(std::string_view bytes) {
    static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto byte = [&](std::size_t k) {
            return i + k < bytes.size() ? static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i + k])) : 0U;
        };
        const std::uint32_t word = byte(0) << 16U | byte(1) << 8U | byte(2);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k <= bytes.size() ? letters[word >> (18U - 6U * static_cast<unsigned>(k)) & 63U] : '=';
    }
    return text;
}

void add_number(std::string& bytes, std::size_t value) {
    for (; value >= 128; value /= 128) bytes += static_cast<char>(value % 128 + 128);
    bytes += static_cast<char>(value);
}

/// Ascending numbers as gaps and runs.
std::string runs_of(const std::vector<Index>& faces) {
    std::string bytes;
    std::size_t at = 0;
    for (std::size_t i = 0; i < faces.size();) {
        std::size_t end = i + 1;
        while (end < faces.size() && faces[end] == faces[end - 1] + 1) ++end;
        add_number(bytes, faces[i] - at);
        add_number(bytes, end - i);
        at = faces[end - 1] + std::size_t{1};
        i = end;
    }
    return bytes;
}

using Triple = std::array<double, 3>;

Triple triple(const Point& p) { return {p.x(), p.y(), p.z()}; }

/// Where the pins of a measure are. A bounding measure goes from its first pin straight to the plane of the other.
std::vector<Triple> pins_of_measure(const Mesh& mesh, const Measure& measure) {
    std::vector<Triple> pins;
    for (std::size_t i = 0; i < measure.points.size(); ++i) {
        if (i < measure.locations.size() && measure.locations[i].face != no_index) {
            const auto& [face, weights] = measure.locations[i];
            Triple at{0, 0, 0};
            const auto vertices = corners(mesh, Face(face));
            for (std::size_t c = 0; c < 3; ++c)
                for (std::size_t k = 0; k < 3; ++k) at[k] += weights[c] * triple(mesh.point(vertices[c]))[k];
            pins.push_back(at);
        } else {
            pins.push_back(triple(mesh.point(Vertex(measure.points[i]))));
        }
    }
    if (measure.tool == "bounding" && measure.direction && pins.size() == 2) {
        const Triple& d = *measure.direction;
        double along = 0, length = 0;
        for (std::size_t k = 0; k < 3; ++k) along += (pins[1][k] - pins[0][k]) * d[k], length += d[k] * d[k];
        for (std::size_t k = 0; length > 0 && k < 3; ++k) pins[1][k] = pins[0][k] + along / length * d[k];
    }
    return pins;
}

/// What a measure runs along: the edges between the pins of a tape along them; empty for others.
std::vector<Triple> way_of(PathSearch& search, const Mesh& mesh, const Measure& measure) {
    std::vector<Triple> way;
    if (measure.tool != "tape" || measure.exact || !measure.locations.empty()) return way;
    for (std::size_t i = 1; i < measure.points.size(); ++i)
        for (const Index v : search.find(Vertex(measure.points[i - 1]), Vertex(measure.points[i]), {}))
            way.push_back(triple(mesh.point(Vertex(v))));
    return way;
}

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

/// Colours at even steps of a scale; it is linear between them.
std::vector<std::array<int, 3>> colours_of(const ColourScale& scale) {
    constexpr int steps = 8;
    std::vector<std::array<int, 3>> colours;
    for (int i = 0; i <= steps; ++i) {
        const Rgb colour = colour_of(scale, scale.minimum + (scale.maximum - scale.minimum) * i / steps);
        colours.push_back({colour.red, colour.green, colour.blue});
    }
    return colours;
}

/// What the colours go over: all values, or, where a few lie far out, what holds 98 % of them.
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
    constexpr std::size_t most = 12;
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < std::min(most, descriptor.values.size()); ++i) texts.push_back(digits(descriptor.values[i], 5));
    if (descriptor.values.size() > most) texts.emplace_back("...");
    return joined(texts, ", ") + (descriptor.unit.empty() ? "" : " " + descriptor.unit);
}

}  // namespace

Page::Page(std::string title) {
    document_.SetObject();
    add_members(document_, document_.GetAllocator(), "version", 1, "title", printable(title, 200));
}

std::size_t Page::add_bytes(std::string_view bytes) {
    bytes_.resize((bytes_.size() + 7) / 8 * 8, '\0');
    places_.PushBack(json_value(std::array{bytes_.size(), bytes.size()}, document_.GetAllocator()), document_.GetAllocator());
    bytes_ += bytes;
    return places_.Size() - 1;
}

std::size_t Page::add(const PageObject& object) {
    auto& allocator = document_.GetAllocator();
    const Mesh& mesh = *object.mesh;
    const TriangleSoup soup = to_soup(mesh);
    if (soup.triangles.empty()) fail_input(object.name, "has no triangles", "give a mesh");
    const Box box = box_of(soup);
    const auto relative = [&](Triple p) {
        for (std::size_t k = 0; k < 3; ++k) p[k] -= box.low[k];
        return p;
    };

    const AnnotationSet none;
    const AnnotationSet& set = object.annotations != nullptr ? *object.annotations : none;
    const auto parents = topology(mesh, set).order.parent;
    PathSearch paths(mesh);
    JsonValue annotations(rapidjson::kArrayType);
    for (std::size_t i = 0; i < set.annotations.size(); ++i) {
        const Annotation& one = set.annotations[i];
        JsonValue measures(rapidjson::kArrayType), attributes(rapidjson::kArrayType);
        for (const Attribute& attribute : one.attributes) {
            if (attribute.type == AttributeType::measure) {
                const Measure& measure = attribute.measure;
                JsonValue entry = json_object(
                    allocator, "name", attribute.name, "tool", measure.tool, "value", measure.value, "unit", measure.unit, "pins",
                    json_list(pins_of_measure(mesh, measure), allocator, [&](const Triple& p) { return relative(p); }));
                const auto way =
                    json_list(way_of(paths, mesh, measure), allocator, [&](const Triple& at) { return relative(at); });
                add_given(entry, allocator, "way", way);
                if (measure.uncertainty) add_members(entry, allocator, "uncertainty", *measure.uncertainty);
                add_given(entry, allocator, "stale", measure.stale);
                measures.PushBack(entry, allocator);
            } else {
                const bool is_word = attribute.type == AttributeType::semantic;
                attributes.PushBack(json_object(allocator, "name", attribute.name, "text",
                                                is_word ? attribute.note : values_text(attribute.descriptor)),
                                    allocator);
            }
        }
        JsonValue entry = json_object(allocator, "id", one.id, "tag", one.tag, "type", to_string(one.type), "colour", one.colour,
                                      "parent", parents[i] ? static_cast<int>(*parents[i]) : -1, "attributes",
                                      std::move(attributes), "measures", std::move(measures));
        add_given(entry, allocator, "note", one.note);
        if (one.type == AnnotationType::region)
            add_members(entry, allocator, "faces",
                        json_object(allocator, "count", one.faces.size(), "blob", add_bytes(runs_of(one.faces))));
        else if (one.type == AnnotationType::line) add_members(entry, allocator, "lines", one.polylines);
        else add_members(entry, allocator, "points", one.points);
        annotations.PushBack(entry, allocator);
    }

    JsonValue maps(rapidjson::kArrayType);
    for (const PageMap& map : object.maps) {
        if (map.values.size() != soup.points.size())
            fail_input(
                map.name,
                "holds " + std::to_string(map.values.size()) + " values for " + std::to_string(soup.points.size()) + " vertices",
                "give a map with a number for each vertex");
        const ColourScale scale = scale_of({&map.values}, map.name);
        const double range = scale.maximum - scale.minimum;
        const auto [from, to] = coloured_range(map.values, scale);
        std::vector<std::uint16_t> steps;
        std::vector<std::size_t> histogram(40, 0);
        for (const double value : map.values) {
            if (!std::isfinite(value)) {
                steps.push_back(no_value);
                continue;
            }
            const double share = range > 0 ? std::clamp((value - scale.minimum) / range, 0.0, 1.0) : 0.5;
            steps.push_back(static_cast<std::uint16_t>(std::lround(share * (no_value - 1))));
            const double place = to > from ? std::clamp((value - from) / (to - from), 0.0, 1.0) : 0.5;
            ++histogram[std::min(histogram.size() - 1, static_cast<std::size_t>(place * static_cast<double>(histogram.size())))];
        }
        const std::string_view bytes(reinterpret_cast<const char*>(steps.data()), 2 * steps.size());
        maps.PushBack(json_object(allocator, "name", map.name, "label", map.label.empty() ? map.name : map.label, "blob",
                                  add_bytes(bytes), "minimum", scale.minimum, "maximum", scale.maximum, "from", from, "to", to,
                                  "colours", colours_of(scale), "histogram", histogram),
                      allocator);
    }

    JsonValue relations(rapidjson::kArrayType);
    if (object.graph != nullptr)
        for (std::size_t r = 0; r < object.graph->relationships.size(); ++r) {
            const Relationship& one = object.graph->relationships[r];
            std::vector<std::size_t> members;
            for (const int id : one.annotations)
                for (std::size_t i = 0; i < set.annotations.size(); ++i)
                    if (set.annotations[i].id == id) members.push_back(i);
            JsonValue entry = json_object(allocator, "type", one.type, "members", members, "directed", one.directed, "constraint",
                                          one.is_constraint, "weight", one.weight, "text", "");
            if (r < object.checks.size() && object.checks[r].verdict != Verdict::unknown) {
                add_members(entry, allocator, "holds", object.checks[r].verdict == Verdict::holds);
                entry["text"] = json_string(object.checks[r].text, allocator);
            }
            relations.PushBack(entry, allocator);
        }

    const std::string unit = !object.unit.empty() ? object.unit : set.unit;
    JsonValue entry =
        json_object(allocator, "name", printable(object.name, 200), "unit", unit, "vertices",
                    object.whole ? object.whole->vertices : soup.points.size(), "faces",
                    object.whole ? object.whole->faces : soup.triangles.size(), "origin", box.low, "size", box.size, "up",
                    set.up ? *set.up : object.up, "geometry", add_bytes(quantised_glb(soup, box.low, box.largest())),
                    "annotations", std::move(annotations), "maps", std::move(maps), "relations", std::move(relations));
    if (object.whole)
        add_members(entry, allocator, "simplified",
                    json_object(allocator, "vertices", soup.points.size(), "deviation", object.whole->deviation));
    if (object.cage != nullptr) {
        // In the object's own frame, which its steps begin below.
        TriangleSoup cage = to_soup(*object.cage);
        const Box around = box_of(cage);
        add_members(entry, allocator, "cage",
                    json_object(allocator, "geometry", add_bytes(quantised_glb(cage, around.low, around.largest())), "vertices",
                                cage.points.size(), "origin", relative(around.low)));
    }
    const std::string_view corner_bytes(reinterpret_cast<const char*>(soup.triangles.data()),
                                        soup.triangles.size() * sizeof soup.triangles.front());
    const std::string checksum = sha256(std::string(corner_bytes));
    if (const auto like = std::find(triangles_.begin(), triangles_.end(), checksum); like != triangles_.end()) {
        const auto first = static_cast<rapidjson::SizeType>(like - triangles_.begin());
        if (!objects_[first].HasMember("blend")) add_members(objects_[first], allocator, "blend", first);
        add_members(entry, allocator, "blend", first);
    }
    triangles_.push_back(checksum);
    objects_.PushBack(entry, allocator);
    return objects_.Size() - 1;
}

void Page::add(PageTable table) {
    auto& allocator = document_.GetAllocator();
    JsonValue rows(rapidjson::kArrayType), columns(rapidjson::kArrayType);
    std::vector<int> objects, annotations;
    bool linked = false, deep = false;
    std::vector<bool> numeric(table.columns.size(), true);
    for (const PageTable::Row& row : table.rows) {
        for (std::size_t k = 0; k < row.cells.size() && k < numeric.size(); ++k)
            numeric[k] = numeric[k] && (row.cells[k].IsNumber() || row.cells[k].IsNull());
        rows.PushBack(json_list(row.cells, allocator, [](const Json& cell) -> const JsonValue& { return cell; }), allocator);
        objects.push_back(row.object);
        annotations.push_back(row.annotation);
        linked = linked || row.object >= 0;
        deep = deep || row.annotation >= 0;
    }
    for (std::size_t k = 0; k < table.columns.size(); ++k)
        columns.PushBack(json_object(allocator, "title", table.columns[k], "numeric", static_cast<bool>(numeric[k])), allocator);
    JsonValue entry = json_object(allocator, "name", "table-" + std::to_string(tables_.Size()), "title", table.title, "note",
                                  table.note, "columns", std::move(columns), "rows", std::move(rows));
    if (linked) add_members(entry, allocator, "objects", objects);
    if (deep) add_members(entry, allocator, "annotations", annotations);
    tables_.PushBack(entry, allocator);
}

void Page::add_drawing(const std::string& title, const std::string& svg) {
    auto& allocator = document_.GetAllocator();
    drawings_.PushBack(json_object(allocator, "title", printable(title, 200), "blob", add_bytes(svg)), allocator);
}

void Page::note(const std::string& text) {
    notes_.PushBack(json_string(printable(text, 2000), document_.GetAllocator()), document_.GetAllocator());
}

std::string Page::html(const std::string& made_how) const {
    Json whole;
    auto& allocator = whole.GetAllocator();
    whole.CopyFrom(document_, allocator);
    const auto copy = [&](const JsonValue& value) { return JsonValue(value, allocator); };
    add_members(whole, allocator, "notes", copy(notes_), "provenance", made_how, "objects", copy(objects_), "tables",
                copy(tables_), "drawings", copy(drawings_), "blobs", copy(places_));
    const std::string data = with_markup_escaped(to_compact_text(whole)), bytes = base64(deflated(bytes_));
    return viewer_with(data, bytes);
}

PageTable annotation_table(const Mesh& mesh, const AnnotationSet& set, int object, const std::string& name) {
    PageTable table;
    table.title = name;
    table.columns = {"annotation", "id", "type", "elements", "area or length", "unit"};
    const auto cell = [](const auto& value) {
        Json made;
        static_cast<JsonValue&>(made) = json_value(value, made.GetAllocator());
        return made;
    };
    for (std::size_t i = 0; i < set.annotations.size(); ++i) {
        const Annotation& one = set.annotations[i];
        PageTable::Row& row = table.rows.emplace_back();
        const bool region = one.type == AnnotationType::region, line = one.type == AnnotationType::line;
        const auto size = region ? evaluate(mesh, one, "area") : line ? evaluate(mesh, one, "length") : std::nullopt;
        std::size_t elements = region ? one.faces.size() : one.points.size();
        for (const auto& polyline : one.polylines) elements += polyline.size();
        row.cells.push_back(cell(one.tag.empty() ? "annotation " + std::to_string(one.id) : one.tag));
        row.cells.push_back(cell(one.id));
        row.cells.push_back(cell(to_string(one.type)));
        row.cells.push_back(cell(elements));
        row.cells.push_back(cell(size));
        row.cells.push_back(cell(size ? descriptor_unit(region ? "area" : "length", set.unit) : std::string()));
        row.object = object;
        row.annotation = static_cast<int>(i);
    }
    return table;
}

}  // namespace ostraka
