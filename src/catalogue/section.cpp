#include "catalogue/section.h"

#include "ostraka/core/angles.h"

#include <algorithm>
#include <cmath>

namespace ostraka::detail {

namespace {

/// A point on a contour at equal distances from its neighbours, with the outward normal.
struct ContourSample {
    Vector2d place, normal;
};

std::vector<ContourSample> samples_of(const Slice& section, double spacing) {
    std::vector<ContourSample> samples;
    for (const Contour& contour : section.contours) {
        double ahead = spacing / 2;  // distance to the next sample
        for (std::size_t i = 0; i < contour.faces.size(); ++i) {
            const Vector2d &a = contour.points[i], &b = contour.points[(i + 1) % contour.points.size()];
            const Vector2d along = b - a;
            const double length = along.norm();
            if (!(length > 0)) continue;
            for (; ahead < length; ahead += spacing) {
                const Vector2d p = a + ahead / length * along;
                if (p.x() <= 0) samples.push_back({p, Vector2d(along.y(), -along.x()) / length});
            }
            ahead -= length;
        }
    }
    return samples;
}

double total_length(const Slice& section) {
    double length = 0;
    for (const Contour& contour : section.contours) length += contour.length;
    return length;
}

}  // namespace

SliceFrame section_frame(double angle) {
    SliceFrame frame;
    frame.u = Vector(-std::cos(angle), -std::sin(angle), 0);
    frame.v = Vector(0, 0, 1);
    frame.normal = CGAL::cross_product(frame.u, frame.v);
    return frame;
}

Slice section_at(const Mesh& mesh, double angle) { return slice_mesh(mesh, section_frame(angle), {0}).slices[0]; }

double best_section(const Pose& pose) {
    const WallGrid& grid = pose.grid;
    const std::vector<long> tops = grid.ends(true), bottoms = grid.ends(false);
    long longest = 0;
    const auto extent = [&](std::size_t bin) { return tops[bin] < 0 ? -1 : tops[bin] - bottoms[bin]; };
    const bool rim = pose.kind == CatalogueKind::rim;
    const auto allowed = [&](std::size_t bin) { return tops[bin] >= 0 && (!rim || pose.top.bins[bin]); };
    for (std::size_t bin = 0; bin < WallGrid::bins; ++bin)
        if (allowed(bin)) longest = std::max(longest, extent(bin));
    double best = pose.range.middle(), nearest = std::numeric_limits<double>::infinity();
    for (std::size_t bin = 0; bin < WallGrid::bins; ++bin) {
        if (!allowed(bin) || double(extent(bin)) < 0.96 * double(longest)) continue;
        const double angle = 2 * pi * (double(bin) + 0.5) / double(WallGrid::bins);
        const double away = std::abs(std::remainder(angle - pose.range.middle(), 2 * pi));
        if (away < nearest) nearest = away, best = angle;
    }
    return best;
}

std::vector<double> wall_thickness(const Slice& section) {
    constexpr int count = 700;
    const double length = total_length(section);
    if (!(length > 0)) return {};
    const std::vector<ContourSample> samples = samples_of(section, length / count);
    std::vector<double> values;
    for (const ContourSample& from : samples) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const ContourSample& to : samples) {
            const Vector2d between = to.place - from.place;
            const double inward = -between.dot(from.normal);
            if (!(inward > 0) || to.normal.dot(from.normal) > -0.7) continue;
            nearest = std::min(nearest, between.squaredNorm() / inward);
        }
        if (std::isfinite(nearest)) values.push_back(nearest);
    }
    return values;
}

std::vector<Vector2d> outer_profile(const Slice& section, double low, double high, std::size_t count) {
    std::vector<double> reach(count, 0);
    const double step = (high - low) / double(count);
    for (const Contour& contour : section.contours)
        for (std::size_t i = 0; i < contour.faces.size(); ++i) {
            const Vector2d &a = contour.points[i], &b = contour.points[(i + 1) % contour.points.size()];
            const double from = std::min(a.y(), b.y()), to = std::max(a.y(), b.y());
            const long first = std::max(0L, static_cast<long>(std::ceil((from - low) / step - 0.5)));
            for (long k = first; k < static_cast<long>(count) && low + step * (double(k) + 0.5) <= to; ++k) {
                const double height = low + step * (double(k) + 0.5);
                const double x =
                    a.y() == b.y() ? std::min(a.x(), b.x()) : a.x() + (height - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
                reach[static_cast<std::size_t>(k)] = std::max(reach[static_cast<std::size_t>(k)], -x);
            }
        }
    std::vector<Vector2d> profile;
    for (std::size_t k = 0; k < count; ++k)
        if (reach[k] > 0) profile.emplace_back(reach[k], low + step * (double(k) + 0.5));
    return profile;
}

std::vector<std::vector<Vector2d>> fracture_parts(const Slice& section, bool top, double thickness) {
    const double sign = top ? 1 : -1;
    double end = -std::numeric_limits<double>::infinity();
    for (const Contour& contour : section.contours)
        for (const Vector2d& p : contour.points)
            if (contour.closed && p.x() <= 0) end = std::max(end, sign * p.y());
    // Direction of the wall towards its end: from its points further away to those near the end.
    Vector2d near(0, 0), far(0, 0);
    double near_count = 0, far_count = 0;
    const std::vector<ContourSample> samples = samples_of(section, std::max(total_length(section) / 2000, thickness / 50));
    for (const ContourSample& sample : samples) {
        const double away = end - sign * sample.place.y();
        if (away < 1.5 * thickness) near += sample.place, near_count += 1;
        else if (away < 4 * thickness) far += sample.place, far_count += 1;
    }
    std::vector<std::vector<Vector2d>> parts;
    if (near_count == 0 || far_count == 0) return parts;
    const Vector2d outward = (near / near_count - far / far_count).normalized();
    for (const Contour& contour : section.contours) {
        if (!contour.closed) continue;
        bool open = false;
        for (std::size_t i = 0; i < contour.faces.size(); ++i) {
            const Vector2d &a = contour.points[i], &b = contour.points[(i + 1) % contour.points.size()];
            const Vector2d normal = Vector2d(b.y() - a.y(), a.x() - b.x()).normalized();
            const bool broken = a.x() <= 0 && end - sign * a.y() < 1.5 * thickness && normal.dot(outward) > 0.7;
            if (broken && !open) parts.push_back({a});
            if (broken) parts.back().push_back(b);
            open = broken;
        }
    }
    return parts;
}

}  // namespace ostraka::detail
