// Points and vectors as Eigen's and back.
#pragma once

#include "ostraka/core/mesh.h"

#include <Eigen/Geometry>

namespace ostraka {

inline Eigen::Vector3d eigen(const Point& p) { return {p.x(), p.y(), p.z()}; }
inline Eigen::Vector3d eigen(const Vector& v) { return {v.x(), v.y(), v.z()}; }
inline Point point_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
inline Vector vector_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace ostraka
