#include "ostraka/fields/curvature.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/fields/statistics.h"
#include "ostraka/geom/neighbourhood.h"

#include <cmath>
#include <limits>

namespace ostraka {

namespace {

std::vector<Vector> unit_normals(const Mesh& mesh) {
    std::vector<Vector> normals(mesh.number_of_faces(), Vector(0, 0, 0));
    parallel_for(normals.size(), [&](std::size_t f) {
        const Vector a = area_vector(mesh, Face(static_cast<Index>(f)));
        const double length = std::sqrt(a.squared_length());
        if (length > 0) normals[f] = a / length;
    });
    return normals;
}

/// Curvature of an edge between two faces with area.
struct EdgeCurvature {
    double mean = 0;         ///< l b / 2 (Cohen-Steiner and Morvan 2003)
    Vector vector{0, 0, 0};  ///< half the sum of the two conormals (Sullivan 2008), of length l sin(b / 2)
};

EdgeCurvature edge_curvature(const Mesh& mesh, const std::vector<Vector>& normals, Edge edge) {
    EdgeCurvature result;
    const Halfedge h = mesh.halfedge(edge), o = mesh.opposite(h);
    if (mesh.is_border(h) || mesh.is_border(o)) return result;
    const Vector &left = normals[mesh.face(h)], &right = normals[mesh.face(o)];
    if (left == CGAL::NULL_VECTOR || right == CGAL::NULL_VECTOR) return result;
    const Vector e = mesh.point(mesh.target(h)) - mesh.point(mesh.source(h));
    const double length = std::sqrt(e.squared_length());
    if (!(length > 0)) return result;
    const double angle = std::atan2(CGAL::cross_product(left, right) * e / length, left * right);
    result.mean = length * angle / 2;
    result.vector = CGAL::cross_product(e, left - right) / 2;
    return result;
}

double angle_at(const Mesh& mesh, Halfedge h) {  // at the target of h, in the face of h
    const Point& p = mesh.point(mesh.target(h));
    const Vector a = mesh.point(mesh.source(h)) - p, b = mesh.point(mesh.target(mesh.next(h))) - p;
    return std::atan2(std::sqrt(CGAL::cross_product(a, b).squared_length()), a * b);
}

/// Angle deficit; 0 at the border and for isolated vertices.
double deficit(const Mesh& mesh, Vertex vertex) {
    if (mesh.is_isolated(vertex) || mesh.is_border(vertex)) return 0;
    double sum = 0;
    for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(vertex))) sum += angle_at(mesh, h);
    return 2 * pi - sum;
}

/// Integrals per face: half of its edges, and its share of the vertices' deficits by angle.
struct FaceShares {
    CurvatureIntegrals integrals;
    std::vector<Vector> vector;
};

FaceShares face_area_fractions(const Mesh& mesh) {
    const std::vector<Vector> normals = unit_normals(mesh);
    std::vector<EdgeCurvature> edges(mesh.number_of_edges());
    std::vector<double> deficits(mesh.number_of_vertices());
    parallel_for(edges.size(), [&](std::size_t e) { edges[e] = edge_curvature(mesh, normals, Edge(static_cast<Index>(e))); });
    parallel_for(deficits.size(), [&](std::size_t v) { deficits[v] = deficit(mesh, Vertex(static_cast<Index>(v))); });
    FaceShares shares;
    shares.integrals.mean.assign(mesh.number_of_faces(), 0);
    shares.integrals.gaussian = shares.integrals.mean;
    shares.vector.assign(mesh.number_of_faces(), Vector(0, 0, 0));
    parallel_for(shares.vector.size(), [&](std::size_t f) {
        for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(Face(static_cast<Index>(f))))) {
            const EdgeCurvature& edge = edges[mesh.edge(h)];
            shares.integrals.mean[f] += edge.mean / 2;
            shares.vector[f] += edge.vector / 2;
            const double deficit_at_vertex = deficits[mesh.target(h)], angle_sum = 2 * pi - deficit_at_vertex;
            if (deficit_at_vertex != 0 && angle_sum > 0)
                shares.integrals.gaussian[f] += deficit_at_vertex * angle_at(mesh, h) / angle_sum;
        }
    });
    return shares;
}

/// A face without a border edge has all its dihedral angles, a face without a border vertex all its angle deficits.
struct CompleteFaces {
    std::vector<std::uint8_t> mean, gaussian;
};

CompleteFaces complete_faces(const Mesh& mesh) {
    CompleteFaces complete;
    complete.mean.assign(mesh.number_of_faces(), 1);
    complete.gaussian = complete.mean;
    parallel_for(complete.mean.size(), [&](std::size_t f) {
        for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(Face(static_cast<Index>(f))))) {
            if (mesh.is_border(mesh.opposite(h))) complete.mean[f] = 0;
            if (mesh.is_border(mesh.target(h))) complete.gaussian[f] = 0;
        }
    });
    return complete;
}

/// Per vertex, a third of the integrals and areas of the adjacent complete faces.
struct VertexShares {
    std::vector<double> mean, gaussian, mean_area, gaussian_area;
    std::vector<Vector> mean_vector, area_vector;
};

