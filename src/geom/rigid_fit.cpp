#include "ostraka/geom/rigid_fit.h"
#include "ostraka/algebra/dense.h"

#include "ostraka/core/error.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace ostraka {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Motion Motion::inverse() const {
    Motion back;
    back.rotation = rotation.transpose();
    back.scale = 1 / scale;
    back.translation = -back.scale * (back.rotation * translation);
    return back;
}

Motion Motion::after(const Motion& other) const {
    return {rotation * other.rotation, scale * (rotation * other.translation) + translation, scale * other.scale};
}

Vector3d PreciseMotion::operator()(const Vector3d& p) const {
    Vector3d result;
    for (int row = 0; row < 3; ++row) {
        // Error-free transformations of products and sums (Ogita, Rump and Oishi 2005, algorithm Dot2).
        double sum = translation_[row], rest = 0;
        for (int k = 0; k < 3; ++k) {
            const double product = matrix_(row, k) * p[k], total = sum + product, part = total - sum;
            rest += std::fma(matrix_(row, k), p[k], -product) + ((sum - (total - part)) + (product - part));
            sum = total;
        }
        result[row] = sum + rest;
    }
    return result;
}

Motion fit_motion(const std::vector<Vector3d>& from, const std::vector<Vector3d>& to, const std::vector<double>& weights,
                  const FitOptions& options) {
    if (from.empty() || from.size() != to.size() || (!weights.empty() && weights.size() != from.size())) {
        fail_usage(std::to_string(from.size()) + " points are to be carried onto " + std::to_string(to.size()),
                   "give as many of the one as of the other, at least one, and a weight for each or none");
    }
    const auto weight = [&](std::size_t i) { return weights.empty() ? 1.0 : weights[i]; };
    Vector3d a = Vector3d::Zero(), b = Vector3d::Zero();
    double total = 0;
    for (std::size_t i = 0; i < from.size(); ++i) a += weight(i) * from[i], b += weight(i) * to[i], total += weight(i);
    if (total > 0) a /= total, b /= total;
    Matrix3d m = Matrix3d::Zero();
    double spread = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        m += weight(i) * (to[i] - b) * (from[i] - a).transpose();
        spread += weight(i) * (from[i] - a).squaredNorm();
    }
    const Svd3 svd(m);
    Vector3d sign(1, 1, svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1);
    Motion result;
    result.rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
    if (options.scale && spread > 0)
        result.scale = std::clamp(svd.singularValues().dot(sign) / spread, options.min_scale, options.max_scale);
    result.translation = b - result.scale * (result.rotation * a);
    return result;
}

}  // namespace ostraka
