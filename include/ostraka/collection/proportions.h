// Finds the proportions (ratios of two measures) that are fixed in a collection of objects (thesis, section 3.2.2, Table 3.1).
#pragma once

#include "ostraka/collection/measure_table.h"
#include "ostraka/core/options.h"
#include "ostraka/stats/inference.h"
#include "ostraka/stats/summary.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// Options of `study_proportions`.
struct ProportionOptions {
    double false_discoveries = 0.05;  ///< allowed fraction of false discoveries among the ratios reported as fixed
    enum class Correction { bh, by } correction = Correction::bh;  ///< Benjamini-Hochberg, Benjamini-Yekutieli
    int permutations = 4999;                                       ///< number of random permutations per test
    double range = 0.9;        ///< a proposed range of a ratio covers this fraction of the observed ratios
    double confidence = 0.95;  ///< confidence level of intervals
    std::uint64_t seed = 1;    ///< random seed

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Statistics of one measure or ratio: a row of Table 3.1 of the thesis, with confidence intervals.
struct MeasureRow {
    std::string name, unit;          ///< name of the measure, or of the ratio; unit of its values
    std::optional<Summary> summary;  ///< statistics of the values; none if there are no values
    /// Intervals of the standard deviation and of the coefficient of variation.
    std::optional<Interval> deviation_interval, variation_interval;
    /// Standard deviation of the logarithm of the measure after subtraction of the object's common size, estimated from all
    /// ratios with this measure (as in Friedman and Alm 2012, equation 6); none if there are fewer than three measures with the
    /// same power or unit.
    std::optional<double> own_deviation;
};

/// How stable the ratio of two measures is.
enum class Fixedness {
    unknown,    ///< too few objects for a test, or identical objects
    free,       ///< the two measures are unrelated
    with_size,  ///< both measures follow the size of the object; the ratio is no more stable than other ratios
    stable,     ///< the ratio is more stable than other ratios, but only because both measures follow the size closely
    fixed       ///< the ratio is more stable than other ratios, and more than the common size explains
};
std::string to_string(Fixedness fixedness);

/// Statistics and tests of the ratio of two measures.
struct RatioRow {
    /// Indices of the two measures; the numerator has the larger median.
    std::size_t numerator = 0, denominator = 0;
    MeasureRow row;            ///< statistics of the ratio
    double log_deviation = 0;  ///< standard deviation of the logarithm of the ratio
    /// Quantiles that enclose the fraction `range` (ProportionOptions) of the observed ratios.
    double low = 0, high = 0;
    /// P-value of the null hypothesis that the two measures are paired at random across objects.
    double p_pairing = 1;
    /// P-value of the null hypothesis that the ratio varies as much as ratios vary when each object's deviations from its size
    /// are permuted among its measures.
    double p_others = 1;
    /// P-value of the null hypothesis that only the common size relates the two measures; none if not tested or undetermined.
    std::optional<double> p_size;
    /// P-values corrected for the number of ratios. q: the larger of p_others and p_size; q_pairing: p_pairing.
    double q = 1, q_pairing = 1;
    double q_others = 1;  ///< p_others corrected for the number of ratios
    Fixedness fixedness = Fixedness::unknown;
};

/// Names of the tests that a ratio failed ("pairing", "others", "size"). The text is empty if the ratio is fixed, and "nothing
/// is known" if no test is possible.
std::string reason_not_fixed(const RatioRow& ratio, double false_discoveries);

/// Result of `study_proportions`.
struct ProportionStudy {
    std::vector<MeasureRow> measures;  ///< one per measure of the table
    std::vector<RatioRow> ratios;      ///< one per pair of measures of the same kind (same power or unit)
    /// Standard deviation of the logarithm of the objects' common size, from the lengths; none if unknown.
    std::optional<double> size_deviation;
    std::vector<std::string> notes;  ///< messages about values that were ignored and tests that were not possible
};

/// Describes every measure and every ratio of two measures of one kind (the same power of a length, or the same unit), and tests
/// on logarithms which ratios are fixed. A ratio is fixed if it passes two tests. (a) The ratio varies less than ratios do when
/// each object's deviations from its size are permuted among its measures. (b) The two measures deviate from the size together:
/// the deviations of both from the mean of the other measures, corrected for the error of that mean, are correlated more
/// strongly than after the deviations are permuted over the objects. Test (b) applies only if at least two other measures, or
/// groups of measures related by (a), are available to estimate the size. The p-value of a ratio is the larger p-value of tests
/// (a) and (b), corrected for the number of ratios. A ratio that is constant, up to rounding, in four or more objects is fixed,
/// with the smallest p-value that the permutations allow; if all measures of all objects are equal, the result is unknown.
/// Values that are not positive, above 1e35 or below 1e-35 count as missing (very large and very small values with a note).
/// Throws Error (input) for no measure or no object, Error (usage) for more than 60 measures or options out of range. Results
/// do not depend on the number of threads. See doc/proportions.md.
ProportionStudy study_proportions(const MeasureTable& table, const ProportionOptions& options = {});

}  // namespace ostraka
