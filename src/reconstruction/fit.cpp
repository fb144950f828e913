#include "ostraka/reconstruction/fit.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/dense.h"

#include "level_system.h"
#include "match_search.h"

#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"
#include "ostraka/core/stopwatch.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/reconstruction/template_cage.h"
#include "ostraka/remesh/simplify.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// The levels of a fit on one mesh of the template.
class Fitter {
public:
    /// Lengths are in the template's unit. All arguments must outlive it.
    Fitter(LevelSystem& system, const MatchSearch& search, MatchSearch::Labels labels,
           std::vector<CorrespondenceConstraint> correspondences, double diagonal, const NonRigidOptions& options)
        : system_(system),
          mesh_(system.mesh),
          search_(search),
          labels_(std::move(labels)),
          correspondences_(system.mesh.number_of_vertices()),
          diagonal_(diagonal),
          options_(options),
          rest_(system.rest),
          now_(system.rest),
          rings_(system.rings) {
        for (CorrespondenceConstraint& correspondence : correspondences)
            correspondences_[correspondence.vertex].push_back(correspondence);
    }

    /// Solves for the vertices of a cage instead; `weights` must outlive it, one row per vertex.
    void go_through(const CageWeights& weights, const Points& cage) {
        weights_ = &weights;
        cage_rest_ = cage_ = cage;
    }
    [[nodiscard]] const Points& cage() const { return cage_; }

    void start_at(Points points) { now_ = std::move(points); }
    [[nodiscard]] const Points& rest() const { return rest_; }
    [[nodiscard]] const Points& now() const { return now_; }

    /// Smoothing length of a level.
    static double smoothing(const NonRigidOptions& options, int level, double diagonal) {
        return between(options, level, options.start, options.end) * diagonal;
    }

    void run(int first, int end, NonRigidFit& fit) {
        if (first == end) return;
        if (weights_ == nullptr) {
            const AddedSeconds watch(fit.seconds_solving);
            solver_ = &system_.renewed_solver();
        }
        for (int level = first; level < end; ++level) {
            NonRigidFit::Level record;
            record.vertices = mesh_.number_of_vertices();
            record.smoothing = smoothing(options_, level, diagonal_);
            const double search_radius =
                between(options_, level, std::max(options_.search_radius, 1e-9), std::max(options_.last_search_radius, 1e-9)) *
                diagonal_;
            for (; record.steps < options_.steps; ++record.steps) {
                match(search_radius, fit);
                const AddedSeconds watch(fit.seconds_solving);
                const Points before = now_;
                if (record.steps == 0) start_ = level == 0 ? rest_ : now_;
                solve(record.smoothing, level == 0 ? options_.stay * diagonal_ : options_.fade * record.smoothing,
                      record.steps == 0);
                const double change = (now_ - before).colwise().norm().maxCoeff();
                if (change < 0.05 * record.smoothing) {
                    ++record.steps;
                    break;
                }
            }
            take_residual(record);
            fit.levels.push_back(record);
        }
    }

    const std::vector<VertexMatch>& match(double search_radius, NonRigidFit& fit) {
        const AddedSeconds watch(fit.seconds_matching);
        const double min_cosine = std::cos(options_.angle * pi / 180);
        if (slides()) {
            matches_ = search_.sliding_matches(now_, mesh_, labels_, search_radius, min_cosine, slides_);
            return matches_;
        }
        matches_ = search_.matches(now_, mesh_, labels_, search_radius, min_cosine);
        if (options_.counterparts == NonRigidOptions::Counterparts::surface) return matches_;
        VertexAssignmentOptions options = options_.vertices;
        options.counterpart = options_.counterparts == NonRigidOptions::Counterparts::best
                                  ? VertexAssignmentOptions::Counterpart::best
                                  : VertexAssignmentOptions::Counterpart::one_to_one;
        options.search_radius = search_radius;
        options.angle = options_.angle;
        search_.assign(now_, mesh_, labels_, options, matches_);
        return matches_;
    }

