#include "io/triangle_tree.h"

#include "ostraka/execution/parallel.h"

#include <algorithm>
#include <limits>

namespace ostraka::detail {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Inserts two zero bits after each of the lower 16 bits.
std::uint64_t spread(std::uint64_t x) {
    x = (x | (x << 32)) & 0x001F00000000FFFFull;
    x = (x | (x << 16)) & 0x001F0000FF0000FFull;
    x = (x | (x << 8)) & 0x100F00F00F00F00Full;
    x = (x | (x << 4)) & 0x10C30C30C30C30C3ull;
    x = (x | (x << 2)) & 0x1249249249249249ull;
    return x;
}

/// Stable radix sort of triangle indices by their 48-bit code.
std::vector<Index> sorted_by_code(std::vector<std::pair<std::uint64_t, Index>>& items) {
    std::vector<std::pair<std::uint64_t, Index>> other(items.size());
    for (unsigned shift = 0; shift < 48; shift += 12) {
        std::vector<std::size_t> begin(4097, 0);
        for (const auto& item : items) ++begin[((item.first >> shift) & 4095) + 1];
        for (std::size_t i = 0; i < 4096; ++i) begin[i + 1] += begin[i];
        for (const auto& item : items) other[begin[(item.first >> shift) & 4095]++] = item;
        items.swap(other);
    }
    std::vector<Index> order(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) order[i] = items[i].second;
    return order;
}

}  // namespace

TriangleTree::TriangleTree(const TriangleSoup& soup, std::vector<Index> groups) : soup_(soup), groups_(std::move(groups)) {
    if (soup.triangles.empty()) return;
    find_frame();
    order_triangles();
    if (order_.empty()) return;
    find_boxes();
    if (!groups_.empty()) group_nodes();
}

void TriangleTree::find_frame() {
    std::array<double, 3> low, high;
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    for (const auto& t : soup_.triangles)
        for (const Index v : t)
            for (std::size_t a = 0; a < 3; ++a) {
                low[a] = std::min(low[a], soup_.points[v][a]);
                high[a] = std::max(high[a], soup_.points[v][a]);
            }
    corner_ = low;
    const double side = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
    scale_ = side > 1e-290 ? 1 / side : 1;
}

void TriangleTree::order_triangles() {
    const std::array<double, 3>& low = corner_;
    std::vector<std::pair<std::uint64_t, Index>> codes(soup_.triangles.size());
    parallel_for(codes.size(), 4096, [&](std::size_t t) {
        const auto& [a, b, c] = soup_.triangles[t];
        std::uint64_t code = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double middle =
                (soup_.points[a][k] - low[k]) / 3 + (soup_.points[b][k] - low[k]) / 3 + (soup_.points[c][k] - low[k]) / 3;
            code |= spread(static_cast<std::uint64_t>(std::clamp(middle * scale_, 0.0, 1.0) * 65535)) << k;
        }
        codes[t] = {code, static_cast<Index>(t)};
    });
    if (!groups_.empty()) std::erase_if(codes, [&](const auto& item) { return groups_[item.second] == left_out; });
    order_ = sorted_by_code(codes);
    if (std::any_of(order_.begin(), order_.end(), [&](Index t) { return !groups_.empty() && groups_[t] != 0; }))
        std::stable_sort(order_.begin(), order_.end(), [&](Index a, Index b) { return groups_[a] < groups_[b]; });
}

void TriangleTree::find_boxes() {
    boxes_.resize(order_.size());
    parallel_for(order_.size(), 4096, [&](std::size_t i) {
        const auto& [a, b, c] = soup_.triangles[order_[i]];
        const auto &p = soup_.points[a], &q = soup_.points[b], &r = soup_.points[c];
        std::array<double, 3> low, high;
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min({p[k], q[k], r[k]});
            high[k] = std::max({p[k], q[k], r[k]});
        }
        boxes_[i] = scaled_box(low, high);
    });
    const std::vector<Box>* below = &boxes_;
    do {
        std::vector<Box> level((below->size() + fan - 1) / fan);
        for (std::size_t n = 0; n < level.size(); ++n) {
            Box box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
            for (std::size_t i = n * fan; i < std::min(below->size(), (n + 1) * fan); ++i)
                for (std::size_t k = 0; k < 3; ++k) {
                    box.low[k] = std::min(box.low[k], (*below)[i].low[k]);
                    box.high[k] = std::max(box.high[k], (*below)[i].high[k]);
                }
            level[n] = box;
        }
        levels_.push_back(std::move(level));
        below = &levels_.back();
    } while (below->size() > 1);
}

