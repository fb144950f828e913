// Classification of fracture and intact surface: trains the model, and evaluates it on held-out objects and scanned fragments.
#include "facet_learning.h"
#include "harness.h"
#include "scenes.h"

#include "ostraka/files/json_build.h"
#include "ostraka/fracture/facets.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
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
    void list_options(OptionList& list) {
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

/// Areas by true and predicted class, and the calibration of probabilities.
struct Score {
    std::array<std::array<double, 2>, 2> area{};  ///< [truth][called]
    std::array<std::array<double, 3>, 10> bins{};
    double seconds = 0, faces = 0, alike = 0;  ///< alike: area classified correctly by its own probability alone
    std::size_t fragments = 0, unclear = 0, whole = 0, passed = 0;

    void add(const Score& other) {
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j) area[i][j] += other.area[i][j];
        for (std::size_t b = 0; b < bins.size(); ++b)
            for (std::size_t k = 0; k < 3; ++k) bins[b][k] += other.bins[b][k];
        seconds += other.seconds, faces += other.faces, alike += other.alike, fragments += other.fragments;
        unclear += other.unclear, whole += other.whole, passed += other.passed;
    }
    void scale(double by) {
        for (auto& row : area)
            for (double& one : row) one *= by;
        for (auto& bin : bins)
            for (double& one : bin) one *= by;
        alike *= by;
    }
    [[nodiscard]] double all() const { return area[0][0] + area[0][1] + area[1][0] + area[1][1]; }
    [[nodiscard]] double agreement() const { return (area[0][0] + area[1][1]) / all(); }
    [[nodiscard]] double recall() const { return area[1][1] / std::max(1e-300, area[1][0] + area[1][1]); }
    [[nodiscard]] double precision() const { return area[1][1] / std::max(1e-300, area[0][1] + area[1][1]); }
    [[nodiscard]] double calibration_error() const {
        double error = 0, all = 0;
        for (const auto& bin : bins) error += std::abs(bin[1] - bin[2]), all += bin[0];
        return error / all;
    }
};

/// Score of one fragment.
Score score(const SeenFragment& one, const std::vector<double>& log_odds) {
    Score result;
    const Stopwatch watch;
    const Facets found = find_facets(one.given.mesh, one.evidence, log_odds);
    result.seconds = one.seconds + watch.seconds().processor;
    const Mesh& mesh = one.given.mesh;
    for (const Face f : mesh.faces()) {
        if (!is_known(one.given, f)) continue;
        const double area = face_area(mesh, f), p = found.probability[f];
        result.alike += (p > 0.5) == one.given.broken[f] ? area : 0;
        result.area[one.given.broken[f] ? 1 : 0][found.of_face[f] == Facet::fracture ? 1 : 0] += area;
        auto& bin = result.bins[static_cast<std::size_t>(std::min(9.0, 10 * p))];
        bin[0] += area, bin[1] += area * p, bin[2] += one.given.broken[f] ? area : 0;
    }
    result.faces = static_cast<double>(mesh.number_of_faces());
    result.fragments = 1;
    result.unclear = found.answer == Facets::Answer::unclear ? 1 : 0;
    result.whole = found.answer == Facets::Answer::whole ? 1 : 0;
    result.passed = result.agreement() >= 0.9 ? 1 : 0;
    return result;
}

const std::string columns =
    "object | fragments | broken % | agreement % | alone % | recall % | precision % | agree by 90 % | called whole, unclear | "
    "calibration error | s for 100 000 faces";

