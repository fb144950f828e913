#include "ostraka/shape_classes/classify.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/text.h"
#include "ostraka/shape_classes/dissimilarity.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace ostraka {

std::string to_string(Membership membership) { return enum_name(membership, {"member", "other", "undecided"}); }

namespace {

QuantityCheck check_of(const LearntRange& range, const std::optional<double>& value, bool attributes) {
    QuantityCheck check;
    check.quantity = range.quantity;
    check.quantity.value = value;
    check.low = range.low;
    check.high = range.high;
    check.recognised = range.recognised;
    check.decides = range.quantity.kind != QuantityKind::attribute || attributes;
    if (!value || !range.high || !(range.reject > 0)) {
        check.decides = false;
        return check;
    }
    if (*value > *range.high) check.distance_from_range = *value - *range.high;
    if (range.low && *value < *range.low) check.distance_from_range = *range.low - *value;
    const double width = range.low ? *range.high - *range.low : *range.high;
    if (check.distance_from_range > 0)
        check.excess = width > 0 ? check.distance_from_range / width : std::numeric_limits<double>::max();
    return check;
}

std::string check_text(const QuantityCheck& check) {
    const ClassQuantity& quantity = check.quantity;
    const std::string unit = quantity.unit.empty() ? "" : " " + quantity.unit;
    std::string text = fmt::format("{}: {}{}", quantity.text(), digits(quantity.value.value_or(0), 4), unit);
    const bool above = check.high && *quantity.value > *check.high;
    text += above ? ", at most " + digits(*check.high, 4) : ", at least " + digits(check.low.value_or(0), 4);
    return fmt::format("{}{} is accepted: {}{}{}{}", text, unit, digits(check.distance_from_range, 3), unit,
                       above ? " too much" : " too little",
                       check.worst.empty() ? "" : "; the largest deviation is " + check.worst);
}

/// The value of the quantity with this key, if any.
std::optional<double> value_of(const std::vector<ClassQuantity>& quantities, const std::string& key) {
    const auto quantity =
        std::find_if(quantities.begin(), quantities.end(), [&](const auto& candidate) { return candidate.key() == key; });
    return quantity == quantities.end() ? std::nullopt : quantity->value;
}

/// Adds the combined quantities of the parts; `worst` gets, by key, the part that is farthest off.
void add_parts(const ShapeClass& learnt, std::vector<ClassQuantity>& quantities, std::map<std::string, std::string>& worst) {
    std::vector<std::optional<double>> values;
    for (const LearntRange& range : learnt.ranges) values.push_back(value_of(quantities, range.quantity.key()));
    for (CombinedParts& combined : combined_parts(learnt.ranges, values, expected_parts(learnt.ranges))) {
        if (combined.quantity.value) {
            const double value = *values[combined.worst];
            worst[combined.quantity.key()] =
                fmt::format("{}: {}, {} times the members' mean", learnt.ranges[combined.worst].quantity.text(), digits(value, 4),
                            digits(value / combined.expected, 3));
        }
        quantities.push_back(std::move(combined.quantity));
    }
}

double score_of(const ShapeClass& learnt, const LearntMember& object, const ShapeCoordinates& coordinates) {
    double score = coordinates.distance;
    if (object.fit.residuals) {
        const FitResiduals& r = *object.fit.residuals;
        score = 10 * (r.distance + r.back) + r.unmatched + r.unexplained + r.stretch + r.bend;
    }
    // Invariant to the fit: the difference of the object's own surface from the members' mean.
    for (const char* name : {"compactness", "geodesic mean", "geodesic most", "geodesic variation"}) {
        const std::string key = "geometry " + std::string(name);
        const LearntRange* range = learnt.find(key);
        const std::optional<double> object_value = value_of(object.quantities, key);
        if (range != nullptr && range->count > 0 && range->mean > 0 && object_value && *object_value > 0)
            score += 2 * std::abs(std::log(*object_value / range->mean));
    }
    return score;
}

/// Combined parts: root mean squared logarithms, and the disagreement of its own annotations with those of the template.
double score_of_parts(const std::vector<ClassQuantity>& quantities) {
    double score = 0;
    for (const ClassQuantity& quantity : quantities)
        if (quantity.kind == QuantityKind::part && quantity.id < 0) score += quantity.value.value_or(0);
    return score;
}

/// Adds the dissimilarity to the members; `worst` gets the quantity that is farthest off.
void add_unlikeness(const ShapeClass& learnt, std::vector<ClassQuantity>& quantities, ClassAnswer& class_answer,
                    std::map<std::string, std::string>& worst) {
    std::vector<std::optional<double>> values;
    for (const LearntRange& range : learnt.ranges) values.push_back(value_of(quantities, range.quantity.key()));
    const auto dissimilarity_found = dissimilarity(learnt, values);
    if (!dissimilarity_found) return;
    class_answer.dissimilarity = dissimilarity_found->value;
    ClassQuantity& quantity = quantities.emplace_back();
    quantity.name = unlike_the_members;
    quantity.value = dissimilarity_found->value;
    worst[quantity.key()] =
        fmt::format("{}: {}, {} deviations {} the members' mean", learnt.ranges[dissimilarity_found->worst].quantity.text(),
                    digits(*values[dissimilarity_found->worst], 4), digits(std::abs(dissimilarity_found->off), 3),
                    dissimilarity_found->off > 0 ? "above" : "below");
}

/// Whether the object is fitted but all members are in correspondence: these do not show the error of a fit, which slides along
/// the surface.
bool fitted_to_given(const ShapeClass& learnt, const LearntMember& object) {
    return object.fit.residuals && std::all_of(learnt.members.begin(), learnt.members.end(),
                                               [](const auto& m) { return m.placed_by == "correspondence"; });
}

/// Whether the object is rejected only by distances of vertices.
bool only_shape(const ClassAnswer& answer) {
    return !answer.rejecting_checks.empty() &&
           std::all_of(answer.rejecting_checks.begin(), answer.rejecting_checks.end(), [&](std::size_t i) {
               const std::string& name = answer.checks[i].quantity.name;
               return name == "from the mean shape" || name == "outside the modes";
           });
}

std::vector<std::string> unit_and_mirror_warnings(const ShapeClass& learnt, const LearntMember& object,
                                                  const ShapeCoordinates& coordinates) {
    constexpr double times = 3, nearer = 0.5;
    std::vector<std::string> warnings;
    const auto& sizes = learnt.modes.centroid_sizes;
    const double largest = *std::max_element(sizes.begin(), sizes.end()),
                 smallest = *std::min_element(sizes.begin(), sizes.end());
    if (coordinates.centroid_size > times * largest || times * coordinates.centroid_size < smallest)
        warnings.push_back(fmt::format("it is {} times as large as members are on average: is it in another unit?",
                                       digits(coordinates.centroid_size / learnt.modes.mean_size, 3)));
    if (object.fit.residuals) return warnings;
    const Landmarks object_points = landmarks_of(object.fit.points);
    Landmarks mirror = object_points;
    mirror.col(0) *= -1;
    ProcrustesOptions scaled;
    scaled.scaling = true;
    const double residual = procrustes(object_points, learnt.modes.mean, scaled).sum_of_squares,
                 mirrored = procrustes(mirror, learnt.modes.mean, scaled).sum_of_squares;
    if (mirrored < nearer * nearer * residual && residual > 1e-6 * learnt.modes.mean.squaredNorm())
        warnings.emplace_back(
            "its mirror image is nearer the members than itself: is it mirrored, or are left and right exchanged?");
    return warnings;
}

/// The first quantity that is neither rejected nor recognised; null if there is none.
const QuantityCheck* not_recognised(const ClassAnswer& answer) {
    for (const QuantityCheck& check : answer.checks)
        if (check.decides && check.recognised && *check.quantity.value > *check.recognised) return &check;
    return nullptr;
}

std::string unsure_text(const ShapeClass& learnt, const QuantityCheck& check) {
    const std::string number = std::to_string(learnt.out_of_class.size());
    return fmt::format(
        "its dissimilarity to the members, {} deviations on average, also occurs for out-of-class objects: up to {} is "
        "recognised, estimated from {}, and up to {} is not rejected{}",
        digits(*check.quantity.value, 3), digits(*check.recognised, 3),
        learnt.out_of_class.size() < ShapeClass::min_members ? "the members" : number + " out-of-class objects",
        digits(*check.high, 3), check.worst.empty() ? "" : "; the largest deviation is " + check.worst);
}

}  // namespace

