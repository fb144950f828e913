// Green coordinates of a triangle mesh (Lipman, Levin, Cohen-Or 2008), in closed form.
//
// With the height h of a face's plane over x, the foot x' of x in it, and r the distance to x, the integrals over a face T are
//     psi   = 1/(4 pi) int_T 1/r          = 1/(4 pi) (sum_e delta_e L_e - h Omega)
//     phi_i = 1/(4 pi) int_T Gamma_i h/r^3 = 1/(4 pi) (Gamma_i(x') Omega - h sum_e (grad Gamma_i . nu_e) L_e)
// where nu_e is the outward normal of edge e in the plane, delta_e = nu_e . (e - x'), L_e = int_e 1/r and Omega the solid angle
// of T. L_e serves both faces of an edge. What vanishes near an edge (delta, h) comes from one and the same vector q from x to
// the foot on its line, so that the solid angles of its two faces still add up. Gamma_i(x') = delta_i / height_i.
#include "coords/cage_arrays.h"
#include "coords/kinds.h"
#include "coords/lanes.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

namespace ostraka::coords {

namespace {

/// A face whose height is below this share of its longest edge is skipped: its contribution is smaller than the rounding error
/// of the division by that height.
constexpr double flat = 1e-10;

/// Data of a face beside CageFace.
struct FacePlane {
    Vector3 unit;                ///< unit normal
    std::array<Vector3, 3> out;  ///< outward normals of the edges in the plane
    Vector3 across;              ///< out_i . out_j of the edges that meet at corner k
    Vector3 over_height;         ///< 1 / height over edge k
};

struct Work {
    explicit Work(const CageArrays& cage) : vertex(cage.points.size()), edge(cage.edges.size()), psi(cage.faces.size()) {}
    struct VertexLanes {
        VectorLanes p;  ///< from x to the vertex
        Lanes r, phi;   ///< |p|, and the weight
    };
    struct EdgeLanes {
        VectorLanes q;                  ///< from x to its foot on the edge's line
        Lanes square, start, end, log;  ///< |q|^2, parameters of the ends along the line, L
    };
    struct FaceLanes {
        Lanes psi;
    };
    std::vector<VertexLanes> vertex;
    std::vector<EdgeLanes> edge;
    std::vector<FaceLanes> psi;
    VectorLanes x;
    Lanes near;  ///< 1 where the point lies on the cage
};

/// Contribution of an edge to the solid angle of a face at the given height: the difference of atan(delta s / (|q|^2 + height
/// r)) between its ends, which lie at `start` and `end` along its line, at the distances r.
OSTRAKA_INLINE double solid_angle_of_edge(double delta, double square, double height, double size, double start, double end,
                                          double r_start, double r_end) {
    const double A = square + height * r_start, B = square + height * r_end;
    const double y = delta * (square * size + height * (end * r_start - start * r_end)), x = A * B + delta * delta * start * end;
    const double value = angle(std::fabs(y), x);
    return y < 0 ? -value : value;
}

OSTRAKA_EACH_WIDTH
void integrate(const CageArrays& cage, const std::vector<FacePlane>& planes, double snap, Work& work) {
    const double scale = cage.scale;
    Lanes near{};
    for (std::size_t i = 0; i < work.vertex.size(); ++i) {
        Work::VertexLanes& v = work.vertex[i];
        const Vector3 point = cage.points[i];
#pragma GCC ivdep
        for (int l = 0; l < lanes; ++l) {
            const Vector3 p = scale * (point - work.x.at(l));
            const double r = std::sqrt(dot(p, p));
            near[l] = r <= snap ? 1 : near[l];
            v.p.set(l, p);
            v.r[l] = r;
            v.phi[l] = 0;
        }
    }
    for (std::size_t i = 0; i < work.edge.size(); ++i) {
        const CageEdge& edge = cage.edges[i];
        Work::EdgeLanes& e = work.edge[i];
        const Work::VertexLanes &from = work.vertex[edge.from], &to = work.vertex[edge.to];
        const double size = edge.length;
        const Vector3 t = (size > 0 ? 1 / size : 0) * edge.along;
#pragma GCC ivdep
        for (int l = 0; l < lanes; ++l) {
            const bool first = from.r[l] <= to.r[l];
            const Vector3 p = select(first, from.p.at(l), to.p.at(l));
            // The foot on the line, with one step of re-orthogonalisation.
            const double s = dot(t, p);
            const Vector3 rough = p - s * t, q = rough - dot(t, rough) * t;
            const double square = dot(q, q);
            const double a = first ? s : s - size, b = first ? s + size : s;
            const double ra = from.r[l], rb = to.r[l], inner = a * b + square, product = ra * rb;
            // (ra + rb)^2 - size^2 = 2 (ra rb + inner); close to the edge the sum cancels and is computed from the distance.
            const double opposite = product - inner, sum = ra + rb + size;
            const double difference = inner < 0 ? size * size * square / (opposite > 0 ? opposite : 1) : product + inner;
            near[l] = square <= snap * snap && a <= 0 && b >= 0 ? 1 : near[l];
            e.q.set(l, q);
            e.square[l] = square;
            e.start[l] = a;
            e.end[l] = b;
            const double ratio = sum * sum / (2 * (difference > 0 ? difference : 1));
            e.log[l] = logarithm(difference > 0 && ratio > 1 ? ratio : 1);
        }
    }
    for (std::size_t i = 0; i < work.psi.size(); ++i) {
        const CageFace& face = cage.faces[i];
        const FacePlane& plane = planes[i];
        Work::VertexLanes &v0 = work.vertex[face.corner[0]], &v1 = work.vertex[face.corner[1]], &v2 = work.vertex[face.corner[2]];
        const Work::EdgeLanes &e0 = work.edge[face.edge[0]], &e1 = work.edge[face.edge[1]], &e2 = work.edge[face.edge[2]];
        const double size0 = cage.edges[face.edge[0]].length, size1 = cage.edges[face.edge[1]].length,
                     size2 = cage.edges[face.edge[2]].length;
        // The ends of an edge in the face's own direction, from corner k + 1 to corner k + 2.
        const double s0 = face.sign[0], s1 = face.sign[1], s2 = face.sign[2];
        const Lanes &start0 = s0 > 0 ? e0.start : e0.end, &end0 = s0 > 0 ? e0.end : e0.start;
        const Lanes &start1 = s1 > 0 ? e1.start : e1.end, &end1 = s1 > 0 ? e1.end : e1.start;
        const Lanes &start2 = s2 > 0 ? e2.start : e2.end, &end2 = s2 > 0 ? e2.end : e2.start;
        const Vector3 n = plane.unit, out0 = plane.out[0], out1 = plane.out[1], out2 = plane.out[2];
        const double a0 = plane.across[0], a1 = plane.across[1], a2 = plane.across[2];
        const double close = plane.over_height[0] > 0 ? snap : -1;  // disabled for a face that is skipped
        const double f0 = plane.over_height[0], f1 = plane.over_height[1], f2 = plane.over_height[2];
#pragma GCC ivdep
        for (int l = 0; l < lanes; ++l) {
            // The height, computed from the foot point on the nearest edge.
            const double q0 = e0.square[l], q1 = e1.square[l], q2 = e2.square[l];
            const Vector3 foot0 = e0.q.at(l), foot1 = e1.q.at(l), foot2 = e2.q.at(l);
            const double h0 = dot(n, foot0), h1 = dot(n, foot1), h2 = dot(n, foot2);
            const double h01 = q0 <= q1 ? h0 : h1, q01 = q0 <= q1 ? q0 : q1, h = q01 <= q2 ? h01 : h2, height = std::fabs(h);
            const double d0 = dot(out0, foot0), d1 = dot(out1, foot1), d2 = dot(out2, foot2);
            const double omega = solid_angle_of_edge(d0, q0, height, size0, s0 * start0[l], s0 * end0[l], v1.r[l], v2.r[l]) +
                                 solid_angle_of_edge(d1, q1, height, size1, s1 * start1[l], s1 * end1[l], v2.r[l], v0.r[l]) +
                                 solid_angle_of_edge(d2, q2, height, size2, s2 * start2[l], s2 * end2[l], v0.r[l], v1.r[l]);
            near[l] = height <= close && d0 >= -snap && d1 >= -snap && d2 >= -snap ? 1 : near[l];
            const double solid = h < 0 ? -omega : omega;
            const double L0 = e0.log[l], L1 = e1.log[l], L2 = e2.log[l];
            v0.phi[l] += f0 * (d0 * solid + h * (L0 + a2 * L1 + a1 * L2));
            v1.phi[l] += f1 * (d1 * solid + h * (a2 * L0 + L1 + a0 * L2));
            v2.phi[l] += f2 * (d2 * solid + h * (a1 * L0 + a0 * L1 + L2));
            work.psi[i].psi[l] = d0 * L0 + d1 * L1 + d2 * L2 - h * solid;
        }
    }
    for (int l = 0; l < lanes; ++l) work.near[l] = near[l];
}

std::vector<FacePlane> planes_of(const CageArrays& cage) {
    std::vector<FacePlane> planes;
    for (const CageFace& face : cage.faces) {
        FacePlane plane{};
        double longest = 0;
        for (const Index e : face.edge) longest = std::max(longest, cage.edges[e].length);
        if (face.double_area > flat * longest * longest) {
            plane.unit = 1 / face.double_area * face.normal;
            for (std::size_t k = 0; k < 3; ++k) {
                const CageEdge& edge = cage.edges[face.edge[k]];
                plane.out[k] = face.sign[k] / edge.length * cross(edge.along, plane.unit);
                plane.over_height[k] = edge.length / face.double_area;
            }
            for (std::size_t k = 0; k < 3; ++k) plane.across[k] = dot(plane.out[(k + 1) % 3], plane.out[(k + 2) % 3]);
        }
        planes.push_back(plane);
    }
    return planes;
}

/// Six times the signed volume, relative to the first vertex.
double orientation(const CageArrays& cage) {
    double sum = 0;
    for (const CageFace& face : cage.faces) sum += dot(cage.from(cage.points[0], face.corner[0]), face.normal);
    return sum;
}

}  // namespace

Coordinates green(const Mesh& mesh, const std::vector<Point>& points, const CoordinateOptions& options) {
    const CageArrays cage(mesh);
    if (!(orientation(cage) > 0))
        fail_input("cage", "is inside out or without volume", "reverse its faces so that their normals point outward");
    const std::vector<FacePlane> planes = planes_of(cage);
    const double snap = options.snap * cage.diagonal;
    Coordinates result;
    const auto rows = static_cast<Eigen::Index>(points.size());
    result.vertex.resize(rows, static_cast<Eigen::Index>(cage.points.size()));
    result.normal.resize(rows, static_cast<Eigen::Index>(cage.faces.size()));
    std::vector<double> winding_numbers(points.size());  // of the cage around each point; NaN on the cage
    const auto compute = [&](Work& work) { integrate(cage, planes, snap, work); };
    for_each_point<Work>(cage, points, compute, [&](const Work& work, std::size_t l, std::size_t point) {
        const auto row = static_cast<Eigen::Index>(point);
        double *phi = result.vertex.row(row).data(), *psi = result.normal.row(row).data(), sum = 0;
        for (std::size_t i = 0; i < work.vertex.size(); ++i) sum += phi[i] = work.vertex[i].phi[l] / (4 * pi);
        for (std::size_t i = 0; i < work.psi.size(); ++i) psi[i] = work.psi[i].psi[l] / (4 * pi * cage.scale);
        winding_numbers[point] = work.near[l] != 0 ? std::numeric_limits<double>::quiet_NaN() : sum;
    });
    std::string outside_indices;
    std::size_t outside = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!(std::fabs(winding_numbers[i] - 1) <= 1e-6))
            if (++outside <= 10) outside_indices += (outside_indices.empty() ? "" : ", ") + std::to_string(i);
    if (outside > 0)
        fail_input("cage",
                   fmt::format("{} {} not lie strictly inside, the only place where Green coordinates are defined: {}{}", outside,
                               outside == 1 ? "point does" : "points do", outside_indices, outside > 10 ? " ..." : ""),
                   "widen the cage there, or use mean value coordinates");
    return result;
}

}  // namespace ostraka::coords
