#include "face_tree.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/parallel.h"
#include "ostraka/geom/eigen.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka {

using Eigen::Vector3d;

namespace {

constexpr std::uint32_t leaf_size = 6;
/// Single precision: boxes are this much larger, and cones this much wider than they need to be.
constexpr float slack = 2e-7F;
constexpr double rounding = 1e-6;

double angle_between(const Vector3d& a, const Vector3d& b) { return 2 * std::atan2((a - b).norm(), (a + b).norm()); }

/// Nodes of a tree over so many faces. Halves differ by one at most, so that each level has two sizes.
std::uint32_t node_count(std::uint32_t faces) {
    std::uint32_t nodes = 0;
    // Of `small` faces there are `few` trees in this level, of one more `many`.
    std::uint32_t small = faces, few = 1, many = 0;
    while (few > 0 || many > 0) {
        nodes += few + many;
        const std::uint32_t split_few = small > leaf_size ? few : 0, split_many = small + 1 > leaf_size ? many : 0;
        // small = 2k: k, k; 2k + 1: k, k + 1; and 2k + 2: k + 1, k + 1.
        const std::uint32_t half = small / 2;
        few = small % 2 == 0 ? 2 * split_few + split_many : split_few;
        many = small % 2 == 0 ? split_many : split_few + 2 * split_many;
        small = half;
    }
    return nodes;
}

Vector3d vector_of_place(const std::array<float, 3>& p) { return {p[0], p[1], p[2]}; }

}  // namespace

Vector3d FaceTree::place(const Point& p) const { return eigen(p - middle_) / unit_; }

FaceTree::FaceTree(const Mesh& mesh, const std::vector<Face>& faces) : mesh_(mesh), middle_(CGAL::ORIGIN) {
    if (faces.empty()) return;
    const CGAL::Bbox_3 box = bounding_box(mesh);
    middle_ = Point(0.5 * (box.xmin() + box.xmax()), 0.5 * (box.ymin() + box.ymax()), 0.5 * (box.zmin() + box.zmax()));
    unit_ = box_diagonal(mesh);
    std::vector<Item> items(faces.size());
    parallel_for(faces.size(), [&](std::size_t i) {
        const Vector3d p = place(centroid(mesh, faces[i]));
        items[i] = {{static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())}, faces[i]};
    });
    const auto count = static_cast<std::uint32_t>(faces.size());
    nodes_.resize(node_count(count));
    // The upper nodes one after the other, the trees below them side by side.
    const std::uint32_t small = std::max<std::uint32_t>(count / 64, 1024);
    std::vector<Range> above, below, todo{{0, 0, count}};
    while (!todo.empty()) {
        const Range range = todo.back();
        todo.pop_back();
        if (range.end - range.begin <= small) {
            below.push_back(range);
            continue;
        }
        above.push_back(range);
        for (const Range& half : split(range, items)) todo.push_back(half);
    }
    parallel_for(
        below.size(), [&](std::size_t i) { build(below[i], items); }, 1);
    for (auto range = above.rbegin(); range != above.rend(); ++range) join(range->node);
    faces_.resize(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) faces_[i] = items[i].face;
}

std::array<FaceTree::Range, 2> FaceTree::split(const Range& range, std::vector<Item>& items) {
    Place low = items[range.begin].centre, high = low;
    for (std::uint32_t i = range.begin; i < range.end; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], items[i].centre[k]);
            high[k] = std::max(high[k], items[i].centre[k]);
        }
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
        if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
    const std::uint32_t middle = range.begin + (range.end - range.begin) / 2;
    std::nth_element(items.begin() + range.begin, items.begin() + middle, items.begin() + range.end,
                     [axis](const Item& a, const Item& b) {
                         return a.centre[axis] < b.centre[axis] || (a.centre[axis] == b.centre[axis] && a.face < b.face);
                     });
    const std::uint32_t second = range.node + 1 + node_count(middle - range.begin);
    nodes_[range.node].first = second;
    nodes_[range.node].count = 0;
    return {Range{range.node + 1, range.begin, middle}, Range{second, middle, range.end}};
}

void FaceTree::build(const Range& range, std::vector<Item>& items) {
    if (range.end - range.begin <= leaf_size) {
        fill(range, items);
        return;
    }
    for (const Range& half : split(range, items)) build(half, items);
    join(range.node);
}

