#include "ostraka/image/colour_space.h"

#include "ostraka/core/angles.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

double power7(double x) {
    const double cube = x * x * x;
    return cube * cube * x;
}

/// Angle of a hue in degrees, 0 to 360; 0 for a neutral colour.
double hue_of(double a, double b) {
    if (a == 0 && b == 0) return 0;
    const double degrees = std::atan2(b, a) * 180 / pi;
    return degrees < 0 ? degrees + 360 : degrees;
}

double cosine_of_degrees(double angle) { return std::cos(angle * pi / 180); }

}  // namespace

Lab lab_from_linear(const std::array<float, 3>& linear) {
    const double r = static_cast<double>(linear[0]), g = static_cast<double>(linear[1]), b = static_cast<double>(linear[2]);
    const std::array<double, 3> xyz{0.4124564 * r + 0.3575761 * g + 0.1804375 * b, 0.2126729 * r + 0.7151522 * g + 0.0721750 * b,
                                    0.0193339 * r + 0.1191920 * g + 0.9503041 * b};
    constexpr std::array<double, 3> white{0.9504700, 1.0000001, 1.0888300};
    std::array<double, 3> f{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double share = xyz[k] / white[k];
        f[k] = share > 216.0 / 24389 ? std::cbrt(share) : (24389.0 / 27 * share + 16) / 116;
    }
    return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

double colour_difference(const Lab& first, const Lab& second) {
    const double mean_chroma = (std::hypot(first[1], first[2]) + std::hypot(second[1], second[2])) / 2;
    const double stretch = 1 + 0.5 * (1 - std::sqrt(power7(mean_chroma) / (power7(mean_chroma) + power7(25))));
    const double a1 = stretch * first[1], a2 = stretch * second[1];
    const double chroma1 = std::hypot(a1, first[2]), chroma2 = std::hypot(a2, second[2]);
    const double hue1 = hue_of(a1, first[2]), hue2 = hue_of(a2, second[2]);
    const bool neutral = chroma1 * chroma2 == 0;
    double hue_step = hue2 - hue1;
    if (neutral) hue_step = 0;
    else if (hue_step > 180) hue_step -= 360;
    else if (hue_step < -180) hue_step += 360;
    const double lightness_difference = second[0] - first[0], chroma_difference = chroma2 - chroma1,
                 hue_difference = 2 * std::sqrt(chroma1 * chroma2) * std::sin(hue_step / 2 * pi / 180);
    double mean_hue = hue1 + hue2;
    if (!neutral) {
        if (std::fabs(hue1 - hue2) > 180) mean_hue += mean_hue < 360 ? 360 : -360;
        mean_hue /= 2;
    }
    const double mean_lightness = (first[0] + second[0]) / 2, middle_chroma = (chroma1 + chroma2) / 2;
    const double hue_weight = 1 - 0.17 * cosine_of_degrees(mean_hue - 30) + 0.24 * cosine_of_degrees(2 * mean_hue) +
                              0.32 * cosine_of_degrees(3 * mean_hue + 6) - 0.20 * cosine_of_degrees(4 * mean_hue - 63);
    const double off_middle = (mean_lightness - 50) * (mean_lightness - 50);
    const double lightness_scale = 1 + 0.015 * off_middle / std::sqrt(20 + off_middle), chroma_scale = 1 + 0.045 * middle_chroma,
                 hue_scale = 1 + 0.015 * middle_chroma * hue_weight;
    const double from_blue = (mean_hue - 275) / 25;
    const double rotation = -2 * std::sqrt(power7(middle_chroma) / (power7(middle_chroma) + power7(25))) *
                            std::sin(60 * std::exp(-from_blue * from_blue) * pi / 180);
    const double l = lightness_difference / lightness_scale, c = chroma_difference / chroma_scale, h = hue_difference / hue_scale;
    return std::sqrt(std::max(0.0, l * l + c * c + h * h + rotation * c * h));
}

}  // namespace ostraka
