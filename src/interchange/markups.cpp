// 3D Slicer markups (.mrk.json), schema 1.0.3.
#include "interchange/landmark_formats.h"
#include "interchange/text.h"

#include "ostraka/core/error.h"
#include "ostraka/files/json_build.h"

#include <fmt/core.h>

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
        const std::string declared_space = text_in(markup, "coordinateSystem");
        const auto space = declared_space == "RAS" ? AnatomicalSpace::ras : AnatomicalSpace::lps;
        if (!declared_space.empty() && declared_space != "LPS" && declared_space != "RAS")
            fail_input(where,
                       fmt::format("at {}/coordinateSystem: unknown value '{}'", pointer, one_line(declared_space).substr(0, 20)),
                       "use LPS or RAS");
        const JsonValue* control_points = find_member(markup, "controlPoints");
        if (control_points == nullptr) return points;
        if (!control_points->IsArray())
            fail_input(where, fmt::format("at {}/controlPoints: is not a list", pointer), "correct or regenerate the file");
        for (rapidjson::SizeType i = 0; i < control_points->Size(); ++i) {
            const JsonValue& point = (*control_points)[i];
            const std::string status = text_in(point, "positionStatus");
            if (!status.empty() && status != "defined") {
                ++undefined;
                continue;
            }
            const auto position = triple(find_member(point, "position"));
            if (!position)
                fail_input(where, fmt::format("at {}/controlPoints/{}/position: not three numbers", pointer, i),
                           "give the position, or \"positionStatus\": \"undefined\"");
            check_position(*position, fmt::format("{}, at {}/controlPoints/{}/position", where, pointer, i));
            points.push_back({text_in(point, "label"), in_mesh_space(*position, space, options.mesh_space), {}});
        }
        return points;
    }

    void read(const JsonValue& markup, const std::string& pointer) {
        if (!markup.IsObject())
            fail_input(where, fmt::format("at {}: is not an object", pointer), "correct or regenerate the file");
        const std::string type = text_in(markup, "type"), name = text_in(markup, "name");
        const JsonValue* unit = find_member(markup, "coordinateUnits");
        if (unit != nullptr && unit->IsArray() && !unit->Empty()) unit = &(*unit)[0];
        const std::string unit_text = unit != nullptr && unit->IsString() ? unit->GetString() : "";
        if (!unit_text.empty() && unit_text.size() < 20) {
            if (!set.unit.empty() && set.unit != unit_text)
                fail_input(where,
                           fmt::format("at {}/coordinateUnits: '{}' differs from the earlier '{}'", pointer, one_line(unit_text),
                                       set.unit),
                           "use one unit in a file");
            set.unit = unit_text;
        }
        if (type != "Fiducial" && type != "Line" && type != "Curve" && type != "ClosedCurve") {
            set.notes.push_back(fmt::format("at {}: a markup of type '{}' is not a point, line or curve and was left out",
                                            pointer, one_line(type).substr(0, 20)));
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
            set.notes.push_back(fmt::format("at {}: a curve of fewer than two points was left out", pointer));
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
    return json_object(a, "id", std::to_string(number), "label", label, "description", "", "associatedNodeID", "", "position",
                       position, "selected", true, "locked", false, "visibility", true, "positionStatus", "defined");
}

}  // namespace

LandmarkSet read_markups(const std::string& bytes, const std::string& where, const LandmarkFileOptions& options) {
    const Json document = parse_json(bytes, where);
    const JsonValue* markups = find_member(document, "markups");
    if (markups == nullptr || !markups->IsArray())
        fail_input(where, "has no list \"markups\"", "give a .mrk.json file of 3D Slicer");
    Reader reader{where, options, {}, 0};
    for (rapidjson::SizeType i = 0; i < markups->Size(); ++i) reader.read((*markups)[i], "/markups/" + std::to_string(i));
    if (reader.undefined > 0) reader.set.notes.push_back(counted(reader.undefined, "point") + " not yet placed, left out");
    return std::move(reader.set);
}

std::string write_markups(const LandmarkSet& set, const LandmarkFileOptions& options, const Provenance& provenance) {
    Json document(rapidjson::kObjectType);
    auto& a = document.GetAllocator();
    add_member(document, "@schema", schema_address, a);
    JsonValue markups(rapidjson::kArrayType);
    const auto begin = [&](const char* type, const std::string& name) {
        JsonValue markup = json_object(a, "type", type, "name", name, "coordinateSystem", option_text(options, "mesh-space"));
        // The schema allows two units; for any other unit of the mesh, the unit is omitted.
        if (set.unit == "mm" || set.unit == "um") add_member(markup, "coordinateUnits", set.unit, a);
        add_members(markup, a, "locked", false, "labelFormat", "%N-%d");
        return markup;
    };
    // All points are in one list at the beginning, as many readers use the first markup only.
    if (!set.landmarks.empty() || set.curves.empty()) {
        JsonValue markup = begin("Fiducial", "landmarks");
        std::size_t number = 0;
        add_members(markup, a, "lastUsedControlPointNumber", set.landmarks.size(), "controlPoints",
                    json_list(set.landmarks, a, [&](const Landmark& landmark) {
                        return control_point(++number, landmark.name, landmark.position, a);
                    }));
        markups.PushBack(markup, a);
    }
    for (const LandmarkCurve& curve : set.curves) {
        JsonValue markup = begin(curve.closed ? "ClosedCurve" : "Curve", curve.name);
        std::size_t number = 0;
        add_members(markup, a, "controlPoints", json_list(curve.points, a, [&](const auto& position) {
                        ++number;
                        return control_point(number, std::to_string(number), position, a);
                    }));
        markups.PushBack(markup, a);
    }
    add_members(document, a, "markups", std::move(markups), "provenance", provenance.to_json(a));
    return json_text(document);
}

}  // namespace ostraka::interchange
