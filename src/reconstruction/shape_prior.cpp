#include "ostraka/reconstruction/shape_prior.h"
#include "ostraka/algebra/dense.h"
#include "ostraka/core/angles.h"

#include "reconstruction/match_search.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/submesh.h"
#include "ostraka/stats/summary.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

namespace ostraka {

using Eigen::MatrixXd;
using Eigen::VectorXd;

void ShapePrior::check(std::size_t vertices) const {
    if (mean.size() != vertices)
        fail_input("class", fmt::format("has {} vertices, but the template has {}", mean.size(), vertices),
                   "give the class that was learnt with this template");
    if (static_cast<std::size_t>(modes.rows()) != 3 * vertices || static_cast<std::size_t>(modes.cols()) != deviations.size())
        fail_input("class", "its modes do not fit its mean", "learn it again");
    if (!modes.allFinite() ||
        std::any_of(deviations.begin(), deviations.end(), [](double d) { return !(d > 0) || !std::isfinite(d); }))
        fail_input("class", "has a mode that is not finite or has zero variance", "learn it again");
}

namespace {

/// A point of the class's shape and the fragment's distance from its plane.
struct Residual {
    Vector3d place, normal;
    double distance = 0, weight = 0;
    std::array<Index, 3> corners{};  ///< of the template
    std::array<double, 3> barycentric{};
};

/// Effective number of independent samples of the residuals, at least `minimum`: residuals of a rough surface are independent,
/// those of a shape outside the class are correlated with their neighbours. Bisects the surface across its longest side until
/// there are enough patches; the ratio of the variance of a single residual to that of a patch mean is the number of
/// independent residuals of the patch.
double independent_samples(std::vector<Residual> residuals, std::size_t unknowns, double minimum) {
    const auto wanted = std::max(static_cast<std::size_t>(minimum), 2 * unknowns);
    std::erase_if(residuals, [](const Residual& residual) { return !(residual.weight > 0); });
    if (residuals.size() < 4 * wanted) return minimum;
    std::vector<std::pair<std::size_t, std::size_t>> patches{{0, residuals.size()}};
    while (patches.size() < wanted) {
        std::vector<std::pair<std::size_t, std::size_t>> halves;
        for (const auto& [from, to] : patches) {
            Eigen::AlignedBox3d box;
            for (std::size_t i = from; i < to; ++i) box.extend(residuals[i].place);
            Eigen::Index axis = 0;
            box.sizes().maxCoeff(&axis);
            const std::size_t middle = from + (to - from) / 2;
            const auto begin = residuals.begin();
            std::nth_element(begin + static_cast<std::ptrdiff_t>(from), begin + static_cast<std::ptrdiff_t>(middle),
                             begin + static_cast<std::ptrdiff_t>(to),
                             [axis](const Residual& a, const Residual& b) { return a.place[axis] < b.place[axis]; });
            halves.emplace_back(from, middle);
            halves.emplace_back(middle, to);
        }
        patches = std::move(halves);
    }
    double squares = 0, mean_squares = 0;
    for (const auto& [from, to] : patches) {
        double sum = 0, weight = 0;
        for (std::size_t i = from; i < to; ++i) {
            sum += residuals[i].weight * residuals[i].distance;
            weight += residuals[i].weight;
            squares += residuals[i].weight * residuals[i].distance * residuals[i].distance;
        }
        if (weight > 0) mean_squares += sum * sum / weight;
    }
    const auto count = static_cast<double>(patches.size());
    // The fitted parameters reduce the variance of the means.
    mean_squares *= count / (count - static_cast<double>(unknowns));
    const double maximum = static_cast<double>(residuals.size());
    return mean_squares > 0 ? std::clamp(count * squares / mean_squares, minimum, std::max(minimum, maximum)) : minimum;
}

class PriorFitter {
public:
    PriorFitter(AnnotatedMeshView scaled, const std::vector<PlacedFragment>& fragments, const ShapePrior& prior,
                const PriorOptions& options)
        : scaled_(scaled.mesh), prior_(prior), options_(options), diagonal_(box_diagonal(scaled.mesh)) {
        std::vector<Vector3d> positions;
        for (const Vertex v : scaled.mesh.vertices()) positions.push_back(eigen(scaled.mesh.point(v)));
        FitOptions fit_options;
        fit_options.scale = true;
        registration_ = fit_motion(prior.mean, positions, {}, fit_options);
        coefficients_ = VectorXd::Zero(prior.modes.cols());
        const MatchSearch search(scaled, fragments);
        correspondences_ = search.correspondences();
        constexpr int maximum = 3000;
        samples_ = search.samples(maximum);
        const MatchSearch::Labels labels = search.labels(scaled.mesh, {});
        for (const FragmentSample& sample : samples_) parts_.try_emplace(sample.label);
        for (auto& [label, part] : parts_) {
            std::vector<bool> keep(labels.of_face.size());
            for (std::size_t f = 0; f < keep.size(); ++f) keep[f] = labels.of_face[f] == label;
            part = keep_faces(scaled.mesh, keep);
        }
    }

