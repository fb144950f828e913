// Mean value coordinates of a triangle mesh (Ju, Schaefer, Warren 2005), in vector form.
//
// Seen from x, a face is a spherical triangle. Its mean vector m is the integral of the direction over the triangle, and equals
// half the sum of angle times unit normal over the planes through x and its edges. Written as W_1 p_1 + W_2 p_2 + W_3 p_3 with
// the vectors p from x to the corners, it gives the weights W. The mean vectors of a closed mesh sum to zero, hence linear
// precision. The contribution of an edge to m is used for both of its faces. W_i = (m . c_i) / det with c_i = p_(i+1) x p_(i+2)
// and det = p_1 . (p_2 x p_3).
#include "coords/cage_arrays.h"
#include "coords/kinds.h"
#include "coords/lanes.h"

#include "ostraka/core/error.h"

namespace ostraka::coords {

namespace {

/// A face is a sliver as seen from x, and gets its weights from `sliver_weights`, if its mean vector is shorter than this share
/// of half its perimeter.
constexpr double sliver = 1.0 / 1024;

/// Intermediate values for eight points; one object per block of points.
struct Work {
    explicit Work(const CageArrays& cage)
        : vertex(cage.points.size()), edge(cage.edges.size()), sliver_lanes(cage.faces.size()) {}
    struct VertexLanes {
        VectorLanes p;  ///< from x to the vertex
        Lanes weight;
    };
    struct EdgeLanes {
        VectorLanes c;               ///< p_from x p_to
        Lanes theta, theta_by_sine;  ///< angle between p_from and p_to; the same divided by the length of c
    };
    std::vector<VertexLanes> vertex;
    std::vector<EdgeLanes> edge;
    std::vector<std::uint8_t> sliver_lanes;  ///< per face: bit l is set if the face is a sliver in lane l
    VectorLanes x;
    Lanes near;  ///< 1 where the point may lie on the cage
};

OSTRAKA_EACH_WIDTH
void sum_weights(const CageArrays& cage, double snap, Work& work) {
    const double snap_squared = snap * snap;
    const double scale = cage.scale;
    Lanes near{};
    for (std::size_t i = 0; i < work.vertex.size(); ++i) {
        Work::VertexLanes& v = work.vertex[i];
        const Vector3 point = cage.points[i];
#pragma GCC ivdep
        for (int l = 0; l < lanes; ++l) {
            const Vector3 p = scale * (point - work.x.at(l));
            near[l] = dot(p, p) <= snap_squared ? 1 : near[l];
            v.p.set(l, p);
            v.weight[l] = 0;
        }
    }
    for (std::size_t i = 0; i < work.edge.size(); ++i) {
        const CageEdge& edge = cage.edges[i];
        Work::EdgeLanes& e = work.edge[i];
        const Work::VertexLanes &from = work.vertex[edge.from], &to = work.vertex[edge.to];
        const Vector3 along = edge.along;
        const double close = snap_squared * edge.length * edge.length;
#pragma GCC ivdep
        for (int l = 0; l < lanes; ++l) {
            const Vector3 p = from.p.at(l), q = to.p.at(l);
            // Computed from the nearer end and the edge vector, which avoids the rounding error of p_from x p_to for a distant
            // end.
            const Vector3 c = cross(select(dot(p, p) <= dot(q, q), p, q), along);
            const double square = dot(c, c), cosine = dot(p, q);
            const double sine = std::sqrt(square), theta = angle(sine, cosine);
            near[l] = square <= close && cosine <= 0 ? 1 : near[l];
            e.c.set(l, c);
            e.theta[l] = theta;
            e.theta_by_sine[l] = sine > 0 ? theta / (sine > 0 ? sine : 1) : 0;
        }
    }
    for (std::size_t i = 0; i < work.sliver_lanes.size(); ++i) {
        const CageFace& face = cage.faces[i];
        const Work::EdgeLanes &e0 = work.edge[face.edge[0]], &e1 = work.edge[face.edge[1]], &e2 = work.edge[face.edge[2]];
        Work::VertexLanes &v0 = work.vertex[face.corner[0]], &v1 = work.vertex[face.corner[1]], &v2 = work.vertex[face.corner[2]];
        const double s0 = face.sign[0], s1 = face.sign[1], s2 = face.sign[2];
        const Vector3 normal = face.normal;
        const double flat = snap * face.double_area;
        std::int64_t slivers[lanes];
#pragma GCC ivdep
        for (int l = 0; l < lanes; ++l) {
            const Vector3 c0 = e0.c.at(l), c1 = e1.c.at(l), c2 = e2.c.at(l);
            const Vector3 m = s0 * e0.theta_by_sine[l] * c0 + s1 * e1.theta_by_sine[l] * c1 + s2 * e2.theta_by_sine[l] * c2;
            const double perimeter = e0.theta[l] + e1.theta[l] + e2.theta[l];
            const double det = dot(v0.p.at(l), normal);
            const bool thin = dot(m, m) <= sliver * sliver * perimeter * perimeter;
            const bool touches = std::fabs(det) <= flat;
            near[l] = touches && !thin ? 1 : near[l];
            slivers[l] = thin ? 1 : 0;
            const double factor = thin || det == 0 ? 0 : 0.5 / (det == 0 ? 1 : det);
            v0.weight[l] += factor * s0 * dot(m, c0);
            v1.weight[l] += factor * s1 * dot(m, c1);
            v2.weight[l] += factor * s2 * dot(m, c2);
        }
        std::int64_t bits = 0;
        for (int l = 0; l < lanes; ++l) bits |= slivers[l] << l;
        work.sliver_lanes[i] = static_cast<std::uint8_t>(bits);
    }
    for (int l = 0; l < lanes; ++l) work.near[l] = near[l];
}

/// The weights of a face whose plane passes close to x while x is off the face: m is almost zero there and loses its digits.
/// W_i = |c_i| N_i / (2 det), N_i = theta_i - theta_(i+1) cos A_(i-1) - theta_(i-1) cos A_(i+1) with the angles A of the
/// spherical triangle. The small difference of its sides comes from sin((b + c - a) / 2) sin((a + b + c) / 2) = sin b sin c
/// cos^2(A / 2), and 1 - |cos A| from sin A = |p| det / (|c| |c|). N vanishes as det^2, and therefore W as det.
Vector3 sliver_weights(const Vector3 (&p)[3], const Vector3 (&c)[3], const Vector3& theta, double det) {
    Vector3 cl, pl;
    for (std::size_t k = 0; k < 3; ++k) cl[k] = length(c[k]), pl[k] = length(p[k]);
    if (!(cl[0] * cl[1] * cl[2] > 0) || det == 0) return {0, 0, 0};
    Vector3 one_minus, one_plus, sine;  // 1 - cos A, 1 + cos A; sines of the sides
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
        const double cosine = -dot(c[i], c[j]) / (cl[i] * cl[j]), s = pl[k] * det / (cl[i] * cl[j]);
        const double small = s * s / (1 + std::fabs(cosine));
        one_minus[k] = cosine >= 0 ? small : 2 - small;
        one_plus[k] = cosine < 0 ? small : 2 - small;
        sine[k] = cl[k] / (pl[i] * pl[j]);
    }
    std::size_t k = 0;
    for (std::size_t i = 1; i < 3; ++i)
        if (theta[i] > theta[k]) k = i;
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const double half = std::sin(0.5 * (theta[0] + theta[1] + theta[2]));
    if (!(half > 0)) return {0, 0, 0};
    const double excess = 2 * std::asin(std::min(1.0, 0.5 * sine[i] * sine[j] * one_plus[k] / half));
    Vector3 N;
    N[k] = -excess + theta[i] * one_minus[j] + theta[j] * one_minus[i];
    N[i] = excess - theta[j] * one_plus[k] + theta[k] * one_minus[j];
    N[j] = excess - theta[i] * one_plus[k] + theta[k] * one_minus[i];
    return {cl[0] * N[0] / (2 * det), cl[1] * N[1] / (2 * det), cl[2] * N[2] / (2 * det)};
}

void add_slivers(const CageArrays& cage, Work& work) {
    for (std::size_t i = 0; i < cage.faces.size(); ++i) {
        if (work.sliver_lanes[i] == 0) continue;
        const CageFace& face = cage.faces[i];
        for (int l = 0; l < lanes; ++l) {
            if ((work.sliver_lanes[i] >> l & 1) == 0) continue;
            Vector3 p[3], c[3], theta;
            for (std::size_t k = 0; k < 3; ++k) {
                const Work::EdgeLanes& edge = work.edge[face.edge[k]];
                p[k] = work.vertex[face.corner[k]].p.at(l);
                c[k] = face.sign[k] * edge.c.at(l);
                theta[k] = edge.theta[l];
            }
            const Vector3 weights = sliver_weights(p, c, theta, dot(p[0], face.normal));
            for (std::size_t k = 0; k < 3; ++k) work.vertex[face.corner[k]].weight[l] += weights[k];
        }
    }
}

/// Fills the weights of a point that lies on the cage: linear on the nearest vertex, else edge, else face.
bool weights_on_cage(const CageArrays& cage, const Vector3& x, double snap, double* row) {
    const auto clear_row = [&] { std::fill(row, row + cage.points.size(), 0.0); };
    double minimum = snap;
    std::size_t best = cage.points.size();
    for (std::size_t i = 0; i < cage.points.size(); ++i) {
        const double d = length(cage.from(x, static_cast<Index>(i)));
        if (d <= minimum && (best == cage.points.size() || d < minimum)) minimum = d, best = i;
    }
    if (best < cage.points.size()) {
        clear_row();
        row[best] = 1;
        return true;
    }
    best = cage.edges.size(), minimum = snap;
    double parameter = 0;
    for (std::size_t i = 0; i < cage.edges.size(); ++i) {
        const CageEdge& edge = cage.edges[i];
        if (!(edge.length > 0)) continue;
        const double t = -dot(cage.from(x, edge.from), edge.along) / (edge.length * edge.length);
        if (!(t >= 0 && t <= 1)) continue;
        const double d = length(cage.from(x, edge.from) + t * edge.along);
        if (d <= minimum && (best == cage.edges.size() || d < minimum)) minimum = d, best = i, parameter = t;
    }
    if (best < cage.edges.size()) {
        clear_row();
        row[cage.edges[best].from] = 1 - parameter;
        row[cage.edges[best].to] = parameter;
        return true;
    }
    best = cage.faces.size(), minimum = snap;
    Vector3 barycentric{};
    for (std::size_t i = 0; i < cage.faces.size(); ++i) {
        const CageFace& face = cage.faces[i];
        if (!(face.double_area > 0)) continue;
        const Vector3 p[3]{cage.from(x, face.corner[0]), cage.from(x, face.corner[1]), cage.from(x, face.corner[2])};
        const double d = std::fabs(dot(p[0], face.normal)) / face.double_area;
        if (!(d <= minimum) || (best < cage.faces.size() && !(d < minimum))) continue;
        Vector3 b;
        for (std::size_t k = 0; k < 3; ++k) b[k] = dot(cross(p[(k + 1) % 3], p[(k + 2) % 3]), face.normal);
        if (!(b[0] >= 0 && b[1] >= 0 && b[2] >= 0)) continue;
        minimum = d, best = i, barycentric = 1 / (b[0] + b[1] + b[2]) * b;
    }
    if (best == cage.faces.size()) return false;
    clear_row();
    for (std::size_t k = 0; k < 3; ++k) row[cage.faces[best].corner[k]] = barycentric[k];
    return true;
}

}  // namespace

