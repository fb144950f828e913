// Axes of objects and of annotated parts: principal, of slices, of rotation, of the skeleton; or the reason why there is none.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <string>
#include <vector>

namespace ostraka {

enum class AxisMethod { rotation, slices, skeleton, principal };
std::string to_string(AxisMethod method);

struct AxisOptions {
    AxisMethod method = AxisMethod::rotation;
    double tolerance = 0.02;
    double min_quality = 0.7;
    int slices = 24;
    int trials = 300;
    int smoothing = 2;
    std::uint64_t seed = 1;

    void describe(OptionList& visit);
};

/// A number that describes the axis; lengths are in the mesh's unit.
struct AxisFigure {
    std::string name;
    double value;
    std::string unit;  ///< "length", "degree", "%" or empty for a ratio
};

struct Axis {
    bool found = false;
    std::string reason;                     ///< why there is no axis
    Point point{0, 0, 0};                   ///< point of the straight axis nearest to the part's centroid
    Vector direction{0, 0, 1};              ///< unit vector whose largest component is positive
    std::vector<std::vector<Point>> lines;  ///< the curved axis, or the branches of a skeleton with the longest path first
    double quality = 0;                     ///< 0 to 1; its meaning depends on the method
    std::vector<AxisFigure> figures;
    [[nodiscard]] const AxisFigure* figure(const std::string& name) const;
};

/// The axis of a set of faces by the method in the options. Throws Error (input) if there are no faces with area.
Axis find_axis(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options = {});

/// Axis of the best-fitting surface of revolution. Every normal of such a surface meets the axis: the linear line complex of
/// Pottmann and Wallner (Computational Line Geometry, 2001) is fitted to random sets of normals (RANSAC), then to all with
/// reweighting. The result is refined so that radii agree along parallels (robust least squares over heights), which needs no
/// normals; the refinement starts from the axis of the normals and from their principal directions, and the best result is
/// kept. Quality: the share of the area (without parts that face along the axis) within `tolerance` of the revolved profile. No
/// axis: flat parts, spheres (infinitely many), shapes that are not rotationally symmetric, that fit about several lines, or
/// whose relative error of the diameter exceeds half (short arcs). Figures: largest diameter, per cent of the circle preserved,
/// rms distance, standard errors of the direction and of the diameter. Linear in faces.
Axis rotation_axis(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options = {});

/// For tubular parts: centroids of slices across the longest principal direction, then again across the local tangent. For a
/// slice that covers less than 300 degrees, the centre of its circle is used. The straight axis is fitted to the centres.
/// Quality: 1 - mean radius / length. No axis: parts that are not longer than wide. Figures: length, mean radius, rms distance
/// of the centres from the straight axis. O(slices x faces).
Axis slice_axis(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options = {});

/// Mean curvature skeleton (Tagliasacchi et al. 2012, CGAL) of the largest component, with its holes filled. The axis is the
/// longest path in the skeleton, or its loop. Quality: the share of the skeleton's length on that path. No axis: parts that
/// contract to a point. Figures: length, branches, rms distance from the straight axis. At most 200 000 faces.
Axis skeleton_axis(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options = {});

/// Principal axes of the area: the longest one as direction; `lines` holds all three, longest first, each with the extent of
/// the part along it. Quality: 1 - (second / first variance). No axis: the first two variances agree within a tenth.
Axis principal_axis(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options = {});

/// Circle through the vertices of a curve (for example the rim of a sherd): its axis, its diameter with the 95 % interval
/// (`fit_arc`; without an upper bound if a straight line fits too) and the per cent of the circle that is preserved. Quality: 1
/// - rms distance / radius. No axis: fewer than three vertices, or collinear vertices.
Axis circle_axis(const std::vector<Point>& points);

/// The poly-lines of an axis as a Wavefront OBJ file: exact coordinates, one "l" element each.
std::string to_obj(const Axis& axis);

/// Centroid and covariance of the area of the faces, exact for triangles.
struct AreaMoments {
    double area = 0;
    Point centroid{0, 0, 0};
    std::array<double, 3> variances{};  ///< descending
    std::array<Vector, 3> directions;   ///< unit eigenvectors of the variances, right-handed
};
AreaMoments area_moments(const Mesh& mesh, const std::vector<Index>& faces);

}  // namespace ostraka
