// Conversion of points and vectors to and from Eigen.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <Eigen/Geometry>

#include <vector>

namespace ostraka {

inline Eigen::Vector3d eigen(const Point& p) { return {p.x(), p.y(), p.z()}; }
inline Eigen::Vector3d eigen(const Vector& v) { return {v.x(), v.y(), v.z()}; }
inline Point point_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
inline Vector vector_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
/// The points as columns of a matrix.
inline Eigen::Matrix3Xd columns_of(const std::vector<Point>& list) {
    Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(list.size()));
    for (std::size_t i = 0; i < list.size(); ++i) points.col(static_cast<Eigen::Index>(i)) = eigen(list[i]);
    return points;
}
/// The vertex positions of a mesh as columns of a matrix.
inline Eigen::Matrix3Xd columns_of(const Mesh& mesh) {
    Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(mesh.number_of_vertices()));
    for (const Vertex v : mesh.vertices()) points.col(v.idx()) = eigen(mesh.point(v));
    return points;
}
inline std::vector<Point> points_of(const std::vector<Eigen::Vector3d>& places) {
    std::vector<Point> points;
    for (const Eigen::Vector3d& place : places) points.push_back(point_of(place));
    return points;
}

}  // namespace ostraka
