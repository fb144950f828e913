#include "geom/face_tree.h"

#include "geom/face_order.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"

#include <CGAL/Intersections_3/Segment_3_Triangle_3.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace ostraka {

namespace {

constexpr std::uint32_t leaf_size = 6;
/// Maximum depth: one level per bit of the codes, plus the halving of faces with equal codes.
constexpr std::size_t most_levels = 63 + 32;
/// For single precision, boxes are enlarged and cones widened by these amounts.
constexpr float slack = 2e-7F;
constexpr double rounding = 1e-6;

Eigen::Array4f floats(const Vector3d& v, float last) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), last};
}
Vector3d axis_of(const Eigen::Array4f& cone) { return cone.head<3>().matrix().cast<double>(); }

/// Splits the faces of a node where the first differing bit of their codes changes.
std::uint32_t part(const FaceOrder& order, std::uint32_t begin, std::uint32_t end) {
    const std::uint64_t first = order.codes[begin], last = order.codes[end - 1];
    if (first == last) return begin + (end - begin) / 2;
    const int bit = 63 - std::countl_zero(first ^ last);
    const std::uint64_t* const codes = order.codes.get();
    return static_cast<std::uint32_t>(std::lower_bound(codes + begin, codes + end, last >> bit << bit) - codes);
}

std::uint32_t node_count(const FaceOrder& order, std::uint32_t begin, std::uint32_t end) {
    if (end - begin <= leaf_size) return 1;
    const std::uint32_t middle = part(order, begin, end);
    return 1 + node_count(order, begin, middle) + node_count(order, middle, end);
}

/// Half the opening angle of a cone, 0 to pi.
struct Opening {
    double cosine = 1, sine = 0;

    /// Sum of the angles, at most pi.
    [[nodiscard]] Opening wider_by(const Opening& other) const {
        const double sum = sine * other.cosine + cosine * other.sine;
        if (sum < 0) return {-1, 0};
        return {cosine * other.cosine - sine * other.sine, sum};
    }
    void include(const Opening& other) {
        if (!(other.cosine >= cosine)) *this = other;
    }
};
/// For such a small angle, the sine equals the angle and the cosine is 1.
constexpr Opening rounding_angle{1, rounding};

/// Angle between two vectors.
Opening between(const Vector3d& a, const Vector3d& b) {
    const double cosine = a.dot(b), sine = a.cross(b).norm(), length = std::sqrt(cosine * cosine + sine * sine);
    return {cosine / length, sine / length};
}

/// Exact test whether the segment pq intersects the triangle abc. Triangles with collinear corners intersect nothing.
bool meet(const Point& p, const Point& q, const Point& a, const Point& b, const Point& c) {
    const CGAL::Orientation at_p = CGAL::orientation(a, b, c, p), at_q = CGAL::orientation(a, b, c, q);
    if (at_p == at_q) {
        if (at_p != CGAL::COPLANAR || CGAL::collinear(a, b, c)) return false;
        const Kernel::Triangle_3 triangle(a, b, c);
        return p == q ? triangle.has_on(p) : CGAL::do_intersect(Kernel::Segment_3(p, q), triangle);
    }
    // Seen from above, the line passes downwards through the triangle and lies to the right of no edge.
    const bool down = at_p == CGAL::POSITIVE || at_q == CGAL::NEGATIVE;
    const Point &above = down ? p : q, &below = down ? q : p;
    return CGAL::orientation(above, below, a, b) != CGAL::POSITIVE && CGAL::orientation(above, below, b, c) != CGAL::POSITIVE &&
           CGAL::orientation(above, below, c, a) != CGAL::POSITIVE;
}

/// Conservative test whether a segment may intersect a box, without false negatives. All coordinates are doubled to avoid
/// halving for midpoints.
class SegmentProbe {
public:
    SegmentProbe(const Vector3d& from, const Vector3d& to) {
        margin_ = 1e-14 * (1 + from.cwiseAbs().maxCoeff() + to.cwiseAbs().maxCoeff());
        for (Eigen::Index k = 0; k < 3; ++k) {
            sum_[k] = from[k] + to[k];
            along_[k] = to[k] - from[k];
            extent_[k] = std::abs(along_[k]);
        }
    }

