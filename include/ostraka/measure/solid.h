// The solid under a region: what its faces enclose once their outlines are closed.
#pragma once

#include "ostraka/core/mesh.h"

#include <vector>

namespace ostraka {

/// Volume and centroid of the solid that a region bounds.
struct RegionSolid {
    double volume = 0;  ///< signed: positive where the faces look outward
    /// What the missing surfaces may change at most, if each stays inside the convex hull of its outline: the sum of the hulls'
    /// volumes. 0 where the region is closed or its outlines are plane.
    double volume_bound = 0;
    Point centroid{0, 0, 0};   ///< of the solid; of the surface where the volume vanishes
    std::size_t outlines = 0;  ///< closed by fans
};

/// V = 1/3 sum c . n A over the region's faces (Zhang and Chen 2001; n is the unit normal) and over the fans that join each
/// outline with the mean of its vertices, all about the middle of the region's box. The centroid is the sum of the tetrahedra's.
/// Throws Error (usage) for a face out of range. Linear but for the hulls (n log n in the length of an outline).
RegionSolid region_solid(const Mesh& mesh, const std::vector<Index>& faces);

/// Volume of a mesh without border, however it is oriented; NaN where it is open.
double closed_volume(const Mesh& mesh);

/// Area-weighted mean of the faces' centroids; the mean of the corners where the area vanishes. Throws as above, and for no
/// faces.
Point surface_centroid(const Mesh& mesh, const std::vector<Index>& faces);

/// Of the convex hull of some points; zeros if they lie in a plane.
struct HullSize {
    double volume = 0, area = 0;
};
HullSize hull_size(const std::vector<Point>& points);

}  // namespace ostraka
