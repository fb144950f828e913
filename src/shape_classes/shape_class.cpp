#include "ostraka/shape_classes/shape_class.h"

#include "ostraka/core/error.h"
#include "ostraka/shape_classes/dissimilarity.h"
#include "ostraka/shape_classes/fragment_thresholds.h"
#include "ostraka/shape_classes/thresholds.h"
#include "ostraka/stats/summary.h"
#include "shape_classes/parts.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace ostraka {

const LearntRange* ShapeClass::find(const std::string& key) const {
    for (const LearntRange& range : ranges)
        if (range.quantity.key() == key) return &range;
    return nullptr;
}

MemberFit fit_by_method(const ClassTemplate& class_template, const WholeObject& member, CorrespondenceChoice correspondence,
                        const MemberFitOptions& options) {
    if (correspondence == CorrespondenceChoice::given ||
        (correspondence == CorrespondenceChoice::automatic && in_correspondence(class_template.mesh, member.mesh)))
        return member_in_correspondence(class_template.mesh, member);
    return fit_member(class_template, member, options);
}

LearntMember learn_member(const ClassTemplate& class_template, const WholeObject& member, const LearnOptions& options,
                          const WholeShape* whole_shape) {
    check_options(options, "learn");
    return measure_member(class_template, member, fit_by_method(class_template, member, options.correspondence, options.fit),
                          options, whole_shape);
}

namespace {

/// Names of the template's regions that contain a face, the smallest first.
std::string parts_at(const ClassTemplate& class_template, Index face) {
    std::vector<const Annotation*> list;
    for (const Annotation& annotation : class_template.annotations.annotations)
        if (is_part(class_template.mesh, annotation) &&
            std::find(annotation.faces.begin(), annotation.faces.end(), face) != annotation.faces.end())
            list.push_back(&annotation);
    std::stable_sort(list.begin(), list.end(), [](const auto* a, const auto* b) { return a->faces.size() < b->faces.size(); });
    std::string text;
    for (const Annotation* annotation : list)
        text += fmt::format("{}{} ({})", text.empty() ? "" : ", in ", annotation->id, annotation->tag);
    return text;
}

void name_regions(const ClassTemplate& class_template, MemberFit& fit) {
    for (DeviatingRegion& region : fit.foreign) region.part = parts_at(class_template, region.nearest_face);
    for (DeviatingRegion& region : fit.missing) region.part = parts_at(class_template, region.face);
}

}  // namespace

LearntMember measure_member(const ClassTemplate& class_template, const WholeObject& member, MemberFit fit,
                            const LearnOptions& options, const WholeShape* whole_shape) {
    LearntMember learnt;
    learnt.name = member.name;
    learnt.fit = std::move(fit);
    if (!learnt.fit.problem.empty()) return learnt;
    name_regions(class_template, learnt.fit);
    learnt.quantities = measure_quantities(class_template, learnt.fit.points, options.modes.sizes);
    for (ClassQuantity& quantity : part_quantities(class_template, learnt.fit.points, &member))
        learnt.quantities.push_back(std::move(quantity));
    if (const auto disagreement = own_disagreement(class_template, learnt.fit.points, member)) {
        ClassQuantity& quantity = learnt.quantities.emplace_back();
        quantity.kind = QuantityKind::part;
        quantity.name = "own annotations elsewhere";
        quantity.one_sided = true;
        quantity.value = disagreement;
    }
    learnt.fragments = fragment_quantities(class_template, learnt.fit.points, learnt.quantities);
    for (ClassQuantity& quantity : geometry_quantities(learnt.fit.residuals)) learnt.quantities.push_back(std::move(quantity));
    const bool is_given = whole_shape != nullptr && learnt.fit.outer == nullptr;
    const Mesh& surface = learnt.fit.outer ? *learnt.fit.outer : member.mesh;
    for (ClassQuantity& quantity : geometry_quantities(is_given ? *whole_shape : measure_whole_shape(surface)))
        learnt.quantities.push_back(std::move(quantity));
    return learnt;
}

