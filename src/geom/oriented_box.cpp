// Oriented bounding box: directions are tested on a few hundred extreme points; the result is measured on all points.
#include "ostraka/geom/oriented_box.h"
#include "ostraka/algebra/dense.h"
#include "ostraka/core/angles.h"

#include "geom/calipers.h"

#include "ostraka/execution/parallel.h"
#include "ostraka/mesh/mesh.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace ostraka {

using namespace detail;

namespace {

using Array3 = std::array<double, 3>;

Vector3d vector(const Array3& p) { return {p[0], p[1], p[2]}; }

/// Evenly distributed directions on a hemisphere (Fibonacci lattice).
std::vector<Vector3d> directions(int count) {
    std::vector<Vector3d> list;
    for (int i = 0; i < count; ++i) {
        const double z = (i + 0.5) / count, r = std::sqrt(1 - z * z), turn = i * pi * (3 - std::sqrt(5.0));
        list.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
    }
    return list;
}

/// Axis-parallel boxes of consecutive points, with which the extreme points of many directions are found without reading most of
/// the points.
class PointBlocks {
public:
    explicit PointBlocks(const std::vector<Array3>& points) : points_(points), boxes_((points.size() + size - 1) / size) {
        parallel_for(boxes_.size(), 64, [&](std::size_t b) {
            Box& box = boxes_[b];
            for (std::size_t v = b * size; v < end(b); ++v)
                for (std::size_t c = 0; c < 3; ++c) {
                    box.low[c] = std::min(box.low[c], points_[v][c]);
                    box.high[c] = std::max(box.high[c], points_[v][c]);
                }
        });
        for (const Box& box : boxes_)
            for (std::size_t c = 0; c < 3; ++c)
                rounding_ = std::max({rounding_, 1e-14 * std::abs(box.low[c]), 1e-14 * std::abs(box.high[c])});
    }

    /// Index of the first point that is lowest along the direction n, a unit vector.
    [[nodiscard]] Index lowest(const Vector3d& n) const {
        Lowest best;
        std::size_t first = 0;
        std::vector<double> bounds(boxes_.size());
        for (std::size_t b = 0; b < boxes_.size(); ++b) {
            bounds[b] = bound(boxes_[b], n);
            if (bounds[b] < bounds[first]) first = b;
        }
        search(first, n, best);
        for (std::size_t b = 0; b < boxes_.size(); ++b)
            if (b != first && bounds[b] - rounding_ <= best.height) search(b, n, best);
        return best.point;
    }

private:
    static constexpr std::size_t size = 128;
    static constexpr double infinite = std::numeric_limits<double>::infinity();
    struct Box {
        Array3 low{infinite, infinite, infinite}, high{-infinite, -infinite, -infinite};
    };
    struct Lowest {
        double height = infinite;
        Index point = 0;
    };

    [[nodiscard]] std::size_t end(std::size_t b) const { return std::min((b + 1) * size, points_.size()); }
    /// Lower bound of the heights in a block, apart from rounding.
    static double bound(const Box& box, const Vector3d& n) {
        double height = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const double slope = n[static_cast<Eigen::Index>(c)];
            height += slope * (slope > 0 ? box.low[c] : box.high[c]);
        }
        return height;
    }
    void search(std::size_t b, const Vector3d& n, Lowest& best) const {
        for (std::size_t v = b * size; v < end(b); ++v) {
            const double height = n[0] * points_[v][0] + n[1] * points_[v][1] + n[2] * points_[v][2];
            if (height < best.height || (height == best.height && v < best.point)) best = {height, static_cast<Index>(v)};
        }
    }

    const std::vector<Array3>& points_;
    std::vector<Box> boxes_;
    double rounding_ = 0;  ///< bound of the rounding error of heights
};

