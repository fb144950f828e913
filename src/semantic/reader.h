// What a relationship that is a constraint says, read and checked.
#pragma once

#include "continuity.h"
#include "lower.h"

#include "ostraka/core/error.h"
#include "ostraka/core/json.h"
#include "ostraka/geom/eigen.h"

#include <algorithm>
#include <cmath>

namespace ostraka::semantic {

using Eigen::Vector3d;

/// minValue and maxValue of a constraint.
struct Range {
    double min = 0, max = 0;
};

/// Throws Error (input) that names the file and the constraint.
class Reader {
public:
    Reader(const Shape& shape, const Relationship& relationship, const std::string& where)
        : shape_(shape),
          relationship_(relationship),
          where_(where + ", constraint " + std::to_string(relationship.id) + " (" + relationship.type + ")") {
        if (!relationship.constraint.empty()) parameters_ = parse_json(relationship.constraint, where_);
        else parameters_.SetObject();
    }

    [[noreturn]] void fail(const std::string& what, const std::string& remedy) const { fail_input(where_, what, remedy); }

    [[nodiscard]] const Annotation& member(std::size_t i) const {
        const Annotation* annotation = shape_.set.find(relationship_.annotations.at(i));
        if (annotation == nullptr)
            fail("there is no annotation " + std::to_string(relationship_.annotations[i]), "see 'annotation list'");
        return *annotation;
    }
    void need(std::size_t least, std::size_t most) const {
        const std::size_t n = relationship_.annotations.size();
        if (n < least || (most > 0 && n > most))
            fail("has " + std::to_string(n) + " annotations",
                 "give " + std::to_string(least) + (most == least ? "" : " or more"));
    }
    [[nodiscard]] std::vector<Index> vertices(std::size_t i) const {
        const auto list = vertices_of(shape_.mesh, member(i));
        if (list.empty())
            fail("annotation " + std::to_string(member(i).id) + " selects nothing", "select a part, or leave it out");
        return list;
    }
    [[nodiscard]] std::string word(const char* name, const std::string& otherwise,
                                   std::initializer_list<const char*> known) const {
        const JsonValue* value = find_member(parameters_, name);
        const std::string text = value == nullptr ? otherwise : value->IsString() ? value->GetString() : "?";
        if (std::none_of(known.begin(), known.end(), [&](const char* k) { return text == k; })) {
            std::string list;
            for (const char* k : known) list += (list.empty() ? "" : ", ") + std::string(k);
            fail(std::string(name) + " is '" + text + "'", "use one of: " + list);
        }
        return text;
    }
    [[nodiscard]] std::optional<Vector3d> direction(const char* name) const {
        const JsonValue* value = find_member(parameters_, name);
        if (value == nullptr) return {};
        if (!value->IsArray() || value->Size() != 3) fail(std::string(name) + " is not three numbers", "give x, y, z");
        Vector3d d;
        for (int k = 0; k < 3; ++k) {
            const JsonValue& x = (*value)[static_cast<rapidjson::SizeType>(k)];
            if (!x.IsNumber() || !std::isfinite(x.GetDouble())) fail(std::string(name) + " is not three numbers", "give x, y, z");
            d[k] = x.GetDouble();
        }
        const double largest = d.cwiseAbs().maxCoeff();
        if (!(largest > 0)) fail(std::string(name) + " is zero", "give a direction");
        return Vector3d((d / largest).normalized());
    }
    [[nodiscard]] Vector3d up() const {
        if (const auto d = direction("direction")) return *d;
        if (!shape_.set.up) fail("no direction is up", "give direction in the constraint, or up in the annotations");
        return Vector3d((*shape_.set.up)[0], (*shape_.set.up)[1], (*shape_.set.up)[2]).normalized();
    }
    [[nodiscard]] double number(const char* name, double otherwise, double least, double most) const {
        const JsonValue* value = find_member(parameters_, name);
        if (value == nullptr) return otherwise;
        if (!value->IsNumber() || !(value->GetDouble() >= least && value->GetDouble() <= most))
            fail(std::string(name) + " is not a number from " + std::to_string(least) + " to " + std::to_string(most), "mend it");
        return value->GetDouble();
    }
    /// minValue and maxValue (Appendix B.2), positive.
    [[nodiscard]] Range range() const {
        const auto number = [&](const char* name) {
            const JsonValue* value = find_member(parameters_, name);
            if (value == nullptr || !value->IsNumber() || !(value->GetDouble() > 0 && value->GetDouble() < 1e60))
                fail(std::string(name) + (value == nullptr ? " is missing" : " is not a positive number"),
                     "give minValue and maxValue");
            return value->GetDouble();
        };
        const Range r{number("minValue"), number("maxValue")};
        if (r.min > r.max) fail("minValue is greater than maxValue", "exchange them");
        return r;
    }
    /// The measure that `name` names by id or name in the annotation; the only one if it is left out.
    [[nodiscard]] const Measure& measure(const char* name, const Annotation& annotation) const {
        const JsonValue* value = find_member(parameters_, name);
        const Measure* found = nullptr;
        for (const Attribute& attribute : annotation.attributes) {
            if (attribute.type != AttributeType::measure) continue;
            const bool here = value == nullptr || (value->IsInt() && value->GetInt() == attribute.id) ||
                              (value->IsString() && attribute.name == value->GetString());
            if (!here) continue;
            if (found != nullptr)
                fail("annotation " + std::to_string(annotation.id) + " has several measures that " + name + " may mean",
                     "give its id");
            found = &attribute.measure;
        }
        if (found == nullptr)
            fail("annotation " + std::to_string(annotation.id) + " has no measure that " + name + " names",
                 "take one with 'measure take', or mend " + std::string(name));
        return *found;
    }

    const Shape& shape() const { return shape_; }
    const Relationship& relationship() const { return relationship_; }
    [[nodiscard]] std::unique_ptr<Constraint> make(const char* kind, std::vector<int> ids, const ConstraintParameters& parameters,
                                                   double share = 1) const {
        try {
            return make_constraint(kind, std::move(ids), relationship_.weight * share, parameters, shape_.rest);
        } catch (const Error& error) {
            fail(error.problem(), error.remedy());
        }
    }

private:
    const Shape& shape_;
    const Relationship& relationship_;
    std::string where_;
    Json parameters_;
};

/// The two pins between which a ruler or bounding measure is taken, and the direction of the latter.
struct Pins {
    Index from, to;
    std::optional<Vector3d> direction;
};
Pins pins_of(const Reader& read, const Measure& measure);
double length_of(const Pins& pins, const Points& points);

/// The segment of the first member that continues the second, and the axis of the second, at rest.
struct Continuity {
    AxisSegment segment;
    Axis reference;
};
Continuity continuity_of(const Reader& read);

}  // namespace ostraka::semantic
