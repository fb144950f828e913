#include "ostraka/fields/ball_volume.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/point_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace ostraka {

namespace {

/// A cluster is summed as a whole where its radius is below this share of its distance.
constexpr double max_cluster_ratio = 0.1;
/// Faces farther away than this multiple of their radius are summed as points.
constexpr double far_face_ratio = 8;
constexpr std::uint32_t cluster_leaf_size = 4;

/// Faces summed as one: a face, or a node of the tree.
struct FaceCluster {
    Vector3d centre, area;  ///< centroid by area; sum of the area vectors
    double moment = 0;      ///< sum of (centroid - centre) . area vector over the faces
    double radius = 0;      ///< of the ball around the centre that contains the faces
};

/// A node of the tree, in depth-first order: its first child follows it.
struct ClusterNode {
    FaceCluster cluster;
    std::uint32_t begin = 0, end = 0;  ///< range of faces
    std::uint32_t next = 0;            ///< the node after its subtree
    bool is_leaf = false;
};

/// Flux sums by the smallest radius that contains the cluster.
struct Shells {
    explicit Shells(const std::vector<double>& all_radii)
        : radii(all_radii), volumes(all_radii.size(), 0), angles(all_radii.size(), 0) {}
    const std::vector<double>& radii;
    std::vector<double> volumes, angles;  ///< volumes of cones from the vertex; thirds of their solid angles

    void clear() {
        std::fill(volumes.begin(), volumes.end(), 0);
        std::fill(angles.begin(), angles.end(), 0);
    }
    void add(double distance, double volume, double third_of_angle) {
        std::size_t k = 0;
        while (k < radii.size() && radii[k] <= distance) ++k;
        if (k == radii.size()) return;
        volumes[k] += volume;
        angles[k] += third_of_angle;
    }
};

/// Solid angle of the vertex below its faces: 2 pi minus the exterior dihedral angles of its edges (Girard).
double solid_angle(const Mesh& mesh, Vertex vertex) {
    double sum = 2 * pi;
    for (const Halfedge h : CGAL::halfedges_around_target(vertex, mesh)) {
        const Vector left = area_vector(mesh, mesh.face(h)), right = area_vector(mesh, mesh.face(mesh.opposite(h)));
        const Vector along = mesh.point(mesh.target(h)) - mesh.point(mesh.source(h));
        const double length = std::sqrt(along.squared_length());
        if (length > 0) sum -= std::atan2(CGAL::cross_product(left, right) * along / length, left * right);
    }
    return sum;
}

class ClusterTree {
public:
    explicit ClusterTree(const Mesh& mesh) {
        for (const Face face : mesh.faces()) {
            const auto [a, b, c] = corners(mesh, face);
            Triangle triangle{{eigen(mesh.point(a)), eigen(mesh.point(b)), eigen(mesh.point(c))}, {}};
            const Vector3d area =
                (triangle.corners[1] - triangle.corners[0]).cross(triangle.corners[2] - triangle.corners[0]) / 2;
            if (!(area.norm() > 0)) continue;
            triangle.cluster.area = area;
            triangle.cluster.centre = (triangle.corners[0] + triangle.corners[1] + triangle.corners[2]) / 3;
            for (const Vector3d& corner : triangle.corners)
                triangle.cluster.radius = std::max(triangle.cluster.radius, (corner - triangle.cluster.centre).norm());
            triangles_.push_back(triangle);
        }
        if (triangles_.empty()) fail_input("mesh", "has no face with an area", "check its scale or repair it");
        nodes_.reserve(triangles_.size());
        build(0, static_cast<std::uint32_t>(triangles_.size()));
    }

    /// Adds the faces within the largest radius of the vertex at `p`.
    void collect(const Vector3d& p, Shells& shells) const {
        const double farthest = shells.radii.back();
        for (std::uint32_t at = 0; at < nodes_.size();) {
            const ClusterNode& node = nodes_[at];
            const Vector3d arm = node.cluster.centre - p;
            const double squared = arm.squaredNorm(), reach = farthest + node.cluster.radius;
            if (squared > reach * reach) {
                at = node.next;
            } else if (node.cluster.radius * node.cluster.radius < max_cluster_ratio * max_cluster_ratio * squared) {
                add_point(node.cluster, arm, squared, shells);
                at = node.next;
            } else {
                if (node.is_leaf)
                    for (std::uint32_t i = node.begin; i < node.end; ++i) add_face(triangles_[i], p, shells);
                ++at;
            }
        }
    }

private:
    struct Triangle {
        std::array<Vector3d, 3> corners;
        FaceCluster cluster;
    };

    std::uint32_t build(std::uint32_t begin, std::uint32_t end) {
        const auto number = static_cast<std::uint32_t>(nodes_.size());
        nodes_.emplace_back();
        nodes_[number].begin = begin;
        nodes_[number].end = end;
        nodes_[number].is_leaf = end - begin <= cluster_leaf_size;
        nodes_[number].cluster = joined_cluster(begin, end);
        if (!nodes_[number].is_leaf) {
            Eigen::AlignedBox3d box;
            for (std::uint32_t i = begin; i < end; ++i) box.extend(triangles_[i].cluster.centre);
            Eigen::Index axis = 0;
            box.sizes().maxCoeff(&axis);
            const std::uint32_t middle = begin + (end - begin) / 2;
            const auto first = triangles_.begin();
            std::nth_element(first + begin, first + middle, first + end, [axis](const Triangle& a, const Triangle& b) {
                return a.cluster.centre[axis] < b.cluster.centre[axis];
            });
            build(begin, middle);
            build(middle, end);
        }
        return nodes_[number].next = static_cast<std::uint32_t>(nodes_.size());
    }

