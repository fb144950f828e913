// Which pairs of a box are tried, and how thoroughly.
#pragma once

#include "ostraka/reassembly/reassembly.h"

#include <memory>

namespace ostraka {

using FragmentPairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// How thoroughly pairs are looked at among so many fragments.
struct PairEffort {
    bool all = true;           ///< few fragments: all pairs, with `first` only
    PairOptions prepared;      ///< with which fragments are prepared
    PairOptions first;         ///< with which pairs are tried
    std::size_t partners = 0;  ///< of each fragment, that are tried
    PairOptions thorough;      ///< for those that the first look leaves open
    std::size_t most_thorough = 0;
};

/// Of up to `partners` + 1 fragments all pairs are tried, with all that the options ask for. Of more the work is bounded: a first
/// look with fewer starts, and, from a hundred fragments on, fewer places, at the pairs that fit best quickly; the thorough one
/// at so many of those that it leaves open. All numbers depend on that of the fragments only.
PairEffort effort_among(std::size_t fragments, const ReassemblyOptions& options);

/// Pairs to be tried, in order. Of many fragments those of which one is among the partners that the other quickly fits best with;
/// compared are those whose breaks are most nearly as wide. `fragments`: null where one takes no part.
FragmentPairs promising_pairs(const std::vector<std::unique_ptr<PreparedBreak>>& fragments, const PairEffort& effort);

}  // namespace ostraka
