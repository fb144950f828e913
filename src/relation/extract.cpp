// Candidates for geometric relationships, each measured before it is reported. Steps that are quadratic in the number of
// regions only compare numbers; the number of expensive measurements and of reported relationships is bounded.
#include "relation/bit_table.h"
#include "relation/meter.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/progress.h"
#include "ostraka/mesh/ids.h"
#include "ostraka/mesh/limits.h"

#include <map>
#include <queue>
#include <unordered_map>

namespace ostraka {

using namespace detail;

namespace {

/// Maximum number of relationships reported per type; and of pairs that are expensive to measure, of which the most similar are
/// kept.
constexpr std::size_t most_of_type = 10'000, most_mirrors = 5'000, most_similarities = 200'000;

/// Clusters values so that all values in a group lie within `width` of each other: merges neighbouring runs, narrowest result
/// first.
std::vector<std::vector<int>> clusters(std::vector<std::pair<double, int>> values, double width) {
    std::sort(values.begin(), values.end());
    const std::size_t count = values.size();
    std::vector<std::size_t> last(count), before(count);  // end of the run that begins at an index; begin of the run before the
                                                          // one that begins at an index
    for (std::size_t i = 0; i < count; ++i) last[i] = i, before[i] = i == 0 ? 0 : i - 1;
    using Join = std::tuple<double, std::size_t, std::size_t, std::size_t>;  // span, begin and end of the first run, end of the
                                                                             // second
    std::priority_queue<Join, std::vector<Join>, std::greater<>> joins;
    const auto propose = [&](std::size_t run) {
        if (last[run] + 1 >= count) return;
        const std::size_t end = last[last[run] + 1];
        if (const double span = values[end].first - values[run].first; span <= width) joins.emplace(span, run, last[run], end);
    };
    std::vector<bool> begins(count, true);
    for (std::size_t i = 0; i < count; ++i) propose(i);
    while (!joins.empty()) {
        const auto [span, run, middle, end] = joins.top();
        joins.pop();
        if (!begins[run] || last[run] != middle || last[middle + 1] != end) continue;  // outdated: one of the runs has grown
        begins[middle + 1] = false;
        last[run] = end;
        if (end + 1 < count) before[end + 1] = run;
        propose(run);
        if (run > 0) propose(before[run]);
    }
    std::vector<std::vector<int>> groups;
    for (std::size_t first = 0; first < count; first = last[first] + 1) {
        if (first == last[first]) continue;
        groups.emplace_back();
        for (std::size_t i = first; i <= last[first]; ++i) groups.back().push_back(values[i].second);
        std::sort(groups.back().begin(), groups.back().end());
    }
    return groups;
}

/// Pairs of regions (indices in the list) with a common face.
BitTable overlapping_regions(AnnotatedMeshView object, const std::vector<int>& regions) {
    std::vector<std::vector<std::uint32_t>> at(object.mesh.number_of_faces());
    std::unordered_map<int, const Annotation*> known;
    for (const auto& annotation : object.annotations.annotations) known.emplace(annotation.id, &annotation);
    for (std::uint32_t r = 0; r < regions.size(); ++r)
        for (const Index f : known.at(regions[r])->faces) at[f].push_back(r);
    std::sort(at.begin(), at.end());
    at.erase(std::unique(at.begin(), at.end()), at.end());
    BitTable overlapping(regions.size(), regions.size());
    CancelCheck cancelled;
    for (const auto& list : at) {
        cancelled();
        std::vector<std::uint64_t> bits(overlapping.words(), 0);
        for (const std::uint32_t r : list) bits[r / 64] |= std::uint64_t{1} << (r % 64);
        for (const std::uint32_t r : list) overlapping.add(r, bits.data());
    }
    return overlapping;
}

bool is_wanted(GeometricRelation kind, const std::vector<std::string>& types) {
    return types.empty() || std::find(types.begin(), types.end(), relation_type(kind).name) != types.end();
}

}  // namespace

/// Generates the candidates of each type in turn and keeps those that hold.
class RelationCandidates {
public:
    RelationCandidates(RelationMeter& meter, const std::vector<std::string>& types, int first_id)
        : meter_(meter), state_(*meter.state_), set_(state_.annotations), types_(types), first_id_(first_id) {
        for (const auto& annotation : set_.annotations) {
            if (annotation.all) continue;
            if (annotation.type == AnnotationType::region) {
                state_.used({annotation.id});
                if (state_.part(annotation.id).area() > 0) regions_.push_back(annotation.id);
            }
            for (const auto& attribute : annotation.attributes) {
                if (attribute.note() != nullptr) continue;
                auto& list = with_attribute_[attribute.name];
                if (list.empty() || list.back() != &annotation) list.push_back(&annotation);
            }
        }
        overlapping_ = overlapping_regions(state_, regions_);
    }

