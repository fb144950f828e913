#include "reconstruction/fitter.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/core/stopwatch.h"
#include "ostraka/execution/parallel.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

Fitter::Fitter(LevelSystem& system, const MatchSearch& search, MatchSearch::Labels labels,
               const std::vector<CorrespondenceConstraint>& correspondences, double diagonal, const NonRigidOptions& options)
    : system_(system),
      mesh_(system.mesh),
      search_(search),
      labels_(std::move(labels)),
      correspondences_(system.mesh.number_of_vertices()),
      diagonal_(diagonal),
      options_(options),
      rest_(system.rest),
      current_(system.rest),
      rings_(system.rings) {
    for (const CorrespondenceConstraint& correspondence : correspondences)
        correspondences_[correspondence.vertex].push_back(correspondence);
}

void Fitter::use_cage(const CageWeights& weights, const Points& cage) {
    weights_ = &weights;
    cage_rest_ = cage_ = cage;
}

double Fitter::smoothing(const NonRigidOptions& options, int level, double diagonal) {
    return interpolated(options, level, options.start, options.end) * diagonal;
}

void Fitter::run(int first, int end, NonRigidFit& fit) {
    if (first == end) return;
    if (weights_ == nullptr) {
        const ScopedSeconds watch(fit.seconds_solving);
        solver_ = &system_.renewed_solver();
    }
    for (int level = first; level < end; ++level) {
        NonRigidFit::Level record;
        record.vertices = mesh_.number_of_vertices();
        record.smoothing = smoothing(options_, level, diagonal_);
        const double search_radius =
            interpolated(options_, level, std::max(options_.search_radius, 1e-9), std::max(options_.last_search_radius, 1e-9)) *
            diagonal_;
        for (; record.steps < options_.steps; ++record.steps) {
            match(search_radius, fit);
            const ScopedSeconds watch(fit.seconds_solving);
            const Points before = current_;
            if (record.steps == 0) start_ = level == 0 ? rest_ : current_;
            solve(record.smoothing,
                  level == 0 ? options_.first_decay_length * diagonal_ : options_.later_decay_lengths * record.smoothing,
                  record.steps == 0);
            const double change = (current_ - before).colwise().norm().maxCoeff();
            if (change < 0.05 * record.smoothing) {
                ++record.steps;
                break;
            }
        }
        record_residual(record);
        fit.levels.push_back(record);
    }
}

const std::vector<VertexMatch>& Fitter::match(double search_radius, NonRigidFit& fit) {
    const ScopedSeconds watch(fit.seconds_matching);
    const double min_cosine = std::cos(options_.angle * pi / 180);
    if (slides()) {
        matches_ = search_.sliding_matches(current_, mesh_, labels_, search_radius, min_cosine, slides_);
        return matches_;
    }
    matches_ = search_.matches(current_, mesh_, labels_, search_radius, min_cosine);
    if (options_.counterparts == NonRigidOptions::Counterparts::surface) return matches_;
    VertexAssignmentOptions options = options_.vertices;
    options.counterpart = options_.counterparts == NonRigidOptions::Counterparts::best
                              ? VertexAssignmentOptions::Counterpart::best
                              : VertexAssignmentOptions::Counterpart::one_to_one;
    options.search_radius = search_radius;
    options.angle = options_.angle;
    search_.assign(current_, mesh_, labels_, options, matches_);
    return matches_;
}

void Fitter::polish(double search_radius, double smoothing, NonRigidFit& fit) {
    constexpr int max_steps = 12;
    constexpr double min_change = 1e-10;  // share of the diagonal
    const Points level_points = current_;
    for (int step = 0; step < max_steps; ++step) {
        match(search_radius, fit);
        const ScopedSeconds watch(fit.seconds_solving);
        const Points before = current_;
        if (!step_to_planes(level_points, smoothing)) return;
        if ((current_ - before).colwise().norm().maxCoeff() < min_change * diagonal_) return;
    }
}

