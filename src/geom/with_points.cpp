#include "ostraka/geom/with_points.h"

#include "ostraka/core/error.h"

namespace ostraka {

Mesh with_points(const Mesh& mesh, const std::vector<Point>& points) {
    if (points.size() != mesh.num_vertices())
        fail_usage(
            "there are " + std::to_string(points.size()) + " points for " + std::to_string(mesh.num_vertices()) + " vertices",
            "give one for each vertex");
    Mesh moved = mesh;
    for (const Vertex v : moved.vertices()) moved.point(v) = points[v];
    return moved;
}

}  // namespace ostraka
