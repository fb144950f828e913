// The solver over the points of a cage. All quantities are expressed in displacements d = c - c0 of the cage from rest, so that
// no digits are lost far from the origin: rows are r0 + M d with M = B W.
#include "ostraka/algebra/dense.h"
#include "ostraka/solver/solve.h"

#include "ostraka/core/stopwatch.h"
#include "ostraka/execution/parallel.h"
#include "solver/kernels.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace ostraka {

namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Thin = Eigen::Matrix<double, Eigen::Dynamic, 3>;  ///< one row per cage point

/// The system counts as singular below this reciprocal condition number.
constexpr double min_rcond = 1e-13;
constexpr double min_regularisation = 1e-10;
constexpr Eigen::Index rows_of_piece = 1024;
constexpr std::size_t pieces_of_wave = 16;

/// A large group reduced to sums over its rows.
struct Group {
    std::size_t constraint = 0;
    MatrixXd m_m;               ///< M^T M
    Thin m_r0, m_q;             ///< M^T r0, M^T q
    Matrix3d r0_r0, r0_q, q_q;  ///< sums of r0 r0^T, r0 q^T, q q^T
    Thin right;                 ///< w M^T (p - r0) at the last projection
    double objective = 0;
};

enum class Treatment { constant, group, rows };

/// A range of rows of a constraint.
struct Slice {
    std::size_t constraint;
    Eigen::Index first, count;
};
/// Slices that are summed together, all of the same treatment; a slice of a group stands alone.
using Piece = std::vector<Slice>;

Eigen::Index rows_in(const Piece& piece) {
    Eigen::Index rows = 0;
    for (const Slice& slice : piece) rows += slice.count;
    return rows;
}

/// Sums over the rows of a piece: M^T M; for a group M^T r0 and M^T q, otherwise w M^T (p - r0) of constant rows in `first`.
struct Sum {
    MatrixXd m_m;
    Thin first, second;
    double objective = 0;
};

using Constraints = std::span<const std::unique_ptr<Constraint>>;

}  // namespace

struct CageSpaceSolver::State {
    Points rest;             ///< points of the cage at rest
    std::vector<int> index;  ///< for each point of the shape, its index among the constrained points
    CageWeights weights;     ///< rows of the constrained points
    Points rest_points;      ///< all points of the shape at rest; zero for unconstrained points
    Eigen::Index cage = 0;
    std::vector<Treatment> treatment;
    std::vector<std::size_t> place_of;        ///< constraint -> its index in `groups` or `moving`
    std::vector<Eigen::RowVectorXd> mean_of;  ///< mean row of the weights, for centred constraints

    bool formed = false, factored = false;
    MatrixXd normal, constant_normal;
    Thin constant_right;
    double constant_objective = 0;
    std::vector<Group> groups;
    // Rows that are projected individually.
    std::vector<std::size_t> moving;      ///< indices of the constraints
    std::vector<std::size_t> blocks;      ///< start of each block in `moving`, and the end
    std::vector<Eigen::Index> first_row;  ///< first row of each constraint in `moving`, and the number of rows
    Eigen::Index stride = 0;              ///< length of the rows of m, which are padded with zeros
    CageWeights m;
    Points r0;
    std::vector<Thin> parts;
    std::vector<double> part_objective;

    Cholesky factor;
    double regularisation = 0;
    Thin right;

    void weight_rows(const Constraint& c, std::size_t i, Eigen::Index first, Eigen::Index count, CageWeights& out) const;
    Points rest_rows(const Constraint& c) const {
        Points rows;
        c.rows_of(rest_points, rows);
        return rows;
    }
    void form(Constraints constraints);
    void choose_treatments(Constraints constraints);
    [[nodiscard]] std::vector<Piece> pieces_of(Constraints constraints) const;
    void take_means(Constraints constraints);
    void clear_sums();
    /// Initialises a group; returns its rows at rest.
    [[nodiscard]] Points start_group(Group& group, const Constraint& c) const;
    [[nodiscard]] Sum sum_of(Constraints constraints, const Piece& piece, const std::vector<Points>& group_rows);
    /// `rows`: rows of M; observed rows are set to zero. Rows that are projected individually are stored.
    void sum_slice(const Constraint& c, const Slice& slice, const std::vector<Points>& group_rows, CageWeights& rows, Sum& sum);
    void add(const Sum& sum, std::size_t constraint);
    void add_constant(const Constraint& c, std::size_t i, double by_weight);
    void make_factor();
};