namespace {

std::vector<double> known_of(const LearntRange& range) {
    std::vector<double> known_values;
    for (const auto& value : range.values)
        if (value) known_values.push_back(*value);
    return known_values;
}

/// Whether the quantity is a distance of a member from the others: the root of a sum of squares of deviations that scatter
/// about zero in all directions.
bool is_distance(const ClassQuantity& quantity) {
    const std::string& name = quantity.name;
    return quantity.one_sided && quantity.id < 0 &&
           (name == "from the mean shape" || name == "outside the modes" || name == "sizes of the parts" ||
            name == "places of the parts");
}

/// Whether the quantity is never negative (shares, lengths, ratios), so that a negative bound is meaningless. Deviations are
/// signed, and attributes may be.
bool is_never_negative(const ClassQuantity& quantity) {
    return quantity.kind == QuantityKind::proportion || quantity.kind == QuantityKind::part ||
           quantity.kind == QuantityKind::geometry;
}

void summarise_range(LearntRange& range) {
    const std::vector<double> known_values = known_of(range);
    range.count = known_values.size();
    if (known_values.empty()) return;
    const Summary summary = summarise(known_values, range.quantity.key());
    range.min = summary.min;
    range.max = summary.max;
    range.mean = summary.mean;
    range.median = summary.median;
    range.deviation = summary.standard_deviation;
    range.percentile_5 = sample_quantile(known_values, 0.05);
    range.percentile_25 = sample_quantile(known_values, 0.25);
    range.percentile_75 = sample_quantile(known_values, 0.75);
    range.percentile_95 = sample_quantile(known_values, 0.95);
    const QuantityKind kind = range.quantity.kind;
    range.logarithm =
        range.min > 0 && kind != QuantityKind::constraint && kind != QuantityKind::relation && !is_distance(range.quantity);
}

bool single_part(const LearntRange& range) { return range.quantity.kind == QuantityKind::part && range.quantity.id >= 0; }

/// Moments of the values on the scale that is taken as normal.
SampleMoments range_moments(const LearntRange& range) {
    std::vector<double> known_values = known_of(range);
    if (is_distance(range.quantity)) {
        // The leave-one-out distance of a member is n / (n - 1) times its distance from the mean of all: this is the variance
        // about that mean.
        SampleMoments moments_about_mean;
        moments_about_mean.count = known_values.size();
        const auto n = static_cast<double>(moments_about_mean.count);
        for (const double x : known_values) moments_about_mean.variance += (n - 1) / (n * n) * x * x;
        moments_about_mean.freedom = n - 1;
        return moments_about_mean;
    }
    if (range.logarithm)
        for (double& x : known_values) x = std::log(x);
    return moments_of(std::span<const double>(known_values));
}

void set_bounds(LearntRange& range, const SampleMoments& moments, double resolution) {
    const double largest = std::max(std::abs(range.min), std::abs(range.max));
    // A distance has no side. In one dimension the two-sided t is exact; in more dimensions the bound is conservative.
    const PredictionInterval interval = predict(moments, range.quantity.one_sided && !is_distance(range.quantity), range.reject,
                                                range.logarithm ? resolution : resolution * largest);
    // Does not reject for rounding, nor within the tolerance of a range in per cent (solver: a tenth).
    const bool per_cent = range.quantity.kind == QuantityKind::constraint && range.quantity.unit == "%";
    const double margin = per_cent ? 0.1 : 1e-6;
    const double low = (range.logarithm ? std::exp(interval.low) : interval.low) - margin,
                 high = (range.logarithm ? std::exp(interval.high) : interval.high) + margin;
    if (!std::isfinite(low) || !std::isfinite(high)) return;
    // If members differ so much that the bound is at chance level, it rejects nothing.
    if (range.quantity.name == "own annotations elsewhere" && high >= 1) {
        range.reject = 0;
        return;
    }
    range.high = high;
    if (!range.quantity.one_sided) range.low = is_never_negative(range.quantity) ? std::max(0.0, low) : low;
}

using Moments = std::map<std::string, SampleMoments>;  ///< moments by key that replace those of the range

bool is_unlikeness(const ClassQuantity& quantity) {
    return quantity.kind == QuantityKind::geometry && quantity.name == unlike_the_members;
}

/// Whether the quantity can reject only in combination with others.
bool only_together(const LearntRange& range) { return single_part(range) || counts_for_dissimilarity(range.quantity); }

/// Logarithms. Values below a tenth of a deviation are due to the resolution and are clamped.
std::vector<double> unlikeness_logs(const LearntRange& range) {
    std::vector<double> logs;
    for (const double value : known_of(range)) logs.push_back(std::log(std::max(value, 0.1)));
    return logs;
}

/// A dissimilarity below one deviation never rejects; half a deviation is recognised unless out-of-class objects indicate
/// otherwise.
void set_unlikeness_bounds(ShapeClass& learnt, LearntRange& range, const SampleMoments& members,
                           const SampleMoments& out_of_class, std::size_t class_count) {
    range.high = std::max(1.0, std::exp(predict(members, true, range.reject).high));
    set_recognised(range, members, out_of_class, learnt.accept / static_cast<double>(class_count), learnt.unsure);
}

/// `out_of_class`: the moments of the out-of-class objects over all classes that are queried together, instead of those of this
/// class.
void set_thresholds(ShapeClass& learnt, const Moments& moderated, const std::optional<SampleMoments>& out_of_class = {},
                    std::size_t class_count = 1) {
    std::map<QuantityKind, std::size_t> counts;
    for (const LearntRange& range : learnt.ranges)
        if (!only_together(range) && range.count >= ShapeClass::min_members) ++counts[range.quantity.kind];
    const auto kinds = std::max<std::size_t>(1, counts.size() - counts.count(QuantityKind::attribute));
    for (LearntRange& range : learnt.ranges) {
        range.low.reset();
        range.high.reset();
        range.recognised.reset();
        range.reject = 0;
        if (only_together(range) || range.count < ShapeClass::min_members) continue;
        range.reject = learnt.reject / static_cast<double>(kinds * counts.at(range.quantity.kind));
        const auto moderated_moments = moderated.find(range.quantity.key());
        const bool uses_own_moments = moderated_moments == moderated.end();
        if (is_unlikeness(range.quantity))
            set_unlikeness_bounds(learnt, range,
                                  uses_own_moments ? moments_of(unlikeness_logs(range)) : moderated_moments->second,
                                  out_of_class ? *out_of_class : moments_of(out_of_class_logs(range)), class_count);
        else set_bounds(range, uses_own_moments ? range_moments(range) : moderated_moments->second, learnt.resolution);
    }
}

}  // namespace

