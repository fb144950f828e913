// Enforces hard constraints on measures by adjusting stretch factors.
#pragma once

#include "semantic/statement.h"

#include <array>

namespace ostraka::semantic {

/// Parts with prescribed measures. Each part is attracted to a copy of itself that is stretched by a factor along its measure
/// (or scaled). The factors are the unknowns, so that nested parts, which cannot all be such copies at once, also reach their
/// measures. A vertex belongs to the smallest part that contains it; parts inside others are stretched with them.
class Sizes {
public:
    /// `edited`: the shape after the edit; parts that the edit did not move start from the shape at rest.
    Sizes(std::vector<const Sized*> parts, const Shape& shape, const State& edited);

    [[nodiscard]] bool empty() const { return parts_.empty(); }
    /// Largest error of a measure: the absolute value of the logarithm of its ratio to the required value.
    [[nodiscard]] double off(const State& now) const;
    /// Updates the factors from the result of the last ones (Broyden's method on their logarithms).
    void follow(const State& now);
    /// From now on any value in a range will do, not only its nearer end, which other measures may not allow. False if it did
    /// already.
    bool allow_whole_ranges();

    struct Copy {
        std::vector<int> ids;
        Points shape;       ///< target shape, up to a motion
        bool holds_others;  ///< contains other parts with their own factors, so that it must be allowed to deform
    };
    [[nodiscard]] std::vector<Copy> copies() const;
    /// The linear map that stretches the surface around a vertex; the identity outside all parts.
    [[nodiscard]] const Eigen::Matrix3d& around(Index vertex) const;
    /// Joints that stay fixed: those of parts that are in no other part.
    [[nodiscard]] std::vector<Index> anchors() const;

private:
    [[nodiscard]] Eigen::VectorXd errors(const State& now) const;
    void renew_maps();

    std::vector<const Sized*> parts_;
    std::vector<Points> start_;                 ///< initial shape of each part, with all vertices
    std::vector<std::vector<std::size_t>> in_;  ///< for each part, the other parts that contain it
    std::vector<int> owner_;                    ///< part of each vertex; -1 for none
    std::vector<Eigen::Matrix3d> maps_;
    std::vector<std::optional<std::pair<double, double>>> led_;  ///< ranges prescribed by a part that the edit leads
    /// Whether the edit leaves the measure below its range (-1), above it (1) or inside (0). The measure is moved to the nearer
    /// end of the range only.
    std::vector<int> side_;
    Eigen::VectorXd factors_, errors_, step_;  ///< logarithms
    Eigen::MatrixXd slopes_;                   ///< derivatives of the measures by the factors
};

/// True if no shape satisfies both: all of the part's vertices belong to the whole, the axes are the same, and the part's
/// minimum exceeds the whole's maximum.
bool contradict(const Sized& part, const Sized& whole, const State& state);

}  // namespace ostraka::semantic
