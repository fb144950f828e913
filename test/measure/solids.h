// Solids to measure, and rigid motions of them.
#pragma once

#include "meshes.h"
#include "ostraka/annotation/annotation.h"

#include <Eigen/Geometry>

#include <random>

namespace ostraka::test {

using Eigen::Vector3d;

/// Applies a rotation and a translation to the vertices.
inline TriangleSoup moved(TriangleSoup soup, const Eigen::Matrix3d& rotation, const Vector3d& translation) {
    for (auto& p : soup.points) {
        const Vector3d q = rotation * Vector3d(p[0], p[1], p[2]) + translation;
        p = {q[0], q[1], q[2]};
    }
    return soup;
}

inline Eigen::Matrix3d some_rotation(int seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    std::normal_distribution<double> normal;
    return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized().toRotationMatrix();
}

inline TriangleSoup box(int n, double a, double b, double c) {
    TriangleSoup soup = box(n);
    for (auto& p : soup.points) p = {a * p[0], b * p[1], c * p[2]};
    return soup;
}

inline Annotation whole(const Mesh& mesh) {
    AnnotationSet set;
    return ensure_root(set, mesh);
}

inline Measure pins(const std::string& tool, std::vector<Index> points) {
    Measure measure;
    measure.tool = tool;
    measure.points = std::move(points);
    return measure;
}

}  // namespace ostraka::test
