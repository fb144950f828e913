#include "geom/surface_patch.h"

#include "ostraka/core/progress.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

std::vector<Index> grow_faces(const Mesh& mesh, const std::vector<Face>& start, const std::function<bool(Face)>& inside) {
    std::vector<bool> seen(mesh.number_of_faces(), false);
    std::vector<Index> faces;
    const auto meet = [&](Face face) {
        if (face == Mesh::null_face() || seen[face]) return;
        seen[face] = true;
        if (inside(face)) faces.push_back(face);
    };
    for (const Face face : start) meet(face);
    CancelCheck check;
    std::size_t next = 0;  // the list grows while it is processed
    while (next < faces.size()) {
        check();
        for (const Vertex v : corners(mesh, Face(faces[next++])))
            for (const Face face : mesh.faces_around_target(mesh.halfedge(v))) meet(face);
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

bool may_hold_near(const Mesh& mesh, Face face, const PointTree& points, double limit) {
    const Point middle = centroid(mesh, face);
    double size = 0;
    for (const Vertex v : corners(mesh, face)) size = std::max(size, CGAL::squared_distance(mesh.point(v), middle));
    return std::sqrt(points.nearest(middle).squared) <= (limit + std::sqrt(size)) * (1 + 1e-12);
}

SurfacePatch cut_out(const Mesh& mesh, std::vector<Index> faces, const Point& origin) {
    check_cancelled();
    SurfacePatch patch;
    patch.faces = std::move(faces);
    std::vector<bool> selected(mesh.number_of_faces(), false);
    for (const Index face : patch.faces) selected[face] = true;
    const auto inside = [&](Halfedge h) { return !mesh.is_border(h) && selected[mesh.face(h)]; };
    // One vertex per fan: the corner at the target of a halfedge is propagated around the vertex in both directions.
    std::vector<Index> corner(mesh.number_of_halfedges(), no_index);
    for (const Index face : patch.faces)
        for (const Halfedge first : mesh.halfedges_around_face(mesh.halfedge(Face(face)))) {
            if (corner[first] != no_index) continue;
            const auto fresh = static_cast<Index>(patch.vertices.size());
            patch.vertices.push_back(mesh.target(first));
            for (Halfedge h = first; inside(h) && corner[h] == no_index; h = mesh.opposite(mesh.next(h))) corner[h] = fresh;
            for (Halfedge h = mesh.prev(mesh.opposite(first)); inside(h) && corner[h] == no_index;
                 h = mesh.prev(mesh.opposite(h)))
                corner[h] = fresh;
        }
    double extent = 0;
    for (const Index v : patch.vertices) {
        const Vector d = mesh.point(Vertex(v)) - origin;
        extent = std::max({extent, std::abs(d.x()), std::abs(d.y()), std::abs(d.z())});
    }
    if (extent > 0) patch.scale = std::exp2(std::ceil(std::log2(extent)));
    TriangleSoup soup;
    for (const Index v : patch.vertices) {
        const Vector d = mesh.point(Vertex(v)) - origin;
        soup.points.push_back({d.x() / patch.scale, d.y() / patch.scale, d.z() / patch.scale});
    }
    for (const Index face : patch.faces) {
        const Halfedge h = mesh.halfedge(Face(face));
        soup.triangles.push_back({corner[h], corner[mesh.next(h)], corner[mesh.prev(h)]});
    }
    patch.mesh = build_mesh(soup);
    return patch;
}

}  // namespace ostraka
