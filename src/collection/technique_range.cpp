// Out-of-class objects of a technique study.
#include "collection/technique_model.h"

#include "ostraka/execution/parallel.h"
#include "ostraka/stats/summary.h"

#include <cmath>

namespace ostraka {

namespace {

/// Minimum spread: smaller differences are insignificant, however similar the labelled objects are.
constexpr double min_spread = 0.05;

/// Distances are measured on logarithms; for the ratio of sides, on the logarithm of its difference to 1. Coherence is not
/// compared: it is bounded, and has no natural scale near its bounds.
bool compared(const DescriptorMeaning& descriptor) { return descriptor.name != "coherence"; }
double on_scale(const DescriptorMeaning& descriptor, double table_value) {
    return descriptor.positive ? table_value : std::log(std::max(1 - table_value, 1e-3));
}
double from_scale(const DescriptorMeaning& descriptor, double value) {
    return descriptor.positive ? std::exp(value) : 1 - std::exp(value);
}

/// Values of one descriptor over the labelled objects, by class.
struct LabelledValues {
    std::vector<double> values[2];
    [[nodiscard]] bool enough() const { return std::min(values[0].size(), values[1].size()) >= min_compared; }
};

/// Outward distance of `x` from the nearer class median, in robust standard deviations about the medians (Rousseeuw and Croux
/// 1993), widened by 5 / n for the uncertainty of small samples.
double distance_outside(const LabelledValues& class_values, double x) {
    const double medians[2]{sample_quantile(class_values.values[0], 0.5), sample_quantile(class_values.values[1], 0.5)};
    std::vector<double> deviations;
    for (int class_index = 0; class_index < 2; ++class_index)
        for (const double value : class_values.values[class_index]) deviations.push_back(std::abs(value - medians[class_index]));
    const double n = static_cast<double>(deviations.size());
    const double spread = std::max(min_spread, 1.4826 * sample_quantile(std::move(deviations), 0.5)) * (1 + 5 / n);
    return std::max({0.0, std::min(medians[0], medians[1]) - x, x - std::max(medians[0], medians[1])}) / spread;
}

}  // namespace

std::vector<std::optional<TechniqueOutlier>> technique_outliers(const std::vector<TechniqueObject>& objects,
                                                                const std::string& positive, double min_outlier_distance) {
    std::vector<std::optional<TechniqueOutlier>> result(objects.size());
    for (const DescriptorMeaning& descriptor : technique_descriptors()) {
        if (!compared(descriptor)) continue;
        const DescriptorTable table = descriptor_table(objects, {descriptor.name});
        const Labelled labelled_rows = labelled(objects, table, positive);
        parallel_for(table.objects.size(), 8, [&](std::size_t row) {
            const auto value = [&](std::size_t table_row) {
                return on_scale(descriptor, table.values(static_cast<Eigen::Index>(table_row), 0));
            };
            LabelledValues other_values;
            for (const std::size_t other : labelled_rows.rows)
                if (other != row) other_values.values[labelled_rows.truth[other] ? 1 : 0].push_back(value(other));
            if (!other_values.enough()) return;
            const double distance = distance_outside(other_values, value(row));
            auto& maximum = result[table.objects[row]];
            if (distance < min_outlier_distance || (maximum && maximum->distance >= distance)) return;
            std::vector<double> scaled_values = other_values.values[0];
            scaled_values.insert(scaled_values.end(), other_values.values[1].begin(), other_values.values[1].end());
            for (double& scaled_value : scaled_values) scaled_value = from_scale(descriptor, scaled_value);
            const auto [low, high] = std::minmax_element(scaled_values.begin(), scaled_values.end());
            maximum = TechniqueOutlier{descriptor.name, from_scale(descriptor, value(row)), *low, *high, distance};
        });
    }
    return result;
}

}  // namespace ostraka
