// Candidates for the geometric relationships, each measured before it is reported.
#include "meter.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/core/limits.h"

#include <set>

namespace ostraka {

using namespace detail;

namespace {

/// Groups of values of which all lie within `width` of each other: neighbours are joined, narrowest result first.
std::vector<std::vector<int>> clusters(std::vector<std::pair<double, int>> values, double width) {
    std::sort(values.begin(), values.end());
    std::vector<std::pair<std::size_t, std::size_t>> runs;
    for (std::size_t i = 0; i < values.size(); ++i) runs.emplace_back(i, i);
    while (runs.size() > 1) {
        std::size_t best = 0;
        double minimum = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i + 1 < runs.size(); ++i) {
            const double span = values[runs[i + 1].second].first - values[runs[i].first].first;
            if (span < minimum) minimum = span, best = i;
        }
        if (!(minimum <= width)) break;
        runs[best].second = runs[best + 1].second;
        runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(best) + 1);
    }
    std::vector<std::vector<int>> groups;
    for (const auto& [first, last] : runs) {
        if (first == last) continue;
        groups.emplace_back();
        for (std::size_t i = first; i <= last; ++i) groups.back().push_back(values[i].second);
        std::sort(groups.back().begin(), groups.back().end());
    }
    return groups;
}

/// Ids of regions that have a face in common, the lower one first.
std::set<std::pair<int, int>> overlapping_regions(const Mesh& mesh, const AnnotationSet& set, const std::vector<int>& regions) {
    std::vector<std::vector<int>> at(mesh.number_of_faces());
    for (const int id : regions)
        for (const Index f : set.find(id)->faces) at[f].push_back(id);
    std::sort(at.begin(), at.end());
    at.erase(std::unique(at.begin(), at.end()), at.end());
    std::set<std::pair<int, int>> overlapping;
    for (const auto& list : at)
        for (const int a : list)
            for (const int b : list)
                if (a < b) overlapping.emplace(a, b);
    return overlapping;
}

bool is_wanted(GeometricRelation kind, const std::vector<std::string>& types) {
    return types.empty() || std::find(types.begin(), types.end(), relation_type(kind).name) != types.end();
}

}  // namespace

/// The candidates of each kind, one after the other; those that hold are kept.
class RelationCandidates {
public:
    RelationCandidates(RelationMeter& meter, const std::vector<std::string>& types, int first_id)
        : meter_(meter), state_(*meter.state_), set_(state_.set), types_(types), first_id_(first_id) {
        for (const auto& annotation : set_.annotations) {
            if (annotation.all) continue;
            if (annotation.type == AnnotationType::region && state_.part(annotation.id).area() > 0)
                regions_.push_back(annotation.id);
            for (const auto& attribute : annotation.attributes)
                if (attribute.type != AttributeType::semantic) attributes_.insert(attribute.name);
        }
        overlapping_ = overlapping_regions(state_.mesh, set_, regions_);
    }

    std::vector<Relationship> that_hold() {
        using enum GeometricRelation;
        if (wanted(co_linearity)) lines();
        if (wanted(mirror_symmetry))
            for (const int id : regions_) consider(mirror_symmetry, {id});
        for (const GeometricRelation kind : {mirror_symmetry, part_similarity})
            if (wanted(kind))
                for_pairs_apart([&](int a, int b) {
                    if (alike(a, b)) consider(kind, {a, b});
                });
        for_pairs_apart([&](int a, int b) {
            for (const GeometricRelation kind : {co_axiality, parallel_axes, perpendicular_axes})
                if (wanted(kind) && consider(kind, {a, b})) return;
        });
        if (wanted(co_planarity)) planes();
        if (wanted(same_level) && set_.up) levels();
        if (wanted(equal_attributes)) equal_values();
        if (wanted(horizontal_support) || wanted(side_contact)) contacts();
        return std::move(found_);
    }

private:
    [[nodiscard]] bool wanted(GeometricRelation kind) const { return is_wanted(kind, types_); }

    bool consider(GeometricRelation kind, std::vector<int> members, const std::string& attribute = {}) {
        Relationship relationship = extracted_relationship(kind, first_id_ + static_cast<int>(found_.size()), std::move(members));
        relationship.parameters.attribute = attribute;
        const RelationCheck check = meter_.measure(relationship);
        if (check.verdict != Verdict::holds) return false;
        relationship.parameters = check.parameters;
        found_.push_back(std::move(relationship));
        return true;
    }

    /// A part that holds another one shares its geometry: nothing is said of such pairs.
    [[nodiscard]] bool apart(int a, int b) const { return overlapping_.count(std::minmax(a, b)) == 0; }
    template <class Visit>
    void for_pairs_apart(const Visit& visit) const {
        for (std::size_t i = 0; i < regions_.size(); ++i)
            for (std::size_t j = i + 1; j < regions_.size(); ++j)
                if (apart(regions_[i], regions_[j])) visit(regions_[i], regions_[j]);
    }
    [[nodiscard]] bool alike(int a, int b) const {
        const double x = state_.part(a).area(), y = state_.part(b).area();
        return std::abs(x - y) <= 2 * state_.options.ratio / 100 * std::max(x, y);
    }

