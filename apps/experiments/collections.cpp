// Analyses of collections: technique of synthetic statuettes by level and with simulated scanner effects; planted proportions and
// false detections; clusters of arbitrary form, as found by DBSCAN (figure 3.7 of the thesis).
#include "harness.h"

#include "ostraka/collection/proportions.h"
#include "ostraka/collection/technique_study.h"
#include "ostraka/core/angles.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/figures/plot.h"
#include "ostraka/stats/clustering.h"
#include "ostraka/stats/random.h"
#include "ostraka/synthetic/statuettes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace ostraka::experiments {

namespace {

struct TechniqueExperiment {
    std::string output;
    int objects = 100, seeds = 2;
    std::uint64_t vertices = 5000;
    bool variants = false;
    void declare_options(OptionList& list) {
        list("output", output, "folder for tables and plots").positional().required();
        list("objects", objects, "number of statuettes of a population", Range{10, 100000});
        list("seeds", seeds, "number of populations of each level", Range{1, 1000});
        list("vertices", vertices, "number of vertices of each mesh");
        list("variants", variants, "also scan noise, missing interior and holes, at level 3");
    }
};

/// Results for one population.
struct Outcome {
    std::map<std::string, ClassifierResult> classifiers;
    std::map<std::string, double> divided;  ///< F1 of divisions that score better than a single group
    std::size_t objects = 0, left_out = 0;
    Hits slices;  ///< used, of all
};

Outcome outcome_of(const PopulationOptions& options) {
    const auto population = draw_population(options);
    std::vector<std::optional<TechniqueObject>> measured(population.size());
    parallel_for(population.size(), 1, [&](std::size_t i) {
        const Statuette statuette = generate_statuette(population[i]);
        try {
            measured[i] = TechniqueObject{std::to_string(i), option_text(population[i], "technique"),
                                          measure_technique(statuette.mesh, Vector(0, 0, 1))};
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input) throw;  // too few usable slices: counted below
        }
    });
    Outcome outcome;
    std::vector<TechniqueObject> objects;
    for (std::optional<TechniqueObject>& object : measured) {
        if (!object) continue;
        outcome.slices += {object->measures.slices.size(), object->measures.asked};
        objects.push_back(std::move(*object));
    }
    outcome.objects = objects.size();
    outcome.left_out = population.size() - objects.size();
    TechniqueStudyOptions study_options;
    study_options.positive = "wheel";
    const TechniqueStudy study = study_technique(objects, study_options);
    for (const ClassifierResult& each : study.classifiers) outcome.classifiers[each.classifier.name] = each;
    for (const TechniqueSplit& each : study.splits)
        if (each.f1) outcome.divided[each.descriptor] = each.p_value <= 0.05 ? *each.f1 : -1;
    return outcome;
}

template <class Value>
double mean_over(const std::vector<Outcome>& outcomes, const Value& value) {
    std::vector<double> values;
    for (const Outcome& outcome : outcomes) values.push_back(value(outcome));
    return mean_of(values);
}

/// Mean over the populations of a classifier's F1.
double mean_f1(const std::vector<Outcome>& outcomes, const std::string& classifier) {
    return mean_over(outcomes, [&](const Outcome& o) { return o.classifiers.at(classifier).validation.mean_f1; });
}

const std::vector<std::string> shown{
    "roundness", "eccentricity",    "both means", "both",         "roundness variance",   "eccentricity variance",
    "ovality",   "marks",           "coherence",  "straightness", "upright straightness", "wall variation",
    "outside",   "outside and wall"};

void add_rows(TextTable& table, const std::string& name, const std::vector<Outcome>& outcomes) {
    std::size_t objects = 0, left_out = 0;
    Hits slices;
    for (const Outcome& each : outcomes) objects += each.objects, left_out += each.left_out, slices += each.slices;
    std::vector<std::string> cells{name, std::to_string(objects), std::to_string(left_out), fixed(slices.percent(), 1)};
    for (const auto& classifier : shown) cells.push_back(fixed(mean_f1(outcomes, classifier), 3));
    for (const std::string split : {"roundness mean", "first component"}) {
        const auto divided = [&](const Outcome& outcome) { return outcome.divided.at(split); };
        const bool all = std::all_of(outcomes.begin(), outcomes.end(), [&](const Outcome& o) { return divided(o) >= 0; });
        cells.push_back(all ? fixed(mean_over(outcomes, divided), 3) : "no groups");
    }
    table.add(cells);
}

/// Adds areas under the ROC curves.
void add_areas(TextTable& table, const std::string& name, const std::vector<Outcome>& outcomes) {
    std::vector<std::string> cells{name};
    for (const auto& classifier : shown)
        cells.push_back(fixed(mean_over(outcomes, [&](const Outcome& o) { return o.classifiers.at(classifier).roc.area; }), 3));
    table.add(cells);
}

