// Ambient occlusion by rays.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <embree3/rtcore.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace ostraka::texture {

/// Computes the ambient occlusion of a surface at points on it. Queries may run in parallel.
class Occlusion {
public:
    /// How directions over the hemisphere are weighted: by the cosine of the angle to its axis, or all alike.
    enum class Weighting { cosine, uniform };
    /// `distance`: length of the rays, as a fraction of the box diagonal.
    Occlusion(const Mesh& mesh, int rays, double distance, Weighting weighting = Weighting::cosine);
    Occlusion(const Occlusion&) = delete;
    Occlusion& operator=(const Occlusion&) = delete;

    /// Share of the rays from a point of the surface that meet no surface: directions over the hemisphere around the normal,
    /// in a pattern turned by an angle that follows from `seed`.
    [[nodiscard]] float open_share(const Point& point, const Vector& normal, std::uint64_t seed) const {
        return open_share(point, normal, normal, seed);
    }
    /// Likewise over the hemisphere around `axis`; the rays start above the surface along the normal.
    [[nodiscard]] float open_share(const Point& point, const Vector& normal, const Vector& axis, std::uint64_t seed) const;

private:
    Point middle_{0, 0, 0};
    double unit_length_ = 1;
    float length_ = 0;
    std::vector<std::array<double, 2>> directions_;  ///< radius and angle in the plane of the hemisphere
    std::vector<std::array<float, 3>> points_;
    std::vector<std::array<Index, 3>> triangles_;
    std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device_;
    std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)> scene_;
};

}  // namespace ostraka::texture