Coordinates mean_value(const Mesh& mesh, const std::vector<Point>& points, const CoordinateOptions& options) {
    const CageArrays cage(mesh);
    const double snap = options.snap * cage.diagonal;
    Coordinates result;
    result.vertex.resize(static_cast<Eigen::Index>(points.size()), static_cast<Eigen::Index>(cage.points.size()));
    const auto compute = [&](Work& work) {
        sum_weights(cage, snap, work);
        add_slivers(cage, work);
    };
    for_each_point<Work>(cage, points, compute, [&](const Work& work, std::size_t l, std::size_t point) {
        double* row = result.vertex.row(static_cast<Eigen::Index>(point)).data();
        if (work.near[l] != 0 && weights_on_cage(cage, vector3(points[point]), snap, row)) return;
        double sum = 0;
        for (const Work::VertexLanes& v : work.vertex) sum += v.weight[l];
        if (!(std::fabs(sum) > 0) || !std::isfinite(sum))
            fail_input("point " + std::to_string(point),
                       "has no mean value coordinates in this cage: the sum of its weights is zero or not finite",
                       "move the point closer to the cage, or give a cage that encloses a volume");
        for (std::size_t i = 0; i < work.vertex.size(); ++i) row[i] = work.vertex[i].weight[l] / sum;
    });
    return result;
}

}  // namespace ostraka::coords
