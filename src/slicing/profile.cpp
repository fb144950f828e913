// Half sections around an axis, and the additional elements of a drawing.
#include "ostraka/slicing/profile.h"
#include "ostraka/core/angles.h"

#include "ostraka/slicing/silhouette.h"
#include "ostraka/slicing/slice_descriptors.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

SliceFrame section_frame(const SliceFrame& axis, double angle) {
    SliceFrame frame;
    frame.origin = axis.origin;
    frame.u = -(std::cos(angle) * axis.u + std::sin(angle) * axis.v);
    frame.v = axis.normal;
    frame.normal = CGAL::cross_product(frame.u, frame.v);
    return frame;
}

/// Area of the closed contours and length of the open contours in the half plane x <= 0.
struct Half {
    double angle = 0, area = 0, open = 0;
};
Half half_of(const Slice& section, double angle) {
    Half half{angle};
    for (const auto& contour : section.contours) {
        std::vector<Vector2d> half_outline;
        for (std::size_t i = 0; i < contour.faces.size(); ++i) {
            const Vector2d &a = contour.points[i], &b = contour.points[(i + 1) % contour.points.size()];
            if (a.x() <= 0) half_outline.push_back(a);
            if ((a.x() <= 0) != (b.x() <= 0)) half_outline.push_back(a + a.x() / (a.x() - b.x()) * (b - a));
        }
        if (!contour.closed) {
            for (std::size_t i = 0; i + 1 < half_outline.size(); ++i) half.open += (half_outline[i + 1] - half_outline[i]).norm();
            continue;
        }
        for (std::size_t i = 0; i < half_outline.size(); ++i) {
            const Vector2d &a = half_outline[i], &b = half_outline[(i + 1) % half_outline.size()];
            half.area += (a.x() * b.y() - a.y() * b.x()) / 2;
        }
    }
    return half;
}

/// Distance of the section from the axis at a height, on the left side; 0 where there is no section.
double extent(const Slice& section, double height) {
    double maximum = 0;
    for (const auto& contour : section.contours)
        for (std::size_t i = 0; i < contour.faces.size(); ++i) {
            const Vector2d &a = contour.points[i], &b = contour.points[(i + 1) % contour.points.size()];
            if ((a.y() <= height) == (b.y() <= height)) continue;
            maximum = std::max(maximum, -(a.x() + (height - a.y()) / (b.y() - a.y()) * (b.x() - a.x())));
        }
    return maximum;
}

constexpr int steps = 200;

/// Corners of the outer profile: where the poly-line of 200 distances bends by more than 25 degrees over 1/40 of the height, at
/// the sharpest point of each such interval.
std::vector<Profile::Edge> breaks(const Profile& profile) {
    constexpr int window = 5;
    std::vector<Vector2d> line;
    for (std::size_t i = 0; i < steps; ++i)
        line.emplace_back(profile.extent[i], profile.low + (profile.high - profile.low) * (double(i) + 0.5) / steps);
    std::vector<double> turn(steps, 0);
    for (std::size_t i = window; i + window < steps; ++i) {
        const Vector2d a = line[i] - line[i - window], b = line[i + window] - line[i];
        turn[i] = std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
    }
    std::vector<Profile::Edge> edges;
    for (std::size_t i = 2 * window; i + 2 * window < steps; ++i) {
        if (turn[i] < 25 * pi / 180) continue;
        bool sharpest = true;
        for (std::size_t k = i - window; k <= i + window; ++k)
            sharpest = sharpest && (turn[k] < turn[i] || (turn[k] == turn[i] && k >= i));
        if (sharpest) edges.push_back({line[i].y(), line[i].x()});
    }
    return edges;
}

/// The one of 36 directions in which the mesh protrudes farthest from the section's outer side.
double widest(const Mesh& mesh, const SliceFrame& axis, const Profile& profile) {
    std::vector<double> maximum(36, -std::numeric_limits<double>::infinity());
    for (const Vertex v : mesh.vertices()) {
        const Vector2d place = axis.place(mesh.point(v));
        const double wall = profile.extent_at(axis.height(mesh.point(v)));
        for (std::size_t k = 0; k < 36; ++k)
            maximum[k] = std::max(maximum[k],
                                  std::cos(double(k) * pi / 18) * place.x() + std::sin(double(k) * pi / 18) * place.y() - wall);
    }
    std::size_t best = 0;
    for (std::size_t k = 1; k < 36; ++k)
        if (maximum[k] > maximum[best] + 1e-9 * std::abs(maximum[best])) best = k;
    return double(best) * pi / 18;
}

/// Whether a protruding part is in front of or behind the body in the view.
bool hides(const Mesh& mesh, const SliceFrame& axis, const Profile& profile) {
    const double size = profile.high - profile.low;
    const Vector2d along(std::cos(profile.view_angle), std::sin(profile.view_angle));
    return std::any_of(mesh.vertices().begin(), mesh.vertices().end(), [&](Vertex v) {
        const Vector2d place = axis.place(mesh.point(v));
        const double wall = profile.extent_at(axis.height(mesh.point(v)));
        return wall > 0 && place.norm() > wall + 0.05 * size && std::abs(along.dot(place)) < wall + 0.01 * size;
    });
}

}  // namespace

