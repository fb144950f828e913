// Detection rate of planted proportions, and false detections, in many synthetic populations.
#include "ostraka/collection/proportions.h"
#include "ostraka/core/parallel.h"
#include "ostraka/report/plot.h"
#include "ostraka/report/table.h"
#include "ostraka/stats/random.h"

#include "experiments.h"

#include <algorithm>
#include <cmath>
#include <iostream>

namespace ostraka::experiments {

namespace {

struct Scenario {
    std::string name;
    SyntheticMeasuresOptions made;
};

/// Result of one population.
struct Found {
    std::size_t planted = 0, hit = 0, wrong = 0;
};

Found find(const SyntheticMeasuresOptions& options, const ProportionOptions& study) {
    const SyntheticMeasures made = make_measures(options);
    Found found;
    for (const RatioRow& ratio : study_proportions(made.table, study).ratios) {
        const int a = made.groups[ratio.numerator], b = made.groups[ratio.denominator];
        const bool planted = a >= 0 && a == b, called = ratio.fixedness == Fixedness::fixed;
        found.planted += planted ? 1 : 0;
        found.hit += planted && called ? 1 : 0;
        found.wrong += !planted && called ? 1 : 0;
    }
    return found;
}

std::vector<Found> over_seeds(const SyntheticMeasuresOptions& made, int seeds) {
    std::vector<Found> list(static_cast<std::size_t>(seeds));
    ProportionOptions study;
    parallel_for(
        list.size(),
        [&](std::size_t s) {
            SyntheticMeasuresOptions options = made;
            options.seed = s + 1;
            ProportionOptions seeded = study;
            seeded.seed = s + 1;
            list[s] = find(options, seeded);
        },
        1);
    return list;
}

/// Share of intervals that contain the true coefficient of variation, which follows from the planted deviation of the
/// logarithm.
double coverage(int seeds, double deviation) {
    const double truth = std::sqrt(std::expm1(deviation * deviation));
    std::vector<int> inside(static_cast<std::size_t>(seeds));
    parallel_for(
        inside.size(),
        [&](std::size_t s) {
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
        },
        1);
    return static_cast<double>(std::count(inside.begin(), inside.end(), 1)) / seeds;
}

}  // namespace

void fixed_proportions(const FixedProportionsOptions& options) {
    std::vector<Scenario> scenarios;
    SyntheticMeasuresOptions base;
    const auto add = [&](const std::string& name, const auto& change) {
        Scenario scenario{name, base};
        change(scenario.made);
        scenarios.push_back(scenario);
    };
    add("two ratios, common size 15 %", [](auto&) {});
    add("two ratios, no common size", [](auto& m) { m.size_deviation = 0; });
    add("two ratios, common size 40 %", [](auto& m) { m.size_deviation = 0.4; });
    add("one ratio", [](auto& m) { m.groups = 1; });
    add("three measures together", [](auto& m) { m.groups = 1, m.group_size = 3; });
    add("two groups of three", [](auto& m) { m.groups = 2, m.group_size = 3; });
    add("15 % each measure, 21 % ratios", [](auto& m) { m.ratio_deviation = 0.15 * std::sqrt(2.0); });
    add("four measures, one ratio", [](auto& m) { m.measures = 4, m.groups = 1; });
    add("four measures, two ratios", [](auto& m) { m.measures = 4; });
    add("four measures, three together", [](auto& m) { m.measures = 4, m.groups = 1, m.group_size = 3; });
    add("five measures, one ratio", [](auto& m) { m.measures = 5, m.groups = 1; });
    add("twenty measures, five ratios", [](auto& m) { m.measures = 20, m.groups = 5; });
    add("measures follow the size unequally", [](auto& m) { m.spread = 0.5; });
    add("a tenth of the values missing", [](auto& m) { m.missing = 0.1; });
    add("a third of the values missing", [](auto& m) { m.missing = 0.33; });
    add("twenty objects", [](auto& m) { m.objects = 20; });
    add("ten objects", [](auto& m) { m.objects = 10; });
    add("planted 6 %", [](auto& m) { m.planted_deviation = 0.06; });
    add("planted 9 %", [](auto& m) { m.planted_deviation = 0.09; });
    const std::size_t with = scenarios.size();
    add("none planted, common size 15 %", [](auto& m) { m.groups = 0; });
    add("none planted, no common size", [](auto& m) { m.groups = 0, m.size_deviation = 0; });
    add("none planted, four measures", [](auto& m) { m.groups = 0, m.measures = 4; });
    add("none planted, twenty measures", [](auto& m) { m.groups = 0, m.measures = 20; });
    add("none planted, unequal measures", [](auto& m) { m.groups = 0, m.spread = 0.5; });
    add("none planted, four unequal measures", [](auto& m) { m.groups = 0, m.measures = 4, m.spread = 0.5; });
    add("none planted, a third missing", [](auto& m) { m.groups = 0, m.missing = 0.33; });
    add("none planted, ten objects", [](auto& m) { m.groups = 0, m.objects = 10; });

    TextTable table(
        {"population", "ratios", "planted", "recall", "false discoveries", "false a population", "populations with one"});
    for (std::size_t s = 0; s < scenarios.size(); ++s) {
        const SyntheticMeasuresOptions& made = scenarios[s].made;
        const std::vector<Found> list = over_seeds(made, options.seeds);
        double planted = 0, hit = 0, wrong = 0, share = 0, any = 0;
        for (const Found& found : list) {
            planted += static_cast<double>(found.planted);
            hit += static_cast<double>(found.hit);
            wrong += static_cast<double>(found.wrong);
            share += found.wrong == 0 ? 0 : static_cast<double>(found.wrong) / static_cast<double>(found.hit + found.wrong);
            any += found.wrong > 0 ? 1 : 0;
        }
        const double n = options.seeds;
        table.add({scenarios[s].name, std::to_string(made.measures * (made.measures - 1) / 2), fixed(planted / n, 0),
                   s < with ? fixed(hit / planted, 3) : "-", percent(share / n), fixed(wrong / n, 2), percent(any / n, 0)});
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
            double planted = 0, hit = 0;
            for (const Found& found : over_seeds(made, options.seeds)) {
                planted += static_cast<double>(found.planted);
                hit += static_cast<double>(found.hit);
            }
            series.points.push_back({100 * deviation, hit / planted});
        }
        power.series.push_back(series);
    }
    std::filesystem::create_directories(options.output);
    table.write(options.output, "recovery",
                "Planted proportions found, over " + std::to_string(options.seeds) + " populations each");
    write_plot(Path(options.output) / "power.svg", power);
    write_plot(Path(options.output) / "power.png", power);
    std::cout << table.markdown() << "\n95 % intervals of the coefficient of variation of 40 objects hold the true one in "
              << percent(coverage(5 * options.seeds, 0.03)) << " (3 %) and " << percent(coverage(5 * options.seeds, 0.15))
              << " (15 %) of " << 5 * options.seeds << " populations\n";
}

}  // namespace ostraka::experiments
