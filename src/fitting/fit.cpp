#include "ostraka/fitting/fit.h"

#include "match_search.h"

#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/solver/solve.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>

namespace ostraka {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

class Stopwatch {
public:
    explicit Stopwatch(double& sum) : sum_(sum), begin_(std::chrono::steady_clock::now()) {}
    ~Stopwatch() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

private:
    double& sum_;
    std::chrono::steady_clock::time_point begin_;
};

/// The rest shape's neighbours of each vertex with their cotangent weights, and the area around it.
struct Rings {
    std::vector<std::size_t> begin;
    std::vector<int> neighbour;
    std::vector<double> weight;
    std::vector<double> area, sum;  ///< area around each vertex; sum of its weights
};

double cotangent(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const double sine = (a - c).cross(b - c).norm();
    return sine > 0 ? (a - c).dot(b - c) / sine : 0;
}

Rings rings_of(const Mesh& mesh, const Points& rest) {
    Rings rings;
    rings.area.assign(mesh.number_of_vertices(), 0);
    rings.sum.assign(mesh.number_of_vertices(), 0);
    for (const Face face : mesh.faces()) {
        const double area = face_area(mesh, face) / 3;
        for (const Vertex v : corners(mesh, face)) rings.area[v] += area;
    }
    for (const Vertex v : mesh.vertices()) {
        rings.begin.push_back(rings.neighbour.size());
        if (mesh.is_isolated(v)) continue;
        for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(v))) {
            const Vertex n = mesh.source(h);
            double weight = 0;
            for (const Halfedge side : {h, mesh.opposite(h)})
                if (!mesh.is_border(side))
                    weight += 0.5 * cotangent(rest.col(static_cast<Eigen::Index>(v)), rest.col(static_cast<Eigen::Index>(n)),
                                              rest.col(static_cast<Eigen::Index>(mesh.target(mesh.next(side)))));
            rings.neighbour.push_back(static_cast<int>(n.idx()));
            // Obtuse angles would make the displacement unstable; needles, the weights endless.
            rings.weight.push_back(std::clamp(weight, 0.05, 20.0));
            rings.sum[v] += rings.weight.back();
        }
    }
    rings.begin.push_back(rings.neighbour.size());
    return rings;
}

class Fitter {
public:
    Fitter(const Mesh& scaled, const AnnotationSet& set, const std::vector<PlacedFragment>& fragments,
           const NonRigidOptions& options)
        : mesh_(scaled), options_(options), diagonal_(box_diagonal(scaled)), search_(scaled, set, fragments) {
        rest_.resize(3, static_cast<Eigen::Index>(scaled.number_of_vertices()));
        for (const Vertex v : scaled.vertices()) rest_.col(static_cast<Eigen::Index>(v)) = eigen(scaled.point(v));
        now_ = rest_;
        rings_ = rings_of(scaled, rest_);
        double sum = 0;
        for (const double area : rings_.area) sum += area;
        mean_area_ = sum / static_cast<double>(std::max<std::size_t>(1, rings_.area.size()));
        guides_ = search_.guides();
    }

    NonRigidFit run() {
        NonRigidFit fit;
        make_solver();
        for (int level = 0; level < options_.levels; ++level) {
            const double t = options_.levels > 1 ? static_cast<double>(level) / (options_.levels - 1) : 1;
            const auto between = [&](double first, double last) { return first * std::pow(last / first, t); };
            NonRigidFit::Level record;
            record.smoothing = between(options_.start, options_.end) * diagonal_;
            const double reach = between(std::max(options_.reach, 1e-9), std::max(options_.last_reach, 1e-9)) * diagonal_;
            for (; record.steps < options_.steps; ++record.steps) {
                {
                    const Stopwatch watch(fit.seconds_matching);
                    matches_ = search_.matches(now_, mesh_, reach, std::cos(options_.angle * std::numbers::pi / 180));
                }
                const Stopwatch watch(fit.seconds_solving);
                const Points before = now_;
                solve(record.smoothing, record.steps == 0);
                const double change = (now_ - before).colwise().norm().maxCoeff();
                if (change < 0.05 * record.smoothing) {
                    ++record.steps;
                    break;
                }
            }
            double squares = 0;
            for (std::size_t i = 0; i < matches_.size(); ++i) {
                if (matches_[i].fragment < 0) continue;
                ++record.matched;
                squares += (now_.col(static_cast<Eigen::Index>(i)) - matches_[i].place).squaredNorm();
            }
            record.residual = record.matched > 0 ? std::sqrt(squares / static_cast<double>(record.matched)) : 0;
            fit.levels.push_back(record);
        }
        {
            const Stopwatch watch(fit.seconds_matching);
            fit.matches =
                search_.matches(now_, mesh_, options_.last_reach * diagonal_, std::cos(options_.angle * std::numbers::pi / 180));
        }
        for (Eigen::Index i = 0; i < now_.cols(); ++i) fit.points.push_back(point_of(now_.col(i)));
        return fit;
    }

private:
    /// For each vertex a match, a place to stay at and a Laplacian displacement; then the guides.
    void make_solver() {
        std::vector<std::unique_ptr<Constraint>> list;
        for (const Vertex v : mesh_.vertices()) {
            const int i = static_cast<int>(v.idx());
            ConstraintParameters here;
            here.target = rest_.col(i);
            match_.push_back(list.size());
            list.push_back(make_constraint("Closeness", {i}, 0, here, rest_));
            stay_.push_back(list.size());
            list.push_back(make_constraint("Closeness", {i}, 1, here, rest_));
            laplacian_.push_back(no_constraint);
            if (mesh_.is_isolated(v)) continue;
            std::vector<int> ids{i};
            ConstraintParameters ring;
            for (std::size_t k = rings_.begin[v]; k < rings_.begin[v + 1]; ++k) {
                ids.push_back(rings_.neighbour[k]);
                ring.coefficients.push_back(rings_.weight[k]);
            }
            laplacian_.back() = list.size();
            list.push_back(make_constraint("CotangentLaplacianDisplacement", std::move(ids), 1, ring, rest_));
        }
        for (const Guide& guide : guides_) {
            ConstraintParameters there;
            there.target = guide.place;
            guide_.push_back(list.size());
            list.push_back(make_constraint("Closeness", {static_cast<int>(guide.vertex)}, 1, there, rest_));
        }
        solver_ = std::make_unique<MeshSpaceSolver>(std::move(list), rest_);
    }

