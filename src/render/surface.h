// The triangles of a scene, prepared for ray queries. The surface's own coordinates are the mesh's, translated and scaled so that
// the bounding box is centred at the origin and its largest side is [-1, 1]: single precision is then sufficient for objects of
// any size and position.
#pragma once

#include "ostraka/render/scene.h"

#include <Eigen/Core>

#include <memory>
#include <vector>

struct RTCDeviceTy;
struct RTCSceneTy;

namespace ostraka::detail {

class Surface {
public:
    /// Checks the triangles and builds the search tree; `smooth`: true to prepare normals that are interpolated across edges.
    Surface(const Scene& scene, bool smooth);
    ~Surface();
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    /// Intersection of a ray with a triangle.
    struct Hit {
        Index triangle = no_index;  ///< index of the triangle
        Eigen::Vector3d weights;    ///< barycentric coordinates
        Eigen::Vector3d point;
    };

    /// The first triangle along the ray; among triangles at the same distance, the triangle with the smallest index. Independent
    /// of the structure of the search tree. Returns false if there is no hit.
    bool first_hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, Hit& hit) const;

    /// Whether a triangle intersects the ray between the distances `from` and `to` from the origin.
    [[nodiscard]] bool blocked(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double from, double to) const;

    /// Unit normal of a triangle; the null vector if it has no area.
    [[nodiscard]] Eigen::Vector3d face_normal(Index triangle) const;
    /// Unit normal at a hit, interpolated between the corners. The normal at a corner is the area-weighted sum over the adjacent
    /// faces whose normals differ from the normal of the hit face by less than the crease angle (given as its cosine).
    [[nodiscard]] Eigen::Vector3d smooth_normal(const Hit& hit, double crease_cosine) const;

    /// The normal at the corner `vertex` of a face whose normal is `normal`; requires a surface constructed with `smooth`.
    [[nodiscard]] Eigen::Vector3f corner_normal(Index vertex, const Eigen::Vector3f& normal, float crease_cosine) const;

    /// Position in the surface's coordinates.
    [[nodiscard]] Eigen::Vector3d point(Index index) const { return points_[index].cast<double>(); }
    /// Indices of the triangle's points.
    [[nodiscard]] const std::array<Index, 3>& corners(Index triangle) const { return triangles_[triangle]; }
    [[nodiscard]] std::size_t triangle_count() const { return triangles_.size(); }  ///< number of triangles
    /// Indices of the points that are used by a triangle.
    [[nodiscard]] const std::vector<Index>& used_points() const { return used_; }

    /// Converts a point of the mesh to the surface's coordinates.
    [[nodiscard]] Eigen::Vector3d to_local(const std::array<double, 3>& point) const;
    /// Length of one unit of the surface's coordinates in the mesh's unit.
    [[nodiscard]] double unit_length() const { return unit_length_; }
    /// The origin of the surface's coordinates in mesh coordinates.
    [[nodiscard]] const std::array<double, 3>& middle() const { return middle_; }

private:
    void measure_box(const Scene& scene);  ///< sets middle_ and unit_length_
    void build_tree();                     ///< builds the search tree
    void gather_faces_around_points();     ///< sets around_begin_ and around_

    const std::vector<std::array<Index, 3>>& triangles_;
    std::vector<Index> used_;  ///< indices of the points that are used by a triangle (all points if there are no triangles)
    std::array<double, 3> middle_{};
    double unit_length_ = 1;
    std::vector<Eigen::Vector3f> points_;  ///< with an additional element at the end: the tree reads four floats at a time
    std::vector<Eigen::Vector3f> areas_;   ///< area vectors of the triangles
    /// For each point, index of its first entry in `around_`; triangles around each point.
    std::vector<Index> around_begin_, around_;
    std::unique_ptr<RTCDeviceTy, void (*)(RTCDeviceTy*)> device_;
    std::unique_ptr<RTCSceneTy, void (*)(RTCSceneTy*)> tree_;
};

}  // namespace ostraka::detail