void learn_thresholds(ShapeClass& learnt) {
    measure_dissimilarity(learnt);
    for (LearntRange& range : learnt.ranges)
        if (is_unlikeness(range.quantity)) summarise_range(range);
    set_thresholds(learnt, {});
}

void moderate_thresholds(std::vector<ShapeClass>& classes) {
    std::map<std::string, std::vector<SampleMoments>> samples;
    const auto is_shared = [](const LearntRange& range) {
        return !only_together(range) && !is_unlikeness(range.quantity) && (range.logarithm || is_distance(range.quantity)) &&
               range.count >= ShapeClass::min_members && range.quantity.id < 0 &&
               (range.quantity.kind == QuantityKind::geometry || range.quantity.kind == QuantityKind::part);
    };
    for (const ShapeClass& shape_class : classes)
        for (const LearntRange& range : shape_class.ranges) {
            if (is_shared(range)) samples[range.quantity.key()].push_back(range_moments(range));
            else if (counts_for_dissimilarity(range.quantity) && range.count >= ShapeClass::min_members) {
                samples[range.quantity.key()].push_back(dissimilarity_moments(range));
                samples[range.quantity.key()].back().variance += shape_class.resolution * shape_class.resolution;
            }
        }
    std::map<std::string, VariancePrior> priors;
    for (const auto& [key, class_moments] : samples)
        if (const auto prior = variance_prior(class_moments)) priors.emplace(key, *prior);
    // Dissimilarities are in units of deviations: members of all classes form one sample, and so do out-of-class objects.
    std::vector<double> member_dissimilarities, out_of_class_values;
    std::size_t classes_with_thresholds = 0;
    std::optional<Dependence> dependence;
    if (!priors.empty()) dependence = dependence_of(classes);
    for (ShapeClass& shape_class : classes) {
        shape_class.variances = priors;
        shape_class.dependence = dependence;
        measure_dissimilarity(shape_class);
        for (LearntRange& range : shape_class.ranges) {
            if (!is_unlikeness(range.quantity)) continue;
            summarise_range(range);
            const std::vector<double> member_logs = unlikeness_logs(range);
            member_dissimilarities.insert(member_dissimilarities.end(), member_logs.begin(), member_logs.end());
            const std::vector<double> stranger_values = out_of_class_logs(range);
            out_of_class_values.insert(out_of_class_values.end(), stranger_values.begin(), stranger_values.end());
            classes_with_thresholds += member_logs.size() >= ShapeClass::min_members ? 1 : 0;
        }
    }
    for (ShapeClass& shape_class : classes) {
        Moments moderated;
        for (const LearntRange& range : shape_class.ranges) {
            if (is_unlikeness(range.quantity)) {
                if (classes_with_thresholds >= 3) moderated[range.quantity.key()] = moments_of(member_dissimilarities);
            } else if (const auto prior = priors.find(range.quantity.key()); is_shared(range) && prior != priors.end()) {
                moderated[range.quantity.key()] = prior->second.moderate(range_moments(range));
            }
        }
        const bool strangers_shared = classes_with_thresholds >= 3 && shape_class.out_of_class.size() >= ShapeClass::min_members;
        set_thresholds(shape_class, moderated, strangers_shared ? std::optional(moments_of(out_of_class_values)) : std::nullopt,
                       classes.size());
    }
}

