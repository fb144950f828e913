#include "image/srgb.h"

#include "ostraka/image/appearance.h"

#include <cmath>

namespace ostraka {

namespace images {

namespace {
double linear_light(double value) { return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4); }
}  // namespace

SrgbTables::SrgbTables() {
    for (std::size_t code = 0; code < 256; ++code) {
        linear_[code] = static_cast<float>(linear_light(static_cast<double>(code) / 255));
        upper_[code] = static_cast<float>(linear_light((static_cast<double>(code) + 0.5) / 255));
    }
    std::size_t code = 0;
    for (std::size_t i = 0; i < first_.size(); ++i) {
        const float light = static_cast<float>(i) / static_cast<float>(first_.size() - 1);
        while (code < 255 && light >= upper_[code]) ++code;
        first_[i] = static_cast<std::uint8_t>(code);
    }
}

const SrgbTables& srgb_tables() {
    static const SrgbTables tables;
    return tables;
}

}  // namespace images

float linear_from_srgb(std::uint8_t channel) { return images::srgb_tables().linear(channel); }
std::uint8_t srgb_from_linear(float light) { return images::srgb_tables().channel(light); }

}  // namespace ostraka