    /// Point-to-plane steps in the unknowns of the cage (Chen and Medioni 1992), each of minimal length where vertices are
    /// matched: this approximates the surface as closely as the cage allows, unlike levels with smoothing. Unmatched vertices
    /// are held at their positions after the levels. Uses at most 4000 vertices, at equal steps.
    void polish(double search_radius, double smoothing, NonRigidFit& fit) {
        constexpr int max_steps = 12;
        constexpr double settled = 1e-10;  // share of the diagonal
        const Points left = now_;
        for (int step = 0; step < max_steps; ++step) {
            match(search_radius, fit);
            const AddedSeconds watch(fit.seconds_solving);
            const Points before = now_;
            if (!step_to_planes(left, smoothing)) return;
            if ((now_ - before).colwise().norm().maxCoeff() < settled * diagonal_) return;
        }
    }

    /// Rotation of each vertex's neighbourhood.
    [[nodiscard]] std::vector<Matrix3d> rotations() const {
        const auto n = static_cast<std::size_t>(rest_.cols());
        std::vector<Matrix3d> covariances(n), rotations(n);
        parallel_for(n, [&](std::size_t i) {
            Matrix3d sum = Matrix3d::Zero();
            for (std::size_t k = rings_.begin[i]; k < rings_.begin[i + 1]; ++k) {
                const int j = rings_.neighbour[k];
                sum += rings_.weight[k] * (now_.col(j) - now_.col(static_cast<Eigen::Index>(i))) *
                       (rest_.col(j) - rest_.col(static_cast<Eigen::Index>(i))).transpose();
            }
            covariances[i] = sum;
        });
        parallel_for(n, [&](std::size_t i) {
            Matrix3d sum = covariances[i];
            for (std::size_t k = rings_.begin[i]; k < rings_.begin[i + 1]; ++k)
                sum += covariances[static_cast<std::size_t>(rings_.neighbour[k])];
            const Svd3 svd(sum);
            Vector3d signs(1, 1, 1);
            if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs.z() = -1;
            rotations[i] = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
        });
        return rotations;
    }

private:
    /// False if the system has no solution.
    bool step_to_planes(const Points& left, double smoothing) {
        constexpr Eigen::Index rows_at_once = 512;
        const Eigen::Index count = cage_.cols(), stride = std::max<Eigen::Index>(1, now_.cols() / 4000),
                           n = (now_.cols() + stride - 1) / stride;
        Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(3 * count, 3 * count), same = Eigen::MatrixXd::Zero(count, count);
        Eigen::VectorXd right = Eigen::VectorXd::Zero(3 * count);
        for (Eigen::Index first = 0; first < n; first += rows_at_once) {
            const Eigen::Index rows = std::min(rows_at_once, n - first);
            Eigen::MatrixXd planes = Eigen::MatrixXd::Zero(3 * count, rows), places(count, rows);
            for (Eigen::Index r = 0; r < rows; ++r)
                add_plane((first + r) * stride, left, smoothing, planes.col(r), places.col(r), right);
            normal.selfadjointView<Eigen::Lower>().rankUpdate(planes);
            same.selfadjointView<Eigen::Lower>().rankUpdate(places);
        }
        for (int axis = 0; axis < 3; ++axis) normal.block(axis * count, axis * count, count, count) += same;
        normal.diagonal().array() += 1e-12 * normal.diagonal().mean();
        const Cholesky factor(normal);
        if (!factor.found()) return false;
        const Eigen::VectorXd change = factor.solve(right);
        if (!change.allFinite()) return false;
        for (int axis = 0; axis < 3; ++axis) cage_.row(axis) += change.segment(axis * count, count).transpose();
        now_ = points_of(*weights_, cage_);
        return true;
    }