std::vector<std::optional<double>> expected_parts(const std::vector<LearntRange>& ranges, std::optional<std::size_t> without) {
    std::vector<std::optional<double>> expected;
    for (const LearntRange& range : ranges) {
        expected.emplace_back();
        if (!single_part(range)) continue;
        double sum = 0, count = 0;
        for (std::size_t i = 0; i < range.values.size(); ++i)
            if (i != without && range.values[i] && *range.values[i] > 0) sum += std::log(*range.values[i]), ++count;
        if (count > 0) expected.back() = std::exp(sum / count);
    }
    return expected;
}

std::vector<CombinedParts> combined_parts(const std::vector<LearntRange>& ranges,
                                          const std::vector<std::optional<double>>& values,
                                          const std::vector<std::optional<double>>& expected) {
    std::vector<CombinedParts> combined_quantities;
    for (const bool sizes : {true, false}) {
        std::vector<std::size_t> places;
        std::vector<std::optional<double>> part_values, expected_values;
        for (std::size_t k = 0; k < ranges.size(); ++k) {
            if (!single_part(ranges[k]) || is_size_of_part(ranges[k].quantity) != sizes) continue;
            places.push_back(k);
            part_values.push_back(values[k]);
            expected_values.push_back(expected[k]);
        }
        if (places.empty()) continue;
        CombinedParts& combined = combined_quantities.emplace_back();
        combined.quantity.kind = QuantityKind::part;
        combined.quantity.name = sizes ? "sizes of the parts" : "places of the parts";
        combined.quantity.one_sided = true;
        const PartsDeviation deviation = parts_deviation(part_values, expected_values);
        if (deviation.count == 0) continue;
        combined.quantity.value = deviation.off;
        combined.worst = places[deviation.worst];
        combined.expected = *expected_values[deviation.worst];
    }
    return combined_quantities;
}

double mean_distance(const ShapeModes& modes, const std::vector<Landmarks>& shapes) {
    if (shapes.size() < 2) return 0;
    std::vector<Landmarks> aligned;
    for (const Landmarks& shape : shapes) aligned.push_back(coordinates_in(modes, shape).map.apply(shape));
    double sum = 0;
    for (std::size_t i = 0; i < aligned.size(); ++i)
        for (std::size_t j = i + 1; j < aligned.size(); ++j) sum += (aligned[i] - aligned[j]).norm();
    return sum / (0.5 * static_cast<double>(aligned.size() * (aligned.size() - 1))) / modes.mean_size;
}

