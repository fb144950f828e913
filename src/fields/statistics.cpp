#include "ostraka/fields/statistics.h"

#include "ostraka/core/error.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka {

namespace {

/// Values in ascending order with the sums of weights up to each.
struct Distribution {
    std::vector<double> values, sums;

    Distribution(const std::vector<double>& given, const std::vector<double>& weights, const std::string& where) {
        if (given.empty()) fail_input(where, "has no value here", "choose a region with values");
        if (weights.size() != given.size())
            fail_input(where,
                       "has " + std::to_string(given.size()) + " values and " + std::to_string(weights.size()) + " weights",
                       "give one weight a value");
        for (std::size_t i = 0; i < given.size(); ++i) {
            if (!std::isfinite(given[i]))
                fail_input(where, "value " + std::to_string(i) + " is not a finite number",
                           "mend the map or choose another region");
            if (!(weights[i] >= 0 && std::isfinite(weights[i])))
                fail_input(where, "weight " + std::to_string(i) + " is negative or not finite", "is a face broken?");
        }
        std::vector<std::size_t> order(given.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](auto i, auto j) { return given[i] < given[j]; });
        const bool none = std::all_of(weights.begin(), weights.end(), [](double w) { return w == 0; });
        double sum = 0;
        for (const std::size_t i : order) {
            const double weight = none ? 1 : weights[i];
            if (weight == 0) continue;
            values.push_back(given[i]);
            sums.push_back(sum += weight);
        }
    }

    [[nodiscard]] double at(double share) const {
        const double wanted = share * sums.back();
        const auto place = std::lower_bound(sums.begin(), sums.end(), wanted) - sums.begin();
        const auto i = std::min<std::size_t>(static_cast<std::size_t>(place), values.size() - 1);
        return sums[i] == wanted && i + 1 < values.size() ? (values[i] + values[i + 1]) / 2 : values[i];
    }
};

void check_map(const std::vector<double>& map, std::size_t count, const char* element, const std::string& where) {
    if (map.size() != count)
        fail_input(where, "has " + std::to_string(map.size()) + " values for " + std::to_string(count) + ' ' + element,
                   std::string("give one value for each of the ") + element);
}

void check_faces(const Mesh& mesh, const std::vector<Index>& faces) {
    if (faces.empty()) fail_usage("the region has no faces", "select some");
    for (const Index face : faces)
        if (face >= mesh.number_of_faces())
            fail_usage("face " + std::to_string(face) + " is not one of the " + std::to_string(mesh.number_of_faces()) + " faces",
                       "was it selected on another mesh?");
}

}  // namespace

Statistics statistics(const std::vector<double>& values, const std::vector<double>& weights, const std::string& where) {
    const Distribution sorted(values, weights, where);
    Statistics result;
    result.count = values.size();
    result.weight = sorted.sums.back();
    // About the median, so that nothing is lost where values are large and near each other.
    result.median = sorted.at(0.5);
    double sum = 0, square = 0, before = 0;
    for (std::size_t i = 0; i < sorted.values.size(); ++i) {
        const double weight = sorted.sums[i] - before, off = sorted.values[i] - result.median;
        before = sorted.sums[i];
        sum += weight * off;
        square += weight * off * off;
    }
    const double shift = sum / result.weight;
    result.mean = result.median + shift;
    result.deviation = std::sqrt(std::max(0.0, square / result.weight - shift * shift));
    result.integral = result.mean * result.weight;
    result.min = sorted.values.front();
    result.max = sorted.values.back();
    result.percentile_5 = sorted.at(0.05);
    result.percentile_25 = sorted.at(0.25);
    result.percentile_75 = sorted.at(0.75);
    result.percentile_95 = sorted.at(0.95);
    return result;
}

double quantile(const std::vector<double>& values, const std::vector<double>& weights, double share, const std::string& where) {
    if (!(share >= 0 && share <= 1)) fail_usage("a quantile at " + std::to_string(share), "use a share from 0 to 1");
    return Distribution(values, weights, where).at(share);
}

Statistics vertex_statistics(const Mesh& mesh, const std::vector<double>& map, const std::vector<Index>& faces,
                             const std::string& where) {
    check_map(map, mesh.number_of_vertices(), "vertices", where);
    check_faces(mesh, faces);
    std::vector<std::pair<Index, double>> shares;
    shares.reserve(3 * faces.size());
    for (const Index face : faces) {
        const double third = face_area(mesh, Face(face)) / 3;
        for (const Vertex v : corners(mesh, Face(face))) shares.emplace_back(v, third);
    }
    std::stable_sort(shares.begin(), shares.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<double> values, weights;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const Index vertex = shares[i].first;
        if (i > 0 && shares[i - 1].first == vertex) {
            weights.back() += shares[i].second;
            continue;
        }
        if (!std::isfinite(map[vertex]))
            fail_input(where, "the value of vertex " + std::to_string(vertex) + " is not a finite number",
                       "mend the map or choose another region");
        values.push_back(map[vertex]);
        weights.push_back(shares[i].second);
    }
    return statistics(values, weights, where);
}

Statistics face_statistics(const Mesh& mesh, const std::vector<double>& map, const std::vector<Index>& faces,
                           const std::string& where) {
    check_map(map, mesh.number_of_faces(), "faces", where);
    check_faces(mesh, faces);
    std::vector<double> values, weights;
    for (const Index face : faces) {
        if (!std::isfinite(map[face]))
            fail_input(where, "the value of face " + std::to_string(face) + " is not a finite number",
                       "mend the map or choose another region");
        values.push_back(map[face]);
        weights.push_back(face_area(mesh, Face(face)));
    }
    return statistics(values, weights, where);
}

}  // namespace ostraka
