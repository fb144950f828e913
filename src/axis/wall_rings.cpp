#include "axis/wall_rings.h"

#include "ostraka/core/angles.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace ostraka::detail {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector4d;

namespace {

double arc_of(const std::vector<double>& turns) {
    std::vector<double> sorted = turns;
    std::sort(sorted.begin(), sorted.end());
    double gap = sorted.front() + 2 * pi - sorted.back();
    for (std::size_t i = 1; i < sorted.size(); ++i) gap = std::max(gap, sorted[i] - sorted[i - 1]);
    return 2 * pi - gap;
}

/// Share of the circle over which cells lie, with half a cell at both ends.
double share_of(const RevolutionPosterior& posterior, const std::vector<std::size_t>& cells) {
    const SpaceLine line = posterior.model->line(posterior.best);
    const Vector3d u = line.direction.unitOrthogonal(), w = line.direction.cross(u);
    std::vector<double> turns;
    for (const std::size_t i : cells) {
        const Vector3d d = posterior.model->cells()[i].p - line.point;
        turns.push_back(std::atan2(d.dot(w), d.dot(u)));
    }
    return turns.empty() ? 0 : std::min(1.0, arc_of(turns) / (2 * pi) * (1 + 1.0 / double(turns.size())));
}

/// Mean of the cells' radii and heights, and its error. `place_variance`: of the radius of the ring among the cells.
void finish(const RevolutionPosterior& posterior, const std::vector<double>& radius, double ring_radius, double place_variance,
            WallRing& ring) {
    const std::vector<double> heights = posterior.model->heights(posterior.best);
    double sum = 0, count = 0, height = 0;
    for (const std::size_t i : ring.cells) {
        const double n = posterior.model->cells()[i].count;
        sum += radius[i], count += n, height += heights[i];
    }
    ring.correction = ring_radius - sum / double(ring.cells.size());
    ring.height = std::clamp(posterior.model->relative_height(height / double(ring.cells.size())), -1.0, 1.0);
    const double sigma = posterior.model->sheets()[posterior.model->cells()[ring.cells[0]].sheet].sigma;
    ring.error = std::sqrt(sigma * sigma / std::max(1.0, count) + place_variance);
    ring.share = share_of(posterior, ring.cells);
}

/// Radius of the highest place of a section, and its variance.
struct SectionTop {
    double radius, variance;
};
/// A section about a point in it: distance as a cubic of the angle from the vertical.
class PolarSection {
public:
    explicit PolarSection(const Eigen::Vector4d& coefficients, double low, double high)
        : coefficients_(coefficients), low_(low), high_(high) {}
    [[nodiscard]] double at(double angle) const {
        return coefficients_[0] + angle * (coefficients_[1] + angle * (coefficients_[2] + angle * coefficients_[3]));
    }
    /// Angle of the highest place.
    [[nodiscard]] double top() const {
        constexpr int steps = 60;
        double best = low_, high = -1e300;
        for (int k = 0; k <= steps; ++k) {
            const double angle = low_ + (high_ - low_) * k / steps, height = at(angle) * std::cos(angle);
            if (height > high) high = height, best = angle;
        }
        double left = std::max(low_, best - (high_ - low_) / steps), right = std::min(high_, best + (high_ - low_) / steps);
        for (int k = 0; k < 60; ++k) {
            const double a = left + (right - left) / 3, b = right - (right - left) / 3;
            (at(a) * std::cos(a) < at(b) * std::cos(b) ? left : right) = at(a) * std::cos(a) < at(b) * std::cos(b) ? a : b;
        }
        return (left + right) / 2;
    }
    /// Distance aside of the highest place.
    [[nodiscard]] double aside() const {
        const double angle = top();
        return at(angle) * std::sin(angle);
    }

private:
    Eigen::Vector4d coefficients_;
    double low_, high_;
};

/// The highest place of points of a section (radius, height upwards), from a polar curve about the centre of their circle. None
/// if they are flat or if the highest place is at their end.
std::optional<SectionTop> top_of_section(const std::vector<Eigen::Vector2d>& points) {
    if (points.size() < 12) return {};
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const auto& p : points) mean += p;
    mean /= double(points.size());
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Vector3d b = Vector3d::Zero();
    double extent = 0;
    for (const auto& p : points) {
        const Eigen::Vector2d d = p - mean;
        const Vector3d row(2 * d.x(), 2 * d.y(), 1);
        A += row * row.transpose(), b += d.squaredNorm() * row;
        extent = std::max(extent, std::abs(d.x()));
    }
    const Vector3d circle = A.inverse() * b;
    const Eigen::Vector2d centre = mean + circle.head<2>();
    const double radius = std::sqrt(std::max(0.0, circle[2] + circle.head<2>().squaredNorm()));
    // Flat, or hollow.
    if (!circle.allFinite() || radius > 4 * extent || circle[1] > 0) return {};
    Matrix4d normal = Matrix4d::Zero();
    Vector4d right = Vector4d::Zero();
    double low = 1e300, high = -1e300, squares = 0;
    std::vector<std::pair<double, double>> polar;
    for (const auto& p : points) {
        const Eigen::Vector2d d = p - centre;
        const double u = std::atan2(d.x(), d.y());
        if (std::abs(u) > 1.4) continue;
        polar.emplace_back(u, d.norm());
        const Vector4d row(1, u, u * u, u * u * u);
        normal += row * row.transpose(), right += d.norm() * row;
        low = std::min(low, u), high = std::max(high, u);
    }
    if (polar.size() < 12 || high - low < 0.4) return {};
    for (int k = 0; k < 4; ++k) normal(k, k) *= 1 + 1e-9;
    const Matrix4d inverse = normal.inverse();
    const Vector4d coefficients = inverse * right;
    const PolarSection section(coefficients, low, high);
    const double angle = section.top();
    if (!inverse.allFinite() || angle < low + 0.02 * (high - low) || angle > high - 0.02 * (high - low)) return {};
    for (const auto& [u, distance] : polar) squares += std::pow(distance - section.at(u), 2);
    Vector4d slope;
    for (int k = 0; k < 4; ++k) {
        const double step = 1e-3 * radius;
        slope[k] = (PolarSection(coefficients + step * Vector4d::Unit(k), low, high).aside() -
                    PolarSection(coefficients - step * Vector4d::Unit(k), low, high).aside()) /
                   (2 * step);
    }
    return SectionTop{centre.x() + section.aside(), squares / double(polar.size() - 4) * slope.dot(inverse * slope)};
}

