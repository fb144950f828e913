// The solid bounded by a region: the faces of the region, and surfaces that close its outlines.
#pragma once

#include "ostraka/io/bodies.h"
#include "ostraka/mesh/mesh.h"

#include <string>
#include <vector>

namespace ostraka {

/// Volume and centroid of the solid bounded by a region.
struct RegionSolid {
    double volume = 0;  ///< signed volume: positive if the faces are oriented outwards
    /// Maximum error of the volume due to the missing surfaces, if each missing surface lies inside the convex hull of its
    /// outline: the sum of the volumes of these hulls. 0 if the region is closed or its outlines are planar.
    double volume_bound = 0;
    Point centroid{0, 0, 0};   ///< centroid of the solid, or of the surface if the volume is 0
    std::size_t outlines = 0;  ///< number of outlines of the region, which were closed by fans
};

/// Computes the volume V = 1/3 sum c . n A over the region's faces (Zhang and Chen 2001; c is the centroid, n the unit normal and
/// A the area of a face) and over the fans that join each outline with the mean of its vertices. All positions are relative to
/// the centre of the region's bounding box. The centroid is the weighted mean of the centroids of the corresponding tetrahedra.
/// Throws Error (usage) for a face out of range. Time: linear, except for the hulls (n log n in the length of an outline).
RegionSolid region_solid(const Mesh& mesh, const std::vector<Index>& faces);

/// Volume and centroid of the solid bounded by a region, whatever the orientation of its closed components: a component inside
/// another bounds a cavity, and bodies that overlap have a bound (see SolidBodies). Open components count as in `region_solid`,
/// with the sign of their orientation. `remarks`: what is wrong with the
/// orientation. Throws as `region_solid`.
struct BodyVolume : RegionSolid {
    std::vector<std::string> remarks;  ///< texts about orientation and overlaps; empty: nothing to report
};
BodyVolume body_volume(const Mesh& mesh, const std::vector<Index>& faces);

/// Volume of a mesh without border, independent of its orientation (see `body_volume`); NaN for an open mesh.
double closed_volume(const Mesh& mesh);

/// Area-weighted mean of the faces' centroids, or the mean of the corners if the area is 0. Throws Error (usage) for a face out
/// of range and if there are no faces.
Point surface_centroid(const Mesh& mesh, const std::vector<Index>& faces);

/// Size of the convex hull of points; zeros if the points are coplanar.
struct ConvexHullSize {
    double volume = 0, area = 0;  ///< volume and surface area of the hull
};
/// Volume and surface area of the convex hull of points.
ConvexHullSize convex_hull_size(const std::vector<Point>& points);

}  // namespace ostraka
