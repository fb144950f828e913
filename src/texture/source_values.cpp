#include "texture/source_values.h"

#include "ostraka/fields/curvature.h"
#include "texture/occlusion.h"

#include <algorithm>
#include <cmath>

namespace ostraka::texture {

namespace {

/// Width of a sample, in texels of the source, up to which the full image is read.
constexpr double full_image = 1.25;

/// For each face, the width in texture coordinates of a length on the surface.
std::vector<float> texture_lengths(const BakeSource& source) {
    std::vector<float> result(source.mesh.number_of_faces());
    for (const Face face : source.mesh.faces()) {
        const TexturePoint* corner = &source.extras.corner_texture[3 * static_cast<std::size_t>(face)];
        const float area = std::abs((corner[1][0] - corner[0][0]) * (corner[2][1] - corner[0][1]) -
                                    (corner[1][1] - corner[0][1]) * (corner[2][0] - corner[0][0])) /
                           2;
        const double surface = face_area(source.mesh, face);
        result[face] = surface > 0 ? static_cast<float>(std::sqrt(static_cast<double>(area) / surface)) : 0;
    }
    return result;
}

Sample linear_colour(const Colour& colour) {
    return {linear_from_srgb(colour[0]), linear_from_srgb(colour[1]), linear_from_srgb(colour[2]),
            static_cast<float>(colour[3]) / 255};
}

}  // namespace

SourceValues::SourceValues(const BakeSource& source, const BakeOptions& options, double footprint, const std::string& where)
    : source_(source), quantity_(options.quantity), footprint_(footprint) {
    if (quantity_ == BakedQuantity::colour && !source.extras.appearance.empty()) {
        sampler_.emplace(source.extras.appearance, where);
        if (!source.extras.corner_texture.empty()) texture_per_length_ = texture_lengths(source);
    }
    if (quantity_ == BakedQuantity::curvature) {
        CurvatureOptions curvature_options;
        curvature_options.scale = options.curvature_scale;
        curvature_ = curvature(source.mesh, curvature_options).mean;
        for (double& value : curvature_)
            if (std::isnan(value)) value = 0;  // at the border
    }
    if (quantity_ == BakedQuantity::occlusion)
        occlusion_ = std::make_unique<Occlusion>(source.mesh, options.occlusion_rays, options.occlusion_distance);
}

SourceValues::~SourceValues() = default;

Sample SourceValues::colour(const SurfaceHit& hit) const {
    const MeshExtras& extras = source_.extras;
    Sample result{1, 1, 1, 1};
    const auto multiply = [&](const Sample& factor) {
        for (std::size_t k = 0; k < 4; ++k) result[k] *= factor[k];
    };
    if (sampler_) {
        const Index material = extras.face_materials.empty() ? no_index : extras.face_materials[hit.face];
        TexturePoint at{};
        float footprint = 0;
        if (!extras.corner_texture.empty()) {
            for (std::size_t axis = 0; axis < 2; ++axis) {
                double sum = 0;
                for (std::size_t k = 0; k < 3; ++k)
                    sum += hit.barycentric[k] *
                           static_cast<double>(extras.corner_texture[3 * static_cast<std::size_t>(hit.face) + k][axis]);
                at[axis] = static_cast<float>(sum);
            }
            footprint = static_cast<float>(footprint_) * texture_per_length_[hit.face];
            const auto [width, height] = sampler_->size(material);
            if (footprint * static_cast<float>(std::max(width, height)) < static_cast<float>(full_image)) footprint = 0;
        }
        multiply(sampler_->colour(material, at, footprint));
    }
    if (!extras.vertex_colours.empty()) {
        const auto vertices = corners(source_.mesh, Face(hit.face));
        Sample mean{};
        for (std::size_t k = 0; k < 3; ++k) {
            const Sample corner = linear_colour(extras.vertex_colours[vertices[k]]);
            for (std::size_t c = 0; c < 4; ++c) mean[c] += static_cast<float>(hit.barycentric[k]) * corner[c];
        }
        multiply(mean);
    }
    if (!extras.face_colours.empty()) multiply(linear_colour(extras.face_colours[hit.face]));
    return result;
}

Sample SourceValues::at(const SourcePlace& place, std::uint64_t seed) const {
    switch (quantity_) {
        case BakedQuantity::colour:
            return colour(place.hit);
        case BakedQuantity::relief:
            return {static_cast<float>(place.height)};
        case BakedQuantity::occlusion:
            return {occlusion_->open_share(place.hit.point, area_vector(source_.mesh, Face(place.hit.face)), seed)};
        case BakedQuantity::curvature:
            break;
    }
    const auto vertices = corners(source_.mesh, Face(place.hit.face));
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += place.hit.barycentric[k] * curvature_[vertices[k]];
    return {static_cast<float>(sum)};
}

void SampleMean::add(const Sample& sample, double weight) {
    const double opacity = is_colour_ ? static_cast<double>(sample[3]) : 1.0;
    for (std::size_t k = 0; k < 3; ++k) sum_[k] += weight * opacity * static_cast<double>(sample[k]);
    sum_[3] += weight * opacity;
    weight_ += weight;
}

void SampleMean::add(const SampleMean& other) {
    for (std::size_t k = 0; k < 4; ++k) sum_[k] += other.sum_[k];
    weight_ += other.weight_;
}

Sample SampleMean::mean() const {
    Sample result{};
    if (sum_[3] > 0)
        for (std::size_t k = 0; k < 3; ++k) result[k] = static_cast<float>(sum_[k] / sum_[3]);
    result[3] = weight_ > 0 ? static_cast<float>(sum_[3] / weight_) : 0;
    return result;
}

std::array<std::uint8_t, 4> stored_colour(const Sample& linear) {
    const double alpha = std::clamp(static_cast<double>(linear[3]), 0.0, 1.0);
    return {srgb_from_linear(linear[0]), srgb_from_linear(linear[1]), srgb_from_linear(linear[2]),
            static_cast<std::uint8_t>(std::lround(255 * alpha))};
}

std::array<std::uint8_t, 4> ShownRange::grey(float value) const {
    const double share = high > low ? (static_cast<double>(value) - low) / (high - low) : 0.5;
    const auto channel = static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
    return {channel, channel, channel, 255};
}

ShownRange shown_range(const BakeOptions& options, std::vector<float> values) {
    if (options.quantity == BakedQuantity::occlusion || options.quantity == BakedQuantity::colour) return {0, 1};
    if (options.range > 0) return {-options.range, options.range};
    if (values.empty()) return {-1, 1};
    for (float& value : values) value = std::abs(value);
    const auto place = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) * 99 / 100);
    std::nth_element(values.begin(), place, values.end());
    const double limit = static_cast<double>(*place);
    return limit > 0 ? ShownRange{-limit, limit} : ShownRange{-1, 1};
}

}  // namespace ostraka::texture
