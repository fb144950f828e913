// Thin-plate splines of landmarks in two and three dimensions (Bookstein 1989; Gunz, Mitteroecker and Bookstein 2005).
#pragma once

#include "ostraka/morphometrics/shape_sample.h"

#include <memory>

namespace ostraka {

/// The bending energy matrix B of a reference: for landmarks Y, trace(Y^T B Y) is the bending energy of the spline from the
/// reference to Y, up to a constant factor. B is symmetric and positive semidefinite, k x k, and maps affine images of the
/// reference to 0. Kernel r^2 log r^2 in the plane, -r in space. Throws Error (input) if landmarks are not finite. Time: O(k^3).
Eigen::MatrixXd bending_energy_matrix(const Landmarks& reference, int dimension);

/// The interpolating thin-plate spline that maps the landmarks `from` to `to`.
class ThinPlateSpline {
public:
    /// Throws Error (input) if both do not have the same number of landmarks, all finite, or fewer than two.
    ThinPlateSpline(const Landmarks& from, const Landmarks& to, int dimension);
    /// Images of points; in two dimensions z is 0.
    [[nodiscard]] Landmarks operator()(const Landmarks& points) const;
    [[nodiscard]] double bending_energy() const { return energy_; }  ///< trace(Y^T B Y), see bending_energy_matrix

private:
    int dimension_;
    Landmarks from_;
    Eigen::MatrixXd weights_, affine_;
    double scale_ = 1, energy_ = 0;
};

/// A square grid over the bounding box of `from`, deformed by the thin-plate spline to `to`, as poly-lines: `cells` squares along
/// the longer side of the box, which is enlarged by `margin` of its size; each square side has `steps` segments.
std::vector<std::vector<std::array<double, 2>>> deformation_grid(const Landmarks& from, const Landmarks& to, int cells = 14,
                                                                 double margin = 0.12, int steps = 4);

}  // namespace ostraka
