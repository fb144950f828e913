#include "ostraka/geom/submesh.h"

#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

namespace ostraka {

std::vector<Halfedge> holes_of(const Mesh& mesh) {
    std::vector<Halfedge> holes;
    std::vector<bool> seen(mesh.number_of_halfedges(), false);
    for (const Halfedge first : mesh.halfedges()) {
        if (!mesh.is_border(first) || seen[first]) continue;
        holes.push_back(first);
        for (Halfedge h = first; !seen[h]; h = mesh.next(h)) seen[h] = true;
    }
    return holes;
}

std::size_t close_hole(Mesh& mesh, Halfedge border) {
    std::vector<Face> patch;
    CGAL::Polygon_mesh_processing::triangulate_hole(mesh, border, std::back_inserter(patch));
    return patch.size();
}

}  // namespace ostraka
