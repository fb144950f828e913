#include "facet_learning.h"

#include "harness.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

namespace ostraka::experiments {

namespace {

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

FeatureTable sampled_rows(const SeenFragment& one, const FeatureTable& features) {
    FeatureTable rows;
    for (const std::size_t p : one.sampled) rows.add(features.row(p));
    return rows;
}

/// Parameters of the log odds shift + slope x that fit the truth best (Platt 1999).
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

}  // namespace

bool is_known(const FacetCase& one, Face f) { return one.known.empty() || one.known[f]; }

SeenFragment seen_fragment(FacetCase given) {
    SeenFragment result;
    const Stopwatch watch;
    result.evidence = facet_evidence(given.mesh);
    result.seconds = watch.seconds().processor;
    const FacetGraph& graph = result.evidence.graph;
    result.broken.assign(graph.count(), 0);
    for (const Face f : given.mesh.faces())
        if (given.broken[f]) result.broken[graph.patch_of_face[f]] += face_area(given.mesh, f);
    for (std::size_t p = 0; p < graph.count(); ++p) result.broken[p] /= graph.areas[p] > 0 ? graph.areas[p] : 1;
    std::vector<double> known(graph.count(), 0);
    for (const Face f : given.mesh.faces())
        if (is_known(given, f)) known[graph.patch_of_face[f]] += face_area(given.mesh, f);
    constexpr std::size_t samples = 600;
    double sum = 0;
    std::size_t k = 0;
    for (std::size_t p = 0; p < graph.count(); ++p)
        for (sum += graph.areas[p]; (static_cast<double>(k) + 0.5) * graph.area < samples * sum && k < samples; ++k)
            if (known[p] > 0.5 * graph.areas[p]) result.sampled.push_back(p);
    for (const std::size_t scale : {0, 2}) result.evidence.around[scale] = {};  // not needed for context, and large
    result.given = std::move(given);
    return result;
}

LearntFacets learn_facets(const std::vector<SeenFragment>& all, std::size_t folds, const BoostOptions& options) {
    LearntFacets result;
    const std::size_t n = all.size();
    Tables own(n);
    for (std::size_t k = 0; k < n; ++k) own[k] = sampled_rows(all[k], all[k].evidence.features);
    const auto told = [&](std::size_t k, const BoostedTrees& alone) {
        return with_context(all[k].evidence, log_odds_of(alone, all[k].evidence.features));
    };
    // alone[i][j]: trees trained without folds i and j; alone[i][i]: trees trained without fold i.
    std::vector<std::vector<BoostedTrees>> alone(folds, std::vector<BoostedTrees>(folds));
    for (std::size_t i = 0; i < folds; ++i)
        for (std::size_t j = 0; j <= i; ++j)
            alone[i][j] = alone[j][i] = learnt(
                all, own, [&](std::size_t k) { return all[k].fold != i && all[k].fold != j; }, options);
    // Context of the sampled patches, from trees trained without the fragment's fold and `left_out`.
    const auto tables = [&](std::size_t left_out) {
        Tables rows(n);
        for (std::size_t k = 0; k < n; ++k)
            if (all[k].fold != left_out)
                rows[k] = sampled_rows(all[k], told(k, alone[all[k].fold][left_out == folds ? all[k].fold : left_out]));
        return rows;
    };
    std::vector<double> odds;
    std::vector<bool> truth;
    result.log_odds.resize(n);
    for (std::size_t fold = 0; fold < folds; ++fold) {
        const BoostedTrees trees = learnt(
            all, tables(fold), [&](std::size_t k) { return all[k].fold != fold; }, options);
        for (std::size_t k = 0; k < n; ++k) {
            if (all[k].fold != fold) continue;
            result.log_odds[k] = log_odds_of(trees, told(k, alone[fold][fold]));
            for (const std::size_t p : all[k].sampled) {
                odds.push_back(result.log_odds[k][p]);
                truth.push_back(all[k].broken[p] > 0.5);
            }
        }
    }
    const auto everything = [](std::size_t) { return true; };
    result.model.alone = learnt(all, own, everything, options);
    result.model.trees = learnt(all, tables(folds), everything, options);
    std::tie(result.model.shift, result.model.slope) = calibrated(odds, truth);
    for (auto& list : result.log_odds)
        for (double& one : list) one = result.model.shift + result.model.slope * one;
    return result;
}

}  // namespace ostraka::experiments
