#include "ostraka/mesh/orientation.h"

#include <CGAL/boost/graph/helpers.h>

#include <utility>

namespace ostraka {

double signed_volume(const Mesh& mesh) {
    double volume = 0;
    if (mesh.number_of_faces() == 0) return 0;
    const Point origin = mesh.point(*mesh.vertices().begin());
    for (const Face face : mesh.faces()) volume += (centroid(mesh, face) - origin) * area_vector(mesh, face);
    return volume / 3;
}

bool is_inside_out(const Mesh& mesh) { return CGAL::is_closed(mesh) && signed_volume(mesh) < 0; }

Mesh turned_over(const Mesh& mesh) {
    TriangleSoup soup = to_soup(mesh);
    for (auto& corners_of_face : soup.triangles) std::swap(corners_of_face[1], corners_of_face[2]);
    return build_mesh(soup);
}

}  // namespace ostraka