    std::vector<Relationship> that_hold(std::vector<std::string>& notes) {
        using enum GeometricRelation;
        if (wanted(co_linearity)) lines();
        if (wanted(mirror_symmetry))
            for (const int id : regions_) consider(mirror_symmetry, {id});
        if (wanted(mirror_symmetry)) alike_pairs(mirror_symmetry, most_mirrors, notes);
        if (wanted(part_similarity)) alike_pairs(part_similarity, most_similarities, notes);
        if (wanted(co_axiality) || wanted(parallel_axes) || wanted(perpendicular_axes)) axes();
        if (wanted(co_planarity)) planes();
        if (wanted(same_level) && set_.up) levels();
        if (wanted(equal_attributes)) equal_values();
        if (wanted(horizontal_support) || wanted(side_contact)) contacts(notes);
        for (const auto& [kind, count] : held_)
            if (count >= most_of_type)
                notes.push_back("'" + relation_type(kind).name + "': the first " + std::to_string(most_of_type) +
                                " that hold are reported (use --type or fewer annotations to get the others)");
        return std::move(found_);
    }

private:
    [[nodiscard]] bool wanted(GeometricRelation kind) const { return is_wanted(kind, types_); }

    bool consider(GeometricRelation kind, std::vector<int> members, const std::string& attribute = {}) {
        std::size_t& held = held_[kind];
        if (held >= most_of_type) return false;
        Relationship relationship = extracted_relationship(kind, first_id_ + static_cast<int>(found_.size()), std::move(members));
        relationship.parameters.attribute = attribute;
        const RelationCheck check = meter_.measure(relationship);
        if (check.verdict != Verdict::holds) return false;
        relationship.parameters = check.parameters;
        found_.push_back(std::move(relationship));
        ++held;
        return true;
    }

    /// i, j: indices of regions in the list. Overlapping regions share geometry, so that such pairs are skipped.
    [[nodiscard]] bool apart(std::size_t i, std::size_t j) const { return !overlapping_.test(i, j); }
    template <class Visit>
    void for_pairs_apart(const Visit& visit) const {
        CancelCheck cancelled;
        for (std::size_t i = 0; i < regions_.size(); ++i)
            for (std::size_t j = i + 1; j < regions_.size(); ++j) {
                cancelled();
                if (apart(i, j)) visit(i, j);
            }
    }

    /// Pairs of similar area, in the order of the regions; if there are more than `most`, those with the smallest area
    /// difference.
    void alike_pairs(GeometricRelation kind, std::size_t most, std::vector<std::string>& notes) {
        std::vector<double> areas;
        for (const int id : regions_) areas.push_back(state_.part(id).area());
        using Pair = std::tuple<double, std::size_t, std::size_t>;  // relative difference of the areas, indices
        std::priority_queue<Pair> alike;
        std::size_t all = 0;
        for_pairs_apart([&](std::size_t i, std::size_t j) {
            const double difference = std::abs(areas[i] - areas[j]), larger = std::max(areas[i], areas[j]);
            if (!(difference <= 2 * state_.options.max_difference / 100 * larger)) return;
            ++all;
            alike.emplace(difference / larger, i, j);
            if (alike.size() > most) alike.pop();
        });
        std::vector<std::pair<std::size_t, std::size_t>> pairs;
        for (; !alike.empty(); alike.pop()) pairs.emplace_back(std::get<1>(alike.top()), std::get<2>(alike.top()));
        std::sort(pairs.begin(), pairs.end());
        for (const auto& [i, j] : pairs) consider(kind, {regions_[i], regions_[j]});
        if (all > most)
            notes.push_back("'" + relation_type(kind).name + "': of " + std::to_string(all) +
                            " pairs of about the same area the " + std::to_string(most) +
                            " most similar were measured (give fewer annotations at once to measure all)");
    }

