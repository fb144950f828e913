// Enforces hard constraints on measures by adjusting stretch factors of parts.
#pragma once

#include "semantic/statement.h"

#include <array>

namespace ostraka::semantic {

/// Parts with prescribed measures. Each part is attracted to a copy of itself that is stretched by a factor along its measure (or
/// scaled). The factors are the unknowns, so that nested parts, which cannot all be exact copies at once, also reach their
/// measures. A vertex belongs to the smallest part that contains it; parts inside others are stretched with them.
class Sizes {
public:
    /// `edited`: the shape after the edit; parts that the edit did not move start from the shape at rest.
    Sizes(std::vector<const Sized*> parts, const Shape& shape, const State& edited);

    [[nodiscard]] bool empty() const { return parts_.empty(); }  ///< true: no part has a prescribed measure
    /// Largest error of a measure: absolute value of the logarithm of the ratio of the measure to the required value.
    [[nodiscard]] double off(const State& now) const;
    /// Updates the factors from the result of the last factors (Broyden's method on the logarithms of the factors).
    void follow(const State& now);
    /// From now on accepts any value in a required range, not only the nearer end of the range, which other measures may not
    /// allow. Returns false if any value was accepted before.
    bool allow_whole_ranges();

    /// Stretched copy of a part.
    struct Copy {
        std::vector<int> ids;  ///< vertices of the part
        Points shape;          ///< target shape, up to a motion
        bool
            contains_parts;  ///< true: the part contains other parts with their own factors, so that it must be allowed to deform
    };
    [[nodiscard]] std::vector<Copy> copies() const;  ///< stretched copy of each part
    /// The linear map that stretches the surface around a vertex; the identity for vertices outside all parts.
    [[nodiscard]] const Eigen::Matrix3d& around(Index vertex) const;
    /// Vertices at joints that stay fixed: the anchors of parts that no other part contains.
    [[nodiscard]] std::vector<Index> anchors() const;

private:
    /// Logarithm of the ratio of each measure to its required value.
    [[nodiscard]] Eigen::VectorXd errors(const State& now) const;
    void renew_maps();  ///< updates maps_ from the factors

    std::vector<const Sized*> parts_;           ///< parts with prescribed measures
    std::vector<Points> start_;                 ///< for each part, its initial shape with the positions of all vertices
    std::vector<std::vector<std::size_t>> in_;  ///< for each part, the indices of the other parts that contain it
    std::vector<int> owner_;                    ///< for each vertex, the index of its part; -1: none
    std::vector<Eigen::Matrix3d> maps_;         ///< for each part, the linear map of its factors
    /// For each part, the range prescribed by a part that the edit leads; empty: its own range.
    std::vector<std::optional<std::pair<double, double>>> led_;
    /// For each part, whether the edit leaves the measure below its range (-1), above (1) or inside (0). The measure is moved to
    /// the nearer end of the range only.
    std::vector<int> side_;
    /// For each part, logarithms of the factor, of the error, and of the last change of the factor.
    Eigen::VectorXd factors_, errors_, step_;
    Eigen::MatrixXd slopes_;  ///< derivatives of the logarithms of the measures with respect to the logarithms of the factors
};

/// True if no shape satisfies the required ranges of a part and of a whole: all of the part's vertices belong to the whole, the
/// two axes are the same, and the part's minimum exceeds the whole's maximum.
bool contradict(const Sized& part, const Sized& whole, const State& state);

}  // namespace ostraka::semantic
