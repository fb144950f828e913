#include "ostraka/semantic/moved_graph.h"

#include "ostraka/files/json_build.h"
#include "semantic/statements.h"

#include <cmath>

namespace ostraka {

namespace {

std::array<double, 3> as_array(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// Moves the geometry of relationships.
class RelationMover {
public:
    RelationMover(const Motion& motion, const std::string& unit_before, const std::string& unit_after)
        : motion_(motion), move_(motion), unit_before_(unit_before), unit_after_(unit_after) {}

    void move(Relationship& relationship) const {
        RelationParameters& parameters = relationship.parameters;
        for (auto* line : {&parameters.plane, &parameters.axis})
            if (*line) {
                turn((*line)->direction);
                (*line)->point = as_array(move_(Vector3d((*line)->point[0], (*line)->point[1], (*line)->point[2])));
            }
        if (parameters.up) turn(*parameters.up);
        const RelationType* type = find_relation_type(relationship.type);
        for (Deviation& deviation : parameters.deviations) scale(deviation, type != nullptr && type->geometric);
        if (!relationship.constraint.empty()) move_constraint(relationship);
    }

private:
    void turn(std::array<double, 3>& direction) const {
        direction = as_array(motion_.rotation * Vector3d(direction[0], direction[1], direction[2]));
    }

    /// Deviations without a unit are lengths only in relations that follow from geometry, on objects of unknown unit.
    void scale(Deviation& deviation, bool is_geometric) const {
        if (deviation.unit != unit_before_ || (deviation.unit.empty() && !is_geometric)) return;
        if (deviation.value) *deviation.value *= motion_.scale;
        if (deviation.tolerance) *deviation.tolerance *= motion_.scale;
        deviation.unit = unit_after_;
    }

    void move_constraint(Relationship& relationship) const {
        Json parameters = parse_json(relationship.constraint, relationship.type);
        auto& allocator = parameters.GetAllocator();
        const auto vector_in = [&](const char* name) -> std::optional<Vector3d> {
            const JsonValue* value = find_member(parameters, name);
            if (value == nullptr || !value->IsArray() || value->Size() != 3) return std::nullopt;
            for (const auto& entry : value->GetArray())
                if (!entry.IsNumber()) return std::nullopt;
            const auto numbers = triple_of(*value);
            return Vector3d(numbers[0], numbers[1], numbers[2]);
        };
        const auto set = [&](const char* name, auto&& value) { parameters[name] = json_value(value, allocator); };
        if (const auto direction = vector_in("direction")) set("direction", as_array(motion_.rotation * *direction));
        if (const auto point = vector_in("point")) set("point", as_array(move_(*point)));
        const JsonValue* absolute = find_member(parameters, "absolute");
        const int power = relationship.type == "keep measure" ? 1
                          : absolute != nullptr && absolute->IsBool() && absolute->GetBool()
                              ? semantic::length_power(relationship.type)
                              : 0;
        if (power != 0)
            for (const char* end : {"minValue", "maxValue"})
                if (const JsonValue* value = find_member(parameters, end); value != nullptr && value->IsNumber())
                    set(end, value->GetDouble() * std::pow(motion_.scale, power));
        relationship.constraint = to_text(parameters);
    }

    const Motion& motion_;
    PreciseMotion move_;
    const std::string &unit_before_, &unit_after_;
};

}  // namespace

RelationGraph moved_graph(const RelationGraph& graph, const Motion& motion, const std::string& unit_before,
                          const std::string& unit_after) {
    RelationGraph result;
    result.relationships = graph.relationships;
    const RelationMover mover(motion, unit_before, unit_after);
    for (Relationship& relationship : result.relationships) mover.move(relationship);
    return result;
}

}  // namespace ostraka
