// The mould study on synthetic heads and on mixes of scanned faces: which similarity and epsilon recover the moulds.
#include "experiments.h"
#include "report.h"

#include "ostraka/collection/moulds.h"
#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"
#include "ostraka/geom/diffusion.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/submesh.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/remesh/remesh.h"
#include "ostraka/report/plot.h"
#include "ostraka/report/table.h"
#include "ostraka/stats/random.h"
#include "ostraka/stats/scores.h"
#include "ostraka/stats/summary.h"
#include "ostraka/synthetic/head_casts.h"

#include <algorithm>
#include <functional>
#include <iostream>
#include <map>
#include <set>

namespace ostraka::experiments {

namespace {

/// Heads with their moulds.
struct Heads {
    std::vector<Mesh> meshes;
    std::vector<std::vector<std::int32_t>> labels;
    std::vector<std::string> moulds, names;
    std::vector<bool> beard, long_hair, hand_made;
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

Heads synthetic_heads(const MouldPopulationOptions& population, const CastOptions& cast) {
    auto plan = plan_heads(population, cast);
    Heads heads;
    heads.meshes.resize(plan.size());
    heads.labels.resize(plan.size());
    std::vector<HeadCast> casts(plan.size());
    parallel_for(
        plan.size(), [&](std::size_t i) { casts[i] = cast_planned(plan[i], population); }, 1);
    for (std::size_t i = 0; i < plan.size(); ++i) {
        heads.meshes[i] = std::move(casts[i].mesh);
        heads.labels[i] = std::move(casts[i].face_labels);
        heads.moulds.push_back(plan[i].mould);
        heads.names.push_back(plan[i].name);
        heads.beard.push_back(casts[i].beard);
        heads.long_hair.push_back(plan[i].shape.long_hair);
        heads.hand_made.push_back(plan[i].shape.hat != HeadShape::Hat::none);
    }
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

Compared compare(const Heads& heads, const std::function<bool(std::size_t)>& chosen,
                 const std::function<std::vector<HeadPart>(std::size_t)>& without) {
    std::vector<std::size_t> list;
    for (std::size_t i = 0; i < heads.meshes.size(); ++i)
        if (chosen(i)) list.push_back(i);
    std::vector<Mesh> meshes(list.size());
    std::vector<double> sizes(list.size());
    parallel_for(
        list.size(),
        [&](std::size_t k) {
            const auto& labels = heads.labels[list[k]];
            const auto parts = without(list[k]);
            std::vector<bool> keep;
            for (std::size_t f = 0; f < heads.meshes[list[k]].number_of_faces(); ++f)
                keep.push_back(labels.empty() ||
                               std::find(parts.begin(), parts.end(), static_cast<HeadPart>(labels[f])) == parts.end());
            meshes[k] = keep_faces(heads.meshes[list[k]], keep, true).mesh;
            sizes[k] = std::sqrt(surface_area(meshes[k]));
        },
        1);
    CompareOptions options;
    options.features.size = upper_median(sizes);

    Compared result;
    std::vector<std::optional<PreparedHead>> ready(list.size());
    Stopwatch finding;
    parallel_for(
        list.size(), [&](std::size_t k) { ready[k].emplace(prepare_head(meshes[k], options)); }, 1);
    result.finding = finding.seconds();
    std::vector<PreparedHead> prepared;
    std::vector<std::string> names;
    std::map<std::string, int> numbers;
    for (std::size_t k = 0; k < list.size(); ++k) {
        result.features += static_cast<double>(ready[k]->features.features.size()) / static_cast<double>(list.size());
        prepared.push_back(std::move(*ready[k]));
        names.push_back(heads.names[list[k]]);
        result.moulds.push_back(heads.moulds[list[k]]);
        result.truth.push_back(numbers.try_emplace(heads.moulds[list[k]], static_cast<int>(numbers.size())).first->second);
    }
    Stopwatch comparing;
    result.matrices = compare_heads(names, prepared, options);
    result.comparing = comparing.seconds();
    return result;
}

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

CastOptions cast_of(const MouldExperimentOptions& options, double wear) {
    CastOptions cast;
    cast.vertices = options.vertices;
    cast.wear = wear;
    cast.pressure = wear > 0 ? 0.01 : 0;
    cast.noise = 0.001;
    return cast;
}

/// All similarities and choices of epsilon, without wear and with moderate wear.
void choice_experiment(const MouldExperimentOptions& options) {
    TextTable table({"similarity", "method", "epsilon", "no wear", "wear 0.01", "wear 0.02"});
    std::vector<std::vector<double>> scores(3, std::vector<double>(choices().size(), 0));
    for (int seed = 1; seed <= options.seeds; ++seed) {
        MouldPopulationOptions population;
        population.objects = options.objects;
        population.seed = static_cast<std::uint64_t>(seed);
        const double levels[] = {0, 0.01, 0.02};
        for (std::size_t level = 0; level < 3; ++level) {
            const Compared compared = compare(synthetic_heads(population, cast_of(options, levels[level])), everyone, back_only);
            std::cerr << format("seed %d wear %g: %.0f features a head in %.1f s, pairs %.1f s (processor %.1f, %.1f)\n", seed,
                                levels[level], compared.features, compared.finding.wall, compared.comparing.wall,
                                compared.finding.processor, compared.comparing.processor);
            for (std::size_t i = 0; i < choices().size(); ++i)
                scores[level][i] +=
                    adjusted_rand_index(grouped(compared, choices()[i], options.objects / population.moulds).labels,
                                        compared.truth) /
                    options.seeds;
        }
    }
    for (std::size_t i = 0; i < choices().size(); ++i)
        table.add({choices()[i].similarity, choices()[i].method, choices()[i].epsilon, fixed(scores[0][i], 2),
                   fixed(scores[1][i], 2), fixed(scores[2][i], 2)});
    std::cout << "Adjusted Rand index, mean of " << options.seeds << " populations of " << options.objects
              << " casts of 4 moulds, faces only\n\n"
              << table.markdown() << "\n";
    table.write(options.output, "choices");
}

/// Results for increasing wear.
void wear_experiment(const MouldExperimentOptions& options) {
    const std::vector<double> levels{0, 0.005, 0.01, 0.02, 0.03, 0.04, 0.06};
    struct Curve {
        const char* name;
        Choice choice;
        std::vector<std::vector<double>> scores;
    };
    std::vector<Curve> curves{{"default (combined, linkage, nested)", by_default, {}},
                              {"consistent, linkage, silhouette", {"consistent", "linkage", "silhouette"}, {}},
                              {"matches, linkage, nested", {"matches", "linkage", "nested"}, {}},
                              {"registration, embedding, nested", {"registration", "embedding", "nested"}, {}},
                              {"consistent, linkage, nested", {"consistent", "linkage", "nested"}, {}},
                              {"thesis (matches, embedding, knn)", thesis, {}}};
    for (auto& curve : curves) curve.scores.resize(levels.size());
    for (int seed = 1; seed <= options.seeds; ++seed) {
        for (std::size_t level = 0; level < levels.size(); ++level) {
            MouldPopulationOptions population;
            population.objects = options.objects;
            population.seed = static_cast<std::uint64_t>(seed);
            CastOptions cast = cast_of(options, levels[level]);
            cast.pressure = 0.01;
            const Compared compared = compare(synthetic_heads(population, cast), everyone, back_only);
            for (auto& curve : curves)
                curve.scores[level].push_back(adjusted_rand_index(
                    grouped(compared, curve.choice, options.objects / population.moulds).labels, compared.truth));
            std::cerr << format("seed %d wear %g: %.2f\n", seed, levels[level], curves[0].scores[level].back());
        }
    }
    Plot plot;
    plot.title = "Moulds found as wear grows";
    plot.x.label = "wear: standard deviation of the smoothing, share of the head's height";
    plot.y.label = "adjusted Rand index";
    plot.y.minimum = 0, plot.y.maximum = 1;
    std::vector<std::string> columns{"wear"};
    for (const auto& curve : curves) columns.push_back(curve.name);
    TextTable table(columns);
    for (std::size_t level = 0; level < levels.size(); ++level) {
        std::vector<std::string> cells{significant(levels[level], 3)};
        for (const auto& curve : curves) {
            double mean = 0;
            for (const double score : curve.scores[level]) mean += score / options.seeds;
            cells.push_back(fixed(mean, 2) + " (" +
                            fixed(*std::min_element(curve.scores[level].begin(), curve.scores[level].end()), 2) + ")");
        }
        table.add(cells);
    }
    for (const auto& curve : curves) {
        PlotSeries series;
        series.name = curve.name;
        for (std::size_t level = 0; level < levels.size(); ++level) {
            double mean = 0;
            for (const double score : curve.scores[level]) mean += score / options.seeds;
            series.points.push_back({levels[level], mean});
        }
        plot.series.push_back(std::move(series));
    }
    std::cout << "Adjusted Rand index as wear grows, mean (least) of " << options.seeds << " populations of " << options.objects
              << " casts of 4 moulds, faces only, pressure 0.01, noise 0.001\n\n"
              << table.markdown() << "\n";
    table.write(options.output, "wear");
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
void run_experiment(const MouldExperimentOptions& options) {
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
    std::cout << "The thesis's runs: " << population.objects
              << " casts of 4 moulds (wear 0.01, pressure 0.01, noise 0.001, beards on 40 %), " << population.hand_made
              << " heads formed by hand\n\n"
              << table.markdown() << "\n";
    table.write(options.output, "runs");
}

/// Casts of moulds that are mixes of scanned faces.
Heads scanned_heads(const MouldExperimentOptions& options, double difference, double wear) {
    std::vector<MeshFile> faces;
    for (const auto& file : options.faces) faces.push_back(read_mesh(file));
    std::vector<Eigen::MatrixXd> places;
    for (const auto& face : faces) {
        places.push_back(positions(face.mesh));
        if (places.back().rows() != places.front().rows() || faces.size() < 2)
            fail_usage("the faces are not in correspondence", "give two or more with the same vertices");
    }
    // The largest component is the shell of the face; eyes and teeth are separate components.
    const SubMesh shell = keep_faces(faces.front().mesh, std::vector<bool>(faces.front().mesh.number_of_faces(), true), true);
    Heads heads;
    Random random(11);
    constexpr int moulds = 4;
    std::vector<Eigen::MatrixXd> archetypes;
    for (int mould = 0; mould < moulds; ++mould) {
        Eigen::MatrixXd mix = places.front();
        for (std::size_t k = 1; k < places.size(); ++k) mix += difference * random.normal() * (places[k] - places.front());
        archetypes.push_back(mix);
    }
    for (int i = 0; i < options.objects; ++i) {
        Mesh mesh = shell.mesh;
        for (const Vertex v : mesh.vertices())
            mesh.point(v) = point_of(
                archetypes[static_cast<std::size_t>(i % moulds)].row(static_cast<Eigen::Index>(shell.vertices[v])).transpose());
        heads.meshes.push_back(std::move(mesh));
        heads.moulds.push_back("mould-" + std::to_string(i % moulds + 1));
        heads.names.push_back("head-" + std::to_string(i + 1));
    }
    heads.labels.resize(heads.meshes.size());
    parallel_for(
        heads.meshes.size(),
        [&](std::size_t i) {
            // A different number of vertices for each cast, so that no two meshes coincide.
            Random own(23, i);
            RemeshOptions remeshing;
            remeshing.vertices = static_cast<std::uint64_t>(options.vertices / 2 * own.uniform(0.9, 1.1));
            Mesh mesh = remesh(heads.meshes[i], remeshing).mesh;
            const double size = std::sqrt(surface_area(mesh));
            if (wear > 0) set_positions(mesh, Diffusion(mesh).smoothed(positions(mesh), wear * own.uniform(0.5, 1) * size, 3));
            std::vector<Vector> normals;
            for (const Vertex v : mesh.vertices()) normals.push_back(vertex_normal(mesh, v));
            for (const Vertex v : mesh.vertices()) mesh.point(v) += 0.001 * size * own.normal() * normals[v];
            const Eigen::Matrix3d rotation =
                Eigen::Quaterniond(own.normal(), own.normal(), own.normal(), own.normal()).normalized().toRotationMatrix();
            for (const Vertex v : mesh.vertices()) mesh.point(v) = point_of(rotation * eigen(mesh.point(v)));
            heads.meshes[i] = std::move(mesh);
        },
        1);
    return heads;
}

void scan_experiment(const MouldExperimentOptions& options) {
    TextTable table({"difference", "wear", "default", "consistent, linkage, silhouette", "matches, linkage, nested",
                     "registration, embedding, nested", "consistent, linkage, nested", "thesis (matches, embedding, knn)",
                     "silhouette"});
    for (const double difference : {1.0, 0.5, 0.25}) {
        for (const double wear : {0.0, 0.01, 0.02}) {
            const Compared compared = compare(scanned_heads(options, difference, wear), everyone, back_only);
            const auto score = [&](const Choice& choice) {
                return fixed(adjusted_rand_index(grouped(compared, choice, options.objects / 4).labels, compared.truth), 2);
            };
            table.add({significant(difference, 2), significant(wear, 2), score(by_default),
                       score({"consistent", "linkage", "silhouette"}), score({"matches", "linkage", "nested"}),
                       score({"registration", "embedding", "nested"}), score({"consistent", "linkage", "nested"}), score(thesis),
                       fixed(grouped(compared, by_default, 0).silhouette, 2)});
            std::cerr << format("difference %g wear %g done\n", difference, wear);
        }
    }
    std::cout << "Mixes of " << options.faces.size() << " scanned faces: adjusted Rand index over " << options.objects
              << " casts of 4 moulds\n\n"
              << table.markdown() << "\n";
    table.write(options.output, "scans");
}

}  // namespace

void moulds(const MouldExperimentOptions& options) {
    const auto wanted = [&](const char* part) {
        return options.parts.empty() || std::find(options.parts.begin(), options.parts.end(), part) != options.parts.end();
    };
    if (wanted("choices")) choice_experiment(options);
    if (wanted("wear")) wear_experiment(options);
    if (wanted("runs")) run_experiment(options);
    if (wanted("scans") && !options.faces.empty()) scan_experiment(options);
}

}  // namespace ostraka::experiments
