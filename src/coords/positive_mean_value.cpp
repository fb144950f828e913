// Positive mean value coordinates (Lipman, Kopf, Cohen-Or and Levin 2007): only the part of the cage visible from a point has a
// weight.
#include "coords/interior_weights.h"
#include "coords/kinds.h"

#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace ostraka::coords {

namespace {

constexpr int rays = 1024;

/// Evenly distributed directions on the sphere: a golden-angle spiral.
std::vector<Vector3d> spread_directions() {
    std::vector<Vector3d> directions;
    const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
    for (int i = 0; i < rays; ++i) {
        const double z = 1 - (2 * i + 1) / static_cast<double>(rays), r = std::sqrt(1 - z * z), angle = golden * i;
        directions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
    return directions;
}

/// A face of the cage, prepared for ray intersection.
struct RayFace {
    Vector3d a, u, v;
    std::array<Index, 3> corner{};
};

/// The weights of one node from the first hit of each ray.
void add_visible_weights(const std::vector<RayFace>& faces, const std::vector<Vector3d>& directions, const Vector3d& place,
                         double* row, std::size_t size) {
    for (const Vector3d& d : directions) {
        double nearest = std::numeric_limits<double>::infinity(), s = 0, t = 0;
        const RayFace* hit = nullptr;
        for (const RayFace& face : faces) {
            // Ray-triangle intersection by Moeller and Trumbore, 1997.
            const Vector3d p = d.cross(face.v);
            const double det = face.u.dot(p);
            if (det == 0) continue;
            const Vector3d offset = place - face.a;
            const double x = offset.dot(p) / det;
            if (x < 0 || x > 1) continue;
            const Vector3d q = offset.cross(face.u);
            const double y = d.dot(q) / det;
            if (y < 0 || x + y > 1) continue;
            const double distance = face.v.dot(q) / det;
            if (distance > 0 && distance < nearest) nearest = distance, hit = &face, s = x, t = y;
        }
        if (hit == nullptr) continue;
        row[hit->corner[0]] += (1 - s - t) / nearest;
        row[hit->corner[1]] += s / nearest;
        row[hit->corner[2]] += t / nearest;
    }
    double sum = 0;
    for (std::size_t j = 0; j < size; ++j) sum += row[j];
    if (sum > 0)
        for (std::size_t j = 0; j < size; ++j) row[j] /= sum;
}

WeightMatrix visible_weights(const CageInterior& inside, const UnitCage& cage) {
    WeightMatrix weights = weights_on_cage(inside, cage);
    const std::vector<Vector3d> directions = spread_directions();
    std::vector<RayFace> faces;
    for (const Face f : cage.mesh.faces()) {
        const auto c = corners(cage.mesh, f);
        const Vector3d a = cage.corners[c[0]], u = cage.corners[c[1]] - a, v = cage.corners[c[2]] - a;
        if (u.cross(v).norm() > 0) faces.push_back({a, u, v, {c[0], c[1], c[2]}});
    }
    Progress progress("visibility from the nodes", inside.nodes().size());
    parallel_for(inside.nodes().size(), 16, [&](std::size_t v) {
        progress.advance();
        if (!inside.is_within(static_cast<Index>(v))) return;
        add_visible_weights(faces, directions, inside.nodes()[v], weights.row(static_cast<Eigen::Index>(v)).data(),
                            cage.corners.size());
    });
    return weights;
}

}  // namespace

Coordinates positive_mean_value(const Mesh& mesh, const std::vector<Point>& points, const CoordinateOptions& options) {
    return interior_coordinates("positive-mean-value", mesh, points, options, visible_weights);
}

}  // namespace ostraka::coords
