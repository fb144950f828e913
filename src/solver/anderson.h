// Anderson acceleration of a fixed-point iteration (Peng et al. 2018, Anderson acceleration for geometry optimization).
#pragma once

#include "ostraka/solver/constraint.h"

#include <vector>

namespace ostraka::solver {

/// Accelerates the iteration x -> G(x).
class Anderson {
public:
    explicit Anderson(int window) : window_(window) {}  ///< `window`: max number of previous steps used
    /// Computes the next iterate from the current iterate x and g = G(x).
    void next(const Points& x, const Points& g, Points& accelerated);

private:
    /// Number of previous steps used at most, number in the buffers, and index of the oldest.
    int window_, used_ = 0, oldest_ = 0;
    bool started_ = false;
    Points last_f_, last_g_;       ///< G(x) - x and G(x) of the last step
    std::vector<Points> df_, dg_;  ///< ring buffers of differences between successive values of G(x) - x, and of G(x)
    Eigen::MatrixXd products_;     ///< inner products of the entries of df_
};

/// Sum of the inner products of the columns a_i and b_i, the same for any number of threads.
double dot(const Points& a, const Points& b);

}  // namespace ostraka::solver
