#include "ostraka/geom/submesh.h"

#include "ostraka/core/progress.h"

#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

namespace ostraka {

namespace {

/// Checks for cancellation at every step of CGAL's algorithm.
struct WatchedFilling : CGAL::Polygon_mesh_processing::Hole_filling::Default_visitor {
    void quadratic_step() const { check(); }
    void cubic_step() const { check(); }
    mutable CancelCheck check;
};

}  // namespace

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
    WatchedFilling watched;
    CGAL::Polygon_mesh_processing::triangulate_hole(mesh, border, std::back_inserter(patch),
                                                    CGAL::parameters::visitor(std::ref(watched)));
    return patch.size();
}

}  // namespace ostraka
