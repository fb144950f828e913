// The solver: against a dense reference, on singular and contradictory systems, for any number of threads.
#include "ostraka/solver/solve.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/solver/make_constraint.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <random>
#include <thread>

namespace ostraka {
namespace {

using List = std::vector<std::unique_ptr<Constraint>>;

/// A grid of n x n points over the unit square, bumped.
Points grid(int n) {
    Points points(3, n * n);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double u = static_cast<double>(i) / (n - 1), v = static_cast<double>(j) / (n - 1);
            points.col(i * n + j) << u, v, 0.2 * std::sin(5 * u) * std::cos(4 * v);
        }
    return points;
}

std::vector<int> ring(int n, int i, int j) {
    std::vector<int> ids{i * n + j};
    if (i > 0) ids.push_back((i - 1) * n + j);
    if (j > 0) ids.push_back(i * n + j - 1);
    if (i + 1 < n) ids.push_back((i + 1) * n + j);
    if (j + 1 < n) ids.push_back(i * n + j + 1);
    return ids;
}

void add_laplacians(List& list, int n, const Points& rest, double weight) {
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) list.push_back(make_constraint(kinds::LaplacianDisplacement{}, ring(n, i, j), weight, rest));
}

kinds::Closeness at(const Eigen::Vector3d& p) { return {Points(p)}; }

/// Matrix of a constraint's rows over all points, dense, from its documented map.
Eigen::MatrixXd dense_rows(const Constraint& c, Eigen::Index points) {
    const auto& map = c.map();
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(map.rows - map.observed, points);
    for (Eigen::Index i = 0; i < map.direct; ++i) {
        b(i, c.ids()[i]) += 1;
        if (map.centred)
            for (Eigen::Index j = 0; j < map.direct; ++j) b(i, c.ids()[j]) -= 1.0 / static_cast<double>(map.direct);
    }
    for (const auto& entry : map.entries)
        if (map.direct + entry.row < b.rows()) b(map.direct + entry.row, c.ids()[entry.position]) += entry.value;
    return b;
}

/// Local/global iterations with dense matrices.
Points dense_solve(const List& list, Points x, int iterations) {
    for (int it = 0; it < iterations; ++it) {
        Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(x.cols(), x.cols()), right = Eigen::MatrixXd::Zero(x.cols(), 3);
        for (const auto& c : list) {
            const Eigen::MatrixXd b = dense_rows(*c, x.cols());
            Points rows = Points::Zero(3, c->map().rows), projected(3, c->map().rows);
            c->rows_of(x, rows);
            c->project(rows, projected);
            normal += c->weight() * b.transpose() * b;
            right += c->weight() * b.transpose() * projected.leftCols(b.rows()).transpose();
        }
        x = normal.ldlt().solve(right).transpose();
    }
    return x;
}

List mixed(int n, const Points& rest) {
    List list;
    add_laplacians(list, n, rest, 2);
    std::vector<int> plane, rigid;
    for (int i = 0; i < n * n / 2; ++i) plane.push_back(i);
    for (int i = 0; i < 9; ++i) rigid.push_back(n * n - 1 - i);
    list.push_back(make_constraint(kinds::Plane{}, plane, 3, rest));
    list.push_back(make_constraint(kinds::Rigid{}, rigid, 1.5, rest));
    list.push_back(make_constraint(kinds::EdgeStrain{{1.2, 1.3}}, {0, n + 1}, 4, rest));
    list.push_back(make_constraint(at(rest.col(3) + Eigen::Vector3d(0.1, 0, 0.3)), {3}, 5, rest));
    list.push_back(make_constraint(kinds::Closeness{}, {n * n - 1}, 5, rest));
    return list;
}

TEST(MeshSpace, EqualsADenseSolve) {
    const int n = 9;
    const Points rest = grid(n);
    for (const int iterations : {1, 2, 10}) {
        const List reference = mixed(n, rest);
        MeshSpaceSolver solver(mixed(n, rest), rest);
        Points x = rest;
        SolveOptions options;
        options.iterations = iterations;
        options.tolerance = 0;
        options.window = 0;
        const SolveSummary summary = solver.solve(x, options);
        EXPECT_EQ(summary.iterations, iterations);
        EXPECT_TRUE(summary.usable);
        EXPECT_FALSE(summary.regularised);
        EXPECT_EQ(summary.floating_parts, 0);
        EXPECT_LT((x - dense_solve(reference, rest, iterations)).cwiseAbs().maxCoeff(), 1e-10);
        double phi = 0;
        for (const auto& c : reference) phi += c->weight() * c->squared_distance(x);
        EXPECT_NEAR(summary.objective.back(), phi, 1e-12 * summary.objective.front());
    }
}

