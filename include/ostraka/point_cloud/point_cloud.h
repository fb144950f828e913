// Point clouds of fragments: reading, normal estimation, surface reconstruction.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/files/file.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/mesh/mesh.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// Points with their attributes. Each list of attributes is empty or has one entry per point.
struct PointCloud {
    std::vector<Point> points;
    std::vector<Vector> normals;  ///< empty, or one unit vector per point, pointing outwards
    std::vector<Colour> colours;  ///< empty, or one colour per point; alpha 255; alpha 0 marks a point without colour
    /// Empty, or one number per point, unchanged from the file; NaN: the point has no intensity.
    std::vector<double> intensities;
    std::vector<std::string> notes;  ///< messages about contents of the file that were interpreted, dropped or ignored
};

/// File name extensions of formats that can only store points: .e57, .las, .pts, .ptx, .pcd, .xyz and so on. Mesh files (.ply,
/// .obj, .off) may also contain points only.
const std::vector<std::string>& point_cloud_endings();

/// Reads the points of a file without faces: E57, LAS 1.0 to 1.4, PTS, PTX, PCD (text, binary, LZF), PLY, OFF, OBJ, or text with
/// x y z and further columns per line (.xyz, .asc, .csv, .txt). A header line, such as //X Y Z R G B, names the columns of a
/// text file. Without a header the columns are identified by their values: normals have length 1, colours are whole numbers
/// from 0 to 255, a single column is the intensity; a note reports the result. Several scans of a file are merged, with their
/// poses applied. Empty, invalid and infinite points are dropped and counted in a note; if any normal has length zero, all
/// normals are dropped. Returns nothing for a file with faces. Throws Error (input) for a file that cannot be read, such as
/// LAZ. Memory use is at most 256 MB plus 16 times the file size.
std::optional<PointCloud> read_point_cloud(const Path& file);

struct CloudOptions {
    int neighbours = 18;     ///< number of nearest neighbours from which the normal of a point is estimated
    double longest = 8;      ///< max edge length of the surface, in multiples of the point spacing
    double close_holes = 1;  ///< max size of a hole that is filled, as a share of the bounding box diagonal

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Estimates a unit normal for each point: the direction from a quadric through the point's neighbours (jets; Cazals and Pouget
/// 2005), the orientation by a minimum spanning tree (Hoppe et al. 1992). All normals are flipped together if they point inwards
/// (sign of the mean over the points of normal times position relative to the centre, i.e. of the flux through the surface).
/// Throws Error (input) for fewer than `neighbours` + 1 points.
std::vector<Vector> estimate_normals(const std::vector<Point>& points, const CloudOptions& options = {});

/// Mean distance from each point to its sixth nearest neighbour.
double point_spacing(const std::vector<Point>& points);

struct CloudSurface {
    Mesh mesh;  ///< its vertices are the points that belong to a face, in the order of the cloud
    /// For each vertex, index of its point in the cloud; no_index: the vertex is not a point of the cloud.
    std::vector<Index> sources;
    std::size_t border_loops = 0;    ///< number of border loops of the surface that were not filled
    double border_length = 0;        ///< total length of the unfilled border loops
    std::vector<std::string> notes;  ///< messages about the reconstruction
};

/// Surface reconstruction by advancing front (Cohen-Steiner and Da 2004). The surface is oriented by the normals (estimated if
/// the cloud has none) and repaired, and small holes are filled (io/repair.h). Duplicate points count once. Throws Error
/// (input) if no surface can be reconstructed (too few or collinear points).
CloudSurface reconstruct_surface(const PointCloud& cloud, const CloudOptions& options = {});

}  // namespace ostraka
