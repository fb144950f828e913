// Detection rate of planted proportions, and false detections, in many synthetic populations.
#include "harness.h"

#include "ostraka/collection/proportions.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/figures/plot.h"
#include "ostraka/figures/table.h"
#include "ostraka/stats/random.h"

#include <algorithm>
#include <cmath>
#include <iostream>

namespace ostraka::experiments {

namespace {

struct FixedProportionsOptions {
    std::string output = "experiments-output/proportions";
    int seeds = 100;
    void list_options(OptionList& list) {
        list("output", output, "folder for table and plot").positional();
        list("seeds", seeds, "number of populations of each kind", Range{1, 100000});
    }
};

struct Scenario {
    const char* name;
    void (*change)(SyntheticMeasuresOptions& made);
    bool planted = true;
};

const std::vector<Scenario> scenarios{
    {"two ratios, common size 15 %", [](auto&) {}},
    {"two ratios, no common size", [](auto& m) { m.size_deviation = 0; }},
    {"two ratios, common size 40 %", [](auto& m) { m.size_deviation = 0.4; }},
    {"one ratio", [](auto& m) { m.groups = 1; }},
    {"three measures together", [](auto& m) { m.groups = 1, m.group_size = 3; }},
    {"two groups of three", [](auto& m) { m.groups = 2, m.group_size = 3; }},
    {"15 % each measure, 21 % ratios", [](auto& m) { m.ratio_deviation = 0.15 * std::sqrt(2.0); }},
    {"four measures, one ratio", [](auto& m) { m.measures = 4, m.groups = 1; }},
    {"four measures, two ratios", [](auto& m) { m.measures = 4; }},
    {"four measures, three together", [](auto& m) { m.measures = 4, m.groups = 1, m.group_size = 3; }},
    {"five measures, one ratio", [](auto& m) { m.measures = 5, m.groups = 1; }},
    {"twenty measures, five ratios", [](auto& m) { m.measures = 20, m.groups = 5; }},
    {"measures follow the size unequally", [](auto& m) { m.spread = 0.5; }},
    {"a tenth of the values missing", [](auto& m) { m.missing = 0.1; }},
    {"a third of the values missing", [](auto& m) { m.missing = 0.33; }},
    {"twenty objects", [](auto& m) { m.objects = 20; }},
    {"ten objects", [](auto& m) { m.objects = 10; }},
    {"planted 6 %", [](auto& m) { m.planted_deviation = 0.06; }},
    {"planted 9 %", [](auto& m) { m.planted_deviation = 0.09; }},
    {"none planted, common size 15 %", [](auto& m) { m.groups = 0; }, false},
    {"none planted, no common size", [](auto& m) { m.groups = 0, m.size_deviation = 0; }, false},
    {"none planted, four measures", [](auto& m) { m.groups = 0, m.measures = 4; }, false},
    {"none planted, twenty measures", [](auto& m) { m.groups = 0, m.measures = 20; }, false},
    {"none planted, unequal measures", [](auto& m) { m.groups = 0, m.spread = 0.5; }, false},
    {"none planted, four unequal measures", [](auto& m) { m.groups = 0, m.measures = 4, m.spread = 0.5; }, false},
    {"none planted, a third missing", [](auto& m) { m.groups = 0, m.missing = 0.33; }, false},
    {"none planted, ten objects", [](auto& m) { m.groups = 0, m.objects = 10; }, false}};

/// Sums over populations.
struct Detections {
    double planted = 0, hit = 0, wrong = 0, wrong_share = 0, any_wrong = 0;
};

Detections over_seeds(SyntheticMeasuresOptions made, int seeds) {
    std::vector<Detections> list(static_cast<std::size_t>(seeds));
    parallel_for(list.size(), 1, [&](std::size_t s) {
        SyntheticMeasuresOptions options = made;
        ProportionOptions study;
        options.seed = study.seed = s + 1;
        const SyntheticMeasures measures = make_measures(options);
        for (const RatioRow& ratio : study_proportions(measures.table, study).ratios) {
            const int a = measures.groups[ratio.numerator], b = measures.groups[ratio.denominator];
            const bool planted = a >= 0 && a == b, called = ratio.fixedness == Fixedness::fixed;
            list[s].planted += planted;
            list[s].hit += planted && called;
            list[s].wrong += !planted && called;
        }
    });
    Detections sum;
    for (const Detections& one : list) {
        sum.planted += one.planted, sum.hit += one.hit, sum.wrong += one.wrong;
        sum.wrong_share += one.wrong == 0 ? 0 : one.wrong / (one.hit + one.wrong);
        sum.any_wrong += one.wrong > 0;
    }
    return sum;
}

/// Share of intervals that contain the true coefficient of variation, which follows from the planted deviation of the
/// logarithm.
double coverage(int seeds, double deviation) {
    const double truth = std::sqrt(std::expm1(deviation * deviation));
    std::vector<int> inside(static_cast<std::size_t>(seeds));
    parallel_for(inside.size(), 1, [&](std::size_t s) {
        Random random(s + 1, 99);
        MeasureTable table;
        table.measures = {{"a", 1, "mm"}};
        table.values.resize(40, 1);
        for (Eigen::Index i = 0; i < 40; ++i) {
            table.objects.push_back(std::to_string(i));
            table.values(i, 0) = std::exp(random.normal(0, deviation));
        }
        table.units.assign(40, "mm");
        ProportionOptions study;
        study.seed = s + 1;
        const MeasureRow row = study_proportions(table, study).measures.front();
        inside[s] =
            row.variation_interval && row.variation_interval->low <= truth && truth <= row.variation_interval->high ? 1 : 0;
    });
    return static_cast<double>(std::count(inside.begin(), inside.end(), 1)) / seeds;
}

void fixed_proportions(const FixedProportionsOptions& options) {
    TextTable table(
        {"population", "ratios", "planted", "recall", "false discoveries", "false a population", "populations with one"});
    const double n = options.seeds;
    for (const Scenario& scenario : scenarios) {
        SyntheticMeasuresOptions made;
        scenario.change(made);
        const Detections sum = over_seeds(made, options.seeds);
        table.add({scenario.name, std::to_string(made.measures * (made.measures - 1) / 2), fixed(sum.planted / n, 0),
                   scenario.planted ? fixed(sum.hit / sum.planted, 3) : "-", percent(sum.wrong_share / n),
                   fixed(sum.wrong / n, 2), percent(sum.any_wrong / n, 0)});
    }

    // The variation that can be detected, for three numbers of objects.
    Plot power{"Planted ratios found among ratios of 15 %",
               {"variation of the planted ratios, %"},
               {"share found", false, 0.0, 1.0},
               {}};
    for (const int objects : {10, 20, 40, 80}) {
        PlotSeries series{std::to_string(objects) + " objects", {}};
        for (const double deviation : {0.01, 0.03, 0.05, 0.06, 0.07, 0.08, 0.09, 0.1, 0.12, 0.15}) {
            SyntheticMeasuresOptions made;
            made.objects = objects;
            made.planted_deviation = deviation;
            const Detections sum = over_seeds(made, options.seeds);
            series.points.push_back({100 * deviation, sum.hit / sum.planted});
        }
        power.series.push_back(series);
    }
    table.write(options.output, "recovery",
                "Planted proportions found, over " + std::to_string(options.seeds) + " populations each");
    write_plot(Path(options.output) / "power.svg", power);
    write_plot(Path(options.output) / "power.png", power);
    std::cout << table.markdown() << "\n95 % intervals of the coefficient of variation of 40 objects hold the true one in "
              << percent(coverage(5 * options.seeds, 0.03)) << " (3 %) and " << percent(coverage(5 * options.seeds, 0.15))
              << " (15 %) of " << 5 * options.seeds << " populations\n";
}

const Registration registered("proportions", "planted proportions found in made populations, and false ones", fixed_proportions);

}  // namespace

}  // namespace ostraka::experiments