SolveOptions steps(int iterations, int window = 5) {
    SolveOptions options;
    options.iterations = iterations;
    options.tolerance = 0;
    options.window = window;
    return options;
}

/// Identity weights: the cage is the shape.
CageWeights identity(Eigen::Index n) { return CageWeights::Identity(n, n); }

TEST(CageSpace, EqualsMeshSpaceIfTheCageIsTheShape) {
    const int n = 7;
    const Points rest = grid(n).colwise() + Eigen::Vector3d(1000, -500, 200);
    MeshSpaceSolver mesh(mixed(n, rest), rest);
    CageSpaceSolver cage(mixed(n, rest), identity(n * n), rest);
    Points x = rest, c = rest;
    for (const int window : {0, 4}) {
        const SolveSummary a = mesh.solve(x, steps(8, window)), b = cage.solve(c, steps(8, window));
        EXPECT_FALSE(b.regularised);
        EXPECT_LT((x - c).cwiseAbs().maxCoeff(), 1e-9);
        ASSERT_EQ(a.objective.size(), b.objective.size());
        for (std::size_t i = 0; i < a.objective.size(); ++i)
            EXPECT_NEAR(a.objective[i], b.objective[i], 1e-9 * a.objective.front());
    }
}

CageWeights random_weights(Eigen::Index points, Eigen::Index cage) {
    std::mt19937 random(5);
    CageWeights w(points, cage);
    for (Eigen::Index i = 0; i < points; ++i) {
        for (Eigen::Index j = 0; j < cage; ++j) w(i, j) = static_cast<double>(random()) / 4294967296.0;
        w.row(i) /= w.row(i).sum();
    }
    return w;
}

TEST(CageSpace, EqualsADenseSolve) {
    const int n = 9, cage = 6;  // large groups are reduced to their moments here
    const CageWeights w = random_weights(n * n, cage);
    Points rest_cage(3, cage);
    rest_cage << 0, 2, 0, -1, 0, 1, 0, 0, 2, 0, -1, 1, 1, 0, 0, 0, 0, -3;
    const Points rest = points_of(w, rest_cage);
    const List reference = mixed(n, rest);
    Points c = rest_cage;
    for (int it = 0; it < 3; ++it) {
        Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(cage, cage), right = Eigen::MatrixXd::Zero(cage, 3);
        const Points x = points_of(w, c);
        for (const auto& constraint : reference) {
            const Eigen::MatrixXd m = dense_rows(*constraint, n * n) * w;
            Points rows, projected(3, constraint->map().rows);
            constraint->rows_of(x, rows);
            constraint->project(rows, projected);
            normal += constraint->weight() * m.transpose() * m;
            right += constraint->weight() * m.transpose() * projected.leftCols(m.rows()).transpose();
        }
        c = normal.ldlt().solve(right).transpose();
    }
    CageSpaceSolver solver(mixed(n, rest), w, rest_cage);
    Points solved = rest_cage;
    const SolveSummary summary = solver.solve(solved, steps(3, 0));
    EXPECT_FALSE(summary.regularised);
    EXPECT_LT((solved - c).cwiseAbs().maxCoeff(), 1e-9);
    double phi = 0;
    for (const auto& constraint : reference) phi += constraint->weight() * constraint->squared_distance(points_of(w, solved));
    EXPECT_NEAR(summary.objective.back(), phi, 1e-10 * summary.objective.front());
}

