#include "ostraka/registration/align.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/dense.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/plane_motion.h"

#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {
using PlaceOf = CGAL::Pointer_property_map<Point>::const_type;
using Traits = CGAL::Search_traits_adapter<std::size_t, PlaceOf, CGAL::Search_traits_3<Kernel>>;
using Search = CGAL::Orthogonal_k_neighbor_search<Traits>;
}  // namespace

struct AlignSurface::State {
    std::vector<Point> places;  ///< of the vertices
    std::vector<Vector3d> points, normals;
    std::vector<bool> border;
    std::vector<Vector3d> sample_points, sample_normals;
    double size = 0;
    Vector3d centre = Vector3d::Zero();
    Matrix3d axes = Matrix3d::Identity();
    std::unique_ptr<Search::Tree> tree;
    std::unique_ptr<Search::Distance> distance;

    [[nodiscard]] std::size_t nearest(const Vector3d& p) const {
        const Search search(*tree, point_of(p), 1, 0, true, *distance);
        return search.begin()->first;
    }
};

AlignSurface::AlignSurface(const Mesh& mesh, int samples) : state_(std::make_unique<State>()) {
    State& s = *state_;
    const double area = surface_area(mesh);
    if (!(area > 0)) fail_input("mesh", "it has no area, so that nothing can be laid onto it", "is it the right file?");
    if (samples < 1)
        fail_usage("a surface is to be laid onto another by " + std::to_string(samples) + " points", "take at least one");
    s.size = std::sqrt(area);
    for (const Vertex v : mesh.vertices()) {
        if (mesh.is_isolated(v)) continue;
        const Vector3d normal = eigen(vertex_normal(mesh, v));
        if (normal.isZero()) continue;
        s.places.push_back(mesh.point(v));
        s.points.push_back(eigen(mesh.point(v)));
        s.normals.push_back(normal);
        s.border.push_back(mesh.is_border(v));
    }
    // Each sample stands for the same area: the faces' areas in a row, cut into equal lengths.
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
    std::vector<std::size_t> all(s.places.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    const Traits traits{PlaceOf(s.places.data())};
    s.tree = std::make_unique<Search::Tree>(all.begin(), all.end(), Search::Tree::Splitter(), traits);
    s.tree->build();
    s.distance = std::make_unique<Search::Distance>(PlaceOf(s.places.data()));
}

AlignSurface::~AlignSurface() = default;
AlignSurface::AlignSurface(AlignSurface&&) noexcept = default;
double AlignSurface::size() const { return state_->size; }

std::vector<Motion> principal_starts(const AlignSurface& a, const AlignSurface& b) {
    std::vector<Motion> starts;
    for (const Vector3d& signs : {Vector3d(1, 1, 1), Vector3d(1, -1, -1), Vector3d(-1, 1, -1), Vector3d(-1, -1, 1)}) {
        Motion motion;
        motion.turn = b.state().axes * signs.asDiagonal() * a.state().axes.transpose();
        motion.shift = b.state().centre - motion.turn * a.state().centre;
        starts.push_back(motion);
    }
    return starts;
}

namespace {

/// A sample of one surface and the plane at its partner, both where the second surface is.
struct Pair {
    Vector3d point, place, normal;  ///< the moved point is that of the first surface if `forward`
    double squared;
    bool forward;
};

class Aligner {
public:
    Aligner(const AlignSurface& a, const AlignSurface& b, const AlignOptions& options)
        : a_(a.state()), b_(b.state()), options_(options), cosine_(std::cos(options.angle * pi / 180)) {}

    Alignment run(const Motion& start) {
        // The pairs change from step to step, so that the distance may rise for a while: the best pose met is kept.
        constexpr int patience = 4;
        Alignment result;
        Motion motion = start;
        double least = measure(motion);
        result.motion = motion;
        result.overlap = overlap_;
        for (int since = 0; result.iterations < options_.iterations && since < patience && pairs_.size() >= 6;
             ++result.iterations) {
            motion = step(motion);
            const double now = measure(motion);
            since = now < least * (1 - 1e-3) ? 0 : since + 1;
            if (now < least) least = now, result.motion = motion, result.overlap = overlap_;
            result.settled = since >= patience;
        }
        result.distance = least / (0.5 * (a_.size + b_.size));
        return result;
    }

private:
    /// Pairs under a motion, trimmed; their root mean square.
    double measure(const Motion& motion) {
        pairs_.clear();
        const Motion back = motion.inverse();
        collect(a_, b_, motion, back, true);
        collect(b_, a_, back, motion, false);
        const std::size_t all = a_.sample_points.size() + b_.sample_points.size();
        overlap_ = static_cast<double>(pairs_.size()) / static_cast<double>(all);
        // Trimmed against all samples: a pose in which few points find a partner is no better for it.
        const auto wanted = std::max<std::size_t>(1, static_cast<std::size_t>(options_.trim * static_cast<double>(all)));
        std::stable_sort(pairs_.begin(), pairs_.end(), [](const Pair& p, const Pair& q) { return p.squared < q.squared; });
        if (pairs_.size() > wanted) pairs_.resize(wanted);
        // A pose in which few points find a partner is no better for it: who has none is as far off as the farthest that counts.
        double sum = 0;
        for (const Pair& pair : pairs_) {
            const double off = pair.normal.dot(pair.point - pair.place);
            sum += off * off;
        }
        const auto missing = static_cast<double>(wanted - pairs_.size());
        if (!pairs_.empty()) sum += missing * pairs_.back().squared;
        rms_ = pairs_.empty() ? b_.size : std::sqrt(sum / static_cast<double>(wanted));
        return rms_;
    }

    void collect(const AlignSurface::State& from, const AlignSurface::State& to, const Motion& there, const Motion& back,
                 bool forward) {
        for (std::size_t i = 0; i < from.sample_points.size(); ++i) {
            const Vector3d p = there(from.sample_points[i]), n = there.turn * from.sample_normals[i];
            const std::size_t v = to.nearest(p);
            if (to.border[v] || n.dot(to.normals[v]) < cosine_) continue;
            // Lengths and planes are compared where the second surface is.
            if (forward) {
                pairs_.push_back({p, to.points[v], to.normals[v], (p - to.points[v]).squaredNorm(), true});
            } else {
                const Vector3d q = back(to.points[v]);
                const Vector3d normal = back.turn * to.normals[v];
                pairs_.push_back({q, from.sample_points[i], normal, (q - from.sample_points[i]).squaredNorm(), false});
            }
        }
    }

    /// The first surface is turned by w, shifted by t and scaled by 1 + s about the pairs' centre, linearised.
    Motion step(const Motion& motion) {
        Vector3d centre = Vector3d::Zero();
        for (const Pair& pair : pairs_) centre += pair.point / static_cast<double>(pairs_.size());
        const bool scaled = options_.shrinkage > 0;
        PlaneMotion planes(centre, b_.size);
        for (const Pair& pair : pairs_) planes.add(pair.point, pair.normal, pair.normal.dot(pair.place - pair.point));
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
    std::vector<Pair> pairs_;
    double rms_ = 0, overlap_ = 0;
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

void AlignOptions::describe(OptionList& visit) {
    visit("shrinkage", shrinkage, "surfaces may differ in size by up to this share; 0: rigid", Range{0, 0.5});
    visit("trim", trim, "share of the pairs of points that count, the nearest ones", Range{0.1, 1});
    visit("pair-angle", angle, "pairs whose normals differ by more are left out", Range{1, 180}, "degrees");
    visit("samples", samples, "points on each surface that are laid onto the other", Range{10, 1e6});
    visit("iterations", iterations, "most steps of a registration", Range{1, 10000});
}

}  // namespace ostraka
