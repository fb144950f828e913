// Spatial hash of triangles with insertion and removal.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <cmath>
#include <unordered_map>

namespace ostraka::cage {

using Triangle = std::array<Vertex, 3>;  ///< corners of a triangle

/// True if two triangles intersect elsewhere than at the vertices and edges that they share; decided in exact arithmetic.
bool overlap(const Triangle& s, const std::array<Point, 3>& points_s, const Triangle& t, const std::array<Point, 3>& points_t);

/// A hierarchy of hash grids whose cell sizes double from level to level. A triangle is stored in the level whose cells are at
/// least as large as its bounding box, in at most eight cells.
class TriangleGrid {
public:
    explicit TriangleGrid(double cell) : cell_(cell) {}  ///< cell: smallest cell size

    void insert(Face face, const CGAL::Bbox_3& box) {
        const int level = level_of(box);
        Level& grid = levels_[level];
        ++grid.size;
        each_cell(level, box, [&](const Key& key) { grid.cells[key].push_back(face); });
    }
    void remove(Face face, const CGAL::Bbox_3& box) {
        const int level = level_of(box);
        Level& grid = levels_[level];
        --grid.size;
        each_cell(level, box, [&](const Key& key) {
            auto& faces = grid.cells[key];
            faces.erase(std::find(faces.begin(), faces.end(), face));
            if (faces.empty()) grid.cells.erase(key);
        });
    }
    /// Calls `visit(face)` for each triangle stored in a cell that meets the box, possibly more than once, until a call returns
    /// true. Returns true if a call did.
    template <class Visit>
    bool any(const CGAL::Bbox_3& box, Visit&& visit) const {
        for (const auto& [level, grid] : levels_) {
            if (grid.size == 0) continue;
            bool stopped = false;
            if (cells_of(level, box) > static_cast<double>(grid.cells.size())) {
                for (const auto& [key, faces] : grid.cells)
                    for (const Face face : faces)
                        if (!stopped && visit(face)) stopped = true;
            } else {
                each_cell(level, box, [&](const Key& key) {
                    const auto faces = grid.cells.find(key);
                    if (stopped || faces == grid.cells.end()) return;
                    for (const Face face : faces->second)
                        if (!stopped && visit(face)) stopped = true;
                });
            }
            if (stopped) return true;
        }
        return false;
    }

private:
    using Key = std::array<std::int64_t, 3>;
    struct Hash {
        std::size_t operator()(const Key& key) const {
            std::size_t hash = 0;
            for (const std::int64_t k : key) hash = (hash ^ static_cast<std::size_t>(k)) * 0x9E3779B97F4A7C15ULL;
            return hash ^ (hash >> 29U);
        }
    };
    struct Level {
        std::size_t size = 0;
        std::unordered_map<Key, std::vector<Face>, Hash> cells;
    };
    [[nodiscard]] int level_of(const CGAL::Bbox_3& box) const {
        const double size = std::max({box.x_span(), box.y_span(), box.z_span()});
        return size <= cell_ ? 0 : static_cast<int>(std::ceil(std::log2(size / cell_)));
    }
    [[nodiscard]] double cells_of(int level, const CGAL::Bbox_3& box) const {
        const double size = std::ldexp(cell_, level);
        return (box.x_span() / size + 1) * (box.y_span() / size + 1) * (box.z_span() / size + 1);
    }
    template <class Visit>
    void each_cell(int level, const CGAL::Bbox_3& box, Visit&& visit) const {
        const double size = std::ldexp(cell_, level);
        const auto cell = [&](double x) { return static_cast<std::int64_t>(std::floor(x / size)); };
        for (auto x = cell(box.xmin()); x <= cell(box.xmax()); ++x)
            for (auto y = cell(box.ymin()); y <= cell(box.ymax()); ++y)
                for (auto z = cell(box.zmin()); z <= cell(box.zmax()); ++z) visit(Key{x, y, z});
    }

    double cell_;
    std::map<int, Level> levels_;
};

}  // namespace ostraka::cage
