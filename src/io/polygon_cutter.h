// Triangulation of one polygon in space.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ostraka::io {

/// Quality of the triangulation of one polygon: clean; crossing: triangles overlap; gave_up: too expensive, rest divided by
/// halving.
enum class CutResult : std::uint8_t { clean, crossing, gave_up };

/// Divides polygons into triangles, reusing working arrays for successive polygons.
class PolygonCutter {
public:
    /// Positions of the triangle's corners in the polygon's list of corners.
    using Triple = std::array<std::uint32_t, 3>;

    /// Divides the polygon with the corners `points[corners[i]]`, i in [0, count), and appends its triangles to `triangles`, all
    /// with the orientation of the polygon. No triangle repeats a vertex. A quadrilateral is split along the shorter diagonal
    /// that keeps both triangles upright (at equal lengths, the diagonal at the first corner). A strictly convex polygon becomes
    /// a fan from the first corner, or with more than a thousand corners is halved (every second corner, then every fourth, ...).
    /// All other polygons are divided by ear clipping (Meisters 1975) in the coordinate plane of the largest projected area. A
    /// grid finds the corners that could lie in an ear, so that the time is nearly linear in practice. Result `crossing`: no ear
    /// was left, so triangles overlap. Result `gave_up`: a budget of a million tests (twenty million for many corners) plus 200
    /// per corner is exhausted, where a test in exact arithmetic counts as 16; the rest of the polygon is halved. Memory:
    /// O(count).
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

    std::vector<std::uint32_t> kept_;  ///< positions of corners that differ from their predecessor
    std::vector<Point2> flat_;         ///< projections of the kept corners, scaled by a power of two, counter-clockwise
    /// For each kept corner: its neighbours in the remaining polygon.
    std::vector<std::uint32_t> next_, previous_;
    /// Corners to try as ears in this round and in the next round; round in which a corner last changed.
    std::vector<std::uint32_t> candidates_, waiting_, round_of_;
    /// Corners that are not strictly convex, and the grid that finds them.
    std::vector<std::uint32_t> reflex_, cell_begin_, cell_items_;
    std::vector<char> alive_;
    Point2 grid_low_{}, grid_size_{1, 1};
    std::size_t cells_ = 1;  ///< number of cells per side
    std::size_t budget_ = 0;
};

}  // namespace ostraka::io