    /// Contribution of a vertex to a point-to-plane step: to the plane of its match, and to the position where it is held.
    void add_plane(Eigen::Index v, const Points& left, double smoothing, Eigen::Ref<Eigen::VectorXd> plane_row,
                   Eigen::Ref<Eigen::VectorXd> place_row, Eigen::VectorXd& right) const {
        constexpr double hold = 0.1, shorten = 1e-6;  // weights relative to matches
        const Eigen::Index count = cage_.cols();
        const auto i = static_cast<std::size_t>(v);
        const Vector3d x = now_.col(v);
        const double area = std::max(rings_.area[i] / system_.mean_area, 1e-6);
        const VertexMatch& one = matches_[i];
        double weight = one.fragment < 0 ? hold * area : shorten * area;
        Vector3d pull = one.fragment < 0 ? Vector3d(weight * (left.col(v) - x)) : Vector3d::Zero();
        for (const CorrespondenceConstraint& correspondence : correspondences_[i]) {
            const double share = weight_of(correspondence, smoothing);
            weight += share;
            pull += share * (correspondence.place - x);
        }
        const auto w = weights_->row(v).transpose();
        place_row = std::sqrt(weight) * w;
        for (int axis = 0; axis < 3; ++axis) right.segment(axis * count, count) += pull[axis] * w;
        if (one.fragment < 0) return;
        const Vector3d plane = search_.normal(one);
        const double off = plane.dot(one.place - x);
        for (int axis = 0; axis < 3; ++axis) {
            plane_row.segment(axis * count, count) = std::sqrt(area) * plane[axis] * w;
            right.segment(axis * count, count) += area * off * plane[axis] * w;
        }
    }

    void take_residual(NonRigidFit::Level& record) const {
        double squares = 0;
        for (std::size_t i = 0; i < matches_.size(); ++i) {
            if (matches_[i].fragment < 0) continue;
            ++record.matched;
            squares += (now_.col(static_cast<Eigen::Index>(i)) - matches_[i].place).squaredNorm();
        }
        record.residual = record.matched > 0 ? std::sqrt(squares / static_cast<double>(record.matched)) : 0;
    }

    static double between(const NonRigidOptions& options, int level, double first, double last) {
        return first * std::pow(last / first, options.levels > 1 ? static_cast<double>(level) / (options.levels - 1) : 1);
    }

    /// If few matches changed since the weights were set, the weights and the factorisation are kept: vertices that lost their
    /// match are held, vertices that gained one wait.
    [[nodiscard]] bool matched_as_before() const {
        std::size_t changed = 0;
        for (std::size_t i = 0; i < matches_.size(); ++i) changed += (matches_[i].fragment >= 0) != weighted_[i] ? 1 : 0;
        return static_cast<double>(changed) <= 0.02 * static_cast<double>(matches_.size());
    }

    [[nodiscard]] bool slides() const { return options_.counterparts == NonRigidOptions::Counterparts::sliding; }

    /// Target of a matched vertex: the match itself, or the nearest position to which it may slide from there.
    [[nodiscard]] Vector3d goal_of(std::size_t i) const {
        constexpr double free = 0.95;  // the remainder pulls it back, so that unconstrained vertices do not drift
        const VertexMatch& match = matches_[i];
        if (!slides()) return match.place;
        return match.place + free * (slides_[i].free * (now_.col(static_cast<Eigen::Index>(i)) - match.place));
    }

    /// In units of the mean area: the vertex's area and, if a curve holds it, part of a strip along the curve, as for outlines.
    [[nodiscard]] double weight_of_match(std::size_t i, double smoothing) const {
        constexpr double curve = 0.5;
        double area = rings_.area[i];
        if (slides() && slides_[i].on_curve) area += curve * smoothing * std::sqrt(area);
        return area / system_.mean_area;
    }

    /// Sliding vertices take several solves to converge: each attracts them to the tangent planes from their current positions
    /// (a majorisation of the distance from the plane). In cage space a solve costs as much as a matching, and point-to-plane
    /// steps follow at the end.
    void solve(double smoothing, double transition, bool new_level) {
        constexpr int slides_at_once = 5;
        solve_once(smoothing, transition, new_level);
        if (!slides() || weights_ != nullptr) return;
        for (int k = 1; k < slides_at_once; ++k) solve_once(smoothing, transition, false);
    }