void TriangleTree::group_nodes() {
    std::vector<Index> below;
    for (const Index t : order_) below.push_back(groups_[t]);
    for (const auto& boxes : levels_) {
        std::vector<Index> level(boxes.size());
        for (std::size_t n = 0; n < level.size(); ++n) {
            const auto first = below.begin() + static_cast<std::ptrdiff_t>(n * fan),
                       last = below.begin() + static_cast<std::ptrdiff_t>(std::min(below.size(), (n + 1) * fan));
            level[n] = std::all_of(first, last, [&](Index g) { return g == *first; }) ? *first : 0;
        }
        below = level;
        level_groups_.push_back(std::move(level));
    }
}

TriangleTree::Box TriangleTree::scaled_box(const std::array<double, 3>& low, const std::array<double, 3>& high) const {
    // Subtraction, multiplication and rounding to single precision are monotone; one step outwards compensates for the
    // rounding.
    Box box;
    for (std::size_t k = 0; k < 3; ++k) {
        box.low[k] = std::nextafterf(static_cast<float>((low[k] - corner_[k]) * scale_), -infinity);
        box.high[k] = std::nextafterf(static_cast<float>((high[k] - corner_[k]) * scale_), infinity);
    }
    return box;
}

bool TriangleTree::overlap(const Box& a, const Box& b) {
    return a.low[0] <= b.high[0] && b.low[0] <= a.high[0] && a.low[1] <= b.high[1] && b.low[1] <= a.high[1] &&
           a.low[2] <= b.high[2] && b.low[2] <= a.high[2];
}

std::size_t TriangleTree::pairs_of_leaf(Index leaf, std::size_t max_boxes, const std::function<bool(Index, Index)>& visit) const {
    const Index count = static_cast<Index>(order_.size());
    const Box& leaf_box = levels_[0][leaf];
    const Index own_begin = leaf * fan, own_end = std::min(count, own_begin + fan);
    const bool grouped = !groups_.empty();
    const Index own_group = grouped ? level_groups_[0][leaf] : 0;
    const auto of_one_group = [&](Index i, Index j) {
        return grouped && groups_[order_[i]] != 0 && groups_[order_[i]] == groups_[order_[j]];
    };
    struct Node {
        Index level, number;
    };
    std::size_t compared = 0;
    std::vector<Node> stack{{static_cast<Index>(levels_.size() - 1), 0}};
    while (!stack.empty() && compared < max_boxes) {
        const Node node = stack.back();
        stack.pop_back();
        const auto& below = node.level == 0 ? boxes_ : levels_[node.level - 1];
        const Index begin = node.number * fan, end = std::min(static_cast<Index>(below.size()), begin + fan);
        if (node.level == 0) {
            compared += fan * fan;
            for (Index i = own_begin; i < own_end; ++i)
                for (Index j = std::max(begin, i + 1); j < end; ++j)
                    if (overlap(boxes_[i], boxes_[j]) && !of_one_group(i, j) && !visit(order_[i], order_[j])) return compared;
            continue;
        }
        compared += fan;
        const unsigned span = 2 * (node.level - 1);  // a node of that level covers 4^level leaves
        for (Index i = end; i-- > begin;)
            if ((static_cast<std::uint64_t>(i + 1) << span) > leaf && overlap(leaf_box, below[i]) &&
                (own_group == 0 || level_groups_[node.level - 1][i] != own_group))
                stack.push_back({node.level - 1, i});
    }
    return compared;
}

