// The solver over the points themselves.
#include "ostraka/solver/solve.h"

#include "ostraka/core/stopwatch.h"
#include "ostraka/execution/parallel.h"
#include "solver/constraint_rows.h"
#include "solver/elimination.h"

#include <algorithm>
#include <map>
#include <span>

namespace ostraka {

namespace {

using solver::RowMatrix;

double diagonal_of(const Points& points) {
    if (points.cols() == 0) return 0;
    return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
}

/// The matrix counts as singular below this value (see SparseCholesky::reciprocal_condition).
constexpr double singular = 1e-14;
/// Initial weight of the rest shape in singular systems, as a share of the mean diagonal entry.
constexpr double first_regularisation = 1e-9;

}  // namespace

struct MeshSpaceSolver::State {
    Points rest;
    solver::Unknowns unknowns;
    std::vector<double> row_weight;
    RowMatrix columns;         ///< B^T of all rows
    RowMatrix moving_columns;  ///< B^T of the rows whose projection changes
    bool has_pattern = false, has_factor = false, has_constants = false;
    SparseCholesky cholesky;
    solver::Floating floating;
    std::vector<char> idle;
    double pin = 0, regularisation = 0, symbolic_seconds = 0;
    Points rows, projected;
    Eigen::MatrixXd constant_right, right;
    std::vector<std::size_t> blocks;  ///< blocks of constraints that are projected together: first of each, and the end

    // A few weights that changed since the factorisation: A + U S U^T by the Woodbury formula.
    std::map<std::size_t, double> factored_weight;  ///< constraint -> weight used in the factorisation
    bool updates_current = true;
    std::vector<std::size_t> updated_rows;
    Eigen::VectorXd update_sign, update_root;
    Eigen::MatrixXd update_columns;  ///< A^-1 U
    Eigen::PartialPivLU<Eigen::MatrixXd> capacity;

    std::vector<char> exact;  ///< constraints that are eliminated; empty: none
    solver::Elimination elimination;