    /// Separating-axis test: no separating plane perpendicular to an axis, or parallel to the segment and an axis.
    [[nodiscard]] bool may_meet(const Eigen::Array4f& low, const Eigen::Array4f& high) const {
        double away[3], size[3];
        for (Eigen::Index k = 0; k < 3; ++k) {
            away[k] = sum_[k] - (static_cast<double>(low[k]) + static_cast<double>(high[k]));
            size[k] = static_cast<double>(high[k]) - static_cast<double>(low[k]) + margin_;
            if (std::abs(away[k]) > size[k] + extent_[k]) return false;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = k == 2 ? 0 : k + 1, j = k == 0 ? 2 : k - 1;
            if (std::abs(along_[i] * away[j] - along_[j] * away[i]) > size[i] * extent_[j] + size[j] * extent_[i]) return false;
        }
        return true;
    }

private:
    double sum_[3], along_[3], extent_[3], margin_;
};

}  // namespace

Vector3d FaceTree::place(const Point& p) const { return eigen(p - middle_) * scale_; }

FaceTree::FaceTree(const Mesh& mesh) : mesh_(mesh), middle_(CGAL::ORIGIN) {
    if (mesh.has_garbage()) throw std::logic_error("FaceTree: collect the garbage first");
    const CGAL::Bbox_3 box = bounding_box(mesh);
    middle_ = Point(0.5 * (box.xmin() + box.xmax()), 0.5 * (box.ymin() + box.ymax()), 0.5 * (box.zmin() + box.zmax()));
    unit_ = std::hypot(box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin());
    scale_ = 1 / unit_;
    const FaceOrder order = order_faces(mesh, middle_, unit_);
    size_ = order.count;
    area_ = order.area;
    if (size_ > 0) build(order);
}

void FaceTree::build(const FaceOrder& order) {
    // The upper nodes and the subtrees below them, in node order. First the subtrees are counted, then built in parallel.
    struct Piece {
        std::uint32_t begin, end;
        std::uint32_t second;  ///< the piece of an upper node's second child; 0 for subtrees
        std::uint32_t node = 0;
    };
    std::vector<Piece> pieces;
    const std::uint32_t small = std::max<std::uint32_t>(order.count / 64, 1024);
    const auto cut = [&](const auto& again, std::uint32_t begin, std::uint32_t end) -> void {
        const std::size_t own = pieces.size();
        pieces.push_back({begin, end, 0});
        if (end - begin <= small) return;
        const std::uint32_t middle = part(order, begin, end);
        again(again, begin, middle);
        pieces[own].second = static_cast<std::uint32_t>(pieces.size());
        again(again, middle, end);
    };
    cut(cut, 0, order.count);
    std::vector<std::uint32_t> nodes(pieces.size(), 1);
    parallel_for(pieces.size(), 1, [&](std::size_t i) {
        if (pieces[i].second == 0) nodes[i] = node_count(order, pieces[i].begin, pieces[i].end);
    });
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        pieces[i].node = count;
        count += nodes[i];
    }
    nodes_ = std::make_unique_for_overwrite<Node[]>(count);
    triangles_ = std::make_unique_for_overwrite<Triangle[]>(order.count);
    parallel_for(pieces.size(), 1, [&](std::size_t i) {
        if (pieces[i].second == 0) build(order, pieces[i].begin, pieces[i].end, pieces[i].node);
    });
    for (auto piece = pieces.rbegin(); piece != pieces.rend(); ++piece) {
        if (piece->second == 0) continue;
        nodes_[piece->node].first = pieces[piece->second].node;
        join(piece->node);
    }
}

/// Builds the subtree whose root is `node`; returns the first unused node number after it.
std::uint32_t FaceTree::build(const FaceOrder& order, std::uint32_t begin, std::uint32_t end, std::uint32_t node) {
    if (end - begin <= leaf_size) {
        fill(order, begin, end, nodes_[node]);
        return node + 1;
    }
    const std::uint32_t middle = part(order, begin, end);
    nodes_[node].first = build(order, begin, middle, node + 1);
    const std::uint32_t next = build(order, middle, end, nodes_[node].first);
    join(node);
    return next;
}

