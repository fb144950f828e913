#include "ostraka/solver/hard.h"
#include "examples.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

using List = std::vector<std::unique_ptr<Constraint>>;

/// A closed chain of points with Laplacian displacements.
struct Chain {
    static constexpr int n = 30;
    Points rest{3, n};
    List list;
    std::vector<bool> hard;
    Chain() {
        for (int i = 0; i < n; ++i) rest.col(i) << std::cos(i * 0.2094), std::sin(i * 0.2094), 0.1 * std::sin(i * 0.6);
        for (int i = 0; i < n; ++i)
            add(false, make_constraint(kinds::LaplacianDisplacement{}, {i, (i + 1) % n, (i + n - 1) % n}, 1, rest));
    }
    void add(bool must, std::unique_ptr<Constraint> c) {
        list.push_back(std::move(c));
        hard.push_back(must);
    }
    void pin(bool must, int i, const Eigen::Vector3d& by) {
        add(must, make_constraint(kinds::Closeness{rest.col(i) + by}, {i}, 0.1, rest));
    }
};

TEST(Hard, PositionsGiveTheConstrainedMinimum) {
    Chain chain;
    chain.pin(true, 0, {0, 0, 1});
    chain.pin(true, 11, {0.5, 0, 0});
    // The same with Lagrange multipliers.
    const int n = Chain::n;
    Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(n + 2, n + 2), right = Eigen::MatrixXd::Zero(n + 2, 3);
    for (int i = 0; i < n; ++i) {
        Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(n);
        row[i] = -1;
        row[(i + 1) % n] = row[(i + n - 1) % n] = 0.5;
        kkt.topLeftCorner(n, n) += row.transpose() * row;
        right.topRows(n) += row.transpose() * (row * chain.rest.transpose());
    }
    kkt(n, 0) = kkt(0, n) = kkt(n + 1, 11) = kkt(11, n + 1) = 1;
    right.row(n) = (chain.rest.col(0) + Eigen::Vector3d(0, 0, 1)).transpose();
    right.row(n + 1) = (chain.rest.col(11) + Eigen::Vector3d(0.5, 0, 0)).transpose();
    const Eigen::MatrixXd wanted = kkt.fullPivLu().solve(right).topRows(n);

    HardSolver solver(std::move(chain.list), chain.hard, chain.rest);
    Points x = chain.rest;
    HardOptions options;
    options.tolerance = 1e-9;
    const HardSummary summary = solver.solve(x, options);
    EXPECT_TRUE(summary.met);
    EXPECT_LT(summary.violation.back(), 1e-8);
    EXPECT_LT((x.transpose() - wanted).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_LT(solver.constraint(solver.size() - 1).residual(x), 1e-8);
    EXPECT_EQ(solver.constraint(solver.size() - 1).weight(), 0.1);
}

TEST(Hard, StationsOnALineGiveTheConstrainedMinimumAtOnce) {
    // Means of three points each on two lines; motion along the lines is free. The same with Lagrange multipliers for all three
    // coordinates.
    Chain chain;
    chain.pin(false, 0, {0, 0, 0});
    const int n = Chain::n;
    const Eigen::Vector3d directions[2] = {Eigen::Vector3d(1, 2, 3).normalized(), Eigen::Vector3d(-2, 0.5, 1).normalized()};
    const Eigen::Vector3d points[2] = {{0.3, 0, 0.4}, {0, -0.5, 0}};
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(18, 3 * n);
    Eigen::VectorXd values(18);
    for (int line = 0; line < 2; ++line) {
        kinds::AxisOnLine kind{directions[line], points[line]};
        std::vector<int> ids;
        for (int k = 0; k < 9; ++k) ids.push_back(3 + 12 * line + k), kind.stations.push_back(k / 3);
        chain.add(true, make_constraint(kind, ids, 3, chain.rest));
        const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - directions[line] * directions[line].transpose();
        for (int k = 0; k < 9; ++k) rows.block<3, 3>(9 * line + 3 * (k / 3), 3 * ids[static_cast<std::size_t>(k)]) = across / 3;
        for (int s = 0; s < 3; ++s) values.segment<3>(9 * line + 3 * s) = across * points[line];
    }
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(3 * n);
    for (int i = 0; i < n; ++i)
        for (int c = 0; c < 3; ++c) {
            Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(3 * n);
            row[3 * i + c] = -1;
            row[3 * ((i + 1) % n) + c] = row[3 * ((i + n - 1) % n) + c] = 0.5;
            hessian += row.transpose() * row;
            right += row.transpose() * row.dot(Eigen::Map<const Eigen::VectorXd>(chain.rest.data(), 3 * n));
        }
    for (int c = 0; c < 3; ++c) hessian(c, c) += 0.1, right[c] += 0.1 * chain.rest(c, 0);
    Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(3 * n + 18, 3 * n + 18);
    kkt.topLeftCorner(3 * n, 3 * n) = hessian;
    kkt.bottomLeftCorner(18, 3 * n) = rows;
    kkt.topRightCorner(3 * n, 18) = rows.transpose();
    Eigen::VectorXd all(3 * n + 18);
    all << right, values;
    const Eigen::VectorXd wanted = kkt.completeOrthogonalDecomposition().solve(all).head(3 * n);

    HardSolver solver(std::move(chain.list), chain.hard, chain.rest);
    Points x = chain.rest;
    HardOptions options;
    options.tolerance = 1e-9;
    const HardSummary summary = solver.solve(x, options);
    EXPECT_TRUE(summary.met);
    EXPECT_EQ(summary.rounds, 1);
    EXPECT_TRUE(summary.last.usable);
    EXPECT_LT((Eigen::Map<const Eigen::VectorXd>(x.data(), 3 * n) - wanted).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(Hard, ContradictoryLinesAreReported) {
    Chain chain;
    chain.pin(false, 0, {0, 0, 0});
    for (const double height : {-1.0, 1.0}) {
        const kinds::AxisOnLine kind{Eigen::Vector3d::UnitX(), {0, 0, height}};
        chain.add(true, make_constraint(kind, {4, 5}, 1, chain.rest));
    }
    HardSolver solver(std::move(chain.list), chain.hard, chain.rest);
    Points x = chain.rest;
    const HardSummary summary = solver.solve(x);
    EXPECT_FALSE(summary.met);
    EXPECT_TRUE(x.allFinite());
    EXPECT_NEAR(x(2, 4), 0, 1e-6) << "half-way";
    EXPECT_NEAR(summary.of_constraint[summary.of_constraint.size() - 1], 1, 1e-6);
}

TEST(Hard, ShapesHold) {
    Chain chain;
    chain.pin(false, 3, {0, 0, 0});
    chain.pin(false, 20, {0.4, 0.3, 0.2});
    chain.add(true, make_constraint(kinds::Plane{}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14}, 0.5, chain.rest));
    chain.add(true, make_constraint(kinds::Rigid{}, {18, 19, 20, 21, 22}, 0.5, chain.rest));
    chain.add(true, make_constraint(kinds::EdgeStrain{{1.5, 1.5}}, {25, 26}, 0.5, chain.rest));
    HardSolver solver(std::move(chain.list), chain.hard, chain.rest);
    Points x = chain.rest;
    const HardSummary summary = solver.solve(x);
    EXPECT_TRUE(summary.met) << summary.violation.back();
    EXPECT_TRUE(summary.last.usable);
    EXPECT_NEAR((x.col(26) - x.col(25)).norm(), 1.5 * (chain.rest.col(26) - chain.rest.col(25)).norm(), 1e-5);
    EXPECT_LT(solver.constraint(solver.size() - 3).normalised_residual(x), 1e-5);
}

TEST(Hard, ContradictionsAreReported) {
    Chain chain;
    chain.pin(true, 0, {0, 0, 1});
    chain.pin(true, 0, {0, 0, -1});
    HardSolver solver(std::move(chain.list), chain.hard, chain.rest);
    Points x = chain.rest;
    HardOptions options;
    options.rounds = 30;
    const HardSummary summary = solver.solve(x, options);
    EXPECT_FALSE(summary.met);
    EXPECT_TRUE(x.allFinite());
    EXPECT_NEAR(summary.of_constraint[Chain::n] + summary.of_constraint[Chain::n + 1], 2, 1e-6);
    EXPECT_EQ(summary.of_constraint[0], 0);
}

TEST(Hard, RefusesInvalidArguments) {
    Chain chain;
    EXPECT_THROW(HardSolver(std::move(chain.list), {true}, chain.rest), Error);
    Chain other;
    other.add(true, make_constraint(kinds::Closeness{}, {0}, 0, other.rest));
    EXPECT_THROW(HardSolver(std::move(other.list), other.hard, other.rest), Error);
}

}  // namespace
}  // namespace ostraka
