#include "ostraka/measure/appearance_change.h"

#include "ostraka/execution/parallel.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/image/appearance.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ostraka {

namespace {

struct AreaPlace {
    Face face;
    std::array<double, 3> barycentric;
};

/// Places at equal steps of the accumulated area of the faces; within the faces, by a sequence of low discrepancy (R2).
std::vector<AreaPlace> places_by_area(const Mesh& mesh, std::size_t count) {
    std::vector<double> ends;
    double total = 0;
    for (const Face f : mesh.faces()) ends.push_back(total += face_area(mesh, f));
    std::vector<AreaPlace> places;
    if (!(total > 0)) return places;
    for (std::size_t i = 0; i < count; ++i) {
        const double area = total * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
        const auto place = std::min(std::upper_bound(ends.begin(), ends.end(), area), ends.end() - 1);
        const double number = static_cast<double>(i) + 1;
        double u = number * 0.7548776662466927, v = number * 0.5698402909980532;
        u -= std::floor(u), v -= std::floor(v);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        places.push_back({Face(static_cast<Index>(place - ends.begin())), {1 - u - v, u, v}});
    }
    return places;
}

double difference_of_srgb(const std::array<float, 4>& a, const std::array<float, 4>& b) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k)
        sum += std::abs(static_cast<double>(srgb_from_linear(a[k])) - static_cast<double>(srgb_from_linear(b[k])));
    return sum / 3;
}

/// The texture at a point of a face; `texels`: width of the area over which the colour is averaged.
std::array<float, 4> texture_at(const TextureSampler& sampler, const MeshExtras& extras, Index face,
                                const std::array<double, 3>& barycentric, int texels = 0) {
    const Index material = extras.face_materials.empty() ? no_index : extras.face_materials[face];
    std::array<double, 2> at{};
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t c = 0; c < 2; ++c)
            at[c] += barycentric[k] * static_cast<double>(extras.corner_texture[3 * std::size_t{face} + k][c]);
    const auto [width, height] = material == no_index ? std::array<int, 2>{} : sampler.size(material);
    const int size = std::max(width, height);
    const float footprint = size > 0 ? static_cast<float>(texels) / static_cast<float>(size) : 0;
    return sampler.colour(material, {static_cast<float>(at[0]), static_cast<float>(at[1])}, footprint);
}

}  // namespace

AppearanceChange appearance_change(const MeshFile& before, const Mesh& after, const MeshExtras& after_extras,
                                   const std::string& where, std::size_t samples) {
    const std::vector<AreaPlace> places = places_by_area(after, samples);
    const SurfaceSearch search(before.mesh);
    const TextureSampler sampler(before.extras.appearance, where);
    std::vector<std::array<double, 2>> differences(places.size());
    parallel_for(places.size(), [&](std::size_t i) {
        const auto& [face, barycentric] = places[i];
        const SurfaceHit hit = search.closest(point_at(after, face, barycentric));
        const auto original = texture_at(sampler, before.extras, hit.face, hit.barycentric);
        differences[i] = {difference_of_srgb(texture_at(sampler, after_extras, face, barycentric), original),
                          difference_of_srgb(texture_at(sampler, before.extras, hit.face, hit.barycentric, 2), original)};
    });
    AppearanceChange change;
    change.samples = places.size();
    for (const auto& [mean, resampling] : differences) change.mean += mean, change.resampling += resampling;
    if (change.samples > 0) {
        change.mean /= static_cast<double>(change.samples);
        change.resampling /= static_cast<double>(change.samples);
    }
    return change;
}

}  // namespace ostraka