/// A lip.
struct Lip {
    WallRing ring;     ///< the ring at its top
    double depth;      ///< how far the lip falls off from its top
    double roughness;  ///< deviation of its surface from its profile
};
/// None for a floor or for a lip that is no end of the walls.
std::optional<Lip> ring_of_lip(const RevolutionPosterior& posterior, std::size_t sheet, const std::vector<double>& radius,
                               const std::vector<double>& height) {
    const RevolutionModel& model = *posterior.model;
    // Above or below the walls, whatever the orientation of the faces.
    double lip_height = 0, wall_height = 0, lip_cells = 0, wall_cells = 0;
    for (std::size_t i = 0; i < radius.size(); ++i) {
        if (model.cells()[i].sheet == sheet) lip_height += height[i], ++lip_cells;
        else if (model.sheets()[model.cells()[i].sheet].wall) wall_height += height[i], ++wall_cells;
    }
    const double side = lip_height * wall_cells > wall_height * lip_cells ? 1 : -1;
    std::vector<std::size_t> members;
    double inner = 1e300, outer = -1e300, top = -1e300, walls = -1e300, lowest_wall = 1e300, lowest_lip = 1e300;
    for (std::size_t i = 0; i < radius.size(); ++i) {
        const double h = side * height[i], r = std::abs(radius[i]);
        if (model.cells()[i].sheet == sheet)
            members.push_back(i), inner = std::min(inner, r), outer = std::max(outer, r), top = std::max(top, h),
                                  lowest_lip = std::min(lowest_lip, h);
        else if (model.sheets()[model.cells()[i].sheet].wall) walls = std::max(walls, h), lowest_wall = std::min(lowest_wall, h);
    }
    if (members.size() < 8 || outer - inner > 0.25 * outer || top < walls - 0.02 * (walls - lowest_wall)) return {};
    // On a leaning wall the top is beyond the sheet of the lip: cells of its neighbours are used too.
    const double margin = 0.7 * (outer - inner), from = inner - margin, width = outer - inner + 2 * margin;
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < radius.size(); ++i)
        if (model.sheets()[model.cells()[i].sheet].used && side * height[i] > lowest_lip - margin && std::abs(radius[i]) > from &&
            std::abs(radius[i]) < from + width)
            near.push_back(i);
    // Mean heights of rows by radius have the top.
    constexpr int rows = 13;
    std::array<double, rows> sum{}, count{};
    for (const std::size_t i : near) {
        const auto row =
            static_cast<std::size_t>(std::clamp(rows * (std::abs(radius[i]) - from) / std::max(1e-12, width), 0.0, rows - 1.0));
        sum[row] += side * height[i], count[row] += 1;
    }
    const double most = *std::max_element(count.begin(), count.end());
    double best = -1e300, lowest = 1e300;
    for (std::size_t k = 0; k < rows; ++k)
        if (count[k] > most / 4) best = std::max(best, sum[k] / count[k]), lowest = std::min(lowest, sum[k] / count[k]);
    // A polar curve through the points near the top, or the middle of a flat lip.
    const double depth = std::max(0.25 * (outer - inner), 3 * model.sheets()[sheet].sigma);
    WallRing ring;
    ring.rim = true;
    std::vector<Eigen::Vector2d> section, wide_section;
    double mean = 0, squares = 0;
    for (const std::size_t i : near) {
        if (side * height[i] > best - 1.5 * depth) wide_section.emplace_back(std::abs(radius[i]), side * height[i]);
        if (side * height[i] < best - depth) continue;
        ring.cells.push_back(i);
        section.emplace_back(std::abs(radius[i]), side * height[i]);
        mean += section.back().x(), squares += section.back().x() * section.back().x();
    }
    if (ring.cells.size() < 5) return {};
    mean /= double(ring.cells.size());
    const double sign = radius[ring.cells[0]] < 0 ? -1 : 1, spread = squares / double(ring.cells.size()) - mean * mean;
    SectionTop at = top_of_section(section).value_or(SectionTop{mean, std::max(0.0, spread) / 16});
    // The top depends on the shape of the lip too: the difference from that of a wider section counts as an error.
    if (const auto wider = top_of_section(wide_section)) at.variance += std::pow(wider->radius - at.radius, 2) / 2;
    finish(posterior, radius, sign * at.radius, at.variance, ring);
    // A lip that is preserved along less than half of the wall is a corner of it.
    if (ring.share < 0.5 * model.arc() / (2 * pi)) return {};
    return Lip{std::move(ring), best - lowest, model.sheets()[sheet].sigma};
}

}  // namespace

