// Detects suspicious fragments in a collection: copies, mirror images, other units.
#pragma once

#include "ostraka/fracture/fragment.h"

#include <string>
#include <vector>

namespace ostraka {

struct SuspiciousFragment {
    std::size_t fragment = 0;
    std::string text;       ///< description, e.g. "is a copy of pot-3"
    bool left_out = false;  ///< excluded, since it would be joined with the fragment of which it is a copy
};

/// A fragment whose face areas equal those of another fragment, face by face, to 1e-4 is a copy of it (moved or not), or its
/// mirror image if the best-fitting motion turns one inside out relative to the other. A fragment may be in another unit if its
/// size is near 10, 25.4, 100, 304.8 or 1000 times larger or smaller than the median and differs from it by a factor of more
/// than eight, or of more than five if the width of its fracture differs as much from the median width. A fragment with a
/// negative enclosed volume is inside out. In O(n log n) over fragments and O(faces).
std::vector<SuspiciousFragment> suspicious_fragments(const std::vector<Fragment>& fragments);

}  // namespace ostraka