    [[nodiscard]] double weight_of(const Constraint& constraint, std::size_t c) const {
        return !exact.empty() && exact[c] ? 0 : constraint.weight();
    }
    void eliminate(std::span<const std::unique_ptr<Constraint>> constraints);
    [[nodiscard]] bool holds_points_of(std::size_t constraint) const;
    bool update(std::span<const std::unique_ptr<Constraint>> constraints);
    void solve(Eigen::MatrixXd& x);
    void prepare(std::span<const std::unique_ptr<Constraint>> constraints);
    void renew_weights(std::span<const std::unique_ptr<Constraint>> constraints);
    void renew_constants(std::span<const std::unique_ptr<Constraint>> constraints);
    void add_right(const RowMatrix& by_column, Eigen::MatrixXd& sum) const;
    bool factorise();
};

void MeshSpaceSolver::State::prepare(std::span<const std::unique_ptr<Constraint>> constraints) {
    unknowns = solver::number_unknowns(constraints, rest.cols());
    columns = solver::transposed(unknowns.rows, unknowns.count);
    RowMatrix moving;
    for (std::size_t c = 0; c < constraints.size(); ++c)
        for (std::size_t r = unknowns.first_row[c]; r < unknowns.first_row[c + 1]; ++r) {
            if (!constraints[c]->constant())
                for (std::size_t k = unknowns.rows.begin[r]; k < unknowns.rows.begin[r + 1]; ++k) {
                    moving.unknown.push_back(unknowns.rows.unknown[k]);
                    moving.value.push_back(unknowns.rows.value[k]);
                }
            moving.begin.push_back(moving.unknown.size());
        }
    moving_columns = solver::transposed(moving, unknowns.count);
    rows.setZero(3, static_cast<Eigen::Index>(unknowns.rows.rows()));
    projected.setZero(3, rows.cols());
    constexpr std::size_t rows_of_block = 1024;
    blocks.assign(1, 0);
    for (std::size_t c = 0; c < constraints.size(); ++c)
        if (unknowns.first_row[c + 1] - unknowns.first_row[blocks.back()] >= rows_of_block || c + 1 == constraints.size())
            blocks.push_back(c + 1);
}

void MeshSpaceSolver::State::renew_weights(std::span<const std::unique_ptr<Constraint>> constraints) {
    row_weight.assign(unknowns.rows.rows(), 0.0);
    for (std::size_t c = 0; c < constraints.size(); ++c)
        std::fill_n(row_weight.data() + unknowns.first_row[c], unknowns.rows_of(c), weight_of(*constraints[c], c));
    floating = solver::floating_parts(unknowns, row_weight);
    idle.assign(static_cast<std::size_t>(unknowns.count), 0);
    for (const int i : floating.idle) idle[i] = 1;
}

/// A floating part is fixed at one of its points, which does not change the objective, and its mean is restored after each
/// solve.
bool MeshSpaceSolver::State::factorise() {
    LowerTriangle matrix = solver::normal_matrix(unknowns.rows, columns, row_weight);
    if (!has_pattern) {
        const Stopwatch watch;
        cholesky.analyse(matrix);
        symbolic_seconds = watch.seconds();
        has_pattern = true;
    }
    double sum = 0;
    for (int i = 0; i < unknowns.count; ++i) sum += matrix.valuePtr()[matrix.outerIndexPtr()[i]];
    const std::size_t active = static_cast<std::size_t>(unknowns.count) - floating.idle.size();
    const double mean = sum > 0 ? sum / static_cast<double>(active) : 1.0;
    pin = mean;
    const auto add_to_diagonal = [&](int i, double value) { matrix.valuePtr()[matrix.outerIndexPtr()[i]] += value; };
    for (const int i : floating.idle) add_to_diagonal(i, mean);
    for (const auto& part : floating.parts) add_to_diagonal(part.front(), pin);
    regularisation = 0;
    for (double share = first_regularisation; !cholesky.factor(matrix) || cholesky.reciprocal_condition() < singular;
         share *= 100) {
        if (share > 1)
            throw Error(ErrorKind::failure, "solver", "the system cannot be factorised", "bring weights closer to each other");
        const double wanted = share * mean;
        for (std::size_t i = 0; i < unknowns.point.size(); ++i) add_to_diagonal(static_cast<int>(i), wanted - regularisation);
        regularisation = wanted;
    }
    return regularisation == 0;
}

/// Returns false if too many rows have changed, or the update is ill-conditioned.
bool MeshSpaceSolver::State::update(std::span<const std::unique_ptr<Constraint>> constraints) {
    constexpr std::size_t max_rows = 24;
    updated_rows.clear();
    std::vector<double> change;
    for (const auto& [c, before] : factored_weight) {
        const Constraint& constraint = *constraints[c];
        std::fill_n(row_weight.data() + unknowns.first_row[c], unknowns.rows_of(c), constraint.weight());
        if (constraint.weight() == before) continue;
        // The set of fixed parts may have changed, too.
        if (constraint.weight() == 0 || before == 0 || static_cast<std::size_t>(constraint.map().rows) > max_rows) return false;
        for (std::size_t r = unknowns.first_row[c]; r < unknowns.first_row[c + 1]; ++r) {
            updated_rows.push_back(r);
            change.push_back(constraint.weight() - before);
        }
        if (updated_rows.size() > max_rows) return false;
    }
    const auto rank = static_cast<Eigen::Index>(updated_rows.size());
    update_sign.resize(rank);
    update_root.resize(rank);
    update_columns.setZero(unknowns.count, rank);
    for (Eigen::Index k = 0; k < rank; ++k) {
        const double d = change[static_cast<std::size_t>(k)];
        update_sign[k] = d < 0 ? -1 : 1;
        update_root[k] = std::sqrt(std::abs(d));
        const std::size_t r = updated_rows[static_cast<std::size_t>(k)];
        for (std::size_t e = unknowns.rows.begin[r]; e < unknowns.rows.begin[r + 1]; ++e)
            update_columns(unknowns.rows.unknown[e], k) += update_root[k] * unknowns.rows.value[e];
    }
    if (rank == 0) return true;
    cholesky.solve(update_columns);
    Eigen::MatrixXd small = update_sign.asDiagonal().toDenseMatrix();
    for (Eigen::Index k = 0; k < rank; ++k) {
        const std::size_t r = updated_rows[static_cast<std::size_t>(k)];
        for (std::size_t e = unknowns.rows.begin[r]; e < unknowns.rows.begin[r + 1]; ++e)
            small.row(k) += update_root[k] * unknowns.rows.value[e] * update_columns.row(unknowns.rows.unknown[e]);
    }
    // The update subtracts from the solution of the old factors; the size of this matrix bounds the digits lost.
    constexpr double max_lost = 1e3;
    if (!(small.cwiseAbs().maxCoeff() < max_lost)) return false;
    capacity.compute(small);
    return capacity.rcond() > 1 / max_lost;
}

void MeshSpaceSolver::State::solve(Eigen::MatrixXd& x) {
    cholesky.solve(x);
    const auto rank = static_cast<Eigen::Index>(updated_rows.size());
    if (rank == 0) return;
    Eigen::MatrixXd seen = Eigen::MatrixXd::Zero(rank, x.cols());
    for (Eigen::Index k = 0; k < rank; ++k) {
        const std::size_t r = updated_rows[static_cast<std::size_t>(k)];
        for (std::size_t e = unknowns.rows.begin[r]; e < unknowns.rows.begin[r + 1]; ++e)
            seen.row(k) += update_root[k] * unknowns.rows.value[e] * x.row(unknowns.rows.unknown[e]);
    }
    x.noalias() -= update_columns * capacity.solve(seen);
}

void MeshSpaceSolver::State::renew_constants(std::span<const std::unique_ptr<Constraint>> constraints) {
    parallel_for(constraints.size(), [&](std::size_t c) {
        if (!constraints[c]->constant()) return;
        const auto first = static_cast<Eigen::Index>(unknowns.first_row[c]), count = constraints[c]->map().rows;
        constraints[c]->project(rows.middleCols(first, count), projected.middleCols(first, count));
    });
    constant_right.setZero(unknowns.count, 3);
    // Rows whose projection changes do not contribute here.
    std::vector<char> constant(unknowns.rows.rows(), 0);
    for (std::size_t c = 0; c < constraints.size(); ++c)
        if (constraints[c]->constant()) std::fill_n(constant.data() + unknowns.first_row[c], unknowns.rows_of(c), 1);
    parallel_for(static_cast<std::size_t>(unknowns.count), [&](std::size_t i) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (std::size_t k = columns.begin[i]; k < columns.begin[i + 1]; ++k)
            if (constant[columns.unknown[k]])
                sum += (row_weight[columns.unknown[k]] * columns.value[k]) * projected.col(columns.unknown[k]);
        constant_right.row(static_cast<Eigen::Index>(i)) = sum.transpose();
    });
    for (std::size_t i = 0; i < unknowns.point.size(); ++i)
        constant_right.row(static_cast<Eigen::Index>(i)) += regularisation * rest.col(unknowns.point[i]).transpose();
    for (const auto& part : floating.parts)
        constant_right.row(part.front()) += pin * rest.col(unknowns.point[part.front()]).transpose();
}

