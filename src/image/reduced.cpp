#include "image/area_mean.h"
#include "image/codecs.h"
#include "image/srgb.h"
#include "ostraka/execution/parallel.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

/// Mean colour of pixels, weighted by alpha; without weights where all are transparent.
std::array<std::uint8_t, 4> mean_pixel(const Pixels& pixels, const images::Coverage& columns, const images::Coverage& rows) {
    const images::SrgbTables& tables = images::srgb_tables();
    const auto weighted = images::area_sum<4>(columns, rows, [&](int column, int row) {
        const auto& pixel = pixels.at(column, row);
        const float alpha = pixel[3];
        return std::array<float, 4>{tables.linear(pixel[0]) * alpha, tables.linear(pixel[1]) * alpha,
                                    tables.linear(pixel[2]) * alpha, alpha};
    });
    const double area = static_cast<double>(pixels.width) * pixels.height;
    const auto light = [&](double sum, double total) { return tables.channel(static_cast<float>(sum / total)); };
    if (weighted[3] > 0)
        return {light(weighted[0], weighted[3]), light(weighted[1], weighted[3]), light(weighted[2], weighted[3]),
                static_cast<std::uint8_t>(std::lround(weighted[3] / area))};
    const auto plain = images::area_sum<3>(columns, rows, [&](int column, int row) {
        const auto& pixel = pixels.at(column, row);
        return std::array<float, 3>{tables.linear(pixel[0]), tables.linear(pixel[1]), tables.linear(pixel[2])};
    });
    return {light(plain[0], area), light(plain[1], area), light(plain[2], area), 0};
}

/// Encodes with falling quality until the file fits; nullopt if none fits. `smallest`: size of the smallest file.
std::optional<Image> encoded_within(const Pixels& pixels, const std::string& stem, bool translucent, std::size_t max_bytes,
                                    std::size_t& smallest) {
    const ImageFormat format = translucent ? ImageFormat::png : ImageFormat::jpeg;
    for (const int quality : {90, 80, 70, 60}) {
        Image image = encode(pixels, format, stem.empty() ? stem : stem + extension_of(format), quality);
        smallest = image.bytes.size();
        if (smallest <= max_bytes) return image;
        if (translucent) break;
    }
    return std::nullopt;
}

int scaled_side(int side, double factor) { return std::max(1, static_cast<int>(std::lround(side * factor))); }

}  // namespace

Pixels reduced(const Pixels& pixels, int width, int height) {
    if (width < 1 || height < 1 || width > pixels.width || height > pixels.height)
        fail_usage(
            fmt::format("an image of {} x {} pixels cannot be reduced to {} x {}", pixels.width, pixels.height, width, height));
    if (width == pixels.width && height == pixels.height) return pixels;
    Pixels result = images::blank_pixels(width, height);
    parallel_for(static_cast<std::size_t>(height), 8, [&](std::size_t row) {
        const images::Coverage rows(static_cast<int>(row), height, pixels.height);
        auto* target = result.rgba.data() + row * static_cast<std::size_t>(width);
        for (int column = 0; column < width; ++column)
            target[column] = mean_pixel(pixels, images::Coverage(column, width, pixels.width), rows);
    });
    return result;
}

Image within_budget(const Image& image, int max_side, std::size_t max_bytes, const std::string& where) {
    if (max_side < 1) fail_usage(fmt::format("the largest side of an image is {}", max_side), "give at least 1 pixel");
    const int side = std::max(image.width, image.height);
    if (side <= max_side && image.bytes.size() <= max_bytes) return image;
    const Pixels pixels = decode(image, where);
    const bool translucent = images::is_translucent(pixels);
    const std::string stem = Path(image.name).stem().string();
    for (double factor = std::min(1.0, static_cast<double>(max_side) / side);;) {
        const int width = scaled_side(pixels.width, factor), height = scaled_side(pixels.height, factor);
        std::size_t smallest = 0;
        if (auto fitting = encoded_within(reduced(pixels, width, height), stem, translucent, max_bytes, smallest))
            return *std::move(fitting);
        if (width == 1 && height == 1)
            fail_usage(fmt::format("no image fits into {} bytes", max_bytes), "allow at least 1,000 bytes for an image");
        const double ratio = static_cast<double>(max_bytes) / static_cast<double>(smallest);
        factor *= std::clamp(std::sqrt(ratio) * 0.97, 0.1, 0.9);
    }
}

}  // namespace ostraka
