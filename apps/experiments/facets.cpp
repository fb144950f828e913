// Classification of fracture and intact surface: trains the model, and evaluates it on held-out objects and scanned fragments.
// Each fragment is evaluated by trees trained without its object.
#include "facet_cases.h"
#include "harness.h"
#include "scenes.h"

#include "ostraka/files/json_build.h"
#include "ostraka/fracture/facet_evidence.h"
#include "ostraka/fracture/facets.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

namespace ostraka::experiments {

namespace {

struct FacetOptions {
    int objects = 20;
    std::uint64_t seed = 1;
    BoostOptions boosting;
    std::string model, pictures;
    std::vector<std::string> meshes, scanned, judged;
    bool each = false;
    void declare_options(OptionList& list) {
        list("objects", objects, "number of training objects of each kind", Range{4, 1000});
        list("seed", seed, "random seed of objects and fractures");
        list("trees", boosting.trees, "number of trees of the model", Range{1, 10000});
        list("depth", boosting.depth, "depth of its trees", Range{1, 16});
        list("model", model, "model file to train and write (data/facets.model.json); else the built-in model is evaluated");
        list("meshes", meshes, "folders of meshes of whole objects that are broken for training too");
        list("scanned", scanned, "folders of fragments in assembled layout for training too");
        list("judge", judged,
             "sources for evaluation: pot:SEED, stone:SEED, made:NAME:SEED, mesh:FILE:SEED or a folder of fragments in assembled "
             "layout");
        list("pictures", pictures, "folder for coloured meshes of the evaluated fragments");
        list("each", each, "one row per fragment");
    }
};

/// A fragment with its features.
struct SeenFragment {
    FacetCase given;
    FacetEvidence evidence;
    std::vector<double> broken;        ///< per patch: area share of fracture
    std::vector<std::size_t> sampled;  ///< patches used for training, drawn by area
    double seconds = 0;
    std::size_t fold = 0;  ///< cross-validation fold of its object

