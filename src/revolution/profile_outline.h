// Where the wall is, by radius and height, and the outline of it.
#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

namespace ostraka::detail {

/// A curve around the wall right of the axis, the wall on its left: from the axis to the axis, or closed.
struct Outline {
    std::vector<Eigen::Vector2d> points;  ///< radius, height
    bool closed = false;                  ///< the wall does not reach the axis
};

/// Square cells: rows are heights, columns radii from the axis on.
struct ProfileImage {
    double step = 0;
    std::size_t rows = 0, columns = 0;
    std::vector<double> wall_share;  ///< share of the rays that meet anything that is inside the wall
    std::vector<double> present;     ///< rays that meet anything, of each row

    void add(std::size_t row, double from, double to);
    void clear(std::size_t row);
    /// In a row from `first` to before `end`.
    [[nodiscard]] bool reaches_axis(std::size_t first, std::size_t end) const;
    /// Rows without wall between others get the wall between those, straight.
    void bridge(std::vector<std::string>* notes);
    /// Gaussian of a standard deviation in cells, mirrored at the axis.
    void smooth(double deviation);
    /// The level line of one half of the largest piece (marching squares).
    [[nodiscard]] Outline outline() const;

private:
    [[nodiscard]] double at(long row, long column) const;
};

/// `count` points evenly along the curve (of an open one both ends too).
std::vector<Eigen::Vector2d> resampled(const std::vector<Eigen::Vector2d>& line, bool closed, int count);

}  // namespace ostraka::detail