    /// Where few matches came or went since the weights were last set, they stay, and with them the factorisation: who lost its
    /// match is held where it is, who found one waits.
    [[nodiscard]] bool matched_as_before() const {
        std::size_t changed = 0;
        for (std::size_t i = 0; i < matches_.size(); ++i) changed += (matches_[i].fragment >= 0) != weighted_[i] ? 1 : 0;
        return static_cast<double>(changed) <= 0.02 * static_cast<double>(matches_.size());
    }

    void solve(double smoothing, bool new_level) {
        // In units of mean areas, and of lengths of the smoothing, so that weights are near one.
        const double transition = options_.stay * diagonal_;
        const double stay = std::pow(std::min(1.0, smoothing / transition), 4);
        turn();
        const bool renew = new_level || !matched_as_before();
        if (renew) weighted_.assign(matches_.size(), false);
        for (std::size_t i = 0; i < matches_.size(); ++i) {
            const bool matched = matches_[i].fragment >= 0;
            if (renew) {
                const double share = rings_.area[i] / mean_area_;
                weighted_[i] = matched;
                solver_->set_weight(match_[i], matched ? share : 0);
                solver_->set_weight(stay_[i], stay * std::max(share, 1e-6));
            }
            if (weighted_[i])
                solver_->set_target(match_[i],
                                    matched ? Points(matches_[i].place) : Points(now_.col(static_cast<Eigen::Index>(i))));
            if (laplacian_[i] == no_constraint) continue;
            solver_->set_target(laplacian_[i], displacement_.col(static_cast<Eigen::Index>(i)));
            if (!renew) continue;
            const double area = std::max(rings_.area[i], 1e-6 * mean_area_);
            solver_->set_weight(laplacian_[i], std::pow(smoothing, 4) * rings_.sum[i] * rings_.sum[i] / (area * mean_area_));
        }
        for (std::size_t g = 0; renew && g < guides_.size(); ++g) {
            // What a patch of the smoothing's size would weigh: of a landmark the whole, of an outline the share of its length.
            const double width = guides_[g].length > 0 ? guides_[g].length * smoothing : smoothing * smoothing;
            solver_->set_weight(guide_[g], options_.guides * std::max(width, 0.0) / mean_area_);
        }
        SolveOptions once;
        once.iterations = 1;
        once.window = 0;
        const SolveSummary summary = solver_->solve(now_, once);
        if (!summary.usable)
            throw Error(ErrorKind::failure, "fit", "no usable solution: " + summary.text(), "look at the template's faces");
    }

    /// Rest displacements turned with the surroundings of each vertex.
    void turn() {
        const auto n = static_cast<std::size_t>(rest_.cols());
        std::vector<Matrix3d> covariances(n);
        displacement_.setZero(3, rest_.cols());
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
            if (laplacian_[i] == no_constraint) return;
            Matrix3d sum = covariances[i];
            Vector3d rest = Vector3d::Zero();
            for (std::size_t k = rings_.begin[i]; k < rings_.begin[i + 1]; ++k) {
                const int j = rings_.neighbour[k];
                sum += covariances[static_cast<std::size_t>(j)];
                rest += rings_.weight[k] / rings_.sum[i] * (rest_.col(j) - rest_.col(static_cast<Eigen::Index>(i)));
            }
            const Eigen::JacobiSVD<Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
            Vector3d signs(1, 1, 1);
            if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs.z() = -1;
            displacement_.col(static_cast<Eigen::Index>(i)) =
                svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose() * rest;
        });
    }

    static constexpr std::size_t no_constraint = static_cast<std::size_t>(-1);

    const Mesh& mesh_;
    const NonRigidOptions& options_;
    double diagonal_, mean_area_ = 1;
    MatchSearch search_;
    Points rest_, now_, displacement_;
    Rings rings_;
    std::vector<Guide> guides_;
    std::vector<std::size_t> match_, stay_, laplacian_, guide_;
    std::unique_ptr<MeshSpaceSolver> solver_;
    std::vector<VertexMatch> matches_;
    std::vector<bool> weighted_;  ///< vertices whose match weighs in the factorisation
};

}  // namespace

NonRigidFit fit_template(const Mesh& scaled, const AnnotationSet& set, const std::vector<PlacedFragment>& fragments,
                         const NonRigidOptions& options) {
    check_options(options, "fit");
    if (scaled.number_of_faces() == 0) fail_input("template", "has no faces", "is it the right file?");
    return Fitter(scaled, set, fragments, options).run();
}

}  // namespace ostraka