    [[nodiscard]] FaceCluster joined_cluster(std::uint32_t begin, std::uint32_t end) const {
        FaceCluster joined{Vector3d::Zero(), Vector3d::Zero()};
        double weight = 0;
        for (std::uint32_t i = begin; i < end; ++i) {
            const FaceCluster& face = triangles_[i].cluster;
            joined.centre += face.area.norm() * face.centre;
            joined.area += face.area;
            weight += face.area.norm();
        }
        joined.centre /= weight;
        for (std::uint32_t i = begin; i < end; ++i) {
            const FaceCluster& face = triangles_[i].cluster;
            joined.moment += (face.centre - joined.centre).dot(face.area);
            joined.radius = std::max(joined.radius, (face.centre - joined.centre).norm() + face.radius);
        }
        return joined;
    }

    /// Three times the volume of the cone is arm . area; the solid angle is that over the cube of the distance.
    static void add_point(const FaceCluster& cluster, const Vector3d& arm, double squared, Shells& shells) {
        const double volume = (arm.dot(cluster.area) + cluster.moment) / 3, distance = std::sqrt(squared);
        shells.add(distance, volume, volume / (squared * distance));
    }

    /// The solid angle of a near face is exact (Van Oosterom and Strackee 1983).
    static void add_face(const Triangle& triangle, const Vector3d& p, Shells& shells) {
        const FaceCluster& face = triangle.cluster;
        const Vector3d arm = face.centre - p;
        const double squared = arm.squaredNorm();
        if (squared > far_face_ratio * far_face_ratio * face.radius * face.radius) return add_point(face, arm, squared, shells);
        const Vector3d a = triangle.corners[0] - p, b = triangle.corners[1] - p, c = triangle.corners[2] - p;
        const double la = a.norm(), lb = b.norm(), lc = c.norm();
        if (!(la > 0 && lb > 0 && lc > 0)) return;  // the face lies in a plane through the vertex
        const double angle = 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
        shells.add(std::sqrt(squared), arm.dot(face.area) / 3, angle / 3);
    }

    std::vector<Triangle> triangles_;
    std::vector<ClusterNode> nodes_;
};

/// Squared distances of the vertices from the nearest border vertex; infinite without a border.
PointTree border_tree(const Mesh& mesh) {
    std::vector<Point> points;
    for (const Vertex vertex : mesh.vertices())
        if (!mesh.is_isolated(vertex) && mesh.is_border(vertex)) points.push_back(mesh.point(vertex));
    return PointTree(points);
}

void check_radii(const std::vector<double>& radii) {
    const bool ascending = std::adjacent_find(radii.begin(), radii.end(), std::greater_equal<>()) == radii.end();
    if (radii.empty() || !(radii.front() > 0) || !std::isfinite(radii.back()) || !ascending)
        fail_usage("the radii of the balls are invalid", "give ascending lengths above 0");
}

}  // namespace

std::vector<double> BallVolumes::at_scale(std::size_t scale) const {
    std::vector<double> values;
    for (std::size_t i = scale; i < shares.size(); i += scales) values.push_back(shares[i]);
    return values;
}

BallVolumes ball_volumes(const Mesh& mesh, const std::vector<double>& radii) {
    check_radii(radii);
    const ClusterTree tree(mesh);
    const PointTree border = border_tree(mesh);
    const std::size_t count = mesh.number_of_vertices(), scales = radii.size();
    BallVolumes result{scales, std::vector<double>(count * scales, std::numeric_limits<double>::quiet_NaN())};
    Progress progress("volumes in balls", count);
    parallel_blocks(count, 512, [&](std::size_t begin, std::size_t end) {
        Shells shells(radii);
        for (std::size_t i = begin; i < end; ++i) {
            const Vertex vertex(static_cast<Index>(i));
            if (mesh.is_isolated(vertex) || mesh.is_border(vertex)) continue;
            const double squared_room =
                border.size() > 0 ? border.nearest(mesh.point(vertex)).squared : std::numeric_limits<double>::infinity();
            shells.clear();
            tree.collect(eigen(mesh.point(vertex)), shells);
            const double angle = solid_angle(mesh, vertex) / 3;
            double volume = 0, angles = angle;
            for (std::size_t k = 0; k < scales; ++k) {
                volume += shells.volumes[k];
                angles -= shells.angles[k];
                const double cube = radii[k] * radii[k] * radii[k];
                if (radii[k] * radii[k] < squared_room)
                    result.shares[i * scales + k] = std::clamp((angles * cube + volume) / (4 * pi / 3 * cube), 0.0, 1.0);
            }
        }
        progress.advance(end - begin);
    });
    return result;
}

}  // namespace ostraka
