// Detects fragments in a collection that are probably wrong data: copies, mirror images, other units.
#pragma once

#include "ostraka/fracture/fragment.h"

#include <string>
#include <vector>

namespace ostraka {

/// A fragment that is probably wrong data.
struct SuspiciousFragment {
    std::size_t fragment = 0;  ///< index of the fragment
    std::string text;          ///< suspicion as text, e.g. "is a copy of pot-3"
    /// True if the fragment is excluded from reassembly, because it is a copy and would be joined with its original.
    bool left_out = false;
};

/// Detects copies, mirror images, fragments in other units and fragments that are inside out. A fragment is a copy of another
/// fragment if their face areas agree, face by face, to a relative 1e-4; it is a mirror image if the best-fitting motion
/// includes a reflection. A fragment may be in another unit if its size is near 10, 25.4, 100, 304.8 or 1000 times larger or
/// smaller than the median size and differs from the median by a factor of more than eight, or of more than five if the width
/// of its fracture differs as much from the median width. A fragment with a negative enclosed volume is inside out. Time: O(n
/// log n) for n fragments, plus linear in the number of faces.
std::vector<SuspiciousFragment> suspicious_fragments(const std::vector<Fragment>& fragments);

}  // namespace ostraka
