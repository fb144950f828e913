// CGAL's tree, the reference for other measurements.
#include "benchmarks.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>

#include <chrono>

namespace ostraka::bench {

double seconds_of_cgal_tree(const Mesh& mesh) {
    using Primitive = CGAL::AABB_face_graph_triangle_primitive<Mesh>;
    const auto start = std::chrono::steady_clock::now();
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree(faces(mesh).begin(), faces(mesh).end(), mesh);
    tree.build();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (tree.size() != mesh.number_of_faces()) return 0;
    return seconds;
}

}  // namespace ostraka::bench
