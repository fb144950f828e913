#include "transfer/place_mapping.h"

#include "ostraka/geom/distance.h"
#include "ostraka/mesh/limits.h"

#include <Eigen/Dense>

#include <algorithm>

namespace ostraka {

namespace {

/// Solves x(b) + d n(b) = p for the weights b of corners 1 and 2 of a face and the distance d by Newton's method, starting from
/// the centroid and `first_distance`; nullopt if it does not converge.
std::optional<Eigen::Vector3d> meet_along_normals(const Mesh& mesh, Index face, const Point& p, double first_distance) {
    const auto corner = corners(mesh, Face(face));
    std::array<Eigen::Vector3d, 3> x, n;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vector at = mesh.point(corner[k]) - p, up = vertex_normal(mesh, corner[k]);
        x[k] = {at.x(), at.y(), at.z()};
        n[k] = {up.x(), up.y(), up.z()};
    }
    Eigen::Vector3d unknown(1.0 / 3, 1.0 / 3, first_distance);
    const double size = std::max((x[1] - x[0]).norm(), (x[2] - x[0]).norm());
    // Where normals nearly intersect, the root is double and convergence is only linear (factor 1/2).
    for (int round = 0; round < 60; ++round) {
        const double u = unknown[0], v = unknown[1], w = unknown[2];
        const Eigen::Vector3d up = (1 - u - v) * n[0] + u * n[1] + v * n[2];
        const Eigen::Vector3d off = (1 - u - v) * x[0] + u * x[1] + v * x[2] + w * up;
        Eigen::Matrix3d slopes;
        slopes << x[1] - x[0] + w * (n[1] - n[0]), x[2] - x[0] + w * (n[2] - n[0]), up;
        if (!(std::abs(slopes.determinant()) > 1e-12 * size * size)) return std::nullopt;
        const Eigen::Vector3d change = slopes.partialPivLu().solve(-off);
        unknown += change;
        if (!(std::abs(unknown[0]) + std::abs(unknown[1]) + std::abs(unknown[2]) / size < 1e6)) return std::nullopt;
        if (std::abs(change[0]) + std::abs(change[1]) < 1e-14 && std::abs(change[2]) <= 1e-14 * size) return unknown;
        // Accepts a solution whose last digits keep changing because of rounding.
        if (round > 20 && off.norm() <= 1e-11 * size) return unknown;
    }
    return std::nullopt;
}

}  // namespace

Vector smooth_normal(const Mesh& mesh, const SurfacePoint& p) {
    return interpolate(mesh, p, [&](Vertex v) { return vertex_normal(mesh, v); });
}

PlaceMapping::PlaceMapping(const Mesh& source, const SurfaceSearch& target, const CorrespondenceOptions& options)
    : source_(source),
      search_(target),
      target_(target.mesh()),
      edge_(target.typical_edge()),
      far_(options.max_distance * target.diagonal()),
      min_cosine_(options.min_cosine()) {
    if (edge_ > (1 + 1e-9) * typical_edge(surface_area(source), source.number_of_faces())) on_source_.emplace(source_);
}

MappedPlace PlaceMapping::operator()(const SurfacePoint& place) const {
    MappedPlace result;
    result.from = place;
    result.start = position(source_, place);
    result.normal = unit_vector(smooth_normal(source_, place));
    const Point& p = result.start;
    const auto take = [&](CorrespondenceKind kind, Index face, const std::array<double, 3>& weights) {
        result.kind = kind;
        result.to = surface_point(target_, face, on_longest_edge(face, weights));
        result.end = position(target_, result.to);
        result.up = unit_vector(smooth_normal(target_, result.to));
    };
    if (result.normal.squared_length() > 0) {
        if (on_source_) {
            if (const auto hit = along_target_normal(p, result.normal)) {
                take(CorrespondenceKind::ray, hit->face, hit->barycentric);
                result.mutual = is_mutual(result);
                return result;
            }
        } else {
            for (const double length : {std::min(far_, 2 * edge_), far_})
                for (const SurfaceHit& hit : search_.line_hits(p, result.normal, length))
                    if (search_.normal(hit.face) * result.normal >= min_cosine_) {
                        take(CorrespondenceKind::ray, hit.face, hit.barycentric);
                        result.mutual = true;
                        return result;
                    }
        }
    }
    const bool oriented = result.normal.squared_length() > 0;
    if (const auto hit = search_.closest_compatible(p, result.normal, oriented ? min_cosine_ : -1, far_))
        take(CorrespondenceKind::closest, hit->face, hit->barycentric);
    return result;
}

