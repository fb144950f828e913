#include "semantic/constraint_members.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

namespace ostraka::semantic {

namespace {

bool is_named(const Annotation& annotation, const std::variant<int, std::string>& name) {
    const int* id = std::get_if<int>(&name);
    return id != nullptr ? annotation.id == *id : annotation.tag == std::get<std::string>(name);
}

bool is_named(const Attribute& attribute, const std::variant<int, std::string>& name) {
    const int* id = std::get_if<int>(&name);
    return id != nullptr ? attribute.id == *id : attribute.name == std::get<std::string>(name);
}

}  // namespace

Points columns_at(const Points& points, const std::vector<Index>& vertices) {
    Points some(3, static_cast<Eigen::Index>(vertices.size()));
    for (std::size_t i = 0; i < vertices.size(); ++i) some.col(static_cast<Eigen::Index>(i)) = points.col(vertices[i]);
    return some;
}

void ConstraintMembers::fail(const std::string& what, const std::string& remedy) const { fail_input(place_, what, remedy); }

const Annotation& ConstraintMembers::member(std::size_t i) const {
    const Annotation* annotation = shape_.annotations.find(relationship_.annotations.at(i));
    if (annotation == nullptr)
        fail(fmt::format("there is no annotation {}", relationship_.annotations[i]), "see 'annotation list'");
    return *annotation;
}

std::vector<Index> ConstraintMembers::vertices(std::size_t i) const {
    auto list = vertices_of(shape_.mesh, member(i));
    if (list.empty()) fail(fmt::format("annotation {} selects nothing", member(i).id), "select a part, or leave it out");
    return list;
}

std::vector<int> ConstraintMembers::all_vertices() const {
    std::set<int> all;
    for (std::size_t i = 0; i < count(); ++i)
        for (const Index v : vertices(i)) all.insert(static_cast<int>(v));
    return {all.begin(), all.end()};
}

const std::vector<Index>& ConstraintMembers::faces(std::size_t i) const {
    need_region(i);
    return member(i).faces;
}

void ConstraintMembers::need(std::size_t minimum, std::size_t maximum) const {
    if (count() < minimum || (maximum > 0 && count() > maximum))
        fail(fmt::format("has {} annotations", count()), fmt::format("give {}{}", minimum, maximum == minimum ? "" : " or more"));
}

void ConstraintMembers::need_region(std::size_t i) const {
    if (member(i).faces.empty()) fail(fmt::format("annotation {} is no region", member(i).id), "use regions");
}

Vector3d ConstraintMembers::up(const std::optional<Vector3d>& stated) const {
    if (stated) return *stated;
    if (!shape_.annotations.up)
        fail("no upward direction is given", "give direction in the constraint, or up in the annotations");
    return Vector3d((*shape_.annotations.up)[0], (*shape_.annotations.up)[1], (*shape_.annotations.up)[2]).normalized();
}

const Measure& ConstraintMembers::measure(const MeasureName& name, std::size_t i) const {
    const Annotation& annotation = member(i);
    // "equal attributes" names its attribute as the relation does.
    const std::string& attribute_name = relationship_.parameters.attribute;
    const Measure* match = nullptr;
    for (const Attribute& attribute : annotation.attributes) {
        if (attribute.measure() == nullptr) continue;
        if (!(name.measure ? is_named(attribute, *name.measure) : attribute_name.empty() || attribute.name == attribute_name))
            continue;
        if (match != nullptr)
            fail(fmt::format("annotation {} has several measures that {} may mean", annotation.id, name.parameter),
                 "give its id");
        match = attribute.measure();
    }
    if (match == nullptr)
        fail(fmt::format("annotation {} has no measure that {} names", annotation.id, name.parameter),
             fmt::format("take one with 'measure take', or correct {}", name.parameter));
    return *match;
}

double ConstraintMembers::tolerance(const std::string& quantity, double for_all) const {
    for (const Deviation& deviation : relationship_.parameters.deviations)
        if (deviation.quantity == quantity && deviation.tolerance) return *deviation.tolerance;
    return for_all;
}

std::optional<std::size_t> ConstraintMembers::leader(const Leader& stated, const State& edited) const {
    if (!stated.any) return {};
    if (stated.named) {
        for (std::size_t i = 0; i < count(); ++i)
            if (is_named(member(i), *stated.named)) return i;
        fail("follow names none of its annotations", "give true, or the id or tag of the one that the others follow");
    }
    std::optional<std::size_t> best;
    double most = 0;
    if (edited.asked.empty() || edited.is_dragging) return best;
    for (std::size_t i = 0; i < count(); ++i) {
        const std::vector<Index> list = vertices(i);
        const auto moved = std::count_if(list.begin(), list.end(), [&](Index v) { return edited.asked[v]; });
        const double share = static_cast<double>(moved) / static_cast<double>(list.size());
        if (share > most) most = share, best = i;
    }
    return best;
}

std::unique_ptr<Constraint> ConstraintMembers::make(const ConstraintKind& kind, std::vector<int> ids, double share) const {
    try {
        return make_constraint(kind, std::move(ids), relationship_.weight * share, shape_.rest);
    } catch (const Error& error) {
        fail(error.problem(), error.remedy());
    }
}

std::unique_ptr<Constraint> ConstraintMembers::as_edited(std::size_t i, const State& edited) const {
    const std::vector<Index> list = vertices(i);
    return make(kinds::Closeness{columns_at(edited.points, list)}, ids_of(list));
}

double ConstraintMembers::size_at_rest(const Constraint& constraint) const {
    Eigen::AlignedBox3d box;
    for (const int v : constraint.ids()) box.extend(Vector3d(shape_.rest.col(v)));
    return box.diagonal().norm();
}

}  // namespace ostraka::semantic
