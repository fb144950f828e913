#include "ostraka/fitting/shape_prior.h"

#include "match_search.h"

#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"
#include "ostraka/geom/eigen.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ostraka {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

void ShapePrior::check(std::size_t vertices) const {
    if (mean.size() != vertices)
        fail_input("class", "has " + std::to_string(mean.size()) + " vertices, and the template " + std::to_string(vertices),
                   "give the class that was learnt with this template");
    if (static_cast<std::size_t>(modes.rows()) != 3 * vertices || static_cast<std::size_t>(modes.cols()) != deviations.size())
        fail_input("class", "its modes do not fit its mean", "learn it anew");
    if (!modes.allFinite() ||
        std::any_of(deviations.begin(), deviations.end(), [](double d) { return !(d > 0) || !std::isfinite(d); }))
        fail_input("class", "has a mode that is not finite, or does not vary", "learn it anew");
}

namespace {

class PriorFitter {
public:
    PriorFitter(const Mesh& scaled, const AnnotationSet& set, const std::vector<PlacedFragment>& fragments,
                const ShapePrior& prior, const PriorOptions& options)
        : scaled_(scaled), prior_(prior), options_(options), search_(scaled, set, fragments), diagonal_(box_diagonal(scaled)) {
        std::vector<Vector3d> there;
        for (const Vertex v : scaled.vertices()) there.push_back(eigen(scaled.point(v)));
        FitOptions free;
        free.scale = true;
        place_ = fit_motion(prior.mean, there, {}, free);
        coefficients_ = VectorXd::Zero(prior.modes.cols());
        labels_ = search_.labels(scaled, {});
        constexpr std::size_t most = 4000;
        const std::size_t step = std::max<std::size_t>(1, labels_.of_vertex.size() / most);
        for (std::size_t i = 0; i < labels_.of_vertex.size(); ++i)
            if (i % step != 0) labels_.of_vertex[i].clear();
        areas_.assign(scaled.number_of_vertices(), 0);
        for (const Face face : scaled.faces())
            for (const Vertex v : corners(scaled, face)) areas_[v] += face_area(scaled, face) / 3;
    }

    PriorFit run() {
        PriorFit fit;
        Points now = shape();
        for (; fit.iterations < options_.iterations; ++fit.iterations) {
            if (!step(now, fit)) break;
            const Points then = shape();
            const double change = (then - now).colwise().norm().maxCoeff();
            now = then;
            if (change < 1e-5 * diagonal_) break;
        }
        fit.mesh = scaled_;
        for (const Vertex v : fit.mesh.vertices()) fit.mesh.point(v) = point_of(now.col(static_cast<Eigen::Index>(v)));
        for (Eigen::Index k = 0; k < coefficients_.size(); ++k)
            fit.coefficients.push_back(coefficients_[k] / prior_.deviations[static_cast<std::size_t>(k)]);
        return fit;
    }

private:
    [[nodiscard]] Points shape() const {
        Points points(3, static_cast<Eigen::Index>(prior_.mean.size()));
        const VectorXd offset = prior_.modes * coefficients_;
        for (Eigen::Index i = 0; i < points.cols(); ++i)
            points.col(i) = place_(prior_.mean[static_cast<std::size_t>(i)] + offset.segment<3>(3 * i));
        return points;
    }

