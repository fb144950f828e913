#include "ostraka/algebra/dense.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace ostraka {
namespace {

Eigen::Matrix2d symmetric(double a, double b, double c) {
    Eigen::Matrix2d m;
    m << a, b, b, c;
    return m;
}

TEST(SymmetricEigen2, KnownMatrices) {
    const SymmetricEigen2 two(symmetric(2, 1, 2));
    ASSERT_TRUE(two.succeeded());
    EXPECT_NEAR(two.eigenvalues()[0], 1, 1e-15);
    EXPECT_NEAR(two.eigenvalues()[1], 3, 1e-15);
    EXPECT_NEAR(std::abs(two.eigenvectors().col(1).dot(Eigen::Vector2d(1, 1).normalized())), 1, 1e-15);
    const SymmetricEigen2 diagonal(symmetric(5, 0, -7));
    EXPECT_EQ(diagonal.eigenvalues(), Eigen::Vector2d(-7, 5));
    EXPECT_EQ(SymmetricEigen2(Eigen::Matrix2d::Zero()).eigenvalues(), Eigen::Vector2d::Zero());
    EXPECT_FALSE(SymmetricEigen2(symmetric(1, std::numeric_limits<double>::quiet_NaN(), 1)).succeeded());
}

/// For any size the vectors are orthonormal, the values ascend, and both reproduce the matrix, as with the dynamic solver.
TEST(SymmetricEigen2, AgreesWithTheDynamicSolver) {
    for (const double size : {1e-150, 1e-8, 1.0, 1e8, 1e150})
        for (const auto& m : {symmetric(1, 2, 3), symmetric(3, -2, 1), symmetric(1, 1e-9, 1), symmetric(-1, 0.5, -1e-7)}) {
            const Eigen::Matrix2d scaled = size * m;
            const SymmetricEigen2 two(scaled);
            const SymmetricEigenX any{Eigen::MatrixXd(scaled)};
            const Eigen::Matrix2d v = two.eigenvectors();
            EXPECT_LE(two.eigenvalues()[0], two.eigenvalues()[1]);
            EXPECT_LE((v.transpose() * v - Eigen::Matrix2d::Identity()).norm(), 1e-15);
            EXPECT_LE((v * two.eigenvalues().asDiagonal() * v.transpose() - scaled).norm(), 1e-15 * 4 * size * m.norm());
            EXPECT_LE((two.eigenvalues() - any.eigenvalues()).norm(), 1e-15 * 4 * size * m.norm());
        }
}

/// Only the lower triangle is read.
TEST(SymmetricEigen2, ReadsTheLowerTriangle) {
    Eigen::Matrix2d m = symmetric(1, 2, 3);
    m(0, 1) = 99;
    EXPECT_EQ(SymmetricEigen2(m).eigenvalues(), SymmetricEigen2(symmetric(1, 2, 3)).eigenvalues());
}

}  // namespace
}  // namespace ostraka