bool Fitter::step_to_planes(const Points& level_points, double smoothing) {
    constexpr Eigen::Index rows_at_once = 512;
    const Eigen::Index count = cage_.cols(), stride = std::max<Eigen::Index>(1, current_.cols() / 4000),
                       n = (current_.cols() + stride - 1) / stride;
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(3 * count, 3 * count), place_products = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(3 * count);
    for (Eigen::Index first = 0; first < n; first += rows_at_once) {
        const Eigen::Index rows = std::min(rows_at_once, n - first);
        Eigen::MatrixXd planes = Eigen::MatrixXd::Zero(3 * count, rows), places(count, rows);
        for (Eigen::Index r = 0; r < rows; ++r)
            add_plane((first + r) * stride, level_points, smoothing, planes.col(r), places.col(r), right);
        normal.selfadjointView<Eigen::Lower>().rankUpdate(planes);
        place_products.selfadjointView<Eigen::Lower>().rankUpdate(places);
    }
    for (int axis = 0; axis < 3; ++axis) normal.block(axis * count, axis * count, count, count) += place_products;
    normal.diagonal().array() += 1e-12 * normal.diagonal().mean();
    const Cholesky factor(normal);
    if (!factor.succeeded()) return false;
    const Eigen::VectorXd change = factor.solve(right);
    if (!change.allFinite()) return false;
    for (int axis = 0; axis < 3; ++axis) cage_.row(axis) += change.segment(axis * count, count).transpose();
    current_ = points_of(*weights_, cage_);
    return true;
}

void Fitter::add_plane(Eigen::Index v, const Points& level_points, double smoothing, Eigen::Ref<Eigen::VectorXd> plane_row,
                       Eigen::Ref<Eigen::VectorXd> place_row, Eigen::VectorXd& right) const {
    constexpr double hold_weight = 0.1, damping = 1e-6;  // weights against matches
    const Eigen::Index count = cage_.cols();
    const auto i = static_cast<std::size_t>(v);
    const Vector3d x = current_.col(v);
    const double area = std::max(rings_.area[i] / system_.mean_area, 1e-6);
    const VertexMatch& match = matches_[i];
    double weight = match.fragment < 0 ? hold_weight * area : damping * area;
    Vector3d pull = match.fragment < 0 ? Vector3d(weight * (level_points.col(v) - x)) : Vector3d::Zero();
    for (const CorrespondenceConstraint& correspondence : correspondences_[i]) {
        const double term_weight = weight_of(correspondence, smoothing);
        weight += term_weight;
        pull += term_weight * (correspondence.place - x);
    }
    const auto w = weights_->row(v).transpose();
    place_row = std::sqrt(weight) * w;
    for (int axis = 0; axis < 3; ++axis) right.segment(axis * count, count) += pull[axis] * w;
    if (match.fragment < 0) return;
    const Vector3d plane = search_.normal(match);
    const double distance = plane.dot(match.place - x);
    for (int axis = 0; axis < 3; ++axis) {
        plane_row.segment(axis * count, count) = std::sqrt(area) * plane[axis] * w;
        right.segment(axis * count, count) += area * distance * plane[axis] * w;
    }
}

void Fitter::record_residual(NonRigidFit::Level& record) const {
    double squares = 0;
    for (std::size_t i = 0; i < matches_.size(); ++i) {
        if (matches_[i].fragment < 0) continue;
        ++record.matched;
        squares += (current_.col(static_cast<Eigen::Index>(i)) - matches_[i].place).squaredNorm();
    }
    record.residual = record.matched > 0 ? std::sqrt(squares / static_cast<double>(record.matched)) : 0;
}

double Fitter::interpolated(const NonRigidOptions& options, int level, double first, double last) {
    return first * std::pow(last / first, options.levels > 1 ? static_cast<double>(level) / (options.levels - 1) : 1);
}

bool Fitter::matches_unchanged() const {
    std::size_t changed = 0;
    for (std::size_t i = 0; i < matches_.size(); ++i) changed += (matches_[i].fragment >= 0) != weighted_[i] ? 1 : 0;
    return static_cast<double>(changed) <= 0.02 * static_cast<double>(matches_.size());
}

Vector3d Fitter::target_of(std::size_t i) const {
    constexpr double slide_share = 0.95;  // the rest attracts it back, so that unconstrained vertices do not drift
    const VertexMatch& match = matches_[i];
    if (!slides()) return match.place;
    return match.place + slide_share * (slides_[i].free * (current_.col(static_cast<Eigen::Index>(i)) - match.place));
}

double Fitter::weight_of_match(std::size_t i, double smoothing) const {
    constexpr double curve_weight = 0.5;
    double area = rings_.area[i];
    if (slides() && slides_[i].on_curve) area += curve_weight * smoothing * std::sqrt(area);
    return area / system_.mean_area;
}

void Fitter::solve(double smoothing, double transition, bool new_level) {
    constexpr int slides_at_once = 5;
    solve_once(smoothing, transition, new_level);
    if (!slides() || weights_ != nullptr) return;
    for (int k = 1; k < slides_at_once; ++k) solve_once(smoothing, transition, false);
}

