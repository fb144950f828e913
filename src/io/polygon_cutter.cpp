#include "io/polygon_cutter.h"

#include "ostraka/mesh/mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka::io {

namespace {

using Point2 = std::array<double, 2>;
using Point3 = std::array<double, 3>;

/// Exact orientation of a, b, c; 1 is to the left. `exact` counts the cases that need exact arithmetic.
int orientation(const Point2& a, const Point2& b, const Point2& c, std::size_t& exact) {
    const double ux = b[0] - a[0], uy = b[1] - a[1], vx = c[0] - a[0], vy = c[1] - a[1];
    if ((ux == 0 && vx == 0) || (uy == 0 && vy == 0)) return 0;  // the difference of equal numbers is exactly 0
    const double left = ux * vy, right = uy * vx, size = std::fabs(left) + std::fabs(right);
    // Shewchuk 1997: the error is below (3 + 16 e) e times the sum of the magnitudes, e = 2^-53, unless there is underflow.
    if (size > 1e-250 && std::fabs(left - right) > 4e-16 * size) return left > right ? 1 : -1;
    ++exact;
    using Flat = Kernel::Point_2;
    return CGAL::orientation(Flat(a[0], a[1]), Flat(b[0], b[1]), Flat(c[0], c[1]));
}

Point3 cross_of(const Point3& a, const Point3& b, const Point3& c) {
    const Point3 u{b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

double dot(const Point3& a, const Point3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// The largest power of two that prevents products of coordinates from overflowing; scaling by it is exact.
double safe_scale(const std::vector<Point3>& points, const std::uint32_t* corners, std::size_t count) {
    double largest = 0;
    for (std::size_t i = 0; i < count; ++i)
        for (const double x : points[corners[i]]) largest = std::max(largest, std::fabs(x));
    if (largest == 0) return 1;
    return std::ldexp(1.0, std::min(-std::ilogb(largest), 1000));
}

Point3 scaled(const Point3& p, double scale) { return {p[0] * scale, p[1] * scale, p[2] * scale}; }

}  // namespace

CutResult PolygonCutter::cut(const std::vector<Point3>& points, const std::uint32_t* corners, std::size_t count,
                             std::vector<Triple>& triangles) {
    drop_repeated(corners, count);
    if (kept_.size() < 3) return CutResult::clean;
    if (kept_.size() == 3) {
        const auto a = kept_[0], b = kept_[1], c = kept_[2];
        if (corners[a] != corners[b] && corners[b] != corners[c] && corners[c] != corners[a]) triangles.push_back({a, b, c});
        return CutResult::clean;
    }
    if (kept_.size() == 4 && corners[kept_[0]] != corners[kept_[2]] && corners[kept_[1]] != corners[kept_[3]]) {
        cut_quadrilateral(points, corners, triangles);
        return CutResult::clean;
    }
    project(points, corners);
    if (is_strictly_convex()) {
        // A vertex with very many triangles would slow down later algorithms.
        constexpr std::size_t large = 1000;
        if (kept_.size() > large) {
            std::vector<std::uint32_t> ring(kept_.size());
            std::iota(ring.begin(), ring.end(), 0U);
            halve(std::move(ring), corners, triangles);
            return CutResult::clean;
        }
        for (std::size_t i = 1; i + 1 < kept_.size(); ++i) triangles.push_back({kept_[0], kept_[i], kept_[i + 1]});
        return CutResult::clean;
    }
    return clip_ears(corners, triangles);
}

/// Drops corners that repeat their predecessor (cyclically).
void PolygonCutter::drop_repeated(const std::uint32_t* corners, std::size_t count) {
    kept_.clear();
    for (std::size_t i = 0; i < count; ++i)
        if (kept_.empty() || corners[kept_.back()] != corners[i]) kept_.push_back(static_cast<std::uint32_t>(i));
    while (kept_.size() > 1 && corners[kept_.back()] == corners[kept_.front()]) kept_.pop_back();
}

void PolygonCutter::cut_quadrilateral(const std::vector<Point3>& points, const std::uint32_t* corners,
                                      std::vector<Triple>& triangles) {
    const double scale = safe_scale(points, corners, kept_.back() + 1);
    std::array<Point3, 4> p;
    for (std::size_t i = 0; i < 4; ++i) p[i] = scaled(points[corners[kept_[i]]], scale);
    const bool first_upright = dot(cross_of(p[0], p[1], p[2]), cross_of(p[0], p[2], p[3])) > 0;
    const bool second_upright = dot(cross_of(p[1], p[2], p[3]), cross_of(p[1], p[3], p[0])) > 0;
    const auto squared = [](const Point3& a, const Point3& b) {
        const Point3 d{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
        return dot(d, d);
    };
    bool first = squared(p[0], p[2]) <= squared(p[1], p[3]);
    if (first_upright != second_upright) first = first_upright;
    const auto& k = kept_;
    if (first) {
        triangles.push_back({k[0], k[1], k[2]});
        triangles.push_back({k[0], k[2], k[3]});
    } else {
        triangles.push_back({k[0], k[1], k[3]});
        triangles.push_back({k[1], k[2], k[3]});
    }
}

/// Projects onto the coordinate plane in which the polygon's area (Newell's normal) is largest, mirrored if necessary so that
/// it is counter-clockwise; if the area is zero, onto the plane of its two largest extents.
void PolygonCutter::project(const std::vector<Point3>& points, const std::uint32_t* corners) {
    const double scale = safe_scale(points, corners, kept_.back() + 1);
    const Point3 origin = scaled(points[corners[kept_[0]]], scale);
    Point3 normal{0, 0, 0}, low = origin, high = origin;
    for (std::size_t i = 0; i < kept_.size(); ++i) {
        const Point3 a = scaled(points[corners[kept_[i]]], scale),
                     b = scaled(points[corners[kept_[(i + 1) % kept_.size()]]], scale);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t u = (k + 1) % 3, v = (k + 2) % 3;
            normal[k] += (a[u] - origin[u]) * (b[v] - origin[v]) - (a[v] - origin[v]) * (b[u] - origin[u]);
            low[k] = std::min(low[k], a[k]);
            high[k] = std::max(high[k], a[k]);
        }
    }
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
        if (std::fabs(normal[k]) > std::fabs(normal[axis])) axis = k;
    if (normal[axis] == 0) {
        axis = 0;
        for (std::size_t k = 1; k < 3; ++k)
            if (high[k] - low[k] < high[axis] - low[axis]) axis = k;
    }
    std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(u, v);
    flat_.resize(kept_.size());
    for (std::size_t i = 0; i < kept_.size(); ++i) {
        const Point3 p = scaled(points[corners[kept_[i]]], scale);
        flat_[i] = {p[u], p[v]};
    }
}

/// Cuts off every second corner until none is left: no corner is in more triangles than the logarithm of their number.
void PolygonCutter::halve(std::vector<std::uint32_t> ring, const std::uint32_t* corners, std::vector<Triple>& triangles) const {
    std::vector<std::uint32_t> remaining_ring;
    while (ring.size() > 2) {
        remaining_ring.clear();
        for (std::size_t i = 0; i < ring.size(); i += 2) {
            remaining_ring.push_back(ring[i]);
            if (i + 1 == ring.size()) continue;
            const Triple piece{kept_[ring[i]], kept_[ring[i + 1]], kept_[ring[i + 2 < ring.size() ? i + 2 : 0]]};
            const auto u = corners[piece[0]], v = corners[piece[1]], w = corners[piece[2]];
            if (u != v && v != w && w != u) triangles.push_back(piece);
        }
        ring.swap(remaining_ring);
    }
}

/// All turns are left turns, and the direction rotates once: it reverses from rightward to leftward and back once each.
bool PolygonCutter::is_strictly_convex() const {
    const std::size_t count = flat_.size();
    std::size_t reversals = 0, exact = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Point2 &a = flat_[i], &b = flat_[(i + 1) % count], &c = flat_[(i + 2) % count];
        if (orientation(a, b, c, exact) <= 0) return false;
        reversals += (a < b) != (b < c);
    }
    return reversals == 2;
}

std::array<std::size_t, 2> PolygonCutter::cell_of(const Point2& point) const {
    std::array<std::size_t, 2> cell{};
    for (std::size_t k = 0; k < 2; ++k) {
        const double place = std::floor((point[k] - grid_low_[k]) / grid_size_[k] * static_cast<double>(cells_));
        cell[k] = static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(cells_ - 1)));
    }
    return cell;
}

