// Triangulation of one polygon in space.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ostraka::io {

/// Quality of a triangulation.
enum class CutResult : std::uint8_t { clean, crossing, gave_up };

/// Reuses its working arrays for successive polygons.
class PolygonCutter {
public:
    using Triple = std::array<std::uint32_t, 3>;  ///< positions in the list of corners

    /// Appends the triangles over `points[corners[i]]`, i in [0, count), to `triangles`, all with the orientation of the
    /// polygon. No triangle repeats a vertex. Quadrilaterals are split along the shorter diagonal that keeps both triangles
    /// upright (the one at the first corner if equal), strictly convex polygons into a fan from the first corner, those of more
    /// than a thousand corners by halving (every second corner, then every fourth, ...), all others by ear clipping (Meisters
    /// 1975) in the coordinate plane of the largest projected area. A grid finds the corners that could lie in an ear, so that
    /// the time is nearly linear in practice. `crossing`: no ear was left, so triangles overlap. `gave_up`: a budget of a
    /// million tests (twenty million for many corners) and 200 per corner is exhausted, where a test in exact arithmetic counts
    /// as 16; the rest is halved. O(count) memory.
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
    std::vector<std::uint32_t> next_, previous_;
    std::vector<std::uint32_t> candidates_, waiting_, round_of_;   ///< corners to try in this and the next round
    std::vector<std::uint32_t> reflex_, cell_begin_, cell_items_;  ///< grid of corners that are not strictly convex
    std::vector<char> alive_;
    Point2 grid_low_{}, grid_size_{1, 1};
    std::size_t cells_ = 1;  ///< number of cells per side
    std::size_t budget_ = 0;
};

}  // namespace ostraka::io
