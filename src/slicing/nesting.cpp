// Point-in-polygon with exact predicates over strips.
#include "nesting.h"

#include <algorithm>
#include <cmath>

namespace ostraka::detail {

namespace {

using Eigen::Vector2d;

/// Edges of all closed contours, sorted into horizontal strips.
class Strips {
public:
    explicit Strips(const std::vector<Contour>& contours) {
        double variation = 0;
        for (std::size_t c = 0; c < contours.size() && contours[c].closed; ++c) {
            const auto& points = contours[c].points;
            for (std::size_t i = 0; i < points.size(); ++i) {
                edges_.push_back({points[i], points[(i + 1) % points.size()], static_cast<int>(c)});
                variation += std::abs(edges_.back().b.y() - edges_.back().a.y());
            }
        }
        low_ = high_ = edges_.front().a.y();
        for (const auto& edge : edges_) low_ = std::min(low_, edge.a.y()), high_ = std::max(high_, edge.a.y());
        // As many strips as let the entries be about twice the edges.
        const double wanted = variation > 0 ? double(edges_.size()) * (high_ - low_) / variation : 1;
        strips_ = static_cast<std::size_t>(std::clamp(wanted, 1.0, double(edges_.size())));
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

    /// The contours that contain the point in their inside, and those that pass through it.
    void locate(const Vector2d& p, std::vector<int>& inside, std::vector<int>& on) const {
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
                if ((side == CGAL::LEFT_TURN) == (b.y() > a.y())) continue;  // it passes on the right
            }
            if ((a.y() <= p.y()) != (b.y() <= p.y())) crossed.push_back(edge.contour);
        }
        std::sort(on.begin(), on.end());
        on.erase(std::unique(on.begin(), on.end()), on.end());
        // Odd crossings are inside.
        std::sort(crossed.begin(), crossed.end());
        std::size_t kept = 0;
        for (std::size_t i = 0; i < crossed.size();) {
            std::size_t j = i;
            while (j < crossed.size() && crossed[j] == crossed[i]) ++j;
            const int contour = crossed[i];
            if ((j - i) % 2 == 1 && !std::binary_search(on.begin(), on.end(), contour)) crossed[kept++] = contour;
            i = j;
        }
        crossed.resize(kept);
    }

private:
    struct Edge {
        Vector2d a, b;
        int contour;
    };
    [[nodiscard]] std::size_t strip(double y) const {
        if (!(high_ > low_)) return 0;
        const double at = (y - low_) / (high_ - low_) * double(strips_);
        return static_cast<std::size_t>(std::clamp(at, 0.0, double(strips_ - 1)));
    }
    [[nodiscard]] std::pair<std::size_t, std::size_t> range(const Edge& edge) const {
        return std::minmax(strip(edge.a.y()), strip(edge.b.y()));
    }

    std::vector<Edge> edges_;
    std::vector<std::size_t> first_;
    std::vector<Index> entries_;
    double low_ = 0, high_ = 0;
    std::size_t strips_ = 1;
};

struct Votes {
    int contour, inside, decided;
};

/// Whether `inner`, all of whose points tried lie on `outer`, is inside it: the first of its points, then of the middles of its
/// edges that is on neither side by a hair decides. Contours that cover each other: a hole lies in the outer one.
bool inside_by_all_points(const Strips& strips, const std::vector<Contour>& contours, std::size_t inner, std::size_t outer) {
    const auto& points = contours[inner].points;
    std::vector<int> inside, on;
    const auto has = [](const std::vector<int>& list, std::size_t c) {
        return std::binary_search(list.begin(), list.end(), static_cast<int>(c));
    };
    for (const auto& p : points) {
        strips.locate(p, inside, on);
        if (!has(on, outer)) return has(inside, outer);
    }
    const auto& others = contours[outer].points;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vector2d a = points[i], b = points[(i + 1) % points.size()], middle = (a + b) / 2;
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < others.size(); ++k) {
            const Vector2d p = others[k], along = others[(k + 1) % others.size()] - p;
            const double t = std::clamp(along.dot(middle - p) / along.squaredNorm(), 0.0, 1.0);
            nearest = std::min(nearest, (p + t * along - middle).norm());
        }
        if (nearest <= 1e-9 * contours[outer].length) continue;
        strips.locate(middle, inside, on);
        return has(inside, outer);
    }
    return contours[inner].hole && !contours[outer].hole;
}

}  // namespace

void nest(std::vector<Contour>& contours) {
    std::size_t closed = 0;
    while (closed < contours.size() && contours[closed].closed) ++closed;
    if (closed < 2) return;
    const Strips strips(contours);
    std::vector<int> inside, on;
    for (std::size_t c = 0; c < closed; ++c) {
        auto& contour = contours[c];
        std::vector<Votes> votes;
        const auto vote = [&](int other, int in, int decided) {
            if (static_cast<std::size_t>(other) >= c) return;  // as large at most: it cannot contain this one
            for (auto& entry : votes)
                if (entry.contour == other) {
                    entry.inside += in, entry.decided += decided;
                    return;
                }
            votes.push_back({other, in, decided});
        };
        constexpr int samples = 5;
        for (int k = 0; k < samples; ++k) {
            strips.locate(contour.points[contour.points.size() * static_cast<std::size_t>(k) / samples], inside, on);
            for (const int other : inside) vote(other, 1, 0);
            for (const int other : on) vote(other, 0, -1);
        }
        for (const auto& entry : votes) {
            const int decided = samples + entry.decided;
            const auto other = static_cast<std::size_t>(entry.contour);
            const bool contained = decided == 0 ? inside_by_all_points(strips, contours, c, other) : 2 * entry.inside > decided;
            if (!contained) continue;
            ++contour.depth;
            contour.parent = std::max(contour.parent, entry.contour);  // sorted by area: the last is the smallest
        }
    }
}

}  // namespace ostraka::detail
