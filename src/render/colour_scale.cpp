#include "ostraka/render/colour_scale.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace ostraka {

namespace {
/// Evenly spaced control points of a piecewise linear scale. Lightness (CIE L*) increases uniformly from 15 to 91.
constexpr std::array<Rgb, 9> sequential{{{68, 1, 84},
                                         {71, 44, 122},
                                         {59, 81, 139},
                                         {44, 113, 142},
                                         {33, 144, 141},
                                         {39, 173, 129},
                                         {92, 200, 99},
                                         {170, 220, 50},
                                         {253, 231, 37}}};
/// From dark blue through near white to dark red.
constexpr std::array<Rgb, 9> diverging{{{33, 62, 148},
                                        {62, 107, 190},
                                        {118, 159, 219},
                                        {183, 207, 236},
                                        {243, 242, 240},
                                        {245, 197, 175},
                                        {230, 139, 109},
                                        {202, 76, 66},
                                        {150, 20, 40}}};

constexpr Rgb no_value{160, 160, 160};

double relative_position(const ColourScale& scale, double value) {
    // Halved to avoid overflow for very wide ranges.
    const double width = scale.maximum / 2 - scale.minimum / 2;
    if (!(width > 0)) return 0.5;
    return std::clamp((value / 2 - scale.minimum / 2) / width, 0.0, 1.0);
}
}  // namespace

ColourScale scale_of(const std::vector<const std::vector<double>*>& values, const std::string& where) {
    ColourScale scale;
    scale.minimum = std::numeric_limits<double>::infinity();
    scale.maximum = -scale.minimum;
    for (const auto* map_values : values)
        for (const double value : *map_values) {
            if (!std::isfinite(value)) continue;
            scale.minimum = std::min(scale.minimum, value);
            scale.maximum = std::max(scale.maximum, value);
        }
    if (scale.minimum > scale.maximum)
        fail_input(where, "the map contains no finite value", "give a map with at least one finite value");
    scale.diverging = scale.minimum < 0 && scale.maximum > 0;
    if (scale.diverging) {
        scale.maximum = std::max(scale.maximum, -scale.minimum);
        scale.minimum = -scale.maximum;
    }
    return scale;
}

Rgb colour_of(const ColourScale& scale, double value) {
    if (std::isnan(value)) return no_value;
    const auto& table = scale.diverging ? diverging : sequential;
    const double position = relative_position(scale, value) * static_cast<double>(table.size() - 1);
    const auto low = std::min(static_cast<std::size_t>(position), table.size() - 2);
    const double weight = position - static_cast<double>(low);
    const auto mix = [&](std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>(std::lround(a + weight * (b - a))); };
    const Rgb &a = table[low], &b = table[low + 1];
    return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

Rgb category_colour(std::size_t index) {
    static constexpr std::array<Rgb, category_hues> hues{{{204, 102, 119},
                                                          {75, 63, 168},
                                                          {221, 204, 119},
                                                          {136, 204, 238},
                                                          {136, 34, 85},
                                                          {153, 153, 51},
                                                          {17, 119, 51},
                                                          {170, 68, 153},
                                                          {68, 170, 153}}};
    // Positive: towards white; negative: towards black.
    static constexpr std::array<double, category_count / category_hues> shades{0, 0.45, -0.35, 0.25, -0.18, 0.62, -0.5};
    const Rgb& hue = hues.at(index % category_hues);
    const double shade = shades.at(index / category_hues % shades.size());
    const auto channel = [&](std::uint8_t value) {
        return static_cast<std::uint8_t>(std::lround((1 - std::abs(shade)) * value + (shade > 0 ? 255 * shade : 0)));
    };
    return {channel(hue.red), channel(hue.green), channel(hue.blue)};
}

double round_length(double length) {
    if (!(length > 0) || !std::isfinite(length)) return 0;
    const int exponent = static_cast<int>(std::floor(std::log10(length)));
    double best = 0;
    for (int e = exponent - 1; e <= exponent + 1; ++e)
        for (const int digit : {1, 2, 5}) {
            // Parsed from text: the double nearest to the decimal number, so that it is printed with one digit.
            const double candidate = std::strtod((std::to_string(digit) + "e" + std::to_string(e)).c_str(), nullptr);
            if (std::isfinite(candidate) && candidate <= length * (1 + 1e-12)) best = std::max(best, candidate);
        }
    return best;
}

std::vector<double> ticks(const ColourScale& scale, int count) {
    std::vector<double> positions;
    const double half = scale.maximum / 2 - scale.minimum / 2;
    if (!(half > 0) || count < 2) return {scale.minimum};
    const double smallest = half / (count / 2.0);
    double step = round_length(smallest);
    if (!(step > 0)) return {scale.minimum, scale.maximum};
    if (step < smallest * 0.999) step = round_length(smallest * 2.5);
    const double first = std::ceil(scale.minimum / step - 1e-9);
    for (int i = 0; i <= 4 * count; ++i) {
        const double value = (first + i) * step;
        if (!(value <= scale.maximum + 1e-9 * step)) break;
        positions.push_back(value == 0 ? 0.0 : value);
    }
    return positions;
}

std::string tick_text(double value, double step) {
    const double size = std::max(std::abs(value), std::abs(step));
    if (size == 0) return "0";
    if (size >= 1e6 || size < 1e-4 || !(step > 0)) return digits(value, 4);
    const int after_point = std::clamp(-static_cast<int>(std::floor(std::log10(step) + 1e-9)), 0, 12);
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", after_point, value);
    return text;
}

}  // namespace ostraka
