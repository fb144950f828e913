#include "ostraka/shape_classes/shape_modes.h"
#include "ostraka/algebra/dense.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace ostraka {

using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

namespace {

constexpr double rounding = 1e-10;  ///< eigenvalues below this fraction of the largest are rounding errors

RowVectorXd row_of(const Landmarks& shape) {
    RowVectorXd row(3 * shape.rows());
    for (Eigen::Index i = 0; i < shape.rows(); ++i) row.segment<3>(3 * i) = shape.row(i);
    return row;
}

Landmarks shape_from(const RowVectorXd& row) {
    Landmarks shape(row.size() / 3, 3);
    for (Eigen::Index i = 0; i < shape.rows(); ++i) shape.row(i) = row.segment<3>(3 * i);
    return shape;
}

/// Squared distance of member i from the mean of the others, and its part outside their span, from the inner products.
std::pair<double, double> left_out(const MatrixXd& inner, Eigen::Index i) {
    const Eigen::Index n = inner.rows(), m = n - 1;
    // Columns of A are members in terms of all members: the others minus their mean, and member i minus that mean.
    MatrixXd other_members = MatrixXd::Zero(n, m);
    VectorXd tested_member = VectorXd::Zero(n);
    for (Eigen::Index k = 0, column = 0; k < n; ++k) {
        if (k == i) continue;
        tested_member[k] = -1.0 / static_cast<double>(m);
        for (Eigen::Index j = 0; j < m; ++j) other_members(k, j) = -1.0 / static_cast<double>(m);
        other_members(k, column++) += 1;
    }
    tested_member[i] = 1;
    const double squared_distance = std::max(0.0, tested_member.dot(inner * tested_member));
    const MatrixXd gram = other_members.transpose() * inner * other_members;
    const VectorXd projections = other_members.transpose() * (inner * tested_member);
    const SymmetricEigenX eigen(gram);
    double within = 0;
    const double largest = std::max(0.0, eigen.eigenvalues()[m - 1]);
    for (Eigen::Index k = 0; k < m; ++k) {
        if (eigen.eigenvalues()[k] <= rounding * std::max(largest, inner.trace())) continue;
        const double part = eigen.eigenvectors().col(k).dot(projections);
        within += part * part / eigen.eigenvalues()[k];
    }
    return {squared_distance, std::max(0.0, squared_distance - within)};
}

}  // namespace

ShapeModes learn_modes(const std::vector<Landmarks>& members, const Landmarks& frame, const ModeOptions& options) {
    check_options(options, "modes");
    if (members.empty()) fail_input("class", "has no member", "give at least one member");
    ProcrustesOptions options_used;
    options_used.scaling = !options.sizes;
    options_used.planar = are_planar(members) && are_planar({frame});
    const GeneralisedProcrustes aligned = generalised_procrustes(members, options_used);
    ShapeModes result;
    result.sizes = options.sizes;
    result.centroid_sizes = aligned.centroid_sizes;
    const auto n = static_cast<Eigen::Index>(members.size());
    for (const double size : aligned.centroid_sizes) result.mean_size += size / static_cast<double>(n);
    const double unit = options.sizes ? 1 : result.mean_size;
    MatrixXd rows = unit * shape_rows(aligned.aligned);
    RowVectorXd mean = rows.colwise().mean();
    ProcrustesOptions turn_only;
    turn_only.planar = options_used.planar;
    const Eigen::Matrix3d rotation = procrustes(shape_from(mean), frame, turn_only).rotation;
    const auto rotated = [&](const RowVectorXd& row) { return row_of(shape_from(row) * rotation.transpose()); };
    for (Eigen::Index i = 0; i < n; ++i) rows.row(i) = rotated(rows.row(i));
    mean = rotated(mean);
    result.mean = shape_from(mean);
    const MatrixXd centred = rows.rowwise() - mean;
    const MatrixXd inner = centred * centred.transpose();

    for (Eigen::Index i = 0; i < n; ++i) result.distances.push_back(std::sqrt(inner(i, i)) / result.mean_size);
    result.archetype =
        static_cast<std::size_t>(std::min_element(result.distances.begin(), result.distances.end()) - result.distances.begin());
    if (n > 1)
        for (Eigen::Index i = 0; i < n; ++i) {
            const auto [squared_distance, outside] = left_out(inner, i);
            result.left_out_distances.push_back(std::sqrt(squared_distance) / result.mean_size);
            result.left_out_outside.push_back(std::sqrt(outside) / result.mean_size);
        }

    const SymmetricEigenX eigen(inner);
    std::vector<Eigen::Index> kept;
    const double floor = 1e-20 * result.mean_size * result.mean_size;
    for (Eigen::Index k = n - 1; k >= 0; --k)
        if (eigen.eigenvalues()[k] > std::max(floor, rounding * eigen.eigenvalues()[n - 1])) kept.push_back(k);
    for (const Eigen::Index k : kept) result.total += eigen.eigenvalues()[k] / static_cast<double>(n - 1);
    double sum = 0;
    std::size_t count = 0;
    while (count < kept.size() && count < static_cast<std::size_t>(options.maximum) && sum < options.variance * result.total)
        sum += eigen.eigenvalues()[kept[count++]] / static_cast<double>(n - 1);
    result.modes.resize(static_cast<Eigen::Index>(count), mean.size());
    result.coefficients.resize(n, static_cast<Eigen::Index>(count));
    for (std::size_t k = 0; k < count; ++k) {
        const double value = eigen.eigenvalues()[kept[k]];
        result.variances.push_back(value / static_cast<double>(n - 1));
        RowVectorXd mode = eigen.eigenvectors().col(kept[k]).transpose() * centred / std::sqrt(value);
        // The sign of an eigenvector is arbitrary: its largest entry is made positive.
        Eigen::Index at = 0;
        mode.cwiseAbs().maxCoeff(&at);
        if (mode[at] < 0) mode = -mode;
        result.modes.row(static_cast<Eigen::Index>(k)) = mode;
        result.coefficients.col(static_cast<Eigen::Index>(k)) = centred * mode.transpose();
    }
    return result;
}