namespace {

using Quantities = std::vector<ClassQuantity> LearntMember::*;

/// The values of each quantity on the members.
std::vector<LearntRange> collected(const std::vector<const LearntMember*>& members, Quantities quantities) {
    std::vector<LearntRange> ranges;
    std::map<std::string, std::size_t> range_indices;
    for (std::size_t i = 0; i < members.size(); ++i)
        for (const ClassQuantity& quantity : members[i]->*quantities) {
            const auto [entry, is_new] = range_indices.try_emplace(quantity.key(), ranges.size());
            if (is_new) {
                ranges.emplace_back().quantity = quantity;
                ranges.back().quantity.value.reset();
                ranges.back().values.resize(members.size());
            }
            ranges[entry->second].values[i] = quantity.value;
        }
    return ranges;
}

/// Each quantity has an equal share of the rate at which members are rejected.
void add_fragment_ranges(ShapeClass& learnt, const std::vector<const LearntMember*>& members) {
    learnt.fragments = collected(members, &LearntMember::fragments);
    for (LearntRange& range : learnt.fragments) {
        summarise_range(range);
        if (range.count < ShapeClass::min_members) continue;
        range.reject = learnt.reject / static_cast<double>(learnt.fragments.size());
        set_bounds(range, range_moments(range), learnt.resolution);
    }
}

/// Adds the values of the ranges on the out-of-class objects.
void add_out_of_class(ShapeClass& learnt, const std::vector<LearntMember>& out_of_class) {
    for (const LearntMember& stranger : out_of_class) {
        if (!stranger.fit.problem.empty()) {
            learnt.notes.push_back(
                fmt::format("the out-of-class object {} is left out: {}", stranger.name, stranger.fit.problem));
            continue;
        }
        learnt.out_of_class.push_back(stranger.name);
        std::map<std::string, std::optional<double>> values;
        for (const ClassQuantity& quantity : stranger.quantities) values[quantity.key()] = quantity.value;
        for (LearntRange& range : learnt.ranges) {
            const auto entry = values.find(range.quantity.key());
            range.out_of_class.push_back(entry == values.end() ? std::nullopt : entry->second);
        }
    }
}

/// Bound on how far the template is off on one more member: the prediction bound of the logits. More than half of both surfaces
/// is never accepted.
void learn_most_off(ShapeClass& learnt, const std::vector<const LearntMember*>& members) {
    constexpr double min_off = 0.01;
    std::vector<double> logits;
    for (const LearntMember* member : members)
        if (member->fit.residuals) {
            const double off_fraction = std::clamp(member->fit.residuals->off(), min_off, 1 - min_off);
            logits.push_back(std::log(off_fraction / (1 - off_fraction)));
        }
    if (logits.size() < ShapeClass::min_members) return;
    learnt.most_off = std::min(uninformative_fit, 1 / (1 + std::exp(-predict(moments_of(logits), true, learnt.reject).high)));
}

void add_ranges(ShapeClass& learnt, const std::vector<const LearntMember*>& members,
                const std::vector<LearntMember>& out_of_class) {
    learnt.ranges = collected(members, &LearntMember::quantities);
    add_out_of_class(learnt, out_of_class);
    const auto add = [&](const char* name, const std::vector<double>& values) {
        LearntRange& range = learnt.ranges.emplace_back();
        range.quantity.name = name;
        range.quantity.one_sided = true;
        range.values.resize(members.size());
        for (std::size_t i = 0; i < values.size(); ++i) range.values[i] = values[i];
    };
    const std::size_t n = members.size();
    // Each member compared with the others.
    std::vector<std::vector<CombinedParts>> combined_by_member;
    for (std::size_t i = 0; n > 1 && i < n; ++i) {
        std::vector<std::optional<double>> member_values;
        for (const LearntRange& range : learnt.ranges) member_values.push_back(range.values[i]);
        combined_by_member.push_back(combined_parts(learnt.ranges, member_values, expected_parts(learnt.ranges, i)));
    }
    for (std::size_t k = 0; n > 1 && k < combined_by_member.front().size(); ++k) {
        LearntRange& range = learnt.ranges.emplace_back();
        range.quantity = combined_by_member.front()[k].quantity;
        range.quantity.value.reset();
        for (std::size_t i = 0; i < n; ++i) range.values.push_back(combined_by_member[i][k].quantity.value);
    }
    add("from the mean shape", learnt.modes.left_out_distances);
    add("outside the modes", learnt.modes.left_out_outside);
    if (learnt.sizes) {
        add("centroid size", learnt.modes.centroid_sizes);
        learnt.ranges.back().quantity.one_sided = false;
    }
    for (LearntRange& range : learnt.ranges) summarise_range(range);
    learn_thresholds(learnt);
}

/// Selects the member nearest to the mean, excluding those in `ineligible` if there are others.
void choose_archetype(ShapeModes& modes, const std::set<std::size_t>& ineligible) {
    if (ineligible.size() >= modes.distances.size()) return;
    std::size_t best = modes.distances.size();
    for (std::size_t i = 0; i < modes.distances.size(); ++i)
        if (ineligible.count(i) == 0 && (best == modes.distances.size() || modes.distances[i] < modes.distances[best])) best = i;
    modes.archetype = best;
}

}  // namespace