WallRing widest_ring(const RevolutionPosterior& posterior) {
    const RevolutionModel& model = *posterior.model;
    const std::vector<double> radius = model.radii(posterior.best), height = model.heights(posterior.best);
    std::vector<std::pair<double, std::size_t>> wide;
    double low = 1e300, high = -1e300;
    for (std::size_t i = 0; i < radius.size(); ++i)
        if (model.sheets()[model.cells()[i].sheet].used && model.robust()[i] > 0) {
            wide.emplace_back(std::abs(radius[i]), i);
            low = std::min(low, height[i]), high = std::max(high, height[i]);
        }
    std::sort(wide.begin(), wide.end());
    // The height of the widest cells, and the cells of their sheet near this height.
    WallRing ring;
    if (wide.empty()) return ring;
    const std::size_t few = std::max<std::size_t>(1, wide.size() / 50);
    std::vector<double> heights;
    for (std::size_t k = wide.size() - few; k < wide.size(); ++k) heights.push_back(height[wide[k].second]);
    std::nth_element(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2), heights.end());
    const double middle = heights[heights.size() / 2];
    const std::size_t sheet = model.cells()[wide.back().second].sheet;
    for (const auto& [r, i] : wide)
        if (model.cells()[i].sheet == sheet && std::abs(height[i] - middle) < 0.05 * (high - low)) ring.cells.push_back(i);
    if (ring.cells.empty()) ring.cells.push_back(wide.back().second);
    // Widest cells are widest by noise too: the ring has the largest radius of a smooth profile through the cells.
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Vector3d b = Vector3d::Zero();
    const auto row_at = [&](double h) {
        const double x = (h - middle) / (0.05 * (high - low) + 1e-12);
        return Vector3d(1, x, x * x);
    };
    for (const std::size_t i : ring.cells)
        A += row_at(height[i]) * row_at(height[i]).transpose(), b += std::abs(radius[i]) * row_at(height[i]);
    A.diagonal().array() += 1e-6 * A(0, 0);
    const Matrix3d inverse = A.inverse();
    const Vector3d profile = inverse * b;
    double most = -1e300, variance = 0;
    const double sigma = model.sheets()[sheet].sigma;
    for (const std::size_t i : ring.cells)
        if (const double r = row_at(height[i]).dot(profile); r > most)
            most = r, variance = sigma * sigma * row_at(height[i]).dot(inverse * row_at(height[i]));
    finish(posterior, radius, radius[ring.cells[0]] < 0 ? -most : most, variance, ring);
    return ring;
}