    PriorFit run() {
        PriorFit fit;
        Points current = shape();
        for (; fit.iterations < options_.iterations; ++fit.iterations) {
            if (!step(current, fit)) break;
            const Points next = shape();
            const double change = (next - current).colwise().norm().maxCoeff();
            current = next;
            if (change < 1e-5 * diagonal_) break;
        }
        fit.mesh = scaled_;
        for (const Vertex v : fit.mesh.vertices()) fit.mesh.point(v) = point_of(current.col(static_cast<Eigen::Index>(v)));
        for (Eigen::Index k = 0; k < coefficients_.size(); ++k)
            fit.coefficients.push_back(coefficients_[k] / prior_.deviations[static_cast<std::size_t>(k)]);
        return fit;
    }

private:
    [[nodiscard]] Points shape() const {
        Points points(3, static_cast<Eigen::Index>(prior_.mean.size()));
        const VectorXd offset = prior_.modes * coefficients_;
        for (Eigen::Index i = 0; i < points.cols(); ++i)
            points.col(i) = registration_(prior_.mean[static_cast<std::size_t>(i)] + offset.segment<3>(3 * i));
        return points;
    }

    /// Distances of the fragments' samples from the planes of the class's shape, which is smooth while the fragments are not.
    [[nodiscard]] std::vector<Residual> residuals(const Points& current) {
        std::vector<Residual> result;
        const double cosine = std::cos(options_.angle * pi / 180), search_radius = options_.search_radius * diagonal_;
        for (auto& [label, part] : parts_) {
            if (part.faces.empty()) continue;
            for (const Vertex v : part.mesh.vertices())
                part.mesh.point(v) = point_of(current.col(static_cast<Eigen::Index>(part.vertices[v])));
            const SurfaceSearch search(part.mesh);
            std::vector<std::optional<Residual>> sample_residuals(samples_.size());
            parallel_for(samples_.size(), [&, label = label, part = &part](std::size_t i) {
                const FragmentSample& sample = samples_[i];
                if (sample.label != label) return;
                const auto hit =
                    search.closest_compatible(point_of(sample.place), vector_of(sample.normal), cosine, search_radius);
                if (!hit) return;
                Residual residual;
                residual.place = eigen(hit->point);
                residual.normal = eigen(search.normal(hit->face));
                residual.distance = residual.normal.dot(sample.place - residual.place);
                const auto c = corners(part->mesh, Face(hit->face));
                for (std::size_t k = 0; k < 3; ++k) residual.corners[k] = part->vertices[c[k]];
                residual.barycentric = hit->barycentric;
                sample_residuals[i] = residual;
            });
            for (const auto& residual : sample_residuals)
                if (residual) result.push_back(*residual);
        }
        return result;
    }

