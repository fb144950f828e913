#include "ostraka/registration/part_alignment.h"
#include "ostraka/core/angles.h"

#include "registration/trimmed_registration.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "registration/surface_points.h"

#include <fmt/core.h>

#include <cmath>
#include <optional>

namespace ostraka {

namespace {

struct Sample {
    Vector3d place, normal;
};

/// Centroids of faces, each representing the same area.
std::vector<Sample> samples_of(const Mesh& part, const std::vector<bool>& of_part, int count) {
    const double area = marked_area(part, of_part);
    if (!(area > 0)) fail_input("fragment", "has no area that could be registered to a template", "check its faces and facets");
    std::vector<Sample> samples;
    double sum = 0, next = 0.5 * area / count;
    for (const Face face : part.faces()) {
        if (!of_part.empty() && !of_part[face]) continue;
        sum += face_area(part, face);
        if (next >= sum || samples.size() >= static_cast<std::size_t>(count)) continue;
        samples.push_back({eigen(centroid(part, face)), eigen(area_vector(part, face)).normalized()});
        while (next < sum) next += area / count;
    }
    return samples;
}

class PartAligner {
public:
    PartAligner(std::vector<Sample> samples, const SurfaceSearch& whole, const std::vector<Anchor>& anchors,
                const PartAlignmentOptions& options)
        : samples_(std::move(samples)), whole_(whole), anchors_(anchors), options_(options) {}

    PartAlignment run(const Motion& start) {
        const detail::Registration registration = detail::register_from(
            start, options_.iterations, 1e-4, pairs_, [&](const Motion& pose) { return measure(pose); },
            [&](const Motion& pose) { return step(pose); });
        return {registration.pose, registration.fit.residual, registration.fit.overlap, registration.iterations,
                registration.converged};
    }

private:
    /// Trimmed pairs under a pose; the objective includes anchors and samples without a partner.
    detail::PoseFit measure(const Motion& pose) {
        std::vector<std::optional<detail::PlanePair>> partners(samples_.size());
        const double search_radius = options_.search_radius * whole_.diagonal(), cosine = std::cos(options_.angle * pi / 180);
        parallel_for(samples_.size(), [&](std::size_t i) {
            const Vector3d p = pose(samples_[i].place), n = pose.rotation * samples_[i].normal;
            const auto hit = whole_.closest_compatible(point_of(p), vector_of(n), cosine, search_radius);
            if (hit)
                partners[i] =
                    detail::PlanePair{p, eigen(hit->point), eigen(whole_.normal(hit->face)), hit->distance * hit->distance};
        });
        pairs_.pairs.clear();
        for (const auto& pair : partners)
            if (pair) pairs_.pairs.push_back(*pair);
        detail::PoseFit fit;
        fit.overlap = static_cast<double>(pairs_.pairs.size()) / static_cast<double>(samples_.size());
        const std::size_t kept_count = pairs_.trim(options_.trim, samples_.size()), pair_count = pairs_.pairs.size();
        double sum = pairs_.squares();
        fit.residual = pair_count == 0 ? search_radius : std::sqrt(sum / static_cast<double>(pair_count));
        // A sample without a partner counts with the search radius, so that a pose with few pairs does not score better.
        sum += static_cast<double>(kept_count - pair_count) * search_radius * search_radius;
        weight_ =
            anchors_.empty() ? 0 : options_.anchors * static_cast<double>(kept_count) / static_cast<double>(anchors_.size());
        for (const Anchor& anchor : anchors_) sum += weight_ * (pose(anchor.of_part) - anchor.of_whole).squaredNorm();
        fit.minimised = sum;
        return fit;
    }

    /// Rotation by w and translation by t about the centre of the pairs, linearised.
    [[nodiscard]] Motion step(const Motion& pose) const {
        PlaneMotion planes = pairs_.planes(whole_.diagonal());
        for (const Anchor& anchor : anchors_) {
            const Vector3d p = pose(anchor.of_part);
            for (int axis = 0; axis < 3; ++axis) planes.add(p, Vector3d::Unit(axis), anchor.of_whole[axis] - p[axis], weight_);
        }
        return planes.motion(planes.solve(1e-9)).after(pose);
    }

    std::vector<Sample> samples_;
    const SurfaceSearch& whole_;
    const std::vector<Anchor>& anchors_;
    const PartAlignmentOptions& options_;
    detail::PlanePairs pairs_;
    double weight_ = 0;
};

}  // namespace

PartAlignment align_part(const Mesh& part, const std::vector<bool>& of_part, const SurfaceSearch& whole, const Motion& start,
                         const std::vector<Anchor>& anchors, const PartAlignmentOptions& options) {
    check_options(options, "registration");
    if (!of_part.empty() && of_part.size() != part.number_of_faces())
        fail_usage(fmt::format("there are {} marks for {} faces", of_part.size(), part.number_of_faces()));
    return PartAligner(samples_of(part, of_part, options.samples), whole, anchors, options).run(start);
}

void PartAlignmentOptions::declare_options(OptionList& list) {
    list("icp-trim", trim, "share of the point pairs, closest first, that a registration uses (trimming)", Range{0.1, 1});
    list("icp-reach", search_radius, "maximum distance of two points paired in the registration", Range{0, 10},
         "share of the whole's diagonal");
    list("icp-angle", angle, "maximum angle between the normals of two points paired in the registration", Range{1, 180},
         "degrees");
    list("icp-landmarks", anchors, "registration: weight of all landmarks together, relative to the surface", Range{0, 1e9});
    list("icp-samples", samples, "number of points of a fragment that are registered onto the template", Range{10, 1e7});
    list("icp-iterations", iterations, "maximum number of iterations of a registration", Range{0, 10000});
}

}  // namespace ostraka
