#include "wrap.h"

#include <CGAL/alpha_wrap_3.h>

namespace ostraka::cage {

Mesh wrap(const TriangleSoup& soup, double alpha, double offset) {
    std::vector<Point> points;
    for (const auto& p : soup.points) points.emplace_back(p[0], p[1], p[2]);
    std::vector<std::array<std::size_t, 3>> triangles;
    for (const auto& t : soup.triangles) triangles.push_back({t[0], t[1], t[2]});
    Mesh mesh;
    CGAL::alpha_wrap_3(points, triangles, alpha, offset, mesh);
    mesh.collect_garbage();
    return mesh;
}

}  // namespace ostraka::cage
