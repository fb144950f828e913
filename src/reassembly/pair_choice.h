// Selects the pairs of a collection to try, and the effort for each.
#pragma once

#include "ostraka/reassembly/reassembly.h"

#include <memory>

namespace ostraka {

using FragmentPairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// Effort of the search, by the number of fragments.
struct PairEffort {
    bool all_pairs = true;     ///< few fragments: all pairs, with `first` only
    PairOptions prepared;      ///< options for preparing the fragments
    PairOptions first;         ///< options for trying the pairs
    std::size_t partners = 0;  ///< per fragment, number of partners that are tried
    PairOptions thorough;      ///< options for the pairs that the first attempt leaves open
    std::size_t max_thorough = 0;
};

/// Up to `partners` + 1 fragments: all pairs, with the given options. More fragments: the work is bounded. The pairs with the
/// best quick fit are tried with fewer starts and, from a hundred fragments on, fewer frames; a bounded number of those that
/// stay open is tried thoroughly. All limits depend on the number of fragments only.
PairEffort pair_effort(std::size_t fragments, const ReassemblyOptions& options);

/// Pairs to try, in order. With many fragments: pairs in which one is among the best quick fits of the other; only fractures of
/// similar width are compared. `fragments`: null for a fragment that takes no part.
FragmentPairs promising_pairs(const std::vector<std::unique_ptr<PreparedFracture>>& fragments, const PairEffort& effort);

}  // namespace ostraka