TEST(CageSpace, WeightsAndTargetsCanChange) {
    const int n = 9, cage = 6;
    const CageWeights w = random_weights(n * n, cage);
    Points rest_cage(3, cage);
    rest_cage << 0, 2, 0, -1, 0, 1, 0, 0, 2, 0, -1, 1, 1, 0, 0, 0, 0, -3;
    const Points rest = points_of(w, rest_cage);
    List changed = mixed(n, rest);
    const std::size_t last = changed.size() - 1, plane = last - 4;
    changed[last]->set_weight(50);
    changed[3]->set_weight(0.5);
    changed[plane]->set_weight(7);
    const Points target = rest.col(3) + Eigen::Vector3d(0, 1, 1);
    changed[last - 1]->set_target(target);
    CageSpaceSolver fresh(std::move(changed), w, rest_cage), solver(mixed(n, rest), w, rest_cage);
    Points a = rest_cage, b = rest_cage;
    solver.solve(b, steps(2));
    solver.set_weight(last, 50);
    solver.set_weight(3, 0.5);
    solver.set_weight(plane, 7);
    solver.set_target(last - 1, target);
    b = rest_cage;
    const SolveSummary x = fresh.solve(a, steps(5)), y = solver.solve(b, steps(5));
    EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_NEAR(x.objective.back(), y.objective.back(), 1e-9 * x.objective.front());
    EXPECT_EQ(y.times.symbolic, 0);
}

TEST(CageSpace, GroupsAloneAreRegularisedTowardsRest) {
    const int n = 9, cage = 6;
    const CageWeights w = random_weights(n * n, cage);
    Points rest_cage(3, cage);
    rest_cage << 0, 2, 0, -1, 0, 1, 0, 0, 2, 0, -1, 1, 1, 0, 0, 0, 0, -3;
    const Points rest = points_of(w, rest_cage);
    List list;
    std::vector<int> all;
    for (int i = 0; i < n * n; ++i) all.push_back(i);
    list.push_back(make_constraint(kinds::Plane{}, all, 1, rest));
    CageSpaceSolver solver(std::move(list), w, rest_cage);
    Points c = rest_cage;
    const SolveSummary summary = solver.solve(c, steps(50));
    EXPECT_TRUE(summary.regularised);
    EXPECT_TRUE(summary.usable);
    EXPECT_LT((c - rest_cage).cwiseAbs().maxCoeff(), 5);
    EXPECT_LT(solver.constraint(0).normalised_residual(points_of(w, c)), 1e-4);
    EXPECT_NE(summary.text().find("singular"), std::string::npos);
}

TEST(MeshSpace, ObjectiveNeverIncreasesAndAccelerationHelps) {
    const int n = 12;
    const Points rest = grid(n);
    double plain = 0;
    for (const int window : {0, 5}) {
        MeshSpaceSolver solver(mixed(n, rest), rest);
        Points x = rest;
        const SolveSummary summary = solver.solve(x, steps(40, window));
        for (std::size_t i = 1; i < summary.objective.size(); ++i) EXPECT_LE(summary.objective[i], summary.objective[i - 1]);
        if (window == 0) plain = summary.objective.back();
        else EXPECT_LT(summary.objective.back(), plain);
    }
}

TEST(MeshSpace, IsTheSameForAnyNumberOfThreads) {
    const int n = 40;
    const Points rest = grid(n);
    std::vector<Points> results;
    for (const int count : {1, 2, 5}) {
        set_threads(count);
        MeshSpaceSolver solver(mixed(n, rest), rest);
        CageSpaceSolver cage(mixed(n, rest), random_weights(n * n, 30), random_weights(3, 30).topRows(3));
        Points x = rest, c = random_weights(3, 30).topRows(3);
        solver.solve(x, steps(15));
        cage.solve(c, steps(15));
        Points both(3, x.cols() + c.cols());
        both << x, c;
        results.push_back(both);
    }
    set_threads(0);
    EXPECT_EQ(results[0], results[1]);
    EXPECT_EQ(results[0], results[2]);
}

TEST(MeshSpace, SolversOfSeveralThreadsDoNotDisturbEachOther) {
    const int n = 40;  // large enough for dense blocks in the factor: BLAS is called
    const Points rest = grid(n);
    const auto solved = [&] {
        MeshSpaceSolver solver(mixed(n, rest), rest);
        Points x = rest;
        solver.solve(x, steps(5));
        return x;
    };
    const Points alone = solved();
    std::vector<std::thread> threads;
    std::atomic<int> wrong = 0;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&] {
            set_threads(1);
            for (int lap = 0; lap < 5; ++lap) wrong += solved() != alone ? 1 : 0;
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(wrong, 0);
}

