#include "texture/pack.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace {
/// Sorts rectangles stably, so that equal ones keep their order with every C library.
template <class Rectangle>
void sort_rectangles(Rectangle* first, int count, std::size_t /*size*/, int (*compare)(const void*, const void*)) {
    std::stable_sort(first, first + count, [&](const Rectangle& a, const Rectangle& b) { return compare(&a, &b) < 0; });
}
}  // namespace
#define STBRP_STATIC
#define STBRP_SORT sort_rectangles
#define STB_RECT_PACK_IMPLEMENTATION
#include <stb/stb_rect_pack.h>

namespace ostraka::texture {

namespace {

constexpr double growth = 1.02;  ///< of an image that is too small

/// Packs the rectangles without a place into image `image`; true if all fitted.
bool pack_into(std::vector<PackedRectangle>& rectangles, std::vector<std::size_t>& open, std::size_t image, int size) {
    std::vector<stbrp_node> nodes(static_cast<std::size_t>(size));
    std::vector<stbrp_rect> places(open.size());
    for (std::size_t i = 0; i < open.size(); ++i) {
        places[i].w = rectangles[open[i]].width;
        places[i].h = rectangles[open[i]].height;
    }
    stbrp_context context;
    stbrp_init_target(&context, size, size, nodes.data(), size);
    stbrp_pack_rects(&context, places.data(), static_cast<int>(places.size()));
    std::vector<std::size_t> left;
    for (std::size_t i = 0; i < open.size(); ++i) {
        if (places[i].was_packed == 0) {
            left.push_back(open[i]);
            continue;
        }
        rectangles[open[i]].image = image;
        rectangles[open[i]].x = places[i].x;
        rectangles[open[i]].y = places[i].y;
    }
    open = std::move(left);
    return open.empty();
}

}  // namespace

Packing pack(std::vector<PackedRectangle>& rectangles, int max_size) {
    std::vector<std::size_t> all(rectangles.size());
    double area = 0;
    int side = 4;
    for (std::size_t i = 0; i < rectangles.size(); ++i) {
        all[i] = i;
        area += static_cast<double>(rectangles[i].width) * rectangles[i].height;
        side = std::max({side, rectangles[i].width, rectangles[i].height});
    }
    const auto multiple = [](double size) { return static_cast<int>(4 * std::ceil(size / 4)); };
    for (double size = std::max<double>(side, std::sqrt(area)); size <= max_size; size = std::max(size * growth, size + 4)) {
        std::vector<std::size_t> open = all;
        const int tried = std::min(multiple(size), max_size);
        if (pack_into(rectangles, open, 0, tried)) return {tried, 1};
    }
    Packing packing{max_size, 0};
    for (std::vector<std::size_t> open = all; !open.empty();) pack_into(rectangles, open, packing.images++, max_size);
    return packing;
}

}  // namespace ostraka::texture
