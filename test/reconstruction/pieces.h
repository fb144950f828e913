// A body with landmarks, and fragments of it.
#pragma once

#include "meshes.h"

#include "ostraka/fracture/fragment.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/synthetic/fragments.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace ostraka::test {

/// Maps a point of the unit sphere to a body with a head and waves, so that no rotation leaves it unchanged.
inline Eigen::Vector3d body_place(const Eigen::Vector3d& p) {
    return (1 + 0.15 * std::sin(3 * p.x() + 1) * std::cos(2 * p.y()) + 0.1 * p.z() * p.x()) *
           Eigen::Vector3d(p.x(), 1.2 * p.y(), 1.8 * p.z());
}

inline Mesh body(int levels = 4) {
    Mesh mesh = build_mesh(octahedron_sphere(levels));
    for (const Vertex v : mesh.vertices()) mesh.point(v) = point_of(body_place(eigen(mesh.point(v))));
    return mesh;
}

inline Mesh deformed_by(const Mesh& mesh, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& map) {
    Mesh result = mesh;
    for (const Vertex v : result.vertices()) result.point(v) = point_of(map(eigen(mesh.point(v))));
    return result;
}

inline Annotation landmark(int id, const std::string& tag, Index vertex) {
    Annotation annotation;
    annotation.id = id;
    annotation.tag = tag;
    annotation.type = AnnotationType::point;
    annotation.points = {vertex};
    return annotation;
}

/// Forty vertices spread over the index range as landmarks.
inline AnnotationSet landmarks_of(const Mesh& mesh) {
    AnnotationSet set;
    const auto n = static_cast<Index>(mesh.number_of_vertices());
    for (int i = 0; i < 40; ++i)
        set.annotations.push_back(landmark(i, "landmark " + std::to_string(i), (static_cast<Index>(i) * 97U) % n));
    return set;
}

/// A fragment of `whole` around a point, with its landmarks.
struct Cut {
    Fragment fragment;
    SyntheticFragment piece;
};
inline Cut cut(AnnotatedMeshView object, const Point& centre, const FragmentOptions& options) {
    Cut result{{{}, "piece", {}}, generate_fragment(object.mesh, centre, options)};
    result.fragment.mesh = result.piece.mesh;
    for (const Annotation& annotation : object.annotations.annotations) {
        const auto& original_vertices = result.piece.vertices;
        const auto entry = std::find(original_vertices.begin(), original_vertices.end(), annotation.points.front());
        if (entry != original_vertices.end())
            result.fragment.annotations.annotations.push_back(
                landmark(annotation.id, annotation.tag, static_cast<Index>(entry - original_vertices.begin())));
    }
    return result;
}

}  // namespace ostraka::test