/// Only corners that are not strictly convex can lie inside an ear, and clipping never makes a convex corner reflex.
void PolygonCutter::build_grid(std::uint32_t start) {
    std::size_t count = 0, exact = 0;
    Point2 high = flat_[start];
    grid_low_ = flat_[start];
    reflex_.clear();
    std::uint32_t i = start;
    do {
        for (std::size_t k = 0; k < 2; ++k) {
            grid_low_[k] = std::min(grid_low_[k], flat_[i][k]);
            high[k] = std::max(high[k], flat_[i][k]);
        }
        if (orientation(flat_[previous_[i]], flat_[i], flat_[next_[i]], exact) <= 0) reflex_.push_back(i);
        ++count;
        i = next_[i];
    } while (i != start);
    for (std::size_t k = 0; k < 2; ++k) grid_size_[k] = high[k] > grid_low_[k] ? high[k] - grid_low_[k] : 1;
    cells_ = std::clamp<std::size_t>(static_cast<std::size_t>(std::sqrt(static_cast<double>(count) / 4)), 1, 2048);
    cell_begin_.assign(cells_ * cells_ + 1, 0);
    const auto index = [this](std::uint32_t corner) {
        const auto [x, y] = cell_of(flat_[corner]);
        return y * cells_ + x;
    };
    for (const std::uint32_t r : reflex_) ++cell_begin_[index(r) + 1];
    for (std::size_t c = 0; c + 1 < cell_begin_.size(); ++c) cell_begin_[c + 1] += cell_begin_[c];
    cell_items_.resize(reflex_.size());
    std::vector<std::uint32_t> fill(cell_begin_.begin(), cell_begin_.end() - 1);
    for (const std::uint32_t r : reflex_) cell_items_[fill[index(r)]++] = r;
}

