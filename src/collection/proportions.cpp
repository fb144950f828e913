#include "ostraka/collection/proportions.h"

#include "collection/ratio_tests.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/mesh/disjoint_sets.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace ostraka {

namespace {

using proportions::Pair;

constexpr double no_ratio = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t max_measures = 60;
constexpr std::size_t enough_objects = 10;

MeasureRow row_of(const std::string& name, const std::string& unit, const std::vector<double>& values, double confidence) {
    MeasureRow row{name, unit, std::nullopt, std::nullopt, std::nullopt, std::nullopt};
    if (values.empty()) return row;
    row.summary = summarise(values, name);
    row.deviation_interval = deviation_interval(values, false, confidence);
    row.variation_interval = deviation_interval(values, true, confidence);
    return row;
}

/// The measures of one kind that have values. Ratios are taken among them.
struct Kind {
    std::vector<std::size_t> measures;
    Eigen::MatrixXd logs;  ///< logarithms of the positive values
};

std::vector<Kind> kinds_of(const MeasureTable& table) {
    std::map<std::pair<int, std::string>, Kind> kinds;
    for (std::size_t j = 0; j < table.measures.size(); ++j) {
        const MeasureColumn& column = table.measures[j];
        if (table.values.col(static_cast<Eigen::Index>(j)).array().isNaN().all()) continue;
        kinds[{column.power, column.power == 0 ? column.unit : ""}].measures.push_back(j);
    }
    std::vector<Kind> result;
    for (auto& [key, kind] : kinds) {
        kind.logs.resize(table.values.rows(), static_cast<Eigen::Index>(kind.measures.size()));
        for (std::size_t c = 0; c < kind.measures.size(); ++c)
            for (Eigen::Index i = 0; i < table.values.rows(); ++i) {
                const double value = table.values(i, static_cast<Eigen::Index>(kind.measures[c]));
                kind.logs(i, static_cast<Eigen::Index>(c)) = value > 0 ? std::log(value) : no_ratio;
            }
        result.push_back(std::move(kind));
    }
    return result;
}

std::vector<double> corrected(const std::vector<double>& p, ProportionOptions::Correction correction) {
    return correction == ProportionOptions::Correction::by ? benjamini_yekutieli(p) : benjamini_hochberg(p);
}

/// Labels connected components of measures: joined pairs get the same label.
std::vector<int> components(std::size_t count, const std::vector<Pair>& joined_pairs) {
    DisjointSets sets(count);
    for (const Pair& pair : joined_pairs) sets.unite_into(static_cast<std::size_t>(pair.a), static_cast<std::size_t>(pair.b));
    std::vector<int> group;
    for (std::size_t i = 0; i < count; ++i) group.push_back(static_cast<int>(sets.find(i)));
    return group;
}

/// A ratio whose p-value is not corrected yet.
struct Candidate {
    RatioRow ratio;
    Pair pair;
    std::size_t count = 0;
    bool constant = false;  ///< equal in at least four objects that are not identical
};

/// Equality up to the rounding of a division.
bool all_same(double minimum, double maximum) { return maximum - minimum <= 1e-12 * std::abs(maximum); }

/// Whether each measure is the same in all objects that have it.
bool are_identical(const MeasureTable& table) {
    for (Eigen::Index j = 0; j < table.values.cols(); ++j) {
        double minimum = std::numeric_limits<double>::infinity(), maximum = -minimum;
        for (const double value : table.values.col(j))
            if (!std::isnan(value)) minimum = std::min(minimum, value), maximum = std::max(maximum, value);
        if (minimum < maximum && !all_same(minimum, maximum)) return false;
    }
    return true;
}

/// Rows and p-values of the ratios of one kind.
std::vector<Candidate> ratios_of(const MeasureTable& table, const Kind& kind, bool identical, const ProportionOptions& options) {
    std::vector<Candidate> candidates;
    const auto m = static_cast<Eigen::Index>(kind.measures.size());
    std::vector<double> medians;
    for (Eigen::Index j = 0; j < m; ++j) {
        std::vector<double> values;
        for (const double value : kind.logs.col(j))
            if (!std::isnan(value)) values.push_back(value);
        medians.push_back(values.empty() ? -std::numeric_limits<double>::infinity() : summarise(values).median);
    }
    for (Eigen::Index a = 0; a < m; ++a)
        for (Eigen::Index b = a + 1; b < m; ++b) {
            Candidate candidate;
            const bool swapped = medians[static_cast<std::size_t>(b)] > medians[static_cast<std::size_t>(a)];
            candidate.pair = swapped ? Pair{b, a} : Pair{a, b};
            candidate.ratio.numerator = kind.measures[static_cast<std::size_t>(candidate.pair.a)];
            candidate.ratio.denominator = kind.measures[static_cast<std::size_t>(candidate.pair.b)];
            candidates.push_back(std::move(candidate));
        }
    const Eigen::MatrixXd centred = proportions::centred_columns(kind.logs);
    parallel_for(candidates.size(), 1, [&](std::size_t r) {
        Candidate& candidate = candidates[r];
        RatioRow& ratio = candidate.ratio;
        std::vector<double> values;
        for (Eigen::Index i = 0; i < centred.rows(); ++i) {
            if (std::isnan(centred(i, candidate.pair.a)) || std::isnan(centred(i, candidate.pair.b))) continue;
            const double value = table.values(i, static_cast<Eigen::Index>(ratio.numerator)) /
                                 table.values(i, static_cast<Eigen::Index>(ratio.denominator));
            if (std::isfinite(value) && value > 0) values.push_back(value);
        }
        candidate.count = values.size();
        candidate.constant =
            !identical && values.size() >= 4 &&
            all_same(*std::min_element(values.begin(), values.end()), *std::max_element(values.begin(), values.end()));
        ratio.row = row_of(fmt::format("{} / {}", table.measures[ratio.numerator].name, table.measures[ratio.denominator].name),
                           "", values, options.confidence);
        if (values.empty()) return;
        ratio.log_deviation = std::sqrt(proportions::ratio_variance(centred, candidate.pair).value);
        ratio.low = sample_quantile(values, (1 - options.range) / 2);
        ratio.high = sample_quantile(values, (1 + options.range) / 2);
    });
    return candidates;
}

void test(std::vector<Candidate>& candidates, const Kind& kind, const ProportionOptions& options, int permutations,
          std::uint64_t seed) {
    if (candidates.empty()) return;
    const Eigen::MatrixXd centred = proportions::centred_columns(kind.logs);
    std::vector<Pair> pairs;
    for (const Candidate& candidate : candidates) pairs.push_back(candidate.pair);
    std::vector<double> pairing = proportions::pairing_test(centred, pairs, permutations, seed);
    // With two measures of a kind there is no other ratio to compare with.
    std::vector<double> p_others = kind.measures.size() < 3 ? std::vector<double>(candidates.size(), 1.0)
                                                            : proportions::others_test(centred, pairs, permutations, seed + 1);
    // A ratio that does not vary at all is not due to chance: it gets the smallest p-value of the permutation test.
    for (std::size_t r = 0; r < candidates.size(); ++r)
        if (candidates[r].constant) pairing[r] = p_others[r] = 1 / (1 + static_cast<double>(permutations));
    const std::vector<double> q = corrected(p_others, options.correction);
    std::vector<Pair> joined_pairs;
    for (std::size_t r = 0; r < candidates.size(); ++r) {
        candidates[r].ratio.p_pairing = pairing[r];
        candidates[r].ratio.p_others = p_others[r];
        if (q[r] <= options.false_discoveries) joined_pairs.push_back(pairs[r]);
    }
    const std::vector<int> groups = components(kind.measures.size(), joined_pairs);
    for (std::size_t r = 0; r < candidates.size(); ++r)
        if (q[r] <= options.false_discoveries && !candidates[r].constant)
            candidates[r].ratio.p_size = proportions::size_test(centred, pairs[r], groups, permutations, seed + 2 + r);
}

Fixedness verdict(const Candidate& candidate, bool identical, double alpha, double q_others) {
    const RatioRow& ratio = candidate.ratio;
    if (candidate.count < 4 || identical) return Fixedness::unknown;
    if (ratio.q <= alpha || candidate.constant) return Fixedness::fixed;
    if (q_others <= alpha) return Fixedness::stable;
    return ratio.q_pairing <= alpha ? Fixedness::with_size : Fixedness::free;
}

void check(const MeasureTable& table, std::vector<std::string>& notes) {
    if (table.measures.empty()) fail_input("measures", "the table has no measure", "define at least one measure");
    if (table.objects.empty()) fail_input("measures", "the table has no object", "give at least one object");
    if (table.measures.size() > max_measures)
        fail_usage(fmt::format("there are {} measures, and every pair of them gives a ratio", table.measures.size()),
                   "use at most " + std::to_string(max_measures));
    std::size_t missing = 0, not_positive = 0;
    for (Eigen::Index i = 0; i < table.values.rows(); ++i)
        for (Eigen::Index j = 0; j < table.values.cols(); ++j) {
            const double value = table.values(i, j);
            if (std::isnan(value)) ++missing;
            else if (!std::isfinite(value))
                fail_input(
                    "measures",
                    fmt::format("the value of '{}' of object '{}' is not finite",
                                table.measures[static_cast<std::size_t>(j)].name, table.objects[static_cast<std::size_t>(i)]),
                    "remove the value");
            else if (!(value > 0)) ++not_positive;
        }
    if (missing > 0)
        notes.push_back(
            fmt::format("missing values: {} of {}; each row reports its number of objects", missing, table.values.size()));
    if (not_positive > 0)
        notes.push_back(fmt::format("values that are not positive: {}; ratios with them are left out", not_positive));
}

/// Values whose fourth powers, or those of their ratios, overflow or underflow become missing.
MeasureTable without_extremes(MeasureTable table, std::vector<std::string>& notes) {
    constexpr double largest = 1e35;
    std::size_t count = 0;
    std::string first;
    for (Eigen::Index i = 0; i < table.values.rows(); ++i)
        for (Eigen::Index j = 0; j < table.values.cols(); ++j) {
            double& value = table.values(i, j);
            const double size = std::abs(value);
            if (!std::isfinite(value) || value == 0 || (size <= largest && size >= 1 / largest)) continue;
            if (count++ == 0)
                first = fmt::format("'{}' of '{}' is {}", table.measures[static_cast<std::size_t>(j)].name,
                                    table.objects[static_cast<std::size_t>(i)], digits(value));
            value = no_ratio;
        }
    if (count > 0)
        notes.push_back(fmt::format(
            "values left out because they are too large or too small for the computation: {} (the first: {})", count, first));
    return table;
}

/// Appends the statistics of each measure, and notes on those without values.
void describe_measures(ProportionStudy& study, const UnifiedMeasures& unified, double confidence) {
    const MeasureTable& table = unified.table;
    for (std::size_t j = 0; j < table.measures.size(); ++j) {
        std::vector<double> values;
        for (std::size_t i = 0; i < table.objects.size(); ++i)
            if (const double value = table.values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
                !std::isnan(value) && (table.measures[j].power == 0 || unified.comparable[i]))
                values.push_back(value);
        const bool absent = table.values.col(static_cast<Eigen::Index>(j)).array().isNaN().all();
        // The unit of a measure that was never taken is unknown.
        study.measures.push_back(row_of(table.measures[j].name, absent ? "" : table.measures[j].unit, values, confidence));
        if (absent)
            study.notes.push_back(
                fmt::format("measure '{}' has no value in any object and is not used in ratios", table.measures[j].name));
        else if (values.empty())
            study.notes.push_back(fmt::format("measure '{}' has no value that can be compared", table.measures[j].name));
    }
}

/// The standard deviation of the size shared by two lengths: from their covariance over the comparable objects.
std::optional<double> size_deviation(const Eigen::MatrixXd& centred, const std::vector<double>& deviations,
                                     const std::vector<bool>& comparable) {
    double sum = 0, count = 0;
    for (Eigen::Index c = 0; c < centred.cols(); ++c) {
        double mean = 0, square = 0, n = 0;
        for (Eigen::Index i = 0; i < centred.rows(); ++i)
            if (comparable[static_cast<std::size_t>(i)] && !std::isnan(centred(i, c)))
                mean += centred(i, c), square += centred(i, c) * centred(i, c), n += 1;
        if (n < 2) continue;
        const double deviation = deviations[static_cast<std::size_t>(c)];
        sum += (square - mean * mean / n) / (n - 1) - deviation * deviation;
        count += 1;
    }
    if (count == 0) return {};
    return std::sqrt(std::max(0.0, sum / count));
}

/// Tests the ratios within each kind of measure, and enters the deviations of the measures.
std::vector<Candidate> tested_candidates(ProportionStudy& study, const UnifiedMeasures& unified, const std::vector<Kind>& kinds,
                                         bool identical, const ProportionOptions& options) {
    std::vector<Candidate> all_candidates;
    std::size_t ratios = 0;
    for (const Kind& kind : kinds) ratios += kind.measures.size() * (kind.measures.size() - 1) / 2;
    // Enough permutations that a single fixed ratio can fall below its corrected limit.
    const int permutations =
        std::max(options.permutations, static_cast<int>(std::ceil(2 * static_cast<double>(ratios) / options.false_discoveries)));
    for (std::size_t k = 0; k < kinds.size(); ++k) {
        const Kind& kind = kinds[k];
        std::vector<Candidate> candidates = ratios_of(unified.table, kind, identical, options);
        test(candidates, kind, options, permutations, options.seed + 1000003 * (k + 1));
        const Eigen::MatrixXd centred = proportions::centred_columns(kind.logs);
        if (const auto deviations = proportions::own_deviations(centred)) {
            for (std::size_t c = 0; c < deviations->size(); ++c)
                study.measures[kind.measures[c]].own_deviation = (*deviations)[c];
            if (unified.table.measures[kind.measures.front()].power == 1)
                if (const auto shared = size_deviation(centred, *deviations, unified.comparable)) study.size_deviation = *shared;
        }
        all_candidates.insert(all_candidates.end(), std::make_move_iterator(candidates.begin()),
                              std::make_move_iterator(candidates.end()));
    }
    return all_candidates;
}

/// Corrects the p-values for the number of tests, classifies the ratios and appends them.
void classify_ratios(ProportionStudy& study, std::vector<Candidate> candidates, bool identical,
                     const ProportionOptions& options) {
    std::vector<double> joint, others, pairing;
    for (const Candidate& candidate : candidates) {
        joint.push_back(std::max(candidate.ratio.p_others, candidate.ratio.p_size.value_or(0)));
        others.push_back(candidate.ratio.p_others);
        pairing.push_back(candidate.ratio.p_pairing);
    }
    const std::vector<double> q = corrected(joint, options.correction), q_others = corrected(others, options.correction),
                              q_pairing = corrected(pairing, options.correction);
    std::size_t too_few = 0, constant = 0;
    for (std::size_t r = 0; r < candidates.size(); ++r) {
        Candidate& candidate = candidates[r];
        candidate.ratio.q = q[r];
        candidate.ratio.q_pairing = q_pairing[r];
        candidate.ratio.q_others = q_others[r];
        candidate.ratio.fixedness = verdict(candidate, identical, options.false_discoveries, q_others[r]);
        too_few += candidate.count < 4 ? 1 : 0;
        constant += candidate.constant ? 1 : 0;
        study.ratios.push_back(std::move(candidate.ratio));
    }
    if (too_few > 0)
        study.notes.push_back("ratios known for fewer than four objects, which are not classified: " + std::to_string(too_few));
    if (constant > 0) study.notes.push_back("ratios that are exactly equal in all objects: " + std::to_string(constant));
}

}  // namespace

