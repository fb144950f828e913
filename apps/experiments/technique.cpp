// Classification of the technique of synthetic statuettes, by level, and with simulated scanner effects.
#include "harness.h"

#include "ostraka/collection/technique_study.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/figures/plot.h"
#include "ostraka/figures/table.h"
#include "ostraka/synthetic/statuettes.h"

#include <algorithm>
#include <iostream>
#include <map>

namespace ostraka::experiments {

namespace {

struct TechniqueExperiment {
    std::string output;
    int objects = 100, seeds = 2;
    std::uint64_t vertices = 5000;
    bool variants = false;
    void list_options(OptionList& list) {
        list("output", output, "folder for tables and plots").positional().required();
        list("objects", objects, "number of statuettes of a population", Range{10, 100000});
        list("seeds", seeds, "number of populations of each level", Range{1, 1000});
        list("vertices", vertices, "number of vertices of each mesh");
        list("variants", variants, "also scan noise, missing interior and holes, at level 3");
    }
};

struct Variant {
    std::string name;
    PopulationOptions population;
};

/// Results for one population.
struct Outcome {
    std::map<std::string, ClassifierResult> classifiers;
    std::map<std::string, double> divided;  ///< F1 of divisions that score better than a single group
    std::size_t objects = 0, left_out = 0, open = 0, slices = 0, used = 0;
    Seconds seconds;  ///< for measuring and classifying
};

Outcome outcome_of(const PopulationOptions& options) {
    const auto population = draw_population(options);
    std::vector<std::optional<TechniqueObject>> measured(population.size());
    std::vector<std::array<std::size_t, 3>> counts(population.size());
    parallel_for(population.size(), 1, [&](std::size_t i) {
        const Statuette statuette = generate_statuette(population[i]);
        try {
            TechniqueObject object{std::to_string(i), option_text(population[i], "technique"),
                                   measure_technique(statuette.mesh, Vector(0, 0, 1))};
            counts[i] = {object.measures.open_used > 0 ? std::size_t{1} : 0, object.measures.asked,
                         object.measures.slices.size()};
            measured[i] = std::move(object);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input) throw;  // too few usable slices: counted below
        }
    });
    Outcome outcome;
    std::vector<TechniqueObject> objects;
    for (std::size_t i = 0; i < measured.size(); ++i) {
        if (!measured[i]) {
            ++outcome.left_out;
            continue;
        }
        outcome.open += counts[i][0];
        outcome.slices += counts[i][1];
        outcome.used += counts[i][2];
        objects.push_back(std::move(*measured[i]));
    }
    outcome.objects = objects.size();
    TechniqueStudyOptions study_options;
    study_options.positive = "wheel";
    const Stopwatch watch;
    const TechniqueStudy study = study_technique(objects, study_options);
    outcome.seconds = watch.seconds();
    for (const ClassifierResult& each : study.classifiers) outcome.classifiers[each.classifier.name] = each;
    for (const TechniqueSplit& each : study.splits)
        if (each.f1) outcome.divided[each.descriptor] = each.p_value <= 0.05 ? *each.f1 : -1;
    return outcome;
}

/// Mean over the populations of a classifier's F1.
double mean_f1(const std::vector<Outcome>& outcomes, const std::string& classifier) {
    std::vector<double> values;
    for (const Outcome& each : outcomes) values.push_back(each.classifiers.at(classifier).validation.mean_f1);
    return mean_of(values);
}

const std::vector<std::string> shown{
    "roundness", "eccentricity",    "both means", "both",         "roundness variance",   "eccentricity variance",
    "ovality",   "marks",           "coherence",  "straightness", "upright straightness", "wall variation",
    "outside",   "outside and wall"};

void add_rows(TextTable& table, const std::string& name, const std::vector<Outcome>& outcomes) {
    std::vector<std::string> cells{name};
    std::size_t objects = 0, left_out = 0, slices = 0, used = 0;
    for (const Outcome& each : outcomes)
        objects += each.objects, left_out += each.left_out, slices += each.slices, used += each.used;
    cells.push_back(std::to_string(objects));
    cells.push_back(std::to_string(left_out));
    cells.push_back(fixed(percentage(used, std::max<std::size_t>(slices, 1)), 1));
    for (const auto& classifier : shown) cells.push_back(fixed(mean_f1(outcomes, classifier), 3));
    for (const std::string split : {"roundness mean", "first component"}) {
        std::vector<double> values;
        for (const Outcome& each : outcomes) values.push_back(each.divided.at(split));
        const bool all = *std::min_element(values.begin(), values.end()) >= 0;
        cells.push_back(all ? fixed(mean_of(values), 3) : "no groups");
    }
    table.add(cells);
}

/// Adds areas under the ROC curves.
void add_areas(TextTable& table, const std::string& name, const std::vector<Outcome>& outcomes) {
    std::vector<std::string> cells{name};
    for (const auto& classifier : shown) {
        std::vector<double> areas;
        for (const Outcome& each : outcomes) areas.push_back(each.classifiers.at(classifier).roc.area);
        cells.push_back(fixed(mean_of(areas), 3));
    }
    table.add(cells);
}

std::vector<std::string> columns(const std::string& first) {
    std::vector<std::string> list{first, "objects", "left out", "slices used %"};
    list.insert(list.end(), shown.begin(), shown.end());
    list.insert(list.end(), {"divided by roundness", "divided by first component"});
    return list;
}

void technique(const TechniqueExperiment& options) {
    const auto of = [&](PopulationOptions population, int level, int seed) {
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
        for (int seed = 1; seed <= options.seeds; ++seed) outcomes.push_back(of({}, level, seed));
        add_rows(levels, std::to_string(level), outcomes);
        add_areas(areas, std::to_string(level), outcomes);
        for (const auto& name : drawn) {
            curves[name].name = name;
            curves[name].points.push_back({static_cast<double>(level), mean_f1(outcomes, name)});
        }
        std::cerr << "level " << level << " done\n";
    }
    levels.write(folder, "levels", "F1 of wheel-made by level");
    areas.write(folder, "areas", "Area under the ROC of wheel-made by level");
    std::cout << levels.markdown() << "\n" << areas.markdown() << "\n";
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
    std::vector<Variant> variants{
        {"as above", {}},          {"without scan noise", {}},     {"scan noise 0.15 mm", {}},
        {"scan noise 0.3 mm", {}}, {"cavity seen to the end", {}}, {"cavity seen to a fifth, mesh open there", {}},
        {"up to 8 holes", {}}};
    variants[1].population.scan_noise = 0;
    variants[2].population.scan_noise = 0.15;
    variants[3].population.scan_noise = 0.3;
    variants[4].population.cavity_seen = 1, variants[4].population.interior = PopulationOptions::Interior::closed;
    variants[5].population.cavity_seen = 0.2, variants[5].population.interior = PopulationOptions::Interior::open;
    variants[6].population.holes = 8;
    TextTable scans(columns("level 3"));
    for (const Variant& variant : variants) {
        add_rows(scans, variant.name, {of(variant.population, 3, 1)});
        std::cerr << variant.name << " done\n";
    }
    scans.write(folder, "scans", "F1 of wheel-made by what the scanner does, level 3");
    std::cout << scans.markdown();
}

const Registration registered("technique",
                              "wheel-made or hand-made: F1 on generated statuettes by level of difficulty (section 3.2.1)",
                              technique);

}  // namespace

}  // namespace ostraka::experiments
