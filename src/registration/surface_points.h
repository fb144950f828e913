// Points with normals, evenly spread over a surface and smoothed independently of its triangulation and noise.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace ostraka {

struct SurfacePoints {
    std::vector<Eigen::Vector3d> places, normals;                     ///< unit normals
    double spacing = 0;                                               ///< min distance between points with similar normals
    [[nodiscard]] std::size_t size() const { return places.size(); }  ///< number of points
};

/// Spreads points over the faces marked in `faces` (all faces if empty): no two points are nearer than `spacing` unless their
/// normals are more than a right angle apart (the two sides of a wall), and there is no room for another point (dart throwing in
/// random order). Then each normal is replaced by the mean normal over the area within `radius` that faces the same way, and each
/// point is moved along its normal to the mean height of that area: this removes noise, and moves the points of two meshes of one
/// surface alike if `radius` is the same. Takes time linear in the faces and in area / spacing^2. Empty without area. Throws
/// Error (usage) unless spacing and radius are positive and the marks, if any, are one per face.
SurfacePoints spread_points(const Mesh& mesh, const std::vector<bool>& faces, double spacing, double radius,
                            std::uint64_t seed = 1);

/// Area of the faces marked in `faces` (of all faces if empty).
double marked_area(const Mesh& mesh, const std::vector<bool>& faces);

}  // namespace ostraka
