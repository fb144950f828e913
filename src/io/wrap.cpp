// The watertight wrap (Portaneri, Rouxel-Labbé, Hemmer, Cohen-Steiner, Alliez 2022), by CGAL.
#include "ostraka/io/wrap.h"
#include "ostraka/core/error.h"

#include <CGAL/alpha_wrap_3.h>

namespace ostraka {

TriangleSoup wrap_soup(const TriangleSoup& soup, double alpha, double offset) {
    std::vector<Point> points;
    for (const auto& p : soup.points) points.emplace_back(p[0], p[1], p[2]);
    std::vector<std::array<std::size_t, 3>> triangles;
    for (const auto& t : soup.triangles) triangles.push_back({t[0], t[1], t[2]});
    Mesh mesh;
    CGAL::alpha_wrap_3(points, triangles, alpha, offset, mesh);
    mesh.collect_garbage();
    if (mesh.number_of_faces() == 0) fail_work("mesh", "could not be wrapped", "use another alpha and offset");
    return to_soup(mesh);
}

}  // namespace ostraka
