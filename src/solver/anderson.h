// Anderson acceleration of a fixed-point iteration (Peng et al. 2018, Anderson acceleration for geometry optimization).
#pragma once

#include "ostraka/solver/constraint.h"

#include <vector>

namespace ostraka::solver {

class Anderson {
public:
    explicit Anderson(int window) : window_(window) {}
    /// The next iterate, from x and G(x).
    void next(const Points& x, const Points& g, Points& accelerated);

private:
    int window_, used_ = 0, oldest_ = 0;
    bool started_ = false;
    Points last_f_, last_g_;
    std::vector<Points> df_, dg_;  ///< ring buffers of differences of residuals G(x) - x and of G(x)
    Eigen::MatrixXd products_;     ///< inner products of the df
};

/// Sum of a_i . b_i, the same for any number of threads.
double dot(const Points& a, const Points& b);

}  // namespace ostraka::solver
