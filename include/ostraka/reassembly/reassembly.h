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
    int partners = 24;      ///< for each fragment, number of partners with the best quick fit that are registered in full
    int min_faces = 100;    ///< min number of faces of a fragment that is matched: a fragment with fewer shows no relief

    void list_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// All candidate poses of a pair of fragments.
struct PairResult {
    std::size_t first = 0, second = 0;      ///< indices of the two fragments
    std::vector<PairCandidate> candidates;  ///< each pose maps the second fragment onto the first; most likely candidate first
    double confidence = 0;                  ///< probability that the most likely candidate is right
};

/// Two fragments that are joined.
struct FragmentJoin {
    std::size_t first = 0, second = 0;  ///< indices of the two fragments
    Motion pose;                        ///< maps the second fragment onto the first, as placed in the group
    double pair = 0;                    ///< probability of the join from the two fragments alone
    double confidence = 0;              ///< probability of the join including the evidence of the rest of the group
    std::size_t loops = 0;              ///< number of loops of joins closed with a third fragment
    JoinEvidence evidence;              ///< features of the join, for the poses in the group
    bool carries = false;               ///< true if the join is an edge of the spanning tree of the group
    std::string reason;                 ///< evidence for the join, as text
};

/// A pose that is likely from two fragments alone, but was rejected.
struct RejectedJoin {
    std::size_t first = 0, second = 0;  ///< indices of the two fragments
    double pair = 0;                    ///< probability of the pose from the two fragments alone
    std::string reason;                 ///< why the pose was rejected, as text
};

/// Groups of joined fragments with their poses.
struct Reassembly {
    std::vector<Motion> poses;         ///< for each fragment, the motion into the frame of the largest fragment of its group
    std::vector<int> group;            ///< for each fragment, the index of its group (largest group first); -1: not joined
    std::vector<std::string> alone;    ///< for each fragment, why it is not joined; empty if it is joined
    std::vector<FragmentJoin> joins;   ///< ordered by group, then by descending confidence
    std::vector<RejectedJoin> undone;  ///< likely poses that were rejected
    std::size_t pairs_tried = 0;       ///< number of pairs of fragments that were registered
    /// Number of pairs that were skipped for dissimilar fractures, which happens with many fragments only.
    std::size_t pairs_left = 0;
    [[nodiscard]] int groups() const;  ///< number of groups
};

/// Cache of pair results. The functions are called from several threads, one call at a time.
struct PairMemory {
    /// Returns the stored result for two fragments (by index) and these options; empty: the pair must be registered.
    std::function<std::optional<PairResult>(std::size_t, std::size_t, const PairOptions&)> recall;
    /// Stores the result of a pair.
    std::function<void(const PairResult&, const PairOptions&)> keep;
};

/// Reassembles fragments. Each pair of fragments contributes all its candidate poses, not only the most likely one. Candidates
/// that close a loop with candidates of a third fragment gain probability, as three wrong poses rarely agree. Groups are joined
/// in descending order of probability if no fragment lies inside another; all other contacts of the join count as evidence for or
/// against the join. The poses of each group are refined together (Ceres: point to plane between all fractures and rims that
/// meet). Unrelated fragments stay single. The result is deterministic. Throws Error (usage) if there are no fragments.
Reassembly reassemble(const std::vector<Fragment>& fragments, const ReassemblyOptions& options = {},
                      const PairMemory& memory = {});

}  // namespace ostraka
