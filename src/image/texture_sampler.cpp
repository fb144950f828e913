#include "image/area_mean.h"
#include "image/srgb.h"
#include "ostraka/core/memory.h"
#include "ostraka/core/message_text.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/image/appearance.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

using LinearColour = std::array<float, 4>;

/// Coordinate within the image or its mirror image, finite: a whole number of repetitions makes no difference.
double wrapped_coordinate(double value, TextureWrap wrap) {
    if (!std::isfinite(value)) return 0;
    if (wrap == TextureWrap::clamp) return std::clamp(value, 0.0, 1.0);
    if (wrap == TextureWrap::repeat) return value - std::floor(value);
    return value - 2 * std::floor(value / 2);
}

/// Texel that a texel number outside the image shows; numbers lie within one mirrored repetition of the image.
int wrapped_texel(int texel, int count, TextureWrap wrap) {
    if (wrap == TextureWrap::clamp) return std::clamp(texel, 0, count - 1);
    const int period = wrap == TextureWrap::repeat ? count : 2 * count;
    const int inside = (texel % period + period) % period;
    return inside < count ? inside : period - 1 - inside;
}

/// The two texels next to a coordinate and the share of the second.
struct Neighbours {
    int first = 0, second = 0;
    float share = 0;
};

Neighbours neighbours_of(double coordinate, int count, TextureWrap wrap, bool nearest) {
    const double position = wrapped_coordinate(coordinate, wrap) * count;
    if (nearest) {
        const int texel = wrapped_texel(static_cast<int>(std::floor(position)), count, wrap);
        return {texel, texel, 0};
    }
    const double left = std::floor(position - 0.5);
    const int texel = static_cast<int>(left);
    return {wrapped_texel(texel, count, wrap), wrapped_texel(texel + 1, count, wrap), static_cast<float>(position - 0.5 - left)};
}

LinearColour mixed(const LinearColour& p, const LinearColour& q, float share) {
    LinearColour result;
    for (std::size_t k = 0; k < 4; ++k) result[k] = p[k] + share * (q[k] - p[k]);
    return result;
}

template <class Texel>  // colour of a column and a row
LinearColour interpolated(const Neighbours& columns, const Neighbours& rows, const Texel& texel) {
    const LinearColour upper = mixed(texel(columns.first, rows.first), texel(columns.second, rows.first), columns.share);
    if (rows.share == 0) return upper;
    return mixed(upper, mixed(texel(columns.first, rows.second), texel(columns.second, rows.second), columns.share), rows.share);
}

std::size_t texel_index(int width, int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
}

LinearColour linear_colour(const std::array<std::uint8_t, 4>& pixel) {
    const images::SrgbTables& tables = images::srgb_tables();
    return {tables.linear(pixel[0]), tables.linear(pixel[1]), tables.linear(pixel[2]), static_cast<float>(pixel[3]) / 255};
}

LinearColour linear_colour(const std::array<std::uint16_t, 4>& values) {
    LinearColour colour;
    for (std::size_t k = 0; k < 4; ++k) colour[k] = static_cast<float>(values[k]) / 65535;
    return colour;
}

/// Level with half the width and height of a larger one; `read`: linear colour of a column and a row of the larger one.
template <class Level, class Read>
Level halved(int width, int height, const Read& read) {
    Level level{std::max(1, width / 2), std::max(1, height / 2), {}};
    level.rgba.resize(static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height));
    const double area = static_cast<double>(width) * height;
    parallel_for(static_cast<std::size_t>(level.height), 8, [&](std::size_t row) {
        const images::Coverage rows(static_cast<int>(row), level.height, height);
        for (int column = 0; column < level.width; ++column) {
            const auto sum = images::area_sum<4>(images::Coverage(column, level.width, width), rows, read);
            auto& target = level.rgba[texel_index(level.width, column, static_cast<int>(row))];
            for (std::size_t k = 0; k < 4; ++k) target[k] = static_cast<std::uint16_t>(std::lround(sum[k] / area * 65535));
        }
    });
    return level;
}

}  // namespace