void FaceTree::fill(const FaceOrder& order, std::uint32_t begin, std::uint32_t end, Node& leaf) {
    leaf.first = begin;
    leaf.count = end - begin;
    leaf.low.setConstant(std::numeric_limits<float>::infinity());
    leaf.high.setConstant(-std::numeric_limits<float>::infinity());
    std::array<Vector3d, leaf_size> normals;
    Vector3d axis = Vector3d::Zero();
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
        Triangle& triangle = triangles_[begin + i];
        triangle.face = order.faces[begin + i];
        const auto vertices = corners(mesh_, Face(triangle.face));
        for (std::size_t corner = 0; corner < 3; ++corner) {
            triangle.corners[corner] = vertices[corner];
            const Place p = floats(place(mesh_.point(vertices[corner])), 0);
            leaf.low = leaf.low.min(p - slack);
            leaf.high = leaf.high.max(p + slack);
        }
        const Point& a = mesh_.point(vertices[0]);
        const Vector area = CGAL::cross_product(mesh_.point(vertices[1]) - a, mesh_.point(vertices[2]) - a);
        normals[i] = eigen(area / std::sqrt(area.squared_length()));
        axis += normals[i];
    }
    leaf.low[3] = leaf.high[3] = 0;
    Opening opening{-1, 0};
    if (axis.norm() > rounding) {
        leaf.cone = floats(axis.normalized(), 0);
        const Vector3d stored = axis_of(leaf.cone).normalized();
        double cosine = 1;
        for (std::uint32_t i = 0; i < leaf.count; ++i) cosine = std::min(cosine, stored.dot(normals[i]));
        opening = Opening{cosine, std::sqrt(std::max(0.0, 1 - cosine * cosine))}.wider_by(rounding_angle);
    } else {
        leaf.cone = floats(Vector3d::UnitZ(), 0);
    }
    leaf.cone[3] = static_cast<float>(opening.cosine);
    leaf.sine = static_cast<float>(opening.sine);
}

void FaceTree::join(std::uint32_t number) {
    Node& node = nodes_[number];
    node.count = 0;
    const Node &a = nodes_[number + 1], &b = nodes_[node.first];
    node.low = a.low.min(b.low);
    node.high = a.high.max(b.high);
    const Vector3d axis = axis_of(a.cone) + axis_of(b.cone);
    Opening opening{-1, 0};
    if (a.cone[3] > -1 && b.cone[3] > -1 && axis.norm() > rounding) {
        node.cone = floats(axis.normalized(), 0);
        opening = {};
        for (const Node* child : {&a, &b})
            opening.include(between(axis_of(node.cone), axis_of(child->cone))
                                .wider_by({child->cone[3], child->sine})
                                .wider_by(rounding_angle));
    } else {
        node.cone = floats(Vector3d::UnitZ(), 0);
    }
    node.cone[3] = static_cast<float>(opening.cosine);
    node.sine = static_cast<float>(opening.sine);
}

/// State of a nearest-face search.
struct FaceTree::Search {
    const FaceTree& tree;
    const Point& query;
    const Vector& normal;
    double min_cosine;
    double bound;  ///< squared distance
    std::optional<SurfaceHit> best;

    Place from, direction;  ///< the query in single precision; `direction` is as long as the normal
    float margin;           ///< tolerance by which boxes may appear too far away
    float limit;            ///< upper bound of `bound`, in the unit of the boxes
    float turn_cosine, turn_sine, length;

    Search(const FaceTree& faces, const Point& from_point, const Vector& along, double least_cosine, double search_radius)
        : tree(faces), query(from_point), normal(along), min_cosine(least_cosine), bound(search_radius * search_radius) {
        const Vector3d at = tree.place(query);
        from = floats(at, 0);
        direction = floats(eigen(normal), 0);
        // The boxes include the rounding errors of points within them; for points farther away, the errors grow.
        margin = static_cast<float>(2e-7 * std::max(0.0, at.cwiseAbs().maxCoeff() - 1));
        turn_cosine = static_cast<float>(std::clamp(min_cosine, -1.0, 1.0));
        turn_sine = std::sqrt(1 - turn_cosine * turn_cosine);
        length = direction.matrix().norm();
        set_limit();
    }

    void set_limit() {
        const double above = bound / (tree.unit_ * tree.unit_) * (1 + 1e-5);
        using Single = std::numeric_limits<float>;
        limit = above < Single::max() ? static_cast<float>(above) : Single::infinity();
    }
    [[nodiscard]] bool any_normal() const { return min_cosine <= -1; }

