// Which proportions of the objects of a collection are fixed (thesis, section 3.2.2, Table 3.1).
#pragma once

#include "ostraka/collection/measure_table.h"
#include "ostraka/core/options.h"
#include "ostraka/stats/inference.h"
#include "ostraka/stats/summary.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

struct ProportionOptions {
    double false_discoveries = 0.05;
    enum class Correction { bh, by } correction = Correction::bh;  ///< Benjamini-Hochberg, Benjamini-Yekutieli
    int permutations = 4999;
    double range = 0.9;
    double confidence = 0.95;
    std::uint64_t seed = 1;

    void describe(OptionList& visit);
};

/// A row of Table 3.1 with confidence intervals of its variation.
struct MeasureRow {
    std::string name, unit;
    std::optional<Summary> summary;  ///< none if there are no values
    std::optional<Interval> deviation_interval,
        variation_interval;  ///< intervals of the standard deviation and of the coefficient of variation
    /// Standard deviation of the logarithm about the common size of the object, estimated from all ratios with this measure (as
    /// in Friedman and Alm 2012, equation 6); none for fewer than three measures of its kind.
    std::optional<double> own_deviation;
};

enum class Fixedness {
    unknown,    ///< too few objects for a test, or identical objects
    free,       ///< the two measures are unrelated
    with_size,  ///< both follow the size of the object; the ratio is no more stable than others
    stable,     ///< more stable than other ratios, but only because both measures follow the size closely
    fixed       ///< more stable than other ratios and than the common size explains
};
std::string to_string(Fixedness fixedness);

struct RatioRow {
    std::size_t numerator = 0, denominator = 0;  ///< indices of the measures; the numerator has the larger median
    MeasureRow row;
    double log_deviation = 0;  ///< standard deviation of the logarithm of the ratio
    double low = 0, high = 0;  ///< quantiles that enclose the share `range` of the ratios
    double p_pairing = 1;      ///< null hypothesis: the two measures are paired at random across objects
    double p_others = 1;       ///< null hypothesis: varies as ratios do with deviations from the size permuted among measures
    /// Null hypothesis: only the common size relates the two measures; none if not tested or undetermined.
    std::optional<double> p_size;
    double q = 1, q_pairing = 1;  ///< corrected for the number of ratios: the larger of p_others and p_size; p_pairing
    double q_others = 1;          ///< p_others, corrected for the number of ratios
    Fixedness fixedness = Fixedness::unknown;
};

/// The tests that a ratio failed ("pairing", "others", "size"); empty if the ratio is fixed; "nothing is known" if no test is
/// possible.
std::string reason_not_fixed(const RatioRow& ratio, double false_discoveries);

struct ProportionStudy {
    std::vector<MeasureRow> measures;
    std::vector<RatioRow> ratios;          ///< ratios of measures of the same kind
    std::optional<double> size_deviation;  ///< standard deviation of the logarithm of the common size, from the lengths
    std::vector<std::string> notes;
};

/// Describes every measure and every ratio of two measures of one kind (the same power of a length, or the same unit), and
/// tests on logarithms which ratios are fixed. A ratio is fixed if it passes two tests. (a) It varies less than ratios do when
/// each object's deviations from its size are permuted among its measures. (b) The two measures deviate from the size together:
/// their deviations from the mean of the others, corrected for the error of that mean, are correlated more than when all
/// deviations are shuffled over the objects. Test (b) applies only if at least two other measures, or groups of measures
/// related by (a), are left to estimate the size. The p-value of a ratio is the larger of the two, corrected for the number of
/// ratios. A ratio that is constant, up to rounding, in four or more objects is fixed, with the smallest p-value that the
/// permutations allow; if all measures of all objects are equal, the result is unknown. Values that are not positive count as
/// missing, and so do, with a note, values above 1e35 or below 1e-35. Throws Error (input) for no measure or no object, Error
/// (usage) for more than 60 measures or options out of range. Results do not depend on the number of threads. See
/// doc/proportions.md.
ProportionStudy study_proportions(const MeasureTable& table, const ProportionOptions& options = {});

}  // namespace ostraka
