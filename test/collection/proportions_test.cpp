#include "ostraka/collection/proportions.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/stats/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace ostraka {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

MeasureTable table_of(const std::vector<std::string>& names, const std::vector<std::vector<double>>& rows) {
    MeasureTable table;
    for (const auto& name : names) table.measures.push_back({name, 1, "mm"});
    table.values.resize(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(names.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        table.objects.push_back("object " + std::to_string(i));
        table.units.emplace_back("mm");
        for (std::size_t j = 0; j < names.size(); ++j)
            table.values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = rows[i][j];
    }
    return table;
}

std::string all_notes(const ProportionStudy& study) {
    std::string text;
    for (const auto& note : study.notes) text += note + '\n';
    return text;
}

ProportionOptions quick(std::uint64_t seed = 1) {
    ProportionOptions options;
    options.permutations = 999;
    options.seed = seed;
    return options;
}

struct Counts {
    double planted = 0, hit = 0, wrong = 0;
};

Counts over_seeds(SyntheticMeasuresOptions options, int seeds) {
    Counts counts;
    for (int s = 1; s <= seeds; ++s) {
        options.seed = static_cast<std::uint64_t>(s);
        const SyntheticMeasures population = make_measures(options);
        for (const RatioRow& ratio : study_proportions(population.table, quick(options.seed)).ratios) {
            const int a = population.groups[ratio.numerator], b = population.groups[ratio.denominator];
            const bool planted = a >= 0 && a == b, called = ratio.fixedness == Fixedness::fixed;
            counts.planted += planted ? 1 : 0;
            counts.hit += planted && called ? 1 : 0;
            counts.wrong += !planted && called ? 1 : 0;
        }
    }
    return counts;
}

TEST(Proportions, RowsByHand) {
    const ProportionStudy study = study_proportions(table_of({"arm", "height"}, {{8, 20}, {9, 18}, {7, 21}, {8, 25}}), quick());
    ASSERT_EQ(study.measures.size(), 2u);
    ASSERT_EQ(study.ratios.size(), 1u);
    EXPECT_EQ(study.measures[0].summary->mean, 8);
    EXPECT_DOUBLE_EQ(*study.measures[0].summary->standard_deviation, std::sqrt(2.0 / 3));
    EXPECT_DOUBLE_EQ(*study.measures[0].summary->coefficient_of_variation, std::sqrt(2.0 / 3) / 8);
    EXPECT_EQ(study.measures[0].unit, "mm");
    const RatioRow& ratio = study.ratios[0];
    EXPECT_EQ(ratio.numerator, 1u) << "the larger over the smaller";
    EXPECT_EQ(ratio.row.name, "height / arm");
    EXPECT_DOUBLE_EQ(ratio.row.summary->mean, (20.0 / 8 + 2 + 3 + 25.0 / 8) / 4);
    EXPECT_EQ(ratio.row.summary->count, 4u);
    const auto inside = [](const Interval& interval, double value) { return interval.low <= value && value <= interval.high; };
    EXPECT_TRUE(inside(*ratio.row.variation_interval, *ratio.row.summary->coefficient_of_variation));
    EXPECT_NE(ratio.fixedness, Fixedness::fixed) << "with two measures there is nothing to compare with";
}

TEST(Proportions, AMeasureWithoutAValueHasNoRatios) {
    MeasureTable table =
        table_of({"a", "b", "c", "handle"}, {{8, 20, 5, none}, {9, 18, 6, none}, {7, 21, 4, none}, {8, 25, 5, none}});
    const ProportionStudy with = study_proportions(table, quick());
    ASSERT_EQ(with.measures.size(), 4u);
    EXPECT_EQ(with.measures[3].unit, "") << "what was never taken has no unit";
    EXPECT_EQ(with.ratios.size(), 3u);
    for (const RatioRow& ratio : with.ratios) EXPECT_EQ(ratio.row.name.find("handle"), std::string::npos);
    table.measures.pop_back();
    table.values = Eigen::MatrixXd(table.values.leftCols(3));
    const ProportionStudy without = study_proportions(table, quick());
    for (std::size_t r = 0; r < 3; ++r) EXPECT_EQ(with.ratios[r].q, without.ratios[r].q);
}

TEST(Proportions, FewObjectsAndTheFailedTestAreReported) {
    SyntheticMeasuresOptions options;
    options.objects = 9;
    const ProportionStudy few_objects = study_proportions(make_measures(options).table, quick());
    EXPECT_NE(all_notes(few_objects).find("9 objects: too few to establish fixed ratios"), std::string::npos)
        << all_notes(few_objects);
    options.objects = 10;
    const ProportionStudy enough = study_proportions(make_measures(options).table, quick());
    EXPECT_EQ(all_notes(enough).find("too few to establish"), std::string::npos);
    for (const ProportionStudy& study : {few_objects, enough})
        for (const RatioRow& ratio : study.ratios)
            EXPECT_EQ(reason_not_fixed(ratio, 0.05).empty(), ratio.fixedness == Fixedness::fixed) << ratio.row.name;
    RatioRow stable;
    stable.fixedness = Fixedness::stable, stable.p_others = 2e-5, stable.p_size = 0.99;
    EXPECT_EQ(reason_not_fixed(stable, 0.05), "size");
}

TEST(Proportions, PlantedOnesAreFoundWithAndWithoutCommonSize) {
    for (const double size : {0.0, 0.15, 0.4}) {
        SyntheticMeasuresOptions options;
        options.size_deviation = size;
        const Counts counts = over_seeds(options, 10);
        EXPECT_GE(counts.hit, 0.9 * counts.planted) << size;
        EXPECT_LE(counts.wrong, 0.15 * counts.hit) << size << ": 5 % are allowed on average over many populations";
    }
}

TEST(Proportions, GroupsOfThreeAreFound) {
    SyntheticMeasuresOptions options;
    options.group_size = 3;
    const Counts counts = over_seeds(options, 6);
    EXPECT_GE(counts.hit, 0.9 * counts.planted);
    EXPECT_LE(counts.wrong, 0.15 * counts.hit);
}

TEST(Proportions, FewFalseDiscoveriesWithoutPlantedRatios) {
    for (const double size : {0.0, 0.15, 0.4}) {
        SyntheticMeasuresOptions options;
        options.groups = 0;
        options.size_deviation = size;
        EXPECT_LE(over_seeds(options, 10).wrong, 3) << size;
    }
    SyntheticMeasuresOptions unequal;
    unequal.groups = 0;
    unequal.spread = 0.5;
    EXPECT_LE(over_seeds(unequal, 10).wrong, 3) << "measures that follow the size closely are not bound to each other";
}

TEST(Proportions, ScaledCopiesVaryWithTheSize) {
    SyntheticMeasuresOptions options;
    options.groups = 0;
    options.ratio_deviation = 0.03;
    options.size_deviation = 0.2;
    const ProportionStudy study = study_proportions(make_measures(options).table, quick());
    for (const RatioRow& ratio : study.ratios) {
        EXPECT_EQ(ratio.fixedness, Fixedness::with_size) << ratio.row.name;
        EXPECT_LT(*ratio.row.summary->coefficient_of_variation, 0.06);
    }
    EXPECT_NEAR(*study.size_deviation, 0.2, 0.08);
    for (const MeasureRow& row : study.measures) EXPECT_NEAR(*row.own_deviation, 0.03 / std::sqrt(2.0), 0.012);
}

TEST(Proportions, DoNotDependOnUnitsOrderOrThreads) {
    SyntheticMeasuresOptions options;
    options.missing = 0.1;
    const MeasureTable table = make_measures(options).table;
    const int original_threads = threads();
    set_threads(1);
    const ProportionStudy single_thread = study_proportions(table, quick());
    set_threads(3);
    const ProportionStudy three = study_proportions(table, quick());
    set_threads(original_threads);
    for (std::size_t r = 0; r < single_thread.ratios.size(); ++r) {
        EXPECT_EQ(single_thread.ratios[r].p_others, three.ratios[r].p_others);
        EXPECT_EQ(single_thread.ratios[r].p_pairing, three.ratios[r].p_pairing);
        EXPECT_EQ(single_thread.ratios[r].q, three.ratios[r].q);
        EXPECT_EQ(single_thread.ratios[r].row.variation_interval->high, three.ratios[r].row.variation_interval->high);
    }
    // A different unit for each object changes only sizes.
    MeasureTable other = table;
    Random random(5);
    for (std::size_t i = 0; i < other.objects.size(); ++i) {
        other.values.row(static_cast<Eigen::Index>(i)) *= std::exp2(static_cast<double>(random.below(40)) - 20);
        other.units[i].clear();
    }
    const ProportionStudy scaled = study_proportions(other, quick());
    for (std::size_t r = 0; r < single_thread.ratios.size(); ++r) {
        std::size_t same = scaled.ratios.size();
        for (std::size_t k = 0; k < scaled.ratios.size(); ++k)
            if (std::set{scaled.ratios[k].numerator, scaled.ratios[k].denominator} ==
                std::set{single_thread.ratios[r].numerator, single_thread.ratios[r].denominator})
                same = k;
        ASSERT_LT(same, scaled.ratios.size());
        EXPECT_NEAR(scaled.ratios[same].log_deviation, single_thread.ratios[r].log_deviation, 1e-9);
        EXPECT_EQ(scaled.ratios[same].fixedness == Fixedness::fixed, single_thread.ratios[r].fixedness == Fixedness::fixed);
    }
}

TEST(Proportions, MissingValuesAreReportedInEachRow) {
    SyntheticMeasuresOptions options;
    SyntheticMeasures population = make_measures(options);
    population.table.values.col(3).head(15).setConstant(none);
    population.table.values.col(5).setConstant(none);
    population.table.values(0, 0) = 0;
    const ProportionStudy study = study_proportions(population.table, quick());
    EXPECT_EQ(study.measures[3].summary->count, 25u);
    EXPECT_FALSE(study.measures[5].summary);
    for (const RatioRow& ratio : study.ratios) {
        if (ratio.numerator == 5 || ratio.denominator == 5) {
            EXPECT_EQ(ratio.fixedness, Fixedness::unknown);
            EXPECT_FALSE(ratio.row.summary);
            EXPECT_EQ(ratio.p_others, 1);
        } else {
            const std::size_t expected =
                40 - (ratio.numerator == 3 || ratio.denominator == 3 ? 15 : 0) -
                (ratio.numerator == 0 || ratio.denominator == 0 ? 1 : 0) +
                (ratio.numerator + ratio.denominator == 3 && ratio.numerator * ratio.denominator == 0 ? 1 : 0);
            EXPECT_EQ(ratio.row.summary->count, expected) << ratio.row.name;
        }
    }
    std::string notes;
    for (const auto& note : study.notes) notes += note + '\n';
    EXPECT_NE(notes.find("55 of 320"), std::string::npos) << notes;
    EXPECT_NE(notes.find("not positive: 1;"), std::string::npos) << notes;
}

TEST(Proportions, HandlesSingleAndIdenticalObjects) {
    const ProportionStudy single_object = study_proportions(table_of({"a", "b", "c"}, {{1, 2, 3}}), quick());
    ASSERT_EQ(single_object.ratios.size(), 3u);
    for (const RatioRow& ratio : single_object.ratios) {
        EXPECT_EQ(ratio.fixedness, Fixedness::unknown);
        EXPECT_FALSE(ratio.row.summary->standard_deviation);
        EXPECT_FALSE(ratio.row.variation_interval);
    }
    EXPECT_FALSE(single_object.notes.empty());
    const std::vector<std::vector<double>> same(10, {1, 2, 3, 5});
    const ProportionStudy identical = study_proportions(table_of({"a", "b", "c", "d"}, same), quick());
    for (const RatioRow& ratio : identical.ratios) {
        EXPECT_EQ(*ratio.row.summary->standard_deviation, 0);
        EXPECT_EQ(ratio.fixedness, Fixedness::unknown) << "nothing varies: nothing can be more stable";
        EXPECT_EQ(ratio.p_others, 1);
        EXPECT_EQ(ratio.p_pairing, 1);
    }
    EXPECT_NE(all_notes(identical).find("the objects are identical"), std::string::npos);
}

TEST(Proportions, ARatioThatIsTheSameInAllObjectsIsFixed) {
    // Two measures only, few objects, two sizes: no permutation would detect it.
    const ProportionStudy two = study_proportions(table_of({"a", "b"}, {{1, 3}, {1, 3}, {7, 21}, {7, 21}, {1, 3}}), quick());
    EXPECT_EQ(two.ratios.at(0).fixedness, Fixedness::fixed);
    EXPECT_EQ(two.ratios[0].p_others, 1.0 / 1000);
    EXPECT_NE(all_notes(two).find("exactly equal in all objects: 1"), std::string::npos);
    // Scaled copies: decimal factors, so that quotients are rounded.
    std::vector<std::vector<double>> scaled;
    for (int i = 0; i < 6; ++i) scaled.push_back({0.1 * (i + 1), 0.3 * (i + 1), 0.7 * (i + 1)});
    for (const RatioRow& ratio : study_proportions(table_of({"a", "b", "c"}, scaled), quick()).ratios)
        EXPECT_EQ(ratio.fixedness, Fixedness::fixed) << ratio.row.name;
    // A ratio that differs in the sixth digit is subject to the tests again, and three objects are not sufficient.
    scaled[2][0] *= 1 + 1e-6;
    EXPECT_EQ(all_notes(study_proportions(table_of({"a", "b", "c"}, scaled), quick())).find("digit: 3"), std::string::npos);
    scaled.resize(3);
    scaled[2][0] = 0.3;
    for (const RatioRow& ratio : study_proportions(table_of({"a", "b", "c"}, scaled), quick()).ratios)
        EXPECT_EQ(ratio.fixedness, Fixedness::unknown);
}

TEST(Proportions, ValuesBeyondComputingAreLeftOutWithANote) {
    MeasureTable table = make_measures().table;
    table.values(3, 1) = 1e308;
    table.values(4, 1) = 1e-300;
    table.values(5, 0) = -1e200;
    table.units.assign(table.objects.size(), "km");
    table.units[3] = "mm";
    const ProportionStudy study = study_proportions(table, quick());
    EXPECT_NE(all_notes(study).find("too small for the computation: 3 (the first: 'measure 2' of"), std::string::npos)
        << all_notes(study);
    EXPECT_EQ(study.measures[1].summary->count, 38U);
    const auto finite = [](const MeasureRow& row) {
        const Summary& s = *row.summary;
        return std::isfinite(s.mean) && std::isfinite(*s.standard_deviation) && std::isfinite(*s.coefficient_of_variation) &&
               std::isfinite(row.variation_interval->low) && std::isfinite(row.variation_interval->high) &&
               std::isfinite(row.deviation_interval->high);
    };
    for (const MeasureRow& row : study.measures) EXPECT_TRUE(finite(row)) << row.name;
    for (const RatioRow& ratio : study.ratios) {
        EXPECT_TRUE(finite(ratio.row)) << ratio.row.name;
        EXPECT_TRUE(std::isfinite(ratio.log_deviation) && std::isfinite(ratio.low) && std::isfinite(ratio.high));
    }
    // Within the permitted range nothing overflows.
    MeasureTable distant = make_measures().table;
    distant.values.col(0) *= 1e33 / distant.values.col(0).maxCoeff();
    distant.values.col(1) *= 1e-33 / distant.values.col(1).minCoeff();
    const ProportionStudy wide = study_proportions(distant, quick());
    for (const RatioRow& ratio : wide.ratios) EXPECT_TRUE(finite(ratio.row)) << ratio.row.name;
    EXPECT_EQ(all_notes(wide), "");
}

TEST(Proportions, AnExactProportionAmongOthersIsFixed) {
    SyntheticMeasures population = make_measures({.groups = 0});
    population.table.values.col(2) = 0.41 * population.table.values.col(6);
    int exact = 0;
    for (const RatioRow& ratio : study_proportions(population.table, quick()).ratios)
        if (std::set{ratio.numerator, ratio.denominator} == std::set<std::size_t>{2, 6}) {
            ++exact;
            EXPECT_EQ(ratio.fixedness, Fixedness::fixed);
            EXPECT_NEAR(ratio.log_deviation, 0, 1e-9);
            EXPECT_NEAR(ratio.low, ratio.high, 1e-12);
        }
    EXPECT_EQ(exact, 1);
}

TEST(Proportions, RatiosAreTakenWithinAKind) {
    MeasureTable table =
        table_of({"length", "area", "width", "other area"}, {{1, 2, 3, 4}, {2, 3, 4, 5}, {2, 3, 5, 6}, {2, 3, 4, 7}});
    table.measures[1].power = table.measures[3].power = 2;
    const ProportionStudy study = study_proportions(table, quick());
    ASSERT_EQ(study.ratios.size(), 2u);
    for (const RatioRow& ratio : study.ratios)
        EXPECT_EQ(table.measures[ratio.numerator].power, table.measures[ratio.denominator].power);
}

TEST(Proportions, RefuseInvalidInput) {
    EXPECT_THROW(study_proportions(MeasureTable{}), Error);
    EXPECT_THROW(study_proportions(table_of({"a"}, {})), Error);
    EXPECT_THROW(study_proportions(table_of({"a"}, {{std::numeric_limits<double>::infinity()}})), Error);
    MeasureTable wrong = table_of({"a"}, {{1}});
    wrong.units.clear();
    EXPECT_THROW(study_proportions(wrong), Error);
    EXPECT_THROW(study_proportions(table_of(std::vector<std::string>(61, "a"), {std::vector<double>(61, 1)})), Error);
    EXPECT_THROW(study_proportions(table_of({"a"}, {{1}}), {.false_discoveries = 2}), Error);
}

TEST(Units, AreConvertedToTheMostCommonUnit) {
    MeasureTable table = table_of({"length", "area"}, {{10, 100}, {20, 200}, {3, 9}, {5, 7}, {1, 1}});
    table.measures[1].power = 2;
    table.units = {"mm", "millimetres", "cm", "", "ell"};
    const UnifiedMeasures unified = unify_units(table);
    EXPECT_EQ(unified.table.measures[0].unit, "mm");
    EXPECT_EQ(unified.table.measures[1].unit, "mm^2");
    EXPECT_DOUBLE_EQ(unified.table.values(2, 0), 30);
    EXPECT_DOUBLE_EQ(unified.table.values(2, 1), 900);
    EXPECT_EQ(unified.comparable, (std::vector<bool>{true, true, true, false, false}));
    EXPECT_EQ(unified.notes.size(), 3u);
    const ProportionStudy study = study_proportions(table_of({"a", "b"}, {{1, 2}, {2, 3}}), quick());
    EXPECT_TRUE(unify_units(table_of({"a"}, {{1}})).notes.empty());
    table.units.assign(5, "");
    for (const bool comparable : unify_units(table).comparable) EXPECT_TRUE(comparable) << "nobody says a unit";
}

TEST(Units, UnknownUnitsAreUsedInRatiosOnly) {
    MeasureTable table = table_of({"a", "b"}, {{1, 2}, {2, 4}, {300, 900}, {4, 8}});
    table.units[2].clear();
    const ProportionStudy study = study_proportions(table, quick());
    EXPECT_EQ(study.measures[0].summary->count, 3u);
    EXPECT_EQ(study.measures[0].summary->max, 4);
    EXPECT_EQ(study.ratios[0].row.summary->count, 4u);
    EXPECT_EQ(study.ratios[0].row.summary->max, 3);
}

TEST(SyntheticMeasures, VaryAsRequested) {
    SyntheticMeasuresOptions options;
    options.objects = 4000;
    const SyntheticMeasures synthetic = make_measures(options);
    const auto deviation = [&](std::size_t a, std::size_t b) {
        const Eigen::VectorXd logs = (synthetic.table.values.col(static_cast<Eigen::Index>(a)).array() /
                                      synthetic.table.values.col(static_cast<Eigen::Index>(b)).array())
                                         .log();
        return std::sqrt((logs.array() - logs.mean()).square().sum() / 3999);
    };
    for (std::size_t a = 0; a < 8; ++a)
        for (std::size_t b = 0; b < a; ++b) {
            const bool planted = synthetic.groups[a] >= 0 && synthetic.groups[a] == synthetic.groups[b];
            EXPECT_NEAR(deviation(a, b), planted ? 0.03 : 0.15, 0.06 * (planted ? 0.03 : 0.15)) << a << ' ' << b;
        }
    EXPECT_THROW(make_measures({.measures = 3}), Error);
}

}  // namespace
}  // namespace ostraka
