#include "ostraka/stats/embedding.h"
#include "ostraka/algebra/dense.h"

#include "ostraka/core/error.h"
#include "stats/check_samples.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ostraka {

namespace {

void check_dimensions(int dimensions) {
    if (dimensions < 1) fail_usage("the number of dimensions is " + std::to_string(dimensions), "use at least 1");
}

/// The sign (1 or -1) that makes the entry of largest magnitude, the first of equal ones, positive.
double sign_of(const Eigen::VectorXd& vector) {
    const double largest = vector.cwiseAbs().maxCoeff();
    for (const double entry : vector)
        if (std::abs(entry) >= largest * (1 - 1e-9)) return entry < 0 ? -1 : 1;
    return 1;
}

}  // namespace

Embedding spectral_embedding(const Eigen::MatrixXd& symmetric, int dimensions) {
    check_dimensions(dimensions);
    require_symmetric(symmetric, false, "spectral embedding");
    const Eigen::Index n = symmetric.rows(), d = std::min<Eigen::Index>(dimensions, n);
    const SymmetricEigenX solver((symmetric + symmetric.transpose()) / 2);
    if (!solver.succeeded())
        throw Error(ErrorKind::failure, "spectral embedding", "the eigenvalues were not found",
                    "check that the matrix has entries of moderate size");
    const Eigen::VectorXd& values = solver.eigenvalues();
    std::vector<Eigen::Index> order(static_cast<std::size_t>(n));
    // By decreasing value, so that a positive eigenvalue comes before a negative one of the same magnitude.
    for (Eigen::Index i = 0; i < n; ++i) order[static_cast<std::size_t>(i)] = n - 1 - i;
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return std::abs(values[a]) > std::abs(values[b]); });
    Embedding result{Eigen::MatrixXd(n, d), Eigen::VectorXd(d)};
    for (Eigen::Index k = 0; k < d; ++k) {
        const Eigen::Index column = order[static_cast<std::size_t>(k)];
        const Eigen::VectorXd vector = solver.eigenvectors().col(column);
        result.coordinates.col(k) = sign_of(vector) * vector;
        result.eigenvalues[k] = values[column];
    }
    return result;
}

PrincipalComponents principal_components(const Eigen::MatrixXd& samples, int dimensions) {
    check_dimensions(dimensions);
    require_samples(samples, "principal components");
    PrincipalComponents result;
    result.mean = samples.row(0) + (samples.rowwise() - samples.row(0)).colwise().mean();
    const Eigen::MatrixXd centred = samples.rowwise() - result.mean;
    const SvdX svd(centred);
    const Eigen::Index d = std::min<Eigen::Index>(dimensions, svd.singularValues().size());
    const double divisor = std::max<double>(1, static_cast<double>(samples.rows() - 1));
    result.directions.resize(samples.cols(), d);
    for (Eigen::Index k = 0; k < d; ++k) result.directions.col(k) = sign_of(svd.matrixV().col(k)) * svd.matrixV().col(k);
    result.scores = centred * result.directions;
    result.variances = svd.singularValues().head(d).cwiseAbs2() / divisor;
    result.total_variance = svd.singularValues().squaredNorm() / divisor;
    return result;
}

}  // namespace ostraka
