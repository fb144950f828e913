// Filling of texels outside charts.
#pragma once

#include "ostraka/image/image.h"

#include <cstdint>
#include <vector>

namespace ostraka::texture {

/// Fills the texels without a colour (`covered` is false): up to `gutter` texels from coloured ones with the nearest coloured texel,
/// further away from a pyramid of means (pull-push, Gortler et al. 1996). Without any coloured texel the image becomes grey.
void fill_empty(Pixels& pixels, std::vector<bool>& covered, int gutter);

}  // namespace ostraka::texture
