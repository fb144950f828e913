// Tables of the sRGB curve (IEC 61966-2-1), for loops over pixels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace ostraka::images {

/// Conversion between sRGB channels and linear light.
class SrgbTables {
public:
    SrgbTables();
    /// Linear light of a channel, 0 to 1.
    [[nodiscard]] float linear(std::uint8_t channel) const { return linear_[channel]; }
    /// Nearest channel of linear light, clamped; NaN is 0.
    [[nodiscard]] std::uint8_t channel(float light) const {
        if (!(light > 0)) return 0;
        if (light >= 1) return 255;
        std::size_t code = first_[static_cast<std::size_t>(light * static_cast<float>(first_.size() - 1))];
        while (code < 255 && light >= upper_[code]) ++code;
        return static_cast<std::uint8_t>(code);
    }

private:
    std::array<float, 256> linear_{};         ///< light of each channel
    std::array<float, 256> upper_{};          ///< light half-way, on the sRGB curve, to the next channel
    std::array<std::uint8_t, 4097> first_{};  ///< channel at each 4096th of the light
};

/// The tables, which are computed once.
const SrgbTables& srgb_tables();

}  // namespace ostraka::images
