// Fragments of a box that cannot be what they seem: copies, mirror images, other units.
#pragma once

#include "ostraka/fracture/fragment.h"

#include <string>
#include <vector>

namespace ostraka {

struct OddFragment {
    std::size_t fragment = 0;
    std::string text;       ///< e.g. "is a copy of pot-3"
    bool left_out = false;  ///< it would be joined with what it is a copy of
};

/// A fragment whose faces have the areas of another's, one after the other, to 1e-4 is a copy of it (moved or not), or its mirror
/// image where the two are turned inside out against each other by the motion that fits best. One that is more than eight times
/// larger or smaller than the median of all in length, or more than five times, and its break as much wider or narrower than the
/// median of breaks, and near 10, 25.4, 100, 304.8 or 1000 times, may be in another unit. One
/// that encloses a negative volume is inside out. In O(n log n) over fragments and O(faces).
std::vector<OddFragment> odd_fragments(const std::vector<Fragment>& fragments);

}  // namespace ostraka
