#include "ostraka/coords/influence.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace ostraka {

std::vector<double> influence_on(const Coordinates& coordinates, const std::vector<Index>& points, InfluenceMeasure by) {
    if (points.empty()) fail_input("points", "none are selected", "select at least one point");
    const bool sum = by == InfluenceMeasure::sum;
    const WeightMatrix& W = coordinates.vertex;
    std::vector<double> result(static_cast<std::size_t>(W.cols()), sum ? 0 : -INFINITY);
    for (const Index i : points) {
        if (static_cast<Eigen::Index>(i) >= W.rows())
            fail_usage(fmt::format("there is no point {} among the {} points with coordinates", i, W.rows()),
                       "give points with coordinates");
        const double* row = W.row(i).data();
        for (std::size_t j = 0; j < result.size(); ++j) result[j] = sum ? result[j] + row[j] : std::max(result[j], row[j]);
    }
    return result;
}

std::vector<double> influence_of(const Coordinates& coordinates, Index cage_vertex) {
    const WeightMatrix& W = coordinates.vertex;
    if (static_cast<Eigen::Index>(cage_vertex) >= W.cols())
        fail_usage("there is no cage vertex " + std::to_string(cage_vertex),
                   fmt::format("choose one of the {} vertices of the cage, counted from 0", W.cols()));
    std::vector<double> result;
    for (Eigen::Index i = 0; i < W.rows(); ++i) result.push_back(W(i, cage_vertex));
    return result;
}

std::vector<Index> dominant_weight_counts(const WeightMatrix& weights, double share) {
    std::vector<Index> counts(static_cast<std::size_t>(weights.rows()));
    parallel_blocks(counts.size(), 256, [&](std::size_t begin, std::size_t end) {
        std::vector<double> row(static_cast<std::size_t>(weights.cols()));
        for (std::size_t i = begin; i < end; ++i) {
            const double* weight = weights.row(static_cast<Eigen::Index>(i)).data();
            double sum = 0, carried = 0;
            for (std::size_t j = 0; j < row.size(); ++j) sum += row[j] = std::fabs(weight[j]);
            std::sort(row.begin(), row.end(), std::greater<>());
            Index count = 0;
            while (count < row.size() && carried < share * sum) carried += row[count++];
            counts[i] = count;
        }
    });
    return counts;
}

}  // namespace ostraka
