// Breaks told from intact surface: the model is made and judged on objects left out, and on scanned fragments.
#include "experiments.h"
#include "facet_cases.h"
#include "report.h"

#include "ostraka/core/error.h"
#include "ostraka/core/json_build.h"
#include "ostraka/fracture/facets.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <iostream>
#include <map>
#include <sstream>

namespace ostraka::experiments {

namespace {

/// A fragment with what it shows.
struct Seen {
    FacetCase given;
    FacetEvidence evidence;
    std::vector<double> broken;        ///< of each patch: share of its area
    std::vector<std::size_t> sampled;  ///< patches that the model learns from, drawn by area
    double seconds = 0;
    std::size_t fold = 0;
};

Seen seen(FacetCase given) {
    Seen result;
    const std::clock_t begin = std::clock();
    result.evidence = facet_evidence(given.mesh);
    result.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    const FacetGraph& graph = result.evidence.graph;
    result.broken.assign(graph.count(), 0);
    for (const Face f : given.mesh.faces())
        if (given.broken[f]) result.broken[graph.patch_of_face[f]] += face_area(given.mesh, f);
    for (std::size_t p = 0; p < graph.count(); ++p) result.broken[p] /= graph.areas[p] > 0 ? graph.areas[p] : 1;
    constexpr std::size_t samples = 1500;
    double sum = 0;
    std::size_t k = 0;
    for (std::size_t p = 0; p < graph.count(); ++p)
        for (sum += graph.areas[p]; (static_cast<double>(k) + 0.5) * graph.area < samples * sum && k < samples; ++k)
            result.sampled.push_back(p);
    result.given = std::move(given);
    return result;
}

struct Samples {
    FeatureTable table;
    std::vector<bool> truth;
    void add(const Seen& one) {
        for (const std::size_t p : one.sampled) {
            table.add(one.evidence.features.row(p));
            truth.push_back(one.broken[p] > 0.5);
        }
    }
};

/// Log odds shift + slope x that fit the truth best (Platt 1999).
std::pair<double, double> calibrated(const std::vector<double>& odds, const std::vector<bool>& truth) {
    double shift = 0, slope = 1;
    for (int step = 0; step < 50; ++step) {
        double a = 1e-6, b = 0, c = 1e-6, g = 0, h = 0;
        for (std::size_t k = 0; k < odds.size(); ++k) {
            const double p = 1 / (1 + std::exp(-(shift + slope * odds[k]))), w = p * (1 - p), off = (truth[k] ? 1 : 0) - p;
            a += w, b += w * odds[k], c += w * odds[k] * odds[k];
            g += off, h += off * odds[k];
        }
        const double det = a * c - b * b;
        shift += (c * g - b * h) / det;
        slope += (a * h - b * g) / det;
    }
    return {shift, slope};
}

/// Areas by what they are and what they are called, and how probabilities fare.
struct Score {
    std::array<std::array<double, 2>, 2> area{};  ///< [truth][called]
    std::array<std::array<double, 3>, 10> bins{};
    double seconds = 0, faces = 0;
    std::size_t fragments = 0, unclear = 0, whole = 0, passed = 0;