    void solve_once(double smoothing, double transition, bool new_level) {
        // In units of the mean area, and of the smoothing length, so that weights are near one.
        const double stay = std::pow(std::min(1.0, smoothing / transition), 4), mean_area = system_.mean_area;
        rotate_displacements();
        const bool renew = new_level || !matched_as_before();
        if (renew && weights_ != nullptr) {
            // With so many changes it is fastest to build the small matrix again.
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
                const double share = rings_.area[i] / mean_area;
                weighted_[i] = matched;
                match_weight_[i] = matched ? weight_of_match(i, smoothing) : 0;
                solver_->set_weight(system_.match(i), match_weight_[i] + correspondence_weight(i, smoothing));
                solver_->set_weight(system_.stay(i), stay * std::max(share, 1e-6));
                if (new_level || weights_ != nullptr)
                    solver_->set_target(system_.stay(i), start_.col(static_cast<Eigen::Index>(i)));
            }
            const Vector3d goal = matched ? goal_of(i) : Vector3d(now_.col(static_cast<Eigen::Index>(i)));
            if (!correspondences_[i].empty()) solver_->set_target(system_.match(i), Points(drawn_together(i, smoothing, goal)));
            else if (weighted_[i]) solver_->set_target(system_.match(i), Points(goal));
            if (system_.laplacian(i) == LevelSystem::no_constraint) continue;
            solver_->set_target(system_.laplacian(i), displacement_.col(static_cast<Eigen::Index>(i)));
            if (!renew) continue;
            const double area = std::max(rings_.area[i], 1e-6 * mean_area);
            solver_->set_weight(system_.laplacian(i),
                                std::pow(smoothing, 4) * rings_.sum[i] * rings_.sum[i] / (area * mean_area));
        }
        SolveOptions once;
        once.iterations = 1;
        once.window = 0;
        const SolveSummary summary = solver_->solve(weights_ != nullptr ? cage_ : now_, once);
        if (weights_ != nullptr) now_ = points_of(*weights_, cage_);
        if (!summary.usable)
            throw Error(ErrorKind::failure, "fit", "no usable solution: " + summary.text(), "look at the template's faces");
    }

    /// Weight of a patch of the size of the smoothing length: a landmark counts in full, an outline by its share of the length.
    [[nodiscard]] double weight_of(const CorrespondenceConstraint& correspondence, double smoothing) const {
        const double width = correspondence.length > 0 ? correspondence.length * smoothing : smoothing * smoothing;
        return options_.correspondences * width / system_.mean_area;
    }
    [[nodiscard]] double correspondence_weight(std::size_t vertex, double smoothing) const {
        double sum = 0;
        for (const CorrespondenceConstraint& correspondence : correspondences_[vertex])
            sum += weight_of(correspondence, smoothing);
        return sum;
    }
    /// Common target of a vertex's match and correspondences: a sum of squares about several points is one about their mean.
    [[nodiscard]] Vector3d drawn_together(std::size_t vertex, double smoothing, const Vector3d& match) const {
        double weight = match_weight_[vertex];
        Vector3d sum = weight * match;
        for (const CorrespondenceConstraint& correspondence : correspondences_[vertex]) {
            const double share = weight_of(correspondence, smoothing);
            sum += share * correspondence.place;
            weight += share;
        }
        return weight > 0 ? Vector3d(sum / weight) : match;
    }

    /// Rest displacements rotated and, for sliding vertices, scaled with the neighbourhood of each vertex.
    void rotate_displacements() {
        const std::vector<Matrix3d> rotation = rotations();
        const std::vector<double> scale = slides() ? local_scales(rings_, rest_, now_) : std::vector<double>(rotation.size(), 1);
        displacement_.setZero(3, rest_.cols());
        parallel_for(rotation.size(), [&](std::size_t i) {
            Vector3d rest = Vector3d::Zero();
            for (std::size_t k = rings_.begin[i]; k < rings_.begin[i + 1]; ++k)
                rest +=
                    rings_.weight[k] / rings_.sum[i] * (rest_.col(rings_.neighbour[k]) - rest_.col(static_cast<Eigen::Index>(i)));
            displacement_.col(static_cast<Eigen::Index>(i)) = scale[i] * (rotation[i] * rest);
        });
    }

    LevelSystem& system_;
    const Mesh& mesh_;
    const MatchSearch& search_;
    MatchSearch::Labels labels_;
    std::vector<std::vector<CorrespondenceConstraint>> correspondences_;  ///< per vertex
    double diagonal_;
    const NonRigidOptions& options_;
    const Points& rest_;
    Points now_, start_, displacement_;  ///< start: of the level
    const Rings& rings_;
    Solver* solver_ = nullptr;
    const CageWeights* weights_ = nullptr;  ///< in cage space
    Points cage_rest_, cage_;
    std::unique_ptr<CageSpaceSolver> through_cage_;
    std::vector<VertexMatch> matches_;
    std::vector<Slide> slides_;         ///< per match
    std::vector<bool> weighted_;        ///< vertices whose match has a weight in the factorisation
    std::vector<double> match_weight_;  ///< and its value
};

