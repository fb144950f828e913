// The turns of all sherds of a vessel at once.
#pragma once

#include "rotational_pairs.h"

#include <vector>

namespace ostraka {

/// What is known of all pairs: of i < j the turn of j against i.
class TurnPairs {
public:
    TurnPairs(std::size_t count, std::vector<TurnPair> pairs) : count_(count), pairs_(std::move(pairs)) {}
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] const TurnPair& of(std::size_t i, std::size_t j) const {
        return pairs_[std::min(i, j) * count_ + std::max(i, j)];
    }
    /// The turn between two as the pair has it.
    [[nodiscard]] static double between(std::size_t i, std::size_t j, double turn_i, double turn_j) {
        return i < j ? turn_j - turn_i : turn_i - turn_j;
    }
    [[nodiscard]] double value(std::size_t i, std::size_t j, double turn_i, double turn_j) const {
        return of(i, j).value(between(i, j, turn_i, turn_j));
    }

private:
    std::size_t count_;
    std::vector<TurnPair> pairs_;  ///< count x count, of which i < j counts
};

struct TurnAssembly {
    std::vector<double> turns;  ///< of each sherd
    std::vector<bool> joined;   ///< meets others where it is
    double value = 0;
};

/// The turns of largest sum over all pairs, from `root` and those `fixed` (at 0) on: at each step one more sherd comes to the
/// best assemblies so far (a beam search). What meets none stands where it shares least surface with the others.
TurnAssembly assemble_turns(const TurnPairs& pairs, const std::vector<bool>& fixed, std::size_t root, int beam);

/// Turns the sherds marked against all others: the value of all pairs across at the turns as they are, and the most that meets at
/// any turn that is another one, be there room for it or not.
struct TurnLead {
    double here = 0, elsewhere = 0;
};
TurnLead lead_of(const TurnPairs& pairs, const std::vector<double>& turns, const std::vector<bool>& counts,
                 const std::vector<bool>& side, int steps);

/// The turn of one sherd at which it shares least surface with the others that count.
double free_turn(const TurnPairs& pairs, const std::vector<double>& turns, const std::vector<bool>& counts, std::size_t sherd,
                 double& shared);

}  // namespace ostraka