    /// Squared distance, in the unit of the boxes.
    [[nodiscard]] float distance(const Node& node) const {
        return ((node.low - from).max(from - node.high) - margin).max(0).matrix().squaredNorm();
    }
    /// True if no normal of the node can be compatible: the angle to the cone's axis exceeds the permitted angle plus half the
    /// opening angle.
    [[nodiscard]] bool is_turned_away(const Node& node) const {
        constexpr auto uncertain = static_cast<float>(rounding);
        return !any_normal() && node.cone[3] > -turn_cosine + uncertain &&
               (direction * node.cone).sum() < length * (node.cone[3] * turn_cosine - node.sine * turn_sine - uncertain);
    }

    void consider(Index face, const Point& a, const Point& b, const Point& c) {
        SurfaceHit hit;
        hit.face = face;
        hit.barycentric = nearest_barycentric(a, b, c, query);
        hit.point = point_at(a, b, c, hit.barycentric);
        const double squared = CGAL::squared_distance(hit.point, query);
        if (squared > bound || (best && squared == bound && hit.face > best->face)) return;
        if (!any_normal()) {
            const Vector n = CGAL::cross_product(b - a, c - a);
            if (n / std::sqrt(n.squared_length()) * normal < min_cosine) return;
        }
        bound = squared;
        set_limit();
        best = hit;
    }
};

std::optional<SurfaceHit> FaceTree::closest(const Point& query, const Vector& normal, double min_cosine,
                                            double search_radius) const {
    if (size_ == 0 || !(search_radius >= 0)) return std::nullopt;
    Search search(*this, query, normal, min_cosine, search_radius);
    struct Waiting {
        std::uint32_t node;
        float squared;
    };
    std::array<Waiting, most_levels + 1> stack;
    std::size_t waiting = 0;
    const auto push = [&](std::uint32_t node, float squared) {
        if (!(squared > search.limit) && !search.is_turned_away(nodes_[node])) stack[waiting++] = {node, squared};
    };
    push(0, search.distance(nodes_[0]));
    while (waiting > 0) {
        const Waiting next = stack[--waiting];
        if (next.squared > search.limit) continue;
        const Node& node = nodes_[next.node];
        if (node.count == 0) {
            const std::uint32_t a = next.node + 1, b = node.first;
            const float to_a = search.distance(nodes_[a]), to_b = search.distance(nodes_[b]);
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
            const auto& [a, b, c] = triangles_[i].corners;
            search.consider(triangles_[i].face, mesh_.point(Vertex(a)), mesh_.point(Vertex(b)), mesh_.point(Vertex(c)));
        }
    }
    if (search.best) search.best->distance = std::sqrt(search.bound);
    return search.best;
}

/// A ray in single precision, with conservative tests of nodes.
struct FaceTree::Ray {
    Place from, inverse, direction;
    float margin;

    Ray(const FaceTree& tree, const Point& origin, const Vector& along) {
        const Vector3d at = tree.place(origin);
        from = floats(at, 0);
        direction = floats(eigen(along), 0);
        // A direction without extent along an axis is replaced by a tiny one, so that no product is undefined.
        for (Eigen::Index k = 0; k < 4; ++k) inverse[k] = 1 / (std::abs(direction[k]) > 1e-30F ? direction[k] : 1e-30F);
        // Rounding errors of the origin, of the direction and of the products below, for distances up to the diagonal.
        margin = 1e-6F + static_cast<float>(2e-7 * std::max(0.0, at.cwiseAbs().maxCoeff() - 1));
    }

    /// Distance at which the ray reaches the node, in the unit of the boxes; infinite if it misses the node or reaches it
    /// beyond `limit`, or if all faces of the node point towards the origin.
    [[nodiscard]] float entry(const Node& node, float limit) const {
        constexpr float never = std::numeric_limits<float>::infinity();
        constexpr auto uncertain = static_cast<float>(rounding);
        if (node.cone[3] > uncertain && (direction * node.cone).sum() < -node.sine - uncertain) return never;
        const Place a = (node.low - margin - from) * inverse, b = (node.high + margin - from) * inverse;
        const float enters = a.min(b).head<3>().maxCoeff(), leaves = a.max(b).head<3>().minCoeff();
        return enters <= leaves && leaves >= 0 && enters <= limit ? std::max(enters, 0.0F) : never;
    }
};

