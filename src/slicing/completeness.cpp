// What is there of a slice's outline.
#include "settling.h"

#include "ostraka/core/angles.h"
#include "ostraka/geom/circle.h"

#include <algorithm>
#include <cmath>

namespace ostraka::detail {

using Eigen::Vector2d;

namespace {

/// What the contours cover of the full turn around a place, radians.
double angle_covered(const std::vector<Contour>& contours, const Vector2d& centre) {
    constexpr double turn = 2 * pi;
    std::vector<std::pair<double, double>> arcs;
    const auto add = [&](double from, double to) { arcs.emplace_back(from, to); };
    for (const auto& contour : contours)
        for (std::size_t i = 0; i < contour.faces.size(); ++i) {
            const Vector2d a = contour.points[i] - centre, b = contour.points[(i + 1) % contour.points.size()] - centre;
            double from = std::atan2(a.y(), a.x()), to = std::atan2(b.y(), b.x());
            if (from > to) std::swap(from, to);
            if (to - from <= turn / 2) {
                add(from, to);
            } else {
                add(to, turn / 2);
                add(-turn / 2, from);
            }
        }
    std::sort(arcs.begin(), arcs.end());
    double sum = 0, reached = -turn / 2;
    for (const auto& [from, to] : arcs) {
        sum += std::max(0.0, to - std::max(from, reached));
        reached = std::max(reached, to);
    }
    return std::min(sum, turn);
}

}  // namespace

Completeness completeness(const std::vector<Contour>& contours) {
    Completeness result;
    double length = 0, closed = 0, gaps = 0;
    Vector2d centre = Vector2d::Zero();
    for (const auto& contour : contours) {
        length += contour.length, gaps += contour.gap;
        if (contour.closed) closed += contour.length;
        result.crossing += contour.crosses ? 1 : 0, result.turned += contour.turned ? 1 : 0;
        for (std::size_t i = 0; i < contour.faces.size(); ++i) {
            const Vector2d &a = contour.points[i], &b = contour.points[(i + 1) % contour.points.size()];
            centre += (b - a).norm() * (a + b) / 2;
        }
    }
    if (contours.empty() || contours.back().closed) return result;
    result.closed_share = closed / length;
    result.share = length / (length + gaps);
    PlaneSegments segments;
    for (const auto& contour : contours)
        for (std::size_t i = 0; i < contour.faces.size(); ++i)
            segments.emplace_back(contour.points[i], contour.points[(i + 1) % contour.points.size()]);
    const Circle circle = fit_circle(segments);
    result.angle = angle_covered(contours, circle.radius > 0 ? circle.centre : Vector2d(centre / length));
    return result;
}

}  // namespace ostraka::detail