    void lines() {
        std::vector<int> points;
        for (const auto& annotation : set_.annotations) {
            if (annotation.all || annotation.type != AnnotationType::point) continue;
            if (annotation.points.size() == 1) points.push_back(annotation.id);
            if (annotation.points.size() > 2) consider(GeometricRelation::co_linearity, {annotation.id});
        }
        if (points.size() > 40) return;
        for (std::size_t i = 0; i < points.size(); ++i)
            for (std::size_t j = i + 1; j < points.size(); ++j)
                for (std::size_t k = j + 1; k < points.size(); ++k)
                    consider(GeometricRelation::co_linearity, {points[i], points[j], points[k]});
    }

    /// Of parts that are flat themselves: thinner than a tenth of their width.
    void planes() {
        std::vector<int> flat;
        for (const int id : regions_) {
            const Cloud::Plane plane = state_.part(id).cloud().plane();
            if (plane.rms < 0.1 * plane.spread) flat.push_back(id);
        }
        for (std::size_t i = 0; i < flat.size(); ++i)
            for (std::size_t j = i + 1; j < flat.size(); ++j)
                if (apart(flat[i], flat[j])) consider(GeometricRelation::co_planarity, {flat[i], flat[j]});
    }

    void levels() {
        const Vector3d up = eigen(unit_vector({(*set_.up)[0], (*set_.up)[1], (*set_.up)[2]}));
        std::vector<std::pair<double, int>> heights;
        for (const int id : regions_) heights.emplace_back(up.dot(state_.part(id).centroid()), id);
        for (auto& group : clusters(std::move(heights), state_.options.distance * state_.diagonal))
            consider(GeometricRelation::same_level, std::move(group));
    }

    void equal_values() {
        for (const auto& name : attributes_) {
            std::vector<std::pair<double, int>> values;
            for (const auto& annotation : set_.annotations)
                if (const auto value = state_.attribute(annotation.id, name); value && *value > 0)
                    values.emplace_back(std::log(*value), annotation.id);
            for (auto& group : clusters(std::move(values), -std::log1p(-std::min(0.999, state_.options.ratio / 100))))
                consider(GeometricRelation::equal_attributes, std::move(group), name);
        }
    }

    void contacts() {
        constexpr auto support = GeometricRelation::horizontal_support, side = GeometricRelation::side_contact;
        for (const auto& [pair, contact] : state_.all_contacts()) {
            const auto& [a, b] = pair;
            if (wanted(support) && (consider(support, {a, b}) || consider(support, {b, a}))) continue;
            if (wanted(side)) consider(side, {a, b});
        }
    }

    RelationMeter& meter_;
    RelationMeter::State& state_;
    const AnnotationSet& set_;
    const std::vector<std::string>& types_;
    int first_id_;
    std::vector<int> regions_;
    std::set<std::string> attributes_;
    std::set<std::pair<int, int>> overlapping_;
    std::vector<Relationship> found_;
};

std::vector<Relationship> RelationMeter::extract(const std::vector<std::string>& types, int first_id) {
    return RelationCandidates(*this, types, first_id).that_hold();
}

std::vector<std::string> geometric_types(const std::vector<std::string>& names) {
    std::vector<std::string> types;
    for (const std::string& name : names) {
        const RelationType* type = find_relation_type(name);
        if (type == nullptr || !type->geometric)
            fail_usage("'" + name + "' is not a type that geometry tells",
                       "use one of those in doc/relations.md; the nearest is '" + nearest_relation_type(name) + "'");
        types.push_back(type->name);
    }
    return types;
}

ExtractedRelations extract_relations(const Mesh& mesh, const AnnotationSet& set, const RelationGraph& old,
                                     const std::vector<std::string>& names, const RelationOptions& options) {
    const std::vector<std::string> types = geometric_types(names);
    const auto wanted = [&](const std::string& type) {
        return types.empty() || std::find(types.begin(), types.end(), type) != types.end();
    };
    ExtractedRelations result;
    for (const Relationship& relationship : old.relationships)
        if (relationship.origin != "extracted") result.graph.relationships.push_back(relationship);
    RelationGraph stated;
    stated.relationships = result.graph.relationships;
    const auto add = [&](Relationship relationship) {
        if (const Relationship* known = find_twin(stated, relationship)) {
            result.stated.push_back(known->id);
            return;
        }
        relationship.id = free_id(result.graph);
        result.graph.relationships.push_back(std::move(relationship));
    };
    Topology found = topology(mesh, set);
    for (Relationship& relationship : relationships_of(found, set, 0))
        if (wanted(relationship.type)) add(std::move(relationship));
    result.order = std::move(found.order);
    using enum GeometricRelation;
    for (const GeometricRelation kind : {same_level, horizontal_support, side_contact})
        if (!set.up && is_wanted(kind, types)) result.not_looked_for.push_back(relation_type(kind).name);
    const AlongEdges along_edges(mesh, set);
    for (Relationship& relationship : RelationMeter(along_edges.mesh(), along_edges.annotations(), options).extract(types, 0))
        add(std::move(relationship));
    return result;
}

}  // namespace ostraka