int PolygonCutter::turn(const Point2& a, const Point2& b, const Point2& c) {
    constexpr std::size_t work_of_exact = 16;  // in units of floating-point tests
    std::size_t exact = 0;
    const int result = orientation(a, b, c, exact);
    budget_ -= std::min(budget_, work_of_exact * exact);
    return result;
}

/// A strictly convex corner whose closed triangle contains no other corner (except corners at the position of one of the
/// three).
bool PolygonCutter::is_ear(std::uint32_t previous, std::uint32_t tip, std::uint32_t next) {
    const Point2 &a = flat_[previous], &b = flat_[tip], &c = flat_[next];
    if (turn(a, b, c) <= 0) return false;
    const auto [left, bottom] = cell_of({std::min({a[0], b[0], c[0]}), std::min({a[1], b[1], c[1]})});
    const auto [right, top] = cell_of({std::max({a[0], b[0], c[0]}), std::max({a[1], b[1], c[1]})});
    for (std::size_t y = bottom; y <= top; ++y) {
        const std::uint32_t first = cell_begin_[y * cells_ + left], last = cell_begin_[y * cells_ + right + 1];
        const std::size_t work = 1 + last - first;
        budget_ -= std::min(budget_, work);
        for (std::uint32_t k = first; k < last; ++k) {
            const std::uint32_t i = cell_items_[k];
            const Point2& p = flat_[i];
            if (alive_[i] == 0 || p == a || p == b || p == c) continue;
            if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
        }
        if (budget_ == 0) return false;
    }
    return true;
}

