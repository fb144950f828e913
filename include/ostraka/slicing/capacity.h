// Capacity of a vessel: the liquid that it holds before it spills, or up to a level.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <Eigen/Core>

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// Errors that the uncertainty of a capacity takes into account.
struct CapacityOptions {
    double up_error = 0.5;  ///< standard deviation of the upward direction in each of two directions across it, degrees
    /// Standard deviation of the wall's positions along its normals, independent from vertex to vertex, in the mesh's unit; none:
    /// estimated from the roughness of the surface.
    std::optional<double> noise;
    double wall_error = 0;  ///< standard deviation of an offset that the whole inner wall has in common, in the mesh's unit

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A requested level of the liquid.
struct FillRequest {
    enum class Kind {
        height,  ///< `value` is a height above `from`, or above the lowest point of the cavity
        share    ///< `value` is a share of the height from the lowest point of the cavity to the level of the overflow
    } kind = Kind::height;
    double value = 0;
    std::optional<Point> from = {};  ///< zero of the heights; none: the lowest point of the cavity
};

/// Volume of the liquid in a cavity up to a level.
struct LiquidVolume {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    double level = 0;          ///< height of the plane above the origin of the coordinates, along the upward direction
    double height = 0;         ///< height of the level above the lowest point of the cavity
    double volume = unknown;   ///< volume; NaN: the cavity does not hold liquid up to this level
    double surface = unknown;  ///< area of the liquid's surface
    /// Standard deviations of the volume due to independent noise of the wall, a common offset of the wall, and the upward
    /// direction.
    double by_noise = 0, by_wall = 0, by_direction = 0;
    std::string reason = {};  ///< why there is no volume; empty: there is one

    [[nodiscard]] double uncertainty() const;  ///< standard deviation of the volume: root of the sum of the three squares
};

/// Where a cavity overflows.
enum class Overflow {
    rim,    ///< over the surface, or over the border of an open mesh that reaches highest
    hole,   ///< through a hole of the mesh: another border than the highest
    sealed  ///< nowhere: the cavity is closed on all sides
};

/// A cavity that holds liquid.
struct Cavity {
    LiquidVolume full;        ///< filling to the level of the overflow, without uncertainties
    Point lowest{0, 0, 0};    ///< lowest point of the cavity
    Point overflow{0, 0, 0};  ///< point over which liquid spills first
    Overflow over = Overflow::rim;
    /// True: the surface of the cavity has a border below the level of the overflow, so that the cavity contains whatever is
    /// behind the wall; its volume is an upper bound only.
    bool open_wall = false;
    double wetted_area = 0;  ///< area of the wall below the level
};

/// The cavities of a vessel in one upward direction, and the fillings of the largest one.
struct Capacity {
    Vector up{0, 0, 1};                ///< unit vector of the upward direction
    std::vector<Cavity> cavities;      ///< by decreasing volume; cavities below a hundredth of the largest are left out
    double height = 0;                 ///< height of the whole object
    double box = 0;                    ///< volume of the object's bounding box along the upward direction
    double noise = 0;                  ///< standard deviation of the noise that the uncertainties assume
    LiquidVolume full;                 ///< the largest open cavity filled to its overflow; NaN if there is none
    std::vector<LiquidVolume> levels;  ///< for each request
    /// Index of the cavity of `full`; none: the object holds no liquid in this direction.
    std::optional<std::size_t> main;
    std::size_t crossing = 0;  ///< number of contours that cross others at the level of the overflow: the mesh intersects itself
    std::string reason = {};   ///< why the capacity is unknown; empty: it is known

    [[nodiscard]] bool known() const { return reason.empty(); }
};

/// A cavity below this share of the object's bounding box is a hollow of the surface, not the inside of a vessel.
inline constexpr double min_cavity_share = 0.005;

/// Finds the cavities of a mesh in which liquid stays, and their volumes.
///
/// The mesh is a closed surface of clay with an inner and an outer wall (in any orientation), or an open surface such as the
/// inner wall alone, taken as a thin wall. Below a plane, the space without clay falls into components: sides of the pieces of
/// the surface and regions of the plane that touch each other along contours, both sides of a piece where its border lies below
/// the plane. A component apart from the unbounded one is a pool. Its overflow is the lowest vertex height above which it is
/// connected with the unbounded component (a saddle of the surface or a vertex of a border), found by bisection over the heights
/// of the vertices; spouts, holes and handles need no rules of their own. The volume is exact for the triangles: the sum of the
/// tetrahedra between the clipped faces and a point of the plane. The largest pool is the capacity; hollows of it that are
/// separate at a lower level count together.
///
/// Uncertainty: `by_noise` is noise * sqrt(sum over the wetted vertices of (area per vertex)^2 + (area of the liquid)^2), the
/// latter for the level of the rim; `by_wall` is wall_error * wetted area; `by_direction` is the root mean square change in
/// eight directions tilted by sqrt(2) up_error. Requests above the overflow get a reason instead of a volume.
///
/// Time: about 80 passes over the faces. Throws Error (usage) for a direction without length or options out of range, (input) for
/// a mesh without faces.
Capacity find_capacity(const Mesh& mesh, const Vector& up, const std::vector<FillRequest>& requests = {},
                       const CapacityOptions& options = {});

/// Volumes of the cavities only, by decreasing volume, for comparing upward directions. Throws as `find_capacity`.
std::vector<Cavity> find_cavities(const Mesh& mesh, const Vector& up);

/// Standard deviation of independent noise of the vertices along their normals, from differences of the vertices' heights above
/// their neighbours (median of at most 20,000 vertices). Vanishes on smooth surfaces with regular triangles; irregular triangles
/// of a curved surface count as noise. 0 for fewer than ten interior vertices.
double surface_noise(const Mesh& mesh);

/// Surface of revolution of a profile: points (radius, height), revolved about the axis radius 0. Each parallel is a regular
/// polygon of the area of its circle, so that volumes between horizontal planes are those of the surface of revolution. A profile
/// whose ends are on the axis, or whose last point is its first, gives a closed mesh. Throws Error (input) for fewer than two
/// different points, coordinates that are not finite, negative radii, or a profile that lies on the axis.
Mesh revolve_profile(const std::vector<Eigen::Vector2d>& profile, int columns = 360);

}  // namespace ostraka
