#include "ostraka/texture/bake.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"
#include "texture/fill.h"
#include "texture/source_values.h"
#include "texture/target_bands.h"
#include "texture/target_surface.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

using namespace texture;

constexpr int max_samples = 4;
constexpr double sample_step = 0.25;  ///< share of a texel of the source below which no further sample is taken

/// Number of samples per row of a texel.
int samples_per_row(const BakeOptions& options, double texel, double source_texel) {
    if (options.samples > 0) return options.samples;
    if (!(texel > 0 && source_texel > 0)) return 1;
    return std::clamp(static_cast<int>(std::ceil(std::min(texel / source_texel, 16.0) - sample_step)), 1, max_samples);
}

/// Bakes the bands of a layout.
class Baker {
public:
    Baker(const Mesh& target, const TextureLayout& layout, const BakeOptions& options, int samples, const SourceLookup& lookup,
          const SourceValues& values)
        : layout_(layout),
          options_(options),
          samples_(samples),
          lookup_(lookup),
          values_(values),
          surface_(target),
          bands_(target, layout, samples),
          texels_(static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(layout.height)),
          images_(layout.images) {
        for (BakedImage& image : images_) {
            image.state.assign(texels_, State::outside);
            if (values.is_colour()) image.pixels.rgba.resize(texels_);
            else image.numbers.resize(texels_);
        }
    }

    PlaceCounts run() {
        const std::vector<Band>& bands = bands_.bands();
        std::vector<PlaceCounts> counts(bands.size());
        Progress progress("bake", bands.size());
        parallel_for(bands.size(), 1, [&](std::size_t i) {
            bake_band(bands[i], counts[i]);
            progress.advance();
        });
        PlaceCounts total;
        for (const PlaceCounts& of_band : counts) total.add(of_band);
        return total;
    }

    /// The range of the numbers that were baked.
    [[nodiscard]] ShownRange range() const {
        std::vector<float> numbers;
        if (options_.quantity == BakedQuantity::curvature || options_.quantity == BakedQuantity::relief)
            for (const BakedImage& image : images_)
                for (std::size_t i = 0; i < texels_; ++i)
                    if (image.state[i] == State::baked) numbers.push_back(image.numbers[i]);
        return shown_range(options_, std::move(numbers));
    }

    /// The pixels of an image, filled; may be called once.
    Pixels pixels(std::size_t index, const ShownRange& range) {
        BakedImage image = std::move(images_[index]);
        Pixels result = std::move(image.pixels);
        result.width = layout_.width, result.height = layout_.height;
        result.rgba.resize(texels_);
        std::vector<bool> covered(texels_);
        for (std::size_t i = 0; i < texels_; ++i) {
            const bool grey = image.state[i] == State::without_source && options_.missing == BakeOptions::Missing::grey;
            covered[i] = grey || image.state[i] == State::baked;
            if (grey) result.rgba[i] = missing_grey;
            else if (covered[i] && !values_.is_colour()) result.rgba[i] = range.grey(image.numbers[i]);
        }
        fill_empty(result, covered, options_.gutter);
        return result;
    }

private:
    enum class State : std::uint8_t { outside, baked, without_source };
    struct BakedImage {
        std::vector<State> state;
        Pixels pixels;               ///< of colours
        std::vector<float> numbers;  ///< of other quantities
    };

