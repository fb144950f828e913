// Candidates for the geometric relationships, each measured before it is told.
#include "meter.h"

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
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i + 1 < runs.size(); ++i) {
            const double span = values[runs[i + 1].second].first - values[runs[i].first].first;
            if (span < least) least = span, best = i;
        }
        if (!(least <= width)) break;
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

}  // namespace

std::vector<Relationship> RelationMeter::extract(const std::vector<std::string>& types, int first_id) {
    State& state = *state_;
    std::vector<Relationship> found;
    const auto wanted = [&](const std::string& type) {
        return types.empty() || std::find(types.begin(), types.end(), type) != types.end();
    };
    const auto consider = [&](const std::string& type, std::vector<int> members, const std::string& attribute = {}) {
        Relationship relationship;
        relationship.id = first_id + static_cast<int>(found.size());
        relationship.type = type;
        relationship.directed = find_relation_type(type)->directed;
        relationship.annotations = std::move(members);
        relationship.origin = "extracted";
        relationship.parameters.attribute = attribute;
        const RelationCheck check = measure(relationship);
        if (check.verdict != Verdict::holds) return false;
        relationship.parameters = check.parameters;
        found.push_back(std::move(relationship));
        return true;
    };

    std::vector<int> regions, single_points;
    std::set<std::string> attributes;
    for (const auto& annotation : state.set.annotations) {
        if (annotation.all) continue;
        Part& part = state.part(annotation.id);
        if (annotation.type == AnnotationType::region && part.area() > 0) regions.push_back(annotation.id);
        if (annotation.type == AnnotationType::point && annotation.points.size() == 1) single_points.push_back(annotation.id);
        if (annotation.type == AnnotationType::point && annotation.points.size() > 2 && wanted("co-linearity"))
            consider("co-linearity", {annotation.id});
        for (const auto& attribute : annotation.attributes)
            if (attribute.type != AttributeType::semantic) attributes.insert(attribute.name);
    }
    if (wanted("co-linearity") && single_points.size() <= 40)
        for (std::size_t i = 0; i < single_points.size(); ++i)
            for (std::size_t j = i + 1; j < single_points.size(); ++j)
                for (std::size_t k = j + 1; k < single_points.size(); ++k)
                    consider("co-linearity", {single_points[i], single_points[j], single_points[k]});

    const auto pairs = [&](const auto& visit) {
        for (std::size_t i = 0; i < regions.size(); ++i)
            for (std::size_t j = i + 1; j < regions.size(); ++j) visit(regions[i], regions[j]);
    };
    // A part that holds another one shares its geometry: nothing is said of such pairs.
    std::set<std::pair<int, int>> overlapping;
    {
        std::vector<std::vector<int>> at(state.mesh.number_of_faces());
        for (const int id : regions)
            for (const Index f : state.set.find(id)->faces) at[f].push_back(id);
        std::sort(at.begin(), at.end());
        at.erase(std::unique(at.begin(), at.end()), at.end());
        for (const auto& list : at)
            for (const int a : list)
                for (const int b : list)
                    if (a < b) overlapping.emplace(a, b);
    }
    const auto apart = [&](int a, int b) { return overlapping.count(std::minmax(a, b)) == 0; };
    const auto alike = [&](int a, int b) {
        const double x = state.part(a).area(), y = state.part(b).area();
        return std::abs(x - y) <= 2 * state.options.ratio / 100 * std::max(x, y);
    };
    if (wanted("mirror symmetry")) {
        for (const int id : regions) consider("mirror symmetry", {id});
        pairs([&](int a, int b) {
            if (apart(a, b) && alike(a, b)) consider("mirror symmetry", {a, b});
        });
    }
    if (wanted("part similarity"))
        pairs([&](int a, int b) {
            if (apart(a, b) && alike(a, b)) consider("part similarity", {a, b});
        });
    pairs([&](int a, int b) {
        if (!apart(a, b)) return;
        if (wanted("co-axiality") && consider("co-axiality", {a, b})) return;
        if (wanted("parallel axes") && consider("parallel axes", {a, b})) return;
        if (wanted("perpendicular axes")) consider("perpendicular axes", {a, b});
    });
    if (wanted("co-planarity")) {
        // Parts that are flat themselves: thinner than a tenth of their width.
        std::vector<int> flat;
        for (const int id : regions) {
            const Cloud::Plane plane = state.part(id).cloud().plane();
            if (plane.rms < 0.1 * plane.spread) flat.push_back(id);
        }
        for (std::size_t i = 0; i < flat.size(); ++i)
            for (std::size_t j = i + 1; j < flat.size(); ++j)
                if (apart(flat[i], flat[j])) consider("co-planarity", {flat[i], flat[j]});
    }
    if (wanted("same level") && state.set.up) {
        const Vector3d up = eigen(unit_vector({(*state.set.up)[0], (*state.set.up)[1], (*state.set.up)[2]}));
        std::vector<std::pair<double, int>> heights;
        for (const int id : regions) heights.emplace_back(up.dot(state.part(id).centroid()), id);
        for (auto& group : clusters(std::move(heights), state.options.distance * state.diagonal))
            consider("same level", std::move(group));
    }
    if (wanted("equal attributes"))
        for (const auto& name : attributes) {
            std::vector<std::pair<double, int>> values;
            for (const auto& annotation : state.set.annotations)
                if (const auto value = state.attribute(annotation.id, name); value && *value > 0)
                    values.emplace_back(std::log(*value), annotation.id);
            for (auto& group : clusters(std::move(values), -std::log1p(-std::min(0.999, state.options.ratio / 100))))
                consider("equal attributes", std::move(group), name);
        }
    if (wanted("horizontal support") || wanted("side contact"))
        for (const auto& [pair, contact] : state.all_contacts()) {
            if (wanted("horizontal support") && (consider("horizontal support", {pair.first, pair.second}) ||
                                                 consider("horizontal support", {pair.second, pair.first})))
                continue;
            if (wanted("side contact")) consider("side contact", {pair.first, pair.second});
        }
    return found;
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
    for (const char* type : {"same level", "horizontal support", "side contact"})
        if (!set.up && wanted(type)) result.not_looked_for.emplace_back(type);
    for (Relationship& relationship : RelationMeter(mesh, set, options).extract(types, 0)) add(std::move(relationship));
    return result;
}

}  // namespace ostraka
