// Objects of revolution placed upright about the z axis, and what is left of them.
#pragma once

#include "catalogue/wall_grid.h"
#include "ostraka/catalogue/catalogue_axis.h"
#include "ostraka/catalogue/entry.h"

namespace ostraka::detail {

/// An end of the wall (top or bottom), in the directions in which it is level.
struct LevelEnd {
    double height = 0;       ///< height of the level part
    double level = 0;        ///< share of the directions with wall in which the end has this height
    double share = 0;        ///< share of the full circle in which the end has this height
    std::vector<bool> bins;  ///< true for the directions of the level part
    /// True if the end is the rim or the foot rather than a break.
    [[nodiscard]] bool is_level() const { return level >= 0.5; }
};
LevelEnd level_end(const WallGrid& grid, bool top);

/// An object in millimetres, with its axis as z axis, the rim (if any) at the top and the lowest point at height 0.
struct Pose {
    TriangleSoup soup;
    Mesh mesh;
    WallGrid grid;
    AngularRange range;  ///< directions that hold the object
    CatalogueKind kind = CatalogueKind::wall;
    LevelEnd top, bottom;
    bool all_around = false;  ///< true: the wall goes all around the axis at most heights
    std::string doubt;        ///< why it is not certain which end is up; empty: certain
};

/// The triangles with the coordinates (u, v, w) . (p - origin) * factor.
TriangleSoup placed(const TriangleSoup& soup, const Point& origin, const std::array<Vector, 3>& axes, double factor);

/// Places an object about its axis. `hint`: upward direction of the file; `hint_known`: it is stated, not assumed.
Pose pose_of(const TriangleSoup& soup, const CatalogueAxis& axis, double factor, const Vector& hint, bool hint_known);

}  // namespace ostraka::detail
