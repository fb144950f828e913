// Functions shared by the methods that find axes.
#pragma once

#include "ostraka/axis/axis.h"
#include "ostraka/core/angles.h"
#include "ostraka/geom/circle.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/line.h"

namespace ostraka::detail {

/// The vector v or -v, whichever has a positive component of largest magnitude.
inline Vector3d oriented(const Vector3d& v) {
    Eigen::Index largest = 0;
    v.cwiseAbs().maxCoeff(&largest);
    return v[largest] < 0 ? Vector3d(-v) : v;
}

/// Two unit vectors that complete the unit vector `a` to a right-handed frame.
inline std::pair<Vector3d, Vector3d> across(const Vector3d& a) {
    const Vector3d u = a.unitOrthogonal();
    return {u, a.cross(u)};
}

/// Per cent of the full turn that the angles cover (`angle_covered`).
inline double covered_percent(std::vector<double> angles) { return 100 * angle_covered(std::move(angles)) / (2 * pi); }

/// Area moments of a part. Throws Error (usage) for options out of range, Error (input) if no face has an area.
AreaMoments part_moments(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options);
/// Diagonal of the bounding box of the faces.
double part_diagonal(const Mesh& mesh, const std::vector<Index>& faces);
/// Min and max height of the faces along a direction, measured from `place`; the range always includes 0.
std::pair<double, double> extent_along(const Mesh& mesh, const std::vector<Index>& faces, const Vector3d& place,
                                       const Vector3d& direction);
/// Sets the straight axis of a result; the stored point is the point of the line closest to `centre`.
void set_line(Axis& axis, const Vector3d& point, const Vector3d& direction, const Vector3d& centre);

}  // namespace ostraka::detail