/// Moves a place in a nearly degenerate face, whose interior cannot be cut, to the longest edge of the face.
std::array<double, 3> PlaceMapping::on_longest_edge(Index face, std::array<double, 3> weights) const {
    const auto corner = corners(target_, Face(face));
    std::size_t apex = 0;
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k)
        if (const double length = distance(target_.point(corner[(k + 1) % 3]), target_.point(corner[(k + 2) % 3]));
            length > longest)
            longest = length, apex = k;
    if (weights[apex] == 1 || 2 * face_area(target_, Face(face)) > 1e-6 * longest * longest) return weights;
    const double rest = 1 - weights[apex];
    for (std::size_t k = 0; k < 3; ++k) weights[k] = k == apex ? 0 : weights[k] / rest;
    return weights;
}

/// Whether the line along the normal of the (coarser) target first meets the source at this place. A place in a fold of the
/// source that the line meets only after another part of the surface has no inverse image.
bool PlaceMapping::is_mutual(const MappedPlace& mapped) const {
    const std::vector<Face> around = faces_of(source_, mapped.from);
    const auto faces_up = [&](Index f) { return on_source_->normal(f) * mapped.up >= min_cosine_; };
    // At the edge of a fold, the line may miss the surface.
    if (!std::all_of(around.begin(), around.end(), faces_up)) return false;
    const double at = std::abs((mapped.start - mapped.end) * mapped.up), tolerance = 1e-4 * edge_;
    for (const SurfaceHit& hit : on_source_->line_hits(mapped.end, mapped.up, at))
        if (std::abs(hit.distance) < at - tolerance && faces_up(hit.face)) return false;
    return true;
}

/// The place of the target whose interpolated normal passes through p; the search starts at the nearest place and crosses edges
/// as the weights indicate.
std::optional<SurfaceHit> PlaceMapping::along_target_normal(const Point& p, const Vector& normal) const {
    const auto start = search_.closest_compatible(p, normal, min_cosine_, far_);
    if (!start) return std::nullopt;
    Index face = start->face, came_from = no_index;
    double d = start->distance * ((p - start->point) * search_.normal(face) < 0 ? -1 : 1);
    for (int step = 0; step < 24; ++step) {
        const auto found = meet_along_normals(target_, face, p, d);
        if (!found) return std::nullopt;
        const std::array<double, 3> weights{1 - (*found)[0] - (*found)[1], (*found)[0], (*found)[1]};
        const auto lowest = static_cast<std::size_t>(std::min_element(weights.begin(), weights.end()) - weights.begin());
        const auto corner = corners(target_, Face(face));
        const Halfedge beyond = target_.opposite(find_halfedge(target_, corner[(lowest + 1) % 3], corner[(lowest + 2) % 3]));
        const bool returns = !target_.is_border(beyond) && static_cast<Index>(target_.face(beyond)) == came_from;
        if (weights[lowest] >= -1e-9 || returns) return weights[lowest] < -1e-3 ? std::nullopt : hit_in(face, weights, p, normal);
        if (target_.is_border(beyond)) return std::nullopt;
        came_from = face;
        face = target_.face(beyond);
        d = (*found)[2];
    }
    return std::nullopt;
}

/// The place of a face with these weights, clamped to be non-negative; nullopt if it is too far away or its normal is
/// incompatible.
std::optional<SurfaceHit> PlaceMapping::hit_in(Index face, const std::array<double, 3>& weights, const Point& p,
                                               const Vector& normal) const {
    SurfaceHit hit;
    hit.face = face;
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += hit.barycentric[k] = std::max(0.0, weights[k]);
    for (double& weight : hit.barycentric) weight /= sum;
    hit.point = point_at(target_, face, hit.barycentric);
    hit.distance = distance(hit.point, p);
    if (hit.distance > far_ || search_.normal(face) * normal < min_cosine_) return std::nullopt;
    return hit;
}

}  // namespace ostraka