    /// False where nothing is matched.
    bool step(const Points& now, PriorFit& fit) {
        const auto matches =
            search_.matches(now, scaled_, labels_, options_.reach * diagonal_, std::cos(options_.angle * std::numbers::pi / 180));
        std::vector<Vector3d> normals(areas_.size(), Vector3d::Zero());
        for (const Face face : scaled_.faces()) {
            const auto c = corners(scaled_, face);
            const Vector3d a = now.col(static_cast<Eigen::Index>(c[0])), b = now.col(static_cast<Eigen::Index>(c[1])),
                           d = now.col(static_cast<Eigen::Index>(c[2]));
            for (const Vertex v : c) normals[v] += (b - a).cross(d - a);
        }
        Vector3d centre = Vector3d::Zero();
        double weight = 0;
        fit.matched = 0;
        for (std::size_t i = 0; i < matches.size(); ++i) {
            if (matches[i].fragment < 0 || !(normals[i].norm() > 0)) continue;
            centre += areas_[i] * now.col(static_cast<Eigen::Index>(i));
            weight += areas_[i];
            ++fit.matched;
        }
        if (fit.matched < 3 || !(weight > 0)) return false;
        centre /= weight;
        double spread = 0;
        for (std::size_t i = 0; i < matches.size(); ++i)
            if (matches[i].fragment >= 0) spread += areas_[i] * (now.col(static_cast<Eigen::Index>(i)) - centre).squaredNorm();
        spread = std::sqrt(spread / weight);
        if (!(spread > 0)) return false;
        // Unknown: turn and scale (times the spread), shift, coefficients (in deviations).
        const Eigen::Index modes = coefficients_.size(), unknowns = 7 + modes;
        MatrixXd normal = MatrixXd::Zero(unknowns, unknowns);
        VectorXd right = VectorXd::Zero(unknowns), row(unknowns);
        const Matrix3d linear = place_.scale * place_.turn;
        const auto add = [&](std::size_t i, const Vector3d& n, double off, double w) {
            const Vector3d arm = (now.col(static_cast<Eigen::Index>(i)) - centre) / spread;
            row.head<3>() = arm.cross(n);
            row[3] = n.dot(arm);
            row.segment<3>(4) = n;
            const Eigen::RowVector3d turned = n.transpose() * linear;
            for (Eigen::Index k = 0; k < modes; ++k)
                row[7 + k] = prior_.deviations[static_cast<std::size_t>(k)] *
                             turned.dot(prior_.modes.col(k).segment<3>(3 * static_cast<Eigen::Index>(i)));
            normal.selfadjointView<Eigen::Lower>().rankUpdate(row, w);
            right += w * off * row;
        };
        double squares = 0;
        for (std::size_t i = 0; i < matches.size(); ++i) {
            if (matches[i].fragment < 0 || !(normals[i].norm() > 0)) continue;
            const Vector3d n = normals[i].normalized();
            const double off = n.dot(matches[i].place - now.col(static_cast<Eigen::Index>(i)));
            squares += areas_[i] * off * off;
            add(i, n, off, areas_[i] / weight);
        }
        constexpr double weight_of_landmark = 0.05;  // against that of the whole surface
        for (const Guide& guide : search_.guides()) {
            const Vector3d off = guide.place - now.col(static_cast<Eigen::Index>(guide.vertex));
            for (int axis = 0; axis < 3; ++axis) add(guide.vertex, Vector3d::Unit(axis), off[axis], weight_of_landmark);
        }
        fit.residual = std::sqrt(squares / weight);
        normal = normal.selfadjointView<Eigen::Lower>();
        // The observed surface counts as `samples` places with the residual as their error, which is never taken for less than
        // what registration leaves; each coefficient is off by one deviation at will.
        const double error = std::max(fit.residual, 1e-4 * diagonal_), stiffness = error * error / options_.samples;
        for (Eigen::Index k = 0; k < modes; ++k) {
            const double b = coefficients_[k] / prior_.deviations[static_cast<std::size_t>(k)];
            normal(7 + k, 7 + k) += stiffness;
            right[7 + k] -= stiffness * b;
        }
        normal.diagonal().array() += 1e-12 * normal.diagonal().maxCoeff();
        const VectorXd x = normal.ldlt().solve(right);
        if (!x.allFinite()) return false;
        // The same motion of what the modes give: first the coefficients, then the motion about the centre.
        for (Eigen::Index k = 0; k < modes; ++k) {
            const double deviation = prior_.deviations[static_cast<std::size_t>(k)];
            coefficients_[k] =
                std::clamp(coefficients_[k] + deviation * x[7 + k], -options_.most * deviation, options_.most * deviation);
        }
        const Vector3d turn = x.head<3>() / spread;
        const double angle = turn.norm();
        Motion about;
        if (angle > 0) about.turn = Eigen::AngleAxisd(std::min(angle, 0.5), turn / angle).toRotationMatrix();
        about.scale = std::clamp(1 + x[3] / spread, 0.8, 1.25);
        about.shift = centre + x.segment<3>(4) - about.scale * (about.turn * centre);
        place_ = about.after(place_);
        return true;
    }

    const Mesh& scaled_;
    const ShapePrior& prior_;
    const PriorOptions& options_;
    MatchSearch search_;
    double diagonal_;
    MatchSearch::Labels labels_;
    std::vector<double> areas_;
    Motion place_;
    VectorXd coefficients_;
};

}  // namespace

PriorFit fit_prior(const Mesh& scaled, const AnnotationSet& set, const std::vector<PlacedFragment>& fragments,
                   const ShapePrior& prior, const PriorOptions& options) {
    check_options(options, "fit");
    prior.check(scaled.number_of_vertices());
    return PriorFitter(scaled, set, fragments, prior, options).run();
}

}  // namespace ostraka