    [[nodiscard]] bool is_known(Face f) const { return given.known.empty() || given.known[f]; }
    [[nodiscard]] FeatureTable rows(const FeatureTable& features) const {
        FeatureTable table;
        for (const std::size_t p : sampled) table.add(features.row(p));
        return table;
    }
};

SeenFragment seen_fragment(FacetCase given) {
    SeenFragment result;
    const Stopwatch watch;
    result.evidence = facet_evidence(given.mesh);
    result.seconds = watch.seconds().processor;
    result.given = std::move(given);
    const FacetGraph& graph = result.evidence.graph;
    result.broken.assign(graph.count(), 0);
    std::vector<double> known(graph.count(), 0);
    for (const Face f : result.given.mesh.faces()) {
        const double area = face_area(result.given.mesh, f);
        if (result.given.broken[f]) result.broken[graph.patch_of_face[f]] += area;
        if (result.is_known(f)) known[graph.patch_of_face[f]] += area;
    }
    constexpr std::size_t samples = 600;
    double sum = 0;
    std::size_t k = 0;
    for (std::size_t p = 0; p < graph.count(); ++p) {
        result.broken[p] /= graph.areas[p] > 0 ? graph.areas[p] : 1;
        for (sum += graph.areas[p]; (static_cast<double>(k) + 0.5) * graph.area < samples * sum && k < samples; ++k)
            if (known[p] > 0.5 * graph.areas[p]) result.sampled.push_back(p);
    }
    for (const std::size_t scale : {0, 2}) result.evidence.around[scale] = {};  // not needed for context, and large
    return result;
}

using Tables = std::vector<FeatureTable>;

/// Trees trained on the sampled patches of fragments for which `used` is true.
BoostedTrees learnt(const std::vector<SeenFragment>& all, const Tables& tables, const std::function<bool(std::size_t)>& used,
                    const BoostOptions& options) {
    FeatureTable rows;
    std::vector<bool> truth;
    std::vector<double> weights;
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (!used(k)) continue;
        // Scanned objects are few but most relevant, and vessel sherds contain little fracture.
        const std::string& object = all[k].given.object;
        const double weight = all[k].given.scanned ? 3 : object.starts_with("pot") || object.starts_with("thin") ? 2 : 1;
        for (std::size_t i = 0; i < all[k].sampled.size(); ++i) {
            rows.add(tables[k].row(i));
            truth.push_back(all[k].broken[all[k].sampled[i]] > 0.5);
            weights.push_back(weight);
        }
    }
    return boost(rows, truth, weights, options);
}

struct LearntFacets {
    FacetModel model;  ///< trained on all fragments
    std::vector<std::vector<double>>
        log_odds;  ///< for each fragment's patches: calibrated, from trees trained without its object
};

/// `folds`: number of folds. Trees that use the context of patches get it from trees trained without the fragment's object.
LearntFacets learn_facets(const std::vector<SeenFragment>& all, std::size_t folds, const BoostOptions& options) {
    LearntFacets result;
    const std::size_t n = all.size();
    Tables alone_tables(n);
    for (std::size_t k = 0; k < n; ++k) alone_tables[k] = all[k].rows(all[k].evidence.features);
    const auto told = [&](std::size_t k, const BoostedTrees& trees) {
        return with_context(all[k].evidence, log_odds_of(trees, all[k].evidence.features));
    };
    // alone[i][j]: trees trained without folds i and j; alone[i][i]: trees trained without fold i.
    std::vector<std::vector<BoostedTrees>> alone(folds, std::vector<BoostedTrees>(folds));
    for (std::size_t i = 0; i < folds; ++i)
        for (std::size_t j = 0; j <= i; ++j)
            alone[i][j] = alone[j][i] = learnt(
                all, alone_tables, [&](std::size_t k) { return all[k].fold != i && all[k].fold != j; }, options);
    // Context of the sampled patches, from trees trained without the fragment's fold and `left_out`.
    const auto tables = [&](std::size_t left_out) {
        Tables rows(n);
        for (std::size_t k = 0; k < n; ++k)
            if (all[k].fold != left_out)
                rows[k] = all[k].rows(told(k, alone[all[k].fold][left_out == folds ? all[k].fold : left_out]));
        return rows;
    };
    std::vector<Eigen::Vector3d> odds;
    std::vector<bool> truth;
    result.log_odds.resize(n);
    for (std::size_t fold = 0; fold < folds; ++fold) {
        const BoostedTrees trees = learnt(
            all, tables(fold), [&](std::size_t k) { return all[k].fold != fold; }, options);
        for (std::size_t k = 0; k < n; ++k) {
            if (all[k].fold != fold) continue;
            result.log_odds[k] = log_odds_of(trees, told(k, alone[fold][fold]));
            for (const std::size_t p : all[k].sampled) {
                odds.emplace_back(1, result.log_odds[k][p], 0);
                truth.push_back(all[k].broken[p] > 0.5);
            }
        }
    }
    const auto everything = [](std::size_t) { return true; };
    result.model.alone = learnt(all, alone_tables, everything, options);
    result.model.trees = learnt(all, tables(folds), everything, options);
    // Log odds shift + slope x that fit the truth best (Platt 1999).
    const Eigen::Vector3d line = logistic(odds, truth, std::vector<double>(odds.size(), 1), 1e-6);
    result.model.shift = line[0], result.model.slope = line[1];
    for (auto& list : result.log_odds)
        for (double& x : list) x = result.model.shift + result.model.slope * x;
    return result;
}

/// Areas by true and predicted class, and the calibration of probabilities.
struct Score {
    Eigen::Array22d area = Eigen::Array22d::Zero();  ///< (truth, called)
    Calibration calibration;
    double seconds = 0, faces = 0, alike = 0;  ///< alike: area classified correctly by its own probability alone
    std::size_t fragments = 0, unclear = 0, whole = 0, passed = 0;

