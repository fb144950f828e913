// The prepared fragments of a collection, before they are grouped.
#pragma once

#include "ostraka/reassembly/reassembly.h"
#include "reassembly/pair_choice.h"

#include <memory>

namespace ostraka {

class PreparedFragments {
public:
    /// `alone` gets the reason why a fragment cannot be matched.
    PreparedFragments(const std::vector<Fragment>& fragments, const ReassemblyOptions& options, const PairEffort& effort,
                      std::vector<std::string>& alone);

    [[nodiscard]] std::size_t count() const { return prepared_.size(); }
    /// Whether a fragment takes part.
    [[nodiscard]] bool has(std::size_t k) const { return prepared_[k] != nullptr; }
    [[nodiscard]] std::size_t taking_part() const;
    [[nodiscard]] const PreparedFracture& operator[](std::size_t k) const { return *prepared_[k]; }
    [[nodiscard]] const std::vector<std::unique_ptr<PreparedFracture>>& prepared() const { return prepared_; }
    /// Mean of the vertices.
    [[nodiscard]] const Eigen::Vector3d& middle(std::size_t k) const { return middle_[k]; }

    /// Distance within which two fractures count as touching.
    [[nodiscard]] double tolerance(std::size_t a, std::size_t b) const;
    /// Whether two fragments may touch in these poses.
    [[nodiscard]] bool near(std::size_t i, const Motion& pose_i, std::size_t j, const Motion& pose_j) const {
        return (pose_i(middle_[i]) - pose_j(middle_[j])).norm() < radius_[i] + radius_[j];
    }
    /// Whether two poses of fragment `k` in the frame of another fragment are equal within the tolerance of a loop.
    [[nodiscard]] bool agree(const Motion& x, const Motion& y, std::size_t k, double length) const;
    [[nodiscard]] double loop_length(std::size_t i, std::size_t j, std::size_t k) const;

private:
    void prepare(const Fragment& fragment, std::size_t k, std::string& alone);
    [[nodiscard]] std::string fracture_problem(const PreparedFracture& fragment) const;

    const ReassemblyOptions& options_;
    const PairEffort& effort_;
    std::vector<std::unique_ptr<PreparedFracture>> prepared_;
    std::vector<Eigen::Vector3d> middle_;
    std::vector<double> radius_;  ///< about the middle
};

}  // namespace ostraka
