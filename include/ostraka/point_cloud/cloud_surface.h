// Surfaces of point clouds beyond their points: Poisson surfaces, trimming, outliers, and colours carried to the vertices.
#pragma once

#include "ostraka/point_cloud/point_cloud.h"

#include <cstddef>
#include <vector>

namespace ostraka {

/// Options of `poisson_surface`.
struct PoissonOptions {
    double edge = 0.7;                    ///< bound of the triangles' circumradius, in multiples of the point spacing
    double deviation = 0.25;              ///< distance between triangles and Poisson surface, in multiples of the spacing
    void list_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// The Poisson surface of oriented points: the level set of the function whose gradient fits the normals best (Kazhdan, Bolitho,
/// Hoppe 2006), solved on a refined Delaunay triangulation of the points and meshed by Delaunay refinement (CGAL; without the
/// screening of Kazhdan and Hoppe 2013). The surface is smooth and closed, also where there are no points: trim it. It does not
/// pass through the points, so that all `sources` are no_index. Normals are estimated if the cloud has none (`cloud_options`).
/// Deterministic. Throws Error (input) for points that define no surface.
CloudSurface poisson_surface(const PointCloud& cloud, const PoissonOptions& options = {}, const CloudOptions& cloud_options = {});

/// Removes the triangles of a surface that have a corner, an edge's middle or their centroid farther than `distance` from the
/// nearest point. Returns the area removed. Throws Error (input) if nothing would be left.
double trim_surface(CloudSurface& surface, const std::vector<Point>& points, double distance);

/// Removes the points whose mean distance to their `neighbours` nearest points is more than `factor` times the median of these
/// means over the cloud, with their attributes. Returns the number of points removed. Throws Error (input) for fewer than
/// `neighbours` + 1 points, or if more than half of the points would be removed.
std::size_t remove_outliers(PointCloud& cloud, double factor, int neighbours = 8);

/// Colours and intensities of a cloud at the vertices of a mesh: means of the `neighbours` nearest points that have them,
/// weighted by the inverse distance; a vertex at a point gets the values of that point. The result has vertex_colours if the
/// cloud has colours, and vertex_values "intensity" if it has intensities.
MeshExtras carried_to_vertices(const PointCloud& cloud, const Mesh& mesh, int neighbours = 4);

}  // namespace ostraka
