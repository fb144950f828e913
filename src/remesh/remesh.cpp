#include "ostraka/remesh/remesh.h"
#include "ostraka/core/angles.h"

#include "ostraka/core/error.h"
#include "ostraka/core/memory.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/watched_tree.h"
#include "ostraka/remesh/refine.h"
#include "ostraka/remesh/simplify.h"
#include "remesh/metric.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <fmt/core.h>

#include <cmath>

namespace ostraka {

namespace {

/// Side of the equilateral triangles that cover `area` with `vertices` vertices: two triangles per vertex, sqrt(3)/4 L^2 each.
double edge_length_for(double area, double vertices) { return std::sqrt(2 * area / (std::sqrt(3.0) * vertices)); }

/// Edges are first cut into pieces of the wanted length. With thin triangles (a single outlier vertex is enough), the edges are
/// long but the area, which determines the length, is almost zero: the pieces would fill the memory before they are merged.
bool too_many_pieces(const Mesh& mesh, double length, double target_vertices) {
    const auto edges = static_cast<double>(mesh.number_of_edges());
    return !(mean_edge_length(mesh) * edges / length <= 1e6 + 10 * (edges + 3 * target_vertices));
}

void mark_features(const Mesh& mesh, double degrees, Mesh::Property_map<Edge, bool>& constrained) {
    const double cosine = std::cos(degrees * pi / 180);
    for (const Edge e : mesh.edges()) {
        if (mesh.is_border(e)) continue;
        const Vector a = area_vector(mesh, mesh.face(mesh.halfedge(e, 0))), b = area_vector(mesh, mesh.face(mesh.halfedge(e, 1)));
        constrained[e] = a * b < cosine * std::sqrt(a.squared_length() * b.squared_length());
    }
}

/// The points of a mesh. The library looks up a point at every step: each look-up also checks for cancellation.
struct WatchedPoints {
    using key_type = Vertex;
    using value_type = Point;
    using reference = const Point&;
    using category = boost::read_write_property_map_tag;
    Mesh* mesh;
    CancelCheck* check;
    friend reference get(const WatchedPoints& points, Vertex v) {
        (*points.check)();
        return points.mesh->point(v);
    }
    friend void put(const WatchedPoints& points, Vertex v, const Point& point) { points.mesh->point(v) = point; }
};

/// The kernel that also checks for cancellation, because building the library's AABB tree compares points. Faces without area
/// get a normal of tiny length here: at a vertex around which no face has a normal, the library's relaxation (CGAL 5.5) reads
/// an edge that does not exist.
struct WatchedKernel : Kernel {
    struct Construct_cross_product_vector_3 {  // NOLINT(readability-identifier-naming): the name that CGAL uses
        Vector operator()(const Vector& a, const Vector& b) const {
            const Vector product = CGAL::cross_product(a, b);
            return product == CGAL::NULL_VECTOR ? Vector(1e-100, 0, 0) : product;
        }
    };
    [[nodiscard]] static Construct_cross_product_vector_3 construct_cross_product_vector_3_object() { return {}; }
    [[nodiscard]] Less_x_3 less_x_3_object() const { return check_cancellation(), Kernel::less_x_3_object(); }
    [[nodiscard]] Less_y_3 less_y_3_object() const { return check_cancellation(), Kernel::less_y_3_object(); }
    [[nodiscard]] Less_z_3 less_z_3_object() const { return check_cancellation(), Kernel::less_z_3_object(); }
    static void check_cancellation() {
        thread_local CancelCheck check;
        check();
    }
};

void run_rounds(Mesh& mesh, double length, const RemeshOptions& options) {
    namespace pmp = CGAL::Polygon_mesh_processing;
    auto constrained = mesh.add_property_map<Edge, bool>("e:constrained", false).first;
    if (options.feature_angle > 0) mark_features(mesh, options.feature_angle, constrained);
    CancelCheck check;
    pmp::isotropic_remeshing(faces(mesh), length, mesh,
                             CGAL::parameters::number_of_iterations(static_cast<unsigned>(options.iterations))
                                 .number_of_relaxation_steps(1)
                                 .vertex_point_map(WatchedPoints{&mesh, &check})
                                 .geom_traits(WatchedKernel())
                                 .edge_is_constrained_map(constrained));
    mesh.remove_property_map(constrained);
    mesh.collect_garbage();
    mesh = build_mesh(to_soup(mesh));  // the library does not keep a border halfedge at border vertices
}

using Primitive = CGAL::AABB_face_graph_triangle_primitive<Mesh>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

/// Projects every interior vertex onto the old surface; returns the maximum remaining distance (border vertices are not moved).
double project(Mesh& mesh, const Tree& tree, double size) {
    const std::size_t count = mesh.number_of_vertices();
    std::vector<double> distance(count, 0);
    parallel_for(count, [&](std::size_t i) {
        const Vertex v(static_cast<Index>(i));
        const Point nearest = tree.closest_point(mesh.point(v));
        if (mesh.is_border(v)) distance[i] = std::sqrt(CGAL::squared_distance(mesh.point(v), nearest));
        else mesh.point(v) = nearest;
    });
    double max_distance = 0;
    for (const double d : distance) max_distance = std::max(max_distance, d);
    return max_distance < 1e-12 * size ? 0 : max_distance;
}

}  // namespace

RemeshResult remesh(const Mesh& mesh, const RemeshOptions& options) {
    check_options(options, "remesh");
    if (mesh.has_garbage()) throw std::logic_error("remesh: collect the garbage first");
    constexpr double bytes_of_vertex = 1500;  // including the AABB tree for the projection
    require_memory(
        bytes_of_vertex * (static_cast<double>(options.vertices) + 0.5 * static_cast<double>(mesh.number_of_vertices())),
        fmt::format("remeshing to {} vertices", options.vertices), "request fewer vertices");
    // Works on a centred copy of size one, so that tolerances inside the library have the same meaning for every object.
    const Frame frame = make_frame(mesh);
    TriangleSoup soup = to_soup(mesh);
    for (auto& p : soup.points) {
        const Vector x = frame.local(Point(p[0], p[1], p[2]));
        p = {x.x(), x.y(), x.z()};
    }
    const Mesh old = build_mesh(soup);
    soup = {};
    const double area = surface_area(old);
    if (!(area > 0) || !std::isfinite(area)) fail_input("mesh", "has no area to remesh", "choose a mesh with a surface");

    RemeshResult result;
    const auto target_vertices = static_cast<double>(options.vertices);
    double length = edge_length_for(area, target_vertices);
    // Borders, features and curvature change the number of vertices: it is measured and corrected.
    constexpr double accepted = 0.03;
    for (int attempt = 0; attempt < 3; ++attempt) {
        if (too_many_pieces(old, length, target_vertices)) {
            if (attempt > 0) break;
            fail_input("mesh", "has triangles that are too long and thin to be cut into equal triangles",
                       "remove vertices that lie far away, or repair the mesh");
        }
        result.mesh = old;
        run_rounds(result.mesh, length, options);
        result.remeshed = result.mesh.number_of_vertices();
        result.target_edge_length = length * frame.size;
        const double ratio = static_cast<double>(result.remeshed) / target_vertices;
        if (std::abs(ratio - 1) <= accepted) break;
        length *= std::sqrt(ratio);
    }
    if (result.remeshed > options.vertices) {
        SimplifyOptions simplification;
        simplification.vertices = options.vertices;
        simplify(result.mesh, simplification);
    } else if (result.remeshed < options.vertices) {
        RefineOptions refinement;
        refinement.vertices = options.vertices;
        refinement.scheme = RefineOptions::Scheme::longest_edge;
        refine(result.mesh, refinement);
    }
    result.reached = result.mesh.number_of_vertices() == options.vertices;
    Tree tree(faces(old).first, faces(old).second, old);
    build_watched(tree);
    tree.accelerate_distance_queries();
    result.deviation = project(result.mesh, tree, 1) * frame.size;
    for (const Vertex v : result.mesh.vertices()) result.mesh.point(v) = frame.world(result.mesh.point(v) - CGAL::ORIGIN);
    return result;
}

void RemeshOptions::declare_options(OptionList& list) {
    list("vertices", vertices, "target number of vertices (reached exactly unless the topology forbids)", Range{1, 5e8});
    list("iterations", iterations, "number of rounds of splitting, collapsing and flipping edges and smoothing vertices",
         Range{1, 100});
    list("feature-angle", feature_angle, "minimum dihedral angle, in degrees, of edges that are kept sharp; 0: none is kept",
         Range{0, 180});
}

}  // namespace ostraka