void TriangleTree::along_segment(const Point& from, const Point& to, std::size_t max_boxes,
                                 const std::function<void(Index)>& visit) const {
    if (levels_.empty()) return;
    std::array<double, 3> start, step;
    for (int k = 0; k < 3; ++k) {
        start[static_cast<std::size_t>(k)] = (from[k] - corner_[static_cast<std::size_t>(k)]) * scale_;
        step[static_cast<std::size_t>(k)] = (to[k] - from[k]) * scale_;
    }
    const auto meets = [&](const Box& box) {
        double enter = 0, leave = 1;
        for (std::size_t k = 0; k < 3; ++k) {
            const double low = static_cast<double>(box.low[k]) - 1e-9, high = static_cast<double>(box.high[k]) + 1e-9;
            if (step[k] == 0) {
                if (start[k] < low || start[k] > high) return false;
                continue;
            }
            const double a = (low - start[k]) / step[k], b = (high - start[k]) / step[k];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        return enter <= leave;
    };
    std::vector<std::pair<Index, Index>> stack{{static_cast<Index>(levels_.size()), 0}};  // level + 1, number
    for (std::size_t boxes = 0; !stack.empty() && boxes < max_boxes; ++boxes) {
        const auto [level, number] = stack.back();
        stack.pop_back();
        if (!meets(level == 0 ? boxes_[number] : levels_[level - 1][number])) continue;
        if (level == 0) {
            visit(order_[number]);
            continue;
        }
        const std::size_t size = level == 1 ? boxes_.size() : levels_[level - 2].size();
        for (Index i = std::min(static_cast<Index>(size), (number + 1) * fan); i-- > number * fan;)
            stack.emplace_back(level - 1, i);
    }
}

TriangleTree::Nearest TriangleTree::nearest(const Point& query) const {
    Nearest best;
    if (levels_.empty()) return best;
    best.squared_distance = std::numeric_limits<double>::infinity();
    std::array<double, 3> q;
    for (int k = 0; k < 3; ++k) q[static_cast<std::size_t>(k)] = (query[k] - corner_[static_cast<std::size_t>(k)]) * scale_;
    const auto bound = [&](const Box& box) {  // squared distance in the mesh's unit
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double d =
                std::max({static_cast<double>(box.low[k]) - q[k], q[k] - static_cast<double>(box.high[k]), 0.0}) / scale_;
            sum += d * d;
        }
        return sum * (1 - 1e-12);
    };
    struct Entry {
        double bound;
        Index level, number;
    };
    std::vector<Entry> stack{{bound(levels_.back()[0]), static_cast<Index>(levels_.size()), 0}};
    while (!stack.empty()) {
        const Entry entry = stack.back();
        stack.pop_back();
        if (entry.bound > best.squared_distance) continue;
        if (entry.level == 0) {
            const Index t = order_[entry.number];
            const auto point = [&](Index v) { return Point(soup_.points[v][0], soup_.points[v][1], soup_.points[v][2]); };
            const auto& [a, b, c] = soup_.triangles[t];
            const double d = squared_distance_to_triangle(query, point(a), point(b), point(c));
            if (d < best.squared_distance || (d == best.squared_distance && t < best.triangle)) best = {t, d};
            continue;
        }
        const auto& below = entry.level == 1 ? boxes_ : levels_[entry.level - 2];
        std::array<Entry, fan> children;
        std::size_t n = 0;
        const Index end = std::min(static_cast<Index>(below.size()), (entry.number + 1) * fan);
        for (Index i = entry.number * fan; i < end; ++i) {  // farthest first, so that the nearest is popped next
            const Entry child{bound(below[i]), entry.level - 1, i};
            std::size_t at = n++;
            for (; at > 0 && children[at - 1].bound < child.bound; --at) children[at] = children[at - 1];
            children[at] = child;
        }
        for (std::size_t i = 0; i < n; ++i) stack.push_back(children[i]);
    }
    return best;
}

namespace {
double squared_distance_to_segment(const Point& p, const Point& a, const Point& b) {
    const Vector d = b - a;
    const double length = d.squared_length();
    const double s = length > 0 ? std::clamp(((p - a) * d) / length, 0.0, 1.0) : 0.0;
    return (p - (a + s * d)).squared_length();
}
}  // namespace

double squared_distance_to_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
    const Vector n = CGAL::cross_product(b - a, c - a);
    const double length = n.squared_length();
    const auto inside = [&](const Point& u, const Point& v) { return CGAL::cross_product(v - u, p - u) * n >= 0; };
    if (length > 0 && inside(a, b) && inside(b, c) && inside(c, a)) {
        const double height = (p - a) * n;
        return height * height / length;
    }
    return std::min(
        {squared_distance_to_segment(p, a, b), squared_distance_to_segment(p, b, c), squared_distance_to_segment(p, c, a)});
}

}  // namespace ostraka::detail
