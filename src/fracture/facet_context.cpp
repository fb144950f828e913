// Context features: the classification of a patch's surroundings, since a fracture is recognised by contrast with intact
// surface.
#include "fracture/facet_columns.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka {

namespace {

class Context {
public:
    Context(const FacetEvidence& evidence, const std::vector<double>& log_odds)
        : evidence_(evidence), graph_(evidence.graph), columns_(graph_.count()), odds_(log_odds) {
        for (const double odds : log_odds) likely_.push_back(1 / (1 + std::exp(-std::clamp(odds, -20.0, 20.0))));
    }

    FeatureColumns run() {
        const std::size_t n = graph_.count();
        const std::vector<double> rank = area_ranks(odds_, graph_.areas);
        columns_.add("log odds", [&](std::size_t p) { return odds_[p]; });
        columns_.add("rank of log odds", [&](std::size_t p) { return rank[p]; });
        for (const std::size_t s : {std::size_t{0}, std::size_t{2}}) {
            const std::vector<double> mean = neighbourhood_means(evidence_, s + 1, likely_);
            columns_.add("likely about, at " + std::to_string(s + 1), [&](std::size_t p) { return mean[p]; });
        }
        const double mean = std::inner_product(likely_.begin(), likely_.end(), graph_.areas.begin(), 0.0) / graph_.area;
        const double low = area_quantile(likely_, graph_.areas, 0.1), high = area_quantile(likely_, graph_.areas, 0.9);
        columns_.add("likely in the fragment", [&](std::size_t) { return mean; });
        columns_.add("least likely in the fragment", [&](std::size_t) { return low; });
        columns_.add("most likely in the fragment", [&](std::size_t) { return high; });
        std::vector<double> behind(n, -1);
        for (std::size_t p = 0; p < n; ++p)
            if (evidence_.walls.behind[p] != no_index) behind[p] = likely_[evidence_.walls.behind[p]];
        const std::vector<double> behind_about = neighbourhood_means(evidence_, 1, behind);
        columns_.add("likely behind", [&](std::size_t p) { return behind_about[p]; });
        parts("part", evidence_.parts[0]);
        parts("small part", evidence_.parts[1]);
        return std::move(columns_);
    }

private:
    void parts(const std::string& name, const std::vector<std::size_t>& part) {
        struct Part {
            double area = 0, likely = 0, spread = 0, length = 0, across = 0, rim = 0;
        };
        std::size_t count = 0;
        for (const std::size_t p : part) count = std::max(count, p + 1);
        std::vector<Part> summaries(count);
        for (std::size_t p = 0; p < part.size(); ++p) {
            Part& summary = summaries[part[p]];
            summary.area += graph_.areas[p];
            summary.likely += graph_.areas[p] * likely_[p];
            summary.spread += graph_.areas[p] * likely_[p] * likely_[p];
        }
        for (Part& summary : summaries) {
            const double area = summary.area > 0 ? summary.area : 1;
            summary.likely /= area;
            summary.spread = std::sqrt(std::max(0.0, summary.spread / area - summary.likely * summary.likely));
        }
        for (const auto& c : graph_.contacts) {
            if (part[c.a] == part[c.b]) continue;
            for (const auto& [inner, outer] : {std::pair(c.a, c.b), std::pair(c.b, c.a)}) {
                Part& summary = summaries[part[inner]];
                summary.length += c.length;
                summary.rim += c.length * likely_[inner];
                summary.across += c.length * summaries[part[outer]].likely;
            }
        }
        std::vector<double> likely, areas;
        for (const Part& summary : summaries) {
            likely.push_back(summary.likely);
            areas.push_back(summary.area);
        }
        const std::vector<double> rank = area_ranks(likely, areas);
        const double low = area_quantile(likely, areas, 0.05), high = area_quantile(likely, areas, 0.95);
        const auto add = [&](const std::string& feature, auto&& value) {
            columns_.add(name + ": " + feature, [&](std::size_t p) { return value(summaries[part[p]]); });
        };
        add("likely", [](const Part& summary) { return summary.likely; });
        columns_.add(name + ": rank of likely", [&](std::size_t p) { return rank[part[p]]; });
        add("over the least likely", [&](const Part& summary) { return summary.likely - low; });
        add("under the most likely", [&](const Part& summary) { return high - summary.likely; });
        add("spread of likely", [](const Part& summary) { return summary.spread; });
        add("likely across its boundary",
            [](const Part& summary) { return summary.length > 0 ? summary.across / summary.length : -1; });
        add("likely at its boundary", [](const Part& summary) { return summary.length > 0 ? summary.rim / summary.length : -1; });
    }

    const FacetEvidence& evidence_;
    const FacetGraph& graph_;
    FeatureColumns columns_;
    const std::vector<double>& odds_;
    std::vector<double> likely_;  ///< per patch, from its own features
};

}  // namespace

FeatureColumns context_columns(const FacetEvidence& evidence, const std::vector<double>& log_odds) {
    return Context(evidence, log_odds).run();
}

FeatureTable with_context(const FacetEvidence& evidence, const std::vector<double>& log_odds) {
    const FeatureTable context = context_columns(evidence, log_odds).table();
    FeatureTable result;
    result.columns = evidence.features.columns + context.columns;
    result.values.reserve(context.rows() * result.columns);
    for (std::size_t r = 0; r < context.rows(); ++r) {
        const auto own_features = evidence.features.row(r), context_features = context.row(r);
        result.values.insert(result.values.end(), own_features.begin(), own_features.end());
        result.values.insert(result.values.end(), context_features.begin(), context_features.end());
    }
    return result;
}

}  // namespace ostraka