ShapeClass learn_class(const ClassTemplate& class_template, const std::vector<LearntMember>& members, const LearnOptions& options,
                       const std::vector<LearntMember>& out_of_class) {
    check_options(options, "learn");
    ShapeClass learnt;
    learnt.sizes = options.modes.sizes;
    learnt.reject = options.reject;
    learnt.resolution = options.resolution;
    learnt.unsure = options.unsure;
    learnt.accept = options.accept;
    std::vector<const LearntMember*> used;
    std::vector<Landmarks> shapes;
    std::set<std::size_t> ineligible;  // members not eligible as archetype
    for (const LearntMember& member : members) {
        if (!member.fit.problem.empty()) {
            learnt.notes.push_back(fmt::format("{} is left out: {}", member.name, member.fit.problem));
            continue;
        }
        if (std::string off_message = fit_off_message(member.fit, uninformative_fit); !off_message.empty()) {
            learnt.notes.push_back(fmt::format("{} is left out: {}", member.name, off_message));
            continue;
        }
        if (std::string off_message = fit_off_message(member.fit, options.fit.max_off); !off_message.empty()) {
            learnt.notes.push_back(fmt::format("{} is used, but cannot be the archetype: {}", member.name, off_message));
            ineligible.insert(used.size());
        }
        used.push_back(&member);
        shapes.push_back(landmarks_of(member.fit.points));
        learnt.members.push_back({member.name, member.fit.placed_by, member.fit.scale, member.fit.notes});
    }
    if (used.empty())
        fail_input("class", members.empty() ? "has no member" : "has no member to which the template could be registered",
                   "give at least one whole object");
    learnt.modes = learn_modes(shapes, landmarks_of({class_template.mesh.points().begin(), class_template.mesh.points().end()}),
                               options.modes);
    learnt.diversity = mean_distance(learnt.modes, shapes);
    add_ranges(learnt, used, out_of_class);
    learn_most_off(learnt, used);
    add_fragment_ranges(learnt, used);
    if (const LearntRange* range = learnt.find("geometry compactness"); range != nullptr && range->count > 0)
        for (std::size_t i = 0; i < range->values.size(); ++i)
            if (!range->values[i]) {
                ineligible.insert(i);
                learnt.notes.push_back(
                    learnt.members[i].name +
                    " is used, but cannot be the archetype: its surface encloses no volume, unlike that of other members");
            }
    choose_archetype(learnt.modes, ineligible);
    learnt.topology = topology_checksum(class_template.mesh);
    if (used.size() == 1)
        learnt.notes.push_back("there is one member: neither modes nor thresholds can be learnt; give at least three");
    else if (!learnt.has_thresholds())
        learnt.notes.push_back("there are two members: thresholds cannot be learnt; give at least three");
    else if (used.size() < 5)
        learnt.notes.push_back(
            fmt::format("there are only {} members: the thresholds have to be wide in order to reject few members", used.size()));
    if (used.size() > 1 && learnt.modes.variances.empty())
        learnt.notes.push_back("all members have the same shape: the thresholds reflect only the resolution of the measurements");
    const bool constrained =
        std::any_of(class_template.graph.relationships.begin(), class_template.graph.relationships.end(),
                    [](const Relationship& relationship) { return relationship.is_constraint && relationship.weight > 0; });
    if (!constrained) learnt.notes.push_back("the template has no constraint: relations and geometry alone decide");
    return learnt;
}

ShapePrior prior_of(const ShapeModes& modes) {
    ShapePrior prior;
    for (Eigen::Index i = 0; i < modes.mean.rows(); ++i) prior.mean.emplace_back(modes.mean.row(i).transpose());
    prior.modes = modes.modes.transpose();
    for (const double variance : modes.variances) prior.deviations.push_back(std::sqrt(variance));
    return prior;
}

void LearnOptions::declare_options(OptionList& list) {
    fit.declare_options(list);
    modes.declare_options(list);
    list("correspondence", correspondence,
         "vertex correspondence between template and members: given (members must have the template's triangles), fitted (the "
         "template is fitted to each member), or auto (given for members with the template's triangles, fitted for others)",
         Choices{"auto", "given", "fitted"});
    list("false-reject", reject, "maximum share of true members that all thresholds together reject (for log-normal quantities)",
         Range{1e-6, 0.5});
    list("unsure", unsure,
         "maximum share of true members that are not recognised because of their dissimilarity; objects between this threshold "
         "and the rejection threshold are undecided; with three or more out-of-class objects, these determine the threshold "
         "instead",
         Range{1e-6, 0.5});
    list("accept", accept,
         "maximum share of out-of-class objects that are accepted by at least one of the classes that are tested together",
         Range{1e-6, 0.5});
    list("resolution", resolution, "standard deviation of repeated measurements of one member", Range{0, 1},
         "share of its value");
}

}  // namespace ostraka
