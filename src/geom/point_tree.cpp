#include "ostraka/geom/point_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace ostraka {

/// Points in the order of a balanced k-d tree: the median of a range splits it along its box's longest side.
struct PointTree::Tree {
    static constexpr std::size_t leaf = 12;
    std::vector<std::array<double, 3>> places;
    std::vector<Index> order;
    std::vector<std::uint8_t> axis;  ///< of the split at the middle of each inner range, stored at the middle

    void build(std::size_t begin, std::size_t end) {
        if (end - begin <= leaf) return;
        std::array<double, 3> low, high;
        low.fill(std::numeric_limits<double>::infinity());
        high.fill(-std::numeric_limits<double>::infinity());
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                low[k] = std::min(low[k], places[order[i]][k]);
                high[k] = std::max(high[k], places[order[i]][k]);
            }
        std::size_t longest = 0;
        for (std::size_t k = 1; k < 3; ++k)
            if (high[k] - low[k] > high[longest] - low[longest]) longest = k;
        const std::size_t middle = begin + (end - begin) / 2;
        std::nth_element(order.begin() + static_cast<std::ptrdiff_t>(begin), order.begin() + static_cast<std::ptrdiff_t>(middle),
                         order.begin() + static_cast<std::ptrdiff_t>(end),
                         [&](Index a, Index b) { return std::pair(places[a][longest], a) < std::pair(places[b][longest], b); });
        axis[middle] = static_cast<std::uint8_t>(longest);
        build(begin, middle);
        build(middle + 1, end);
    }

    /// Calls visit(index, squared distance) for points nearer than the limit, which visit may lower.
    template <class Visit>
    void walk(const std::array<double, 3>& place, double& limit, Visit&& visit, std::size_t begin, std::size_t end) const {
        const auto look = [&](std::size_t i) {
            const auto& p = places[order[i]];
            const double x = p[0] - place[0], y = p[1] - place[1], z = p[2] - place[2], squared = x * x + y * y + z * z;
            if (squared <= limit) visit(order[i], squared);
        };
        if (end - begin <= leaf) {
            for (std::size_t i = begin; i < end; ++i) look(i);
            return;
        }
        const std::size_t middle = begin + (end - begin) / 2, k = axis[middle];
        const double side = place[k] - places[order[middle]][k];
        if (side < 0) walk(place, limit, visit, begin, middle);
        else walk(place, limit, visit, middle + 1, end);
        if (side * side > limit) return;
        look(middle);
        if (side < 0) walk(place, limit, visit, middle + 1, end);
        else walk(place, limit, visit, begin, middle);
    }
};

PointTree::PointTree(const std::vector<Point>& points) : tree_(std::make_unique<Tree>()) {
    for (const Point& p : points) tree_->places.push_back({p.x(), p.y(), p.z()});
    tree_->order.resize(points.size());
    std::iota(tree_->order.begin(), tree_->order.end(), Index{0});
    tree_->axis.assign(points.size(), 0);
    tree_->build(0, points.size());
}
PointTree::~PointTree() = default;
PointTree::PointTree(PointTree&&) noexcept = default;

PointTree::Near PointTree::nearest(const Point& place, double reach) const {
    Near near;
    double limit = reach * reach;
    const auto visit = [&](Index i, double squared) {
        if (squared == limit && near.index != no_index && i > near.index) return;
        if (squared >= reach * reach) return;
        limit = squared;
        near = {i, squared};
    };
    tree_->walk({place.x(), place.y(), place.z()}, limit, visit, 0, tree_->order.size());
    return near;
}

void PointTree::within(const Point& place, double reach, std::vector<Index>& found) const {
    found.clear();
    double limit = reach * reach;
    const auto visit = [&](Index i, double squared) {
        if (squared < limit) found.push_back(i);
    };
    tree_->walk({place.x(), place.y(), place.z()}, limit, visit, 0, tree_->order.size());
    std::sort(found.begin(), found.end());
}

double PointTree::neighbour_distance(const Point& place, std::size_t count) const {
    std::vector<double> nearest;  // a heap, the farthest in front
    double limit = std::numeric_limits<double>::infinity();
    const auto visit = [&](Index, double squared) {
        nearest.push_back(squared);
        std::push_heap(nearest.begin(), nearest.end());
        if (nearest.size() > count) {
            std::pop_heap(nearest.begin(), nearest.end());
            nearest.pop_back();
        }
        if (nearest.size() == count) limit = nearest.front();
    };
    tree_->walk({place.x(), place.y(), place.z()}, limit, visit, 0, tree_->order.size());
    return nearest.empty() ? 0 : std::sqrt(nearest.front());
}

}  // namespace ostraka
