// Selects the pairs of fragments to register, and the effort for each pair.
#pragma once

#include "ostraka/reassembly/reassembly.h"

#include <memory>

namespace ostraka {

using FragmentPairs = std::vector<std::pair<std::size_t, std::size_t>>;  ///< pairs of fragment indices

/// Effort of the search for joins, which depends on the number of fragments.
struct PairEffort {
    bool all_pairs = true;         ///< true for few fragments: all pairs are registered, with `first` only
    PairOptions prepared;          ///< options for preparing the fragments
    PairOptions first;             ///< options for the first registration of each pair
    std::size_t partners = 0;      ///< for each fragment, number of partners with which it is registered
    PairOptions thorough;          ///< options for registering again the pairs that the first registration leaves undecided
    std::size_t max_thorough = 0;  ///< max number of pairs that are registered again
};

/// Up to `partners` + 1 fragments: all pairs are registered, with the given options. More fragments: the work is bounded. Then
/// the pairs with the best quick fit are registered with fewer starts and, from a hundred fragments on, fewer frames; a bounded
/// number of the pairs that stay undecided is registered thoroughly. All limits depend on the number of fragments only.
PairEffort pair_effort(std::size_t fragments, const ReassemblyOptions& options);

/// Pairs to register, in order. With many fragments: pairs in which one fragment is among the best quick fits of the other; only
/// fractures of similar width are compared. `fragments`: null for a fragment that takes no part.
FragmentPairs promising_pairs(const std::vector<std::unique_ptr<PreparedFracture>>& fragments, const PairEffort& effort);

}  // namespace ostraka
