// The solid that several closed surfaces bound together: bodies, cavities, overlaps.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <array>
#include <string>
#include <vector>

namespace ostraka {

/// Closed components of a surface as one solid. A component inside an even number of others bounds a body, inside an odd number
/// a cavity, whatever its orientation.
struct SolidBodies {
    std::size_t closed = 0;           ///< number of closed, consistently oriented components
    std::size_t cavities = 0;         ///< number of components that bound a cavity
    std::size_t turned_cavities = 0;  ///< number of cavities that are oriented outwards, as if they were bodies
    std::size_t inside_out = 0;       ///< number of bodies that are oriented inwards
    std::size_t repeated = 0;         ///< number of components that are there twice, point by point; they count once
    std::size_t overlapping = 0;      ///< number of components that intersect others
    /// Volume of the solid. If bodies overlap, the volume of their union lies between the largest body and the sum of the bodies:
    /// `volume` is the middle and `bound` the half width of this interval. If a cavity intersects a body, `volume` is their
    /// difference and `bound` the volume of the cavity. Otherwise `bound` is 0.
    double volume = 0, bound = 0;
    std::array<double, 3> centroid{};  ///< centroid of the solid; not known better than `volume` if bodies overlap
    double signed_volume = 0;          ///< sum of the signed volumes of the components
    /// Role of each component, in the order of the smallest vertex index.
    enum class Role { open, body, inside_out, cavity, turned_cavity };
    std::vector<Role> roles;

    /// What is wrong with the orientation of the surface or uncertain about the volume, as text; empty: nothing.
    [[nodiscard]] std::vector<std::string> remarks() const;
};

/// Analyses the components of triangles (connected through shared vertices). A component whose triangles do not traverse each of
/// its edges once in each direction is open and ignored. Components with nested boxes are compared by rays, components with
/// intersecting boxes by a search for intersecting triangles. Time: O(n log n), and the number of pairs of triangles with
/// overlapping boxes among components with overlapping boxes. Throws Error (input) for indices out of range and coordinates that
/// are not finite.
SolidBodies solid_bodies(const TriangleSoup& soup);

}  // namespace ostraka