    /// Matches with robust weights that add up to one, their centre and the root mean square of their distances from it.
    struct WeightedMatches {
        std::vector<Residual> residuals;
        Vector3d centre = Vector3d::Zero();
        double squares = 0, spread = 0;  ///< squares: weighted mean of the squared residuals
    };

    /// Outliers far beyond the typical residual get no weight (Tukey's biweight). Empty if nothing is matched.
    [[nodiscard]] std::optional<WeightedMatches> weighted(std::vector<Residual> residuals) const {
        if (residuals.size() < 3) return {};
        std::vector<double> sizes;
        for (const Residual& residual : residuals) sizes.push_back(std::abs(residual.distance));
        const double limit = 4.685 * std::max(1.4826 * upper_median(std::move(sizes)), min_error_);
        double weight = 0;
        for (Residual& residual : residuals) {
            const double t = residual.distance / limit;
            residual.weight = std::abs(t) < 1 ? (1 - t * t) * (1 - t * t) : 0;
            weight += residual.weight;
        }
        if (!(weight > 0)) return {};
        WeightedMatches matches;
        for (Residual& residual : residuals) {
            residual.weight /= weight;
            matches.centre += residual.weight * residual.place;
            matches.squares += residual.weight * residual.distance * residual.distance;
        }
        for (const Residual& residual : residuals)
            matches.spread += residual.weight * (residual.place - matches.centre).squaredNorm();
        matches.spread = std::sqrt(matches.spread);
        if (!(matches.spread > 0)) return {};
        matches.residuals = std::move(residuals);
        return matches;
    }

    /// Normal equations of a step. Unknowns: rotation and scale (times the spread), translation, coefficients (in deviations).
    struct Equations {
        MatrixXd normal;  ///< only the lower triangle
        VectorXd right;
    };

    void add(Equations& equations, const Residual& residual, const WeightedMatches& matches) const {
        const Eigen::Index modes = coefficients_.size();
        const Matrix3d linear = registration_.scale * registration_.rotation;
        const Vector3d arm = (residual.place - matches.centre) / matches.spread;
        VectorXd row(7 + modes);
        row.head<3>() = arm.cross(residual.normal);
        row[3] = residual.normal.dot(arm);
        row.segment<3>(4) = residual.normal;
        const Eigen::RowVector3d rotated = residual.normal.transpose() * linear;
        row.tail(modes).setZero();
        for (std::size_t c = 0; c < 3; ++c)
            for (Eigen::Index k = 0; k < modes && residual.barycentric[c] > 0; ++k)
                row[7 + k] += residual.barycentric[c] * prior_.deviations[static_cast<std::size_t>(k)] *
                              rotated.dot(prior_.modes.col(k).segment<3>(3 * static_cast<Eigen::Index>(residual.corners[c])));
        equations.normal.selfadjointView<Eigen::Lower>().rankUpdate(row, residual.weight);
        equations.right += residual.weight * residual.distance * row;
    }

    /// A landmark counts as one more sample, with less weight if the landmarks have larger residuals than the surface.
    void add_landmarks(Equations& equations, const Points& current, const WeightedMatches& matches, double samples) const {
        double squares = 0;
        for (const CorrespondenceConstraint& correspondence : correspondences_)
            squares += (correspondence.place - current.col(static_cast<Eigen::Index>(correspondence.vertex))).squaredNorm() /
                       (3 * static_cast<double>(correspondences_.size()));
        const double weight = (squares > matches.squares ? matches.squares / squares : 1) / samples;
        for (const CorrespondenceConstraint& correspondence : correspondences_) {
            const Vector3d p = current.col(static_cast<Eigen::Index>(correspondence.vertex));
            for (int axis = 0; axis < 3; ++axis)
                add(equations,
                    {p,
                     Vector3d::Unit(axis),
                     correspondence.place[axis] - p[axis],
                     weight,
                     {correspondence.vertex, 0, 0},
                     {1, 0, 0}},
                    matches);
        }
    }