/// The simplified template, for smooth levels.
struct Coarse {
    Mesh mesh;
    std::vector<Index> vertex_map, face_origin;
};

Coarse coarsened(const Mesh& mesh, std::size_t vertices) {
    Coarse coarse{mesh, {}, {}};
    SimplifyOptions options;
    options.vertices = vertices;
    options.outlines = SimplifyOptions::Outlines::ignore;
    const SimplifyResult done = simplify(coarse.mesh, options);
    coarse.vertex_map = done.vertex_map;
    coarse.face_origin.resize(coarse.mesh.number_of_faces());
    for (Index f = 0; f < done.face_map.size(); ++f)
        if (done.face_map[f] != no_index) coarse.face_origin[done.face_map[f]] = f;
    return coarse;
}

/// Vertices that slide along the curves between parts need no positions along outlines.
MatchSearch::Guides guides_of(const NonRigidOptions& options) {
    if (!options.outlines) return MatchSearch::Guides::landmarks;
    return options.counterparts == NonRigidOptions::Counterparts::sliding ? MatchSearch::Guides::lines
                                                                          : MatchSearch::Guides::outlines;
}

constexpr std::size_t few = 4000;  // number of vertices that resolves the shapes of the first levels

}  // namespace

struct TemplateFitter::State {
    State(const Mesh& of, const AnnotationSet& with, const TemplateCage* around)
        : mesh(of), set(with), cage(around), diagonal(box_diagonal(of)), fine(of) {}

    /// Simplifies the template if it is large enough.
    void prepare() {
        if (coarse || mesh.number_of_vertices() <= 2 * few) return;
        coarse = std::make_unique<Coarse>(coarsened(mesh, few));
        smooth = std::make_unique<LevelSystem>(coarse->mesh);
        edge = mean_edge_length(coarse->mesh);
        const SurfaceSearch search(coarse->mesh);
        nearest.resize(mesh.number_of_vertices());
        parallel_for(nearest.size(),
                     [&](std::size_t i) { nearest[i] = search.closest(mesh.point(Vertex(static_cast<Index>(i)))); });
    }

    /// Coordinates of the vertices used in cage space levels.
    [[nodiscard]] const CageWeights& weights() {
        if (!coarse) return cage->coordinates.vertex;
        if (coarse_weights.size() == 0)
            coarse_weights = compute_coordinates(cage->coordinates.kind, cage->cage, coarse->mesh).vertex;
        return coarse_weights;
    }

    /// Moves the fine mesh with the neighbourhood of the nearest point of the coarse mesh.
    [[nodiscard]] Points follow(const Fitter& fitter) const {
        const std::vector<Matrix3d> rotations = fitter.rotations();
        Points points(3, static_cast<Eigen::Index>(mesh.number_of_vertices()));
        parallel_for(nearest.size(), [&](std::size_t i) {
            const Vector3d p = eigen(mesh.point(Vertex(static_cast<Index>(i))));
            const auto c = corners(coarse->mesh, Face(nearest[i].face));
            Vector3d sum = Vector3d::Zero();
            for (std::size_t k = 0; k < 3; ++k) {
                const auto v = static_cast<Eigen::Index>(c[k]);
                sum += nearest[i].barycentric[k] * (rotations[c[k]] * (p - fitter.rest().col(v)) + fitter.now().col(v));
            }
            points.col(static_cast<Eigen::Index>(i)) = sum;
        });
        return points;
    }