std::string to_string(Fixedness fixedness) {
    static constexpr const char* words[]{"unknown", "free", "with size", "stable", "fixed"};
    return words[static_cast<std::size_t>(fixedness)];
}

std::string reason_not_fixed(const RatioRow& ratio, double false_discoveries) {
    switch (ratio.fixedness) {
        case Fixedness::fixed:
            return "";
        case Fixedness::stable:
            // Either both p-values are small separately but not combined, or only the size relates the two measures.
            return ratio.p_size && *ratio.p_size > ratio.p_others ? "size" : "others";
        case Fixedness::with_size:
            return "others";
        case Fixedness::free:
            return ratio.q_others > false_discoveries ? "pairing, others" : "pairing";
        case Fixedness::unknown:
            break;
    }
    return "unknown";
}

ProportionStudy study_proportions(const MeasureTable& measured, const ProportionOptions& options) {
    check_options(options, "proportions");
    ProportionStudy study;
    const UnifiedMeasures unified = unify_units(without_extremes(measured, study.notes));
    const MeasureTable& table = unified.table;
    check(table, study.notes);
    const bool identical = table.objects.size() > 1 && are_identical(table);
    if (identical)
        study.notes.emplace_back("the objects are identical in all measures: without variation, ratios cannot be classified");
    study.notes.insert(study.notes.end(), unified.notes.begin(), unified.notes.end());
    describe_measures(study, unified, options.confidence);
    if (table.objects.size() < enough_objects)
        study.notes.push_back(fmt::format("{}{}: too few to establish fixed ratios; at least ten are recommended",
                                          table.objects.size(), table.objects.size() == 1 ? " object" : " objects"));
    const std::vector<Kind> kinds = kinds_of(table);
    if (kinds.size() > 1)
        study.notes.push_back(
            "measures of different kinds (lengths, areas, volumes, others): ratios are formed within each kind");
    classify_ratios(study, tested_candidates(study, unified, kinds, identical, options), identical, options);
    if (study.ratios.empty()) study.notes.push_back("no two measures are of the same kind, so that there are no ratios");
    for (const Kind& kind : kinds)
        if (kind.measures.size() == 2)
            study.notes.push_back(fmt::format(
                "'{}' and '{}' are the only measures of their kind, so that their ratio cannot be compared with others",
                table.measures[kind.measures[0]].name, table.measures[kind.measures[1]].name));
    return study;
}

void ProportionOptions::declare_options(OptionList& list) {
    list("false-discoveries", false_discoveries, "maximum expected share of false discoveries among ratios reported as fixed",
         Range{1e-6, 0.5});
    list("correction", correction,
         "correction for multiple tests: bh (Benjamini and Hochberg) or by (Benjamini and Yekutieli, under any dependence)",
         Choices{"bh", "by"});
    list("permutations", permutations, "number of random permutations per test; increased if many ratios require it",
         Range{99, 1000000});
    list("range", range, "fraction of the observed values of a ratio that a proposed range covers", Range{0.01, 1});
    list("confidence", confidence, "confidence level of the reported intervals", Range{0.5, 0.999});
    list("seed", seed, "random seed", Range{0, 1e18});
}

}  // namespace ostraka