/// The extreme points in each direction and in its opposite.
std::vector<Vector3d> extreme_points(const std::vector<Array3>& points, const PointBlocks& blocks,
                                     const std::vector<Vector3d>& along) {
    std::vector<Index> extreme(2 * along.size(), 0);
    parallel_for(extreme.size(), 4,
                 [&](std::size_t k) { extreme[k] = blocks.lowest(k % 2 == 0 ? along[k / 2] : Vector3d(-along[k / 2])); });
    std::sort(extreme.begin(), extreme.end());
    extreme.erase(std::unique(extreme.begin(), extreme.end()), extreme.end());
    std::vector<Vector3d> list;
    for (const Index v : extreme) list.push_back(vector(points[v]));
    return list;
}

struct Candidate {
    double volume = std::numeric_limits<double>::infinity();
    Vector3d normal = Vector3d::UnitZ(), side = Vector3d::UnitX();
    std::vector<Index> outline;  ///< indices of the corners of the convex hull of the points' projection, counter-clockwise
};

/// A point of a projection, with its index.
struct Projected {
    double x = 0, y = 0;
    Index index = 0;
    double operator[](int c) const { return c == 0 ? x : y; }
};

/// Removes points that lie clearly inside the polygon with the given corners, and therefore are no corners of the convex hull.
/// The points are compared with an ellipse inside the polygon. Removes nothing if the polygon is not star-shaped around the mean
/// of its corners, or too thin.
void remove_interior(std::vector<Projected>& points, const std::vector<Index>& corners) {
    if (corners.size() < 3) return;
    Vector2d centre = Vector2d::Zero();
    for (const Index k : corners) centre += Vector2d(points[k].x, points[k].y);
    centre /= static_cast<double>(corners.size());
    double xx = 0, xy = 0, yy = 0;
    for (const Index k : corners) {
        const double x = points[k].x - centre[0], y = points[k].y - centre[1];
        xx += x * x, xy += x * y, yy += y * y;
    }
    // With the Cholesky factor of the scatter, distances are measured in units in which the corners lie around a circle.
    if (!(xx * yy - xy * xy > 1e-6 * xx * yy)) return;
    const double a = 1 / std::sqrt(xx), slope = xy / xx, b = 1 / std::sqrt(yy - xy * slope);
    const auto scaled = [&](const Projected& p) {
        const double x = p.x - centre[0], y = p.y - centre[1];
        return Vector2d(a * x, b * (y - slope * x));
    };
    double radius = std::numeric_limits<double>::infinity();
    Vector2d from = scaled(points[corners.back()]);
    for (const Index k : corners) {
        const Vector2d to = scaled(points[k]);
        const double twice_area = from[0] * to[1] - from[1] * to[0];
        if (!(twice_area > 0)) return;
        radius = std::min(radius, twice_area / (to - from).norm());
        from = to;
    }
    const double limit = radius * radius * (1 - 1e-6);
    points.erase(
        std::remove_if(points.begin(), points.end(), [&](const Projected& p) { return scaled(p).squaredNorm() < limit; }),
        points.end());
}

