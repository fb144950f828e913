#include "semantic/constraint_spec.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka::semantic {

ParameterReader::ParameterReader(const Relationship& relationship, std::string place) : place_(std::move(place)) {
    if (!relationship.constraint.empty()) parameters_ = parse_json(relationship.constraint, place_);
    else parameters_.SetObject();
}

void ParameterReader::fail(const std::string& what, const std::string& remedy) const { fail_input(place_, what, remedy); }

const JsonValue* ParameterReader::given(const char* name) const {
    read_.insert(name);
    return find_member(parameters_, name);
}

bool ParameterReader::flag(const char* name) const {
    const JsonValue* value = given(name);
    if (value != nullptr && !value->IsBool()) fail(fmt::format("{} is neither true nor false", name), "give true or false");
    return value != nullptr && value->GetBool();
}

std::optional<double> ParameterReader::number(const char* name, double minimum, double maximum) const {
    const JsonValue* value = given(name);
    if (value == nullptr) return {};
    if (!value->IsNumber() || !(value->GetDouble() >= minimum && value->GetDouble() <= maximum))
        fail(fmt::format("{} is not a number from {} to {}", name, std::to_string(minimum), std::to_string(maximum)),
             "give a number of this range");
    return value->GetDouble();
}

std::optional<Vector3d> ParameterReader::vector(const char* name) const {
    const JsonValue* value = given(name);
    if (value == nullptr) return {};
    if (!value->IsArray() || value->Size() != 3) fail(fmt::format("{} is not three numbers", name), "give x, y, z");
    Vector3d v;
    for (int k = 0; k < 3; ++k) {
        const JsonValue& x = (*value)[static_cast<rapidjson::SizeType>(k)];
        if (!x.IsNumber() || !(std::abs(x.GetDouble()) < 1e60))
            fail(fmt::format("{} is not three numbers below 1e60", name), "give x, y, z");
        v[k] = x.GetDouble();
    }
    return v;
}

std::optional<Vector3d> ParameterReader::direction(const char* name) const {
    const auto v = vector(name);
    if (!v) return {};
    const double largest = v->cwiseAbs().maxCoeff();
    if (!(largest > 0)) fail(fmt::format("{} is zero", name), "give a direction");
    return Vector3d((*v / largest).normalized());
}

std::optional<std::size_t> ParameterReader::word(const char* name, std::initializer_list<const char*> words) const {
    const JsonValue* value = given(name);
    if (value == nullptr) return {};
    const std::string text = value->IsString() ? value->GetString() : "?";
    const auto place = std::find_if(words.begin(), words.end(), [&](const char* known) { return text == known; });
    if (place == words.end()) fail(fmt::format("{} is '{}'", name, text), "use one of: " + joined(words));
    return static_cast<std::size_t>(place - words.begin());
}

std::optional<std::variant<int, std::string>> ParameterReader::id_or_name(const char* name) const {
    const JsonValue* value = given(name);
    if (value == nullptr) return {};
    if (value->IsInt()) return value->GetInt();
    if (!value->IsString()) fail(fmt::format("{} is neither an id nor a name", name), "give an id or a name");
    return std::string(value->GetString());
}

std::optional<Interval> ParameterReader::range() const {
    if (given("minValue") == nullptr && given("maxValue") == nullptr) return {};
    const auto end = [&](const char* name) {
        const JsonValue* value = given(name);
        if (value == nullptr || !value->IsNumber() || !(value->GetDouble() > 0 && value->GetDouble() < 1e60))
            fail(fmt::format("{}{}", name, value == nullptr ? " is missing" : " is not a positive number"),
                 "give minValue and maxValue, or neither: it stays as it is at rest");
        return value->GetDouble();
    };
    const Interval range{end("minValue"), end("maxValue")};
    if (range.min > range.max) fail("minValue is greater than maxValue", "exchange them");
    return range;
}

void ParameterReader::refuse_others() const {
    for (const auto& member : parameters_.GetObject())
        if (read_.count(member.name.GetString()) == 0)
            fail(fmt::format("has a parameter '{}', which it does not know", member.name.GetString()), "use: " + joined(read_));
}

Leader::Leader(const ParameterReader& read) {
    const JsonValue* value = read.given("follow");
    if (value == nullptr) return;
    any = !value->IsBool() || value->GetBool();
    if (value->IsInt()) named = value->GetInt();
    else if (value->IsString()) named = std::string(value->GetString());
    else if (!value->IsBool())
        read.fail("follow names none of its annotations", "give true, or the id or tag of the one that the others follow");
}

namespace spec {

namespace {

double bend_of(const ParameterReader& read) { return read.number("bend", 0, 1).value_or(7.5e-4); }
SizeMode mode_of(const ParameterReader& read) { return read.word("mode", {"stretch", "scale"}, SizeMode::stretch); }

}  // namespace

KeepShape::KeepShape(const ParameterReader& read) : mode(read.word("mode", {"rigid", "similar", "seat"}, Mode::rigid)) {
    if (mode == Mode::seat) bend = bend_of(read);
}

SameLevel::SameLevel(const ParameterReader& read)
    : up(read.direction("direction")),
      shapes(read.word("shapes", {"keep", "similar", "free", "seat"}, Shapes::keep)),
      reference(read.word("reference", {"mean", "vertex", "base"}, Reference::mean)) {
    if (shapes == Shapes::seat) {
        bend = bend_of(read);
        return;
    }
    if (const auto place = read.word("heights", {"rest", "equal"})) heights = static_cast<Heights>(*place);
    leader = Leader(read);
}

StructuralContinuity::StructuralContinuity(const ParameterReader& read) : angle(read.number("angle", 0.1, 90).value_or(10)) {}

Proportion::Proportion(const ParameterReader& read)
    : first(read, "measure1"), second(read, "measure2"), range(read.range()), mode(mode_of(read)), leader(read) {}

KeepMeasure::KeepMeasure(const ParameterReader& read) : measure(read, "measure"), range(read.range()), mode(mode_of(read)) {}

SameMeasure::SameMeasure(const ParameterReader& read) : measure(read, "measure"), mode(mode_of(read)), leader(read) {}

MirrorSymmetry::MirrorSymmetry(const ParameterReader& read) : leader(read) {
    const auto normal = read.direction("direction"), point = read.vector("point");
    if (normal.has_value() != point.has_value())
        read.fail("has direction or point of the plane alone", "give both, or neither: the plane is then that at rest");
    if (normal) plane = kinds::MirrorPlane{*normal, *point};
}

KeepDirection::KeepDirection(const ParameterReader& read) : up(read.direction("direction")), angle(read.number("angle", 0, 90)) {}

}  // namespace spec

}  // namespace ostraka::semantic
