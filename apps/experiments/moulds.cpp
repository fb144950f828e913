// The mould study on synthetic heads and on mixes of scanned faces: which similarity and epsilon recover the moulds.
#include "harness.h"
#include "scenes.h"

#include "ostraka/collection/moulds.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/figures/plot.h"
#include "ostraka/geom/diffusion.h"
#include "ostraka/geom/submesh.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/stats/scores.h"
#include "ostraka/stats/summary.h"
#include "ostraka/synthetic/head_casts.h"

#include <algorithm>
#include <map>
#include <set>

namespace ostraka::experiments {

namespace {

struct Head {
    Mesh mesh;
    std::vector<std::int32_t> labels;
    std::string mould, name;
    bool beard = false, long_hair = false, hand_made = false;
};

/// Generates a planned head. If its features touch, so that the surface has a handle, it is drawn again: another cast of its
/// mould or, for hand-formed heads, another head with such a hat.
HeadCast cast_planned(PlannedHead& head, const MouldPopulationOptions& population) {
    constexpr int attempts = 10;
    const HeadShape::Hat hat = head.shape.hat;
    for (int attempt = 1;; ++attempt) {
        try {
            return cast_head(head.shape, head.cast);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::failure || attempt == attempts) throw;
        }
        ++head.cast.seed;
        if (hat == HeadShape::Hat::none) continue;
        ArchetypeOptions archetype;
        archetype.hand_made = true;
        archetype.difference = population.difference;
        archetype.seed = head.cast.seed;
        do head.shape = head_archetype(archetype), ++archetype.seed;
        while (head.shape.hat != hat);
    }
}

std::vector<Head> synthetic_heads(const MouldPopulationOptions& population, const CastOptions& cast) {
    auto plan = plan_heads(population, cast);
    std::vector<Head> heads(plan.size());
    parallel_for(plan.size(), 1, [&](std::size_t i) {
        HeadCast made = cast_planned(plan[i], population);
        heads[i] = {std::move(made.mesh),
                    std::move(made.face_labels),
                    plan[i].mould,
                    plan[i].name,
                    made.beard,
                    plan[i].shape.long_hair,
                    plan[i].shape.hat != HeadShape::Hat::none};
    });
    return heads;
}

/// Casts of moulds that are mixes of the faces in mesh files, with about half of `vertices`. Throws Error (usage) if the faces
/// are not in correspondence.
std::vector<Head> scanned_heads(const std::vector<std::string>& files, int objects, std::uint64_t vertices, double difference,
                                double wear) {
    std::vector<Mesh> faces;
    std::vector<Eigen::MatrixXd> places;
    for (const std::string& file : files) {
        faces.push_back(read_mesh(file).mesh);
        places.push_back(positions(faces.back()));
        if (places.back().rows() != places.front().rows() || files.size() < 2)
            fail_usage("the faces are not in correspondence", "give two or more with the same vertices");
    }
    // The largest component is the shell of the face; eyes and teeth are separate components.
    const SubMesh shell = keep_faces(faces.front(), std::vector<bool>(faces.front().number_of_faces(), true), true);
    Random random(11);
    constexpr int moulds = 4;
    std::vector<Eigen::MatrixXd> archetypes(moulds, places.front());
    for (Eigen::MatrixXd& mix : archetypes)
        for (std::size_t k = 1; k < places.size(); ++k) mix += difference * random.normal() * (places[k] - places.front());
    std::vector<Head> heads(static_cast<std::size_t>(objects));
    parallel_for(heads.size(), 1, [&](std::size_t i) {
        const Eigen::MatrixXd& archetype = archetypes[i % moulds];
        std::vector<Point> points;
        for (const Index v : shell.vertices) points.push_back(point_of(archetype.row(static_cast<Eigen::Index>(v)).transpose()));
        // A different number of vertices for each cast, so that no two meshes coincide.
        Random draw(23, i);
        Mesh mesh = remeshed(with_points(shell.mesh, points),
                             static_cast<std::uint64_t>(static_cast<double>(vertices / 2) * draw.uniform(0.9, 1.1)));
        const double size = std::sqrt(surface_area(mesh));
        if (wear > 0) set_positions(mesh, Diffusion(mesh).smoothed(positions(mesh), wear * draw.uniform(0.5, 1) * size, 3));
        std::vector<Vector> normals;
        for (const Vertex v : mesh.vertices()) normals.push_back(vertex_normal(mesh, v));
        for (const Vertex v : mesh.vertices()) mesh.point(v) += 0.001 * size * draw.normal() * normals[v];
        const Eigen::Matrix3d rotation =
            Eigen::Quaterniond(draw.normal(), draw.normal(), draw.normal(), draw.normal()).normalized().toRotationMatrix();
        heads[i].mesh = warped(std::move(mesh), [&](const Eigen::Vector3d& p) { return rotation * p; });
        heads[i].mould = "mould-" + std::to_string(i % moulds + 1);
        heads[i].name = "head-" + std::to_string(i + 1);
    });
    return heads;
}

/// Comparison of a selection of heads without some of their parts.
struct Compared {
    MouldMatrices matrices;
    std::vector<int> truth;
    std::vector<std::string> moulds;
    double features = 0;  ///< mean number
    Seconds finding, comparing;
};

Compared compare(const std::vector<Head>& heads, const std::function<bool(const Head&)>& chosen,
                 const std::vector<HeadPart>& without) {
    std::vector<const Head*> list;
    for (const Head& head : heads)
        if (chosen(head)) list.push_back(&head);
    std::vector<Mesh> meshes(list.size());
    std::vector<double> sizes(list.size());
    parallel_for(list.size(), 1, [&](std::size_t k) {
        std::vector<bool> keep(list[k]->mesh.number_of_faces(), true);
        for (std::size_t f = 0; f < list[k]->labels.size(); ++f)
            keep[f] = std::find(without.begin(), without.end(), static_cast<HeadPart>(list[k]->labels[f])) == without.end();
        meshes[k] = keep_faces(list[k]->mesh, keep, true).mesh;
        sizes[k] = std::sqrt(surface_area(meshes[k]));
    });
    CompareOptions options;
    options.features.size = upper_median(sizes);

    Compared result;
    std::vector<std::optional<PreparedHead>> ready(list.size());
    Stopwatch finding;
    parallel_for(list.size(), 1, [&](std::size_t k) { ready[k].emplace(prepare_head(meshes[k], options)); });
    result.finding = finding.seconds();
    std::vector<PreparedHead> prepared;
    std::vector<std::string> names;
    std::map<std::string, int> numbers;
    for (std::size_t k = 0; k < list.size(); ++k) {
        result.features += static_cast<double>(ready[k]->features.features.size()) / static_cast<double>(list.size());
        prepared.push_back(std::move(*ready[k]));
        names.push_back(list[k]->name);
        result.moulds.push_back(list[k]->mould);
        result.truth.push_back(numbers.try_emplace(list[k]->mould, static_cast<int>(numbers.size())).first->second);
    }
    Stopwatch comparing;
    result.matrices = compare_heads(names, prepared, options);
    result.comparing = comparing.seconds();
    return result;
}

struct MouldExperiment {
    std::string output = "experiments-output/moulds";
    std::vector<std::string> parts, faces;
    int objects = 40, casts = 43, seeds = 3;
    std::uint64_t vertices = 10000;
    void declare_options(OptionList& list) {
        list("output", output, "folder for tables and plots").positional();
        list("part", parts, "parts of the experiment; empty: all", Choices{"choices", "wear", "runs", "scans"});
        list("face", faces, "mesh files of faces in correspondence, for the part scans");
        list("objects", objects, "number of casts of four moulds", Range{8, 10000});
        list("casts", casts, "number of casts in the thesis's runs, with 60 hand-made heads for 43 casts", Range{8, 10000});
        list("seeds", seeds, "number of populations", Range{1, 1000});
        list("vertices", vertices, "number of vertices of a whole head", Range{1500, 1000000});
    }
};

const auto everyone = [](const Head&) { return true; };
const std::vector<HeadPart> back_only{HeadPart::back};

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

/// All similarities and choices of epsilon, without wear and with moderate wear.
void choice_experiment(const MouldExperiment& options) {
    TextTable table({"similarity", "method", "epsilon", "no wear", "wear 0.01", "wear 0.02"});
    const std::vector<Choice> list = choices();
    const Scores scores = scores_by_wear(options, {0, 0.01, 0.02}, list, 0);
    for (std::size_t i = 0; i < list.size(); ++i)
        table.add({list[i].similarity, list[i].method, list[i].epsilon, fixed(mean_of(scores[0][i]), 2),
                   fixed(mean_of(scores[1][i]), 2), fixed(mean_of(scores[2][i]), 2)});
    write_table(table, options.output, "choices",
                fmt::format("Adjusted Rand index, mean of {} populations of {} casts of 4 moulds, faces only", options.seeds,
                            options.objects));
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
        table, options.output, "wear",
        fmt::format("Adjusted Rand index as wear grows, mean (least) of {} populations of {} casts of 4 moulds, faces only, "
                    "pressure 0.01, noise 0.001",
                    options.seeds, options.objects));
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
    const std::vector<Head> heads = synthetic_heads(population, cast);
    const auto moulded = [](const Head& head) { return !head.hand_made; };
    const auto short_hair = [](const Head& head) { return !head.hand_made && !head.long_hair; };
    struct StudyVariant {
        const char* name;
        std::function<bool(const Head&)> chosen;
        std::vector<HeadPart> without;
        const char* drawn = nullptr;  ///< file of the plot
    };
    const std::vector<StudyVariant> runs{
        {"moulded, faces only", moulded, back_only, "moulded.svg"},
        {"short hair, heads without beards", [&](const Head& head) { return short_hair(head) && !head.beard; }, back_only},
        {"short hair, with beards", short_hair, back_only},
        {"short hair, beards removed", short_hair, {HeadPart::back, HeadPart::beard}},
        {"short hair, beards and chins removed", short_hair, {HeadPart::back, HeadPart::beard, HeadPart::chin}},
        {"formed by hand, whole heads (truth: hats)", [](const Head& head) { return head.hand_made; }, {}},
        {"all together, whole heads (truth: moulds, hats)", everyone, {}, "all.svg"}};
    TextTable table({"run", "heads", "kinds", "groups", "adjusted Rand index", "silhouette", "thesis's choice: groups",
                     "its index", "moulded against hand-made"});
    for (const StudyVariant& run : runs) {
        const Compared compared = compare(heads, run.chosen, run.without);
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
        fmt::print(stderr, "{} done\n", run.name);
    }
    write_table(
        table, options.output, "runs",
        fmt::format("The thesis's runs: {} casts of 4 moulds (wear 0.01, pressure 0.01, noise 0.001, beards on 40 %), {} heads "
                    "formed by hand",
                    population.objects, population.hand_made));
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
    write_table(table, options.output, "scans",
                fmt::format("Mixes of {} scanned faces: adjusted Rand index over {} casts of 4 moulds", options.faces.size(),
                            options.objects));
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