void FaceTree::fill(const Range& leaf, std::vector<Item>& items) {
    std::sort(items.begin() + leaf.begin, items.begin() + leaf.end, [](const Item& a, const Item& b) { return a.face < b.face; });
    Node& node = nodes_[leaf.node];
    node.first = leaf.begin;
    node.count = leaf.end - leaf.begin;
    node.low.fill(std::numeric_limits<float>::infinity());
    node.high.fill(-std::numeric_limits<float>::infinity());
    std::array<Vector3d, leaf_size> normals;
    Vector3d axis = Vector3d::Zero();
    for (std::uint32_t i = 0; i < node.count; ++i) {
        const Face face(items[leaf.begin + i].face);
        for (const Vertex v : corners(mesh_, face)) {
            const Vector3d p = place(mesh_.point(v));
            for (std::size_t k = 0; k < 3; ++k) {
                const auto x = static_cast<float>(p[static_cast<Eigen::Index>(k)]);
                node.low[k] = std::min(node.low[k], x - slack);
                node.high[k] = std::max(node.high[k], x + slack);
            }
        }
        const Vector area = area_vector(mesh_, face);
        normals[i] = eigen(area / std::sqrt(area.squared_length()));
        axis += normals[i];
    }
    double opening = axis.norm() > rounding ? 0 : pi;
    axis.normalize();
    for (std::size_t k = 0; k < 3; ++k) node.axis[k] = static_cast<float>(axis[static_cast<Eigen::Index>(k)]);
    for (std::uint32_t i = 0; i < node.count; ++i)
        opening = std::max(opening, angle_between(vector_of_place(node.axis), normals[i]) + rounding);
    opening = std::min(opening, pi);
    node.cosine = static_cast<float>(std::cos(opening));
    node.sine = static_cast<float>(std::sin(opening));
}

void FaceTree::join(std::uint32_t number) {
    Node& node = nodes_[number];
    const Node &a = nodes_[number + 1], &b = nodes_[node.first];
    for (std::size_t k = 0; k < 3; ++k) {
        node.low[k] = std::min(a.low[k], b.low[k]);
        node.high[k] = std::max(a.high[k], b.high[k]);
    }
    Vector3d axis = vector_of_place(a.axis) + vector_of_place(b.axis);
    double opening = pi;
    if (axis.norm() > rounding) {
        axis.normalize();
        for (std::size_t k = 0; k < 3; ++k) node.axis[k] = static_cast<float>(axis[static_cast<Eigen::Index>(k)]);
        opening = 0;
        for (const Node* child : {&a, &b})
            opening = std::max(opening, angle_between(vector_of_place(node.axis), vector_of_place(child->axis)) +
                                            std::atan2(child->sine, child->cosine) + rounding);
        opening = std::min(opening, pi);
    } else {
        node.axis = {0, 0, 1};
    }
    node.cosine = static_cast<float>(std::cos(opening));
    node.sine = static_cast<float>(std::sin(opening));
}

std::optional<SurfaceHit> FaceTree::closest(const Point& query, const Vector& normal, double min_cosine,
                                            double search_radius) const {
    if (nodes_.empty() || !(search_radius >= 0)) return std::nullopt;
    const Vector3d from = place(query), direction = eigen(normal);
    const bool any = min_cosine <= -1;
    const double cosine = std::clamp(min_cosine, -1.0, 1.0), sine = std::sqrt(1 - cosine * cosine), length = direction.norm();
    std::optional<SurfaceHit> best;
    double bound = search_radius * search_radius;  // squared distance
    const auto distance = [&](const Node& node) {
        // No normal is within what is asked for if the cone's axis is farther off than that and half of its opening together.
        if (!any && node.cosine > -cosine + rounding &&
            direction.dot(vector_of_place(node.axis)) < length * (node.cosine * cosine - node.sine * sine - rounding))
            return std::numeric_limits<double>::infinity();
        double squared = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double x = from[static_cast<Eigen::Index>(k)], off = std::max({node.low[k] - x, x - node.high[k], 0.0});
            squared += off * off;
        }
        return squared * unit_ * unit_;
    };
    struct Waiting {
        std::uint32_t node;
        double squared;
    };
    std::array<Waiting, 64> stack;
    std::size_t waiting = 0;
    const auto push = [&](std::uint32_t node, double squared) {
        if (squared <= bound) stack[waiting++] = {node, squared};
    };
    push(0, distance(nodes_[0]));
    while (waiting > 0) {
        const Waiting next = stack[--waiting];
        if (next.squared > bound) continue;
        const Node& node = nodes_[next.node];
        if (node.count == 0) {
            const std::uint32_t a = next.node + 1, b = node.first;
            const double to_a = distance(nodes_[a]), to_b = distance(nodes_[b]);
            if (to_a <= to_b) {
                push(b, to_b);
                push(a, to_a);
            } else {
                push(a, to_a);
                push(b, to_b);
            }
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const Face face(faces_[i]);
            const auto [a, b, c] = corners(mesh_, face);
            const Point &pa = mesh_.point(a), &pb = mesh_.point(b), &pc = mesh_.point(c);
            if (!any) {
                const Vector n = CGAL::cross_product(pb - pa, pc - pa);
                if (n / std::sqrt(n.squared_length()) * normal < min_cosine) continue;
            }
            SurfaceHit hit;
            hit.face = face;
            hit.barycentric = nearest_barycentric(pa, pb, pc, query);
            hit.point = point_at(mesh_, hit.face, hit.barycentric);
            const double squared = CGAL::squared_distance(hit.point, query);
            if (squared > bound || (best && squared == bound && hit.face > best->face)) continue;
            bound = squared;
            best = hit;
        }
    }
    if (best) best->distance = std::sqrt(bound);
    return best;
}

}  // namespace ostraka