/// Computes the rows first ... first + count of M.
void CageSpaceSolver::State::weight_rows(const Constraint& c, std::size_t i, Eigen::Index first, Eigen::Index count,
                                         CageWeights& out) const {
    const auto& map = c.map();
    const auto row = [&](Eigen::Index position) { return weights.row(index[c.ids()[position]]); };
    out.setZero(count, cage);
    for (Eigen::Index r = first; r < std::min(first + count, map.direct); ++r) {
        out.row(r - first) = row(r);
        if (map.centred) out.row(r - first) -= mean_of[i];
    }
    for (const auto& entry : map.entries) {
        const Eigen::Index r = map.direct + entry.row;
        if (r >= first && r < first + count) out.row(r - first) += entry.value * row(entry.position);
    }
}

void CageSpaceSolver::State::choose_treatments(Constraints constraints) {
    constexpr Eigen::Index rows_of_block = 128;
    treatment.assign(constraints.size(), Treatment::rows);
    place_of.assign(constraints.size(), 0);
    groups.clear();
    moving.clear();
    first_row.assign(1, 0);
    blocks.assign(1, 0);
    for (std::size_t i = 0; i < constraints.size(); ++i) {
        const Constraint& c = *constraints[i];
        if (c.constant()) treatment[i] = Treatment::constant;
        else if (c.by_moments() && c.map().rows > cage / 2) {
            treatment[i] = Treatment::group;
            place_of[i] = groups.size();
            groups.emplace_back().constraint = i;
        } else {
            place_of[i] = moving.size();
            moving.push_back(i);
            first_row.push_back(first_row.back() + c.map().rows);
            if (first_row.back() - first_row[blocks.back()] >= rows_of_block) blocks.push_back(moving.size());
        }
    }
    if (blocks.back() != moving.size()) blocks.push_back(moving.size());
}

std::vector<Piece> CageSpaceSolver::State::pieces_of(Constraints constraints) const {
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i < constraints.size(); ++i) {
        const bool joins =
            !pieces.empty() && treatment[i] != Treatment::group && treatment[pieces.back().front().constraint] == treatment[i];
        Eigen::Index size = joins ? rows_in(pieces.back()) : rows_of_piece;
        const Eigen::Index rows = constraints[i]->map().rows;
        for (Eigen::Index first = 0; first < rows; first += rows_of_piece) {
            const Eigen::Index count = std::min(rows_of_piece, rows - first);
            if (size + count > rows_of_piece) {
                pieces.emplace_back();
                size = 0;
            }
            pieces.back().push_back({i, first, count});
            size += count;
        }
    }
    return pieces;
}

void CageSpaceSolver::State::take_means(Constraints constraints) {
    mean_of.assign(constraints.size(), {});
    parallel_for(constraints.size(), 16, [&](std::size_t i) {
        const Constraint& c = *constraints[i];
        if (!c.map().centred) return;
        Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(cage);
        for (Eigen::Index r = 0; r < c.map().direct; ++r) sum += weights.row(index[c.ids()[r]]);
        mean_of[i] = sum / static_cast<double>(c.map().direct);
    });
}

void CageSpaceSolver::State::clear_sums() {
    normal.setZero(cage, cage);
    constant_normal.setZero(cage, cage);
    constant_right.setZero(cage, 3);
    constant_objective = 0;
    stride = solver::padded(cage);
    m.setZero(first_row.back(), stride);
    r0.resize(3, first_row.back());
    parts.assign(blocks.size() - 1, Thin());
    part_objective.assign(parts.size(), 0.0);
}

Points CageSpaceSolver::State::start_group(Group& group, const Constraint& c) const {
    Points rows = rest_rows(c);
    group.m_m.setZero(cage, cage);
    group.m_r0.setZero(cage, 3);
    group.m_q.setZero(cage, 3);
    group.r0_r0 = rows * rows.transpose();
    group.r0_q = group.q_q = Matrix3d::Zero();
    if (c.reference().cols() > 0) {
        group.r0_q = rows * c.reference().transpose();
        group.q_q = c.reference() * c.reference().transpose();
    }
    return rows;
}