    /// On the coarse mesh, or on the template if there is none.
    [[nodiscard]] Fitter smooth_fitter(const MatchSearch& search, const NonRigidOptions& options) {
        std::vector<CorrespondenceConstraint> correspondences = search.correspondences();
        if (!coarse) return {fine, search, search.labels(mesh, {}), std::move(correspondences), diagonal, options};
        for (CorrespondenceConstraint& correspondence : correspondences) {
            const Index here = coarse->vertex_map[correspondence.vertex];
            if (here != no_index)
                correspondence.place +=
                    eigen(coarse->mesh.point(Vertex(here))) - eigen(mesh.point(Vertex(correspondence.vertex)));
            correspondence.vertex = here;
        }
        std::erase_if(correspondences, [&](const CorrespondenceConstraint& correspondence) {
            return correspondence.vertex >= coarse->mesh.number_of_vertices();
        });
        return {
            *smooth,  search, search.labels(coarse->mesh, coarse->face_origin, coarse->vertex_map), std::move(correspondences),
            diagonal, options};
    }

    /// Solves levels in cage space; returns the first level left for the template's vertices.
    int fit_cage(const MatchSearch& search, const NonRigidOptions& options, Fitter& exact, NonRigidFit& fit) {
        if (cage == nullptr) fail_usage("the fit is to go through a cage, and there is none", "give the cage of the template");
        const Points at_rest = columns_of(cage->cage);
        Fitter through = smooth_fitter(search, options);
        through.go_through(weights(), at_rest);
        const int level = options.space == NonRigidOptions::Space::both ? std::max(1, options.levels - 1) : options.levels;
        through.run(0, level, fit);
        exact.start_at(points_of(cage->coordinates.vertex, through.cage()));
        if (level == options.levels) {
            exact.go_through(cage->coordinates.vertex, through.cage());
            exact.polish(options.last_search_radius * diagonal, Fitter::smoothing(options, level - 1, diagonal), fit);
        }
        return level;
    }

    /// Solves the levels that are smooth on the coarse mesh; returns the first one that is not.
    int fit_coarse(const MatchSearch& search, const NonRigidOptions& options, Fitter& exact, NonRigidFit& fit) {
        constexpr double edges = 0.8;  // min smoothing length, in edges of the coarse mesh
        int level = 0;
        while (level < options.levels && Fitter::smoothing(options, level, diagonal) >= edges * edge) ++level;
        Fitter over = smooth_fitter(search, options);
        over.run(0, level, fit);
        const AddedSeconds watch(fit.seconds_coarsening);
        if (level > 0) exact.start_at(follow(over));
        return level;
    }

    const Mesh& mesh;
    const AnnotationSet& set;
    const TemplateCage* cage;
    double diagonal;
    LevelSystem fine;
    CageWeights coarse_weights;
    std::unique_ptr<Coarse> coarse;
    std::unique_ptr<LevelSystem> smooth;  ///< of the coarse mesh
    double edge = 0;                      ///< its mean edge length
    std::vector<SurfaceHit> nearest;      ///< per vertex, nearest point on it
};

TemplateFitter::TemplateFitter(const Mesh& mesh, const AnnotationSet& set, const TemplateCage* cage) {
    if (mesh.number_of_faces() == 0) fail_input("template", "has no faces", "is it the right file?");
    if (cage != nullptr) {
        if (cage->coordinates.has_normals())
            fail_usage(cage->coordinates.kind + " coordinates have a normal term, which a fit cannot use",
                       "take mean-value coordinates");
        if (static_cast<std::size_t>(cage->coordinates.vertex.rows()) != mesh.number_of_vertices() ||
            static_cast<std::size_t>(cage->coordinates.vertex.cols()) != cage->cage.number_of_vertices())
            fail_usage("the cage's coordinates are not those of the template's vertices", "make them anew");
    }
    state_ = std::make_unique<State>(mesh, set, cage);
}
TemplateFitter::~TemplateFitter() = default;
TemplateFitter::TemplateFitter(TemplateFitter&&) noexcept = default;