VertexShares vertex_shares(const Mesh& mesh) {
    const FaceShares faces = face_area_fractions(mesh);
    const CompleteFaces complete = complete_faces(mesh);
    const std::size_t count = mesh.number_of_vertices();
    VertexShares shares;
    shares.mean.assign(count, 0);
    shares.gaussian = shares.mean_area = shares.gaussian_area = shares.mean;
    shares.mean_vector.assign(count, Vector(0, 0, 0));
    shares.area_vector = shares.mean_vector;
    parallel_for(count, [&](std::size_t i) {
        const Vertex v(static_cast<Index>(i));
        if (mesh.is_isolated(v)) return;
        for (const Face face : mesh.faces_around_target(mesh.halfedge(v))) {
            if (face == Mesh::null_face()) continue;
            const Vector a = ostraka::area_vector(mesh, face) / 3;
            const double area = std::sqrt(a.squared_length());
            if (complete.gaussian[face] != 0) {
                shares.gaussian_area[i] += area;
                shares.gaussian[i] += faces.integrals.gaussian[face] / 3;
            }
            if (complete.mean[face] == 0) continue;
            shares.area_vector[i] += a;
            shares.mean_area[i] += area;
            shares.mean[i] += faces.integrals.mean[face] / 3;
            shares.mean_vector[i] += faces.vector[face] / 3;
        }
    });
    return shares;
}

constexpr double no_curvature = std::numeric_limits<double>::quiet_NaN();

/// Curvatures of an interior vertex from its edges and angles alone, where it has no complete face.
std::pair<double, double> own_curvatures(const Mesh& mesh, Vertex v) {
    double area = 0, mean = 0;
    const auto unit_normal = [&](Face face) {
        const Vector a = ostraka::area_vector(mesh, face);
        const double length = std::sqrt(a.squared_length());
        return length > 0 ? Vector(a / length) : Vector(0, 0, 0);
    };
    for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(v))) {
        area += face_area(mesh, mesh.face(h)) / 3;
        const Vector left = unit_normal(mesh.face(h)), right = unit_normal(mesh.face(mesh.opposite(h)));
        const Vector e = mesh.point(mesh.target(h)) - mesh.point(mesh.source(h));
        const double length = std::sqrt(e.squared_length());
        if (length > 0) mean += length * std::atan2(CGAL::cross_product(left, right) * e / length, left * right) / 4;
    }
    return area > 0 ? std::pair(mean / area, deficit(mesh, v) / area) : std::pair(no_curvature, no_curvature);
}

}  // namespace

Curvature curvature(const Mesh& mesh, const CurvatureOptions& options) {
    check_options(options, "curvature");
    const VertexShares shares = vertex_shares(mesh);
    const double radius = options.scale * box_diagonal(mesh);
    Curvature result;
    result.mean.assign(mesh.number_of_vertices(), no_curvature);
    result.gaussian = result.mean;
    parallel_for(result.mean.size(), 4096, [&](std::size_t i) {
        const Vertex vertex(static_cast<Index>(i));
        if (mesh.is_isolated(vertex) || mesh.is_border(vertex)) return;
        if (radius > 0) {
            check_cancelled();  // a ball may be large
            const double squared_radius = radius * radius;
            Vector h(0, 0, 0), a(0, 0, 0);
            double gaussian = 0, area = 0;
            this_threads_neighbourhood().walk(mesh, vertex, radius, [&](Vertex v, double squared) {
                const double falloff = 1 - squared / squared_radius, w = falloff * falloff;
                h += w * shares.mean_vector[v];
                a += w * shares.area_vector[v];
                gaussian += w * shares.gaussian[v];
                area += w * shares.gaussian_area[v];
            });
            const double projected = a.squared_length();
            if (projected > 0) result.mean[i] = h * a / projected;
            if (area > 0) result.gaussian[i] = gaussian / area;
        } else {
            if (shares.mean_area[i] > 0) result.mean[i] = shares.mean[i] / shares.mean_area[i];
            if (shares.gaussian_area[i] > 0) result.gaussian[i] = shares.gaussian[i] / shares.gaussian_area[i];
        }
        if (!std::isnan(result.mean[i]) && !std::isnan(result.gaussian[i])) return;
        const auto [own_mean, own_gaussian] = own_curvatures(mesh, vertex);
        if (std::isnan(result.mean[i])) result.mean[i] = own_mean;
        if (std::isnan(result.gaussian[i])) result.gaussian[i] = own_gaussian;
    });
    return result;
}

CurvatureIntegrals curvature_integrals(const Mesh& mesh) { return face_area_fractions(mesh).integrals; }

RegionCurvature region_curvature(const Mesh& mesh, const CurvatureIntegrals& integrals, const std::vector<Index>& faces) {
    if (integrals.mean.size() != mesh.number_of_faces()) fail_usage("the integrals belong to another mesh", "compute them again");
    RegionCurvature result;
    check_region(mesh, faces);
    for (const Index face : faces) {
        result.area += face_area(mesh, Face(face));
        result.mean_integral += integrals.mean[face];
        result.gaussian_integral += integrals.gaussian[face];
    }
    return result;
}

void CurvatureOptions::declare_options(OptionList& list) {
    list("scale", scale,
         "radius over which curvature is averaged; a larger radius makes the curvature less sensitive to noise; 0: only the "
         "faces around each vertex",
         Range{0, 1}, "share of the box diagonal");
}

}  // namespace ostraka
