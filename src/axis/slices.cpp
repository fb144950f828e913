// Axis of a tubular part from the centres of its slices.
#include "axis/axis_methods.h"

#include "ostraka/execution/parallel.h"

namespace ostraka {

using namespace detail;

namespace {

struct PatchSlice {
    bool valid = false;
    Vector3d centre = Vector3d::Zero();
    double radius = 0;
};

/// The intersection of the part with a plane, within `max_distance` of `point`. A vertex on the plane counts as above it.
PatchSlice cut(const Mesh& mesh, const std::vector<Index>& faces, const Vector3d& point, const Vector3d& normal,
               double max_distance) {
    std::vector<Vector3d> middles;
    std::vector<std::array<Vector3d, 2>> pieces;
    std::vector<double> lengths;
    for (const Index f : faces) {
        std::array<Vector3d, 3> p;
        std::array<double, 3> h{};
        std::size_t k = 0;
        for (const Vertex v : corners(mesh, Face(f))) {
            p.at(k) = eigen(mesh.point(v)) - point;
            h.at(k) = normal.dot(p.at(k));
            ++k;
        }
        const int above = (h[0] >= 0) + (h[1] >= 0) + (h[2] >= 0);
        if (above == 0 || above == 3) continue;
        std::array<Vector3d, 2> ends;
        std::size_t count = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            if ((h.at(i) >= 0) == (h.at(j) >= 0)) continue;
            const double t = h.at(i) / (h.at(i) - h.at(j));
            ends.at(count++) = p.at(i) + t * (p.at(j) - p.at(i));
        }
        const Vector3d middle = (ends[0] + ends[1]) / 2;
        const double length = (ends[1] - ends[0]).norm();
        if (!(length > 0) || middle.norm() > max_distance) continue;
        middles.push_back(middle);
        pieces.push_back(ends);
        lengths.push_back(length);
    }
    PatchSlice slice;
    if (middles.size() < 3) return slice;
    Vector3d centre = Vector3d::Zero();
    double total = 0;
    for (std::size_t i = 0; i < middles.size(); ++i) centre += lengths[i] * middles[i], total += lengths[i];
    centre /= total;
    const auto [u, w] = across(normal);
    std::vector<double> angles;
    for (const auto& m : middles) {
        angles.push_back(std::atan2(w.dot(m - centre), u.dot(m - centre)));
    }
    if (covered_percent(angles) < 100.0 * 300 / 360) {
        PlaneSegments flat;
        for (const auto& [a, b] : pieces)
            flat.emplace_back(Eigen::Vector2d(u.dot(a), w.dot(a)), Eigen::Vector2d(u.dot(b), w.dot(b)));
        // An arc that does not determine its radius has no centre.
        const ArcFit arc = fit_arc(flat);
        if (!arc.is_round() || arc.uncertainty() > 0.25 || arc.circle.radius > max_distance) return slice;
        centre = arc.circle.centre.x() * u + arc.circle.centre.y() * w;
    }
    for (std::size_t i = 0; i < middles.size(); ++i) slice.radius += lengths[i] / total * (middles[i] - centre).norm();
    slice.centre = point + centre;
    slice.valid = true;
    return slice;
}

}  // namespace

Axis slice_axis(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options) {
    const AreaMoments moments = part_moments(mesh, faces, options);
    Axis axis;
    if (moments.variances[0] < 1.3 * moments.variances[1]) {
        axis.reason = "it is not longer than wide";
        return axis;
    }
    const Vector3d centroid = eigen(moments.centroid), direction = eigen(moments.directions[0]);
    const auto ends = extent_along(mesh, faces, centroid, direction);
    const double diagonal = part_diagonal(mesh, faces);
    const auto count = static_cast<std::size_t>(options.slices);
    std::vector<PatchSlice> first(count);
    parallel_for(count, 1, [&](std::size_t i) {
        const double h = ends.first + (ends.second - ends.first) * (0.03 + 0.94 * (double(i) + 0.5) / double(count));
        first[i] = cut(mesh, faces, centroid + h * direction, direction, 2 * diagonal);
    });
    std::vector<PatchSlice> rough;
    for (const auto& slice : first)
        if (slice.valid) rough.push_back(slice);
    std::vector<PatchSlice> fine(rough.size());
    parallel_for(rough.size(), 1, [&](std::size_t i) {
        const std::size_t previous = i >= 2 ? i - 2 : 0, next = std::min(i + 2, rough.size() - 1);
        const Vector3d tangent = rough[next].centre - rough[previous].centre;
        if (tangent.norm() > 0)
            fine[i] = cut(mesh, faces, rough[i].centre, tangent.normalized(), 3 * rough[i].radius + 1e-9 * diagonal);
    });
    std::vector<Vector3d> centres;
    std::vector<Point> line;
    double radius = 0, length = 0;
    for (const auto& slice : fine) {
        if (!slice.valid) continue;
        if (!centres.empty()) length += (slice.centre - centres.back()).norm();
        centres.push_back(slice.centre);
        line.push_back(point_of(slice.centre));
        radius += slice.radius;
    }
    if (centres.size() < 3 || 2 * centres.size() < count || !(length > 0)) {
        axis.reason = "fewer than half of the slices have a centre";
        return axis;
    }
    radius /= double(centres.size());
    const LineFit fit = fit_line(centres, std::vector<double>(centres.size(), 1));
    set_line(axis, fit.point, fit.direction, centroid);
    axis.lines = {line};
    axis.quality = std::max(0.0, 1 - radius / length);
    axis.found = axis.quality > 0.4;
    if (!axis.found) axis.reason = "it is not longer than wide";
    axis.figures = {{"length", length, "length"}, {"mean radius", radius, "length"}, {"rms distance", fit.rms, "length"}};
    return axis;
}

}  // namespace ostraka
