#include "select/expression_reader.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/files/safe_path.h"
#include "ostraka/mesh/limits.h"
#include "select/camera_reader.h"

#include <algorithm>

namespace ostraka {

namespace selection {

namespace {

using std::to_string;
using Kind = SelectionExpression::Kind;

Vector vector_of(const JsonValue& values) {
    const auto [x, y, z] = triple_of(values);
    return {x, y, z};
}

Position position_of(const RecipeValue& value) { return {triple_of(value.json), value.frame}; }

Length length_of(const RecipeValue& value) { return {value.json.GetDouble(), value.frame}; }

Pixel pixel_of(const JsonValue& list) { return {list[0].GetDouble(), list[1].GetDouble()}; }

/// The metric that a path or lasso states.
PathMetric metric_of(const JsonValue& value) {
    const std::string metric = text_in(value, "metric");
    return path_metric(metric.empty() ? "euclidean" : metric);
}

std::vector<Index> indices_of(const JsonValue& list) {
    std::vector<Index> indices;
    for (const auto& index : list.GetArray()) indices.push_back(index.GetUint());
    return indices;
}

// Readers of the kinds of expressions. `value`: the member that names the kind.

Kind read_halfspace(ExpressionReader& reader, const RecipeValue& value) {
    const Vector normal = vector_of(value.json["normal"]);
    if (unit_vector(normal) == CGAL::NULL_VECTOR)
        reader.fail(value.at + "/normal", "the normal has no length", "give a vector that is not zero");
    return Volume(Halfspace{position_of(value["point"]), normal});
}

/// Hidden parts are excluded unless "visible" is false.
bool visible_only(const JsonValue& value) {
    const JsonValue* visible = find_member(value, "visible");
    return visible == nullptr || visible->GetBool();
}

Kind read_rectangle(ExpressionReader& reader, const RecipeValue& value) {
    DrawnArea area{reader.camera(value), {}, visible_only(value.json)};
    const Rectangle rectangle{pixel_of(value.json["from"]), pixel_of(value.json["to"])};
    if (rectangle.from[0] == rectangle.to[0] || rectangle.from[1] == rectangle.to[1])
        reader.fail(value.at, "the rectangle has no area", "give two opposite corners");
    area.shape = rectangle;
    return area;
}

Kind read_polygon(ExpressionReader& reader, const RecipeValue& value) {
    Polygon polygon;
    for (const auto& point : value.json["points"].GetArray()) polygon.points.push_back(pixel_of(point));
    return DrawnArea{reader.camera(value), std::move(polygon), visible_only(value.json)};
}

using Quantity = decltype(Threshold::quantity);

Quantity read_colour(ExpressionReader& reader, const RecipeValue& threshold) {
    const RecipeValue colour = threshold["colour"];
    if (colour.json.IsString()) return ColourQuantity{parse_colour(text_of(colour.json))};
    return ColourQuantity{reader.pick(colour["at"])};
}

Quantity read_map(ExpressionReader& reader, const RecipeValue& threshold) {
    MapQuantity quantity{reader.file(threshold["map"]), {}};
    if (const JsonValue* on = find_member(threshold.json, "on")) quantity.on_faces = text_of(*on) == "face";
    return quantity;
}

/// A quantity of a threshold, by the name of its member, and the reader of the threshold that has it.
struct QuantityReader {
    const char* name;
    Quantity (*read)(ExpressionReader& reader, const RecipeValue& threshold);
};

constexpr QuantityReader quantities[]{
    {"coordinate",
     [](ExpressionReader&, const RecipeValue& threshold) -> Quantity {
         return CoordinateQuantity{vector_of(threshold.json["coordinate"])};
     }},
    {"curvature",
     [](ExpressionReader&, const RecipeValue& threshold) -> Quantity {
         return CurvatureQuantity{text_in(threshold.json, "curvature") == "mean", number_or(threshold.json, "scale", 0)};
     }},
    {"thickness", [](ExpressionReader&, const RecipeValue&) -> Quantity { return ThicknessQuantity{}; }},
    {"distance",
     [](ExpressionReader& reader, const RecipeValue& threshold) -> Quantity {
         return DistanceQuantity{reader.picks(threshold["distance"])};
     }},
    {"colour", read_colour},
    {"values",
     [](ExpressionReader&, const RecipeValue& threshold) -> Quantity {
         return NamedQuantity{text_in(threshold.json, "values")};
     }},
    {"map", read_map}};

const QuantityReader& quantity_of(ExpressionReader& reader, const RecipeValue& threshold) {
    const QuantityReader* chosen = nullptr;
    for (const QuantityReader& quantity : quantities) {
        if (find_member(threshold.json, quantity.name) == nullptr) continue;
        if (chosen != nullptr)
            reader.fail(threshold.at, std::string("a threshold on both ") + chosen->name + " and " + quantity.name,
                        "give one, and join two by intersection");
        chosen = &quantity;
    }
    if (chosen == nullptr)
        reader.fail(threshold.at, "a threshold on nothing",
                    "name one of " + joined(quantities, ", ", [](const QuantityReader& quantity) { return quantity.name; }));
    return *chosen;
}

Kind read_threshold(ExpressionReader& reader, const RecipeValue& value) {
    const QuantityReader& quantity = quantity_of(reader, value);
    Threshold threshold;
    threshold.quantity = quantity.read(reader, value);
    threshold.quantity_at = value.at + '/' + quantity.name;
    threshold.frame = value.frame;
    threshold.quantiles = flag_in(value.json, "quantiles");
    threshold.above = number_in(value.json, "above");
    threshold.below = number_in(value.json, "below");
    if (!threshold.above && !threshold.below)
        reader.fail(value.at, "a threshold with neither above nor below", "give one of them, or both");
    for (const auto& [name, bound] : {std::pair("above", threshold.above), std::pair("below", threshold.below)})
        if (threshold.quantiles && bound && (*bound < 0 || *bound > 1))
            reader.fail(value.at + '/' + name, "a quantile of " + to_string(*bound), "give a share of the area from 0 to 1");
    return threshold;
}

Lab lab_of(const JsonValue& colour) {
    const Rgb rgb = parse_colour(text_of(colour));
    return lab_from_linear({linear_from_srgb(rgb.red), linear_from_srgb(rgb.green), linear_from_srgb(rgb.blue)});
}

/// The bounds in a member; none if there is no such member. `cyclic`: angles, of which the first may exceed the second.
std::optional<PaintedFigureQuery::Interval> bounds_in(ExpressionReader& reader, const RecipeValue& painted, const char* name,
                                                      bool cyclic) {
    const JsonValue* found = find_member(painted.json, name);
    if (found == nullptr) return std::nullopt;
    const PaintedFigureQuery::Interval bounds{(*found)[0].GetDouble(), (*found)[1].GetDouble()};
    if (!cyclic && bounds[0] > bounds[1])
        reader.fail(painted.at + '/' + name, "the first bound exceeds the second", "exchange the two");
    return bounds;
}

Kind read_painted(ExpressionReader& reader, const RecipeValue& value) {
    Painted painted;
    PaintedFigureQuery& query = painted.query;
    if (const JsonValue* like = find_member(value.json, "like")) {
        if (like->IsString()) query.like.push_back(lab_of(*like));
        for (const auto& colour : list_in(value.json, "like")) query.like.push_back(lab_of(colour));
    }
    if (find_member(value.json, "at") != nullptr) painted.places = reader.picks(value["at"]);
    query.lightness = bounds_in(reader, value, "lightness", false);
    query.chroma = bounds_in(reader, value, "chroma", false);
    query.hue = bounds_in(reader, value, "hue", true);
    const bool bounded = query.lightness || query.chroma || query.hue;
    if (query.like.empty() && painted.places.empty() && !bounded)
        reader.fail(value.at, "a painted figure of no colour",
                    "give a colour (like), a place in it (at), or bounds of lightness, chroma or hue");
    const std::optional<double> tolerance = number_in(value.json, "tolerance");
    query.sharpest =
        flag_in(value.json, "edge") || (!painted.places.empty() && query.like.empty() && !bounded && !tolerance.has_value());
    if (query.sharpest && painted.places.empty())
        reader.fail(value.at, "a figure by its edge, but no place in it", "give a place in it (at)");
    constexpr double largest_tolerance = 60;  // of those among which the sharpest is chosen
    query.tolerance = tolerance.value_or(query.sharpest ? largest_tolerance : query.tolerance);
    painted.smallest = {number_or(value.json, "smallest", 0), value.frame};
    query.blur = static_cast<int>(number_or(value.json, "blur", query.blur));
    return painted;
}

Kind read_segments(ExpressionReader& reader, const RecipeValue& value) {
    Segments segments;
    SegmentOptions& options = segments.options;
    options.clusters = static_cast<int>(number_or(value.json, "clusters", options.clusters));
    options.smoothing = number_or(value.json, "smoothing", options.smoothing);
    const bool seeds = find_member(value.json, "seeds") != nullptr, numbers = find_member(value.json, "numbers") != nullptr;
    if (seeds == numbers)
        reader.fail(value.at, seeds ? "segments by both seeds and numbers" : "segments without seeds or numbers",
                    "give one of the two");
    if (seeds) segments.parts = reader.picks(value["seeds"]);
    else segments.parts = indices_of(value.json["numbers"]);
    return segments;
}

template <bool larger>
Kind read_growth(ExpressionReader& reader, const RecipeValue& value) {
    const bool rings = find_member(value.json, "rings") != nullptr, distance = find_member(value.json, "distance") != nullptr;
    if (rings == distance)
        reader.fail(value.at, rings ? "both rings and a distance" : "neither rings nor a distance", "say one: how far");
    Growth growth{reader.part(value["of"]), larger, {}};
    if (distance) growth.extent = length_of(value["distance"]);
    else growth.extent = value.json["rings"].GetInt();
    return growth;
}

Kind read_component(ExpressionReader& reader, const RecipeValue& value) {
    Component component{reader.pick(value["seed"]), nullptr};
    if (find_member(value.json, "of") != nullptr) component.of = reader.part(value["of"]);
    return component;
}

Kind read_labels(ExpressionReader& /*reader*/, const RecipeValue& value) {
    LabelledFaces labelled;
    for (const auto& label : value.json.GetArray()) labelled.labels.insert(label.GetInt());
    return labelled;
}

template <SetOperator combine>
Kind read_combination(ExpressionReader& reader, const RecipeValue& value) {
    Combination combination{combine, {}};
    for (rapidjson::SizeType i = 0; i < value.json.Size(); ++i) combination.operands.push_back(reader.expression(value[i]));
    return combination;
}

/// A kind of expression, by the name of its member, and the reader of this member.
struct KindReader {
    const char* name;
    Kind (*read)(ExpressionReader& reader, const RecipeValue& value);
};

constexpr KindReader kinds[]{
    {"all", [](ExpressionReader&, const RecipeValue&) -> Kind { return WholeMesh{}; }},
    {"faces", [](ExpressionReader&, const RecipeValue& value) -> Kind { return FaceList{indices_of(value.json)}; }},
    {"vertices", [](ExpressionReader& reader, const RecipeValue& value) -> Kind { return VertexPicks{reader.picks(value)}; }},
    {"nearest", [](ExpressionReader&, const RecipeValue& value) -> Kind { return NearestVertex{position_of(value)}; }},
    {"box",
     [](ExpressionReader&, const RecipeValue& value) -> Kind {
         return Volume(Box{position_of(value["min"]), position_of(value["max"])});
     }},
    {"sphere",
     [](ExpressionReader&, const RecipeValue& value) -> Kind {
         return Volume(Sphere{position_of(value["centre"]), value.json["radius"].GetDouble()});
     }},
    {"halfspace", read_halfspace},
    {"rectangle", read_rectangle},
    {"polygon", read_polygon},
    {"brush",
     [](ExpressionReader& reader, const RecipeValue& value) -> Kind {
         return Brush{reader.picks(value["points"]), length_of(value["radius"]), flag_in(value.json, "stroke")};
     }},
    {"threshold", read_threshold},
    {"painted", read_painted},
    {"segments", read_segments},
    {"grow", read_growth<true>},
    {"shrink", read_growth<false>},
    {"path",
     [](ExpressionReader& reader, const RecipeValue& value) -> Kind {
         return SurfacePath{reader.picks(value["points"]), flag_in(value.json, "closed"), metric_of(value.json)};
     }},
    {"lasso",
     [](ExpressionReader& reader, const RecipeValue& value) -> Kind {
         return Lasso{reader.picks(value["points"]), reader.pick(value["seed"]), metric_of(value.json)};
     }},
    {"component", read_component},
    {"labels", read_labels},
    {"annotation", [](ExpressionReader&, const RecipeValue& value) -> Kind { return EarlierAnnotation{value.json.GetInt()}; }},
    {"union", read_combination<SetOperator::unite>},
    {"intersection", read_combination<SetOperator::intersect>},
    {"difference", read_combination<SetOperator::subtract>},
    {"invert", [](ExpressionReader& reader, const RecipeValue& value) -> Kind { return Complement{reader.part(value)}; }}};

/// The name of the only member of an expression that is not "frame".
std::string kind_name(const ExpressionReader& reader, const RecipeValue& expression) {
    std::string kind;
    for (const auto& member : expression.json.GetObject()) {
        const std::string name = text_of(member.name);
        if (name == "frame" || name == kind) continue;
        if (!kind.empty())
            reader.fail(expression.at, "selects by two kinds, " + kind + " and " + name,
                        "join them by union, intersection or difference");
        kind = name;
    }
    return kind;
}

}  // namespace

}  // namespace selection

PlaceFrame frame_of(const JsonValue& object, PlaceFrame around) {
    const std::string frame = text_in(object, "frame");
    return frame.empty() ? around : PlaceFrame{frame == "box"};
}

SelectionExpression ExpressionReader::expression(const RecipeValue& value) {
    using selection::KindReader, selection::kinds;
    const std::string name = selection::kind_name(*this, value);
    const auto* kind = std::find_if(std::begin(kinds), std::end(kinds), [&](const KindReader& k) { return k.name == name; });
    if (kind == std::end(kinds))
        fail(value.at,
             name.empty() ? "a selection without a kind" : "an unknown kind of selection, '" + printable(name, 60) + "'",
             "give one of " + joined(kinds, ", ", [](const KindReader& k) { return k.name; }));
    const RecipeValue inner{value.json, frame_of(value.json, value.frame), value.at};
    const RecipeValue member = inner[kind->name];
    return {member.at, kind->read(*this, member)};
}

std::unique_ptr<const SelectionExpression> ExpressionReader::part(const RecipeValue& value) {
    return std::make_unique<const SelectionExpression>(expression(value));
}

selection::Pick ExpressionReader::pick(const RecipeValue& value) {
    if (value.json.IsArray()) return {selection::position_of(value), value.at};
    if (value.json.IsObject()) return {selection::PixelPick{camera(value), selection::pixel_of(value.json["pixel"])}, value.at};
    return {value.json.GetUint(), value.at};
}

std::vector<selection::Pick> ExpressionReader::picks(const RecipeValue& list) {
    std::vector<selection::Pick> result;
    for (rapidjson::SizeType i = 0; i < list.json.Size(); ++i) result.push_back(pick(list[i]));
    return result;
}

std::shared_ptr<const selection::Camera> ExpressionReader::camera(const RecipeValue& owner) {
    const RecipeValue value = owner["camera"];
    if (!value.json.IsString()) return std::make_shared<const selection::Camera>(camera_from_json(value, where_));
    const std::string name = text_of(value.json);
    const JsonValue* named = named_cameras_ == nullptr ? nullptr : find_member(*named_cameras_, name);
    if (named == nullptr) fail(value.at, "no camera has the name '" + name + "'", "define it under \"cameras\" of the recipe");
    std::shared_ptr<const selection::Camera>& known = cameras_[name];
    if (known == nullptr)
        known =
            std::make_shared<const selection::Camera>(camera_from_json(RecipeValue{*named, frame_, "/cameras/" + name}, where_));
    return known;
}

Path ExpressionReader::file(const RecipeValue& name) const {
    return file_inside(text_of(name.json), folder_, where_, name.at, "the recipe's folder", "move the map beside the recipe");
}

void ExpressionReader::fail(const std::string& at, const std::string& problem, const std::string& remedy) const {
    fail_input(where_, "at " + at + ": " + problem, remedy);
}

}  // namespace ostraka
