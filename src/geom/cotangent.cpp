#include "geom/cotangent.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// Cotangent of the angle opposite the halfedge in its face, clamped to at least 0.
double cotangent(const Mesh& mesh, Halfedge h) {
    if (mesh.is_border(h)) return 0;
    const Point& apex = mesh.point(mesh.target(mesh.next(h)));
    const Vector a = mesh.point(mesh.source(h)) - apex, b = mesh.point(mesh.target(h)) - apex;
    const double sine = std::sqrt(CGAL::cross_product(a, b).squared_length());
    // The weight of a degenerate triangle is limited to that of a very thin one.
    constexpr double maximum = 1e4;
    return sine > 0 ? std::clamp(a * b / sine, 0.0, maximum) : 0;
}

}  // namespace

double cotangent_weight(const Mesh& mesh, Edge edge) {
    const Halfedge h = mesh.halfedge(edge);
    return (cotangent(mesh, h) + cotangent(mesh, mesh.opposite(h))) / 2;
}

}  // namespace ostraka
