#include "ostraka/geom/submesh.h"

#include "geom/surface_patch.h"

#include "ostraka/core/error.h"

#include <string>

namespace ostraka {

namespace {

/// The faces of the piece with the largest area.
std::vector<Index> largest_piece(const Mesh& mesh, const std::vector<bool>& keep) {
    std::vector<Index> best;
    double maximum = -1;
    std::vector<bool> seen(mesh.number_of_faces(), false);
    for (const Face start : mesh.faces()) {
        if (!keep[start] || seen[start]) continue;
        std::vector<Index> piece{start};
        seen[start] = true;
        double area = 0;
        for (std::size_t i = 0; i < piece.size(); ++i) {
            area += face_area(mesh, Face(piece[i]));
            for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(Face(piece[i])))) {
                const Face next = mesh.face(mesh.opposite(h));
                if (next == Mesh::null_face() || !keep[next] || seen[next]) continue;
                seen[next] = true;
                piece.push_back(next);
            }
        }
        if (area > maximum) maximum = area, best = std::move(piece);
    }
    std::sort(best.begin(), best.end());
    return best;
}

}  // namespace

SubMesh keep_faces(const Mesh& mesh, const std::vector<bool>& keep, bool largest_only) {
    if (keep.size() != mesh.number_of_faces())
        fail_usage(std::to_string(keep.size()) + " marks for " + std::to_string(mesh.number_of_faces()) + " faces",
                   "give one a face");
    std::vector<Index> faces;
    if (largest_only) {
        faces = largest_piece(mesh, keep);
    } else {
        for (Index f = 0; f < keep.size(); ++f)
            if (keep[f]) faces.push_back(f);
    }
    SubMesh result = cut_out(mesh, std::move(faces), Point(0, 0, 0));
    for (const Vertex v : result.mesh.vertices()) result.mesh.point(v) = mesh.point(Vertex(result.vertices[v]));
    return result;
}

}  // namespace ostraka