std::optional<SurfaceHit> FaceTree::first_exit(const Point& origin, const Vector& direction, Index ignored,
                                               double min_distance) const {
    std::optional<SurfaceHit> best;
    if (size_ == 0) return best;
    const double length = 1.01 * unit_;
    const Point end = origin + length * direction;
    const Ray ray(*this, origin, direction);
    struct Waiting {
        std::uint32_t node;
        float entry;
    };
    std::array<Waiting, most_levels + 1> stack;
    std::size_t waiting = 0;
    constexpr float never = std::numeric_limits<float>::infinity();
    float limit = static_cast<float>(1.01 * (1 + 1e-5));
    const auto push = [&](std::uint32_t node, float entry) {
        if (entry < never) stack[waiting++] = {node, entry};
    };
    const auto test = [&](const Triangle& triangle) {
        const auto& [a, b, c] = triangle.corners;
        const Point &pa = mesh_.point(Vertex(a)), &pb = mesh_.point(Vertex(b)), &pc = mesh_.point(Vertex(c));
        const Vector n = CGAL::cross_product(pb - pa, pc - pa);
        const double slope = n * direction;
        if (triangle.face == ignored || !(slope > 0)) return;
        const double to_a = (pa - origin) * direction, to_b = (pb - origin) * direction, to_c = (pc - origin) * direction;
        const double distance = std::clamp(n * (pa - origin) / slope, std::min({to_a, to_b, to_c}), std::max({to_a, to_b, to_c}));
        if (!(distance > min_distance) || (best && std::pair(distance, triangle.face) > std::pair(best->distance, best->face)) ||
            !meet(origin, end, pa, pb, pc))
            return;
        const Point point = origin + distance * direction;
        best = SurfaceHit{triangle.face, point, nearest_barycentric(pa, pb, pc, point), distance};
        limit = static_cast<float>(distance * scale_ * (1 + 1e-5)) + ray.margin;
    };
    push(0, ray.entry(nodes_[0], limit));
    while (waiting > 0) {
        const Waiting next = stack[--waiting];
        if (next.entry > limit) continue;
        const Node& node = nodes_[next.node];
        if (node.count > 0) {
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i) test(triangles_[i]);
            continue;
        }
        const std::uint32_t a = next.node + 1, b = node.first;
        const float to_a = ray.entry(nodes_[a], limit), to_b = ray.entry(nodes_[b], limit);
        push(to_a <= to_b ? b : a, std::max(to_a, to_b));
        push(to_a <= to_b ? a : b, std::min(to_a, to_b));
    }
    return best;
}

/// Calls `visit(face)` for each face that the segment intersects until it returns false.
template <class Visit>
void FaceTree::along(const Point& from, const Point& to, const Visit& visit) const {
    if (size_ == 0) return;
    const SegmentProbe probe(place(from), place(to));
    std::array<std::uint32_t, most_levels + 1> stack;
    std::size_t waiting = 0;
    stack[waiting++] = 0;
    while (waiting > 0) {
        const std::uint32_t number = stack[--waiting];
        const Node& node = nodes_[number];
        if (!probe.may_meet(node.low, node.high)) continue;
        if (node.count == 0) {
            stack[waiting++] = node.first;
            stack[waiting++] = number + 1;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const auto& [a, b, c] = triangles_[i].corners;
            if (meet(from, to, mesh_.point(Vertex(a)), mesh_.point(Vertex(b)), mesh_.point(Vertex(c))) &&
                !visit(triangles_[i].face))
                return;
        }
    }
}

std::vector<Index> FaceTree::met(const Point& from, const Point& to) const {
    std::vector<Index> faces;
    along(from, to, [&](Index face) {
        faces.push_back(face);
        return true;
    });
    return faces;
}

bool FaceTree::meets(const Point& from, const Point& to, const std::function<bool(Index)>& ignored) const {
    bool found = false;
    along(from, to, [&](Index face) {
        found = !ignored(face);
        return !found;
    });
    return found;
}

}  // namespace ostraka