void Fitter::solve_once(double smoothing, double transition, bool new_level) {
    // In units of mean areas, and of lengths of the smoothing, so that weights are near one.
    const double stay = std::pow(std::min(1.0, smoothing / transition), 4), mean_area = system_.mean_area;
    rotate_displacements();
    const bool renew = new_level || !matches_unchanged();
    if (renew && weights_ != nullptr) {
        // With so many changes the small matrix is rebuilt.
        through_cage_ = std::make_unique<CageSpaceSolver>(system_.constraints(), *weights_, cage_rest_);
        solver_ = through_cage_.get();
    }
    if (renew) {
        weighted_.assign(matches_.size(), false);
        match_weight_.assign(matches_.size(), 0);
    }
    for (std::size_t i = 0; i < matches_.size(); ++i) {
        const bool matched = matches_[i].fragment >= 0;
        if (renew) {
            const double relative_area = rings_.area[i] / mean_area;
            weighted_[i] = matched;
            match_weight_[i] = matched ? weight_of_match(i, smoothing) : 0;
            solver_->set_weight(system_.match(i), match_weight_[i] + correspondence_weight(i, smoothing));
            solver_->set_weight(system_.stay(i), stay * std::max(relative_area, 1e-6));
            if (new_level || weights_ != nullptr) solver_->set_target(system_.stay(i), start_.col(static_cast<Eigen::Index>(i)));
        }
        const Vector3d target = matched ? target_of(i) : Vector3d(current_.col(static_cast<Eigen::Index>(i)));
        if (!correspondences_[i].empty()) solver_->set_target(system_.match(i), Points(combined_target(i, smoothing, target)));
        else if (weighted_[i]) solver_->set_target(system_.match(i), Points(target));
        if (system_.laplacian(i) == LevelSystem::no_constraint) continue;
        solver_->set_target(system_.laplacian(i), displacement_.col(static_cast<Eigen::Index>(i)));
        if (!renew) continue;
        const double area = std::max(rings_.area[i], 1e-6 * mean_area);
        solver_->set_weight(system_.laplacian(i), std::pow(smoothing, 4) * rings_.sum[i] * rings_.sum[i] / (area * mean_area));
    }
    SolveOptions single_step;
    single_step.iterations = 1;
    single_step.window = 0;
    const SolveSummary summary = solver_->solve(weights_ != nullptr ? cage_ : current_, single_step);
    if (weights_ != nullptr) current_ = points_of(*weights_, cage_);
    if (!summary.usable)
        throw Error(ErrorKind::failure, "fit", "no usable solution: " + summary.text(), "check the template's faces");
}

double Fitter::weight_of(const CorrespondenceConstraint& correspondence, double smoothing) const {
    constexpr double coarse = 0.1;  // of the diagonal
    if (slides() && correspondence.outline && smoothing < coarse * diagonal_) return 0;
    const double width = correspondence.length > 0 ? correspondence.length * smoothing : smoothing * smoothing;
    return options_.correspondences * width / system_.mean_area;
}

double Fitter::correspondence_weight(std::size_t vertex, double smoothing) const {
    double sum = 0;
    for (const CorrespondenceConstraint& correspondence : correspondences_[vertex]) sum += weight_of(correspondence, smoothing);
    return sum;
}

Vector3d Fitter::combined_target(std::size_t vertex, double smoothing, const Vector3d& match) const {
    double weight = match_weight_[vertex];
    Vector3d sum = weight * match;
    for (const CorrespondenceConstraint& correspondence : correspondences_[vertex]) {
        const double term_weight = weight_of(correspondence, smoothing);
        sum += term_weight * correspondence.place;
        weight += term_weight;
    }
    return weight > 0 ? Vector3d(sum / weight) : match;
}

void Fitter::rotate_displacements() {
    const std::vector<Matrix3d> rotation = rotations();
    std::vector<double> scale(rotation.size(), 1);
    if (slides()) {
        std::vector<bool> observed(rotation.size());
        for (std::size_t i = 0; i < observed.size(); ++i) observed[i] = matches_[i].fragment >= 0;
        scale = local_scales(rings_, rest_, current_, observed);
    }
    displacement_.setZero(3, rest_.cols());
    parallel_for(rotation.size(), [&](std::size_t i) {
        Vector3d rest = Vector3d::Zero();
        for (std::size_t k = rings_.begin[i]; k < rings_.begin[i + 1]; ++k)
            rest += rings_.weight[k] / rings_.sum[i] * (rest_.col(rings_.neighbour[k]) - rest_.col(static_cast<Eigen::Index>(i)));
        displacement_.col(static_cast<Eigen::Index>(i)) = scale[i] * (rotation[i] * rest);
    });
}

}  // namespace ostraka
