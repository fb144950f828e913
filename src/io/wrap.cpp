// The watertight wrap (Portaneri, Rouxel-Labbé, Hemmer, Cohen-Steiner, Alliez 2022), by CGAL.
#include "ostraka/io/wrap.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/geom/watched_tree.h"

#include <CGAL/alpha_wrap_3.h>

namespace ostraka {

namespace {

/// The triangles to wrap. CGAL queries them at every step, and each query checks for cancellation.
class WatchedTriangles : public CGAL::Alpha_wraps_3::internal::Triangle_soup_oracle<Kernel> {
public:
    using Triangles = Triangle_soup_oracle<Kernel>;
    using Triangles::Triangles;
    template <class Query>
    bool do_intersect(const Query& query) const {
        check_();
        return Triangles::do_intersect(query);
    }
    Point closest_point(const Point& query) const {
        check_();
        return Triangles::closest_point(query);
    }
    bool first_intersection(const Point& from, const Point& to, Point& intersection, double offset) const {
        check_();
        return Triangles::first_intersection(from, to, intersection, offset);
    }

private:
    mutable CancelCheck check_;
};

}  // namespace

TriangleSoup wrap_soup(const TriangleSoup& soup, double alpha, double offset) {
    std::vector<Point> points;
    for (const auto& p : soup.points) points.emplace_back(p[0], p[1], p[2]);
    std::vector<std::array<std::size_t, 3>> triangles;
    for (const auto& t : soup.triangles) triangles.push_back({t[0], t[1], t[2]});
    Mesh mesh;
    WatchedTriangles oracle(alpha, Kernel());
    oracle.add_triangle_soup(points, triangles);
    build_watched(oracle.tree());
    CGAL::Alpha_wraps_3::internal::Alpha_wrap_3<WatchedTriangles> wrap(oracle);
    wrap(alpha, offset, mesh);
    mesh.collect_garbage();
    if (mesh.number_of_faces() == 0) fail_work("mesh", "could not be wrapped", "use another alpha and offset");
    return to_soup(mesh);
}

}  // namespace ostraka
