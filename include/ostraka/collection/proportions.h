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
    enum class Correction { bh, by } correction = Correction::bh;  ///< Benjamini and Hochberg, and Yekutieli
    int permutations = 4999;
    double range = 0.9;
    double confidence = 0.95;
    std::uint64_t seed = 1;

    void describe(OptionList& visit);
};

/// A row of Table 3.1 and the uncertainty of what varies.
struct MeasureRow {
    std::string name, unit;
    std::optional<Summary> summary;  ///< none without a value
    std::optional<Interval> deviation_interval,
        variation_interval;  ///< of the standard deviation, of the coefficient of variation
    /// Standard deviation of the logarithm about the common size of the object, estimated from all ratios with this measure (as
    /// in Friedman and Alm 2012, equation 6); none for fewer than three measures of its kind.
    std::optional<double> own_deviation;
};

enum class Fixedness {
    unknown,    ///< too few objects to say anything, or identical ones
    free,       ///< the two measures have nothing to do with each other
    with_size,  ///< both follow the size of the object; the ratio is no more stable than others
    stable,     ///< more stable than other ratios, but only as far as both measures follow the size closely
    fixed       ///< more stable than other ratios and than the common size explains
};
std::string to_string(Fixedness fixedness);

struct RatioRow {
    std::size_t numerator = 0, denominator = 0;  ///< measures; the one with the larger median comes first
    MeasureRow row;
    double log_deviation = 0;  ///< standard deviation of the logarithm of the ratio
    double low = 0, high = 0;  ///< quantiles that span the share `range` of the ratios
    double p_pairing = 1;      ///< that the one measure of an object is paired with the other of any
    double p_others = 1;  ///< that the ratio is as variable as those of any two measures, deviations from the size dealt out anew
    std::optional<double>
        p_size;  ///< that nothing but the common size binds them; none where it was not asked or cannot be determined
    double q = 1, q_pairing = 1;  ///< corrected for the number of ratios: of the larger of p_others and p_size, and of p_pairing
    double q_others = 1;          ///< the same of p_others
    Fixedness fixedness = Fixedness::unknown;
};

/// The questions that a ratio failed ("pairing", "others", "size"), empty where it is fixed; "nothing is known" where nothing
/// can be said.
std::string not_fixed_because(const RatioRow& ratio, double false_discoveries);

struct ProportionStudy {
    std::vector<MeasureRow> measures;
    std::vector<RatioRow> ratios;          ///< of measures of the same kind
    std::optional<double> size_deviation;  ///< of the logarithm of the common size of objects, by the lengths
    std::vector<std::string> notes;
};

/// Describes every measure and every ratio of two measures of one kind (the same power of a length, or the same unit), and tests
/// on logarithms which ratios are fixed. A ratio is called fixed if (a) it varies less than ratios do when each object's
/// deviations from its size are dealt out anew among its measures, and (b), where at least two measures, or groups of them that
/// go together by (a), are left to tell the size by, the two deviate from that size together: their deviations from the mean of
/// the others, less what the error of that mean adds, are correlated more than when all deviations are shuffled over the objects.
/// The two p-values are joined as their larger one and corrected for the number of ratios. A ratio that is the same in all of
/// four objects or more, but for rounding, is fixed, with the smallest p-values that the permutations allow; where all measures
/// of all objects are the same, nothing is known. Values that are not above zero count as missing, and so do, with a note, those
/// beyond 1e35 or within 1e-35. Throws Error (input) for no measure or no object, Error (usage) for more than 60 measures or
/// options out of range. Results are the same for any number of threads. doc/proportions.md explains.
ProportionStudy study_proportions(const MeasureTable& table, const ProportionOptions& options = {});

}  // namespace ostraka
