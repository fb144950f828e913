// A scene's triangles made ready for rays. Coordinates are moved and scaled so that the box's middle is the origin and its
// largest side goes from -1 to 1: single precision then serves objects of any size anywhere.
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
    /// Checks the triangles and builds the search tree; `smooth` prepares for `normal` across edges.
    Surface(const Scene& scene, bool smooth);
    ~Surface();
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    struct Hit {
        Index triangle = no_index;
        Eigen::Vector3d weights;  ///< of the three corners, summing to one
        Eigen::Vector3d point;
    };

    /// The first triangle along the ray; of several at the same distance the one of smallest index. Does not depend on how
    /// the tree was built.
    bool first_hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, Hit& hit) const;

    /// True if a triangle lies on the ray between the two distances.
    [[nodiscard]] bool blocked(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double from, double to) const;

    /// Unit normal of a triangle, the null vector if it has no area.
    [[nodiscard]] Eigen::Vector3d face_normal(Index triangle) const;
    /// Unit normal at a hit: at each corner the area-weighted sum over the faces around it that are turned by less than the
    /// crease angle (given as its cosine) against the face hit, interpolated between the corners.
    [[nodiscard]] Eigen::Vector3d smooth_normal(const Hit& hit, double crease_cosine) const;

    /// That sum at one corner of a face of this normal; of a surface that was made `smooth`.
    [[nodiscard]] Eigen::Vector3f corner_normal(Index vertex, const Eigen::Vector3f& normal, float crease_cosine) const;

    [[nodiscard]] Eigen::Vector3d point(Index index) const { return points_[index].cast<double>(); }
    [[nodiscard]] const std::array<Index, 3>& corners(Index triangle) const { return triangles_[triangle]; }
    [[nodiscard]] std::size_t triangle_count() const { return triangles_.size(); }
    [[nodiscard]] const std::vector<Index>& used_points() const { return used_; }

    [[nodiscard]] Eigen::Vector3d to_local(const std::array<double, 3>& point) const;
    /// Length of one unit of these coordinates in the mesh's unit.
    [[nodiscard]] double unit_length() const { return unit_length_; }
    /// The origin of these coordinates in the mesh's.
    [[nodiscard]] const std::array<double, 3>& middle() const { return middle_; }

private:
    void measure_box(const Scene& scene);
    void build_tree();
    void gather_faces_around_points();

    const std::vector<std::array<Index, 3>>& triangles_;
    std::vector<Index> used_;  ///< points that a triangle names (all points if there are no triangles)
    std::array<double, 3> middle_{};
    double unit_length_ = 1;
    std::vector<Eigen::Vector3f> points_;  ///< one more than there are: the tree reads four floats at a time
    std::vector<Eigen::Vector3f> areas_;   ///< area vectors of the triangles
    std::vector<Index> around_begin_, around_;
    std::unique_ptr<RTCDeviceTy, void (*)(RTCDeviceTy*)> device_;
    std::unique_ptr<RTCSceneTy, void (*)(RTCSceneTy*)> tree_;
};

}  // namespace ostraka::detail
