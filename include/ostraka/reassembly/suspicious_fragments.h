// Detects suspicious fragments in a collection: copies, mirror images, other units.
#pragma once

#include "ostraka/fracture/fragment.h"

#include <string>
#include <vector>

namespace ostraka {

/// A fragment that may not belong in the collection as it is.
struct SuspiciousFragment {
    std::size_t fragment = 0;  ///< index of the fragment
    std::string text;          ///< suspicion as text, e.g. "is a copy of pot-3"
    bool left_out = false;     ///< true if the fragment is excluded from reassembly, since it would be joined with its original
};

/// Detects copies, mirror images, fragments in other units and fragments that are inside out. A fragment whose face areas equal
/// the face areas of another fragment, face by face, to a relative 1e-4 is a copy of that fragment (moved or not), or a mirror
/// image if the best-fitting motion leaves one of the two inside out. A fragment may be in another unit if its size is near 10,
/// 25.4, 100, 304.8 or 1000 times larger or smaller than the median size and differs from the median by a factor of more than
/// eight, or of more than five if the width of its fracture differs as much from the median width. A fragment with a negative
/// enclosed volume is inside out. In O(n log n) over fragments and O(faces).
std::vector<SuspiciousFragment> suspicious_fragments(const std::vector<Fragment>& fragments);

}  // namespace ostraka