NonRigidFit TemplateFitter::fit(double scale, const std::vector<PlacedFragment>& fragments, const NonRigidOptions& options) {
    check_options(options, "fit");
    if ((options.counterparts == NonRigidOptions::Counterparts::best ||
         options.counterparts == NonRigidOptions::Counterparts::one_to_one) &&
        !(options.vertices.boundary + options.vertices.distance + options.vertices.outline > 0))
        fail_usage("all three weights of equation 5.1 are zero", "give --distance-weight or another one");
    State& s = *state_;
    NonRigidFit fit;
    const bool slides = options.counterparts == NonRigidOptions::Counterparts::sliding;
    MatchSearch search(s.mesh, s.set, fragments, scale, guides_of(options));
    if (slides) search.recognise_shared_faces();
    {
        const AddedSeconds watch(fit.seconds_coarsening);
        s.prepare();
    }
    Fitter fine(s.fine, search, search.labels(s.mesh, {}), search.correspondences(), s.diagonal, options);
    int level = 0;
    if (options.space != NonRigidOptions::Space::mesh) level = s.fit_cage(search, options, fine, fit);
    else if (s.coarse) level = s.fit_coarse(search, options, fine, fit);
    fine.run(level, options.levels, fit);
    fit.matches = fine.match(options.last_search_radius * s.diagonal, fit);
    // Converts from the template's unit.
    for (VertexMatch& match : fit.matches) {
        match.place *= scale;
        match.distance *= scale;
    }
    for (NonRigidFit::Level& one : fit.levels) {
        one.smoothing *= scale;
        one.residual *= scale;
    }
    for (Eigen::Index i = 0; i < fine.now().cols(); ++i) fit.points.push_back(point_of(scale * fine.now().col(i)));
    return fit;
}

NonRigidFit fit_template(const Mesh& scaled, const AnnotationSet& set, const std::vector<PlacedFragment>& fragments,
                         const NonRigidOptions& options) {
    return TemplateFitter(scaled, set).fit(1, fragments, options);
}

void NonRigidOptions::describe(OptionList& visit) {
    visit("space", space,
          "what is solved for: the template's vertices (mesh), those of a cage around it (cage: fewer degrees of freedom, no "
          "face "
          "folds by noise), or those of the cage and in the last level the template's (both)",
          Choices{"mesh", "cage", "both"});
    visit("smoothing", start, "length below which the first level fits no detail", Range{1e-3, 10},
          "share of the template's diagonal");
    visit("detail", end, "the same of the last level", Range{1e-4, 10});
    visit("levels", levels, "levels of stiffness", Range{1, 100});
    visit("steps", steps, "matches and solutions in each level, at most", Range{1, 1000});
    visit("transition", stay, "length over which the deformation of the first level fades where nothing is observed",
          Range{1e-3, 1e3}, "share of the diagonal");
    visit("fade", fade, "what a later level adds fades over so many of its smoothing lengths", Range{0.1, 1e3});
    visit("reach", search_radius, "farthest match in the first level", Range{0, 10}, "share of the diagonal");
    visit("last-reach", last_search_radius, "farthest match in the last level", Range{0, 10});
    visit("match-angle", angle, "normals of matches differ by at most this", Range{0, 180}, "degrees");
    visit("counterparts", counterparts,
          "of vertices: places of the surface from which they may slide along it, and along the curves between parts (sliding); "
          "the closest places (surface); or in matched annotations vertices by distance, outline and position along it (equation "
          "5.1): the best of each (best), or each given once (one-to-one)",
          Choices{"sliding", "surface", "best", "one-to-one"});
    visit("boundary-weight", vertices.boundary, "equation 5.1: of vertices on an outline against vertices inside", Range{0, 1e6});
    visit("distance-weight", vertices.distance, "equation 5.1: of the distance", Range{0, 1e6});
    visit("outline-weight", vertices.outline, "equation 5.1: of the positions along the outline", Range{0, 1e6});
    visit("guides", correspondences, "weight of matched outlines and landmarks against that of the surface", Range{0, 1e6});
    visit(
        "outlines", outlines,
        "matched lines, and outlines unless vertices slide, guide the fit by the position along them, from landmark to landmark",
        Anything{});
}

}  // namespace ostraka