ShapeCoordinates coordinates_in(const ShapeModes& modes, const Landmarks& shape) {
    if (shape.rows() != modes.mean.rows())
        fail_usage(fmt::format("the shape has {} vertices, but the class {}", shape.rows(), modes.mean.rows()),
                   "fit the template to it");
    ShapeCoordinates result;
    result.centroid_size = centroid_size(shape);
    Landmarks sized = shape;
    double scale = 1;
    if (!modes.sizes) {
        if (!(result.centroid_size > 0)) fail_input("shape", "all its vertices coincide", "check that it is the right file");
        scale = modes.mean_size / result.centroid_size;
        sized *= scale;
    }
    ProcrustesOptions options;
    options.planar = are_planar({shape, modes.mean});
    result.map = procrustes(sized, modes.mean, options);
    const RowVectorXd deviation = row_of(result.map.apply(sized)) - row_of(modes.mean);
    result.map.scale *= scale;
    RowVectorXd unexplained = deviation;
    for (Eigen::Index k = 0; k < modes.modes.rows(); ++k) {
        const double b = modes.modes.row(k).dot(deviation);
        result.coefficients.push_back(b);
        unexplained -= b * modes.modes.row(k);
        const double variance = modes.variances[static_cast<std::size_t>(k)];
        if (variance > 0) result.mahalanobis += b * b / variance;
    }
    result.mahalanobis = std::sqrt(result.mahalanobis);
    result.distance = deviation.norm() / modes.mean_size;
    result.outside = unexplained.norm() / modes.mean_size;
    return result;
}

Landmarks shape_of(const ShapeModes& modes, const std::vector<double>& coefficients) {
    if (coefficients.size() > static_cast<std::size_t>(modes.modes.rows()))
        fail_usage(fmt::format("there are {} coefficients for {} modes", coefficients.size(), modes.modes.rows()),
                   "give at most one per mode");
    RowVectorXd row = row_of(modes.mean);
    for (std::size_t k = 0; k < coefficients.size(); ++k) row += coefficients[k] * modes.modes.row(static_cast<Eigen::Index>(k));
    return shape_from(row);
}

void ModeOptions::declare_options(OptionList& list) {
    list("sizes", sizes, "compare sizes as well as shapes; by default all objects are first scaled to one size", Anything{});
    list("modes", maximum, "maximum number of modes of variation", Range{0, 1e6});
    list("variance", variance, "share of the variance of the members that the kept modes explain", Range{0, 1});
}

}  // namespace ostraka