WallRing diameter_ring(const RevolutionPosterior& posterior) {
    const RevolutionModel& model = *posterior.model;
    const std::vector<double> radius = model.radii(posterior.best), height = model.heights(posterior.best);
    std::vector<Lip> lips;
    double smoothest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < model.sheets().size(); ++k) {
        const WallSheet& sheet = model.sheets()[k];
        if (sheet.wall || !sheet.used) continue;
        if (std::optional<Lip> lip = ring_of_lip(posterior, k, radius, height)) {
            smoothest = std::min(smoothest, sheet.sigma);
            lips.push_back(std::move(*lip));
        }
    }
    // A straight fracture is level too, but rougher than a lip. Of two smooth ends the more rounded one is the lip.
    constexpr double rough = 1.5;
    std::erase_if(lips, [&](const Lip& lip) { return lip.roughness > rough * smoothest; });
    const auto best = std::max_element(lips.begin(), lips.end(), [](const Lip& a, const Lip& b) { return a.depth < b.depth; });
    return best == lips.end() ? widest_ring(posterior) : best->ring;
}

std::vector<double> ring_diameters(const RevolutionPosterior& posterior, const WallRing& ring) {
    std::vector<double> diameters;
    Random random(1, 1);
    for (std::size_t k = 0; k < posterior.samples.size(); ++k) {
        const std::vector<double> radius = posterior.model->radii(posterior.samples[k]);
        double sum = 0;
        for (const std::size_t i : ring.cells) sum += radius[i];
        const double value = sum / double(ring.cells.size()) + ring.correction + ring.error * random.normal();
        const double deviation = posterior.deviations[k][0] + ring.height * posterior.deviations[k][1];
        diameters.push_back(value > 0 ? 2 * value / (1 + std::max(-0.5, deviation)) : std::numeric_limits<double>::infinity());
    }
    return diameters;
}

}  // namespace ostraka::detail