std::vector<std::string> columns(const std::string& first) {
    std::vector<std::string> list{first, "objects", "left out", "slices used %"};
    list.insert(list.end(), shown.begin(), shown.end());
    list.insert(list.end(), {"divided by roundness", "divided by first component"});
    return list;
}

void technique(const TechniqueExperiment& options) {
    const auto drawn_outcome = [&](PopulationOptions population, int level, int seed) {
        population.objects = options.objects;
        population.vertices = options.vertices;
        population.level = level;
        population.seed = static_cast<std::uint64_t>(seed);
        return outcome_of(population);
    };
    const Path folder(options.output);
    std::vector<std::string> area_columns{"level"};
    area_columns.insert(area_columns.end(), shown.begin(), shown.end());
    TextTable levels(columns("level")), areas(area_columns);
    std::map<std::string, PlotSeries> curves;
    const std::vector<std::string> drawn{"roundness", "eccentricity", "both", "outside"};
    for (int level = 1; level <= 5; ++level) {
        std::vector<Outcome> outcomes;
        for (int seed = 1; seed <= options.seeds; ++seed) outcomes.push_back(drawn_outcome({}, level, seed));
        add_rows(levels, std::to_string(level), outcomes);
        add_areas(areas, std::to_string(level), outcomes);
        for (const auto& name : drawn) {
            curves[name].name = name;
            curves[name].points.push_back({static_cast<double>(level), mean_f1(outcomes, name)});
        }
        fmt::print(stderr, "level {} done\n", level);
    }
    levels.write(folder, "levels", "F1 of wheel-made by level");
    areas.write(folder, "areas", "Area under the ROC of wheel-made by level");
    fmt::print("{}\n{}\n", levels.markdown(), areas.markdown());
    Plot plot;
    plot.title = "F1 under cross-validation, mean of " + std::to_string(options.seeds) + " populations of " +
                 std::to_string(options.objects);
    plot.x = {"level of difficulty"};
    plot.x.minimum = 1, plot.x.maximum = 5;
    plot.y = {"F1"};
    plot.y.minimum = 0.5, plot.y.maximum = 1;
    for (const auto& name : drawn) plot.series.push_back(curves[name]);
    plot.lines = {
        {0.8167, false, "thesis: roundness 0.8167"}, {0.6993, false, "thesis: eccentricity 0.6993"}, {2.0 / 3, false, ""}};
    write_plot(folder / "levels.svg", plot);

    if (!options.variants) return;
    using Population = PopulationOptions;
    const std::vector<std::pair<std::string, void (*)(Population&)>> variants{
        {"as above", [](Population&) {}},
        {"without scan noise", [](Population& p) { p.scan_noise = 0; }},
        {"scan noise 0.15 mm", [](Population& p) { p.scan_noise = 0.15; }},
        {"scan noise 0.3 mm", [](Population& p) { p.scan_noise = 0.3; }},
        {"cavity seen to the end", [](Population& p) { p.cavity_seen = 1, p.interior = Population::Interior::closed; }},
        {"cavity seen to a fifth, mesh open there",
         [](Population& p) { p.cavity_seen = 0.2, p.interior = Population::Interior::open; }},
        {"up to 8 holes", [](Population& p) { p.holes = 8; }}};
    TextTable scans(columns("level 3"));
    for (const auto& [name, change] : variants) {
        Population population;
        change(population);
        add_rows(scans, name, {drawn_outcome(population, 3, 1)});
        fmt::print(stderr, "{} done\n", name);
    }
    scans.write(folder, "scans", "F1 of wheel-made by what the scanner does, level 3");
    fmt::print("{}", scans.markdown());
}

const Registration registered_technique(
    "technique", "wheel-made or hand-made: F1 on generated statuettes by level of difficulty (section 3.2.1)", technique);