    void bake_band(const Band& band, PlaceCounts& counts) {
        const std::vector<Index> parts = bands_.faces_of_parts(band), fringe = bands_.faces_of_fringe(band, parts);
        const auto width = static_cast<std::size_t>(layout_.width), samples = static_cast<std::size_t>(samples_);
        CancelCheck check;
        for (int row = band.first_row; row < band.beyond_row; ++row)
            for (std::size_t column = 0; column < width; ++column) {
                check();
                const auto row_of_band = static_cast<std::size_t>(row - band.first_row);
                SampleMean mean(values_.is_colour());
                bool tried = false;
                const auto add = [&](Index face, double x, double y, std::size_t part) {
                    if (face == no_index) return;
                    tried = true;
                    const std::uint64_t texel = (band.image * texels_ + static_cast<std::size_t>(row) * width + column);
                    sample(bands_.place(face, x, y), texel * samples * samples + part, mean, counts);
                };
                const double step = 1.0 / samples_;
                for (std::size_t y = 0; y < samples; ++y)
                    for (std::size_t x = 0; x < samples; ++x)
                        add(parts[(row_of_band * samples + y) * width * samples + column * samples + x],
                            static_cast<double>(column) + (static_cast<double>(x) + 0.5) * step,
                            row + (static_cast<double>(y) + 0.5) * step, y * samples + x);
                add(fringe[row_of_band * width + column], static_cast<double>(column) + 0.5, row + 0.5, 0);
                if (!tried) continue;
                store(images_[band.image], static_cast<std::size_t>(row) * width + column, mean);
            }
    }

    void sample(const TargetPlace& place, std::uint64_t seed, SampleMean& mean, PlaceCounts& counts) const {
        const SourcePlace found =
            lookup_.find(surface_.point(place.face, place.barycentric), surface_.normal(place.face, place.barycentric));
        counts.add(found);
        if (found.found != SourcePlace::Found::nowhere) mean.add(values_.at(found, seed));
    }

    void store(BakedImage& image, std::size_t texel, const SampleMean& mean) const {
        image.state[texel] = mean.empty() ? State::without_source : State::baked;
        if (mean.empty()) return;
        if (values_.is_colour()) image.pixels.rgba[texel] = stored_colour(mean.mean());
        else image.numbers[texel] = mean.mean()[0];
    }

    const TextureLayout& layout_;
    const BakeOptions& options_;
    int samples_;
    const SourceLookup& lookup_;
    const SourceValues& values_;
    TargetSurface surface_;
    TargetBands bands_;
    std::size_t texels_;
    std::vector<BakedImage> images_;
};

}  // namespace

void BakeOptions::declare_options(OptionList& list) {
    list("of", quantity, "what is baked: colours, ambient occlusion, mean curvature, height of the source above the target",
         Choices{"colour", "occlusion", "curvature", "relief"});
    list("distance", distance, "largest distance of the source from the target", Range{0, 1}, "share of the box diagonal");
    list("samples", samples, "rays per row and column of a texel; 0: as the source's texels require, 1 to 4",
         Range{0, max_samples});
    list("missing", missing, "what texels without source show: colours of their neighbourhood, or grey", Choices{"fill", "grey"});
    list("fill", gutter, "width around charts that shows their nearest texel", Range{0, 64}, "texels");
    list("occlusion-rays", occlusion_rays, "occlusion: number of rays per sample", Range{1, 4096});
    list("occlusion-distance", occlusion_distance, "occlusion: length of the rays", Range{0.0001, 2},
         "share of the box diagonal");
    list("curvature-scale", curvature_scale, "curvature: radius of the neighbourhood; 0: the faces around a vertex", Range{0, 1},
         "share of the box diagonal");
    list("range", range, "curvature and relief: value shown by white; 0: the value that 1 % of the samples exceed",
         Range{0, 1e60});
}

BakeResult bake(const Mesh& target, const TextureLayout& layout, const BakeSource& source, const BakeOptions& options,
                const std::string& where) {
    check_options(options, "bake");
    check_layout(target, layout);
    BakeResult result;
    result.texel = texel_size(target, layout);
    result.samples = samples_per_row(options, result.texel, texel_size(source));
    const SourceLookup lookup(source.mesh, options.distance * box_diagonal(target));
    const SourceValues values(source, options, result.texel / result.samples, where);
    Baker baker(target, layout, options, result.samples, lookup, values);
    result.counts = baker.run().result();
    const ShownRange range = baker.range();
    result.low = range.low, result.high = range.high;
    for (std::size_t image = 0; image < layout.images; ++image) result.images.push_back(baker.pixels(image, range));
    return result;
}

}  // namespace ostraka