void CageSpaceSolver::State::sum_slice(const Constraint& c, const Slice& slice, const std::vector<Points>& group_rows,
                                       CageWeights& rows, Sum& sum) {
    const std::size_t i = slice.constraint;
    if (treatment[i] == Treatment::group) {
        const Points& own = group_rows[place_of[i]];
        sum.first += rows.transpose() * own.middleCols(slice.first, slice.count).transpose();
        if (c.reference().cols() > 0)
            sum.second += rows.transpose() * c.reference().middleCols(slice.first, slice.count).transpose();
        return;
    }
    const Points own = rest_rows(c);
    if (treatment[i] == Treatment::constant) {
        Points wanted(3, own.cols());
        c.project(own, wanted);
        const Points gap = (wanted - own).middleCols(slice.first, slice.count);
        sum.first += c.weight() * (rows.transpose() * gap.transpose());
        sum.objective += c.weight() * gap.squaredNorm();
        return;
    }
    const Eigen::Index to = first_row[place_of[i]] + slice.first;
    m.block(to, 0, slice.count, cage) = rows;
    r0.middleCols(to, slice.count) = own.middleCols(slice.first, slice.count);
    const Eigen::Index weighing = c.map().rows - c.map().observed - slice.first;
    if (weighing < slice.count) rows.bottomRows(slice.count - std::max<Eigen::Index>(weighing, 0)).setZero();
}

Sum CageSpaceSolver::State::sum_of(Constraints constraints, const Piece& piece, const std::vector<Points>& group_rows) {
    Sum sum;
    sum.first.setZero(cage, 3);
    sum.second.setZero(cage, 3);
    CageWeights stacked(rows_in(piece), cage), rows;
    Eigen::Index at = 0;
    for (const Slice& slice : piece) {
        const Constraint& c = *constraints[slice.constraint];
        weight_rows(c, slice.constraint, slice.first, slice.count, rows);
        sum_slice(c, slice, group_rows, rows, sum);
        const double scale = treatment[slice.constraint] == Treatment::group ? 1 : std::sqrt(c.weight());
        stacked.middleRows(at, slice.count) = scale * rows;
        at += slice.count;
    }
    sum.m_m.setZero(cage, cage);
    sum.m_m.selfadjointView<Eigen::Lower>().rankUpdate(stacked.transpose());
    return sum;
}

void CageSpaceSolver::State::add(const Sum& sum, std::size_t constraint) {
    const MatrixXd full = sum.m_m.selfadjointView<Eigen::Lower>();
    if (treatment[constraint] == Treatment::group) {
        Group& group = groups[place_of[constraint]];
        group.m_m += full;
        group.m_r0 += sum.first;
        group.m_q += sum.second;
        return;
    }
    normal += full;
    if (treatment[constraint] != Treatment::constant) return;
    constant_normal += full;
    constant_right += sum.first;
    constant_objective += sum.objective;
}

void CageSpaceSolver::State::form(Constraints constraints) {
    choose_treatments(constraints);
    take_means(constraints);
    clear_sums();
    std::vector<Points> group_rows;
    for (Group& group : groups) group_rows.push_back(start_group(group, *constraints[group.constraint]));
    // Pieces are processed in waves, so that their sums need little memory, and added in their order.
    const std::vector<Piece> pieces = pieces_of(constraints);
    for (std::size_t wave = 0; wave < pieces.size(); wave += pieces_of_wave) {
        std::vector<Sum> sums(std::min(pieces_of_wave, pieces.size() - wave));
        parallel_for(sums.size(), 1, [&](std::size_t k) { sums[k] = sum_of(constraints, pieces[wave + k], group_rows); });
        for (std::size_t k = 0; k < sums.size(); ++k) add(sums[k], pieces[wave + k].front().constraint);
    }
    for (const Group& group : groups) normal += constraints[group.constraint]->weight() * group.m_m;
    formed = true;
}

void CageSpaceSolver::State::add_constant(const Constraint& c, std::size_t i, double by_weight) {
    CageWeights rows;
    weight_rows(c, i, 0, c.map().rows, rows);
    const Points own = rest_rows(c);
    Points wanted(3, own.cols());
    c.project(own, wanted);
    constant_right += by_weight * (rows.transpose() * (wanted - own).transpose());
    constant_objective += by_weight * (wanted - own).squaredNorm();
}

