#include "face_tree.h"

#include "ostraka/geom/eigen.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace ostraka {

using Eigen::Vector3d;

namespace {
constexpr std::size_t leaf_size = 4;

double angle_between(const Vector3d& a, const Vector3d& b) { return 2 * std::atan2((a - b).norm(), (a + b).norm()); }
}  // namespace

FaceTree::FaceTree(const Mesh& mesh, const std::vector<Face>& faces) : mesh_(mesh) {
    std::vector<Vector3d> centres(mesh.number_of_faces()), normals(mesh.number_of_faces());
    faces_.reserve(faces.size());
    for (const Face face : faces) {
        faces_.push_back(face);
        centres[face] = eigen(centroid(mesh, face));
        normals[face] = eigen(area_vector(mesh, face)).normalized();
    }
    nodes_.reserve(2 * (faces.size() / leaf_size + 1));
    build(0, faces_.size(), centres, normals);
}

void FaceTree::build(std::size_t begin, std::size_t end, const std::vector<Vector3d>& centres,
                     const std::vector<Vector3d>& normals) {
    const std::size_t here = nodes_.size();
    nodes_.emplace_back();
    if (end - begin <= leaf_size) {
        std::sort(faces_.begin() + static_cast<std::ptrdiff_t>(begin), faces_.begin() + static_cast<std::ptrdiff_t>(end));
        Node node;
        node.first = static_cast<std::uint32_t>(begin);
        node.count = static_cast<std::uint32_t>(end - begin);
        node.axis.setZero();
        for (std::size_t i = begin; i < end; ++i) {
            for (const Vertex v : corners(mesh_, Face(faces_[i]))) node.box.extend(eigen(mesh_.point(v)));
            node.axis += normals[faces_[i]];
        }
        node.axis.normalize();
        double opening = node.axis.squaredNorm() > 0 ? 0 : std::numbers::pi;
        for (std::size_t i = begin; i < end; ++i) opening = std::max(opening, angle_between(node.axis, normals[faces_[i]]));
        node.cosine = std::cos(opening);
        node.sine = std::sin(opening);
        nodes_[here] = node;
        return;
    }
    Eigen::AlignedBox3d middles;
    for (std::size_t i = begin; i < end; ++i) middles.extend(centres[faces_[i]]);
    Eigen::Index axis = 0;
    middles.sizes().maxCoeff(&axis);
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t i) { return faces_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [&](Index a, Index b) {
        return centres[a][axis] < centres[b][axis] || (centres[a][axis] == centres[b][axis] && a < b);
    });
    build(begin, middle, centres, normals);
    const std::size_t second = nodes_.size();
    build(middle, end, centres, normals);
    const Node &a = nodes_[here + 1], &b = nodes_[second];
    Node node;
    node.box = a.box.merged(b.box);
    node.axis = (a.axis + b.axis).normalized();
    const auto reaching = [&](const Node& child) {
        return angle_between(node.axis, child.axis) + std::atan2(child.sine, child.cosine);
    };
    const bool open = !(node.axis.squaredNorm() > 0) || a.cosine <= -1 || b.cosine <= -1;
    const double opening = open ? std::numbers::pi : std::min(std::numbers::pi, std::max(reaching(a), reaching(b)));
    node.cosine = opening < std::numbers::pi ? std::cos(opening) : -1;
    node.sine = opening < std::numbers::pi ? std::sin(opening) : 0;
    node.first = static_cast<std::uint32_t>(second);
    node.count = 0;
    nodes_[here] = node;
}

std::optional<SurfaceHit> FaceTree::closest(const Point& query, const Vector& normal, double min_cosine, double reach) const {
    if (nodes_.empty() || !(reach >= 0)) return std::nullopt;
    const Vector3d place = eigen(query), direction = eigen(normal);
    const bool any = min_cosine <= -1;
    const double cosine = std::clamp(min_cosine, -1.0, 1.0), sine = std::sqrt(1 - cosine * cosine);
    const double length = direction.norm();
    std::optional<SurfaceHit> best;
    double bound = reach * reach;
    const auto distance = [&](const Node& node) {
        // Within the cone's opening and that asked for together, no normal is if the axis is farther away than both.
        constexpr double rounding = 1e-9;
        if (!any && node.cosine > -cosine &&
            direction.dot(node.axis) < length * (node.cosine * cosine - node.sine * sine - rounding))
            return std::numeric_limits<double>::infinity();
        return node.box.squaredExteriorDistance(place);
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
            const double da = distance(nodes_[a]), db = distance(nodes_[b]);
            if (da <= db) {
                push(b, db);
                push(a, da);
            } else {
                push(a, da);
                push(b, db);
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
