// The mould study on synthetic heads and on mixes of scanned faces: which similarity and epsilon recover the moulds.
#include "mould_heads.h"

#include "ostraka/figures/plot.h"
#include "ostraka/figures/table.h"
#include "ostraka/stats/scores.h"

#include <algorithm>
#include <iostream>
#include <map>
#include <set>

namespace ostraka::experiments {

namespace {

struct MouldExperiment {
    std::string output = "experiments-output/moulds";
    std::vector<std::string> parts, faces;
    int objects = 40, casts = 43, seeds = 3;
    std::uint64_t vertices = 10000;
    void list_options(OptionList& list) {
        list("output", output, "folder for tables and plots").positional();
        list("part", parts, "parts of the experiment; empty: all", Choices{"choices", "wear", "runs", "scans"});
        list("face", faces, "mesh files of faces in correspondence, for the part scans");
        list("objects", objects, "number of casts of four moulds", Range{8, 10000});
        list("casts", casts, "number of casts in the thesis's runs, with 60 hand-made heads for 43 casts", Range{8, 10000});
        list("seeds", seeds, "number of populations", Range{1, 1000});
        list("vertices", vertices, "number of vertices of a whole head", Range{1500, 1000000});
    }
};

const auto everyone = [](std::size_t) { return true; };
std::vector<HeadPart> back_only(std::size_t) { return {HeadPart::back}; }

int group_count(const std::vector<int>& labels) { return static_cast<int>(std::set<int>(labels.begin(), labels.end()).size()); }

struct Choice {
    const char *similarity, *method, *epsilon;
};
std::vector<Choice> choices() {
    std::vector<Choice> list;
    for (const char* similarity : {"matches", "consistent", "registration", "combined"})
        for (const char* method : {"linkage", "dbscan", "embedding"})
            for (const char* epsilon : {"0.1", "knn", "volume", "knee", "silhouette", "nested"})
                if (std::string(epsilon) != "volume" || std::string(method) == "embedding")
                    list.push_back({similarity, method, epsilon});
    return list;
}
MouldGroups grouped(const Compared& compared, const Choice& choice, int expected) {
    GroupOptions options;
    set_option(options, "method", choice.method);
    options.epsilon = choice.epsilon;
    options.expected_size = expected;
    return group_heads(mould_distances(compared.matrices, choice.similarity), options);
}
constexpr Choice by_default{"combined", "linkage", "nested"};
/// The thesis's choice: MeshSIFT's count, DBSCAN in the embedding with the mean distance of nearest neighbours.
constexpr Choice thesis{"matches", "embedding", "knn"};

CastOptions cast_of(const MouldExperiment& options, double wear) {
    CastOptions cast;
    cast.vertices = options.vertices;
    cast.wear = wear;
    cast.pressure = wear > 0 ? 0.01 : 0;
    cast.noise = 0.001;
    return cast;
}

/// Adjusted Rand index of a choice, for groups of about `expected` casts.
double score_of(const Compared& compared, const Choice& choice, int expected) {
    return adjusted_rand_index(grouped(compared, choice, expected).labels, compared.truth);
}

/// Adjusted Rand indices [level of wear][choice][population].
using Scores = std::vector<std::vector<std::vector<double>>>;

Scores scores_by_wear(const MouldExperiment& options, const std::vector<double>& levels, const std::vector<Choice>& list,
                      double min_pressure) {
    Scores scores(levels.size(), std::vector<std::vector<double>>(list.size()));
    for (int seed = 1; seed <= options.seeds; ++seed) {
        MouldPopulationOptions population;
        population.objects = options.objects;
        population.seed = static_cast<std::uint64_t>(seed);
        for (std::size_t level = 0; level < levels.size(); ++level) {
            CastOptions cast = cast_of(options, levels[level]);
            cast.pressure = std::max(cast.pressure, min_pressure);
            const Compared compared = compare(synthetic_heads(population, cast), everyone, back_only);
            for (std::size_t i = 0; i < list.size(); ++i)
                scores[level][i].push_back(score_of(compared, list[i], options.objects / population.moulds));
            fmt::print(stderr,
                       "seed {} wear {:g}: {:.0f} features a head in {:.1f} s, pairs {:.1f} s (processor {:.1f}, {:.1f})\n", seed,
                       levels[level], compared.features, compared.finding.wall, compared.comparing.wall,
                       compared.finding.processor, compared.comparing.processor);
        }
    }
    return scores;
}

/// Prints the table and writes it to OUTPUT/NAME.
void write_table(const MouldExperiment& options, const std::string& name, const std::string& title, const TextTable& table) {
    std::cout << title << "\n\n" << table.markdown() << '\n';
    table.write(options.output, name);
}

/// All similarities and choices of epsilon, without wear and with moderate wear.
void choice_experiment(const MouldExperiment& options) {
    TextTable table({"similarity", "method", "epsilon", "no wear", "wear 0.01", "wear 0.02"});
    const std::vector<Choice> list = choices();
    const Scores scores = scores_by_wear(options, {0, 0.01, 0.02}, list, 0);
    for (std::size_t i = 0; i < list.size(); ++i)
        table.add({list[i].similarity, list[i].method, list[i].epsilon, fixed(mean_of(scores[0][i]), 2),
                   fixed(mean_of(scores[1][i]), 2), fixed(mean_of(scores[2][i]), 2)});
    write_table(options, "choices",
                fmt::format("Adjusted Rand index, mean of {} populations of {} casts of 4 moulds, faces only", options.seeds,
                            options.objects),
                table);
}

const std::vector<std::pair<std::string, Choice>> compared_choices{
    {"default (combined, linkage, nested)", by_default},
    {"consistent, linkage, silhouette", {"consistent", "linkage", "silhouette"}},
    {"matches, linkage, nested", {"matches", "linkage", "nested"}},
    {"registration, embedding, nested", {"registration", "embedding", "nested"}},
    {"consistent, linkage, nested", {"consistent", "linkage", "nested"}},
    {"thesis (matches, embedding, knn)", thesis}};

/// Results for increasing wear.
void wear_experiment(const MouldExperiment& options) {
    const std::vector<double> levels{0, 0.005, 0.01, 0.02, 0.03, 0.04, 0.06};
    std::vector<Choice> list;
    std::vector<std::string> columns{"wear"};
    Plot plot;
    plot.title = "Moulds found as wear grows";
    plot.x.label = "wear: standard deviation of the smoothing, share of the head's height";
    plot.y.label = "adjusted Rand index";
    plot.y.minimum = 0, plot.y.maximum = 1;
    for (const auto& [name, choice] : compared_choices) {
        list.push_back(choice);
        columns.push_back(name);
        plot.series.push_back({name, {}});
    }
    const Scores scores = scores_by_wear(options, levels, list, 0.01);
    TextTable table(columns);
    for (std::size_t level = 0; level < levels.size(); ++level) {
        std::vector<std::string> cells{significant(levels[level], 3)};
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::vector<double>& values = scores[level][i];
            cells.push_back(fixed(mean_of(values), 2) + " (" + fixed(*std::min_element(values.begin(), values.end()), 2) + ")");
            plot.series[i].points.push_back({levels[level], mean_of(values)});
        }
        table.add(cells);
    }
    write_table(
        options, "wear",
        fmt::format("Adjusted Rand index as wear grows, mean (least) of {} populations of {} casts of 4 moulds, faces only, "
                    "pressure 0.01, noise 0.001",
                    options.seeds, options.objects),
        table);
    write_plot(Path(options.output) / "wear.svg", plot);
}

/// Figure 3.8: heads in the first two dimensions of the embedding, one series per group found by the thesis's choice, labelled
/// by origin.
void draw_groups(const Path& file, const std::string& title, const MouldGroups& groups, const std::vector<std::string>& kinds) {
    Plot plot;
    plot.title = title;
    plot.x.label = "first direction of the embedding";
    plot.y.label = "second";
    plot.equal = true;
    for (int group = 0; group < group_count(groups.labels); ++group) {
        PlotSeries series;
        series.name = "group " + std::to_string(group + 1);
        series.joined = false;
        for (std::size_t i = 0; i < groups.labels.size(); ++i) {
            if (groups.labels[i] != group) continue;
            const auto row = static_cast<Eigen::Index>(i);
            series.points.push_back({groups.coordinates(row, 0), groups.coordinates(row, 1)});
            series.labels.push_back(kinds[i]);
        }
        plot.series.push_back(std::move(series));
    }
    write_plot(file, plot);
}

/// The thesis's runs: moulded heads, some of them bearded, and hand-formed heads.
void run_experiment(const MouldExperiment& options) {
    MouldPopulationOptions population;
    population.objects = options.casts;
    population.hand_made = (options.casts * 60 + 21) / 43;
    population.seed = 5;
    CastOptions cast = cast_of(options, 0.01);
    cast.beard = 0.4;
    cast.dents = 2;
    const Heads heads = synthetic_heads(population, cast);
    const auto moulded = [&](std::size_t i) { return !heads.hand_made[i]; };
    const auto short_hair = [&](std::size_t i) { return moulded(i) && !heads.long_hair[i]; };
    struct StudyVariant {
        const char* name;
        std::function<bool(std::size_t)> chosen;
        std::vector<HeadPart> without;
        const char* drawn = nullptr;  ///< file of the plot
    };
    const std::vector<StudyVariant> runs{
        {"moulded, faces only", moulded, {HeadPart::back}, "moulded.svg"},
        {"short hair, heads without beards", [&](std::size_t i) { return short_hair(i) && !heads.beard[i]; }, {HeadPart::back}},
        {"short hair, with beards", short_hair, {HeadPart::back}},
        {"short hair, beards removed", short_hair, {HeadPart::back, HeadPart::beard}},
        {"short hair, beards and chins removed", short_hair, {HeadPart::back, HeadPart::beard, HeadPart::chin}},
        {"formed by hand, whole heads (truth: hats)", [&](std::size_t i) { return !moulded(i); }, {}},
        {"all together, whole heads (truth: moulds, hats)", everyone, {}, "all.svg"}};
    TextTable table({"run", "heads", "kinds", "groups", "adjusted Rand index", "silhouette", "thesis's choice: groups",
                     "its index", "moulded against hand-made"});
    for (const StudyVariant& run : runs) {
        const Compared compared = compare(heads, run.chosen, [&](std::size_t) { return run.without; });
        const MouldGroups groups = grouped(compared, by_default, 0), theirs = grouped(compared, thesis, 0);
        // Number of groups that contain both kinds.
        std::map<int, std::set<bool>> kinds;
        for (std::size_t i = 0; i < groups.labels.size(); ++i)
            kinds[groups.labels[i]].insert(compared.moulds[i].starts_with("hand"));
        const auto mixed = std::count_if(kinds.begin(), kinds.end(), [](const auto& group) { return group.second.size() > 1; });
        table.add({run.name, std::to_string(groups.labels.size()), std::to_string(group_count(compared.truth)),
                   std::to_string(group_count(groups.labels)), fixed(adjusted_rand_index(groups.labels, compared.truth), 2),
                   fixed(groups.silhouette, 2), std::to_string(group_count(theirs.labels)),
                   fixed(adjusted_rand_index(theirs.labels, compared.truth), 2),
                   mixed == 0 ? "apart" : std::to_string(mixed) + " mixed groups"});
        if (run.drawn != nullptr)
            draw_groups(Path(options.output) / run.drawn, std::string(run.name) + ": groups as the thesis finds them", theirs,
                        compared.moulds);
        std::cerr << run.name << " done\n";
    }
    write_table(
        options, "runs",
        fmt::format("The thesis's runs: {} casts of 4 moulds (wear 0.01, pressure 0.01, noise 0.001, beards on 40 %), {} heads "
                    "formed by hand",
                    population.objects, population.hand_made),
        table);
}

void scan_experiment(const MouldExperiment& options) {
    std::vector<std::string> columns{"difference", "wear"};
    for (const auto& [name, choice] : compared_choices) columns.push_back(name);
    columns.emplace_back("silhouette");
    TextTable table(columns);
    for (const double difference : {1.0, 0.5, 0.25})
        for (const double wear : {0.0, 0.01, 0.02}) {
            const Compared compared =
                compare(scanned_heads(options.faces, options.objects, options.vertices, difference, wear), everyone, back_only);
            std::vector<std::string> cells{significant(difference, 2), significant(wear, 2)};
            for (const auto& [name, choice] : compared_choices)
                cells.push_back(fixed(score_of(compared, choice, options.objects / 4), 2));
            cells.push_back(fixed(grouped(compared, by_default, 0).silhouette, 2));
            table.add(cells);
            fmt::print(stderr, "difference {:g} wear {:g} done\n", difference, wear);
        }
    write_table(options, "scans",
                fmt::format("Mixes of {} scanned faces: adjusted Rand index over {} casts of 4 moulds", options.faces.size(),
                            options.objects),
                table);
}

/// Compares similarities and choices of epsilon for grouping synthetic heads, and mixes of scanned faces, by mould.
void moulds(const MouldExperiment& options) {
    const auto wanted = [&](const char* part) {
        return options.parts.empty() || std::find(options.parts.begin(), options.parts.end(), part) != options.parts.end();
    };
    if (wanted("choices")) choice_experiment(options);
    if (wanted("wear")) wear_experiment(options);
    if (wanted("runs")) run_experiment(options);
    if (wanted("scans") && !options.faces.empty()) scan_experiment(options);
}

const Registration registered("moulds", "moulds of made heads and of mixes of faces, found again", moulds);

}  // namespace

}  // namespace ostraka::experiments
