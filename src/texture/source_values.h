// Colours and numbers of the source of a bake.
#pragma once

#include "ostraka/texture/bake.h"
#include "texture/source_lookup.h"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace ostraka::texture {

/// Linear red, green, blue and opacity, or a number in the first place.
using Sample = std::array<float, 4>;

class Occlusion;

/// What a bake shows at a place of the source.
class SourceValues {
public:
    /// `footprint`: length on the surface whose mean a sample is to show.
    SourceValues(const BakeSource& source, const BakeOptions& options, double footprint, const std::string& where);
    ~SourceValues();

    /// True for colours; false for numbers.
    [[nodiscard]] bool is_colour() const { return quantity_ == BakedQuantity::colour; }
    /// The value at a place that was found; `seed`: number of the sample, from which the directions of its rays follow.
    [[nodiscard]] Sample at(const SourcePlace& place, std::uint64_t seed) const;

private:
    [[nodiscard]] Sample colour(const SurfaceHit& hit) const;

    const BakeSource& source_;
    BakedQuantity quantity_;
    double footprint_;
    std::optional<TextureSampler> sampler_;
    std::vector<float> texture_per_length_;  ///< for each face: width in texture coordinates per length; empty: full images
    std::vector<double> curvature_;          ///< one per vertex
    std::unique_ptr<Occlusion> occlusion_;
};

/// Mean of samples.
class SampleMean {
public:
    explicit SampleMean(bool is_colour) : is_colour_(is_colour) {}
    void add(const Sample& sample, double weight = 1);
    void add(const SampleMean& other);
    [[nodiscard]] bool empty() const { return !(weight_ > 0); }
    /// The mean; colours are weighted by their opacity.
    [[nodiscard]] Sample mean() const;

private:
    bool is_colour_;
    std::array<double, 4> sum_{};
    double weight_ = 0;
};

/// An sRGB colour with alpha from a linear colour.
std::array<std::uint8_t, 4> stored_colour(const Sample& linear);

/// Range of numbers that black to white show.
struct ShownRange {
    double low = 0, high = 1;
    [[nodiscard]] std::array<std::uint8_t, 4> grey(float value) const;
};
/// The range for a quantity: 0 to 1 for occlusion, else symmetric. `values` may be reordered.
ShownRange shown_range(const BakeOptions& options, std::vector<float> values);

inline constexpr std::array<std::uint8_t, 4> missing_grey{170, 170, 170, 255};  ///< colour of places without source

}  // namespace ostraka::texture