struct FixedProportionsOptions {
    std::string output = "experiments-output/proportions";
    int seeds = 100;
    void declare_options(OptionList& list) {
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

/// Counts of ratios, sums over populations.
struct Detections {
    double planted = 0, hit = 0, wrong = 0, wrong_share = 0, any_wrong = 0;
};

Detections over_seeds(const SyntheticMeasuresOptions& made, int seeds) {
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
    for (const Detections& population : list) {
        sum.planted += population.planted, sum.hit += population.hit, sum.wrong += population.wrong;
        sum.wrong_share += population.wrong == 0 ? 0 : population.wrong / (population.hit + population.wrong);
        sum.any_wrong += population.wrong > 0;
    }
    return sum;
}

/// Share of intervals that contain the true coefficient of variation, which follows from the planted deviation of the
/// logarithm.
double coverage(int seeds, double deviation) {
    constexpr Eigen::Index objects = 40;
    const double truth = std::sqrt(std::expm1(deviation * deviation));
    std::vector<int> inside(static_cast<std::size_t>(seeds));
    parallel_for(inside.size(), 1, [&](std::size_t s) {
        Random random(s + 1, 99);
        MeasureTable table;
        table.measures = {{"a", 1, "mm"}};
        table.values.resize(objects, 1);
        for (Eigen::Index i = 0; i < objects; ++i) {
            table.objects.push_back(std::to_string(i));
            table.values(i, 0) = std::exp(random.normal(0, deviation));
        }
        table.units.assign(objects, "mm");
        ProportionOptions study;
        study.seed = s + 1;
        const auto interval = study_proportions(table, study).measures.front().variation_interval;
        inside[s] = interval && interval->low <= truth && truth <= interval->high ? 1 : 0;
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
    table.write(options.output, "recovery", fmt::format("Planted proportions found, over {} populations each", options.seeds));
    for (const char* name : {"power.svg", "power.png"}) write_plot(Path(options.output) / name, power);
    const int populations = 5 * options.seeds;
    fmt::print(
        "{}\n95 % intervals of the coefficient of variation of 40 objects hold the true one in {} (3 %) and {} (15 %) of {} "
        "populations\n",
        table.markdown(), percent(coverage(populations, 0.03)), percent(coverage(populations, 0.15)), populations);
}

const Registration registered_proportions("proportions", "planted proportions found in made populations, and false ones",
                                          fixed_proportions);

struct ClusterPictureOptions {
    std::string output;
    void declare_options(OptionList& list) {
        list("output", output, "folder for the plot and its table").positional().required();
    }
};

struct Form {
    std::string name;
    int points;
    std::array<double, 2> (*place)(Random& draw);
};

std::array<double, 2> on_arc(Random& draw, double x, double y, double radius, double from, double to) {
    const double angle = draw.uniform(from, to), r = radius + 0.04 * draw.normal();
    return {x + r * std::cos(angle), y + r * std::sin(angle)};
}

const std::vector<Form> forms{{"ring", 220, [](Random& draw) { return on_arc(draw, 0, 0, 1, 0, 2 * pi); }},
                              {"disc in the ring", 80,
                               [](Random& draw) {
                                   return std::array{0.12 * draw.normal(), 0.12 * draw.normal()};
                               }},
                              {"upper arc", 140, [](Random& draw) { return on_arc(draw, 2.6, 0.1, 0.8, 0, pi); }},
                              {"lower arc", 140, [](Random& draw) { return on_arc(draw, 3.4, 0, 0.8, pi, 2 * pi); }},
                              {"scattered", 25, [](Random& draw) {
                                   return std::array{draw.uniform(-1.6, 4.8), draw.uniform(-1.6, 1.6)};
                               }}};

void cluster_picture(const ClusterPictureOptions& options) {
    const Path folder(options.output);
    Random draw(37, 1);
    std::vector<std::array<double, 2>> places;
    std::vector<std::size_t> form_of;
    for (std::size_t f = 0; f < forms.size(); ++f)
        for (int k = 0; k < forms[f].points; ++k) places.push_back(forms[f].place(draw)), form_of.push_back(f);
    Eigen::MatrixXd samples(static_cast<Eigen::Index>(places.size()), 2);
    for (std::size_t i = 0; i < places.size(); ++i) samples.row(static_cast<Eigen::Index>(i)) << places[i][0], places[i][1];
    const double epsilon = 0.22;
    const int minimum = 5;
    const std::vector<int> labels = dbscan(samples, epsilon, minimum);
    Plot plot{"DBSCAN: clusters of any form, and noise", {"x"}, {"y"}};
    plot.equal = true;
    TextTable table({"cluster", "points", "form most of them are drawn from", "of that form"});
    for (int label = -1; label <= *std::max_element(labels.begin(), labels.end()); ++label) {
        PlotSeries series{label < 0 ? "noise" : "cluster " + std::to_string(label + 1)};
        series.joined = false;
        std::map<std::size_t, int> drawn;
        for (std::size_t i = 0; i < places.size(); ++i)
            if (labels[i] == label) series.points.push_back(places[i]), ++drawn[form_of[i]];
        if (series.points.empty()) continue;
        const auto most =
            std::max_element(drawn.begin(), drawn.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
        table.add({series.name, std::to_string(series.points.size()), forms[most->first].name, std::to_string(most->second)});
        plot.series.push_back(std::move(series));
    }
    table.write(folder, "clusters");
    write_plot(folder / "clusters.svg", plot);
    fmt::print("{}", table.markdown());
}

const Registration registered_clusters("dbscan", "points of several forms and the clusters found among them (figure 3.7)",
                                       cluster_picture);

}  // namespace

}  // namespace ostraka::experiments
