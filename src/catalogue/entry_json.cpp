// Catalogue entries as JSON.
#include "ostraka/catalogue/entry.h"

#include "ostraka/files/base64.h"
#include "ostraka/files/json_build.h"

#include <cmath>

namespace ostraka {

namespace {

using Curve = std::vector<Vector2d>;
using Texts = std::vector<std::pair<std::string, std::string>>;

/// Coordinates in thousandths of a millimetre are exact enough for print, and short.
double rounded(double value) { return std::round(value * 1e4) / 1e4; }

/// Null for a number that is not known.
JsonValue number_json(double value) { return std::isfinite(value) ? JsonValue(value) : JsonValue(); }
double number_of_json(const JsonValue& object, const char* name) {
    const JsonValue* member = find_member(object, name);
    return member != nullptr && member->IsNumber() ? member->GetDouble() : unknown_number;
}

JsonValue curve_json(const Curve& curve, JsonAllocator& a) {
    JsonValue list(rapidjson::kArrayType);
    list.Reserve(static_cast<rapidjson::SizeType>(2 * curve.size()), a);
    for (const Vector2d& p : curve) list.PushBack(rounded(p.x()), a).PushBack(rounded(p.y()), a);
    return list;
}
Curve curve_of(const JsonValue& list) {
    Curve curve;
    for (rapidjson::SizeType i = 0; i + 1 < list.Size(); i += 2) curve.emplace_back(list[i].GetDouble(), list[i + 1].GetDouble());
    return curve;
}

JsonValue curves_json(const std::vector<Curve>& curves, JsonAllocator& a) {
    return json_list(curves, a, [&](const Curve& curve) { return curve_json(curve, a); });
}
std::vector<Curve> curves_of(const JsonValue& object, const char* name) {
    std::vector<Curve> curves;
    for (const JsonValue& list : list_in(object, name)) curves.push_back(curve_of(list));
    return curves;
}

JsonValue texts_json(const Texts& texts, JsonAllocator& a) {
    return json_list(texts, a, [](const auto& text) { return std::array{text.first, text.second}; });
}
Texts texts_of(const JsonValue& object, const char* name) {
    Texts texts;
    for (const JsonValue& pair : list_in(object, name)) texts.emplace_back(text_of(pair[0]), text_of(pair[1]));
    return texts;
}
std::vector<std::string> strings_of(const JsonValue& object, const char* name) {
    std::vector<std::string> texts;
    for (const JsonValue& text : list_in(object, name)) texts.push_back(text_of(text));
    return texts;
}

JsonValue view_json(const CatalogueView& view, JsonAllocator& a) {
    return json_object(a, "name", view.name, "jpeg", to_base64(view.jpeg), "picture",
                       std::array{view.left, view.low, view.width, view.height}, "object",
                       std::array{view.object_left, view.object_right, view.object_low, view.object_high}, "outline",
                       curves_json(view.outline, a), "marks", json_list(view.marks, a, [](const CatalogueView::Mark& mark) {
                           return std::array{double(mark.number), rounded(mark.place.x()), rounded(mark.place.y())};
                       }));
}
CatalogueView view_of(const JsonValue& object) {
    CatalogueView view;
    view.name = text_in(object, "name");
    view.jpeg = from_base64(text_in(object, "jpeg")).value_or("");
    const auto picture = list_in(object, "picture"), extent = list_in(object, "object");
    for (rapidjson::SizeType k = 0; k < picture.Size() && k < 4; ++k)
        *std::array{&view.left, &view.low, &view.width, &view.height}[k] = picture[k].GetDouble();
    for (rapidjson::SizeType k = 0; k < extent.Size() && k < 4; ++k)
        *std::array{&view.object_left, &view.object_right, &view.object_low, &view.object_high}[k] = extent[k].GetDouble();
    view.outline = curves_of(object, "outline");
    for (const JsonValue& mark : list_in(object, "marks"))
        view.marks.push_back({static_cast<std::size_t>(mark[0].GetDouble()), {mark[1].GetDouble(), mark[2].GetDouble()}});
    return view;
}

JsonValue diameter_json(const CatalogueDiameter& d, JsonAllocator& a) {
    return json_object(a, "name", d.name, "value", number_json(d.value), "low", number_json(d.low), "high", number_json(d.high),
                       "range", d.is_range, "share", d.share, "height", d.height, "known", d.known);
}
CatalogueDiameter diameter_of(const JsonValue& object) {
    return {text_in(object, "name"),          number_of_json(object, "value"), number_of_json(object, "low"),
            number_of_json(object, "high"),   flag_in(object, "range"),        number_of_json(object, "share"),
            number_of_json(object, "height"), flag_in(object, "known")};
}

JsonValue drawing_json(const CatalogueDrawing& drawing, JsonAllocator& a) {
    return json_object(
        a, "section", curves_json(drawing.section, a), "open", curves_json(drawing.open, a), "breaks",
        curves_json(drawing.breaks, a), "outside", view_json(drawing.outside, a), "reconstructed",
        curve_json(drawing.reconstructed, a), "lines",
        json_list(drawing.lines, a,
                  [](const CatalogueDrawing::Line& line) {
                      return std::array{double(static_cast<int>(line.type)), line.height, line.radius, line.from, line.to};
                  }),
        "size", std::array{drawing.high, drawing.section_reach, drawing.section_near});
}
CatalogueDrawing drawing_of(const JsonValue& object) {
    CatalogueDrawing drawing;
    drawing.section = curves_of(object, "section"), drawing.open = curves_of(object, "open");
    drawing.breaks = curves_of(object, "breaks");
    if (const JsonValue* outside = find_member(object, "outside")) drawing.outside = view_of(*outside);
    if (const JsonValue* curve = find_member(object, "reconstructed")) drawing.reconstructed = curve_of(*curve);
    for (const JsonValue& line : list_in(object, "lines"))
        drawing.lines.push_back({static_cast<CatalogueDrawing::Line::Type>(static_cast<int>(line[0].GetDouble())),
                                 line[1].GetDouble(), line[2].GetDouble(), line[3].GetDouble(), line[4].GetDouble()});
    const auto size = list_in(object, "size");
    if (size.Size() == 3)
        drawing.high = size[0].GetDouble(), drawing.section_reach = size[1].GetDouble(),
        drawing.section_near = size[2].GetDouble();
    return drawing;
}

/// Names and places of the entry's numbers.
std::vector<std::pair<const char*, double CatalogueEntry::*>> numbers_of_entry() {
    return {{"height", &CatalogueEntry::height},
            {"width", &CatalogueEntry::width},
            {"depth", &CatalogueEntry::depth},
            {"thickness", &CatalogueEntry::thickness},
            {"thicknessLow", &CatalogueEntry::thickness_low},
            {"thicknessHigh", &CatalogueEntry::thickness_high},
            {"capacity", &CatalogueEntry::capacity},
            {"capacityError", &CatalogueEntry::capacity_error},
            {"volume", &CatalogueEntry::volume},
            {"weight", &CatalogueEntry::weight}};
}

}  // namespace

Json to_json(const CatalogueEntry& entry) {
    Json document(rapidjson::kObjectType);
    auto& a = document.GetAllocator();
    add_members(document, a, "name", entry.name, "kind", static_cast<int>(entry.kind), "problem", entry.problem, "unit",
                entry.unit, "unitAssumed", entry.unit_assumed, "vertices", entry.vertices, "faces", entry.faces, "diameter",
                diameter_json(entry.diameter, a));
    for (const auto& [name, member] : numbers_of_entry()) add_members(document, a, name, number_json(entry.*member));
    add_members(document, a, "unknown", entry.unknown, "drawing", drawing_json(entry.drawing, a), "views",
                json_list(entry.views, a, [&](const CatalogueView& view) { return view_json(view, a); }), "landmarks",
                entry.landmarks, "annotations", texts_json(entry.annotations, a), "state", texts_json(entry.state, a),
                "provenance", texts_json(entry.provenance, a), "notes", entry.notes);
    return document;
}

CatalogueEntry entry_from_json(const JsonValue& document) {
    CatalogueEntry entry;
    entry.name = text_in(document, "name");
    entry.kind = static_cast<CatalogueKind>(static_cast<int>(number_or(document, "kind", 0)));
    entry.problem = text_in(document, "problem"), entry.unit = text_in(document, "unit");
    entry.unit_assumed = flag_in(document, "unitAssumed");
    entry.vertices = static_cast<std::size_t>(number_or(document, "vertices", 0));
    entry.faces = static_cast<std::size_t>(number_or(document, "faces", 0));
    if (const JsonValue* diameter = find_member(document, "diameter")) entry.diameter = diameter_of(*diameter);
    for (const auto& [name, member] : numbers_of_entry()) entry.*member = number_of_json(document, name);
    entry.unknown = strings_of(document, "unknown");
    if (const JsonValue* drawing = find_member(document, "drawing")) entry.drawing = drawing_of(*drawing);
    for (const JsonValue& view : list_in(document, "views")) entry.views.push_back(view_of(view));
    entry.landmarks = strings_of(document, "landmarks");
    entry.annotations = texts_of(document, "annotations");
    entry.state = texts_of(document, "state");
    entry.provenance = texts_of(document, "provenance");
    entry.notes = strings_of(document, "notes");
    return entry;
}

}  // namespace ostraka
