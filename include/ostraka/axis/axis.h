// Axes of objects and of annotated parts by four methods (principal, slices, rotation, skeleton), or the reason why there is
// none.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <string>
#include <vector>

namespace ostraka {

/// Method by which an axis is found.
enum class AxisMethod { rotation, slices, skeleton, principal };
std::string to_string(AxisMethod method);

/// Options of `find_axis`.
struct AxisOptions {
    AxisMethod method = AxisMethod::rotation;  ///< how the axis is computed
    /// Rotation: max distance of a point on the revolved profile, as a fraction of the largest diameter.
    double tolerance = 0.02;
    double min_quality = 0.7;  ///< rotation: min fraction of the surface that lies on the revolved profile
    int slices = 24;           ///< slices: number of planes across the part
    int trials = 300;          ///< rotation: number of random sets of normals (RANSAC)
    int smoothing = 2;         ///< rotation: number of rounds in which normals are averaged over neighbours
    std::uint64_t seed = 1;    ///< rotation: random seed

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A number that describes the axis; lengths are in the mesh's unit.
struct AxisFigure {
    std::string name;  ///< name of the number in reports
    double value;      ///< the number, in `unit`
    std::string unit;  ///< "length", "degree", "%" or empty for a ratio
};

/// An axis that was found, or the reason why there is none.
struct Axis {
    bool found = false;         ///< true if there is an axis
    std::string reason;         ///< why there is no axis; empty if there is one
    Point point{0, 0, 0};       ///< the point of the straight axis closest to the part's centroid
    Vector direction{0, 0, 1};  ///< unit vector whose largest component is positive
    /// Poly-lines of the curved axis, or the branches of a skeleton with the longest path first.
    std::vector<std::vector<Point>> lines;
    double quality = 0;               ///< quality of the axis, 0 to 1; each method defines its own
    std::vector<AxisFigure> figures;  ///< further numbers about the axis, which depend on the method
    std::vector<std::string> notes;   ///< remarks, such as on parts that were left out
    /// The figure of this name; null if there is none.
    [[nodiscard]] const AxisFigure* figure(const std::string& name) const;
};

/// Finds the axis of a set of faces by the method in the options. Throws Error (input) if there are no faces with area.
Axis find_axis(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options = {});

/// Axis of the surface of revolution fitted to the faces. Every normal of a surface of revolution meets the axis: the linear line
/// complex of Pottmann and Wallner (Computational Line Geometry, 2001) is fitted to random sets of normals (RANSAC), then to all
/// normals with reweighting. The result is refined so that radii agree along parallels (robust least squares over heights), which
/// needs no normals; the refinement starts from the axis fitted to the normals and from the principal directions of the normals,
/// and the result of the highest quality is kept. Quality: the fraction of the area (without parts that face along the axis)
/// within `tolerance` of the revolved profile. No axis is found for flat parts, spheres (infinitely many), shapes that are not
/// rotationally symmetric or that fit about several lines, and short arcs (relative error of the diameter above one half).
/// `figures`: largest diameter, per cent of the circle preserved, rms distance from the profile, standard errors of the direction
/// and of the diameter. Time: linear in the number of faces.
Axis rotation_axis(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options = {});

/// Axis of a tubular part through the centroids of slices, which are cut across the longest principal direction and then again
/// across the local tangent of the curve. A slice that covers less than 300 degrees contributes the centre of its fitted circle
/// instead. The straight axis is fitted to these centres. Quality: 1 - mean radius / length. No axis is found for parts that are
/// not longer than wide. `figures`: length, mean radius, rms distance of the centres from the straight axis. Time: O(number of
/// slices x number of faces).
Axis slice_axis(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options = {});

/// Mean curvature skeleton (Tagliasacchi et al. 2012, CGAL) of the component of the largest area, with its holes filled and long
/// edges cut; a note reports components that are left out. The axis is the
/// longest path in the skeleton, or its loop. Quality: the fraction of the skeleton's length on the longest path. No axis is
/// found for parts that contract to a point. `figures`: length, number of branches, rms distance of the path from the straight
/// axis. The part may have at most 200 000 faces.
Axis skeleton_axis(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options = {});

/// Principal axes of the surface area. `direction` is the axis of the largest variance; `lines` holds all three axes, longest
/// first, each as long as the extent of the part in its direction. Quality: 1 - (second / first variance). No axis is found if
/// the two largest variances differ by less than a tenth (relative).
Axis principal_axis(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options = {});

/// Circle through the vertices of a curve (for example the rim of a sherd): its axis, its diameter with the 95 % interval
/// (`fit_arc`; without an upper bound if a straight line fits too) and the preserved part of the circle in per cent. Quality: 1 -
/// rms distance / radius. No axis is found for fewer than three points or for collinear points.
Axis circle_axis(const std::vector<Point>& points);

/// The poly-lines of an axis as a Wavefront OBJ file: coordinates without rounding, one "l" element per poly-line.
std::string to_obj(const Axis& axis);

/// Centroid and covariance of the surface area of faces, integrated exactly over the triangles.
struct AreaMoments {
    double area = 0;                    ///< total area
    Point centroid{0, 0, 0};            ///< centroid of the area
    std::array<double, 3> variances{};  ///< variances along `directions`, descending
    std::array<Vector, 3> directions;   ///< unit eigenvectors of the covariance, a right-handed frame
};
/// Integrates the moments of the area of faces.
AreaMoments area_moments(const Mesh& mesh, const std::vector<Index>& faces);

}  // namespace ostraka
