// Total least squares line from the eigenvectors of the covariance.
#include "ostraka/geom/line.h"
#include "ostraka/algebra/dense.h"

namespace ostraka {

using Eigen::Matrix3d;
using Eigen::Vector3d;

LineFit fit_line(const std::vector<Vector3d>& points, const std::vector<double>& weights) {
    Vector3d mean = Vector3d::Zero();
    double total = 0;
    for (std::size_t i = 0; i < points.size(); ++i) mean += weights[i] * points[i], total += weights[i];
    mean /= total;
    Matrix3d covariance = Matrix3d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i)
        covariance += weights[i] / total * (points[i] - mean) * (points[i] - mean).transpose();
    const SymmetricEigen3 solver(covariance);
    const Vector3d& values = solver.eigenvalues();
    return {mean, solver.eigenvectors().col(2), std::sqrt(std::max(0.0, values[0]) + std::max(0.0, values[1]))};
}

}  // namespace ostraka
