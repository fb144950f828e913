#include "solver/elimination.h"

namespace ostraka::solver {

void Elimination::add(const RowMatrix& rows, std::size_t first, const Constraint::Components& given) {
    for (Eigen::Index r = 0; r < given.values.cols(); ++r) {
        const std::size_t from = first + static_cast<std::size_t>(r);
        for (Eigen::Index a = 0; a < given.directions.rows(); ++a)
            equations_.push_back(
                {static_cast<Eigen::Index>(rows_.rows()), given.directions.row(a).transpose(), given.values(a, r)});
        for (std::size_t e = rows.begin[from]; e < rows.begin[from + 1]; ++e) {
            rows_.unknown.push_back(rows.unknown[e]);
            rows_.value.push_back(rows.value[e]);
        }
        rows_.begin.push_back(rows_.unknown.size());
    }
}

Eigen::MatrixXd Elimination::times(const Eigen::MatrixXd& x) const {
    Eigen::MatrixXd product = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows_.rows()), x.cols());
    for (std::size_t r = 0; r < rows_.rows(); ++r)
        for (std::size_t e = rows_.begin[r]; e < rows_.begin[r + 1]; ++e)
            product.row(static_cast<Eigen::Index>(r)) += rows_.value[e] * x.row(rows_.unknown[e]);
    return product;
}

void Elimination::finish(const std::function<void(Eigen::MatrixXd&)>& solve) {
    influence_.setZero(unknowns_, static_cast<Eigen::Index>(rows_.rows()));
    for (std::size_t r = 0; r < rows_.rows(); ++r)
        for (std::size_t e = rows_.begin[r]; e < rows_.begin[r + 1]; ++e)
            influence_(rows_.unknown[e], static_cast<Eigen::Index>(r)) += rows_.value[e];
    solve(influence_);
    const Eigen::MatrixXd seen = times(influence_);
    const auto n = static_cast<Eigen::Index>(equations_.size());
    Eigen::MatrixXd complement(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j) {
            const Equation &a = equations_[static_cast<std::size_t>(i)], &b = equations_[static_cast<std::size_t>(j)];
            complement(i, j) = a.direction.dot(b.direction) * seen(a.row, b.row);
        }
    complement_.compute(complement);
}

Eigen::MatrixXd Elimination::correction(const Eigen::MatrixXd& x) const {
    const Eigen::MatrixXd rows = times(x);
    Eigen::VectorXd off(static_cast<Eigen::Index>(equations_.size()));
    for (Eigen::Index i = 0; i < off.size(); ++i) {
        const Equation& equation = equations_[static_cast<std::size_t>(i)];
        off[i] = rows.row(equation.row).dot(equation.direction) - equation.value;
    }
    const Eigen::VectorXd multipliers = complement_.solve(off);
    Eigen::MatrixXd by_row = Eigen::MatrixXd::Zero(rows.rows(), 3);
    for (Eigen::Index i = 0; i < off.size(); ++i) {
        const Equation& equation = equations_[static_cast<std::size_t>(i)];
        by_row.row(equation.row) += multipliers[i] * equation.direction.transpose();
    }
    return influence_ * by_row;
}

}  // namespace ostraka::solver
