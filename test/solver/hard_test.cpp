#include "ostraka/solver/hard.h"
#include "examples.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

using List = std::vector<std::unique_ptr<Constraint>>;

/// A closed chain of points, each of which keeps its place against its neighbours.
struct Chain {
    static constexpr int n = 30;
    Points rest{3, n};
    List list;
    std::vector<bool> hard;
    Chain() {
        for (int i = 0; i < n; ++i) rest.col(i) << std::cos(i * 0.2094), std::sin(i * 0.2094), 0.1 * std::sin(i * 0.6);
        for (int i = 0; i < n; ++i)
            add(false, make_constraint("LaplacianDisplacement", {i, (i + 1) % n, (i + n - 1) % n}, 1, {}, rest));
    }
    void add(bool must, std::unique_ptr<Constraint> c) {
        list.push_back(std::move(c));
        hard.push_back(must);
    }
    void pin(bool must, int i, const Eigen::Vector3d& by) {
        ConstraintParameters p;
        p.target = rest.col(i) + by;
        add(must, make_constraint("Closeness", {i}, 0.1, p, rest));
    }
};

TEST(Hard, PositionsGiveTheConstrainedMinimum) {
    Chain chain;
    chain.pin(true, 0, {0, 0, 1});
    chain.pin(true, 11, {0.5, 0, 0});
    // The same by Lagrange multipliers.
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

TEST(Hard, ShapesHold) {
    Chain chain;
    chain.pin(false, 3, {0, 0, 0});
    chain.pin(false, 20, {0.4, 0.3, 0.2});
    chain.add(true, make_constraint("Plane", {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14}, 0.5, {}, chain.rest));
    chain.add(true, make_constraint("Rigid", {18, 19, 20, 21, 22}, 0.5, {}, chain.rest));
    ConstraintParameters longer;
    longer.min = longer.max = 1.5;
    chain.add(true, make_constraint("EdgeStrain", {25, 26}, 0.5, longer, chain.rest));
    HardSolver solver(std::move(chain.list), chain.hard, chain.rest);
    Points x = chain.rest;
    const HardSummary summary = solver.solve(x);
    EXPECT_TRUE(summary.met) << summary.violation.back();
    EXPECT_TRUE(summary.last.usable);
    EXPECT_NEAR((x.col(26) - x.col(25)).norm(), 1.5 * (chain.rest.col(26) - chain.rest.col(25)).norm(), 1e-5);
    EXPECT_LT(solver.constraint(solver.size() - 3).normalised_residual(x), 1e-5);
}

TEST(Hard, ContradictionsAreSaid) {
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

TEST(Hard, RefusesWhatMakesNoSense) {
    Chain chain;
    EXPECT_THROW(HardSolver(std::move(chain.list), {true}, chain.rest), Error);
    Chain other;
    other.add(true, make_constraint("Closeness", {0}, 0, {}, other.rest));
    EXPECT_THROW(HardSolver(std::move(other.list), other.hard, other.rest), Error);
}

}  // namespace
}  // namespace ostraka
