// The rotations of all sherds of a vessel at once.
#pragma once

#include "rotational_pairs.h"

#include <vector>

namespace ostraka {

/// What is known of all pairs: of i < j the rotation of j against i.
class RotationPairs {
public:
    RotationPairs(std::size_t count, std::vector<RotationPair> pairs) : count_(count), pairs_(std::move(pairs)) {}
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] const RotationPair& of(std::size_t i, std::size_t j) const {
        return pairs_[std::min(i, j) * count_ + std::max(i, j)];
    }
    /// The rotation between two as the pair has it.
    [[nodiscard]] static double between(std::size_t i, std::size_t j, double rotation_i, double rotation_j) {
        return i < j ? rotation_j - rotation_i : rotation_i - rotation_j;
    }
    [[nodiscard]] double value(std::size_t i, std::size_t j, double rotation_i, double rotation_j) const {
        return of(i, j).value(between(i, j, rotation_i, rotation_j));
    }

private:
    std::size_t count_;
    std::vector<RotationPair> pairs_;  ///< count x count, of which i < j counts
};

struct RotationAssembly {
    std::vector<double> rotations;  ///< of each sherd
    std::vector<bool> joined;       ///< meets others where it is
    double value = 0;
};

/// The rotations of largest sum over all pairs, from `root` and those `fixed` (at 0) on: at each step one more sherd comes to the
/// best assemblies so far (a beam search). What meets none stands where it shares least surface with the others.
RotationAssembly assemble_rotations(const RotationPairs& pairs, const std::vector<bool>& fixed, std::size_t root, int beam);

/// Rotates the sherds marked against all others: the value of all pairs across at the rotations as they are, and the most that
/// meets at any rotation that is another one, be there room for it or not.
struct RotationLead {
    double here = 0, elsewhere = 0;
};
RotationLead lead_of(const RotationPairs& pairs, const std::vector<double>& rotations, const std::vector<bool>& counts,
                     const std::vector<bool>& side, int steps);

/// The rotation of one sherd at which it shares least surface with the others that count.
double least_shared_rotation(const RotationPairs& pairs, const std::vector<double>& rotations, const std::vector<bool>& counts,
                             std::size_t sherd, double& shared);

}  // namespace ostraka
