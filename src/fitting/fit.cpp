#include "ostraka/fitting/fit.h"

#include "match_search.h"

#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/remesh/simplify.h"
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

/// The levels of a fit over one mesh of the template.
class Fitter {
public:
    /// `scale` is the template's diagonal. All outlive it.
    Fitter(const Mesh& mesh, const MatchSearch& search, MatchSearch::Labels labels, std::vector<Guide> guides, double diagonal,
           const NonRigidOptions& options)
        : mesh_(mesh),
          search_(search),
          labels_(std::move(labels)),
          guides_(std::move(guides)),
          diagonal_(diagonal),
          options_(options) {
        rest_.resize(3, static_cast<Eigen::Index>(mesh.number_of_vertices()));
        for (const Vertex v : mesh.vertices()) rest_.col(static_cast<Eigen::Index>(v)) = eigen(mesh.point(v));
        now_ = rest_;
        rings_ = rings_of(mesh, rest_);
        double sum = 0;
        for (const double area : rings_.area) sum += area;
        mean_area_ = sum / static_cast<double>(std::max<std::size_t>(1, rings_.area.size()));
    }

    void start_at(Points points) { now_ = std::move(points); }
    [[nodiscard]] const Points& rest() const { return rest_; }
    [[nodiscard]] const Points& now() const { return now_; }

    /// Smoothing length of a level.
    static double smoothing(const NonRigidOptions& options, int level, double diagonal) {
        return between(options, level, options.start, options.end) * diagonal;
    }

    void run(int first, int end, NonRigidFit& fit) {
        if (first == end) return;
        if (!solver_) {
            const Stopwatch watch(fit.seconds_solving);
            make_solver();
        }
        for (int level = first; level < end; ++level) {
            NonRigidFit::Level record;
            record.vertices = mesh_.number_of_vertices();
            record.smoothing = smoothing(options_, level, diagonal_);
            const double reach =
                between(options_, level, std::max(options_.reach, 1e-9), std::max(options_.last_reach, 1e-9)) * diagonal_;
            for (; record.steps < options_.steps; ++record.steps) {
                match(reach, fit);
                const Stopwatch watch(fit.seconds_solving);
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
            double squares = 0;
            for (std::size_t i = 0; i < matches_.size(); ++i) {
                if (matches_[i].fragment < 0) continue;
                ++record.matched;
                squares += (now_.col(static_cast<Eigen::Index>(i)) - matches_[i].place).squaredNorm();
            }
            record.residual = record.matched > 0 ? std::sqrt(squares / static_cast<double>(record.matched)) : 0;
            fit.levels.push_back(record);
        }
    }

    const std::vector<VertexMatch>& match(double reach, NonRigidFit& fit) {
        const Stopwatch watch(fit.seconds_matching);
        matches_ = search_.matches(now_, mesh_, labels_, reach, std::cos(options_.angle * std::numbers::pi / 180));
        if (options_.counterparts == "surface") return matches_;
        VertexAssignmentOptions options = options_.vertices;
        options.counterpart = options_.counterparts;
        options.reach = reach;
        options.angle = options_.angle;
        search_.assign(now_, mesh_, labels_, options, matches_);
        return matches_;
    }

    /// How the surroundings of each vertex have turned.
    [[nodiscard]] std::vector<Matrix3d> turns() const {
        const auto n = static_cast<std::size_t>(rest_.cols());
        std::vector<Matrix3d> covariances(n), turns(n);
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
            const Eigen::JacobiSVD<Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
            Vector3d signs(1, 1, 1);
            if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs.z() = -1;
            turns[i] = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
        });
        return turns;
    }

private:
    static double between(const NonRigidOptions& options, int level, double first, double last) {
        return first * std::pow(last / first, options.levels > 1 ? static_cast<double>(level) / (options.levels - 1) : 1);
    }

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

    void solve(double smoothing, double transition, bool new_level) {
        // In units of mean areas, and of lengths of the smoothing, so that weights are near one.
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
                if (new_level) solver_->set_target(stay_[i], start_.col(static_cast<Eigen::Index>(i)));
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
        const std::vector<Matrix3d> turned = turns();
        displacement_.setZero(3, rest_.cols());
        parallel_for(turned.size(), [&](std::size_t i) {
            Vector3d rest = Vector3d::Zero();
            for (std::size_t k = rings_.begin[i]; k < rings_.begin[i + 1]; ++k)
                rest +=
                    rings_.weight[k] / rings_.sum[i] * (rest_.col(rings_.neighbour[k]) - rest_.col(static_cast<Eigen::Index>(i)));
            displacement_.col(static_cast<Eigen::Index>(i)) = turned[i] * rest;
        });
    }

    static constexpr std::size_t no_constraint = static_cast<std::size_t>(-1);

    const Mesh& mesh_;
    const MatchSearch& search_;
    MatchSearch::Labels labels_;
    std::vector<Guide> guides_;
    double diagonal_, mean_area_ = 1;
    const NonRigidOptions& options_;
    Points rest_, start_, now_, displacement_;  ///< start: of the level
    Rings rings_;
    std::vector<std::size_t> match_, stay_, laplacian_, guide_;
    std::unique_ptr<MeshSpaceSolver> solver_;
    std::vector<VertexMatch> matches_;
    std::vector<bool> weighted_;  ///< vertices whose match weighs in the factorisation
};

