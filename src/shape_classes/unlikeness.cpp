#include "ostraka/shape_classes/unlikeness.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace ostraka {

namespace {

/// Names of what counts: all but what refers to the mean shape.
const std::set<std::string>& names_that_count() {
    static const std::set<std::string> names = [] {
        std::set<std::string> list;
        for (const ClassQuantity& quantity : geometry_quantities(std::optional<FitResiduals>())) list.insert(quantity.name);
        for (const ClassQuantity& quantity : geometry_quantities(WholeShape())) list.insert(quantity.name);
        return list;
    }();
    return names;
}

/// What counts as normal. Shares between 0 and 1 by their logits, a per cent away from the ends; a length of a ten-thousandth is
/// none.
double normal_scale(const ClassQuantity& quantity, double value) {
    constexpr double end = 0.01, least = 1e-4;
    if (is_share_of_surface(quantity)) return std::log((value + end) / (1 - value + end));
    return std::log(std::max(value, least));
}

}  // namespace

bool counts_for_unlikeness(const ClassQuantity& quantity) {
    return quantity.kind == QuantityKind::geometry && quantity.id < 0 && names_that_count().count(quantity.name) > 0;
}

SampleMoments unlikeness_moments(const LearntRange& range, std::optional<std::size_t> without) {
    std::vector<double> values;
    for (std::size_t i = 0; i < range.values.size(); ++i)
        if (i != without && range.values[i]) values.push_back(normal_scale(range.quantity, *range.values[i]));
    return moments_of(values);
}

std::optional<Unlikeness> unlikeness(const ShapeClass& learnt, const std::vector<std::optional<double>>& values,
                                     std::optional<std::size_t> without) {
    constexpr std::size_t least_quantities = 3;
    Unlikeness result;
    for (std::size_t k = 0; k < learnt.ranges.size(); ++k) {
        const LearntRange& range = learnt.ranges[k];
        if (!counts_for_unlikeness(range.quantity) || !values[k]) continue;
        SampleMoments known = unlikeness_moments(range, without);
        if (known.count < 2) continue;
        known.variance += learnt.resolution * learnt.resolution;
        if (const auto prior = learnt.variances.find(range.quantity.key()); prior != learnt.variances.end())
            known = prior->second.moderate(known);
        const double deviation = std::sqrt(known.variance * (1 + 1 / static_cast<double>(known.count)));
        if (!(deviation > 0)) continue;
        double off = (normal_scale(range.quantity, *values[k]) - known.mean) / deviation;
        if (range.quantity.one_sided) off = std::max(0.0, off);
        if (result.count == 0 || std::abs(off) > std::abs(result.off)) result.off = off, result.worst = k;
        result.value += std::abs(off);
        ++result.count;
    }
    if (result.count < least_quantities) return {};
    result.value /= static_cast<double>(result.count);
    return result;
}

void measure_unlikeness(ShapeClass& learnt) {
    if (!learnt.has_thresholds()) return;
    const auto measured = [&](const std::vector<std::optional<double>>& values, std::optional<std::size_t> without) {
        const auto found = unlikeness(learnt, values, without);
        return found ? std::optional(found->value) : std::nullopt;
    };
    std::vector<std::optional<double>> own, theirs;
    for (std::size_t i = 0; i < learnt.members.size(); ++i) {
        std::vector<std::optional<double>> values;
        for (const LearntRange& range : learnt.ranges) values.push_back(range.values[i]);
        own.push_back(measured(values, i));
    }
    for (std::size_t i = 0; i < learnt.strangers.size(); ++i) {
        std::vector<std::optional<double>> values;
        for (const LearntRange& range : learnt.ranges)
            values.push_back(i < range.strangers.size() ? range.strangers[i] : std::nullopt);
        theirs.push_back(measured(values, {}));
    }
    ClassQuantity quantity;
    quantity.name = unlike_the_members;
    quantity.one_sided = true;
    const auto found = std::find_if(learnt.ranges.begin(), learnt.ranges.end(),
                                    [&](const LearntRange& range) { return range.quantity.key() == quantity.key(); });
    LearntRange& range = found != learnt.ranges.end() ? *found : learnt.ranges.emplace_back();
    range.quantity = quantity;
    range.values = std::move(own);
    range.strangers = std::move(theirs);
}

void set_recognised(LearntRange& range, const SampleMoments& members, double accept, double unsure) {
    range.recognised.reset();
    if (!range.high) return;
    std::vector<double> logs;
    for (const auto& value : range.strangers)
        if (value && *value > 0) logs.push_back(std::log(*value));
    if (logs.size() < ShapeClass::min_members) {
        constexpr double half = 0.5;
        range.recognised = std::min(*range.high, std::max(half, std::exp(predict(members, true, unsure).high)));
        return;
    }
    const SampleMoments theirs = moments_of(logs);
    range.recognised = std::min(*range.high, std::exp(2 * theirs.mean - predict(theirs, true, accept).high));
    range.high = std::max(*range.recognised, std::min(*range.high, std::exp(theirs.mean)));
}

}  // namespace ostraka