void add_row(Table& table, const std::string& name, const Score& s) {
    table.row("{} | {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {} | {}, {} | {:.3f} | {:.2f}", name, s.fragments,
              100 * (s.area[1][0] + s.area[1][1]) / s.all(), 100 * s.agreement(), 100 * s.alike / s.all(), 100 * s.recall(),
              100 * s.precision(), s.passed, s.whole, s.unclear, s.calibration_error(), s.seconds / s.faces * 1e5);
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
void pictures(const SeenFragment& one, const std::vector<double>& log_odds, const Path& folder) {
    const Mesh& mesh = one.given.mesh;
    const Facets found = find_facets(mesh, one.evidence, log_odds);
    const auto write = [&](const std::string& what, auto&& value) {
        std::vector<double> values;
        for (const Vertex v : mesh.vertices()) {
            double sum = 0, count = 1e-9;
            for (const Face f : mesh.faces_around_target(mesh.halfedge(v)))
                if (f != Mesh::null_face()) sum += value(f), ++count;
            values.push_back(sum / count);
        }
        write_coloured(folder / (one.given.object + "-" + one.given.name + "-" + what + ".ply"), mesh, values, 1);
    };
    write("known", [&](Face f) { return !is_known(one.given, f) ? 0.5 : one.given.broken[f] ? 1.0 : 0.0; });
    write("likely", [&](Face f) { return found.probability[f]; });
    write("found", [&](Face f) { return found.of_face[f] == Facet::fracture ? 1.0 : 0.0; });
}

std::vector<std::string> own_sources(const FacetOptions& options) {
    std::vector<std::string> sources;
    const auto add = [&](const std::string& one) { sources.push_back(one); };
    const std::array<const char*, 10> names{"box",     "vase",   "cylinder", "hand",  "statuette",
                                            "capsule", "teapot", "sphere",   "chair", "torus"};
    for (int k = 1; k <= options.objects; ++k) {
        const std::string seed = ":" + std::to_string(options.seed * 1000 + static_cast<std::uint64_t>(k));
        const std::string name = names[static_cast<std::size_t>(k) % names.size()];
        for (const char* source : {"pot", "stone", "thin"}) add(source + seed);
        add("made:" + name + seed);
        if (k % 3 == 0) add("pot" + seed + ":whole");
        if (k % 3 == 1) add("stone" + seed + ":whole");
        add("made:" + name + seed + ":whole");
    }
    std::vector<std::string> files;
    for (const std::string& folder : options.meshes)
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
            if (entry.is_regular_file()) files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    for (std::size_t k = 0; k < files.size(); ++k) {
        const std::string source = "mesh:" + files[k] + ":" + std::to_string(options.seed * 1000 + k);
        add(source);
        if (k % 2 == 0) add(source + ":whole");
    }
    return sources;
}

/// Smaller fragments carry too little information.
constexpr std::size_t least_faces = 100;

/// Max number of training fragments per synthetic object: variety of objects matters more than many fragments of one, but each
/// vessel sherd shows little fracture.
std::size_t most_learnt(const std::string& source) { return source.starts_with("pot:") || source.starts_with("thin:") ? 10 : 2; }

/// `few`: limits synthetic objects to the number of training fragments.
std::vector<SeenFragment> all_seen(const std::vector<std::string>& sources, std::size_t folds, bool few) {
    std::vector<SeenFragment> all;
    std::map<std::string, std::size_t> fold_of;  // all fragments of one object are in one fold
    for (const std::string& source : sources) {
        try {
            const std::size_t fold = fold_of.emplace(object_of_source(source), fold_of.size() % folds).first->second;
            std::size_t taken = 0;
            for (FacetCase& one : facet_cases(source)) {
                if (one.mesh.number_of_faces() < least_faces || (few && !one.scanned && taken == most_learnt(source))) continue;
                ++taken;
                all.push_back(seen_fragment(std::move(one)));
                all.back().fold = fold;
            }
        } catch (const std::exception& error) {
            // includes failures of the cut itself
            std::cerr << source << " is left out: " << error.what() << '\n';
        }
    }
    return all;
}

void by_object(const std::vector<SeenFragment>& all, const std::vector<Score>& scores, bool grouped) {
    fmt::print("\n");
    Table table(columns);
    std::map<std::string, double> known;  // objects of a group have equal weight, whatever their size and unit
    for (std::size_t k = 0; k < all.size(); ++k) known[all[k].given.object] += scores[k].all();
    std::map<std::string, Score> groups;
    Score total;
    for (std::size_t k = 0; k < all.size(); ++k) {
        const std::string& object = all[k].given.object;
        std::string group = object;
        if (grouped && !all[k].given.scanned) {
            group = object.starts_with("mesh:") ? "mesh " + object_of_source(object) : object.substr(0, object.find_last_of(':'));
            if (object.ends_with(":whole")) group = "not broken";
        }
        Score share = scores[k];
        share.scale(1 / known[object]);
        groups[group].add(share);
        total.add(share);
    }
    for (const auto& [name, one] : groups) add_row(table, name, one);
    add_row(table, "all", total);
    fmt::print("\n");
    Table calibration("probability | share of the area % | broken %");
    for (const auto& [area, expected, broken] : total.bins)
        calibration.row("{:.2f} | {:.1f} | {:.1f}", expected / std::max(1e-300, area), 100 * area / total.all(),
                        100 * broken / std::max(1e-300, area));
}

FacetModel train(const FacetOptions& options) {
    constexpr std::size_t folds = 5;
    const Stopwatch watch;
    std::vector<std::string> sources = own_sources(options);
    sources.insert(sources.end(), options.scanned.begin(), options.scanned.end());
    const std::vector<SeenFragment> all = all_seen(sources, folds, true);
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
    std::vector<SeenFragment> all;
    std::vector<Score> scores;
    std::optional<Table> table;
    if (options.each) table.emplace(columns);
    for (const std::string& source : options.judged)
        for (SeenFragment& one : all_seen({source}, 1, false)) {
            const std::vector<double> log_odds = model.log_odds(one.evidence);
            scores.push_back(score(one, log_odds));
            if (!options.pictures.empty()) pictures(one, log_odds, options.pictures);
            if (table) add_row(*table, one.given.object + " " + one.given.name, scores.back());
            all.push_back(std::move(one));
        }
    by_object(all, scores, false);
}

const Registration registered("facets",
                              "breaks told from intact surface: the model made, judged on objects left out and on scans", facets);

}  // namespace

}  // namespace ostraka::experiments
