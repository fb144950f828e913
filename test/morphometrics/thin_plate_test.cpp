#include "ostraka/morphometrics/thin_plate.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/error.h"
#include "samples.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

using test::random_configuration;

TEST(ThinPlateSpline, InterpolatesItsLandmarksAndReproducesAffineMaps) {
    for (const int dimension : {2, 3}) {
        Random random(static_cast<std::uint64_t>(dimension));
        const Landmarks from = random_configuration(random, 12, dimension), to = random_configuration(random, 12, dimension);
        const ThinPlateSpline spline(from, to, dimension);
        EXPECT_LT((spline(from) - to).norm(), 1e-9 * to.norm());
        EXPECT_GT(spline.bending_energy(), 0);
        Eigen::Matrix3d a = Eigen::Matrix3d::Identity();
        a.topLeftCorner<2, 2>() << 2, 0.5, -1, 0.7;
        const Eigen::RowVector3d shift(100, -7, 0);
        const ThinPlateSpline affine(from, (from * a.transpose()).rowwise() + shift, dimension);
        const Landmarks other = random_configuration(random, 5, dimension);
        EXPECT_LT((affine(other) - ((other * a.transpose()).rowwise() + shift).eval()).norm(), 1e-7);
        EXPECT_NEAR(affine.bending_energy(), 0, 1e-9);
    }
}

TEST(ThinPlateSpline, BendingEnergyIsSymmetricPositiveAndBlindToAffineMaps) {
    for (const int dimension : {2, 3}) {
        Random random(5);
        const Landmarks x = random_configuration(random, 15, dimension, 1000);
        const Eigen::MatrixXd B = bending_energy_matrix(x, dimension);
        EXPECT_LT((B - B.transpose()).norm(), 1e-12 * B.norm());
        const SymmetricEigenX eigen(B);
        EXPECT_GT(eigen.eigenvalues()[0], -1e-10 * B.norm());
        int positive = 0;
        for (const double value : eigen.eigenvalues()) positive += value > 1e-10 * B.norm() ? 1 : 0;
        EXPECT_EQ(positive, 15 - dimension - 1);
        EXPECT_LT((B * x).norm(), 1e-9 * B.norm() * x.norm());
    }
}

TEST(ThinPlateSpline, CopesWithDegenerateReferences) {
    Landmarks flat(6, 3);
    flat << 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0, 1, 3, 0;
    const ThinPlateSpline spline(flat, 2 * flat, 3);
    EXPECT_LT((spline(flat) - 2 * flat).norm(), 1e-9) << "coplanar landmarks in space";
    const Landmarks two = flat.topRows(2);
    EXPECT_LT((ThinPlateSpline(two, 3 * two, 2)(two) - 3 * two).norm(), 1e-9);
    EXPECT_THROW(ThinPlateSpline(flat, flat.topRows(5), 3), Error);
    EXPECT_THROW(ThinPlateSpline(Landmarks::Zero(4, 3), Landmarks::Zero(4, 3), 3), Error);
    Landmarks unknown = flat;
    unknown(0, 0) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(ThinPlateSpline(unknown, flat, 3), Error);
}

TEST(ThinPlateSpline, GridOfTheSameShapeIsStraight) {
    Landmarks square(5, 3);
    square << 0, 0, 0, 2, 0, 0, 0, 1, 0, 2, 1, 0, 1, 0.4, 0;
    const auto lines = deformation_grid(square, square, 10, 0.1, 3);
    ASSERT_FALSE(lines.empty());
    for (const auto& line : lines) {
        const bool along_x = std::abs(line.front()[1] - line.back()[1]) < 1e-9;
        for (const auto& p : line) EXPECT_NEAR(p[along_x ? 1 : 0], line.front()[along_x ? 1 : 0], 1e-9);
    }
}

}  // namespace
}  // namespace ostraka
