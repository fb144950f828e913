#include "ostraka/collection/moulds.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/stats/summary.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

namespace ostraka {

PreparedHead prepare_head(const Mesh& mesh, const CompareOptions& options) {
    PreparedHead head{mesh_sift(mesh, options.features), AlignSurface(mesh, options.align.samples)};
    std::set<Index> points;
    for (const Feature& feature : head.features.features) points.insert(feature.vertex);
    if (points.size() < 3)
        fail_input("mesh", fmt::format("it has {} salient points, which are too few for a comparison", points.size()),
                   "check that it is a head, or reduce --first-scale, --contrast and --border");
    return head;
}

namespace {

/// Result of comparing two heads.
struct PairComparison {
    int matches_ab = 0, matches_ba = 0;        ///< MeshSIFT match counts in both directions
    int consistent_ab = 0, consistent_ba = 0;  ///< matches explained by a single motion
    double distance = 0;                       ///< registration distance
    double overlap = 0, scale = 1;             ///< from the registration; b is `scale` times as large as a
};
PairComparison compare_pair(const PreparedHead& a, const PreparedHead& b, const CompareOptions& options) {
    PairComparison result;
    result.matches_ab = static_cast<int>(match_features(a.features, b.features, options.matches).size());
    result.matches_ba = static_cast<int>(match_features(b.features, a.features, options.matches).size());
    MatchOptions loose = options.matches;
    loose.ratio = options.loose_ratio;
    const ConsistentMatches forward =
        consistent_matches(a.features, b.features, match_features(a.features, b.features, loose), options.consistent);
    const ConsistentMatches backward =
        consistent_matches(b.features, a.features, match_features(b.features, a.features, loose), options.consistent);
    result.consistent_ab = static_cast<int>(forward.matches.size());
    result.consistent_ba = static_cast<int>(backward.matches.size());
    // If few matches agree, their motion is unreliable: the principal axes are tried as well.
    std::vector<Motion> initial_motions{forward.motion, backward.motion.inverse()};
    constexpr int trusted = 12;
    if (std::max(result.consistent_ab, result.consistent_ba) < trusted)
        for (const Motion& start : principal_starts(a.surface, b.surface)) initial_motions.push_back(start);
    AlignOptions align_options = options.align;
    align_options.shrinkage = options.consistent.shrinkage;
    const Alignment alignment = align(a.surface, b.surface, initial_motions, align_options);
    result.distance = alignment.distance;
    result.overlap = alignment.overlap;
    result.scale = alignment.motion.scale;
    return result;
}

JsonValue to_json(const PairComparison& pair, JsonAllocator& allocator) {
    JsonValue row(rapidjson::kArrayType);
    for (const int count : {pair.matches_ab, pair.matches_ba, pair.consistent_ab, pair.consistent_ba})
        row.PushBack(JsonValue(count), allocator);
    for (const double value : {pair.distance, pair.overlap, pair.scale}) row.PushBack(JsonValue(value), allocator);
    return row;
}

bool from_json(const JsonValue& value, PairComparison& pair) {
    if (!value.IsArray() || value.Size() != 7) return false;
    for (rapidjson::SizeType i = 0; i < 7; ++i)
        if (i < 4 ? !value[i].IsInt() : !value[i].IsNumber()) return false;
    pair = {value[0].GetInt(),    value[1].GetInt(),    value[2].GetInt(),   value[3].GetInt(),
            value[4].GetDouble(), value[5].GetDouble(), value[6].GetDouble()};
    return true;
}

}  // namespace

MouldMatrices compare_heads(const std::vector<std::string>& names, const std::vector<PreparedHead>& heads,
                            const CompareOptions& options, const ResultStore& store, const std::vector<std::string>& checksums) {
    check_options(options, "moulds");
    const auto n = static_cast<Eigen::Index>(heads.size());
    MouldMatrices m;
    m.names = names;
    m.matches = m.consistent = m.registration = Eigen::MatrixXd::Zero(n, n);
    m.scale = Eigen::MatrixXd::Ones(n, n);
    Progress progress("comparing", heads.size() * (heads.size() + 1) / 2);
    const auto is_kept = !checksums.empty();
    for (std::size_t i = 0; i < heads.size(); ++i) {
        if (!store.share().has(i)) continue;
        std::string key;
        std::optional<Json> kept;
        if (is_kept) {
            std::vector<std::string> parts{"mould pairs", checksums[i]};
            for (const auto& [name, value] : declare_options(options)) parts.push_back(name + "=" + value);
            key = ResultStore::key(parts);
            kept = store.find(names[i], key);
        }
        std::vector<PairComparison> row(heads.size() - i);
        std::vector<std::size_t> missing;
        for (std::size_t k = 0; k < row.size(); ++k) {
            const JsonValue* known_comparison = kept ? find_member(*kept, checksums[i + k] + " " + names[i + k]) : nullptr;
            if (known_comparison == nullptr || !from_json(*known_comparison, row[k])) missing.push_back(k);
        }
        progress.advance(row.size() - missing.size());
        parallel_for(missing.size(), 1, [&](std::size_t w) {
            row[missing[w]] = compare_pair(heads[i], heads[i + missing[w]], options);
            progress.advance();
        });
        if (is_kept && !missing.empty()) {
            Json document;
            document.SetObject();
            for (std::size_t k = 0; k < row.size(); ++k)
                add_member(document, checksums[i + k] + " " + names[i + k], to_json(row[k], document.GetAllocator()),
                           document.GetAllocator());
            store.keep(names[i], key, document);
        }
        for (std::size_t k = 0; k < row.size(); ++k) {
            const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(i + k);
            m.matches(a, b) = row[k].matches_ab, m.matches(b, a) = row[k].matches_ba;
            m.consistent(a, b) = row[k].consistent_ab, m.consistent(b, a) = row[k].consistent_ba;
            if (k == 0) continue;
            m.registration(a, b) = m.registration(b, a) = row[k].distance;
            m.scale(a, b) = row[k].scale, m.scale(b, a) = 1 / row[k].scale;
        }
    }
    return m;
}

std::vector<std::string> mould_similarity_names() { return {"matches", "consistent", "registration", "combined"}; }

namespace {

Eigen::MatrixXd distances_from_counts(const Eigen::MatrixXd& counts) {
    Eigen::MatrixXd d = Eigen::MatrixXd::Zero(counts.rows(), counts.cols());
    for (Eigen::Index i = 0; i < d.rows(); ++i) {
        for (Eigen::Index j = 0; j < i; ++j) {
            const auto matched_fraction = [&](Eigen::Index source, Eigen::Index target) {
                return counts(source, source) > 0 ? std::min(counts(source, target) / counts(source, source), 1.0) : 0.0;
            };
            d(i, j) = d(j, i) = 1 - 0.5 * (matched_fraction(i, j) + matched_fraction(j, i));
        }
    }
    return d;
}

Eigen::MatrixXd distances_from_lengths(const Eigen::MatrixXd& lengths) {
    std::vector<double> pair_lengths;
    for (Eigen::Index i = 0; i < lengths.rows(); ++i)
        for (Eigen::Index j = 0; j < i; ++j) pair_lengths.push_back(lengths(i, j));
    Eigen::MatrixXd d = Eigen::MatrixXd::Zero(lengths.rows(), lengths.cols());
    if (pair_lengths.empty()) return d;
    const double median = upper_median(std::move(pair_lengths));
    for (Eigen::Index i = 0; i < d.rows(); ++i)
        for (Eigen::Index j = 0; j < d.cols(); ++j)
            if (i != j && lengths(i, j) > 0) d(i, j) = lengths(i, j) / (lengths(i, j) + median);
    return d;
}

}  // namespace

Eigen::MatrixXd mould_distances(const MouldMatrices& matrices, const std::string& similarity) {
    if (similarity == "matches") return distances_from_counts(matrices.matches);
    if (similarity == "consistent") return distances_from_counts(matrices.consistent);
    if (similarity == "registration") return distances_from_lengths(matrices.registration);
    if (similarity == "combined")
        return (distances_from_counts(matrices.consistent) + distances_from_lengths(matrices.registration)) / 2;
    fail_usage(fmt::format("there is no similarity '{}'", similarity), "use one of: matches, consistent, registration, combined");
}

void CompareOptions::declare_options(OptionList& list) {
    features.declare_options(list);
    matches.declare_options(list);
    list("loose-ratio", loose_ratio,
         "same as --ratio, but for the matches from which geometrically consistent matches are selected", Range{0, 1});
    consistent.declare_options(list);  // shrinkage holds for the registration as well
    list("trim", align.trim, "share of the point pairs, closest first, that a registration uses (trimming)", Range{0.1, 1});
    list("samples", align.samples, "number of points of each surface that are registered onto the other", Range{10, 1e6});
}

}  // namespace ostraka
