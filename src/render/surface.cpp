#include "render/surface.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"

#include <embree3/rtcore.h>
#include <fmt/core.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka::detail {

namespace {
constexpr Index largest_fan = 64;  ///< corners of more faces are shaded flat: their faces are slivers

void check(const Scene& scene) {
    const auto& mesh = scene.mesh;
    const std::string where = scene.title.empty() ? "picture" : scene.title;
    if (mesh.points.size() >= no_index || mesh.triangles.size() >= no_index)
        fail_input(where, "has too many elements for a picture", "simplify the mesh");
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
        for (const double c : mesh.points[i])
            if (!std::isfinite(c))
                fail_input(fmt::format("{}, vertex {}", where, i), "has a coordinate that is not finite",
                           "give finite coordinates");
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (const Index v : mesh.triangles[t])
            if (v >= mesh.points.size())
                fail_input(fmt::format("{}, triangle {}", where, t),
                           fmt::format("refers to vertex {}, but there are {} vertices, counted from 0", v, mesh.points.size()),
                           "correct the triangle");
    const auto length = [&](const char* name, std::size_t count, std::size_t expected, const char* element) {
        if (count != 0 && count != expected)
            fail_input(where, fmt::format("has {} {} for {} {}", count, name, expected, element),
                       "give one value for each element");
    };
    length("values", scene.vertex_values.size(), mesh.points.size(), "vertices");
    length("values", scene.face_values.size(), mesh.triangles.size(), "faces");
    length("colours", scene.vertex_colours.size(), mesh.points.size(), "vertices");
    length("colours", scene.face_colours.size(), mesh.triangles.size(), "faces");
    length("materials", scene.face_materials.size(), mesh.triangles.size(), "faces");
    length("texture coordinates", scene.corner_texture.size(), 3 * mesh.triangles.size(), "corners");
    const std::size_t materials = scene.texture ? scene.texture->materials().size() : 0;
    for (const Index material : scene.face_materials)
        if (material != no_index && material >= materials && scene.texture)
            fail_input(where, fmt::format("a face has material {}, but there are {} materials", material, materials),
                       "use materials of the texture");
    for (const ScenePatch& patch : scene.patches)
        if (patch.triangle >= mesh.triangles.size())
            fail_input(where, "assigns a colour to a triangle that does not exist", "use triangles of the mesh");
    for (const SceneLabel& label : scene.labels)
        for (const Index face : label.faces)
            if (face >= mesh.triangles.size())
                fail_input(where, "labels a triangle that does not exist", "use triangles of the mesh");
}

/// Keeps the nearest hit; ties: the smallest index. The ray extends slightly beyond the nearest hit, so that no equal hit is
/// pruned, for any tree.
struct Nearest {
    RTCIntersectContext context;
    float distance = std::numeric_limits<float>::infinity();
    unsigned triangle = RTC_INVALID_GEOMETRY_ID;
};

void keep_nearest(const RTCFilterFunctionNArguments* arguments) {
    auto* nearest = reinterpret_cast<Nearest*>(arguments->context);
    auto* ray = reinterpret_cast<RTCRay*>(arguments->ray);
    const auto* hit = reinterpret_cast<const RTCHit*>(arguments->hit);
    if (ray->tfar < nearest->distance || (ray->tfar == nearest->distance && hit->primID < nearest->triangle)) {
        nearest->distance = ray->tfar;
        nearest->triangle = hit->primID;
    }
    ray->tfar = nearest->distance * (1 + 0x1p-18F);
}

void set_ray(RTCRay& ray, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double from, double to) {
    ray.org_x = static_cast<float>(origin.x());
    ray.org_y = static_cast<float>(origin.y());
    ray.org_z = static_cast<float>(origin.z());
    ray.dir_x = static_cast<float>(direction.x());
    ray.dir_y = static_cast<float>(direction.y());
    ray.dir_z = static_cast<float>(direction.z());
    ray.tnear = static_cast<float>(from);
    ray.tfar = static_cast<float>(to);
    ray.time = 0;
    ray.mask = 0xFFFFFFFFU;
    ray.id = 0;
    ray.flags = 0;
}
}  // namespace

Surface::Surface(const Scene& scene, bool smooth)
    : triangles_(scene.mesh.triangles), device_(nullptr, &rtcReleaseDevice), tree_(nullptr, &rtcReleaseScene) {
    check(scene);
    measure_box(scene);
    points_.resize(scene.mesh.points.size() + 2, Eigen::Vector3f::Zero());
    parallel_for(scene.mesh.points.size(), 8192,
                 [&](std::size_t i) { points_[i] = to_local(scene.mesh.points[i]).cast<float>(); });
    areas_.resize(triangles_.size());
    parallel_for(triangles_.size(), 8192, [&](std::size_t t) {
        const auto& [a, b, c] = triangles_[t];
        areas_[t] = (points_[b] - points_[a]).cross(points_[c] - points_[a]);
    });
    if (smooth) gather_faces_around_points();
    build_tree();
}

Surface::~Surface() = default;

