// Fragments that are points without faces: read, given normals, made into a surface.
#pragma once

#include "ostraka/core/file.h"
#include "ostraka/core/mesh.h"
#include "ostraka/core/options.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

struct PointCloud {
    std::vector<Point> points;
    std::vector<Vector> normals;     ///< empty, or a unit vector each that looks out of the object
    std::vector<std::string> notes;  ///< what the file held that is not kept, in words
};

/// The points of a file that has no faces: PLY, OFF or OBJ, or text with x y z, or x y z nx ny nz, a line (.xyz, .pts, .asc,
/// .txt; lines that begin with # are comments). Normals are those of PLY's properties nx, ny, nz or of the text; where one of
/// them has no length none is kept. Nothing for a file with faces. Throws Error (input) for what cannot be read.
std::optional<PointCloud> read_point_cloud(const Path& file);

struct CloudOptions {
    int neighbours = 18;     ///< of a point, for its normal
    double longest = 8;      ///< edges of the surface that are longer than this many times the spacing are left out
    double close_holes = 1;  ///< holes of up to this share of the diagonal are closed

    void describe(OptionList& visit);
};

/// Unit normals: directions from quadrics through each point's neighbours (jets; Cazals and Pouget 2005), sides from a minimum
/// spanning tree (Hoppe et al. 1992); all turned over together if they look into the object (mean over the points of normal times
/// place from the middle, the sum of flux through the surface). Throws Error (input) for fewer than `neighbours` + 1 points.
std::vector<Vector> estimate_normals(const std::vector<Point>& points, const CloudOptions& options = {});

/// Mean distance from each point to its sixth neighbour.
double point_spacing(const std::vector<Point>& points);

struct CloudSurface {
    Mesh mesh;                   ///< vertices are points of the cloud, in their order, those with a face only
    std::vector<Index> sources;  ///< the point that each vertex is
    std::size_t border_loops = 0;
    std::vector<std::string> notes;
};

/// A surface through the points: advancing front (Cohen-Steiner and Da 2004), oriented by the normals (estimated where the cloud
/// has none), mended and small holes closed (io/repair.h). Equal points count once. Throws Error (input) for points that have no
/// surface (too few, all in a line).
CloudSurface reconstruct_surface(const PointCloud& cloud, const CloudOptions& options = {});

}  // namespace ostraka