void CageSpaceSolver::State::make_factor() {
    regularisation = 0;
    const double mean = cage > 0 ? normal.trace() / static_cast<double>(cage) : 0;
    factor.compute(normal);
    for (double share = min_regularisation; !factor.succeeded() || !(factor.rcond() > min_rcond); share *= 100) {
        if (share > 1e4)
            throw Error(ErrorKind::failure, "solver", "the system cannot be factorised", "bring weights closer to each other");
        regularisation = mean > 0 ? share * mean : 1.0;
        factor.compute(normal + regularisation * MatrixXd::Identity(cage, cage));
    }
    factored = true;
}

CageSpaceSolver::CageSpaceSolver(std::vector<std::unique_ptr<Constraint>> constraints, const CageWeights& weights,
                                 Points rest_cage)
    : Solver(std::move(constraints), rest_cage.cols(),
             rest_cage.cols() > 0 ? (rest_cage.rowwise().maxCoeff() - rest_cage.rowwise().minCoeff()).norm() : 0.0),
      state_(std::make_unique<State>()) {
    State& s = *state_;
    check_points(rest_cage, "rest points of the cage");
    if (weights.cols() != rest_cage.cols())
        fail_usage("the weights are of " + std::to_string(weights.cols()) + " cage points, and the cage has " +
                   std::to_string(rest_cage.cols()));
    s.rest = std::move(rest_cage);
    s.cage = s.rest.cols();
    s.index.assign(static_cast<std::size_t>(weights.rows()), -1);
    std::vector<Eigen::Index> used;
    for (const auto& c : constraints_)
        for (const int id : c->ids()) {
            if (id < 0 || id >= weights.rows())
                fail_usage("a constraint names point " + std::to_string(id) + ", which does not exist");
            if (s.index[id] >= 0) continue;
            s.index[id] = static_cast<int>(used.size());
            used.push_back(id);
        }
    s.weights.resize(static_cast<Eigen::Index>(used.size()), s.cage);
    s.rest_points.setZero(3, weights.rows());
    for (std::size_t k = 0; k < used.size(); ++k) {
        if (!weights.row(used[k]).allFinite()) fail_usage("the weights of point " + std::to_string(used[k]) + " are not finite");
        s.weights.row(static_cast<Eigen::Index>(k)) = weights.row(used[k]);
        s.rest_points.col(used[k]) = s.rest * weights.row(used[k]).transpose();
    }
}

CageSpaceSolver::~CageSpaceSolver() = default;

void CageSpaceSolver::initialize() {
    State& s = *state_;
    if (s.formed && s.factored) return;
    const Stopwatch watch;
    if (!s.formed) {
        s.form(constraints_);
        setup_.times.symbolic += watch.seconds();
    }
    const double before = watch.seconds();
    s.make_factor();
    setup_.times.factor += watch.seconds() - before;
    setup_.factor_entries = static_cast<double>(s.cage * s.cage);
    setup_.regularised = s.regularisation > 0;
    setup_.regularisation = s.regularisation;
    total_weight_ = rounding_ = 0;
    for (const auto& c : constraints_) total_weight_ += c->weight() * static_cast<double>(c->map().rows - c->map().observed);
    for (const Group& group : s.groups)
        rounding_ += 1e-15 * constraints_[group.constraint]->weight() * (group.r0_r0.trace() + group.q_q.trace());
    rounding_ += 1e-15 * s.constant_objective;
}