    /// The observed surface counts as `samples` measurements with the residual as their error, at least the error of the
    /// registration; each coefficient has a prior of one standard deviation.
    void add_prior(Equations& equations, double residual, double samples) const {
        const double error = std::max(residual, min_error_), stiffness = error * error / samples;
        for (Eigen::Index k = 0; k < coefficients_.size(); ++k) {
            const double b = coefficients_[k] / prior_.deviations[static_cast<std::size_t>(k)];
            equations.normal(7 + k, 7 + k) += stiffness;
            equations.right[7 + k] -= stiffness * b;
        }
        equations.normal.diagonal().array() += 1e-12 * equations.normal.diagonal().maxCoeff();
    }

    /// One step of the fit. Returns false if nothing is matched or the equations have no solution.
    bool step(const Points& current, PriorFit& fit) {
        std::vector<Residual> residuals_now = residuals(current);
        fit.matched = residuals_now.size();
        const auto matches = weighted(std::move(residuals_now));
        if (!matches) return false;
        const Eigen::Index modes = coefficients_.size(), unknowns = 7 + modes;
        Equations equations{MatrixXd::Zero(unknowns, unknowns), VectorXd::Zero(unknowns)};
        for (const Residual& residual : matches->residuals)
            if (residual.weight > 0) add(equations, residual, *matches);
        fit.residual = std::sqrt(matches->squares);
        fit.samples = independent_samples(matches->residuals, static_cast<std::size_t>(unknowns), options_.samples);
        add_landmarks(equations, current, *matches, fit.samples);
        equations.normal = equations.normal.selfadjointView<Eigen::Lower>();
        add_prior(equations, fit.residual, fit.samples);
        const VectorXd x = solve_ldlt<Eigen::Dynamic>(equations.normal, equations.right);
        if (!x.allFinite()) return false;
        apply(x, *matches);
        return true;
    }

    /// The same motion applied to the modes: first the coefficients, then the motion about the centre.
    void apply(const VectorXd& x, const WeightedMatches& matches) {
        for (Eigen::Index k = 0; k < coefficients_.size(); ++k) {
            const double deviation = prior_.deviations[static_cast<std::size_t>(k)];
            coefficients_[k] =
                std::clamp(coefficients_[k] + deviation * x[7 + k], -options_.maximum * deviation, options_.maximum * deviation);
        }
        const Vector3d rotation = x.head<3>() / matches.spread;
        const double angle = rotation.norm();
        Motion increment;
        if (angle > 0) increment.rotation = Eigen::AngleAxisd(std::min(angle, 0.5), rotation / angle).toRotationMatrix();
        increment.scale = std::clamp(1 + x[3] / matches.spread, 0.8, 1.25);
        increment.translation = matches.centre + x.segment<3>(4) - increment.scale * (increment.rotation * matches.centre);
        registration_ = increment.after(registration_);
    }

    const Mesh& scaled_;
    const ShapePrior& prior_;
    const PriorOptions& options_;
    double diagonal_;
    double min_error_ = 1e-4 * diagonal_;
    std::vector<CorrespondenceConstraint> correspondences_;
    std::vector<FragmentSample> samples_;
    std::map<int, SubMesh> parts_;  ///< of the template, by label
    Motion registration_;
    VectorXd coefficients_;
};

}  // namespace

PriorFit fit_prior(AnnotatedMeshView scaled, const std::vector<PlacedFragment>& fragments, const ShapePrior& prior,
                   const PriorOptions& options) {
    check_options(options, "fit");
    prior.check(scaled.mesh.number_of_vertices());
    return PriorFitter(scaled, fragments, prior, options).run();
}

void PriorOptions::declare_options(OptionList& list) {
    list("class-iterations", iterations, "maximum number of iterations that fit the modes of variation of --class",
         Range{1, 1000});
    list("class-limit", maximum, "maximum deviation of a mode of variation from the class mean, in standard deviations",
         Range{0, 100});
    list("class-samples", samples,
         "minimum weight of the observed surface relative to the prior of the class, as a number of independent samples",
         Range{1, 1e9});
}

}  // namespace ostraka