std::vector<std::string> ClassAnswer::reasons() const {
    std::vector<std::string> texts;
    if (fit_failed) texts.push_back(fit_problem);
    for (const std::size_t i : rejecting_checks) texts.push_back(check_text(checks[i]));
    return texts;
}

ClassAnswer compare_with(const ShapeClass& learnt, const LearntMember& object, const ClassifyOptions& options) {
    check_options(options, "classify");
    ClassAnswer answer;
    answer.name = learnt.name;
    answer.fit = object.fit;
    if (!object.fit.problem.empty()) {
        answer.undecided = "the template could not be registered to it: " + object.fit.problem;
        answer.score = std::numeric_limits<double>::max();
        return answer;
    }
    answer.misfit_limit = options.strict ? options.fit.max_off : std::max(options.fit.max_off, learnt.most_off.value_or(0));
    answer.fit_problem = fit_off_message(object.fit, answer.misfit_limit);
    answer.fit_failed = !fit_off_message(object.fit, std::max(uninformative_fit, answer.misfit_limit)).empty();
    answer.coordinates = coordinates_in(learnt.modes, landmarks_of(object.fit.points));
    answer.unusual_findings = unit_and_mirror_warnings(learnt, object, answer.coordinates);
    std::vector<ClassQuantity> quantities = object.quantities;
    const auto add = [&](const char* name, double value) {
        quantities.emplace_back().name = name;
        quantities.back().value = value;
    };
    add("from the mean shape", answer.coordinates.distance);
    add("outside the modes", answer.coordinates.outside);
    if (learnt.sizes) add("centroid size", answer.coordinates.centroid_size);
    std::map<std::string, std::string> worst;
    add_parts(learnt, quantities, worst);
    add_unlikeness(learnt, quantities, answer, worst);
    answer.parts = score_of_parts(quantities);
    answer.score = score_of(learnt, object, answer.coordinates) + answer.parts;
    bool any_decides = false;
    for (const LearntRange& range : learnt.ranges) {
        answer.checks.push_back(check_of(range, value_of(quantities, range.quantity.key()), options.check_attributes));
        QuantityCheck& check = answer.checks.back();
        check.worst = worst[range.quantity.key()];
        any_decides = any_decides || check.decides;
        if (check.decides && check.distance_from_range > 0) answer.rejecting_checks.push_back(answer.checks.size() - 1);
    }
    std::stable_sort(answer.rejecting_checks.begin(), answer.rejecting_checks.end(), [&](std::size_t a, std::size_t b) {
        const auto rank = [&](const QuantityCheck& check) {
            return check.quantity.kind == QuantityKind::constraint ? QuantityKind::proportion : check.quantity.kind;
        };
        const QuantityCheck &x = answer.checks[a], &y = answer.checks[b];
        return std::make_tuple(rank(x), -x.excess) < std::make_tuple(rank(y), -y.excess);
    });
    if (answer.fit_failed) {
        answer.verdict = Membership::other;
    } else if (!any_decides) {
        answer.undecided = learnt.has_thresholds()      ? "none of the learnt quantities can be measured on it"
                           : learnt.members.size() == 1 ? "the class has one member, from which no thresholds can be learnt"
                                                        : "the class has two members, from which no thresholds can be learnt";
    } else if (fitted_to_given(learnt, object) && only_shape(answer)) {
        answer.undecided = fmt::format(
            "the class was learnt from objects in correspondence, but this object was fitted: {}, which may be an error of the "
            "fit",
            check_text(answer.checks[answer.rejecting_checks.front()]));
        answer.rejecting_checks.clear();
    } else if (answer.rejecting_checks.empty() && !answer.fit_problem.empty()) {
        answer.undecided = answer.fit_problem;
    } else if (const QuantityCheck* check = not_recognised(answer); answer.rejecting_checks.empty() && check != nullptr) {
        answer.undecided = unsure_text(learnt, *check);
    } else {
        answer.verdict = answer.rejecting_checks.empty() ? Membership::member : Membership::other;
    }
    return answer;
}

