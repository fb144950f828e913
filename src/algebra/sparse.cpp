#include "ostraka/algebra/sparse.h"

#include <Eigen/SparseCholesky>

namespace ostraka {

struct SparseLdlt::Factor : Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> {
    using SimplicialLDLT::SimplicialLDLT;
};

SparseLdlt::SparseLdlt(const Eigen::SparseMatrix<double>& a) : factor_(std::make_unique<Factor>(a)) {}
SparseLdlt::~SparseLdlt() = default;
bool SparseLdlt::succeeded() const { return factor_->info() == Eigen::Success; }
Eigen::MatrixXd SparseLdlt::solve(const Eigen::MatrixXd& b) const { return factor_->solve(b); }

}  // namespace ostraka