double CageSpaceSolver::project(const Points& cage) {
    State& s = *state_;
    const Thin d = (cage - s.rest).transpose();
    const std::size_t blocks = s.parts.size();
    Thin padded_d = Thin::Zero(s.stride, 3);
    padded_d.topRows(s.cage) = d;
    constexpr std::size_t groups_together = 8;  // a single group is too little work for a thread
    parallel_for(s.groups.size(), groups_together, [&](std::size_t k) {
        Group& g = s.groups[k];
        const Constraint& c = *constraints_[g.constraint];
        const Thin e = g.m_m * d;
        const Matrix3d cross = d.transpose() * g.m_r0;
        const Constraint::Moments moments{d.transpose() * e + cross + cross.transpose() + g.r0_r0,
                                          d.transpose() * g.m_q + g.r0_q};
        const auto p = c.project_moments(moments);
        g.right = c.weight() * ((e + g.m_r0) * p.of_rows.transpose() + g.m_q * p.of_reference.transpose() - g.m_r0);
        const Matrix3d left = Matrix3d::Identity() - p.of_rows;  // r - p = left r - of_reference q
        const double squared = (left * moments.rows * left.transpose()).trace() -
                               2 * (left * moments.reference * p.of_reference.transpose()).trace() +
                               (p.of_reference * g.q_q * p.of_reference.transpose()).trace();
        g.objective = c.weight() * std::max(squared, 0.0);
    });
    parallel_for(blocks, 1, [&](std::size_t k) {
        // One pass over the block's part of M, which stays in the cache between rows and sums.
        const Eigen::Index start = s.first_row[s.blocks[k]];
        Points rows = s.r0.middleCols(start, s.first_row[s.blocks[k + 1]] - start), wanted(3, rows.cols());
        const double* m = s.m.data() + start * s.stride;
        solver::add_rows(m, rows.cols(), s.stride, padded_d.data(), rows.data());
        double objective = 0;
        for (std::size_t i = s.blocks[k]; i < s.blocks[k + 1]; ++i) {
            const Constraint& c = *constraints_[s.moving[i]];
            const Eigen::Index first = s.first_row[i] - start, count = c.map().rows, weighing = count - c.map().observed;
            c.project(rows.middleCols(first, count), wanted.middleCols(first, count));
            objective += c.weight() * (rows - wanted).middleCols(first, weighing).squaredNorm();
            wanted.middleCols(first, weighing) =
                c.weight() * (wanted.middleCols(first, weighing) - s.r0.middleCols(start + first, weighing));
            wanted.middleCols(first + weighing, count - weighing).setZero();
        }
        s.parts[k].setZero(s.stride, 3);
        solver::add_sums(m, rows.cols(), s.stride, wanted.data(), s.parts[k].data());
        s.part_objective[k] = objective;
    });
    s.right = s.constant_right;
    double phi = std::max(s.constant_objective + (d.transpose() * (s.constant_normal * d - 2 * s.constant_right)).trace(), 0.0);
    for (std::size_t k = 0; k < blocks; ++k) {
        s.right += s.parts[k].topRows(s.cage);
        phi += s.part_objective[k];
    }
    for (const Group& g : s.groups) {
        s.right += g.right;
        phi += g.objective;
    }
    return phi;
}

void CageSpaceSolver::global_step(Points& cage) {
    State& s = *state_;
    const Thin d = s.factor.solve(s.right);
    cage = s.rest + d.transpose();
}

void CageSpaceSolver::weight_changed(std::size_t constraint, double before) {
    State& s = *state_;
    s.factored = false;
    if (!s.formed) return;
    const Constraint& c = *constraints_[constraint];
    const double change = c.weight() - before;
    if (s.treatment[constraint] == Treatment::group) {
        s.normal += change * s.groups[s.place_of[constraint]].m_m;
        return;
    }
    if (c.map().rows > rows_of_piece) {  // as expensive as forming all of it
        s.formed = false;
        return;
    }
    CageWeights rows;
    s.weight_rows(c, constraint, 0, c.map().rows, rows);
    rows.conservativeResize(c.map().rows - c.map().observed, s.cage);
    const MatrixXd m_m = rows.transpose() * rows;
    s.normal += change * m_m;
    if (s.treatment[constraint] == Treatment::constant) {
        s.constant_normal += change * m_m;
        s.add_constant(c, constraint, change);
    }
}

void CageSpaceSolver::target_changing(std::size_t constraint) {
    State& s = *state_;
    if (!s.formed || s.treatment[constraint] != Treatment::constant) return;
    s.add_constant(*constraints_[constraint], constraint, -constraints_[constraint]->weight());
}

void CageSpaceSolver::target_changed(std::size_t constraint) {
    State& s = *state_;
    if (!s.formed) return;
    if (s.treatment[constraint] == Treatment::constant)
        s.add_constant(*constraints_[constraint], constraint, constraints_[constraint]->weight());
    if (s.treatment[constraint] == Treatment::group) s.formed = s.factored = false;
}

}  // namespace ostraka
