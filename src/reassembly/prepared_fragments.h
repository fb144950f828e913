// The prepared fragments of a collection, before they are grouped.
#pragma once

#include "ostraka/reassembly/reassembly.h"
#include "reassembly/pair_choice.h"

#include <memory>

namespace ostraka {

/// Fragments prepared for registration; fragments that cannot be matched are null.
class PreparedFragments {
public:
    /// Prepares each fragment. `alone` gets, for each fragment that cannot be matched, the reason.
    PreparedFragments(const std::vector<Fragment>& fragments, const ReassemblyOptions& options, const PairEffort& effort,
                      std::vector<std::string>& alone);

    /// Number of all fragments.
    [[nodiscard]] std::size_t count() const { return prepared_.size(); }
    /// Whether fragment `k` is matched with others.
    [[nodiscard]] bool has(std::size_t k) const { return prepared_[k] != nullptr; }
    [[nodiscard]] std::size_t matched_count() const;  ///< number of fragments that are matched with others
    [[nodiscard]] const PreparedFracture& operator[](std::size_t k) const { return *prepared_[k]; }
    /// One prepared fragment per fragment; null for a fragment that is not matched.
    [[nodiscard]] const std::vector<std::unique_ptr<PreparedFracture>>& prepared() const { return prepared_; }
    /// Mean of the vertices of fragment `k`.
    [[nodiscard]] const Eigen::Vector3d& middle(std::size_t k) const { return middle_[k]; }

    /// Distance within which the fractures of two fragments count as touching.
    [[nodiscard]] double tolerance(std::size_t a, std::size_t b) const;
    /// Whether two fragments may touch in these poses: their bounding spheres intersect.
    [[nodiscard]] bool near(std::size_t i, const Motion& pose_i, std::size_t j, const Motion& pose_j) const {
        return (pose_i(middle_[i]) - pose_j(middle_[j])).norm() < radius_[i] + radius_[j];
    }
    /// Whether two poses of fragment `k` in the frame of another fragment agree within the tolerance of a loop; `length` is the
    /// tolerance of distances.
    [[nodiscard]] bool agree(const Motion& x, const Motion& y, std::size_t k, double length) const;
    /// Tolerance of distances for a loop of three fragments.
    [[nodiscard]] double loop_length(std::size_t i, std::size_t j, std::size_t k) const;

private:
    void prepare(const Fragment& fragment, std::size_t k, std::string& alone);  ///< prepares fragment `k`
    /// Why a fragment with this fracture cannot be matched; empty: it can.
    [[nodiscard]] std::string fracture_problem(const PreparedFracture& fragment) const;

    const ReassemblyOptions& options_;
    const PairEffort& effort_;
    std::vector<std::unique_ptr<PreparedFracture>> prepared_;  ///< for each fragment, its prepared data; null: not matched
    std::vector<Eigen::Vector3d> middle_;                      ///< for each fragment, the mean of its vertices
    std::vector<double> radius_;  ///< for each fragment, the radius of its bounding sphere about the mean of its vertices
};

}  // namespace ostraka
