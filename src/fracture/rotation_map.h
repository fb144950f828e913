// Where a sherd lies on a surface of revolution: the wall unrolled, by place on the profile and angle.
#pragma once

#include "break_side.h"
#include "ostraka/geom/surface_search.h"

#include <map>

namespace ostraka {

/// Places on the profile of a surface of revolution about the vertical axis, as cells of the half plane (radius, height).
class ProfileCells {
public:
    ProfileCells(const SurfaceSearch& whole, double width) : whole_(whole), width_(width) {}
    /// The cell of the surface's place nearest to `p` that faces the same way; none farther off than `search_radius`: -1.
    int row(const Eigen::Vector3d& p, const Eigen::Vector3d& normal, double search_radius);
    [[nodiscard]] double width() const { return width_; }
    [[nodiscard]] std::size_t rows() const { return known_.size(); }

private:
    const SurfaceSearch& whole_;
    double width_;
    std::map<std::pair<long, long>, int> known_;
};

/// What a sherd covers at each of `steps` angles.
class RotationMap {
public:
    /// Places closer than `margin` to the sherd's own break are covered, but do not complain of being covered twice.
    RotationMap(ProfileCells& cells, const SurfaceSamples& surface, const std::vector<Eigen::Vector3d>& fracture, int steps,
                double margin, double search_radius);
    /// Area of this sherd on which `other` lies too when it is rotated by each of the steps against this one: one a step.
    [[nodiscard]] std::vector<double> shared(const RotationMap& other) const;
    [[nodiscard]] double area() const { return area_; }

private:
    struct Place {
        int row, column;
    };
    int steps_;
    double area_ = 0, each_ = 0;
    std::vector<Place> deep_;
    std::vector<std::vector<bool>> covered_;  ///< by row; empty: nowhere
};

}  // namespace ostraka
