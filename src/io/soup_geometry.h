// Geometric quantities of a triangle soup. Private to the module.
#pragma once

#include "ostraka/io/diagnose.h"

namespace ostraka::detail {

inline Point point(const TriangleSoup& soup, Index v) { return {soup.points[v][0], soup.points[v][1], soup.points[v][2]}; }

/// Twice the area vector of a triangle.
inline Vector normal(const TriangleSoup& soup, const std::array<Index, 3>& t) {
    const Point a = point(soup, t[0]);
    return CGAL::cross_product(point(soup, t[1]) - a, point(soup, t[2]) - a);
}
inline double area(const TriangleSoup& soup, const std::array<Index, 3>& t) {
    return 0.5 * std::sqrt(normal(soup, t).squared_length());
}
/// Six times the signed volume of the tetrahedron spanned by a triangle and the apex.
inline double sixfold_volume(const TriangleSoup& soup, const std::array<Index, 3>& t, const Point& apex) {
    return CGAL::cross_product(point(soup, t[0]) - apex, point(soup, t[1]) - apex) * (point(soup, t[2]) - apex);
}

/// True if the corners of a triangle are exactly collinear or coincide.
bool has_no_area(const TriangleSoup& soup, const std::array<Index, 3>& t);
/// For each triangle: 1 if `has_no_area`, else 0.
std::vector<std::uint8_t> triangles_without_area(const TriangleSoup& soup);

/// Bounding box of the vertices with triangles.
CGAL::Bbox_3 box_of_triangles(const TriangleSoup& soup);
double diagonal(const CGAL::Bbox_3& box);  ///< length of the diagonal

/// Finds intersecting pairs of triangles. `place`: for each vertex, the first vertex with the same position; `without_area`: for
/// each triangle, 1 if it is ignored.
SelfIntersections self_intersections(const TriangleSoup& soup, const std::vector<Index>& place,
                                     const std::vector<std::uint8_t>& without_area, std::size_t limit);

/// For each closed component listed in `inner`: the closed components that it lies completely inside, ascending. Components with
/// nested bounding boxes are tested by a ray from one triangle. `closed`: for each component, true if the component is closed.
std::vector<std::vector<Index>> enclosing_components(const TriangleSoup& soup, const std::vector<Index>& component_of_triangle,
                                                     const std::vector<bool>& closed, const std::vector<Index>& inner);
/// For each closed component listed in `inner`: 1 if the component lies completely inside another closed component.
std::vector<std::uint8_t> enclosed_components(const TriangleSoup& soup, const std::vector<Index>& component_of_triangle,
                                              const std::vector<bool>& closed, const std::vector<Index>& inner);

}  // namespace ostraka::detail
