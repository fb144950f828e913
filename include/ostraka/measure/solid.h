// The solid bounded by a region: its faces with their outlines closed.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

/// Volume and centroid of the solid bounded by a region.
struct RegionSolid {
    double volume = 0;  ///< signed: positive if the faces are oriented outwards
    /// Maximum change of the volume due to the missing surfaces, if each stays inside the convex hull of its outline: the sum of
    /// the hulls' volumes. 0 if the region is closed or its outlines are planar.
    double volume_bound = 0;
    Point centroid{0, 0, 0};   ///< centroid of the solid; of the surface if the volume vanishes
    std::size_t outlines = 0;  ///< number of outlines, closed by fans
};

/// V = 1/3 sum c . n A over the region's faces (Zhang and Chen 2001; n is the unit normal) and over the fans that join each
/// outline with the mean of its vertices, all relative to the centre of the region's box. The centroid is the sum of the
/// tetrahedra's. Throws Error (usage) for a face out of range. Linear, except for the hulls (n log n in the length of an
/// outline).
RegionSolid region_solid(const Mesh& mesh, const std::vector<Index>& faces);

/// Volume of a mesh without border, independent of its orientation; NaN for an open mesh.
double closed_volume(const Mesh& mesh);

/// Area-weighted mean of the faces' centroids; the mean of the corners if the area vanishes. Throws as above, and for no faces.
Point surface_centroid(const Mesh& mesh, const std::vector<Index>& faces);

/// Size of the convex hull of points; zeros if they are coplanar.
struct HullSize {
    double volume = 0, area = 0;
};
HullSize hull_size(const std::vector<Point>& points);

}  // namespace ostraka
