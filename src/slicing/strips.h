// Point-in-polygon tests with exact predicates for many contours at once.
#pragma once

#include "ostraka/slicing/slice.h"

#include <algorithm>
#include <cmath>

namespace ostraka::detail {

/// The edges of all closed contours, sorted into horizontal strips.
class Strips {
public:
    /// An edge from `a` to `b`.
    struct Edge {
        Eigen::Vector2d a, b;  ///< end points
        int contour;           ///< index of the contour
        std::size_t place;     ///< index of `a` among the points of the contour
        bool last;             ///< true: the edge closes the contour
    };

    explicit Strips(const std::vector<Contour>& contours) {
        double variation = 0;
        for (std::size_t c = 0; c < contours.size() && contours[c].closed; ++c) {
            const auto& points = contours[c].points;
            for (std::size_t i = 0; i < points.size(); ++i) {
                edges_.push_back({points[i], points[(i + 1) % points.size()], static_cast<int>(c), i, i + 1 == points.size()});
                variation += std::abs(edges_.back().b.y() - edges_.back().a.y());
            }
        }
        low_ = high_ = edges_.front().a.y();
        for (const auto& edge : edges_) low_ = std::min(low_, edge.a.y()), high_ = std::max(high_, edge.a.y());
        // The number of strips for which the number of entries is about twice the number of edges.
        const double target_count = variation > 0 ? double(edges_.size()) * (high_ - low_) / variation : 1;
        strips_ = static_cast<std::size_t>(std::clamp(target_count, 1.0, double(edges_.size())));
        first_.assign(strips_ + 1, 0);
        for (const auto& edge : edges_) {
            const auto [from, to] = range(edge);
            for (std::size_t s = from; s <= to; ++s) ++first_[s + 1];
        }
        for (std::size_t s = 0; s < strips_; ++s) first_[s + 1] += first_[s];
        entries_.resize(first_.back());
        std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            const auto [from, to] = range(edges_[e]);
            for (std::size_t s = from; s <= to; ++s) entries_[next[s]++] = static_cast<Index>(e);
        }
    }

    /// Finds the contours that contain the point in their interior (`inside`), and the contours that pass through the point
    /// (`on`).
    void locate(const Eigen::Vector2d& p, std::vector<int>& inside, std::vector<int>& on) const {
        inside.clear(), on.clear();
        std::vector<int>& crossed = inside;
        const std::size_t s = strip(p.y());
        for (std::size_t k = first_[s]; k < first_[s + 1]; ++k) {
            const Edge& edge = edges_[entries_[k]];
            const auto &a = edge.a, &b = edge.b;
            if (std::max(a.y(), b.y()) < p.y() || std::min(a.y(), b.y()) > p.y() || std::min(a.x(), b.x()) > p.x()) continue;
            const bool ahead = std::max(a.x(), b.x()) < p.x();  // the whole edge lies to the left
            if (a.y() == b.y()) {
                if (!ahead) on.push_back(edge.contour);
                continue;
            }
            if (!ahead) {
                const auto side = CGAL::orientation(Kernel::Point_2(a.x(), a.y()), Kernel::Point_2(b.x(), b.y()),
                                                    Kernel::Point_2(p.x(), p.y()));
                if (side == CGAL::COLLINEAR) {
                    on.push_back(edge.contour);
                    continue;
                }
                if ((side == CGAL::LEFT_TURN) == (b.y() > a.y())) continue;  // passes on the right
            }
            if ((a.y() <= p.y()) != (b.y() <= p.y())) crossed.push_back(edge.contour);
        }
        std::sort(on.begin(), on.end());
        on.erase(std::unique(on.begin(), on.end()), on.end());
        // An odd number of crossings is inside.
        std::sort(crossed.begin(), crossed.end());
        std::size_t kept_count = 0;
        for (std::size_t i = 0; i < crossed.size();) {
            std::size_t j = i;
            while (j < crossed.size() && crossed[j] == crossed[i]) ++j;
            const int contour = crossed[i];
            if ((j - i) % 2 == 1 && !std::binary_search(on.begin(), on.end(), contour)) crossed[kept_count++] = contour;
            i = j;
        }
        crossed.resize(kept_count);
    }

    /// Calls visit(edge, edge) once for every pair of edges whose boxes, enlarged by the tolerance, overlap, except consecutive
    /// edges of a contour.
    template <class Visit>
    void overlapping(double tolerance, const Visit& visit) const {
        std::vector<std::pair<double, Index>> sorted;  // left end, edge
        for (std::size_t s = 0; s < strips_; ++s) {
            sorted.clear();
            for (std::size_t k = first_[s]; k < first_[s + 1]; ++k) {
                const Edge& edge = edges_[entries_[k]];
                sorted.emplace_back(std::min(edge.a.x(), edge.b.x()), entries_[k]);
            }
            std::sort(sorted.begin(), sorted.end());
            for (std::size_t i = 0; i < sorted.size(); ++i) {
                const Edge& e = edges_[sorted[i].second];
                const double right = std::max(e.a.x(), e.b.x()) + tolerance;
                const auto [low, high] = std::minmax(e.a.y(), e.b.y());
                for (std::size_t k = i + 1; k < sorted.size() && sorted[k].first <= right; ++k) {
                    const Edge& f = edges_[sorted[k].second];
                    const auto [minimum, maximum] = std::minmax(f.a.y(), f.b.y());
                    if (minimum > high + tolerance || maximum < low - tolerance || are_neighbours(e, f)) continue;
                    // Only in the lowest strip that contains both.
                    if (std::max(range(e).first, range(f).first) == s) visit(e, f);
                }
            }
        }
    }

private:
    /// Whether two edges are consecutive edges of a contour.
    static bool are_neighbours(const Edge& e, const Edge& f) {
        if (e.contour != f.contour) return false;
        const auto [low, high] = std::minmax(e.place, f.place);
        return high == low + 1 || (low == 0 && (e.place == high ? e : f).last);
    }
    /// Index of the strip at height y.
    [[nodiscard]] std::size_t strip(double y) const {
        if (!(high_ > low_)) return 0;
        const double position = (y - low_) / (high_ - low_) * double(strips_);
        return static_cast<std::size_t>(std::clamp(position, 0.0, double(strips_ - 1)));
    }
    /// Lowest and highest strip that the edge intersects.
    [[nodiscard]] std::pair<std::size_t, std::size_t> range(const Edge& edge) const {
        return std::minmax(strip(edge.a.y()), strip(edge.b.y()));
    }

    std::vector<Edge> edges_;         ///< edges of all closed contours
    std::vector<std::size_t> first_;  ///< for each strip, index of its first entry in entries_
    std::vector<Index> entries_;      ///< indices of the edges that intersect each strip
    double low_ = 0, high_ = 0;       ///< lowest and highest y coordinate
    std::size_t strips_ = 1;          ///< number of strips
};

}  // namespace ostraka::detail
