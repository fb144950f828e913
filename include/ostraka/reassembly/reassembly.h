// Reassembles fragments of one or several objects along their fractures.
#pragma once

#include "ostraka/fracture/pair_registration.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

struct ReassemblyOptions {
    PairOptions pairs;      ///< options for registering two fragments
    double min_join = 0.8;  ///< min probability at which two groups are joined
    /// For each fragment, number of other fragments (those with the highest initial_pair_score) with which it is registered.
    int partners = 24;
    int min_faces = 100;  ///< fragments with fewer faces are not matched, because their fracture surfaces show no relief

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// All candidate poses of a pair of fragments.
struct PairResult {
    std::size_t first = 0, second = 0;      ///< indices of the two fragments
    std::vector<PairCandidate> candidates;  ///< each pose maps the second fragment onto the first; most likely candidate first
    double confidence = 0;                  ///< probability that the most likely candidate is correct
};

/// Two fragments that are joined.
struct FragmentJoin {
    std::size_t first = 0, second = 0;  ///< indices of the two fragments
    Motion pose;                        ///< maps the second fragment onto the first, as placed in the group
    double pair_probability = 0;        ///< probability of the join, computed from the two fragments alone
    double confidence = 0;              ///< probability of the join, computed with the evidence of all fragments of the group
    std::size_t loops = 0;              ///< number of loops that this join closes together with two joins of a third fragment
    JoinEvidence evidence;              ///< features of the join, for the poses in the group
    bool carries = false;               ///< true if the join is an edge of the spanning tree of the group
    std::string reason;                 ///< evidence for the join, as text
};

/// A pose that is likely when only the two fragments are considered, but was rejected.
struct RejectedJoin {
    std::size_t first = 0, second = 0;  ///< indices of the two fragments
    double pair_probability = 0;        ///< probability of the pose, computed from the two fragments alone
    std::string reason;                 ///< why the pose was rejected, as text
};

/// Groups of joined fragments with their poses.
struct Reassembly {
    std::vector<Motion> poses;  ///< for each fragment, the motion into the frame of the largest fragment of its group
    std::vector<int> group;     ///< for each fragment, the index of its group (largest group first); -1: not joined
    std::vector<std::string> reasons_not_joined;  ///< for each fragment, why it is not joined; empty if it is joined
    std::vector<FragmentJoin> joins;              ///< ordered by group, then by descending confidence
    std::vector<RejectedJoin> rejected;           ///< likely poses that were rejected
    std::size_t pairs_tried = 0;                  ///< number of pairs of fragments that were registered
    /// Number of pairs that were skipped because their fractures are dissimilar; pairs are skipped only if there are many
    /// fragments.
    std::size_t pairs_left = 0;
    [[nodiscard]] int groups() const;  ///< number of groups
};

/// Cache of pair results. The functions are called from several threads, one call at a time.
struct PairMemory {
    /// Returns the stored result for two fragments (by index) and these options; empty: the pair must be registered.
    std::function<std::optional<PairResult>(std::size_t, std::size_t, const PairOptions&)> load;
    /// Stores the result of a pair.
    std::function<void(const PairResult&, const PairOptions&)> store;
};

/// Reassembles fragments. Each pair of fragments contributes all its candidate poses, not only the most likely one. If the
/// poses of three fragments agree around a loop, their probability is increased, because three wrong poses rarely agree. Groups
/// are joined in descending order of probability if no fragment lies inside another; all other contacts that result from the
/// join are evidence for or against it. The poses of each group are refined together (Ceres: point to plane between all
/// fractures and rims that meet). Unrelated fragments are not joined. The result is deterministic. Throws Error (usage) if
/// there are no fragments.
Reassembly reassemble(const std::vector<Fragment>& fragments, const ReassemblyOptions& options = {},
                      const PairMemory& memory = {});

}  // namespace ostraka
