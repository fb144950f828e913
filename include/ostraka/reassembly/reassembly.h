// Fragments of one or several objects put together again by their breaks.
#pragma once

#include "ostraka/fracture/break_pair.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

struct ReassemblyOptions {
    PairOptions pairs;
    double min_join = 0.8;  ///< probability from which two groups are joined
    int partners = 24;      ///< of each fragment, those it quickly fits best with are tried in full, of those most nearly as wide
    int min_faces = 100;    ///< a fragment of fewer shows no relief

    void describe(OptionList& visit);
};

/// All poses found for two fragments.
struct PairOfMany {
    std::size_t first = 0, second = 0;
    std::vector<PairCandidate> candidates;  ///< second onto first, most likely first
    double confidence = 0;
};

/// Two fragments that meet.
struct FragmentJoin {
    std::size_t first = 0, second = 0;
    Motion pose;            ///< second onto first, where they are in the group
    double pair = 0;        ///< probability by the two alone
    double confidence = 0;  ///< with what the rest of the group says
    std::size_t loops = 0;  ///< closed with a third fragment
    JoinEvidence evidence;  ///< as they lie in the group
    bool carries = false;   ///< of the tree that holds the group together
    std::string reason;     ///< in words
};

/// A pose that is likely by two fragments alone, and was not taken.
struct UndoneJoin {
    std::size_t first = 0, second = 0;
    double pair = 0;
    std::string reason;
};

struct Reassembly {
    std::vector<Motion> poses;        ///< of each fragment, into the frame of the largest of its group
    std::vector<int> group;           ///< of each fragment, largest group first; -1: joined to none
    std::vector<std::string> alone;   ///< of each fragment: why it is joined to none; else empty
    std::vector<FragmentJoin> joins;  ///< by group, surest first
    std::vector<UndoneJoin> undone;
    std::size_t pairs_tried = 0;
    std::size_t pairs_left = 0;  ///< of many fragments: pairs that were not tried, their breaks being unlike
    [[nodiscard]] int groups() const;
};

/// What was found of pairs before, by their numbers and with these options; nothing: they are tried. And what to do with one that
/// was tried. Called from several threads, one at a time.
struct PairMemory {
    std::function<std::optional<PairOfMany>(std::size_t, std::size_t, const PairOptions&)> recall;
    std::function<void(const PairOfMany&, const PairOptions&)> keep;
};

/// All pairs give candidates, not only their best. Candidates that close a loop with those of a third fragment get surer: three
/// poses of chance hardly agree. The surest first, groups are joined where nothing lies inside anything else; what else then
/// touches counts for or against it. Each group's poses are refined together (Ceres: point to plane between all fractures and
/// rims that meet). Fragments of strangers stay alone. No chance is involved. Throws Error (usage) without fragments.
Reassembly reassemble(const std::vector<Fragment>& fragments, const ReassemblyOptions& options = {},
                      const PairMemory& memory = {});

}  // namespace ostraka