void Surface::measure_box(const Scene& scene) {
    const auto& points = scene.mesh.points;
    std::vector<bool> used(points.size(), triangles_.empty());
    for (const auto& corners : triangles_)
        for (const Index v : corners) used[v] = true;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::array<double, 3> low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
    const auto enclose = [&](const std::array<double, 3>& point) {
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], point[k]);
            high[k] = std::max(high[k], point[k]);
        }
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!used[i]) continue;
        used_.push_back(static_cast<Index>(i));
        enclose(points[i]);
    }
    if (used_.empty()) return;
    double half = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        middle_[k] = low[k] / 2 + high[k] / 2;
        half = std::max(half, high[k] / 2 - low[k] / 2);
    }
    if (half > 0) unit_length_ = half;
}

Eigen::Vector3d Surface::to_local(const std::array<double, 3>& point) const {
    return {(point[0] - middle_[0]) / unit_length_, (point[1] - middle_[1]) / unit_length_,
            (point[2] - middle_[2]) / unit_length_};
}

void Surface::build_tree() {
    const std::string configuration = "threads=" + std::to_string(threads());
    device_.reset(rtcNewDevice(configuration.c_str()));
    if (!device_) throw Error(ErrorKind::failure, "picture", "the ray tracer cannot be started");
    tree_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(tree_.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(tree_.get(), RTC_BUILD_QUALITY_LOW);
    if (!triangles_.empty()) {
        RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, points_.data(), 0,
                                   sizeof(Eigen::Vector3f), points_.size() - 1);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles_.data(), 0,
                                   sizeof(std::array<Index, 3>), triangles_.size());
        rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
        rtcSetGeometryIntersectFilterFunction(geometry, &keep_nearest);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(tree_.get(), geometry);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(tree_.get());
    const RTCError error = rtcGetDeviceError(device_.get());
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    if (error != RTC_ERROR_NONE)
        throw Error(ErrorKind::failure, "picture", fmt::format("the ray tracer failed with code {}", static_cast<int>(error)));
}

void Surface::gather_faces_around_points() {
    around_begin_.assign(points_.size() + 1, 0);
    for (const auto& corners : triangles_)
        for (const Index v : corners) ++around_begin_[v + 1];
    for (std::size_t i = 1; i < around_begin_.size(); ++i) around_begin_[i] += around_begin_[i - 1];
    around_.resize(triangles_.size() * 3);
    std::vector<Index> next(around_begin_.begin(), around_begin_.end() - 1);
    for (std::size_t t = 0; t < triangles_.size(); ++t)
        for (const Index v : triangles_[t]) around_[next[v]++] = static_cast<Index>(t);
}

bool Surface::first_hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, Hit& hit) const {
    Nearest nearest;
    rtcInitIntersectContext(&nearest.context);
    nearest.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    RTCRayHit query;
    set_ray(query.ray, origin, direction, 0, std::numeric_limits<double>::infinity());
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(tree_.get(), &nearest.context, &query);
    if (nearest.triangle == RTC_INVALID_GEOMETRY_ID) return false;
    hit.triangle = nearest.triangle;
    // The position within the triangle is recomputed in double precision (Moeller and Trumbore 1997), so that it depends only
    // on the triangle hit.
    const auto& [a, b, c] = triangles_[hit.triangle];
    const Eigen::Vector3d start = point(a), side_b = point(b) - start, side_c = point(c) - start, offset = origin - start;
    const Eigen::Vector3d p = direction.cross(side_c), q = offset.cross(side_b);
    const double determinant = side_b.dot(p);
    double u = 1.0 / 3, v = 1.0 / 3;
    if (determinant != 0) {
        u = std::clamp(offset.dot(p) / determinant, 0.0, 1.0);
        v = std::clamp(direction.dot(q) / determinant, 0.0, 1.0 - u);
    }
    hit.weights = {1 - u - v, u, v};
    hit.point = start + u * side_b + v * side_c;
    return true;
}

bool Surface::blocked(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double from, double to) const {
    if (!(to > from)) return false;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray;
    set_ray(ray, origin, direction, from, to);
    rtcOccluded1(tree_.get(), &context, &ray);
    return ray.tfar < 0;
}

Eigen::Vector3d Surface::face_normal(Index triangle) const {
    const Eigen::Vector3d area = areas_[triangle].cast<double>();
    const double length = area.norm();
    return length > 0 ? Eigen::Vector3d(area / length) : Eigen::Vector3d::Zero();
}

Eigen::Vector3f Surface::corner_normal(Index vertex, const Eigen::Vector3f& normal, float crease_cosine) const {
    const Index begin = around_begin_[vertex], end = around_begin_[vertex + 1];
    if (end - begin > largest_fan) return normal;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (Index i = begin; i < end; ++i) {
        const Eigen::Vector3f& area = areas_[around_[i]];
        if (area.dot(normal) >= crease_cosine * area.norm()) sum += area;
    }
    const float length = sum.norm();
    return length > 0 ? Eigen::Vector3f(sum / length) : normal;
}

Eigen::Vector3d Surface::smooth_normal(const Hit& hit, double crease_cosine) const {
    const Eigen::Vector3f flat = face_normal(hit.triangle).cast<float>();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k)
        sum += hit.weights[k] *
               corner_normal(triangles_[hit.triangle][static_cast<std::size_t>(k)], flat, static_cast<float>(crease_cosine))
                   .cast<double>();
    const double length = sum.norm();
    return length > 0 ? Eigen::Vector3d(sum / length) : flat.cast<double>();
}

}  // namespace ostraka::detail