void MeshSpaceSolver::State::add_right(const RowMatrix& by_column, Eigen::MatrixXd& sum) const {
    parallel_for(static_cast<std::size_t>(unknowns.count), [&](std::size_t i) {
        Eigen::Vector3d own = Eigen::Vector3d::Zero();
        for (std::size_t k = by_column.begin[i]; k < by_column.begin[i + 1]; ++k) {
            const int r = by_column.unknown[k];
            own += (row_weight[r] * by_column.value[k]) * projected.col(r);
        }
        sum.row(static_cast<Eigen::Index>(i)) += own.transpose();
    });
}

MeshSpaceSolver::MeshSpaceSolver(std::vector<std::unique_ptr<Constraint>> constraints, Points rest)
    : Solver(std::move(constraints), rest.cols(), diagonal_of(rest)), state_(std::make_unique<State>()) {
    check_points(rest, "rest points of the solver");
    state_->rest = std::move(rest);
    state_->prepare(constraints_);
}

MeshSpaceSolver::~MeshSpaceSolver() = default;

void MeshSpaceSolver::initialize() {
    State& s = *state_;
    const Stopwatch watch;
    if (s.has_factor && !s.updates_current) {
        s.has_factor = s.update(constraints_);
        s.updates_current = true;
        s.has_constants = false;
    }
    if (!s.has_factor) {
        s.factored_weight.clear();
        s.updated_rows.clear();
        s.renew_weights(constraints_);
        s.factorise();
        s.has_factor = true;
        s.has_constants = false;
        setup_.floating_parts = static_cast<int>(s.floating.parts.size());
        setup_.factor_entries = s.cholesky.entries();
        setup_.regularised = s.regularisation > 0;
        setup_.regularisation = s.regularisation;
    }
    if (!s.has_constants) {
        s.renew_constants(constraints_);
        s.has_constants = true;
        if (!s.exact.empty()) s.eliminate(constraints_);  // constants are recomputed whenever the matrix is
    }
    total_weight_ = 0;
    for (const double w : s.row_weight) total_weight_ += w;
    setup_.updated_rows = static_cast<int>(s.updated_rows.size());
    setup_.times.symbolic += s.symbolic_seconds;
    setup_.times.factor += watch.seconds() - s.symbolic_seconds;
    s.symbolic_seconds = 0;
}

