// Packing of rectangles into square images.
#pragma once

#include <cstddef>
#include <vector>

namespace ostraka::texture {

/// A rectangle to pack, and its place.
struct PackedRectangle {
    int width, height;      ///< size in texels
    std::size_t image = 0;  ///< index of the image
    int x = 0, y = 0;       ///< first column and row
};

/// Images of one size.
struct Packing {
    int size = 0;            ///< width and height of each image; a multiple of 4
    std::size_t images = 0;  ///< number of images
};

/// Places rectangles in one image of a size up to `max_size`, or in several images of the size `max_size`, a multiple of 4 and at
/// least as large as the sides of all rectangles.
Packing pack(std::vector<PackedRectangle>& rectangles, int max_size);

}  // namespace ostraka::texture
