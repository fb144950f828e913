// Points with normals, evenly spread over a surface and smoothed alike whatever its triangles and noise are.
#pragma once

#include "ostraka/core/mesh.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace ostraka {

struct SurfacePoints {
    std::vector<Eigen::Vector3d> places, normals;  ///< unit normals
    double spacing = 0;                            ///< no two points that face one way are nearer to each other
    [[nodiscard]] std::size_t size() const { return places.size(); }
};

/// Points on the faces marked in `faces` (all if empty), no two nearer than `spacing` unless their normals are more than a right
/// angle apart (the two sides of a wall), and no room left for another (dart throwing in random order). Then each normal is the
/// mean of the area within `radius` that faces the same way, and each point moves along it to that area's mean height: noise
/// goes, and two meshes of one surface that are given the same radius move alike. Linear in the faces and in area / spacing^2.
/// Empty without area. Throws Error (usage) unless spacing and radius are positive and the marks, if any, one a face.
SurfacePoints spread_points(const Mesh& mesh, const std::vector<bool>& faces, double spacing, double radius,
                            std::uint64_t seed = 1);

/// Area of the faces marked (all if empty).
double marked_area(const Mesh& mesh, const std::vector<bool>& faces);

}  // namespace ostraka