    /// Quick test whether the angle between two axes is near 0 or 90 degrees, so that the exact measurement is worthwhile.
    [[nodiscard]] bool worth_measuring(const Vector3d& a, const Vector3d& b) const {
        const double size = a.norm() * b.norm(), limit = std::sin(std::min(90.0, state_.options.angle) * degree);
        const double cosine = std::abs(a.dot(b)) / size, sine = a.cross(b).norm() / size;
        return sine <= limit + 1e-9 || cosine <= limit + 1e-9;
    }

    void axes() {
        using enum GeometricRelation;
        std::vector<const PartAxis*> of;
        for (const int id : regions_) {
            check_cancelled();
            state_.used({id});
            of.push_back(&state_.part(id).axis());
        }
        for_pairs_apart([&](std::size_t i, std::size_t j) {
            if (!of[i]->found || !of[j]->found || !worth_measuring(of[i]->direction, of[j]->direction)) return;
            for (const GeometricRelation kind : {co_axiality, parallel_axes, perpendicular_axes})
                if (wanted(kind) && consider(kind, {regions_[i], regions_[j]})) return;
        });
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

    /// Pairs of flat parts (thinner than a tenth of their width) in a common plane. Moments exclude pairs that cannot be
    /// coplanar.
    void planes() {
        struct Flat {
            std::size_t place;
            double weight;
            Vector3d mean;
            Matrix3d covariance;
        };
        std::vector<Flat> flat;
        for (std::size_t r = 0; r < regions_.size(); ++r) {
            state_.used({regions_[r]});
            const Cloud& cloud = state_.part(regions_[r]).cloud();
            const Cloud::Plane plane = cloud.plane();
            if (plane.rms < 0.1 * plane.spread) {
                Flat one{r, 0, cloud.mean(), Matrix3d::Zero()};
                for (std::size_t i = 0; i < cloud.points.size(); ++i) {
                    const Vector3d off = cloud.points[i] - one.mean;
                    one.weight += cloud.weights[i];
                    one.covariance += cloud.weights[i] * off * off.transpose();
                }
                flat.push_back(one);
            }
        }
        const double tolerance = 1.01 * state_.options.distance * state_.diagonal + 1e-6 * state_.diagonal;
        CancelCheck cancelled;
        for (std::size_t i = 0; i < flat.size(); ++i)
            for (std::size_t j = i + 1; j < flat.size(); ++j) {
                cancelled();
                const Flat &a = flat[i], &b = flat[j];
                if (!apart(a.place, b.place)) continue;
                const Vector3d between = b.mean - a.mean;
                const double weight = a.weight + b.weight;
                const Matrix3d both = (a.covariance + b.covariance) / weight +
                                      a.weight * b.weight / (weight * weight) * between * between.transpose();
                // The smallest eigenvalue is at least the determinant divided by the square of half the sum of the other two.
                const double half = both.trace() / 2;
                if (both.determinant() > tolerance * tolerance * half * half ||
                    SymmetricEigen3(both).eigenvalues()[0] > tolerance * tolerance)
                    continue;
                consider(GeometricRelation::co_planarity, {regions_[a.place], regions_[b.place]});
                if (held_[GeometricRelation::co_planarity] >= most_of_type) return;
            }
    }

    void levels() {
        const Vector3d up = eigen(unit_vector({(*set_.up)[0], (*set_.up)[1], (*set_.up)[2]}));
        std::vector<std::pair<double, int>> heights;
        for (const int id : regions_) {
            state_.used({id});
            heights.emplace_back(up.dot(state_.part(id).centroid()), id);
        }
        for (auto& group : clusters(std::move(heights), state_.options.distance * state_.diagonal))
            consider(GeometricRelation::same_level, std::move(group));
    }

    void equal_values() {
        for (const auto& [name, annotations] : with_attribute_) {
            std::vector<std::pair<double, int>> values;
            for (const Annotation* annotation : annotations)
                if (const auto value = state_.attribute(*annotation, name); value && *value > 0)
                    values.emplace_back(std::log(*value), annotation->id);
            for (auto& group : clusters(std::move(values), -std::log1p(-std::min(0.999, state_.options.max_difference / 100))))
                consider(GeometricRelation::equal_attributes, std::move(group), name);
        }
    }

    void contacts(std::vector<std::string>& notes) {
        constexpr auto support = GeometricRelation::horizontal_support, side = GeometricRelation::side_contact;
        for (const auto& [pair, contact] : state_.all_contacts()) {
            const auto& [a, b] = pair;
            if (wanted(support) && (consider(support, {a, b}) || consider(support, {b, a}))) continue;
            if (wanted(side)) consider(side, {a, b});
        }
        if (state_.contacts_left_out)
            notes.push_back("contacts were measured at the " + std::to_string(state_.contacts->size()) +
                            " longest borders between regions only (give fewer annotations at once to measure all)");
    }

    RelationMeter& meter_;
    RelationMeter::State& state_;
    const AnnotationSet& set_;
    const std::vector<std::string>& types_;
    int first_id_;
    std::vector<int> regions_;
    std::map<std::string, std::vector<const Annotation*>> with_attribute_;
    BitTable overlapping_{0, 0};
    std::vector<Relationship> found_;
    std::map<GeometricRelation, std::size_t> held_;
};

std::vector<Relationship> RelationMeter::extract(const std::vector<std::string>& types, int first_id,
                                                 std::vector<std::string>* notes) {
    std::vector<std::string> said;
    auto found = RelationCandidates(*this, types, first_id).that_hold(said);
    if (notes != nullptr) notes->insert(notes->end(), said.begin(), said.end());
    return found;
}

std::vector<std::string> geometric_types(const std::vector<std::string>& names) {
    std::vector<std::string> types;
    for (const std::string& name : names) {
        const RelationType* type = find_relation_type(name);
        if (type == nullptr || !type->geometric)
            fail_usage("'" + name + "' is not a type that is decided by geometry",
                       "use one of those in doc/relations.md; the nearest is '" + nearest_relation_type(name) + "'");
        types.push_back(type->name);
    }
    return types;
}

namespace {
void note_left_out(const AnnotationTopology& found, const std::function<bool(const std::string&)>& wanted,
                   std::vector<std::string>& notes) {
    std::size_t containments = 0;
    for (const auto& direct : found.order.direct) containments += direct.size();
    for (const auto& [kind, count] : {std::pair(GeometricRelation::containment, containments),
                                      std::pair(GeometricRelation::adjacency, found.adjacent.size())})
        if (const std::string& name = relation_type(kind).name; count > most_of_type && wanted(name))
            notes.push_back("'" + name + "': the first " + std::to_string(most_of_type) + " of " + std::to_string(count) +
                            " are reported (give fewer annotations to get the others)");
}
}  // namespace

ExtractedRelations extract_relations(AnnotatedMeshView object, const RelationGraph& old, const std::vector<std::string>& names,
                                     const RelationOptions& options) {
    const std::vector<std::string> types = geometric_types(names);
    const auto wanted = [&](const std::string& type) {
        return types.empty() || std::find(types.begin(), types.end(), type) != types.end();
    };
    ExtractedRelations result;
    for (const Relationship& relationship : old.relationships)
        if (relationship.origin != "extracted") result.graph.relationships.push_back(relationship);
    RelationshipIndex stated(result.graph);
    FreeIds ids(result.graph.relationships);
    const auto add = [&](Relationship relationship) {
        if (const std::optional<int> known = stated.find(relationship)) {
            result.stated.push_back(*known);
            return;
        }
        relationship.id = ids.next();
        result.graph.relationships.push_back(std::move(relationship));
    };
    AnnotationTopology found = topology(object);
    for (Relationship& relationship : relationships_of(found, object.annotations, 0, most_of_type))
        if (wanted(relationship.type)) add(std::move(relationship));
    note_left_out(found, wanted, result.notes);
    result.order = std::move(found.order);
    using enum GeometricRelation;
    for (const GeometricRelation kind : {same_level, horizontal_support, side_contact})
        if (!object.annotations.up && is_wanted(kind, types)) result.skipped_types.push_back(relation_type(kind).name);
    const EdgeAlignedAnnotations along_edges(object);
    for (Relationship& relationship : RelationMeter(along_edges.object(), options).extract(types, 0, &result.notes))
        add(std::move(relationship));
    return result;
}

}  // namespace ostraka
