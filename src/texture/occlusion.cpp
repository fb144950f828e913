#include "texture/occlusion.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/mesh/limits.h"

#include <cmath>
#include <string>

namespace ostraka::texture {

namespace {

constexpr double start_above = 1e-4;  ///< height above the surface at which rays start, in half diagonals

/// The bits of a number in reverse order, as a fraction (van der Corput 1935).
double reversed_fraction(std::uint32_t bits) {
    double result = 0, place = 0.5;
    for (; bits != 0; bits >>= 1U, place /= 2)
        if ((bits & 1U) != 0) result += place;
    return result;
}

/// An angle that follows from a number without pattern (the finaliser of MurmurHash3).
double scattered_angle(std::uint64_t seed) {
    seed ^= seed >> 33U;
    seed *= 0xff51afd7ed558ccdULL;
    seed ^= seed >> 33U;
    seed *= 0xc4ceb9fe1a85ec53ULL;
    seed ^= seed >> 33U;
    return 2 * pi * static_cast<double>(seed >> 11U) * 0x1p-53;
}

}  // namespace

Occlusion::Occlusion(const Mesh& mesh, int rays, double distance, Weighting weighting)
    : device_(nullptr, &rtcReleaseDevice), scene_(nullptr, &rtcReleaseScene) {
    // Hammersley's points on the disc: projected onto the hemisphere their density is proportional to the cosine (Malley); points
    // whose heights are evenly spread have an even density (Archimedes).
    for (int i = 0; i < rays; ++i) {
        const double share = (i + 0.5) / rays;
        const double radius = std::sqrt(weighting == Weighting::cosine ? share : 1 - share * share);
        directions_.push_back({radius, 2 * pi * reversed_fraction(static_cast<std::uint32_t>(i))});
    }
    const CGAL::Bbox_3 box = bounding_box(mesh);
    middle_ = {box.xmin() / 2 + box.xmax() / 2, box.ymin() / 2 + box.ymax() / 2, box.zmin() / 2 + box.zmax() / 2};
    const double diagonal = box_diagonal(mesh);
    if (diagonal > 0) unit_length_ = diagonal / 2;
    length_ = static_cast<float>(2 * distance);
    points_.resize(mesh.number_of_vertices() + 1);
    for (const Vertex vertex : mesh.vertices()) {
        const Vector local = (mesh.point(vertex) - middle_) / unit_length_;
        points_[vertex] = {static_cast<float>(local.x()), static_cast<float>(local.y()), static_cast<float>(local.z())};
    }
    triangles_ = to_soup(mesh).triangles;
    device_.reset(rtcNewDevice(("threads=" + std::to_string(threads())).c_str()));
    if (!device_) throw Error(ErrorKind::failure, "occlusion", "the ray tracer cannot be started");
    scene_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, points_.data(), 0,
                               sizeof(std::array<float, 3>), points_.size() - 1);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles_.data(), 0,
                               sizeof(std::array<Index, 3>), triangles_.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_.get());
}

float Occlusion::open_share(const Point& point, const Vector& normal, const Vector& up, std::uint64_t seed) const {
    const Vector axis = unit_vector(up);
    const Vector other = std::abs(axis.x()) < 0.6 ? Vector(1, 0, 0) : Vector(0, 1, 0);
    const Vector first = unit_vector(CGAL::cross_product(other, axis)), second = CGAL::cross_product(axis, first);
    const Vector start = (point - middle_) / unit_length_ + start_above * unit_vector(normal);
    const double turn = scattered_angle(seed);
    int open = 0;
    for (const auto& [radius, angle] : directions_) {
        const double height = std::sqrt(std::max(0.0, 1 - radius * radius));
        const Vector direction =
            radius * std::cos(angle + turn) * first + radius * std::sin(angle + turn) * second + height * axis;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRay ray{};
        ray.org_x = static_cast<float>(start.x()), ray.org_y = static_cast<float>(start.y());
        ray.org_z = static_cast<float>(start.z());
        ray.dir_x = static_cast<float>(direction.x()), ray.dir_y = static_cast<float>(direction.y());
        ray.dir_z = static_cast<float>(direction.z());
        ray.tfar = length_;
        ray.mask = 0xFFFFFFFFU;
        rtcOccluded1(scene_.get(), &context, &ray);
        if (ray.tfar >= 0) ++open;
    }
    return static_cast<float>(open) / static_cast<float>(directions_.size());
}

}  // namespace ostraka::texture
