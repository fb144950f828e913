// Points and normals of the target of a bake.
#pragma once

#include "ostraka/execution/parallel.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/mesh/limits.h"

#include <vector>

namespace ostraka::texture {

/// Points and interpolated normals of a mesh.
class TargetSurface {
public:
    explicit TargetSurface(const Mesh& mesh) : mesh_(mesh), normals_(mesh.number_of_vertices()) {
        parallel_for(normals_.size(), [&](std::size_t i) {
            const Vertex vertex(static_cast<Index>(i));
            normals_[i] = mesh.is_isolated(vertex) ? Vector(CGAL::NULL_VECTOR) : vertex_normal(mesh, vertex);
        });
    }

    [[nodiscard]] Point point(Index face, const std::array<double, 3>& barycentric) const {
        return point_at(mesh_, face, barycentric);
    }
    /// Unit normal; the null vector where no face has a normal.
    [[nodiscard]] Vector normal(Index face, const std::array<double, 3>& barycentric) const {
        const auto vertices = corners(mesh_, Face(face));
        Vector sum = CGAL::NULL_VECTOR;
        for (std::size_t k = 0; k < 3; ++k) sum = sum + barycentric[k] * normals_[vertices[k]];
        const Vector of_face = unit_vector(area_vector(mesh_, Face(face)));
        // Interpolated normals are not used where they point away from the face, as at folds.
        return sum * of_face > 0 ? unit_vector(sum) : of_face;
    }

private:
    const Mesh& mesh_;
    std::vector<Vector> normals_;
};

}  // namespace ostraka::texture
