// Cuts one polygon in space into triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ostraka::io {

/// How a polygon was cut, when not cleanly.
enum class CutResult : std::uint8_t { clean, crossing, gave_up };

/// Keeps its working arrays between polygons.
class PolygonCutter {
public:
    using Triple = std::array<std::uint32_t, 3>;  ///< positions in the list of corners

    /// Appends the triangles over `points[corners[i]]`, i in [0, count), to `triangles`, all with the polygon's orientation.
    /// No triangle names a vertex twice. Quadrilaterals are cut along the shorter diagonal that keeps both triangles upright
    /// (the one at the first corner if equal), strictly convex polygons into a fan from the first corner, those of more than a
    /// thousand corners by halving (every second corner, then every fourth, ...), all others by
    /// clipping ears (Meisters 1975) in the coordinate plane that shows them best; the corners that could lie in an ear are
    /// found with a grid, which makes the time near linear in practice. `crossing`: no ear was left, so triangles overlap.
    /// `gave_up`: a budget of a million tests (twenty million for many corners) and 200 a corner was spent, one in exact
    /// arithmetic counting as 16, and the rest is halved. Works in O(count) memory.
    CutResult cut(const std::vector<std::array<double, 3>>& points, const std::uint32_t* corners, std::size_t count,
                  std::vector<Triple>& triangles);

private:
    using Point2 = std::array<double, 2>;
    void drop_repeated(const std::uint32_t* corners, std::size_t count);
    void project(const std::vector<std::array<double, 3>>& points, const std::uint32_t* corners);
    bool is_strictly_convex() const;
    void cut_quadrilateral(const std::vector<std::array<double, 3>>& points, const std::uint32_t* corners,
                           std::vector<Triple>& triangles);
    CutResult clip_ears(const std::uint32_t* corners, std::vector<Triple>& triangles);
    void build_grid(std::uint32_t start);
    void halve(std::vector<std::uint32_t> ring, const std::uint32_t* corners, std::vector<Triple>& triangles) const;
    int turn(const Point2& a, const Point2& b, const Point2& c);
    bool is_ear(std::uint32_t previous, std::uint32_t tip, std::uint32_t next);
    std::array<std::size_t, 2> cell_of(const Point2& point) const;

    std::vector<std::uint32_t> kept_;  ///< positions of corners that differ from the one before
    std::vector<Point2> flat_;         ///< of kept corners, scaled by a power of two, counter-clockwise
    std::vector<std::uint32_t> next_, previous_;
    std::vector<std::uint32_t> candidates_, waiting_, round_of_;   ///< corners to try in this and the next round
    std::vector<std::uint32_t> reflex_, cell_begin_, cell_items_;  ///< grid of corners that are not strictly convex
    std::vector<char> alive_;
    Point2 grid_low_{}, grid_size_{1, 1};
    std::size_t cells_ = 1;  ///< a side
    std::size_t budget_ = 0;
};

}  // namespace ostraka::io
