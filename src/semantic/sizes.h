// Measures that must hold, enforced by their values.
#pragma once

#include "statement.h"

#include <array>

namespace ostraka::semantic {

/// Parts that must have certain measures. Each part tends to a copy of itself that is stretched by a factor along its measure
/// (or scaled), and the factors are what is searched for: so parts within parts, which cannot all be such copies at once, come to
/// their measures too. A vertex belongs to the smallest part that holds it; parts within others are stretched with those.
class Sizes {
public:
    /// `edited` as the edit leaves the shape; parts that it did not ask to change start from the shape at rest.
    Sizes(std::vector<const Sized*> parts, const Shape& shape, const State& edited);

    [[nodiscard]] bool empty() const { return parts_.empty(); }
    /// How far the worst measure is out of its range, as the logarithm of what it would have to grow by.
    [[nodiscard]] double off(const State& now) const;
    /// Better factors from what the last ones led to (Broyden's method on their logarithms).
    void follow(const State& now);
    /// From now on any value in a range will do, not only its nearer end, which other measures may not allow. False if it did
    /// already.
    bool allow_whole_ranges();

    struct Copy {
        std::vector<int> ids;
        Points shape;       ///< that they are to have, up to a motion
        bool holds_others;  ///< parts within it go their own ways, so that it has to give
    };
    [[nodiscard]] std::vector<Copy> copies() const;
    /// What stretches the surface around a vertex; the identity outside all parts.
    [[nodiscard]] const Eigen::Matrix3d& around(Index vertex) const;
    /// Joints that stay where they are: those of parts that are in no other part.
    [[nodiscard]] std::vector<Index> anchors() const;

private:
    [[nodiscard]] Eigen::VectorXd errors(const State& now) const;
    void renew_maps();

    std::vector<const Sized*> parts_;
    std::vector<Points> start_;                 ///< shape that each part is stretched from, of all vertices
    std::vector<std::vector<std::size_t>> in_;  ///< other parts that hold each
    std::vector<int> owner_;                    ///< of each vertex, -1 for none
    std::vector<Eigen::Matrix3d> maps_;
    std::vector<std::optional<std::pair<double, double>>> led_;  ///< ranges that a part gives that the edit leads
    /// Whether the edit leaves the measure below its range (-1), above (1), or in it (0): it comes to the nearer end, no farther.
    std::vector<int> side_;
    Eigen::VectorXd factors_, errors_, step_;  ///< logarithms
    Eigen::MatrixXd slopes_;                   ///< of measures by factors
};

/// Whether no shape can have both: all of the part's vertices are the whole's, along the same axis, and more is asked of the part
/// than the whole may have.
bool contradict(const Sized& part, const Sized& whole, const State& state);

}  // namespace ostraka::semantic
