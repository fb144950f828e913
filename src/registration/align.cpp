#include "ostraka/registration/align.h"
#include "ostraka/algebra/dense.h"
#include "ostraka/core/angles.h"

#include "registration/trimmed_registration.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/point_tree.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

struct AlignSurface::State {
    std::vector<Vector3d> points, normals;  ///< of the vertices
    std::vector<bool> border;
    std::vector<Vector3d> sample_points, sample_normals;
    double size = 0;
    Vector3d centre = Vector3d::Zero();
    Matrix3d axes = Matrix3d::Identity();
    PointTree tree;

    [[nodiscard]] std::size_t nearest(const Vector3d& p) const { return tree.nearest(point_of(p)).index; }
};

AlignSurface::AlignSurface(const Mesh& mesh, int samples) : state_(std::make_unique<State>()) {
    State& s = *state_;
    const double area = surface_area(mesh);
    if (!(area > 0)) fail_input("mesh", "it has no area, so nothing can be registered to it", "check that it is the right file");
    if (samples < 1) fail_usage(fmt::format("a surface cannot be registered by {} points", samples), "use at least one point");
    s.size = std::sqrt(area);
    std::vector<Point> places;
    for (const Vertex v : mesh.vertices()) {
        if (mesh.is_isolated(v)) continue;
        const Vector3d normal = eigen(vertex_normal(mesh, v));
        if (normal.isZero()) continue;
        places.push_back(mesh.point(v));
        s.points.push_back(eigen(mesh.point(v)));
        s.normals.push_back(normal);
        s.border.push_back(mesh.is_border(v));
    }
    // Each sample represents the same area: the cumulative face areas are cut at equal steps.
    double sum = 0, next = 0.5 * area / samples;
    Matrix3d second = Matrix3d::Zero();
    for (const Face face : mesh.faces()) {
        const double a = face_area(mesh, face);
        const Vector3d middle = eigen(centroid(mesh, face));
        s.centre += a / area * middle;
        sum += a;
        while (next < sum && s.sample_points.size() < static_cast<std::size_t>(samples)) {
            s.sample_points.push_back(middle);
            s.sample_normals.push_back(eigen(area_vector(mesh, face)).normalized());
            next += area / samples;
        }
    }
    for (const Vector3d& p : s.sample_points) second += (p - s.centre) * (p - s.centre).transpose();
    s.axes = SymmetricEigen3(second).eigenvectors();
    if (s.axes.determinant() < 0) s.axes.col(0) *= -1;
    s.tree = PointTree(places);
}

AlignSurface::~AlignSurface() = default;
AlignSurface::AlignSurface(AlignSurface&&) noexcept = default;
double AlignSurface::size() const { return state_->size; }

std::vector<Motion> principal_starts(const AlignSurface& a, const AlignSurface& b) {
    std::vector<Motion> starts;
    for (const Vector3d& signs : {Vector3d(1, 1, 1), Vector3d(1, -1, -1), Vector3d(-1, 1, -1), Vector3d(-1, -1, 1)}) {
        Motion motion;
        motion.rotation = b.state().axes * signs.asDiagonal() * a.state().axes.transpose();
        motion.translation = b.state().centre - motion.rotation * a.state().centre;
        starts.push_back(motion);
    }
    return starts;
}

namespace {

class Aligner {
public:
    Aligner(const AlignSurface& a, const AlignSurface& b, const AlignOptions& options)
        : a_(a.state()), b_(b.state()), options_(options), cosine_(std::cos(options.angle * pi / 180)) {}

    Alignment run(const Motion& start) {
        const detail::Registration registration = detail::register_from(
            start, options_.iterations, 1e-3, pairs_, [&](const Motion& motion) { return measure(motion); },
            [&](const Motion& motion) { return step(motion); });
        return {registration.pose, registration.fit.residual / (0.5 * (a_.size + b_.size)), registration.fit.overlap,
                registration.iterations, registration.converged};
    }

private:
    /// Trimmed pairs under a motion; their root mean square.
    detail::PoseFit measure(const Motion& motion) {
        pairs_.pairs.clear();
        const Motion back = motion.inverse();
        collect(a_, b_, motion, back, true);
        collect(b_, a_, back, motion, false);
        const std::size_t sample_count = a_.sample_points.size() + b_.sample_points.size(), pair_count = pairs_.pairs.size();
        const std::size_t kept_count = pairs_.trim(options_.trim, sample_count);
        // Points without a partner count with the largest kept distance, so that a pose with few pairs does not score better.
        double sum = pairs_.squares();
        if (pair_count > 0) sum += static_cast<double>(kept_count - pairs_.pairs.size()) * pairs_.pairs.back().squared;
        const double rms = pair_count > 0 ? std::sqrt(sum / static_cast<double>(kept_count)) : b_.size;
        return {rms, rms, static_cast<double>(pair_count) / static_cast<double>(sample_count)};
    }

    void collect(const AlignSurface::State& from, const AlignSurface::State& to, const Motion& to_target, const Motion& back,
                 bool forward) {
        for (std::size_t i = 0; i < from.sample_points.size(); ++i) {
            const Vector3d p = to_target(from.sample_points[i]), n = to_target.rotation * from.sample_normals[i];
            const std::size_t v = to.nearest(p);
            if (v == no_index || to.border[v] || n.dot(to.normals[v]) < cosine_) continue;  // none: the pose is not finite
            // Distances and planes are compared in the frame of the second surface.
            if (forward) {
                pairs_.pairs.push_back({p, to.points[v], to.normals[v], (p - to.points[v]).squaredNorm()});
            } else {
                const Vector3d q = back(to.points[v]);
                const Vector3d normal = back.rotation * to.normals[v];
                pairs_.pairs.push_back({q, from.sample_points[i], normal, (q - from.sample_points[i]).squaredNorm()});
            }
        }
    }

    /// Rotates the first surface by w, translates it by t and scales it by 1 + s about the centre of the pairs, linearised.
    Motion step(const Motion& motion) {
        const bool scaled = options_.shrinkage > 0;
        const PlaneMotion planes = pairs_.planes(b_.size);
        PlaneMotion::Step step = planes.solve(1e-9, scaled);
        if (scaled)
            step.growth =
                std::log(std::clamp(motion.scale * std::exp(step.growth), 1 - options_.shrinkage, 1 / (1 - options_.shrinkage)) /
                         motion.scale);
        return planes.motion(step).after(motion);
    }

    const AlignSurface::State &a_, &b_;
    const AlignOptions& options_;
    double cosine_;
    detail::PlanePairs pairs_;
};

}  // namespace

Alignment align(const AlignSurface& a, const AlignSurface& b, const std::vector<Motion>& starts, const AlignOptions& options) {
    check_options(options, "registration");
    Aligner aligner(a, b, options);
    Alignment best;
    bool first = true;
    for (const Motion& start : starts.empty() ? principal_starts(a, b) : starts) {
        const Alignment result = aligner.run(start);
        if (first || result.distance < best.distance) best = result;
        first = false;
    }
    return best;
}

void AlignOptions::declare_options(OptionList& list) {
    list("shrinkage", shrinkage, "maximum relative difference in size between template and object; 0: rigid registration",
         Range{0, 0.5});
    list("trim", trim, "share of the point pairs, closest first, that a registration uses (trimming)", Range{0.1, 1});
    list("pair-angle", angle, "maximum angle between the normals of two points paired in the registration", Range{1, 180},
         "degrees");
    list("samples", samples, "number of points of each surface that are registered onto the other", Range{10, 1e6});
    list("iterations", iterations, "maximum number of iterations of a registration", Range{1, 10000});
}

}  // namespace ostraka
