// Further functions for point clouds: Poisson surface reconstruction, trimming of surfaces, removal of outliers, and transfer
// of colours to vertices.
#pragma once

#include "ostraka/point_cloud/point_cloud.h"

#include <cstddef>
#include <vector>

namespace ostraka {

/// Options of `poisson_surface`.
struct PoissonOptions {
    double edge = 0.7;        ///< max circumradius of the triangles, in multiples of the point spacing
    double deviation = 0.25;  ///< max distance between the triangles and the Poisson surface, in multiples of the point spacing
    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// The Poisson surface of oriented points: the level set of the function whose gradient fits the normals best (Kazhdan, Bolitho,
/// Hoppe 2006), solved on a refined Delaunay triangulation of the points and meshed by Delaunay refinement (CGAL; without the
/// screening of Kazhdan and Hoppe 2013). The surface is smooth and closed, also where there are no points; `trim_surface`
/// removes such parts. The surface does not pass through the points, so all `sources` are no_index. Normals are estimated if
/// the cloud has none (`cloud_options`). Deterministic. Throws Error (input) if the points do not determine a surface.
CloudSurface poisson_surface(const PointCloud& cloud, const PoissonOptions& options = {}, const CloudOptions& cloud_options = {});

/// Removes the triangles that are far from the points: a corner, the midpoint of an edge or the centroid is farther than
/// `distance` from the nearest point. Returns the area removed. Throws Error (input) if nothing would be left.
double trim_surface(CloudSurface& surface, const std::vector<Point>& points, double distance);

/// Removes outliers with their attributes. A point is an outlier if its mean distance to its `neighbours` nearest points is
/// more than `factor` times the median of these mean distances over the cloud. Returns the number of points removed. Throws
/// Error (input) for fewer than `neighbours` + 1 points, or if more than half of the points would be removed.
std::size_t remove_outliers(PointCloud& cloud, double factor, int neighbours = 8);

/// Interpolates the colours and intensities of a cloud at the vertices of a mesh: the mean over the `neighbours` nearest points
/// that have a value, weighted by the inverse distance. A vertex at the position of a point gets the values of that point. The
/// result has vertex_colours if the cloud has colours, and vertex_values "intensity" if it has intensities.
MeshExtras carried_to_vertices(const PointCloud& cloud, const Mesh& mesh, int neighbours = 4);

}  // namespace ostraka
