// Intersections of contours with one another and with themselves.
#include "ostraka/core/angles.h"
#include "slicing/contour_classification.h"

#include "slicing/segment_tree.h"
#include "slicing/strips.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka::detail {

namespace {

using Pair = std::pair<int, int>;  ///< two contours, the lower index first

enum class Meeting { apart, touching, crossing };

/// Signed distances of two points from the line through an edge.
std::pair<double, double> distances(const Strips::Edge& edge, const Strips::Edge& other) {
    const Vector2d along = (edge.b - edge.a).normalized();
    const auto from = [&](const Vector2d& p) { return along.x() * (p - edge.a).y() - along.y() * (p - edge.a).x(); };
    return {from(other.a), from(other.b)};
}

Meeting meeting(const std::pair<double, double>& d, const std::pair<double, double>& e, double tolerance) {
    const auto beside = [&](double a, double b) {
        return (a > tolerance && b > tolerance) || (a < -tolerance && b < -tolerance);
    };
    if (beside(d.first, d.second) || beside(e.first, e.second)) return Meeting::apart;
    for (const double x : {d.first, d.second, e.first, e.second})
        if (std::abs(x) <= tolerance) return Meeting::touching;
    return Meeting::crossing;
}

/// The maximum area that a curve of this length can enclose.
double disc_area(double length) { return length * length / (4 * pi); }

/// A curve cut at these (evenly many) positions lies alternately on two sides: the length on the shorter side.
double shorter_side(std::vector<double> positions, double length) {
    std::sort(positions.begin(), positions.end());
    double sum = 0;
    for (std::size_t i = 0; i + 1 < positions.size(); i += 2) sum += positions[i + 1] - positions[i];
    return std::min(sum, length - sum);
}

class Search {
public:
    Search(std::vector<Contour>& contours, std::size_t closed, double tolerance)
        : contours_(contours), closed_(closed), tolerance_(tolerance), strips_(contours) {
        strips_.overlapping(tolerance, [&](const Strips::Edge& e, const Strips::Edge& f) { compare(e, f); });
    }

    Crossings result() {
        Crossings result;
        result.cancelled.assign(contours_.size(), false);
        double doubtful = 0, outer_area = 0;
        for (const auto& [pair, places] : crossings_) {
            mark(pair);
            const Contour &first = contour(pair.first), &second = contour(pair.second);
            if (places.first.size() % 2 == 0)
                doubtful += std::min(min_area(pair), disc_area(shorter_side(places.first, first.length) +
                                                               shorter_side(places.second, second.length)));
            else doubtful += min_area(pair);
        }
        for (const auto& [c, length] : loops_) mark({c, c}), doubtful += std::min(length, disc_area(contour(c).length));
        judge_touching(result, doubtful);
        for (std::size_t c = 0; c < closed_; ++c) outer_area += contours_[c].hole ? 0 : contours_[c].area;
        if (doubtful > 0) result.doubtful = outer_area > doubtful ? doubtful / outer_area : 1;
        return result;
    }

private:
    [[nodiscard]] Contour& contour(int c) const { return contours_[static_cast<std::size_t>(c)]; }
    [[nodiscard]] double min_area(const Pair& pair) const {
        return std::min(std::abs(contour(pair.first).area), std::abs(contour(pair.second).area));
    }
    void mark(const Pair& pair) { contour(pair.first).crosses = contour(pair.second).crosses = true; }

    /// Arc length of the contour up to one of its points.
    double length_up_to(int c, std::size_t point) {
        auto& sums = lengths_[c];
        if (sums.empty()) {
            const auto& points = contour(c).points;
            sums = {0};
            for (std::size_t i = 0; i + 1 < points.size(); ++i) sums.push_back(sums.back() + (points[i + 1] - points[i]).norm());
        }
        return sums[point];
    }

    void compare(const Strips::Edge& e, const Strips::Edge& f) {
        const auto d = distances(e, f), g = distances(f, e);
        const Meeting relation = meeting(d, g, tolerance_);
        if (relation == Meeting::apart) return;
        if (relation == Meeting::touching) {
            if (e.contour != f.contour) touching_[std::minmax(e.contour, f.contour)] = true;
            return;
        }
        const double s = length_up_to(e.contour, e.place) + g.first / (g.first - g.second) * (e.b - e.a).norm();
        const double t = length_up_to(f.contour, f.place) + d.first / (d.first - d.second) * (f.b - f.a).norm();
        if (e.contour == f.contour) {
            const double length = std::abs(s - t);
            loops_[e.contour] += disc_area(std::min(length, contour(e.contour).length - length));
            return;
        }
        auto& [first, second] = crossings_[std::minmax(e.contour, f.contour)];
        first.push_back(e.contour < f.contour ? s : t);
        second.push_back(e.contour < f.contour ? t : s);
    }

    /// On which sides of `outer` the points of `inner` and the midpoints of its edges lie, beyond the tolerance.
    [[nodiscard]] std::pair<bool, bool> sides(int inner, int outer) const {
        const auto& points = contour(inner).points;
        const auto& others = contour(outer).points;
        PlaneSegments pieces;
        for (std::size_t i = 0; i < others.size(); ++i) pieces.emplace_back(others[i], others[(i + 1) % others.size()]);
        const SegmentTree tree(std::move(pieces));
        std::vector<int> containing, passing_through;
        std::size_t hint = 0;
        bool inside = false, outside = false;
        const auto classify_point = [&](const Vector2d& p) {
            strips_.locate(p, containing, passing_through);
            if (std::binary_search(passing_through.begin(), passing_through.end(), outer)) return;
            bool& side = std::binary_search(containing.begin(), containing.end(), outer) ? inside : outside;
            if (!side && tree.distance(p, hint) > tolerance_) side = true;
        };
        for (std::size_t i = 0; i < points.size() && !(inside && outside); ++i) classify_point(points[i]);
        for (std::size_t i = 0; i < points.size() && !(inside && outside); ++i)
            classify_point((points[i] + points[(i + 1) % points.size()]) / 2);
        return {inside, outside};
    }

    void judge_touching(Crossings& result, double& doubtful) {
        for (const auto& [pair, _] : touching_) {
            if (crossings_.contains(pair)) continue;
            const auto [inside, outside] = sides(pair.second, pair.first);
            const bool coincident = !inside && !outside;
            if (coincident && contour(pair.first).hole != contour(pair.second).hole) {
                result.cancelled[static_cast<std::size_t>(pair.first)] = true;
                result.cancelled[static_cast<std::size_t>(pair.second)] = true;
            } else if (coincident || (inside && outside)) {
                mark(pair);
                doubtful += min_area(pair);
            }
        }
    }

    std::vector<Contour>& contours_;
    std::size_t closed_;
    double tolerance_;
    Strips strips_;
    /// Arc lengths of the intersections on each contour.
    std::map<Pair, std::pair<std::vector<double>, std::vector<double>>> crossings_;
    std::map<Pair, bool> touching_;
    std::map<int, double> loops_;  ///< upper bound of the area that a self-intersecting contour encloses twice
    std::map<int, std::vector<double>> lengths_;
};

}  // namespace

Crossings find_crossings(std::vector<Contour>& contours, double tolerance) {
    std::size_t closed = 0;
    while (closed < contours.size() && contours[closed].closed) ++closed;
    if (closed == 0) return {0, std::vector<bool>(contours.size(), false)};
    return Search(contours, closed, tolerance).result();
}

}  // namespace ostraka::detail
