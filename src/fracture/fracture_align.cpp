#include "fracture/fracture_align.h"

#include "ostraka/geom/eigen.h"
#include "ostraka/geom/plane_motion.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

FractureTrees::FractureTrees(Mesh mesh, const FractureSide& side)
    : mesh_(std::move(mesh)),
      side_(side),
      fracture_(points_of(side.fracture.places)),
      frames_(places_of(side.frames)),
      surface_(mesh_.number_of_faces() > 0 ? std::make_unique<SurfaceSearch>(mesh_) : nullptr) {}

template <class Visit>
void FractureAligner::for_each_continued(const Motion& pose, double search_radius, Visit&& visit) const {
    for (const RimFrame& frame : b_.frames) {
        const Vector3d p = pose(frame.place);
        const PointTree::Near near = frames_.nearest(point_of(p), 1.5 * search_radius);
        if (near.index == no_index) continue;
        const RimFrame& other = a_.frames[near.index];
        if (other.facet != frame.facet || other.side.dot(pose.rotation * frame.side) < continued ||
            other.fracture.dot(pose.rotation * frame.fracture) > -min_facing)
            continue;
        visit(p, other, near.squared);
    }
}

Motion FractureAligner::align(const Motion& start, std::size_t samples, int steps, double anchor_weight) const {
    Motion pose = start;
    const std::size_t count = std::min(samples, b_.fracture.places.size());
    for (int step = 0; step < steps; ++step) {
        // The last third of the steps uses the last search radius.
        const double share = std::min(1.0, 1.5 * step / std::max(1, steps - 1));
        const double search_radius = search_radius_ * std::pow(last_search_radius_ / search_radius_, share);
        std::vector<PlanePoint> planes;
        double fracture_weight = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t k = (2 * i + 1) * b_.fracture.places.size() / (2 * count);
            const Vector3d p = pose(b_.fracture.places[k]), n = pose.rotation * b_.fracture.normals[k];
            const PointTree::Near near = fracture_.nearest(point_of(p), search_radius);
            if (near.index == no_index) continue;
            const Vector3d& normal = a_.fracture.normals[near.index];
            const double facing = -normal.dot(n);
            if (facing < min_facing) continue;
            const double distance = normal.dot(a_.fracture.places[near.index] - p),
                         ratio = near.squared / (search_radius * search_radius);
            planes.push_back({p, normal, distance, (1 - ratio) * (1 - ratio)});
            fracture_weight += planes.back().weight;
        }
        std::vector<PlanePoint> rims;
        double rim = 0;
        for_each_continued(pose, search_radius, [&](const Vector3d& p, const RimFrame& other, double squared) {
            const double weight = std::pow(1 - squared / (2.25 * search_radius * search_radius), 2);
            rims.push_back({p, other.side, other.side.dot(other.place - p), weight});
            rims.push_back({p, other.fracture, other.fracture.dot(other.place - p), weight});
            rim += weight;
        });
        if (planes.size() + rims.size() < 6) break;
        const double per_rim = rim > 0 ? edges_ * (fracture_weight > 0 ? fracture_weight : 1) / rim * 0.5 : 0;
        for (PlanePoint& plane : rims) {
            plane.weight *= per_rim;
            planes.push_back(plane);
        }
        double total = 0;
        for (const PlanePoint& plane : planes) total += plane.weight;
        const std::size_t anchor_count = anchor_weight > 0 ? std::min<std::size_t>(200, b_.intact.places.size()) : 0;
        for (std::size_t i = 0; i < anchor_count; ++i) {
            const std::size_t k = (2 * i + 1) * b_.intact.places.size() / (2 * anchor_count);
            const Vector3d p = pose(b_.intact.places[k]), normal = start.rotation * b_.intact.normals[k];
            planes.push_back({p, normal, normal.dot(start(b_.intact.places[k]) - p),
                              anchor_weight * total / static_cast<double>(anchor_count)});
        }
        const StepLength moved = step_onto_planes(planes, pose);
        if (!moved || (share >= 1 && *moved < 1e-7)) break;
    }
    return pose;
}

PairCandidate FractureAligner::judge(const Motion& pose, std::size_t samples, double close) const {
    PairCandidate result;
    result.pose = pose;
    const double smaller = std::min(a_.fracture.area, b_.fracture.area), shorter = std::min(a_.rim_length, b_.rim_length);
    const auto for_each_sample = [&](const SurfaceSamples& from, auto&& visit) {
        const std::size_t count = std::min(samples, from.places.size());
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t k = (2 * i + 1) * from.places.size() / (2 * count);
            visit(pose(from.places[k]), Vector3d(pose.rotation * from.normals[k]), from.area / static_cast<double>(count));
        }
    };
    double touching = 0, squared_sum = 0, inside = 0;
    const auto penetrates = [&](const Vector3d& p, double area) {
        if (!surface_) return;
        const SurfaceHit hit = surface_->closest(point_of(p));
        if (hit.face == no_index || hit.distance < last_search_radius_) return;
        if (eigen(surface_->normal(hit.face)).dot(p - eigen(hit.point)) > -0.3 * hit.distance || !surface_->inside(point_of(p)))
            return;
        inside += area;
        result.depth = std::max(result.depth, hit.distance);
    };
    for_each_sample(b_.fracture, [&](const Vector3d& p, const Vector3d& n, double area) {
        const PointTree::Near near = fracture_.nearest(point_of(p), last_search_radius_);
        if (near.index != no_index) {
            const double facing = -a_.fracture.normals[near.index].dot(n);
            if (facing > min_facing) {
                const double offset = a_.fracture.normals[near.index].dot(p - a_.fracture.places[near.index]),
                             ratio = offset / (close * last_search_radius_);
                touching += area * std::exp(-ratio * ratio / 2);
                squared_sum += area * offset * offset;
                result.contact += area;
            }
        }
        penetrates(p, area);
    });
    for_each_sample(b_.intact, [&](const Vector3d& p, const Vector3d&, double area) { penetrates(p, area); });
    result.residual = result.contact > 0 ? std::sqrt(squared_sum / result.contact) : 0;
    double rim = 0;
    for_each_continued(pose, last_search_radius_, [&](const Vector3d& p, const RimFrame& other, double) {
        // Only the offset across the side's plane counts, not along the rim.
        const double step = other.side.dot(p - other.place) / last_search_radius_;
        rim += std::max(0.0, 1 - step * step);
    });
    result.rim = rim / static_cast<double>(b_.frames.size()) * b_.rim_length / shorter;
    result.contact /= smaller;
    result.penetration = inside / smaller;
    result.score = touching / smaller + result.rim - result.penetration;
    return result;
}

}  // namespace ostraka
