// Nesting of contours, by votes of their points.
#include "slicing/contour_classification.h"

#include "slicing/strips.h"

#include <algorithm>

namespace ostraka::detail {

namespace {

struct Votes {
    int contour, inside, decided;
};

/// Whether `inner`, all of whose tested points lie on `outer`, is inside it. The first of its points, then of its edge
/// midpoints, that is strictly on one side decides. If the contours coincide, the hole lies inside the outer contour.
bool inside_by_all_points(const Strips& strips, const std::vector<Contour>& contours, std::size_t inner, std::size_t outer) {
    const auto& points = contours[inner].points;
    std::vector<int> inside, on;
    const auto has = [](const std::vector<int>& indices, std::size_t c) {
        return std::binary_search(indices.begin(), indices.end(), static_cast<int>(c));
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
        const auto vote = [&](int other, int inside_votes, int decided) {
            if (static_cast<std::size_t>(other) >= c) return;  // no larger than this contour: cannot contain it
            for (auto& entry : votes)
                if (entry.contour == other) {
                    entry.inside += inside_votes, entry.decided += decided;
                    return;
                }
            votes.push_back({other, inside_votes, decided});
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