double Profile::extent_at(double height) const {
    if (extent.empty() || !(height >= low && height <= high)) return 0;
    const auto n = static_cast<long>(extent.size());
    const long place = std::clamp(static_cast<long>((height - low) / (high - low) * double(n)), 0L, n - 1);
    double maximum = 0;
    for (long k = std::max(0L, place - 1); k <= std::min(n - 1, place + 1); ++k)
        maximum = std::max(maximum, extent[static_cast<std::size_t>(k)]);
    return maximum;
}

Profile find_profile(const Mesh& mesh, const SliceFrame& axis, double angle) {
    Profile profile;
    std::tie(profile.low, profile.high) = height_range(mesh, axis);
    if (std::isnan(angle)) {
        std::vector<Half> halves;
        for (int k = 0; k < 36; ++k) {
            const double half_angle = k * pi / 18;
            halves.push_back(half_of(slice_mesh(mesh, section_frame(axis, half_angle), {0}).slices[0], half_angle));
        }
        const auto complete = [](const Half& half) { return half.open == 0 && half.area > 0; };
        if (std::any_of(halves.begin(), halves.end(), complete)) {
            std::erase_if(halves, [&](const Half& half) { return !complete(half); });
            std::stable_sort(halves.begin(), halves.end(), [](const Half& a, const Half& b) { return a.area < b.area; });
            angle = halves[(halves.size() - 1) / 2].angle;
        } else {
            if (std::any_of(halves.begin(), halves.end(), [](const Half& half) { return half.open > 0; }))
                std::erase_if(halves, [](const Half& half) { return !(half.open > 0); });
            std::stable_sort(halves.begin(), halves.end(), [](const Half& a, const Half& b) { return a.open < b.open; });
            angle = halves[(halves.size() - 1) / 2].angle;
        }
    }
    profile.angle = angle;
    profile.frame = section_frame(axis, angle);
    profile.section = slice_mesh(mesh, profile.frame, {0}).slices[0];
    const double size = profile.high - profile.low;
    for (int i = 0; i < steps; ++i) profile.extent.push_back(extent(profile.section, profile.low + size * (i + 0.5) / steps));
    auto heights = slice_heights(profile.low, profile.high, 24);
    for (const double fraction : {0.002, 0.005, 0.01, 0.015, 0.02, 0.03}) heights.push_back(profile.high - fraction * size);
    const auto stack = slice_mesh(mesh, axis, heights);
    const auto descriptors = describe_slices(stack.slices);
    std::size_t round = 0;
    for (std::size_t i = 0; i < 24; ++i) {
        round += descriptors[i].roundness_fitted_relative < 0.05 ? 1 : 0;
        profile.open += descriptors[i].open_length > descriptors[i].closed_length ? 1 : 0;
    }
    profile.is_revolved = 2 * round >= 24;
    // A wall without thickness has its mouth at the border of the mesh.
    const bool ends_open = std::any_of(mesh.vertices().begin(), mesh.vertices().end(), [&](Vertex v) {
        return !mesh.is_isolated(v) && mesh.is_border(v) && axis.height(mesh.point(v)) > profile.high - 0.03 * size;
    });
    for (std::size_t i = 24; i < heights.size(); ++i) {
        const auto& d = descriptors[i];
        const bool mouth = ends_open || d.holes > 0 || !stack.slices[i].completeness.complete();
        const bool arc =
            d.fitted_radius_high - d.fitted_radius_low < 0.2 * d.fitted_radius && d.fitted_centre.norm() < 0.1 * d.fitted_radius;
        if (!mouth || !(arc || d.roundness_fitted_relative < 0.1) || 2 * d.fitted_radius <= profile.rim_diameter) continue;
        profile.rim_diameter = 2 * d.fitted_radius;
        profile.rim_share = arc ? stack.slices[i].completeness.share : 1;
        profile.rim_low = arc ? 2 * d.fitted_radius_low : 0, profile.rim_high = arc ? 2 * d.fitted_radius_high : 0;
    }
    profile.view_angle = angle + pi;
    if (profile.is_revolved) {
        // Only where the slice is round and of similar radius: not on the edge of an arm or a handle.
        for (const auto& edge : breaks(profile)) {
            const auto layer = static_cast<std::size_t>(std::clamp((edge.height - profile.low) / size * 24, 0.0, 23.0));
            const auto& d = descriptors[layer];
            if (d.roundness_fitted_relative < 0.05 && edge.radius < 1.3 * d.fitted_radius) profile.edges.push_back(edge);
        }
        profile.view_angle = widest(mesh, axis, profile);
        profile.hides = hides(mesh, axis, profile);
    }
    profile.outline = silhouette(mesh, section_frame(axis, profile.view_angle + pi), 1000);
    return profile;
}

}  // namespace ostraka