/// The template with fewer vertices, for what is smooth anyway.
struct Coarse {
    Mesh mesh;
    std::vector<Index> vertex_map, face_origin;
};

Coarse coarsened(const Mesh& mesh, std::size_t vertices) {
    Coarse coarse{mesh, {}, {}};
    SimplifyOptions options;
    options.vertices = vertices;
    options.outlines = "ignore";
    const SimplifyResult done = simplify(coarse.mesh, options);
    coarse.vertex_map = done.vertex_map;
    coarse.face_origin.resize(coarse.mesh.number_of_faces());
    for (Index f = 0; f < done.face_map.size(); ++f)
        if (done.face_map[f] != no_index) coarse.face_origin[done.face_map[f]] = f;
    return coarse;
}

/// The fine mesh moved with the surroundings of the nearest place of the coarse one.
Points follow(const Mesh& fine, const Mesh& coarse, const Fitter& fitter) {
    const std::vector<Matrix3d> turns = fitter.turns();
    const SurfaceSearch search(coarse);
    Points points(3, static_cast<Eigen::Index>(fine.number_of_vertices()));
    parallel_for(fine.number_of_vertices(), [&](std::size_t i) {
        const Point& p = fine.point(Vertex(static_cast<Index>(i)));
        const SurfaceHit hit = search.closest(p);
        const auto c = corners(coarse, Face(hit.face));
        Vector3d sum = Vector3d::Zero();
        for (std::size_t k = 0; k < 3; ++k) {
            const auto v = static_cast<Eigen::Index>(c[k]);
            sum += hit.barycentric[k] * (turns[c[k]] * (eigen(p) - fitter.rest().col(v)) + fitter.now().col(v));
        }
        points.col(static_cast<Eigen::Index>(i)) = sum;
    });
    return points;
}

}  // namespace

NonRigidFit fit_template(const Mesh& scaled, const AnnotationSet& set, const std::vector<PlacedFragment>& fragments,
                         const NonRigidOptions& options) {
    check_options(options, "fit");
    if (options.counterparts != "surface" &&
        !(options.vertices.boundary + options.vertices.distance + options.vertices.outline > 0))
        fail_usage("all three weights of equation 5.1 are zero", "give --distance-weight or another one");
    if (scaled.number_of_faces() == 0) fail_input("template", "has no faces", "is it the right file?");
    constexpr std::size_t few = 4000;  // vertices that show every shape of the first levels
    constexpr double edges = 0.8;      // least smoothing length of a level on the coarse mesh, in its edges
    const double diagonal = box_diagonal(scaled);
    NonRigidFit fit;
    const MatchSearch search(scaled, set, fragments);
    Fitter fine(scaled, search, search.labels(scaled, {}), search.guides(), diagonal, options);
    int level = 0;
    if (scaled.number_of_vertices() > 2 * few) {
        Coarse coarse;
        {
            const Stopwatch watch(fit.seconds_coarsening);
            coarse = coarsened(scaled, few);
        }
        const double edge = mean_edge_length(coarse.mesh);
        while (level < options.levels && Fitter::smoothing(options, level, diagonal) >= edges * edge) ++level;
        std::vector<Guide> guides = search.guides();
        for (Guide& guide : guides) {
            const Index here = coarse.vertex_map[guide.vertex];
            if (here != no_index)
                guide.place += eigen(coarse.mesh.point(Vertex(here))) - eigen(scaled.point(Vertex(guide.vertex)));
            guide.vertex = here;
        }
        std::erase_if(guides, [&](const Guide& guide) { return guide.vertex >= coarse.mesh.number_of_vertices(); });
        Fitter smooth(coarse.mesh, search, search.labels(coarse.mesh, coarse.face_origin), std::move(guides), diagonal, options);
        smooth.run(0, level, fit);
        const Stopwatch watch(fit.seconds_coarsening);
        if (level > 0) fine.start_at(follow(scaled, coarse.mesh, smooth));
    }
    fine.run(level, options.levels, fit);
    fit.matches = fine.match(options.last_reach * diagonal, fit);
    for (Eigen::Index i = 0; i < fine.now().cols(); ++i) fit.points.push_back(point_of(fine.now().col(i)));
    return fit;
}

}  // namespace ostraka