/// The smallest box with a face perpendicular to `normal`. `outline`: corners of the hull for a similar normal; may be empty.
Candidate box_across(const Vector3d& normal, const std::vector<Vector3d>& points, const std::vector<Index>& outline = {}) {
    const Vector3d u = normal.unitOrthogonal(), w = normal.cross(u);
    std::vector<Projected> flat;
    flat.reserve(points.size());
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vector3d& p : points) {
        flat.push_back({u.dot(p), w.dot(p), static_cast<Index>(flat.size())});
        low = std::min(low, normal.dot(p));
        high = std::max(high, normal.dot(p));
    }
    remove_interior(flat, outline);
    const auto corners = convex_hull(std::move(flat), [](const Projected& a, const Projected& b, const Projected& c) {
        return (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x) > 0;
    });
    std::vector<Vector2d> hull;
    for (const Projected& corner : corners) hull.emplace_back(corner.x, corner.y);
    Candidate best;
    best.normal = normal;
    for (const Projected& corner : corners) best.outline.push_back(corner.index);
    // Flat objects have boxes without volume; a small multiple of the cubed sum of the sides ranks them.
    const auto cost_of = [&](const Extent& e) {
        const double thickness = high - low, x = e.x1 - e.x0, y = e.y1 - e.y0, sum = thickness + x + y;
        return thickness * x * y + 1e-9 * sum * sum * sum;
    };
    // One side of the smallest rectangle lies on a side of the hull.
    const auto search = [&](const auto& extent_of) {
        Vector2d along = Vector2d::UnitX();
        for (std::size_t i = 0; i < hull.size(); ++i) {
            Vector2d a = hull[(i + 1) % hull.size()] - hull[i];
            if (a.norm() == 0) a = Vector2d::UnitX();
            a.normalize();
            const double cost = cost_of(extent_of(i, a));
            if (cost < best.volume) {
                best.volume = cost;
                along = a;
            }
        }
        best.side = (along[0] * u + along[1] * w).normalized();
        return along;
    };
    Calipers calipers(hull);
    const Vector2d along = search([&](std::size_t i, const Vector2d& a) { return calipers.along(i, a); });
    // Very short sides have arbitrary directions, with which the calipers may fail; then all corners are tested.
    if (const double true_cost = cost_of(extent_along(along, hull)); std::abs(true_cost - best.volume) > 1e-9 * true_cost) {
        best.volume = std::numeric_limits<double>::infinity();
        search([&](std::size_t, const Vector2d& a) { return extent_along(a, hull); });
    }
    return best;
}

/// Pattern search for the normal, with step sizes halved down to `finest`; the smallest perpendicular rectangle is exact for
/// each normal. When it ends, the other two axes are tried as normals.
Candidate refine(Candidate best, const std::vector<Vector3d>& points, double coarsest, double finest) {
    for (int round = 0; round < 4; ++round) {
        int moves = 0;
        for (double step = coarsest; step > finest;) {
            Candidate better = best;
            for (int k = 0; k < 8; ++k) {
                const Vector3d u = best.side, w = best.normal.cross(u);
                const double turn = k * pi / 4;
                const Candidate next = box_across((best.normal + step * (std::cos(turn) * u + std::sin(turn) * w)).normalized(),
                                                  points, best.outline);
                if (next.volume < better.volume) better = next;
            }
            // A gain must be proportional to the step, and the number of moves per step size is limited: otherwise the search
            // circles around round objects.
            if (better.volume < best.volume * (1 - 1e-3 * step) && ++moves <= 16) {
                best = better;
            } else {
                step /= 2;
                moves = 0;
            }
        }
        Candidate turned = best;
        for (const Vector3d& axis : {best.side, Vector3d(best.normal.cross(best.side))})
            if (const Candidate next = box_across(axis.normalized(), points); next.volume < turned.volume) turned = next;
        if (turned.volume > best.volume * (1 - 1e-12)) break;
        best = turned;
    }
    return best;
}

/// Refines all candidates and sorts them by volume.
void refine_all(std::vector<Candidate>& candidates, const std::vector<Vector3d>& points, double coarsest, double finest) {
    parallel_for(candidates.size(), 1, [&](std::size_t i) { candidates[i] = refine(candidates[i], points, coarsest, finest); });
    std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) { return a.volume < b.volume; });
}

/// Directions in narrow cones around the axes of a box.
std::vector<Vector3d> directions_around(const Candidate& box) {
    std::vector<Vector3d> list;
    const std::array<Vector3d, 3> axes{box.side, box.normal.cross(box.side), box.normal};
    for (std::size_t k = 0; k < 3; ++k) {
        list.push_back(axes[k]);
        for (int i = 0; i < 24; ++i) {
            const double turn = i * pi / 4, tilt = 0.02 * std::exp2(i / 8);
            list.push_back(
                (axes[k] + tilt * (std::cos(turn) * axes[(k + 1) % 3] + std::sin(turn) * axes[(k + 2) % 3])).normalized());
        }
    }
    return list;
}

}  // namespace