CutResult PolygonCutter::clip_ears(const std::uint32_t* corners, std::vector<Triple>& triangles) {
    auto remaining = static_cast<std::uint32_t>(kept_.size());
    alive_.assign(remaining, 1);
    next_.resize(remaining);
    previous_.resize(remaining);
    for (std::uint32_t i = 0; i < remaining; ++i) {
        next_[i] = i + 1 == remaining ? 0 : i + 1;
        previous_[i] = i == 0 ? remaining - 1 : i - 1;
    }
    const std::size_t count = remaining;
    budget_ = std::clamp<std::size_t>(count * count, 1'000'000, 20'000'000) + 200 * count;
    build_grid(0);
    std::uint32_t in_grid = remaining;
    CutResult result = CutResult::clean;
    const auto distinct = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const auto u = corners[kept_[a]], v = corners[kept_[b]], w = corners[kept_[c]];
        return u != v && v != w && w != u;
    };
    const auto clip = [&](std::uint32_t tip) {
        const std::uint32_t before = previous_[tip], after = next_[tip];
        if (distinct(before, tip, after)) triangles.push_back({kept_[before], kept_[tip], kept_[after]});
        next_[before] = after;
        previous_[after] = before;
        alive_[tip] = 0;
        --remaining;
    };
    // Iterates over candidates: clipping an ear only changes its two neighbours, which are deferred to the next round (thus
    // every second corner is clipped first, which gives fewer slivers than a fan). When no candidate is left, all corners are
    // tested again, since a corner that blocked an ear may be gone.
    std::uint32_t last = 0, clipped_since_scan = 1, round = 0;
    round_of_.assign(remaining, 0);
    candidates_.clear();
    const auto clip_and_note = [&](std::uint32_t tip) {
        clip(tip);
        ++clipped_since_scan;
        last = next_[tip];
        for (const std::uint32_t neighbour : {previous_[tip], next_[tip]}) {
            if (round_of_[neighbour] == round) continue;
            round_of_[neighbour] = round;
            waiting_.push_back(neighbour);
        }
    };
    while (remaining > 3) {
        ++round;
        waiting_.clear();
        if (budget_ == 0) {
            std::vector<std::uint32_t> ring;
            for (std::uint32_t i = last, n = 0; n < remaining; i = next_[i], ++n) ring.push_back(i);
            halve(std::move(ring), corners, triangles);
            return CutResult::gave_up;
        }
        if (candidates_.empty() && clipped_since_scan == 0) {
            result = CutResult::crossing;  // the polygon intersects or touches itself: the next corner is cut off regardless
            clip_and_note(last);
        } else {
            if (candidates_.empty()) {
                clipped_since_scan = 0;
                for (std::uint32_t i = next_[last], n = 0; n < remaining; i = next_[i], ++n) candidates_.push_back(i);
            }
            for (const std::uint32_t tip : candidates_) {
                if (remaining <= 3 || budget_ == 0) break;
                --budget_;
                if (alive_[tip] == 0 || round_of_[tip] == round || !distinct(previous_[tip], tip, next_[tip])) continue;
                if (is_ear(previous_[tip], tip, next_[tip])) clip_and_note(tip);
            }
            if (remaining < in_grid / 2) {  // ears are larger now: rebuild with coarser cells and without the clipped corners
                build_grid(last);
                in_grid = remaining;
            }
        }
        std::swap(candidates_, waiting_);
    }
    const std::uint32_t tip = last;
    if (distinct(previous_[tip], tip, next_[tip])) triangles.push_back({kept_[previous_[tip]], kept_[tip], kept_[next_[tip]]});
    return result;
}

}  // namespace ostraka::io
