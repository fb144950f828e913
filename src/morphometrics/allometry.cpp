#include "ostraka/morphometrics/allometry.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

Landmarks configuration_of(const Eigen::RowVectorXd& row) {
    Landmarks x(row.size() / 3, 3);
    for (Eigen::Index k = 0; k < x.rows(); ++k) x.row(k) = row.segment<3>(3 * k);
    return x;
}

/// Subtracts the mean of each group from its rows.
template <class Matrix>
Matrix within_groups(const Matrix& rows, const std::vector<std::string>& groups) {
    std::map<std::string, std::pair<Eigen::RowVectorXd, double>> sums;
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        auto& [sum, count] = sums[groups[static_cast<std::size_t>(i)]];
        if (count == 0) sum = Eigen::RowVectorXd::Zero(rows.cols());
        sum += rows.row(i);
        count += 1;
    }
    Matrix result = rows;
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        const auto& [sum, count] = sums.at(groups[static_cast<std::size_t>(i)]);
        result.row(i) -= sum / count;
    }
    return result;
}

}  // namespace

Allometry allometry(const GeneralisedProcrustes& aligned, const std::vector<std::string>& groups) {
    const MatrixXd shapes = shape_rows(aligned.aligned);
    const Eigen::Index n = shapes.rows();
    if (n < 3) fail_input("allometry", fmt::format("there are {} specimens", n), "give at least three");
    if (!groups.empty() && groups.size() != static_cast<std::size_t>(n))
        fail_usage("allometry needs one group for each specimen");
    VectorXd sizes(n);
    for (Eigen::Index i = 0; i < n; ++i) sizes[i] = std::log(aligned.centroid_sizes[static_cast<std::size_t>(i)]);
    const std::vector<std::string> all(static_cast<std::size_t>(n));
    const MatrixXd deviations = within_groups(shapes, groups.empty() ? all : groups);
    const VectorXd x = within_groups(sizes, groups.empty() ? all : groups);
    if (!(x.squaredNorm() > 1e-20 * static_cast<double>(n)))
        fail_input("allometry", "all specimens have the same size", "give specimens of different sizes, with their scales");
    const Eigen::RowVectorXd slope = x.transpose() * deviations / x.squaredNorm();
    Allometry result;
    result.slope = configuration_of(slope);
    const double total = deviations.squaredNorm();
    result.share = total > 0 ? slope.squaredNorm() * x.squaredNorm() / total : 0;
    const Eigen::RowVectorXd mean = shapes.colwise().mean();
    const double length = slope.norm(), mean_size = sizes.mean();
    for (Eigen::Index i = 0; i < n; ++i) {
        const Eigen::RowVectorXd deviation = shapes.row(i) - mean;
        result.log_sizes.push_back(sizes[i]);
        result.scores.push_back(length > 0 ? deviation.dot(slope) / length : 0);
        result.predicted.push_back((sizes[i] - mean_size) * length);
        result.residuals.push_back(configuration_of(shapes.row(i) - (sizes[i] - mean_size) * slope));
    }
    result.smallest = configuration_of(mean + (sizes.minCoeff() - mean_size) * slope);
    result.largest = configuration_of(mean + (sizes.maxCoeff() - mean_size) * slope);
    return result;
}

}  // namespace ostraka
