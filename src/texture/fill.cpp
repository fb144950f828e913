#include "texture/fill.h"

#include "ostraka/core/progress.h"
#include "texture/source_values.h"

#include <algorithm>
#include <array>

namespace ostraka::texture {

namespace {

/// A pixel of an image, with its column and row.
struct TexelPlace {
    int column, row;
};

std::int64_t squared_distance(const TexelPlace& a, const TexelPlace& b) {
    const std::int64_t x = a.column - b.column, y = a.row - b.row;
    return x * x + y * y;
}

/// Grows the coloured texels ring by ring; each new texel takes the nearest of the texels that its neighbours took.
class Dilation {
public:
    Dilation(Pixels& pixels, std::vector<bool>& covered) : pixels_(pixels), covered_(covered) {}

    void run(int gutter) {
        std::vector<Grown> ring;
        for (int row = 0; row < pixels_.height; ++row)
            for (int column = 0; column < pixels_.width; ++column)
                if (covered_[index({column, row})] && has_empty_neighbour({column, row}))
                    ring.push_back({{column, row}, {column, row}});
        for (int step = 0; step < gutter && !ring.empty(); ++step) ring = grow(ring);
    }

private:
    struct Grown {
        TexelPlace place, origin;
    };

    [[nodiscard]] std::size_t index(const TexelPlace& place) const {
        return static_cast<std::size_t>(place.row) * static_cast<std::size_t>(pixels_.width) + static_cast<std::size_t>(place.column);
    }
    template <class Action>
    void each_neighbour(const TexelPlace& place, Action&& action) const {
        for (int row = std::max(place.row - 1, 0); row <= std::min(place.row + 1, pixels_.height - 1); ++row)
            for (int column = std::max(place.column - 1, 0); column <= std::min(place.column + 1, pixels_.width - 1); ++column)
                action(TexelPlace{column, row});
    }
    [[nodiscard]] bool has_empty_neighbour(const TexelPlace& place) const {
        bool result = false;
        each_neighbour(place, [&](const TexelPlace& next) { result = result || !covered_[index(next)]; });
        return result;
    }

    std::vector<Grown> grow(const std::vector<Grown>& ring) {
        struct Candidate {
            std::size_t index;
            std::int64_t distance;
            std::size_t origin;
            Grown grown;
        };
        std::vector<Candidate> candidates;
        for (const Grown& grown : ring)
            each_neighbour(grown.place, [&](const TexelPlace& next) {
                if (!covered_[index(next)])
                    candidates.push_back(
                        {index(next), squared_distance(next, grown.origin), index(grown.origin), {next, grown.origin}});
            });
        std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
            return std::tie(a.index, a.distance, a.origin) < std::tie(b.index, b.distance, b.origin);
        });
        std::vector<Grown> next_ring;
        for (const Candidate& candidate : candidates) {
            if (covered_[candidate.index]) continue;
            covered_[candidate.index] = true;
            pixels_.rgba[candidate.index] = pixels_.rgba[candidate.origin];
            next_ring.push_back(candidate.grown);
        }
        return next_ring;
    }

    Pixels& pixels_;
    std::vector<bool>& covered_;
};

/// Means of the coloured pixels of each block of two by two.
void pull(const Pixels& fine, const std::vector<bool>& covered, Pixels& coarse, std::vector<bool>& coarse_covered) {
    coarse.width = (fine.width + 1) / 2, coarse.height = (fine.height + 1) / 2;
    const auto count = static_cast<std::size_t>(coarse.width) * static_cast<std::size_t>(coarse.height);
    coarse.rgba.assign(count, missing_grey);
    coarse_covered.assign(count, false);
    for (int row = 0; row < coarse.height; ++row)
        for (int column = 0; column < coarse.width; ++column) {
            std::array<unsigned, 4> sum{};
            unsigned number = 0;
            for (int y = 2 * row; y < std::min(2 * row + 2, fine.height); ++y)
                for (int x = 2 * column; x < std::min(2 * column + 2, fine.width); ++x) {
                    if (!covered[static_cast<std::size_t>(y) * static_cast<std::size_t>(fine.width) + static_cast<std::size_t>(x)])
                        continue;
                    ++number;
                    for (std::size_t k = 0; k < 4; ++k) sum[k] += fine.at(x, y)[k];
                }
            if (number == 0) continue;
            const auto i = static_cast<std::size_t>(row) * static_cast<std::size_t>(coarse.width) + static_cast<std::size_t>(column);
            coarse_covered[i] = true;
            for (std::size_t k = 0; k < 4; ++k) coarse.rgba[i][k] = static_cast<std::uint8_t>((sum[k] + number / 2) / number);
        }
}

/// Gives pixels without a colour the colour of their block.
void push(const Pixels& coarse, Pixels& fine, const std::vector<bool>& covered) {
    std::size_t i = 0;
    for (int row = 0; row < fine.height; ++row)
        for (int column = 0; column < fine.width; ++column, ++i)
            if (!covered[i]) fine.rgba[i] = coarse.at(column / 2, row / 2);
}

void fill_from_means(Pixels& pixels, const std::vector<bool>& covered) {
    if (std::find(covered.begin(), covered.end(), false) == covered.end()) return;
    check_cancelled();
    if (pixels.width == 1 && pixels.height == 1) {
        pixels.rgba.front() = missing_grey;
        return;
    }
    Pixels coarse;
    std::vector<bool> coarse_covered;
    pull(pixels, covered, coarse, coarse_covered);
    fill_from_means(coarse, coarse_covered);
    push(coarse, pixels, covered);
}

}  // namespace

void fill_empty(Pixels& pixels, std::vector<bool>& covered, int gutter) {
    Dilation(pixels, covered).run(gutter);
    fill_from_means(pixels, covered);
}

}  // namespace ostraka::texture
