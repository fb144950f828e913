// Reassembles fragments of one or several objects along their fractures.
#pragma once

#include "ostraka/fracture/pair_registration.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

struct ReassemblyOptions {
    PairOptions pairs;
    double min_join = 0.8;  ///< min probability of a join between two groups
    int partners = 24;      ///< per fragment, number of best quick fits tried in full
    int min_faces = 100;    ///< a fragment with fewer faces shows no relief

    void describe(OptionList& visit);
};

/// All candidate poses of two fragments.
struct PairResult {
    std::size_t first = 0, second = 0;
    std::vector<PairCandidate> candidates;  ///< each maps the second fragment onto the first; most likely first
    double confidence = 0;
};

/// Two fragments that are joined.
struct FragmentJoin {
    std::size_t first = 0, second = 0;
    Motion pose;            ///< maps the second fragment onto the first, as placed in the group
    double pair = 0;        ///< probability from the two fragments alone
    double confidence = 0;  ///< probability including the evidence of the rest of the group
    std::size_t loops = 0;  ///< number of loops closed with a third fragment
    JoinEvidence evidence;  ///< for the poses in the group
    bool carries = false;   ///< edge of the spanning tree of the group
    std::string reason;     ///< explanation as text
};

/// A pose that is likely from two fragments alone, but was rejected.
struct RejectedJoin {
    std::size_t first = 0, second = 0;
    double pair = 0;
    std::string reason;
};

struct Reassembly {
    std::vector<Motion> poses;        ///< per fragment, into the frame of the largest fragment of its group
    std::vector<int> group;           ///< per fragment, largest group first; -1: not joined
    std::vector<std::string> alone;   ///< per fragment: why it is not joined; else empty
    std::vector<FragmentJoin> joins;  ///< by group, most certain first
    std::vector<RejectedJoin> undone;
    std::size_t pairs_tried = 0;
    std::size_t pairs_left = 0;  ///< with many fragments: number of pairs skipped for dissimilar fractures
    [[nodiscard]] int groups() const;
};

/// Cache of pair results. `recall` returns the result for a pair of indices and these options, or nothing if the pair must be
/// tried; `keep` stores the result of a pair. Called from several threads, one at a time.
struct PairMemory {
    std::function<std::optional<PairResult>(std::size_t, std::size_t, const PairOptions&)> recall;
    std::function<void(const PairResult&, const PairOptions&)> keep;
};

/// Each pair contributes all its candidates, not only the best. Candidates that close a loop with those of a third fragment
/// gain probability, as three wrong poses rarely agree. Groups are joined in order of certainty if no fragment lies inside
/// another; all other contacts of the join count as evidence for or against it. The poses of each group are refined together
/// (Ceres: point to plane between all fractures and rims that meet). Unrelated fragments stay single. Deterministic. Throws
/// Error (usage) without fragments.
Reassembly reassemble(const std::vector<Fragment>& fragments, const ReassemblyOptions& options = {},
                      const PairMemory& memory = {});

}  // namespace ostraka
