// Texts of the options of pictures, parsed.
#pragma once

#include "ostraka/render/render.h"

#include <vector>

namespace ostraka::detail {

struct Size {
    int width, height;  ///< pixels
};

/// The size of a picture from a text such as "1200x900". Throws Error (usage) for any other text.
Size parse_size(const std::string& text);

/// The views of `views`, or else the one of `view`. Throws Error (usage) for a view that does not exist.
std::vector<View> views_of(const RenderOptions& options);

}  // namespace ostraka::detail
