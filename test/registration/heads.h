// Heads and shapes shared by the tests of registration.
#pragma once

#include "meshes.h"

#include "ostraka/geom/eigen.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/synthetic/head_casts.h"

namespace ostraka::test {

/// An upright cast of mould `mould`.
inline HeadCast head(std::uint64_t mould, std::uint64_t seed, std::uint64_t vertices = 4000) {
    ArchetypeOptions archetype;
    archetype.seed = mould;
    CastOptions cast;
    cast.vertices = vertices;
    cast.seed = seed;
    cast.keep_pose = true;
    return cast_head(head_archetype(archetype), cast);
}

inline Mesh moved(Mesh mesh, const Motion& motion) {
    for (const Vertex v : mesh.vertices()) mesh.point(v) = point_of(motion(eigen(mesh.point(v))));
    return mesh;
}

inline Motion motion(double scale = 1, double far = 100) {
    Motion m;
    m.rotation = Eigen::AngleAxisd(1.9, Eigen::Vector3d(0.2, -1, 0.6).normalized()).toRotationMatrix();
    m.translation = far * Eigen::Vector3d(3, -2, 1);
    m.scale = scale;
    return m;
}

/// Angle between two rotations in degrees.
inline double rotation_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
    return Eigen::AngleAxisd(a.transpose() * b).angle() * 180 / 3.14159265358979323846;
}

}  // namespace ostraka::test