OrientedBox oriented_box(const std::vector<Array3>& points) {
    OrientedBox box;
    box.axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    if (points.empty()) return box;
    const PointBlocks blocks(points);
    std::vector<Vector3d> extreme = extreme_points(points, blocks, directions(points.size() > 50000 ? 128 : 512));
    // Directions do not depend on position and scale; coordinates near one keep products in range.
    const Vector3d origin = extreme.front();
    double extent = 0;
    for (const auto& p : extreme) extent = std::max(extent, (p - origin).cwiseAbs().maxCoeff());
    const auto near_one = [&](std::vector<Vector3d>& list) {
        for (auto& p : list) p = extent > 0 ? Vector3d((p - origin) / extent) : Vector3d::Zero();
    };
    near_one(extreme);

    std::vector<Vector3d> tried = directions(400);
    Vector3d mean = Vector3d::Zero();
    for (const auto& p : extreme) mean += p / static_cast<double>(extreme.size());
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const auto& p : extreme) scatter += (p - mean) * (p - mean).transpose();
    const SymmetricEigen3 principal(scatter);
    for (int k = 0; k < 3; ++k) {
        tried.push_back(Vector3d::Unit(k));
        tried.push_back(principal.eigenvectors().col(k).normalized());
    }
    std::vector<Candidate> all(tried.size());
    parallel_for(tried.size(), 16, [&](std::size_t i) { all[i] = box_across(tried[i], extreme); });
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.volume < b.volume; });
    // The best candidate of each neighbourhood, since their local minima differ.
    std::vector<Candidate> candidates;
    for (const Candidate& next : all) {
        if (candidates.size() == 48) break;
        if (std::none_of(candidates.begin(), candidates.end(),
                         [&](const Candidate& c) { return std::abs(c.normal.dot(next.normal)) > 0.98; }))
            candidates.push_back(next);
    }
    refine_all(candidates, extreme, 0.05, 4e-3);
    candidates.resize(std::min<std::size_t>(candidates.size(), 6));
    // The extreme points in the directions of these boxes may be missing so far.
    std::vector<Vector3d> around;
    for (const Candidate& candidate : candidates) {
        const std::vector<Vector3d> list = directions_around(candidate);
        around.insert(around.end(), list.begin(), list.end());
    }
    std::vector<Vector3d> more = extreme_points(points, blocks, around);
    near_one(more);
    extreme.insert(extreme.end(), more.begin(), more.end());
    for (Candidate& candidate : candidates) candidate = box_across(candidate.normal, extreme);
    refine_all(candidates, extreme, 0.02, 1e-9);
    const Candidate best = candidates.front();

    const std::array<Vector3d, 3> axes{best.side, best.normal.cross(best.side).normalized(), best.normal};
    std::array<double, 3> low, high;
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    for (const auto& p : points)
        for (std::size_t k = 0; k < 3; ++k) {
            const double height = axes[k].dot(vector(p) - origin);
            low[k] = std::min(low[k], height);
            high[k] = std::max(high[k], height);
        }
    std::array<std::size_t, 3> order{0, 1, 2};
    std::stable_sort(order.begin(), order.end(), [&](auto i, auto j) { return high[i] - low[i] > high[j] - low[j]; });
    Vector3d centre = origin;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t from = order[k];
        box.sides[k] = high[from] - low[from];
        for (std::size_t c = 0; c < 3; ++c) box.axes[k][c] = axes[from][static_cast<Eigen::Index>(c)];
        centre += axes[from] * ((low[from] + high[from]) / 2);
    }
    if (vector(box.axes[0]).cross(vector(box.axes[1])).dot(vector(box.axes[2])) < 0)
        for (double& c : box.axes[2]) c = -c;
    box.centre = {centre[0], centre[1], centre[2]};
    return box;
}

}  // namespace ostraka
