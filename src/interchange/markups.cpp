// 3D Slicer markups (.mrk.json), schema 1.0.3.
#include "landmark_formats.h"
#include "text.h"

#include "ostraka/core/error.h"

namespace ostraka::interchange {

namespace {

constexpr const char* schema_address =
    "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/"
    "markups-schema-v1.0.3.json#";

struct Reader {
    const std::string& where;
    const LandmarkFileOptions& options;
    LandmarkSet set;
    std::size_t undefined = 0;

    std::vector<Landmark> points_of(const JsonValue& markup, const std::string& pointer) {
        std::vector<Landmark> points;
        const std::string stated = text_member(markup, "coordinateSystem");
        const auto space = stated == "RAS" ? AnatomicalSpace::ras : AnatomicalSpace::lps;
        if (!stated.empty() && stated != "LPS" && stated != "RAS")
            fail_input(where, "at " + pointer + "/coordinateSystem: '" + one_line(stated).substr(0, 20) + "' is not known",
                       "use LPS or RAS");
        const JsonValue* list = find_member(markup, "controlPoints");
        if (list == nullptr) return points;
        if (!list->IsArray()) fail_input(where, "at " + pointer + "/controlPoints: is not a list", "mend or regenerate the file");
        for (rapidjson::SizeType i = 0; i < list->Size(); ++i) {
            const JsonValue& point = (*list)[i];
            const std::string status = text_member(point, "positionStatus");
            if (!status.empty() && status != "defined") {
                ++undefined;
                continue;
            }
            const auto position = triple(find_member(point, "position"));
            if (!position)
                fail_input(where, "at " + pointer + "/controlPoints/" + std::to_string(i) + "/position: not three numbers",
                           "give the position, or \"positionStatus\": \"undefined\"");
            check_place(*position, where + ", at " + pointer + "/controlPoints/" + std::to_string(i) + "/position");
            points.push_back({text_member(point, "label"), in_mesh_space(*position, space, options.mesh_space), {}});
        }
        return points;
    }

    void read(const JsonValue& markup, const std::string& pointer) {
        if (!markup.IsObject()) fail_input(where, "at " + pointer + ": is not an object", "mend or regenerate the file");
        const std::string type = text_member(markup, "type"), name = text_member(markup, "name");
        const JsonValue* unit = find_member(markup, "coordinateUnits");
        if (unit != nullptr && unit->IsArray() && !unit->Empty()) unit = &(*unit)[0];
        const std::string unit_text = unit != nullptr && unit->IsString() ? unit->GetString() : "";
        if (!unit_text.empty() && unit_text.size() < 20) {
            if (!set.unit.empty() && set.unit != unit_text)
                fail_input(where, "at " + pointer + "/coordinateUnits: '" + one_line(unit_text) + "' after '" + set.unit + "'",
                           "use one unit in a file");
            set.unit = unit_text;
        }
        if (type != "Fiducial" && type != "Line" && type != "Curve" && type != "ClosedCurve") {
            set.notes.push_back("at " + pointer + ": a markup of type '" + one_line(type).substr(0, 20) +
                                "' is no point, line or curve and was left out");
            return;
        }
        std::vector<Landmark> points = points_of(markup, pointer);
        if (type == "Fiducial") {
            for (Landmark& point : points) {
                if (point.name.empty()) point.name = std::to_string(set.landmarks.size() + 1);
                set.landmarks.push_back(std::move(point));
            }
            return;
        }
        if (points.size() < 2) {
            set.notes.push_back("at " + pointer + ": a curve of fewer than two points was left out");
            return;
        }
        LandmarkCurve curve;
        curve.name = name.empty() ? "curve " + std::to_string(set.curves.size() + 1) : name;
        curve.closed = type == "ClosedCurve";
        for (const Landmark& point : points) curve.points.push_back(point.position);
        set.curves.push_back(std::move(curve));
    }
};

JsonValue control_point(std::size_t number, const std::string& label, const std::array<double, 3>& position, JsonAllocator& a) {
    JsonValue point(rapidjson::kObjectType);
    add_member(point, "id", std::to_string(number), a);
    add_member(point, "label", label, a);
    add_member(point, "description", "", a);
    add_member(point, "associatedNodeID", "", a);
    add_member(point, "position", triple_json(position, a), a);
    add_member(point, "selected", JsonValue(true), a);
    add_member(point, "locked", JsonValue(false), a);
    add_member(point, "visibility", JsonValue(true), a);
    add_member(point, "positionStatus", "defined", a);
    return point;
}

}  // namespace

LandmarkSet read_markups(const std::string& bytes, const std::string& where, const LandmarkFileOptions& options) {
    const Json document = parse_json(bytes, where);
    const JsonValue* list = find_member(document, "markups");
    if (list == nullptr || !list->IsArray()) fail_input(where, "has no list \"markups\"", "give a .mrk.json file of 3D Slicer");
    Reader reader{where, options, {}, 0};
    for (rapidjson::SizeType i = 0; i < list->Size(); ++i) reader.read((*list)[i], "/markups/" + std::to_string(i));
    if (reader.undefined > 0) reader.set.notes.push_back(counted(reader.undefined, "point") + " not yet placed, left out");
    return std::move(reader.set);
}

std::string write_markups(const LandmarkSet& set, const LandmarkFileOptions& options, const Provenance& provenance) {
    Json document(rapidjson::kObjectType);
    auto& a = document.GetAllocator();
    add_member(document, "@schema", schema_address, a);
    JsonValue list(rapidjson::kArrayType);
    const auto begin = [&](const char* type, const std::string& name) {
        JsonValue markup(rapidjson::kObjectType);
        add_member(markup, "type", type, a);
        add_member(markup, "name", name, a);
        add_member(markup, "coordinateSystem", option_text(options, "mesh-space"), a);
        // The schema knows two units; where the mesh has another, none is better than a wrong one.
        if (set.unit == "mm" || set.unit == "um") add_member(markup, "coordinateUnits", set.unit, a);
        add_member(markup, "locked", JsonValue(false), a);
        add_member(markup, "labelFormat", "%N-%d", a);
        return markup;
    };
    // All points stand in one list in front, as many readers look at the first markup only.
    if (!set.landmarks.empty() || set.curves.empty()) {
        JsonValue markup = begin("Fiducial", "landmarks"), points(rapidjson::kArrayType);
        std::size_t number = 0;
        for (const Landmark& landmark : set.landmarks)
            points.PushBack(control_point(++number, landmark.name, landmark.position, a), a);
        add_member(markup, "lastUsedControlPointNumber", JsonValue(static_cast<std::uint64_t>(number)), a);
        add_member(markup, "controlPoints", std::move(points), a);
        list.PushBack(markup, a);
    }
    for (const LandmarkCurve& curve : set.curves) {
        JsonValue markup = begin(curve.closed ? "ClosedCurve" : "Curve", curve.name), points(rapidjson::kArrayType);
        std::size_t number = 0;
        for (const auto& position : curve.points) {
            ++number;
            points.PushBack(control_point(number, std::to_string(number), position, a), a);
        }
        add_member(markup, "controlPoints", std::move(points), a);
        list.PushBack(markup, a);
    }
    add_member(document, "markups", std::move(list), a);
    add_member(document, "provenance", provenance.to_json(a), a);
    return json_text(document);
}

}  // namespace ostraka::interchange