TEST(MeshSpace, UnconstrainedPartsKeepTheirMean) {
    const int n = 6;
    Points rest(3, 2 * n * n + 1);
    rest << grid(n), grid(n).colwise() + Eigen::Vector3d(3, 0, 0), Eigen::Vector3d(9, 9, 9);
    List list;
    add_laplacians(list, n, rest, 1);
    for (int part = 0; part < 2; ++part) {
        std::vector<int> ids;
        for (int i = 0; i < n * n; ++i) ids.push_back(part * n * n + i);
        list.push_back(make_constraint(kinds::Plane{}, ids, 2, rest));
    }
    MeshSpaceSolver solver(std::move(list), rest);
    Points x = rest.colwise() + Eigen::Vector3d(5, 5, 5);
    const Eigen::Vector3d alone = x.col(2 * n * n);
    const SolveSummary summary = solver.solve(x, steps(60));
    EXPECT_EQ(summary.floating_parts, 2);
    EXPECT_FALSE(summary.regularised);
    EXPECT_TRUE(summary.usable);
    for (int part = 0; part < 2; ++part) EXPECT_LT((x - rest).middleCols(part * n * n, n * n).rowwise().mean().norm(), 1e-12);
    EXPECT_LT(solver.constraint(solver.size() - 1).residual(x), 1e-9);
    EXPECT_EQ(x.col(2 * n * n), alone);  // in no constraint
}

TEST(MeshSpace, SingularSystemsAreRegularisedTowardsRest) {
    // Two Laplacians over six points leave many degrees of freedom.
    const Points rest = grid(4);
    List list;
    list.push_back(make_constraint(kinds::Laplacian{}, ring(4, 1, 1), 1, rest));
    list.push_back(make_constraint(kinds::Laplacian{}, ring(4, 1, 2), 1, rest));
    list.push_back(make_constraint(at(rest.col(5) + Eigen::Vector3d(0, 0, 1)), {5}, 1, rest));
    MeshSpaceSolver solver(std::move(list), rest);
    Points x = rest;
    const SolveSummary summary = solver.solve(x, steps(5));
    EXPECT_TRUE(summary.regularised);
    EXPECT_GT(summary.regularisation, 0);
    EXPECT_TRUE(summary.usable);
    EXPECT_LT(summary.objective.back(), 1e-9);
    EXPECT_LT((x - rest).cwiseAbs().maxCoeff(), 3);
}

TEST(MeshSpace, StationsWithSharedPointsLeaveNoWaves) {
    // A tube of 41 rings with closeness, whose axis is constrained to a line that diverges from it: the force must increase along
    // the tube.
    constexpr int rings = 41, sides = 8, step = 10;
    Points rest(3, rings * sides);
    for (int k = 0; k < rings; ++k)
        for (int i = 0; i < sides; ++i) {
            const double a = 2 * 3.14159265358979 * i / sides;
            rest.col(k * sides + i) << std::cos(a), std::sin(a), 0.25 * k;
        }
    const kinds::AxisOnLine line{{0.3, 0, 1}, Eigen::Vector3d::Zero()};
    const auto farthest = [&](bool shares) {
        List list;
        std::vector<int> all;
        for (int k = 0; k < rings; ++k)
            for (int i = 0; i < sides; ++i) {
                std::vector<int> ids{k * sides + i, k * sides + (i + 1) % sides, k * sides + (i + sides - 1) % sides};
                if (k > 0) ids.push_back((k - 1) * sides + i);
                if (k + 1 < rings) ids.push_back((k + 1) * sides + i);
                all.push_back(ids.front());
                list.push_back(make_constraint(kinds::Closeness{}, {ids.front()}, 0.1, rest));
                if (k > 0 && k + 1 < rings) list.push_back(make_constraint(kinds::LaplacianDisplacement{}, ids, 1, rest));
            }
        kinds::AxisOnLine tube = line;
        for (const int id : all) {
            const int k = id / sides;
            tube.stations.push_back(shares ? k / step : std::min(k / step, rings / step - 1));
            if (shares) tube.shares.push_back(static_cast<double>(k % step) / step);
        }
        list.push_back(make_constraint(tube, all, 1e6, rest));
        MeshSpaceSolver solver(std::move(list), rest);
        Points x = rest;
        EXPECT_TRUE(solver.solve(x).usable);
        double maximum = 0;
        for (int k = 0; k < rings; ++k) {
            const Eigen::Vector3d mean = x.middleCols(k * sides, sides).rowwise().mean();
            maximum = std::max(maximum, mean.cross(line.direction.normalized()).norm());
        }
        return maximum;
    };
    EXPECT_GT(farthest(false), 0.02);
    EXPECT_LT(farthest(true), 1e-4);
}

