#include "ostraka/geom/submesh.h"

#include "geom/surface_patch.h"

#include "ostraka/core/error.h"
#include "ostraka/mesh/flood.h"

#include <string>

namespace ostraka {

namespace {

/// The faces of the piece with the largest area.
std::vector<Index> largest_piece(const Mesh& mesh, const std::vector<bool>& keep) {
    std::vector<Index> best;
    double maximum = -1;
    std::vector<bool> seen = keep;
    seen.flip();
    for (const Face start : mesh.faces()) {
        if (seen[start]) continue;
        const std::vector<Face> piece = flood_faces(mesh, start, seen);
        double area = 0;
        for (const Face face : piece) area += face_area(mesh, face);
        if (area > maximum) maximum = area, best.assign(piece.begin(), piece.end());
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