    void add(const Score& other) {
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j) area[i][j] += other.area[i][j];
        for (std::size_t b = 0; b < bins.size(); ++b)
            for (std::size_t k = 0; k < 3; ++k) bins[b][k] += other.bins[b][k];
        seconds += other.seconds, faces += other.faces, fragments += other.fragments;
        unclear += other.unclear, whole += other.whole, passed += other.passed;
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

/// Of one fragment; areas as shares of its own.
Score score(const Seen& one, const FacetModel& model) {
    Score result;
    const std::clock_t begin = std::clock();
    const Facets found = find_facets(one.given.mesh, one.evidence, model.log_odds(one.evidence.features));
    result.seconds = one.seconds + static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    const Mesh& mesh = one.given.mesh;
    for (const Face f : mesh.faces()) {
        const double area = face_area(mesh, f) / one.evidence.graph.area, p = found.probability[f];
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

void print(const std::string& name, const Score& s) {
    std::cout << format("| %s | %zu | %.1f | %.1f | %.1f | %.1f | %zu | %zu, %zu | %.3f | %.2f |\n", name.c_str(), s.fragments,
                        100 * (s.area[1][0] + s.area[1][1]) / s.all(), 100 * s.agreement(), 100 * s.recall(), 100 * s.precision(),
                        s.passed, s.whole, s.unclear, s.calibration_error(), s.seconds / s.faces * 1e5)
              << std::flush;
}

void print_head() {
    std::cout
        << "\n| object | fragments | broken % | agreement % | recall % | precision % | agree by 90 % | called whole, unclear "
           "| calibration error | s for 100 000 faces |\n|---|---|---|---|---|---|---|---|---|---|\n";
}

void write_model(const Path& file, const FacetModel& model, const std::string& recipe) {
    Json document;
    document.SetObject();
    auto& allocator = document.GetAllocator();
    add_members(document, allocator, "recipe", recipe, "features", FacetEvidence::names(), "shift",
                std::round(1e4 * model.shift) / 1e4, "slope", std::round(1e4 * model.slope) / 1e4);
    JsonValue trees = model.trees.to_json(allocator);
    for (auto& member : trees.GetObject()) document.AddMember(member.name, member.value, allocator);
    write_file(file, to_compact_text(document) + "\n");
}

std::vector<std::string> own_sources(const FacetExperiment& options) {
    std::vector<std::string> sources;
    const auto add = [&](const std::string& one) { sources.push_back(one); };
    for (int k = 1; k <= options.objects; ++k) {
        const std::string seed = std::to_string(options.seed * 1000 + static_cast<std::uint64_t>(k));
        add("pot:" + seed);
        add("stone:" + seed);
        if (k % 3 == 0) add("pot:" + seed + ":whole");
        if (k % 3 == 1) add("stone:" + seed + ":whole");
        if (k <= (options.objects + 1) / 2)
            for (const char* name : {"hand", "statuette", "teapot", "vase", "box", "cylinder"})
                if ((static_cast<std::size_t>(k) + std::string(name).size()) % 3 == 0)
                    add(std::string("made:") + name + ":" + seed);
    }
    return sources;
}

std::vector<Seen> all_seen(const std::vector<std::string>& sources, std::size_t folds) {
    std::vector<Seen> all;
    for (std::size_t k = 0; k < sources.size(); ++k) {
        try {
            for (FacetCase& one : facet_cases(sources[k])) {
                all.push_back(seen(std::move(one)));
                all.back().fold = k % folds;
            }
        } catch (const Error& error) {
            std::cerr << sources[k] << " is left out: " << error.what() << '\n';
        }
    }
    return all;
}

void by_object(const std::vector<Seen>& all, const std::vector<Score>& scores, bool grouped) {
    print_head();
    std::map<std::string, Score> groups;
    Score total;
    for (std::size_t k = 0; k < all.size(); ++k) {
        const std::string& object = all[k].given.object;
        std::string group = grouped ? object.substr(0, object.find_last_of(':')) : object;
        if (grouped && object.ends_with(":whole")) group = "not broken";
        groups[group].add(scores[k]);
        total.add(scores[k]);
    }
    for (const auto& [name, one] : groups) print(name, one);
    print("all", total);
}

}  // namespace

void facets(const FacetExperiment& options) {
    FacetModel model;
    if (options.model.empty()) {
        model = facet_model();
    } else {
        constexpr std::size_t folds = 4;
        const Stopwatch watch;
        const std::vector<Seen> all = all_seen(own_sources(options), folds);
        std::cout << format("%zu fragments in %.0f s\n", all.size(), watch.seconds().wall) << std::flush;
        std::vector<double> odds;
        std::vector<bool> truth;
        std::vector<Score> scores(all.size());
        for (int round = 0; round < 2; ++round) {
            // The first round calibrates, the second judges with that.
            static std::vector<FacetModel> left_out(folds);
            for (std::size_t fold = 0; fold < folds; ++fold) {
                if (round == 0) {
                    Samples samples;
                    for (const Seen& one : all)
                        if (one.fold != fold) samples.add(one);
                    left_out[fold].trees = boost(samples.table, samples.truth, {}, options.boosting);
                }
                for (std::size_t k = 0; k < all.size(); ++k) {
                    if (all[k].fold != fold) continue;
                    if (round == 1) {
                        left_out[fold].shift = model.shift, left_out[fold].slope = model.slope;
                        scores[k] = score(all[k], left_out[fold]);
                        continue;
                    }
                    for (const std::size_t p : all[k].sampled) {
                        odds.push_back(left_out[fold].trees.log_odds(all[k].evidence.features.row(p)));
                        truth.push_back(all[k].broken[p] > 0.5);
                    }
                }
            }
            if (round == 0) std::tie(model.shift, model.slope) = calibrated(odds, truth);
        }
        std::cout << format("left out, calibrated by %.3f + %.3f x; %.0f s\n", model.shift, model.slope, watch.seconds().wall);
        by_object(all, scores, true);
        Samples samples;
        for (const Seen& one : all) samples.add(one);
        model.trees = boost(samples.table, samples.truth, {}, options.boosting);
        write_model(
            options.model, model,
            format("ostraka_experiments facets --objects %d --seed %llu --trees %d --depth %d --model FILE", options.objects,
                   static_cast<unsigned long long>(options.seed), options.boosting.trees, options.boosting.depth));
    }
    if (options.judged.empty()) return;
    std::vector<Seen> all;
    std::vector<Score> scores;
    for (const std::string& source : options.judged)
        for (Seen& one : all_seen({source}, 1)) {
            scores.push_back(score(one, model));
            if (options.each) print(one.given.object + " " + one.given.name, scores.back());
            all.push_back(std::move(one));
        }
    by_object(all, scores, false);
}

}  // namespace ostraka::experiments