Classification decide(std::string object, std::vector<ClassAnswer> answers, const ClassifyOptions& options) {
    if (answers.empty()) fail_usage("there is no class to compare with", "give at least one class");
    Classification result;
    result.object = std::move(object);
    result.answers = std::move(answers);
    if (std::all_of(result.answers.begin(), result.answers.end(), [](const ClassAnswer& class_answer) {
            return class_answer.dissimilarity || !class_answer.fit.problem.empty();
        }))
        for (ClassAnswer& class_answer : result.answers)
            if (class_answer.dissimilarity) class_answer.score = *class_answer.dissimilarity + class_answer.parts;
    int second = -1;
    std::size_t undecided_count = 0;
    for (std::size_t i = 0; i < result.answers.size(); ++i) {
        const ClassAnswer& class_answer = result.answers[i];
        const int k = static_cast<int>(i);
        const auto better = [&](int other) {
            return other < 0 || class_answer.score < result.answers[static_cast<std::size_t>(other)].score;
        };
        if (class_answer.fit.problem.empty() && better(result.nearest)) result.nearest = k;
        if (class_answer.verdict == Membership::undecided) ++undecided_count;
        if (class_answer.verdict != Membership::member) continue;
        if (better(result.best)) second = result.best, result.best = k;
        else if (better(second)) second = k;
    }
    const auto name = [&](int k) { return fmt::format("'{}'", result.answers[static_cast<std::size_t>(k)].name); };
    const auto score = [&](int k) { return result.answers[static_cast<std::size_t>(k)].score; };
    if (result.best >= 0 && second >= 0 && score(second) - score(result.best) <= options.tie_tolerance * score(second)) {
        result.text = fmt::format("cannot decide, because it may belong to {} as well as to {}", name(result.best), name(second));
        result.best = -1;
    } else if (result.best >= 0) {
        result.verdict = Membership::member;
        result.text = "belongs to " + name(result.best);
    } else if (const ClassAnswer* nearest_answer =
                   result.nearest < 0 ? nullptr : &result.answers[static_cast<std::size_t>(result.nearest)];
               nearest_answer != nullptr && nearest_answer->verdict == Membership::undecided &&
               undecided_count < result.answers.size()) {
        result.text =
            fmt::format("cannot decide: nearest to {}, which is undecided: {}", name(result.nearest), nearest_answer->undecided);
    } else if (undecided_count == result.answers.size()) {
        result.text = "cannot decide, because " + result.answers.front().undecided;
        if (result.nearest >= 0 && result.answers.size() > 1) result.text += "; nearest to " + name(result.nearest);
    } else {
        result.verdict = Membership::other;
        result.text = result.answers.size() == 1 ? "does not belong to " + name(0) : "belongs to none";
        if (undecided_count > 0) result.text += " of the classes that are decided";
        if (result.answers.size() > 1 && result.nearest >= 0) result.text += "; nearest to " + name(result.nearest);
    }
    return result;
}

void ClassifyOptions::declare_options(OptionList& list) {
    fit.declare_options(list);
    list("correspondence", correspondence,
         "vertex correspondence between template and object: given (the object must have the template's triangles), fitted (the "
         "template is fitted to the object), or auto (given if the object has the template's triangles, otherwise fitted)",
         Choices{"auto", "given", "fitted"});
    list("strict", strict, "decide whether the template fits an object by --max-off alone, without comparison with the members",
         Anything{});
    list("check-attributes", check_attributes, "also reject objects with attribute values outside the ranges of the class",
         Anything{});
    list("close", tie_tolerance, "minimum relative difference of the scores of two classes that are distinguished", Range{0, 1});
}

}  // namespace ostraka
