// The wall of a vessel or sherd about the z axis: where it is, at each height and in each direction.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka::detail {

/// Distances of the wall from the axis, sampled at equal heights and in equal angles. NaN: no wall is met.
class WallGrid {
public:
    static constexpr std::size_t bins = 360;  ///< directions, one degree each

    /// Slices the mesh, whose axis is the z axis, with `rows` planes. Surfaces that face away from the axis are outer, surfaces
    /// that face towards it are inner; surfaces along a radius (fractures) are neither.
    WallGrid(const Mesh& mesh, std::size_t rows);

    [[nodiscard]] std::size_t rows() const { return heights_.size(); }
    [[nodiscard]] double height(std::size_t row) const { return heights_[row]; }  ///< height of a row
    [[nodiscard]] double step() const { return step_; }                           ///< distance of two rows
    [[nodiscard]] double low() const { return low_; }                             ///< lowest height of the mesh
    [[nodiscard]] double high() const { return high_; }                           ///< highest height of the mesh
    /// Largest distance of an outer surface from the axis in a direction, and of an inner surface.
    [[nodiscard]] double outer(std::size_t row, std::size_t bin) const { return outer_[row * bins + bin]; }
    [[nodiscard]] double inner(std::size_t row, std::size_t bin) const { return inner_[row * bins + bin]; }
    [[nodiscard]] bool wall(std::size_t row, std::size_t bin) const;  ///< true if there is an outer or an inner surface

    /// Share of the directions in which the outer surface is met at this height.
    [[nodiscard]] double coverage(std::size_t row) const;
    /// Share of the directions in which an inner surface is met at this height.
    [[nodiscard]] double hollow(std::size_t row) const;
    /// Median distance of the outer surface over the directions that `used` selects (all, if empty); NaN without surface.
    [[nodiscard]] double radius(std::size_t row, const std::vector<bool>& used = {}) const;
    /// Median distance of the inner surface; NaN without surface.
    [[nodiscard]] double inner_radius(std::size_t row) const;
    /// For each direction, the highest (or lowest) row with wall; -1: there is no wall.
    [[nodiscard]] std::vector<long> ends(bool top) const;
    /// Points (x, y) of the outer surface at a height, in the order of the directions.
    [[nodiscard]] std::vector<Eigen::Vector2d> arc(std::size_t row) const;

private:
    double low_ = 0, high_ = 0, step_ = 0;
    std::vector<double> heights_, outer_, inner_;
};

/// A range of directions around the axis: from `start` counter-clockwise over `angle`, radians.
struct AngularRange {
    double start = 0, angle = 0;
    [[nodiscard]] double middle() const { return start + angle / 2; }
};
/// The smallest range that holds all directions with wall: the circle without its widest gap.
AngularRange occupied(const WallGrid& grid);

}  // namespace ostraka::detail