TEST(MeshSpace, ContradictoryPositionsMeetInTheMiddle) {
    const Points rest = grid(3);
    List list;
    list.push_back(make_constraint(at({0, 0, 0}), {4}, 1, rest));
    list.push_back(make_constraint(at({4, 0, 0}), {4}, 3, rest));
    MeshSpaceSolver solver(std::move(list), rest);
    Points x = rest;
    const SolveSummary summary = solver.solve(x);
    EXPECT_EQ(summary.stop, StopReason::converged);
    EXPECT_LT((x.col(4) - Eigen::Vector3d(3, 0, 0)).norm(), 1e-14);
    EXPECT_NEAR(solver.constraint(0).residual(x), 3, 1e-12);
    EXPECT_NEAR(solver.constraint(1).residual(x), 1, 1e-12);
}

TEST(MeshSpace, ZeroWeightsLeavePointsUnchanged) {
    const Points rest = grid(5);
    List list;
    add_laplacians(list, 5, rest, 0);
    MeshSpaceSolver solver(std::move(list), rest);
    const Points start = 2 * rest;
    Points x = start;
    const SolveSummary summary = solver.solve(x);
    EXPECT_EQ(x, start);
    EXPECT_TRUE(summary.usable);
    EXPECT_EQ(summary.objective.back(), 0);
}

TEST(MeshSpace, WithoutConstraintsThereAreNoUnknowns) {
    Points nothing(3, 0);
    MeshSpaceSolver empty({}, nothing);
    EXPECT_TRUE(empty.solve(nothing).usable);
    Points x = grid(3);
    MeshSpaceSolver idle({}, x);
    idle.solve(x);
    EXPECT_EQ(x, grid(3));
}

TEST(MeshSpace, WeightsAndTargetsCanChange) {
    const int n = 9;
    const Points rest = grid(n);
    const std::size_t last = mixed(n, rest).size() - 1;
    MeshSpaceSolver solver(mixed(n, rest), rest);
    Points warm = rest;
    solver.solve(warm, steps(2));
    // A few rows, a few others, back, many, none, again: each time as if newly constructed.
    List now = mixed(n, rest);
    const auto expect_same = [&](const std::string& name, int updated) {
        List copy = mixed(n, rest);
        for (std::size_t i = 0; i < copy.size(); ++i) copy[i]->set_weight(now[i]->weight());
        MeshSpaceSolver fresh(std::move(copy), rest);
        Points a = rest, b = rest;
        fresh.solve(a, steps(6));
        EXPECT_EQ(solver.solve(b, steps(6)).updated_rows, updated) << name;
        EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-9) << name;
    };
    const auto set = [&](std::size_t i, double w) {
        solver.set_weight(i, w);
        now[i]->set_weight(w);
    };
    set(last, 100);
    expect_same("heavier", 1);
    set(2, 0.25);
    set(last - 2, 9);
    expect_same("more rows", 3);
    set(last, 5);
    expect_same("back", 2);
    set(last - 4, 8);
    expect_same("a large group", 0);
    set(last, 0);
    expect_same("without", 0);
    set(last, 1e-3);
    expect_same("with again", 0);
    for (std::size_t i = 0; i < 60; ++i) set(i, 3);
    expect_same("many", 0);
}

TEST(Solver, RefusesInvalidArguments) {
    const Points rest = grid(3);
    List beyond;
    beyond.push_back(make_constraint(kinds::Closeness{}, {8}, 1, rest));
    EXPECT_THROW(MeshSpaceSolver(std::move(beyond), rest.leftCols(4)), Error);
    List list;
    list.push_back(make_constraint(kinds::Closeness{}, {8}, 1, rest));
    MeshSpaceSolver solver(std::move(list), rest);
    Points few = rest.leftCols(4), nan = rest;
    nan(0, 0) = std::nan("");
    EXPECT_THROW(solver.solve(few), Error);
    EXPECT_THROW(solver.solve(nan), Error);
    EXPECT_THROW(solver.set_weight(0, -1), Error);
    EXPECT_THROW(solver.set_target(0, few), Error);
    SolveOptions options;
    options.window = -1;
    Points x = rest;
    EXPECT_THROW(solver.solve(x, options), Error);
    EXPECT_THROW(CageSpaceSolver({}, CageWeights::Zero(4, 3), rest), Error);
    EXPECT_THROW(points_of(CageWeights::Zero(4, 3), rest), Error);
}

}  // namespace
}  // namespace ostraka
