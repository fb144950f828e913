// Green coordinates of a triangle mesh (Lipman, Levin, Cohen-Or 2008), in closed form.
//
// With the height h of a face's plane over x, the foot x' of x in it, and r the distance to x, the integrals over a face T are
//     psi   = 1/(4 pi) int_T 1/r          = 1/(4 pi) (sum_e delta_e L_e - h Omega)
//     phi_i = 1/(4 pi) int_T Gamma_i h/r^3 = 1/(4 pi) (Gamma_i(x') Omega - h sum_e (grad Gamma_i . nu_e) L_e)
// where nu_e is the outward normal of edge e in the plane, delta_e = nu_e . (e - x'), L_e = int_e 1/r and Omega the solid angle
// of T. L_e serves both faces of an edge. What vanishes near an edge (delta, h) comes from one and the same vector q from x to
// the foot on its line, so that the solid angles of its two faces still add up. Gamma_i(x') = delta_i / height_i.
#include "cage_arrays.h"
#include "kinds.h"
#include "lanes.h"

#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"

#include <algorithm>
#include <limits>

namespace ostraka::coords {

namespace {

/// What a face's loop needs beside CageFace.
struct FacePlane {
    Three unit;                ///< normal
    std::array<Three, 3> out;  ///< outward normals of the edges in the plane
    Three across;              ///< out_i . out_j of the edges that meet at corner k
    Three over_height;         ///< 1 / height over edge k
};

struct Work {
    explicit Work(const CageArrays& cage) : vertex(cage.points.size()), edge(cage.edges.size()), psi(cage.faces.size()) {}
    struct OfVertex {
        Lanes p[3], r, phi;
    };
    struct OfEdge {
        Lanes q[3], square, start, end, log;  ///< foot on the line, |q|^2, places of the ends along the line, L
    };
    struct OfFace {
        Lanes psi;
    };
    std::vector<OfVertex> vertex;
    std::vector<OfEdge> edge;
    std::vector<OfFace> psi;
    Lanes x[3];
    Lanes near;  ///< 1 where the point lies on the cage
};

OSTRAKA_EACH_WIDTH
void integrate(const CageArrays& cage, const std::vector<FacePlane>& planes, double snap, Work& work) {
    const double scale = cage.scale;
    Lanes near{};
    for (std::size_t i = 0; i < work.vertex.size(); ++i) {
        Work::OfVertex& v = work.vertex[i];
        const Three& point = cage.points[i];
        for (int l = 0; l < lanes; ++l) {
            const double px = scale * (point[0] - work.x[0][l]), py = scale * (point[1] - work.x[1][l]),
                         pz = scale * (point[2] - work.x[2][l]);
            const double r = std::sqrt(px * px + py * py + pz * pz);
            near[l] = r <= snap ? 1 : near[l];
            v.p[0][l] = px;
            v.p[1][l] = py;
            v.p[2][l] = pz;
            v.r[l] = r;
            v.phi[l] = 0;
        }
    }
    for (std::size_t i = 0; i < work.edge.size(); ++i) {
        const CageEdge& edge = cage.edges[i];
        Work::OfEdge& e = work.edge[i];
        const Work::OfVertex &from = work.vertex[edge.from], &to = work.vertex[edge.to];
        const double size = edge.length, over = size > 0 ? 1 / size : 0;
        const double tx = over * edge.along[0], ty = over * edge.along[1], tz = over * edge.along[2];
        for (int l = 0; l < lanes; ++l) {
            const bool first = from.r[l] <= to.r[l];
            const double px = first ? from.p[0][l] : to.p[0][l], py = first ? from.p[1][l] : to.p[1][l],
                         pz = first ? from.p[2][l] : to.p[2][l];
            const double s = tx * px + ty * py + tz * pz;
            double qx = px - s * tx, qy = py - s * ty, qz = pz - s * tz;
            const double again = tx * qx + ty * qy + tz * qz;
            qx -= again * tx;
            qy -= again * ty;
            qz -= again * tz;
            const double square = qx * qx + qy * qy + qz * qz;
            const double a = first ? s : s - size, b = first ? s + size : s;
            const double ra = from.r[l], rb = to.r[l], inner = a * b + square, product = ra * rb;
            // (ra + rb)^2 - size^2 = 2 (ra rb + inner); near the edge its digits come from the distance.
            const double opposite = product - inner, sum = ra + rb + size;
            const double difference = inner < 0 ? size * size * square / (opposite > 0 ? opposite : 1) : product + inner;
            near[l] = square <= snap * snap && a <= 0 && b >= 0 ? 1 : near[l];
            e.q[0][l] = qx;
            e.q[1][l] = qy;
            e.q[2][l] = qz;
            e.square[l] = square;
            e.start[l] = a;
            e.end[l] = b;
            e.log[l] = difference > 0 ? logarithm(std::fmax(1, sum * sum / (2 * (difference > 0 ? difference : 1)))) : 0;
        }
    }
    for (std::size_t i = 0; i < work.psi.size(); ++i) {
        const CageFace& face = cage.faces[i];
        const FacePlane& plane = planes[i];
        Work::OfVertex* v[3];
        const Work::OfEdge* e[3];
        double size[3];
        for (std::size_t k = 0; k < 3; ++k) {
            v[k] = &work.vertex[face.corner[k]];
            e[k] = &work.edge[face.edge[k]];
            size[k] = cage.edges[face.edge[k]].length;
        }
        const double nx = plane.unit[0], ny = plane.unit[1], nz = plane.unit[2];
        for (int l = 0; l < lanes; ++l) {
            // The height as the nearest edge sees it.
            const double q0 = e[0]->square[l], q1 = e[1]->square[l], q2 = e[2]->square[l];
            const bool take0 = q0 <= q1 && q0 <= q2, take1 = q1 <= q2;
            const double qx = take0 ? e[0]->q[0][l] : (take1 ? e[1]->q[0][l] : e[2]->q[0][l]);
            const double qy = take0 ? e[0]->q[1][l] : (take1 ? e[1]->q[1][l] : e[2]->q[1][l]);
            const double qz = take0 ? e[0]->q[2][l] : (take1 ? e[1]->q[2][l] : e[2]->q[2][l]);
            const double h = nx * qx + ny * qy + nz * qz, height = std::fabs(h);
            double delta[3], omega = 0, inside = 1;
#pragma GCC unroll 3
            for (int k = 0; k < 3; ++k) {
                const Three& out = plane.out[static_cast<std::size_t>(k)];
                const double d = out[0] * e[k]->q[0][l] + out[1] * e[k]->q[1][l] + out[2] * e[k]->q[2][l];
                // Along the face's own direction: from corner k + 1 to corner k + 2.
                const bool along = face.sign[static_cast<std::size_t>(k)] > 0;
                const double start = along ? e[k]->start[l] : -e[k]->end[l], end = along ? e[k]->end[l] : -e[k]->start[l];
                const double rs = v[(k + 1) % 3]->r[l], re = v[(k + 2) % 3]->r[l], square = e[k]->square[l];
                const double As = square + height * rs, Ae = square + height * re;
                const double y = d * (square * size[k] + height * (end * rs - start * re)), x = As * Ae + d * d * start * end;
                const double turn = angle(std::fabs(y), x);
                omega += y < 0 ? -turn : turn;
                inside = d >= -snap ? inside : 0;
                delta[k] = d;
            }
            near[l] = height <= snap && inside > 0 ? 1 : near[l];
            const double solid = h < 0 ? -omega : omega;
            const double L0 = e[0]->log[l], L1 = e[1]->log[l], L2 = e[2]->log[l];
            const double a0 = plane.across[0], a1 = plane.across[1], a2 = plane.across[2];
            v[0]->phi[l] += plane.over_height[0] * (delta[0] * solid + h * (L0 + a2 * L1 + a1 * L2));
            v[1]->phi[l] += plane.over_height[1] * (delta[1] * solid + h * (a2 * L0 + L1 + a0 * L2));
            v[2]->phi[l] += plane.over_height[2] * (delta[2] * solid + h * (a1 * L0 + a0 * L1 + L2));
            work.psi[i].psi[l] = delta[0] * L0 + delta[1] * L1 + delta[2] * L2 - h * solid;
        }
    }
    for (int l = 0; l < lanes; ++l) work.near[l] = near[l];
}

std::vector<FacePlane> planes_of(const CageArrays& cage) {
    std::vector<FacePlane> planes;
    for (const CageFace& face : cage.faces) {
        FacePlane plane{};
        if (face.double_area > 0) {
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

/// Six times the volume, around the first vertex.
double orientation(const CageArrays& cage) {
    double sum = 0;
    for (const CageFace& face : cage.faces) sum += dot(cage.from(cage.points[0], face.corner[0]), face.normal);
    return sum;
}

}  // namespace

Coordinates green(const Mesh& mesh, const std::vector<Point>& points, const CoordinateOptions& options) {
    const CageArrays cage(mesh);
    if (!(orientation(cage) > 0))
        fail_input("cage", "is inside out or without volume", "turn its faces so that their normals point outward");
    const std::vector<FacePlane> planes = planes_of(cage);
    const double snap = options.snap * cage.diagonal;
    Coordinates result;
    const auto rows = static_cast<Eigen::Index>(points.size());
    result.vertex.resize(rows, static_cast<Eigen::Index>(cage.points.size()));
    result.normal.resize(rows, static_cast<Eigen::Index>(cage.faces.size()));
    std::vector<double> turns(points.size());  // how often the cage goes around the point; NaN on it
    parallel_blocks(points.size(), 64, [&](std::size_t begin, std::size_t end) {
        Work work(cage);
        for (std::size_t first = begin; first < end; first += lanes) {
            const std::size_t count = std::min<std::size_t>(lanes, end - first);
            for (std::size_t l = 0; l < lanes; ++l) {
                const Three x = three(points[first + std::min(l, count - 1)]);
                for (std::size_t k = 0; k < 3; ++k) work.x[k][l] = x[k];
            }
            integrate(cage, planes, snap, work);
            for (std::size_t l = 0; l < count; ++l) {
                const auto row = static_cast<Eigen::Index>(first + l);
                double *phi = result.vertex.row(row).data(), *psi = result.normal.row(row).data(), sum = 0;
                for (std::size_t i = 0; i < work.vertex.size(); ++i) sum += phi[i] = work.vertex[i].phi[l] / (4 * pi);
                for (std::size_t i = 0; i < work.psi.size(); ++i) psi[i] = work.psi[i].psi[l] / (4 * pi * cage.scale);
                turns[first + l] = work.near[l] != 0 ? std::numeric_limits<double>::quiet_NaN() : sum;
            }
        }
    });
    std::string list;
    std::size_t outside = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!(std::fabs(turns[i] - 1) <= 1e-6))
            if (++outside <= 10) list += (list.empty() ? "" : ", ") + std::to_string(i);
    if (outside > 0)
        fail_input("cage",
                   std::to_string(outside) + (outside == 1 ? " point does" : " points do") +
                       " not lie strictly inside, where alone Green coordinates are defined: " + list +
                       (outside > 10 ? " ..." : ""),
                   "widen the cage there, or use mean value coordinates");
    return result;
}

}  // namespace ostraka::coords
