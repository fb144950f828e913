#include "solver/anderson.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/execution/parallel.h"

namespace ostraka::solver {

namespace {
constexpr std::size_t block = 4096;

/// Runs a loop over columns in parallel blocks.
template <class Body>
void by_blocks(Eigen::Index columns, Body body) {
    parallel_blocks(static_cast<std::size_t>(columns), block, [&](std::size_t begin, std::size_t end) {
        body(static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(end - begin));
    });
}
}  // namespace

double dot(const Points& a, const Points& b) {
    const auto count = static_cast<std::size_t>(a.cols());
    std::vector<double> parts((count + block - 1) / block, 0.0);
    parallel_blocks(count, block, [&](std::size_t begin, std::size_t end) {
        const auto first = static_cast<Eigen::Index>(begin), length = static_cast<Eigen::Index>(end - begin);
        parts[begin / block] = a.middleCols(first, length).cwiseProduct(b.middleCols(first, length)).sum();
    });
    double sum = 0;
    for (const double part : parts) sum += part;
    return sum;
}

void Anderson::next(const Points& x, const Points& g, Points& accelerated) {
    Points f(3, x.cols());
    by_blocks(x.cols(), [&](Eigen::Index first, Eigen::Index n) {
        f.middleCols(first, n) = g.middleCols(first, n) - x.middleCols(first, n);
    });
    accelerated = g;
    if (started_) {
        if (df_.empty()) {
            df_.resize(window_);
            dg_.resize(window_);
            products_.setZero(window_, window_);
        }
        const int slot = used_ < window_ ? used_ : oldest_;
        df_[slot].resize(3, x.cols());
        dg_[slot].resize(3, x.cols());
        by_blocks(x.cols(), [&](Eigen::Index first, Eigen::Index n) {
            df_[slot].middleCols(first, n) = f.middleCols(first, n) - last_f_.middleCols(first, n);
            dg_[slot].middleCols(first, n) = g.middleCols(first, n) - last_g_.middleCols(first, n);
        });
        if (used_ < window_) ++used_;
        else oldest_ = (oldest_ + 1) % window_;
        Eigen::VectorXd right(used_);
        for (int i = 0; i < used_; ++i) {
            products_(i, slot) = products_(slot, i) = dot(df_[i], df_[slot]);
            right[i] = dot(df_[i], f);
        }
        // Least squares min |f - sum theta_i df_i| by its scaled normal equations; a complete orthogonal decomposition handles
        // differences that have become parallel.
        const Eigen::MatrixXd normal = products_.topLeftCorner(used_, used_);
        Eigen::VectorXd scale(used_);
        for (int i = 0; i < used_; ++i) scale[i] = normal(i, i) > 0 ? 1 / std::sqrt(normal(i, i)) : 0.0;
        const Eigen::VectorXd theta = scale.asDiagonal() * solve_least_squares(scale.asDiagonal() * normal * scale.asDiagonal(),
                                                                               scale.asDiagonal() * right, 1e-12);
        if (theta.allFinite())
            by_blocks(x.cols(), [&](Eigen::Index first, Eigen::Index n) {
                for (int i = 0; i < used_; ++i) accelerated.middleCols(first, n) -= theta[i] * dg_[i].middleCols(first, n);
            });
    }
    last_f_.swap(f);
    last_g_ = g;
    started_ = true;
}

}  // namespace ostraka::solver
