#include "ostraka/geom/point_tree.h"

#include "ostraka/core/progress.h"

#include <algorithm>
#include <numeric>

namespace ostraka {

/// Points in the order of a balanced k-d tree: the median splits a range along the longest side of its box. Ranges are numbered
/// as in a heap: the halves of range r are 2 r and 2 r + 1.
struct PointTree::Tree {
    static constexpr std::size_t leaf = 12;
    using Place = std::array<double, 3>;
    struct Box {
        Place low, high;
        /// Squared distance from the nearest point of the box, rounded like distances, so that no point in the box is nearer.
        [[nodiscard]] double nearest(const Place& place) const {
            Place gap;
            for (std::size_t k = 0; k < 3; ++k) gap[k] = std::max({low[k] - place[k], place[k] - high[k], 0.0});
            return squared_length(gap);
        }
        [[nodiscard]] double farthest(const Place& place) const {
            Place search_radius;
            for (std::size_t k = 0; k < 3; ++k) search_radius[k] = std::max(high[k] - place[k], place[k] - low[k]);
            return squared_length(search_radius);
        }
    };
    std::vector<Place> places;  ///< in the order of the tree
    std::vector<Index> order;
    std::vector<Box> boxes;     ///< by range, from 1
    std::vector<Index> lowest;  ///< lowest point index in each range

    /// Search limit: points that are nearer, or equally near with a lower index, are accepted. Thereby large sets of coincident
    /// points are not searched completely.
    struct Limit {
        double squared = std::numeric_limits<double>::infinity();
        Index index = no_index;
        [[nodiscard]] bool allows(double other, Index i) const { return other < squared || (other == squared && i < index); }
    };

    static Place place_of(const Point& p) { return {p.x(), p.y(), p.z()}; }
    static double squared_length(const Place& v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }
    [[nodiscard]] double squared_distance(std::size_t i, const Place& place) const {
        return squared_length({places[i][0] - place[0], places[i][1] - place[1], places[i][2] - place[2]});
    }

    void build(const std::vector<Place>& given, std::size_t range, std::size_t begin, std::size_t end) {
        if (end - begin > 4096) check_cancelled();
        if (boxes.size() <= range) boxes.resize(2 * range), lowest.resize(2 * range, no_index);
        Box& box = boxes[range];
        box.low.fill(std::numeric_limits<double>::infinity());
        box.high.fill(-std::numeric_limits<double>::infinity());
        if (begin < end) lowest[range] = *std::min_element(order.data() + begin, order.data() + end);
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                box.low[k] = std::min(box.low[k], given[order[i]][k]);
                box.high[k] = std::max(box.high[k], given[order[i]][k]);
            }
        if (end - begin <= leaf) return;
        std::size_t longest = 0;
        for (std::size_t k = 1; k < 3; ++k)
            if (box.high[k] - box.low[k] > box.high[longest] - box.low[longest]) longest = k;
        const std::size_t middle = begin + (end - begin) / 2;
        std::nth_element(order.data() + begin, order.data() + middle, order.data() + end,
                         [&](Index a, Index b) { return std::pair(given[a][longest], a) < std::pair(given[b][longest], b); });
        build(given, 2 * range, begin, middle);
        build(given, 2 * range + 1, middle, end);
    }

    /// Calls visit(index, squared distance, limit) for points within the limit; `visit` may lower the limit.
    template <class Visit>
    void walk(const Point& from, Limit limit, Visit&& visit) const {
        const Place place = place_of(from);
        const auto into = [&](const auto& self, std::size_t range, std::size_t begin, std::size_t end) -> void {
            if (end - begin <= leaf) {
                for (std::size_t i = begin; i < end; ++i)
                    if (const double squared = squared_distance(i, place); limit.allows(squared, order[i]))
                        visit(order[i], squared, limit);
                return;
            }
            const std::size_t middle = begin + (end - begin) / 2, lower = 2 * range, upper = lower + 1;
            const double below = boxes[lower].nearest(place), above = boxes[upper].nearest(place);
            const bool first = below <= above;
            if (first && limit.allows(below, lowest[lower])) self(self, lower, begin, middle);
            if (limit.allows(above, lowest[upper])) self(self, upper, middle, end);
            if (!first && limit.allows(below, lowest[lower])) self(self, lower, begin, middle);
        };
        into(into, 1, 0, order.size());
    }

    /// Raises `maximum` to the largest squared distance in a range.
    void walk_far(const Place& place, double& maximum, std::size_t range, std::size_t begin, std::size_t end) const {
        if (end - begin <= leaf) {
            for (std::size_t i = begin; i < end; ++i) maximum = std::max(maximum, squared_distance(i, place));
            return;
        }
        const std::size_t middle = begin + (end - begin) / 2, lower = 2 * range, upper = lower + 1;
        const double below = boxes[lower].farthest(place), above = boxes[upper].farthest(place);
        const bool first = below >= above;
        if (first && below > maximum) walk_far(place, maximum, lower, begin, middle);
        if (above > maximum) walk_far(place, maximum, upper, middle, end);
        if (!first && below > maximum) walk_far(place, maximum, lower, begin, middle);
    }
};

PointTree::PointTree(const std::vector<Point>& points) : tree_(std::make_unique<Tree>()) {
    Tree& tree = *tree_;
    std::vector<Tree::Place> given;
    given.reserve(points.size());
    for (const Point& p : points) given.push_back(Tree::place_of(p));
    tree.order.resize(points.size());
    std::iota(tree.order.begin(), tree.order.end(), Index{0});
    tree.build(given, 1, 0, points.size());
    tree.places.reserve(points.size());
    for (const Index i : tree.order) tree.places.push_back(given[i]);
}
PointTree::~PointTree() = default;
PointTree::PointTree(PointTree&&) noexcept = default;
PointTree& PointTree::operator=(PointTree&&) noexcept = default;

std::size_t PointTree::size() const { return tree_->order.size(); }

PointTree::Near PointTree::nearest(const Point& place, double search_radius) const {
    Near near;
    tree_->walk(place, {search_radius * search_radius}, [&](Index i, double squared, Tree::Limit& limit) {
        near = {i, squared};
        limit = {squared, i};
    });
    return near;
}

std::vector<PointTree::Near> PointTree::neighbours(const Point& place, std::size_t count) const {
    const auto before = [](const Near& a, const Near& b) {
        return std::pair(a.squared, a.index) < std::pair(b.squared, b.index);
    };
    std::vector<Near> nearest;  // a heap with the farthest point in front
    if (count == 0) return nearest;
    tree_->walk(place, {}, [&](Index i, double squared, Tree::Limit& limit) {
        nearest.push_back({i, squared});
        std::push_heap(nearest.begin(), nearest.end(), before);
        if (nearest.size() > count) {
            std::pop_heap(nearest.begin(), nearest.end(), before);
            nearest.pop_back();
        }
        if (nearest.size() == count) limit = {nearest.front().squared, nearest.front().index};
    });
    std::sort_heap(nearest.begin(), nearest.end(), before);
    return nearest;
}

void PointTree::within(const Point& place, double search_radius, std::vector<Index>& found) const {
    found.clear();
    tree_->walk(place, {search_radius * search_radius}, [&](Index i, double, Tree::Limit&) { found.push_back(i); });
    std::sort(found.begin(), found.end());
}

double PointTree::farthest_squared(const Point& place) const {
    double maximum = 0;
    tree_->walk_far(Tree::place_of(place), maximum, 1, 0, size());
    return maximum;
}

}  // namespace ostraka
