// How much the texture of a surface changed with its triangles.
#pragma once

#include "ostraka/io/mesh_file.h"

#include <string>

namespace ostraka {

/// Differences of colour between a textured surface and its original, in sRGB values of 0 to 255, mean over the channels and the
/// area.
struct AppearanceChange {
    double mean = 0;        ///< from the original's colour at the nearest point
    double resampling = 0;  ///< of the original's colours from their means over two texels: what a new image cannot keep either
    std::size_t samples = 0;
};

/// Compares the texture of `after` with that of `before` at `samples` points spread over the area of `after`. Both must show the
/// same object in the same position, with the images of `before`. `where`: file for messages. Time: O(n) for the search tree of
/// `before`. The result is the same for any number of threads. Throws Error (input) for an image that cannot be decoded.
AppearanceChange appearance_change(const MeshFile& before, const Mesh& after, const MeshExtras& after_extras,
                                   const std::string& where, std::size_t samples = 20000);

}  // namespace ostraka
