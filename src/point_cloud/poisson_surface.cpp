// Poisson surfaces of oriented points.
#include "point_cloud/surface_parts.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/geom/point_tree.h"
#include "ostraka/io/repair.h"
#include "ostraka/point_cloud/cloud_surface.h"

#include <CGAL/Implicit_surface_3.h>
#include <CGAL/Poisson_reconstruction_function.h>
#include <CGAL/Surface_mesh_complex_2_in_triangulation_3.h>
#include <CGAL/Surface_mesh_default_criteria_3.h>
#include <CGAL/Surface_mesh_default_triangulation_3.h>
#include <CGAL/make_surface_mesh.h>
#include <CGAL/property_map.h>

#include <map>

namespace ostraka {

namespace {

using PoissonFunction = CGAL::Poisson_reconstruction_function<Kernel>;

/// The function of the surface for the mesher; asks now and then whether the work was cancelled.
class WatchedFunction {
public:
    explicit WatchedFunction(const PoissonFunction& function) : function_(function) {}
    double operator()(const Point& place) const {
        check_();
        return function_(place);
    }

private:
    PoissonFunction function_;  // a handle: copies share the solution
    mutable CancelCheck check_;
};

/// The library draws the first places that it tries from its global generator: started anew, so that every call gives the same
/// surface, and put back at the end.
class FixedSeed {
public:
    FixedSeed() : before_(CGAL::get_default_random()) { CGAL::get_default_random() = CGAL::Random(0); }
    ~FixedSeed() { CGAL::get_default_random() = before_; }
    FixedSeed(const FixedSeed&) = delete;
    FixedSeed& operator=(const FixedSeed&) = delete;

private:
    CGAL::Random before_;
};

/// The facets of a meshed level set, each in any orientation.
template <class Complex>
TriangleSoup triangles_of(const Complex& complex) {
    TriangleSoup soup;
    std::map<typename Complex::Vertex_handle, Index> number;
    for (auto facet = complex.facets_begin(); facet != complex.facets_end(); ++facet) {
        std::array<Index, 3> triangle{};
        for (int k = 0; k < 3; ++k) {
            const auto vertex = facet->first->vertex((facet->second + k + 1) % 4);
            const auto [entry, is_new] = number.try_emplace(vertex, static_cast<Index>(soup.points.size()));
            if (is_new) soup.points.push_back({vertex->point().x(), vertex->point().y(), vertex->point().z()});
            triangle[static_cast<std::size_t>(k)] = entry->second;
        }
        soup.triangles.push_back(triangle);
    }
    return soup;
}

/// The level set of the function as triangles. Vertices and cells are ordered by their creation, not by their addresses, so that
/// the mesh depends on the function alone.
TriangleSoup level_set(const PoissonFunction& function, double spacing, const PoissonOptions& options) {
    using Traits = CGAL::Robust_circumcenter_traits_3<Kernel>;
    using VertexBase = clouds::Stamped<CGAL::Surface_mesh_vertex_base_3<Traits>>;
    using CellBase = clouds::Stamped<
        CGAL::Delaunay_triangulation_cell_base_with_circumcenter_3<Traits, CGAL::Surface_mesh_cell_base_3<Traits>>>;
    using Triangulation = CGAL::Delaunay_triangulation_3<Traits, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;
    using Complex = CGAL::Surface_mesh_complex_2_in_triangulation_3<Triangulation>;
    const FixedSeed seed;
    const double radius = 5 * std::sqrt(function.bounding_sphere().squared_radius());
    constexpr double bisection = 1e-3, min_angle = 20;
    const CGAL::Implicit_surface_3<Kernel, WatchedFunction> surface(WatchedFunction(function),
                                                                    Kernel::Sphere_3(function.get_inner_point(), radius * radius),
                                                                    bisection * options.deviation * spacing / radius);
    const CGAL::Surface_mesh_default_criteria_3<Triangulation> criteria(min_angle, options.edge * spacing,
                                                                        options.deviation * spacing);
    Triangulation triangulation;
    Complex complex(triangulation);
    CGAL::make_surface_mesh(complex, surface, criteria, CGAL::Manifold_with_boundary_tag());
    return triangles_of(complex);
}

/// Agreement of the triangles within `distance` of a point with its normal: negative if the surface is inside out.
double agreement_with_normals(const Mesh& mesh, const std::vector<Point>& points, const std::vector<Vector>& normals,
                              double distance) {
    const PointTree tree(points);
    double sum = 0;
    for (const Face face : mesh.faces()) {
        const Index nearest = tree.nearest(centroid(mesh, face), distance).index;
        if (nearest != no_index) sum += area_vector(mesh, face) * normals[nearest];
    }
    return sum;
}

}  // namespace

CloudSurface poisson_surface(const PointCloud& cloud, const PoissonOptions& options, const CloudOptions& cloud_options) {
    check_options(options, "points");
    const std::vector<Vector> estimated =
        cloud.normals.size() == cloud.points.size() ? std::vector<Vector>() : estimate_normals(cloud.points, cloud_options);
    const std::vector<Vector>& normals = estimated.empty() ? cloud.normals : estimated;
    const clouds::Normalised frame(cloud.points);
    if (!(frame.size() > 0)) fail_input("points", "all coincide", "export them again");
    const std::vector<Point> points = frame.points();
    const double spacing = point_spacing(points);
    if (!(spacing > 0)) fail_input("points", "coincide in groups of seven and more", "export them again, without doubles");
    using Oriented = std::pair<Point, Vector>;
    std::vector<Oriented> oriented;
    oriented.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) oriented.emplace_back(points[i], normals[i]);
    PoissonFunction function(oriented.begin(), oriented.end(), CGAL::First_of_pair_property_map<Oriented>(),
                             CGAL::Second_of_pair_property_map<Oriented>());
    check_cancelled();
    const char* remedy = "check the normals, or use the method advancing-front";
    if (!function.compute_implicit_function()) fail_input("points", "do not define a Poisson surface", remedy);
    check_cancelled();
    TriangleSoup soup = level_set(function, spacing, options);
    if (soup.triangles.empty()) fail_input("points", "do not define a Poisson surface", remedy);
    for (auto& point : soup.points) {
        const Point place = frame.back(Point(point[0], point[1], point[2]));
        point = {place.x(), place.y(), place.z()};
    }
    RepairOptions repair_options;
    repair_options.fill_holes = 0;
    RepairResult repaired = repair(soup, {}, repair_options);
    CloudSurface result;
    result.mesh = std::move(repaired.mesh);
    result.sources.assign(result.mesh.number_of_vertices(), no_index);
    constexpr double near = 4;
    if (agreement_with_normals(result.mesh, cloud.points, normals, near * spacing * frame.size()) < 0) {
        soup = to_soup(result.mesh);
        for (auto& triangle : soup.triangles) std::swap(triangle[1], triangle[2]);
        result.mesh = build_mesh(soup);
    }
    clouds::count_borders(repaired.after, result);
    return result;
}

void PoissonOptions::declare_options(OptionList& list) {
    list("edge", edge, "for poisson: largest circumradius of a triangle, in multiples of the point spacing", Range{0.2, 1000});
    list("deviation", deviation,
         "for poisson: largest distance of a triangle from the Poisson surface, in multiples of the spacing", Range{0.01, 100});
}

}  // namespace ostraka