double MeshSpaceSolver::project(const Points& points) {
    State& s = *state_;
    std::vector<double> parts(s.blocks.size() - 1, 0.0);
    parallel_for(parts.size(), 1, [&](std::size_t b) {
        Points rows;
        for (std::size_t c = s.blocks[b]; c < s.blocks[b + 1]; ++c) {
            const Constraint& constraint = *constraints_[c];
            const auto first = static_cast<Eigen::Index>(s.unknowns.first_row[c]);
            const Eigen::Index count = constraint.map().rows;
            constraint.rows_of(points, rows);
            if (!constraint.constant()) constraint.project(rows, s.projected.middleCols(first, count));
            if (const double weight = s.weight_of(constraint, c); weight > 0)
                parts[b] +=
                    weight *
                    (rows - s.projected.middleCols(first, count)).leftCols(count - constraint.map().observed).squaredNorm();
        }
    });
    double sum = 0;
    for (const double part : parts) sum += part;
    return sum;
}

void MeshSpaceSolver::global_step(Points& points) {
    State& s = *state_;
    s.right = s.constant_right;
    s.add_right(s.moving_columns, s.right);
    s.solve(s.right);
    if (!s.exact.empty()) s.right -= s.elimination.correction(s.right);
    for (const auto& part : s.floating.parts) {
        Eigen::RowVector3d shift = Eigen::RowVector3d::Zero();
        for (const int i : part) shift += s.rest.col(s.unknowns.point[i]).transpose() - s.right.row(i);
        shift /= static_cast<double>(part.size());
        for (const int i : part) s.right.row(i) += shift;
    }
    parallel_for(s.unknowns.point.size(), 4096, [&](std::size_t i) {
        if (!s.idle[i]) points.col(s.unknowns.point[i]) = s.right.row(static_cast<Eigen::Index>(i)).transpose();
    });
}

/// True if constraints of positive weight involve all points of this one.
bool MeshSpaceSolver::State::holds_points_of(std::size_t constraint) const {
    for (std::size_t r = unknowns.first_row[constraint]; r < unknowns.first_row[constraint + 1]; ++r)
        for (std::size_t e = unknowns.rows.begin[r]; e < unknowns.rows.begin[r + 1]; ++e)
            if (idle[static_cast<std::size_t>(unknowns.rows.unknown[e])]) return false;
    return true;
}

void MeshSpaceSolver::State::eliminate(std::span<const std::unique_ptr<Constraint>> constraints) {
    elimination = solver::Elimination(unknowns.count);
    for (std::size_t c = 0; c < constraints.size(); ++c) {
        if (!exact[c]) continue;
        const auto first = unknowns.first_row[c];
        elimination.add(unknowns.rows, first, *constraints[c]->given_components());
    }
    elimination.finish([&](Eigen::MatrixXd& x) { solve(x); });
}

bool MeshSpaceSolver::enforce(const std::vector<std::size_t>& constraints) {
    State& s = *state_;
    constexpr Eigen::Index most_rows = 256;
    Eigen::Index rows = 0;
    for (const std::size_t c : constraints) {
        if (!constraint(c).given_components()) return false;
        rows += constraint(c).map().rows;
    }
    if (rows > most_rows) return false;
    s.exact.assign(constraints_.size(), 0);
    for (const std::size_t c : constraints) s.exact[c] = 1;
    s.renew_weights(constraints_);
    const bool held = std::all_of(constraints.begin(), constraints.end(), [&](std::size_t c) { return s.holds_points_of(c); });
    s.has_factor = false;
    if (held && s.floating.parts.empty()) {
        initialize();
        if (s.regularisation == 0) return true;
    }
    s.exact.clear();
    s.has_factor = false;
    return false;
}

void MeshSpaceSolver::start(Points& points) {
    State& s = *state_;
    if (s.exact.empty()) return;
    Eigen::MatrixXd x = Eigen::MatrixXd::Zero(s.unknowns.count, 3);  // means occur in no eliminated row
    for (std::size_t i = 0; i < s.unknowns.point.size(); ++i)
        x.row(static_cast<Eigen::Index>(i)) = points.col(s.unknowns.point[i]).transpose();
    const Eigen::MatrixXd by = s.elimination.correction(x);
    for (std::size_t i = 0; i < s.unknowns.point.size(); ++i)
        points.col(s.unknowns.point[i]) -= by.row(static_cast<Eigen::Index>(i)).transpose();
}

void MeshSpaceSolver::weight_changed(std::size_t constraint, double before) {
    constexpr std::size_t many = 1000;  // limit for tracking changed weights individually
    if (!state_->has_factor) return;
    state_->factored_weight.emplace(constraint, before);
    state_->updates_current = false;
    if (state_->factored_weight.size() > many) state_->has_factor = false;
}

void MeshSpaceSolver::target_changed(std::size_t) { state_->has_constants = false; }

}  // namespace ostraka
