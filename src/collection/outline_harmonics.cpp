#include "collection/outline_harmonics.h"
#include "ostraka/core/angles.h"

#include <Eigen/Geometry>

#include <cmath>

namespace ostraka {

namespace {

constexpr int directions = 360;

/// Distance of the contour from the centre in each direction; 0 where a ray misses the contour.
std::array<double, directions> radii_of(const Contour& contour, const Vector2d& centre) {
    std::array<double, directions> radii{};
    const std::size_t segment_count = contour.closed ? contour.points.size() : contour.points.size() - 1;
    for (std::size_t i = 0; i < segment_count; ++i) {
        const Vector2d a = contour.points[i] - centre, b = contour.points[(i + 1) % contour.points.size()] - centre;
        const double start_angle = std::atan2(a.y(), a.x());
        const double swept_angle = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
        // Directions are offset by half a step so that none is parallel to an axis.
        const double step = 2 * pi / directions;
        const double low = std::min(start_angle, start_angle + swept_angle) / step - 0.5,
                     high = std::max(start_angle, start_angle + swept_angle) / step - 0.5;
        for (auto d = static_cast<int>(std::ceil(low)); d <= static_cast<int>(std::floor(high)); ++d) {
            const double angle = (d + 0.5) * step;
            const Vector2d ray(std::cos(angle), std::sin(angle)), segment = b - a;
            const double across = ray.x() * segment.y() - ray.y() * segment.x();
            if (across == 0) continue;
            const double r = (a.x() * segment.y() - a.y() * segment.x()) / across;
            double& radius = radii.at(static_cast<std::size_t>(((d % directions) + directions) % directions));
            radius = std::max(radius, r);
        }
    }
    return radii;
}

}  // namespace

OutlineHarmonics outline_harmonics(const Contour& contour, const Vector2d& centre) {
    OutlineHarmonics result;
    if (contour.points.size() < 2) return result;
    const auto radii = radii_of(contour, centre);
    constexpr int columns = 1 + 2 * static_cast<int>(max_harmonics);
    Eigen::Matrix<double, columns, columns> normal = Eigen::Matrix<double, columns, columns>::Zero();
    Eigen::Matrix<double, columns, 1> right = Eigen::Matrix<double, columns, 1>::Zero(), row;
    int met = 0;
    for (int d = 0; d < directions; ++d) {
        const double r = radii.at(static_cast<std::size_t>(d));
        if (r <= 0) continue;
        ++met;
        const double angle = (d + 0.5) * 2 * pi / directions;
        row[0] = 1;
        for (int k = 1; k <= static_cast<int>(max_harmonics); ++k)
            row[2 * k - 1] = std::cos(k * angle), row[2 * k] = std::sin(k * angle);
        normal += row * row.transpose();
        right += r * row;
    }
    result.turn = static_cast<double>(met) / directions;
    if (met < columns) return result;
    // With all directions the matrix is diagonal and the damping reduces each harmonic by 1e-4.
    normal.diagonal().tail<columns - 1>().array() += 0.5e-4 * met;
    const Eigen::Matrix<double, columns, 1> x = normal.ldlt().solve(right);
    result.radius = x[0];
    for (std::size_t k = 1; k <= max_harmonics; ++k) {
        result.cosine.at(k) = x[static_cast<Eigen::Index>(2 * k - 1)];
        result.sine.at(k) = x[static_cast<Eigen::Index>(2 * k)];
    }
    return result;
}

}  // namespace ostraka
