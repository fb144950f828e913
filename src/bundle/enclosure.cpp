#include "ostraka/bundle/enclosure.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Polygon_mesh_processing/intersection.h>
#include <CGAL/Side_of_triangle_mesh.h>

namespace ostraka {

Enclosure enclosure(const Mesh& cage, const Mesh& mesh) {
    Enclosure result;
    if (cage.number_of_faces() == 0) return result;
    result.closed = true;
    for (const Halfedge h : cage.halfedges()) result.closed = result.closed && !cage.is_border(h);
    if (!result.closed) return result;
    double volume = 0;
    const Point origin = *cage.points().begin();
    for (const Face face : cage.faces()) volume += (centroid(cage, face) - origin) * area_vector(cage, face);
    result.outward = volume > 0;

    using Primitive = CGAL::AABB_face_graph_triangle_primitive<Mesh>;
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree(cage.faces().begin(), cage.faces().end(), cage);
    tree.build();
    const CGAL::Side_of_triangle_mesh<Mesh, Kernel> side(tree);
    for (const Vertex vertex : mesh.vertices()) {
        if (mesh.is_isolated(vertex)) continue;
        const CGAL::Bounded_side where = side(mesh.point(vertex));
        result.outside += where == CGAL::ON_UNBOUNDED_SIDE;
        result.touching += where == CGAL::ON_BOUNDARY;
    }
    if (result.outside + result.touching == 0) result.intersecting = CGAL::Polygon_mesh_processing::do_intersect(cage, mesh);
    return result;
}

}  // namespace ostraka
