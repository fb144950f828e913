// What the surroundings of a patch are likely to be.
#include "facet_columns.h"
#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"

namespace ostraka {

namespace {

/// Of each patch the mean over its part.
std::vector<double> part_means(const FacetGraph& graph, const std::vector<std::size_t>& part, const std::vector<double>& values) {
    const std::size_t count = part.empty() ? 0 : 1 + *std::max_element(part.begin(), part.end());
    std::vector<double> sum(count, 0), area(count, 0), result(part.size(), 0);
    for (std::size_t p = 0; p < part.size(); ++p) {
        sum[part[p]] += graph.areas[p] * values[p];
        area[part[p]] += graph.areas[p];
    }
    for (std::size_t p = 0; p < part.size(); ++p)
        if (area[part[p]] > 0) result[p] = sum[part[p]] / area[part[p]];
    return result;
}

/// Means over the samples about each patch that face elsewhere than a patch, but not the other way; -1 where there is none.
std::vector<double> mean_aside(const FacetEvidence& evidence, std::size_t scale, const std::vector<double>& values) {
    const FacetGraph& graph = evidence.graph;
    const Neighbourhoods& around = evidence.around[scale];
    std::vector<double> result(values.size(), -1);
    parallel_for(
        values.size(),
        [&](std::size_t p) {
            double sum = 0, count = 0;
            for (std::size_t k = around.first[p]; k < around.first[p + 1]; ++k) {
                const Index q = evidence.samples.patch[around.samples[k]];
                if (std::abs(graph.normals[q] * graph.normals[p]) >= 0.5) continue;
                sum += values[q];
                ++count;
            }
            if (count > 0) result[p] = sum / count;
        },
        64);
    return result;
}

}  // namespace

FeatureTable with_surroundings(const FacetEvidence& evidence, const std::vector<double>& log_odds) {
    const FacetGraph& graph = evidence.graph;
    const std::size_t n = graph.count();
    if (log_odds.size() != n) fail_usage("there are not as many log odds as patches", "take them from the same evidence");
    std::vector<double> likely(n);
    double all = 0;
    for (std::size_t p = 0; p < n; ++p) {
        likely[p] = 1 / (1 + std::exp(-log_odds[p]));
        all += graph.areas[p] / graph.area * likely[p];
    }
    FeatureColumns columns(n);
    const auto add = [&](const std::string& name, const std::vector<double>& values) {
        columns.add(name, [&](std::size_t p) { return values[p]; });
    };
    add("likely", log_odds);
    columns.add("likely anywhere", [&](std::size_t) { return all; });
    for (std::size_t s = 0; s < scale_count; ++s) add("likely at " + std::to_string(s), mean_about(evidence, s, likely));
    for (const std::size_t s : {std::size_t{1}, std::size_t{2}}) add("likely aside", mean_aside(evidence, s, likely));
    for (const auto& part : evidence.parts) add("likely in the part", part_means(graph, part, likely));
    columns.add("likely behind", [&](std::size_t p) {
        const Index behind = evidence.walls.behind[p];
        return behind == no_index ? -1 : likely[behind];
    });
    const FeatureTable around = columns.table();
    FeatureTable result;
    for (std::size_t p = 0; p < n; ++p) {
        std::vector<float> row(evidence.features.row(p).begin(), evidence.features.row(p).end());
        row.insert(row.end(), around.row(p).begin(), around.row(p).end());
        result.add(row);
    }
    return result;
}

}  // namespace ostraka
