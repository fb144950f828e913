// Reads and validates a relationship that is a constraint.
#pragma once

#include "statement.h"

#include "ostraka/axis/axis.h"
#include "ostraka/core/error.h"
#include "ostraka/core/json.h"
#include "ostraka/core/words.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/rigid_fit.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace ostraka::semantic {

using Eigen::Vector3d;

/// Indices as the solver's ids.
inline std::vector<int> ids_of(const std::vector<Index>& vertices) { return {vertices.begin(), vertices.end()}; }

/// minValue and maxValue of a constraint.
struct Range {
    double min = 0, max = 0;
};

/// Reads the members and parameters of a constraint. Errors (input) name the file and the constraint.
class Reader {
public:
    Reader(Shape shape, const Relationship& relationship, const std::string& where)
        : shape_(shape),
          relationship_(relationship),
          where_(where + ", constraint " + std::to_string(relationship.id) + " (" + relationship.type + ")") {
        if (!relationship.constraint.empty()) parameters_ = parse_json(relationship.constraint, where_);
        else parameters_.SetObject();
    }

    [[noreturn]] void fail(const std::string& what, const std::string& remedy) const { fail_input(where_, what, remedy); }

    [[nodiscard]] std::size_t members() const { return relationship_.annotations.size(); }
    [[nodiscard]] const Annotation& member(std::size_t i) const {
        const Annotation* annotation = shape_.set.find(relationship_.annotations.at(i));
        if (annotation == nullptr)
            fail("there is no annotation " + std::to_string(relationship_.annotations[i]), "see 'annotation list'");
        return *annotation;
    }
    void need(std::size_t minimum, std::size_t maximum) const {
        const std::size_t n = relationship_.annotations.size();
        if (n < minimum || (maximum > 0 && n > maximum))
            fail("has " + std::to_string(n) + " annotations",
                 "give " + std::to_string(minimum) + (maximum == minimum ? "" : " or more"));
    }
    [[nodiscard]] std::vector<Index> vertices(std::size_t i) const {
        const auto list = vertices_of(shape_.mesh, member(i));
        if (list.empty())
            fail("annotation " + std::to_string(member(i).id) + " selects nothing", "select a part, or leave it out");
        return list;
    }
    /// The vertices of all members together.
    [[nodiscard]] std::vector<int> all_vertices() const {
        std::set<int> all;
        for (std::size_t i = 0; i < members(); ++i)
            for (const Index v : vertices(i)) all.insert(static_cast<int>(v));
        return {all.begin(), all.end()};
    }
    void need_region(std::size_t i) const {
        if (member(i).faces.empty()) fail("annotation " + std::to_string(member(i).id) + " is no region", "use regions");
    }
    [[nodiscard]] const std::vector<Index>& faces(std::size_t i) const {
        need_region(i);
        return member(i).faces;
    }
    [[nodiscard]] bool flag(const char* name) const {
        const JsonValue* value = given(name);
        if (value != nullptr && !value->IsBool()) fail(std::string(name) + " is neither true nor false", "give true or false");
        return value != nullptr && value->GetBool();
    }
    [[nodiscard]] bool has(const char* name) const { return given(name) != nullptr; }
    [[nodiscard]] std::string word(const char* name, const std::string& otherwise,
                                   std::initializer_list<const char*> known) const {
        const JsonValue* value = given(name);
        const std::string text = value == nullptr ? otherwise : value->IsString() ? value->GetString() : "?";
        if (std::none_of(known.begin(), known.end(), [&](const char* k) { return text == k; }))
            fail(std::string(name) + " is '" + text + "'", "use one of: " + joined(known));
        return text;
    }
    [[nodiscard]] std::optional<Vector3d> vector(const char* name) const {
        const JsonValue* value = given(name);
        if (value == nullptr) return {};
        if (!value->IsArray() || value->Size() != 3) fail(std::string(name) + " is not three numbers", "give x, y, z");
        Vector3d v;
        for (int k = 0; k < 3; ++k) {
            const JsonValue& x = (*value)[static_cast<rapidjson::SizeType>(k)];
            if (!x.IsNumber() || !(std::abs(x.GetDouble()) < 1e60))
                fail(std::string(name) + " is not three numbers below 1e60", "give x, y, z");
            v[k] = x.GetDouble();
        }
        return v;
    }
    [[nodiscard]] std::optional<Vector3d> direction(const char* name) const {
        const auto v = vector(name);
        if (!v) return {};
        const double largest = v->cwiseAbs().maxCoeff();
        if (!(largest > 0)) fail(std::string(name) + " is zero", "give a direction");
        return Vector3d((*v / largest).normalized());
    }
    [[nodiscard]] Vector3d up() const {
        if (const auto d = direction("direction")) return *d;
        if (!shape_.set.up) fail("no direction is up", "give direction in the constraint, or up in the annotations");
        return Vector3d((*shape_.set.up)[0], (*shape_.set.up)[1], (*shape_.set.up)[2]).normalized();
    }
    [[nodiscard]] double number(const char* name, double otherwise, double minimum, double maximum) const {
        const JsonValue* value = given(name);
        if (value == nullptr) return otherwise;
        if (!value->IsNumber() || !(value->GetDouble() >= minimum && value->GetDouble() <= maximum))
            fail(std::string(name) + " is not a number from " + std::to_string(minimum) + " to " + std::to_string(maximum),
                 "give a number of this range");
        return value->GetDouble();
    }
    /// True if the range is given explicitly.
    [[nodiscard]] bool has_range() const { return has("minValue") || has("maxValue"); }
    /// minValue and maxValue (Appendix B.2), positive; if both are absent, the value `at_rest`.
    [[nodiscard]] Range range(double at_rest) const {
        if (!has_range()) return {at_rest, at_rest};
        const auto number = [&](const char* name) {
            const JsonValue* value = given(name);
            if (value == nullptr || !value->IsNumber() || !(value->GetDouble() > 0 && value->GetDouble() < 1e60))
                fail(std::string(name) + (value == nullptr ? " is missing" : " is not a positive number"),
                     "give minValue and maxValue, or neither: it stays as it is at rest");
            return value->GetDouble();
        };
        const Range r{number("minValue"), number("maxValue")};
        if (r.min > r.max) fail("minValue is greater than maxValue", "exchange them");
        return r;
    }
    /// Rejects unknown parameters (likely typos). Call it after all parameters were read.
    void refuse_others() const {
        for (const auto& member : parameters_.GetObject()) {
            const std::string name = member.name.GetString();
            if (asked_.count(name) > 0) continue;
            fail("has a parameter '" + name + "', which it does not know", "use: " + joined(asked_));
        }
    }
    /// The measure of the annotation that parameter `name` refers to by id or name; without the parameter, its only measure.
    [[nodiscard]] const Measure& measure(const char* name, const Annotation& annotation) const {
        const JsonValue* value = given(name);
        // "equal attributes" names its attribute as the relation does.
        const std::string& stated = relationship_.parameters.attribute;
        const Measure* found = nullptr;
        for (const Attribute& attribute : annotation.attributes) {
            if (attribute.type != AttributeType::measure) continue;
            const bool here = value == nullptr ? stated.empty() || attribute.name == stated
                                               : (value->IsInt() && value->GetInt() == attribute.id) ||
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

    /// The member that the others follow. With "follow" an id or tag: that member. With "follow": true: the member of which the
    /// edit moves the largest share of vertices (of equals, the first). Nothing without "follow", or if the edit moves none of
    /// them.
    [[nodiscard]] std::optional<std::size_t> leader(const State& edited) const {
        const JsonValue* value = given("follow");
        if (value == nullptr || (value->IsBool() && !value->GetBool())) return {};
        if (!value->IsBool()) return named_member("follow", *value);
        std::optional<std::size_t> best;
        double most = 0;
        if (edited.asked.empty() || edited.is_under_way) return best;
        for (std::size_t i = 0; i < members(); ++i) {
            const std::vector<Index> list = vertices(i);
            const auto asked = std::count_if(list.begin(), list.end(), [&](Index v) { return edited.asked[v]; });
            const double share = static_cast<double>(asked) / static_cast<double>(list.size());
            if (share > most) most = share, best = i;
        }
        return best;
    }
    /// True if parts follow one that the edit moves.
    [[nodiscard]] bool follows() const {
        const JsonValue* value = given("follow");
        return value != nullptr && !(value->IsBool() && !value->GetBool());
    }
    /// Validates "follow" before there is an edit.
    void read_leader() const { static_cast<void>(leader(State(shape_.mesh))); }
    /// A constraint that keeps a member as the edit leaves it.
    [[nodiscard]] std::unique_ptr<Constraint> as_edited(std::size_t i, const State& edited) const {
        const std::vector<Index> list = vertices(i);
        ConstraintParameters parameters;
        parameters.target.emplace(3, static_cast<Eigen::Index>(list.size()));
        for (std::size_t k = 0; k < list.size(); ++k)
            parameters.target->col(static_cast<Eigen::Index>(k)) = edited.points.col(list[k]);
        return make("Closeness", ids_of(list), parameters);
    }
    /// The tolerance stated for a quantity, otherwise the default.
    [[nodiscard]] double tolerance(const std::string& quantity, double for_all) const {
        for (const Deviation& deviation : relationship_.parameters.deviations)
            if (deviation.quantity == quantity && deviation.tolerance) return *deviation.tolerance;
        return for_all;
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

    /// Diagonal of the bounding box of a constraint's points at rest.
    [[nodiscard]] double size_at_rest(const Constraint& constraint) const {
        Eigen::AlignedBox3d box;
        for (const int v : constraint.ids()) box.extend(Vector3d(shape_.rest.col(v)));
        return box.diagonal().norm();
    }

private:
    [[nodiscard]] std::size_t named_member(const char* name, const JsonValue& value) const {
        for (std::size_t i = 0; i < members(); ++i)
            if ((value.IsInt() && value.GetInt() == member(i).id) || (value.IsString() && value.GetString() == member(i).tag))
                return i;
        fail(std::string(name) + " names none of its annotations",
             "give true, or the id or tag of the one that the others follow");
    }
    const JsonValue* given(const char* name) const {
        asked_.insert(name);
        return find_member(parameters_, name);
    }

    Shape shape_;
    const Relationship& relationship_;
    std::string where_;
    Json parameters_;
    mutable std::set<std::string> asked_;
};
using ReaderPtr = std::shared_ptr<const Reader>;  ///< shared by statements

/// The verdict from deviations and their tolerances.
Measured verdict_of(std::vector<Deviation> deviations);

// Functions that translate relationships to statements, for one or several types each: shapes.cpp, axis_constraints.cpp,
// measures.cpp, places.cpp, parts_kept.cpp, low_level.cpp.
Statement keep_shape(const ReaderPtr&, const RelationOptions&);
Statement same_level(const ReaderPtr&, const RelationOptions&);
Statement co_axiality(const ReaderPtr&, const RelationOptions&);
Statement axis_angle(const ReaderPtr&, const RelationOptions&);
Statement structural_continuity(const ReaderPtr&, const RelationOptions&);
Statement proportion(const ReaderPtr&, const RelationOptions&);
Statement keep_measure(const ReaderPtr&, const RelationOptions&);
Statement same_measure(const ReaderPtr&, const RelationOptions&);
Statement co_planarity(const ReaderPtr&, const RelationOptions&);
Statement co_linearity(const ReaderPtr&, const RelationOptions&);
Statement mirror_symmetry(const ReaderPtr&, const RelationOptions&);
Statement adjacency(const ReaderPtr&, const RelationOptions&);
Statement selections_kept(const ReaderPtr&, const RelationOptions&);
Statement support(const ReaderPtr&, const RelationOptions&);
Statement contact(const ReaderPtr&, const RelationOptions&);
Statement part_similarity(const ReaderPtr&, const RelationOptions&);
Statement same_length(const ReaderPtr&, const RelationOptions&);
Statement keep_direction(const ReaderPtr&, const RelationOptions&);
Statement keep_position(const ReaderPtr&, const RelationOptions&);
/// The solver's kind with the name of the type ("edge strain"); nullptr if there is none.
const ConstraintKind* low_level_kind(const std::string& type);
Statement low_level(const ReaderPtr&, const RelationOptions&);

/// The rigid motion from the current positions of vertices to their positions at rest.
Motion motion_back(const Reader& read, const std::vector<Index>& vertices, const State& now);
/// The axis of a member as measured on the current shape, transformed to the part at rest by the best rigid motion, so that a
/// constraint that transforms it forward reproduces the measured axis. The axis at rest if the current shape has none.
Axis axis_carried_back(const Reader& read, std::size_t i, const Axis& rest, const State& now);
/// What keeps the surface around each of some vertices as `shape` has it, so many times as large, but lets it turn.
Statement::Constraints stars_kept(const Reader& read, const std::vector<Index>& vertices, const Points& shape, double grown = 1);
/// The first members keep their surface by stars: displacements from neighbours, which do not turn, would shear what turns far.
void let_turn(const ReaderPtr& read, std::size_t members, Statement& statement);
/// The points of some vertices.
inline Points columns_at(const Points& points, const std::vector<Index>& vertices) {
    Points some(3, static_cast<Eigen::Index>(vertices.size()));
    for (std::size_t i = 0; i < vertices.size(); ++i) some.col(static_cast<Eigen::Index>(i)) = points.col(vertices[i]);
    return some;
}

/// Measures as the relation of this type does. doubt_axes: an angle within its tolerance gets the verdict unknown if the axis
/// of a part is less certain than the tolerance, that is, if the axis of its slices and the longest principal axis of its area
/// differ by more, for a part at least twice as long as wide.
void doubt_axes(const Reader& read, const State& deformed, double tolerance, Measured& measured);

std::function<Measured(const State&)> as_related(const ReaderPtr& read, Relationship stated, const RelationOptions& tolerances);
/// The mean of vertices, and the unit normal of their fitted plane.
Vector3d mean_of(const std::vector<Index>& vertices, const Points& points);
Vector3d normal_of(const Points& points, const std::vector<Index>& vertices);
/// Distance tolerance in the mesh's unit.
double length_tolerance(const Reader& read, const RelationOptions& tolerances);

}  // namespace ostraka::semantic