TextureSampler::TextureSampler(const Appearance& appearance, const std::string& where)
    : materials_(appearance.materials), pyramids_(appearance.images.size()) {
    std::vector<bool> is_used(appearance.images.size());
    for (const Material& material : materials_)
        if (material.image < is_used.size()) is_used[material.image] = true;
    double bytes = 0;
    const auto needs = [&](std::size_t i) { return is_used[i] && appearance.images[i] != nullptr; };
    for (std::size_t i = 0; i < pyramids_.size(); ++i)  // 4 bytes a pixel, and 8 bytes a pixel of the smaller levels
        if (needs(i)) bytes += (4 + 8.0 / 3) * appearance.images[i]->width * appearance.images[i]->height;
    if (bytes > 0)
        require_memory(bytes, fmt::format("{}: its {}", where, counted(pyramids_.size(), "image")), "reduce the images");
    for (std::size_t i = 0; i < pyramids_.size(); ++i) {
        if (!needs(i)) continue;
        Pyramid& pyramid = pyramids_[i];
        pyramid.full = decode(*appearance.images[i], where);
        const Pixels& full = pyramid.full;
        if (full.width == 1 && full.height == 1) continue;
        pyramid.levels.push_back(
            halved<Level>(full.width, full.height, [&](int column, int row) { return linear_colour(full.at(column, row)); }));
        while (pyramid.levels.back().width > 1 || pyramid.levels.back().height > 1) {
            const Level& previous = pyramid.levels.back();
            Level next = halved<Level>(previous.width, previous.height, [&](int column, int row) {
                return linear_colour(previous.rgba[texel_index(previous.width, column, row)]);
            });
            pyramid.levels.push_back(std::move(next));
        }
    }
}

const TextureSampler::Pyramid* TextureSampler::pyramid_of(Index material) const {
    if (material >= materials_.size() || materials_[material].image >= pyramids_.size()) return nullptr;
    const Pyramid& pyramid = pyramids_[materials_[material].image];
    return pyramid.full.rgba.empty() ? nullptr : &pyramid;
}

std::array<int, 2> TextureSampler::size(Index material) const {
    const Pyramid* pyramid = pyramid_of(material);
    return pyramid == nullptr ? std::array<int, 2>{0, 0} : std::array<int, 2>{pyramid->full.width, pyramid->full.height};
}

std::array<float, 4> TextureSampler::colour(Index material, TexturePoint at, float footprint) const {
    if (material >= materials_.size()) return {1, 1, 1, 1};
    const Material& look = materials_[material];
    const Pyramid* pyramid = pyramid_of(material);
    if (pyramid == nullptr) return look.base_colour;
    const auto neighbours = [&](int width, int height, bool nearest) {
        return std::pair(neighbours_of(at[0], width, look.wrap_u, nearest),
                         neighbours_of(1.0 - at[1], height, look.wrap_v, nearest));
    };
    const auto at_level = [&](std::size_t level) -> LinearColour {
        if (level == 0) {
            const Pixels& full = pyramid->full;
            const auto [columns, rows] = neighbours(full.width, full.height, false);
            return interpolated(columns, rows, [&](int column, int row) { return linear_colour(full.at(column, row)); });
        }
        const Level& smaller = pyramid->levels[level - 1];
        const auto [columns, rows] = neighbours(smaller.width, smaller.height, false);
        return interpolated(columns, rows, [&](int column, int row) {
            return linear_colour(smaller.rgba[texel_index(smaller.width, column, row)]);
        });
    };
    const Pixels& full = pyramid->full;
    const float texels = footprint * static_cast<float>(std::max(full.width, full.height));
    LinearColour colour;
    if (texels > 1) {
        const float last = static_cast<float>(pyramid->levels.size());
        const float level = std::min(std::log2(texels), last), whole = std::floor(level);
        colour = at_level(static_cast<std::size_t>(whole));
        if (level > whole) colour = mixed(colour, at_level(static_cast<std::size_t>(whole) + 1), level - whole);
    } else if (look.nearest) {
        const auto [columns, rows] = neighbours(full.width, full.height, true);
        colour = linear_colour(full.at(columns.first, rows.first));
    } else {
        colour = at_level(0);
    }
    for (std::size_t k = 0; k < 4; ++k) colour[k] *= look.base_colour[k];
    return colour;
}

}  // namespace ostraka
