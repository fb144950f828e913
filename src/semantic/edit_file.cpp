// Reads edits.
#include "ostraka/core/error.h"
#include "ostraka/semantic/edit.h"

#include <fmt/core.h>

#include <cmath>

namespace ostraka {

namespace {

/// Reads one step; errors name its place.
class StepReader {
public:
    StepReader(const JsonValue& step, std::string place) : step_(step), select_(step["select"]), place_(std::move(place)) {}

    [[nodiscard]] EditStep read() const {
        EditStep step;
        step.select = selection();
        if (const JsonValue* threshold = find_member(select_, "threshold")) step.threshold = threshold_of(*threshold);
        step.rule_within_selection = text_in(select_, "scope") == "selection";
        if (const JsonValue* level = find_member(select_, "level")) step.level = static_cast<std::size_t>(level->GetUint64());
        step.operation = operation();
        return step;
    }

private:
    [[noreturn]] void fail(const std::string& what, const std::string& remedy) const { fail_input(place_, what, remedy); }

    [[nodiscard]] Vector3d vector(const JsonValue& value, const char* name) const {
        const Vector3d v(value[0].GetDouble(), value[1].GetDouble(), value[2].GetDouble());
        if (!v.allFinite() || v.cwiseAbs().maxCoeff() > 1e60)
            fail(fmt::format("{} is beyond 1e60", name), "give numbers up to 1e60");
        return v;
    }
    [[nodiscard]] Vector3d direction(const JsonValue& value, const char* name) const {
        const Vector3d v = vector(value, name);
        if (v.isZero(0)) fail(fmt::format("{} is zero", name), "give a direction");
        return unit_direction(v);
    }
    [[nodiscard]] std::optional<Vector3d> centre(const JsonValue& operation) const {
        const JsonValue* value = find_member(operation, "centre");
        return value == nullptr ? std::nullopt : std::optional(vector(*value, "centre"));
    }
    [[nodiscard]] double factor(const JsonValue& operation) const {
        const double factor = operation["factor"].GetDouble();
        if (!(factor > 0 && factor < 1e6))
            fail("the factor is not between 0 and a million", "give a positive factor; 1 changes nothing");
        return factor;
    }
    [[nodiscard]] EditStep::AnnotationName name_of(const JsonValue& value) const {
        if (value.IsString()) return std::string(value.GetString());
        if (!value.IsInt()) fail("there is no annotation " + to_text(value), "see 'annotation list'");
        return value.GetInt();
    }
    static std::vector<Index> indices(const JsonValue& list) {
        std::vector<Index> result;
        for (const JsonValue& value : list.GetArray()) result.push_back(static_cast<Index>(value.GetUint64()));
        return result;
    }
    static std::variant<double, EditStep::Rule> threshold_of(const JsonValue& value) {
        if (value.IsNumber()) return value.GetDouble();
        const std::string rule = value.GetString();
        return rule == "per-point"   ? EditStep::Rule::per_point
               : rule == "auto-mesh" ? EditStep::Rule::cover_mesh
                                     : EditStep::Rule::cover_cage;
    }

    [[nodiscard]] decltype(EditStep::select) selection() const {
        decltype(EditStep::select) select;
        int ways = 0;
        const auto read = [&](const char* way, auto&& value_of) {
            const JsonValue* value = find_member(select_, way);
            if (value == nullptr) return;
            ++ways;
            select = value_of(*value);
        };
        read("annotation", [&](const JsonValue& value) { return EditStep::Annotations{{name_of(value)}}; });
        read("annotations", [&](const JsonValue& list) {
            EditStep::Annotations annotations;
            for (const JsonValue& value : list.GetArray()) annotations.names.push_back(name_of(value));
            return annotations;
        });
        read("vertices", [&](const JsonValue& list) { return EditStep::MeshVertices{indices(list)}; });
        read("cageVertices", [&](const JsonValue& list) { return EditStep::CageVertices{indices(list)}; });
        read("box", [&](const JsonValue& box) {
            const EditStep::Box corners{vector(box["min"], "min"), vector(box["max"], "max")};
            if ((corners.min.array() > corners.max.array()).any()) fail("the box has min > max", "exchange them");
            return corners;
        });
        read("all", [](const JsonValue&) { return EditStep::All(); });
        if (ways != 1)
            fail(fmt::format("selects in {} ways", ways), "use one of annotation, annotations, vertices, cageVertices, box, all");
        return select;
    }

    [[nodiscard]] decltype(EditStep::operation) operation() const {
        decltype(EditStep::operation) operation;
        int operations = 0;
        const auto read = [&](const char* name, auto&& value_of) {
            const JsonValue* value = find_member(step_, name);
            if (value == nullptr) return;
            if (++operations > 1) fail("has more than one operation", "make a step of each");
            operation = value_of(*value);
        };
        read("translate", [&](const JsonValue& by) { return EditStep::Translate{vector(by, "translate")}; });
        read("rotate", [&](const JsonValue& value) {
            const double angle = value["angle"].GetDouble();
            if (!std::isfinite(angle)) fail("the angle is not finite", "give degrees");
            return EditStep::Rotate{direction(value["axis"], "axis"), angle, centre(value)};
        });
        read("scale", [&](const JsonValue& value) { return EditStep::Scale{factor(value), centre(value)}; });
        read("stretch", [&](const JsonValue& value) {
            EditStep::Stretch stretch{direction(value["direction"], "direction"), factor(value)};
            const JsonValue* from = find_member(value, "from");
            if (from != nullptr && from->IsArray()) stretch.from = vector(*from, "from");
            else if (text_in(value, "from") == "middle") stretch.from = EditStep::Stretch::Middle();
            return stretch;
        });
        read("moveTo", [&](const JsonValue& list) {
            EditStep::MoveTo move;
            for (const JsonValue& place : list.GetArray()) move.places.push_back(vector(place, "moveTo"));
            return move;
        });
        if (operations == 0) fail("has no operation", "add translate, rotate, scale, stretch or moveTo");
        return operation;
    }

    const JsonValue &step_, &select_;
    std::string place_;
};

}  // namespace

Vector3d unit_direction(const Vector3d& direction) { return (direction / direction.cwiseAbs().maxCoeff()).normalized(); }

Edit edit_from_json(const JsonValue& document, const std::string& where) {
    validate(document, "edit", where);
    Edit edit;
    for (const JsonValue& step : document["steps"].GetArray())
        edit.steps.push_back(StepReader(step, fmt::format("{}, /steps/{}", where, edit.steps.size())).read());
    return edit;
}

}  // namespace ostraka