    /// Adds another one, its areas multiplied by `weight`.
    void add(const Score& other, double weight) {
        area += weight * other.area, calibration.bins += weight * other.calibration.bins, alike += weight * other.alike;
        seconds += other.seconds, faces += other.faces, fragments += other.fragments;
        unclear += other.unclear, whole += other.whole, passed += other.passed;
    }
    [[nodiscard]] double agreement() const { return (area(0, 0) + area(1, 1)) / area.sum(); }
};

/// Score of one fragment.
Score score(const SeenFragment& fragment, const std::vector<double>& log_odds) {
    Score result;
    const Stopwatch watch;
    const Facets facets = find_facets(fragment.given.mesh, fragment.evidence, log_odds);
    result.seconds = fragment.seconds + watch.seconds().processor;
    const Mesh& mesh = fragment.given.mesh;
    for (const Face f : mesh.faces()) {
        if (!fragment.is_known(f)) continue;
        const bool broken = fragment.given.broken[f];
        const double area = face_area(mesh, f), p = facets.probability[f];
        result.alike += (p > 0.5) == broken ? area : 0;
        result.area(broken ? 1 : 0, facets.of_face[f] == Facet::fracture ? 1 : 0) += area;
        result.calibration.add(p, broken, area);
    }
    result.faces = static_cast<double>(mesh.number_of_faces());
    result.fragments = 1;
    result.unclear = facets.answer == Facets::Answer::unclear ? 1 : 0;
    result.whole = facets.answer == Facets::Answer::whole ? 1 : 0;
    result.passed = result.agreement() >= 0.9 ? 1 : 0;
    return result;
}

const std::string columns =
    "object | fragments | broken % | agreement % | alone % | recall % | precision % | agree by 90 % | called whole, unclear | "
    "calibration error | s for 100 000 faces";

void add_row(Table& table, const std::string& name, const Score& s) {
    const double all = s.area.sum(), broken = s.area.row(1).sum(), called = s.area.col(1).sum(), right = s.area(1, 1);
    table.row("{} | {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {} | {}, {} | {:.3f} | {:.2f}", name, s.fragments,
              100 * broken / all, 100 * s.agreement(), 100 * s.alike / all, 100 * right / std::max(1e-300, broken),
              100 * right / std::max(1e-300, called), s.passed, s.whole, s.unclear, s.calibration.error(),
              s.seconds / s.faces * 1e5);
}

void write_model(const Path& file, const FacetModel& model, const std::string& recipe) {
    Json document;
    document.SetObject();
    auto& allocator = document.GetAllocator();
    add_members(document, allocator, "recipe", recipe, "features", facet_feature_names(), "context", facet_context_names(),
                "shift", std::round(1e4 * model.shift) / 1e4, "slope", std::round(1e4 * model.slope) / 1e4);
    document.AddMember("alone", model.alone.to_json(allocator), allocator);
    document.AddMember("trees", model.trees.to_json(allocator), allocator);
    write_file(file, to_compact_text(document) + "\n");
}

/// Writes pictures of the true classes, the probabilities and the predicted classes.
void pictures(const SeenFragment& fragment, const std::vector<double>& log_odds, const Path& folder) {
    const Mesh& mesh = fragment.given.mesh;
    const Facets facets = find_facets(mesh, fragment.evidence, log_odds);
    const auto write = [&](const std::string& kind, auto&& value) {
        std::vector<double> values;
        for (const Vertex v : mesh.vertices()) {
            double sum = 0, count = 1e-9;
            for (const Face f : mesh.faces_around_target(mesh.halfedge(v)))
                if (f != Mesh::null_face()) sum += value(f), ++count;
            values.push_back(sum / count);
        }
        write_coloured(folder / (fragment.given.object + "-" + fragment.given.name + "-" + kind + ".ply"), mesh, values, 1);
    };
    write("known", [&](Face f) { return !fragment.is_known(f) ? 0.5 : fragment.given.broken[f] ? 1.0 : 0.0; });
    write("likely", [&](Face f) { return facets.probability[f]; });
    write("found", [&](Face f) { return facets.of_face[f] == Facet::fracture ? 1.0 : 0.0; });
}

/// The synthetic objects and the meshes for training.
std::vector<std::string> training_sources(const FacetOptions& options) {
    std::vector<std::string> sources;
    const std::array<const char*, 10> names{"box",     "vase",   "cylinder", "hand",  "statuette",
                                            "capsule", "teapot", "sphere",   "chair", "torus"};
    for (int k = 1; k <= options.objects; ++k) {
        const std::string seed = ":" + std::to_string(options.seed * 1000 + static_cast<std::uint64_t>(k)),
                          made = std::string("made:") + names[static_cast<std::size_t>(k) % names.size()] + seed;
        sources.insert(sources.end(), {"pot" + seed, "stone" + seed, "thin" + seed, made});
        if (k % 3 < 2) sources.push_back((k % 3 == 0 ? "pot" : "stone") + seed + ":whole");
        sources.push_back(made + ":whole");
    }
    std::vector<std::string> files;
    for (const std::string& folder : options.meshes)
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
            if (entry.is_regular_file()) files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    for (std::size_t k = 0; k < files.size(); ++k) {
        sources.push_back("mesh:" + files[k] + ":" + std::to_string(options.seed * 1000 + k));
        if (k % 2 == 0) sources.push_back(sources.back() + ":whole");
    }
    sources.insert(sources.end(), options.scanned.begin(), options.scanned.end());
    return sources;
}

/// Smaller fragments carry too little information.
constexpr std::size_t min_faces = 100;

/// Max number of training fragments per synthetic object: variety of objects matters more than many fragments of one, but each
/// vessel sherd shows little fracture.
std::size_t max_learnt(const std::string& source) { return source.starts_with("pot:") || source.starts_with("thin:") ? 10 : 2; }

/// `few`: limits synthetic objects to the number of training fragments.
std::vector<SeenFragment> all_seen(const std::vector<std::string>& sources, std::size_t folds, bool few) {
    std::vector<SeenFragment> all;
    std::map<std::string, std::size_t> fold_of;  // all fragments of one object are in one fold
    for (const std::string& source : sources) {
        try {
            const std::size_t fold = fold_of.emplace(object_of_source(source), fold_of.size() % folds).first->second;
            std::size_t taken = 0;
            for (FacetCase& fragment : facet_cases(source)) {
                if (fragment.mesh.number_of_faces() < min_faces) continue;
                if (few && !fragment.scanned && taken == max_learnt(source)) continue;
                ++taken;
                all.push_back(seen_fragment(std::move(fragment)));
                all.back().fold = fold;
            }
        } catch (const std::exception& error) {
            // includes failures of the cut itself
            fmt::print(stderr, "{} is left out: {}\n", source, error.what());
        }
    }
    return all;
}

void by_object(const std::vector<SeenFragment>& all, const std::vector<Score>& scores, bool grouped) {
    fmt::print("\n");
    Table table(columns);
    std::map<std::string, double> known;  // objects of a group have equal weight, whatever their size and unit
    for (std::size_t k = 0; k < all.size(); ++k) known[all[k].given.object] += scores[k].area.sum();
    std::map<std::string, Score> groups;
    Score total;
    for (std::size_t k = 0; k < all.size(); ++k) {
        const std::string& object = all[k].given.object;
        std::string group = object;
        if (grouped && !all[k].given.scanned) {
            group = object.starts_with("mesh:") ? "mesh " + object_of_source(object) : object.substr(0, object.find_last_of(':'));
            if (object.ends_with(":whole")) group = "not broken";
        }
        for (Score* sum : {&groups[group], &total}) sum->add(scores[k], 1 / known[object]);
    }
    for (const auto& [name, sum] : groups) add_row(table, name, sum);
    add_row(table, "all", total);
    fmt::print("\n");
    Table calibration("probability | share of the area % | broken %");
    for (const auto& bin : total.calibration.bins.rowwise())
        calibration.row("{:.2f} | {:.1f} | {:.1f}", bin[1] / std::max(1e-300, bin[0]), 100 * bin[0] / total.area.sum(),
                        100 * bin[2] / std::max(1e-300, bin[0]));
}

FacetModel train(const FacetOptions& options) {
    constexpr std::size_t folds = 5;
    const Stopwatch watch;
    const std::vector<SeenFragment> all = all_seen(training_sources(options), folds, true);
    fmt::print("{} fragments in {:.0f} s\n", all.size(), watch.seconds().wall);
    // Calibrated and evaluated by trees trained without the object.
    const LearntFacets learnt = learn_facets(all, folds, options.boosting);
    std::vector<Score> scores;
    for (std::size_t k = 0; k < all.size(); ++k) scores.push_back(score(all[k], learnt.log_odds[k]));
    fmt::print("left out, calibrated by {:.3f} + {:.3f} x; {:.0f} s\n", learnt.model.shift, learnt.model.slope,
               watch.seconds().wall);
    by_object(all, scores, true);
    std::string recipe = fmt::format("ostraka_experiments facets --objects {} --seed {} --trees {} --depth {}", options.objects,
                                     options.seed, options.boosting.trees, options.boosting.depth);
    if (!options.meshes.empty()) recipe += fmt::format(" --meshes {}", fmt::join(options.meshes, ","));
    if (!options.scanned.empty()) recipe += fmt::format(" --scanned {}", fmt::join(options.scanned, ","));
    write_model(options.model, learnt.model, recipe + " --model FILE");
    return learnt.model;
}

/// Classifies fracture and intact surface, evaluated on held-out objects and on others.
void facets(const FacetOptions& options) {
    const FacetModel model = options.model.empty() ? facet_model() : train(options);
    if (options.judged.empty()) return;
    std::vector<Score> scores;
    std::optional<Table> table;
    if (options.each) table.emplace(columns);
    const std::vector<SeenFragment> all = all_seen(options.judged, 1, false);
    for (const SeenFragment& fragment : all) {
        const std::vector<double> log_odds = model.log_odds(fragment.evidence);
        scores.push_back(score(fragment, log_odds));
        if (!options.pictures.empty()) pictures(fragment, log_odds, options.pictures);
        if (table) add_row(*table, fragment.given.object + " " + fragment.given.name, scores.back());
    }
    by_object(all, scores, false);
}

const Registration registered("facets",
                              "breaks told from intact surface: the model made, judged on objects left out and on scans", facets);

}  // namespace

}  // namespace ostraka::experiments
