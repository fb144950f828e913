// Slides semi-landmarks along curves and surfaces (Bookstein 1997; Gunz, Mitteroecker and Bookstein 2005; Perez et al. 2006).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/morphometrics/shape_sample.h"

#include <functional>
#include <vector>

namespace ostraka {

/// A semi-landmark on a curve: it slides along the direction from `before` to `after`.
struct Slider {
    std::size_t before = 0, slides = 0, after = 0;  ///< indices of landmarks
};

/// What is minimised.
enum class SlidingCriterion {
    bending_energy,      ///< bending energy of the thin-plate spline from the mean to the specimen
    procrustes_distance  ///< Procrustes distance from the mean
};

struct SlidingOptions {
    SlidingCriterion criterion = SlidingCriterion::bending_energy;
    int iterations = 30;                     ///< max number of alternations of sliding and superimposition
    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A point on the surface of a specimen, with the unit normal of the surface there.
struct OrientedPoint {
    Eigen::RowVector3d point, normal;
};
/// The place on the surface of a specimen that is closest to a point; called by several threads.
using SurfaceOfSpecimen = std::function<OrientedPoint(std::size_t specimen, const Eigen::RowVector3d& point)>;

/// Semi-landmarks of a sample.
struct SemiLandmarks {
    std::vector<Slider> curves;        ///< semi-landmarks on curves
    std::vector<std::size_t> surface;  ///< indices of semi-landmarks on surfaces
    /// Surface of each specimen; empty: tangent planes are fitted to the five landmarks nearest to the semi-landmark in the mean.
    SurfaceOfSpecimen surface_of;
    [[nodiscard]] bool empty() const { return curves.empty() && surface.empty(); }
};

/// Configurations whose semi-landmarks were slid.
struct SlidSample {
    ShapeSample sample;  ///< in the place and size of the sample given
    int iterations = 0;
    bool converged = false;            ///< true: the mean moved by less than 1e-6 of its size in the last alternation
    double energy_before = 0;          ///< sum of bending energies relative to the first mean, sizes 1, before sliding
    double energy_after = 0;           ///< sum of bending energies relative to the last mean, sizes 1
    double moved = 0;                  ///< root mean square of the distances that semi-landmarks moved, relative to centroid size
    std::vector<std::string> notes{};  ///< messages
};

/// Slides semi-landmarks of complete configurations in alternation with generalised Procrustes superimposition, scaled to unit
/// centroid size. Tangents are those of the current configuration: chords between neighbours on curves, planes on surfaces. With
/// `surface_of` slid semi-landmarks are projected back onto their surface. Bending energy: the closed form T = -(U^T L U)^-1 U^T
/// L Y of Gunz et al. (2005), equations 6 and 7; Procrustes distance: projections of the deviation onto the tangents. Throws
/// Error (input) for indices beyond the landmarks, a landmark that slides twice, and fewer than three landmarks that do not
/// slide. Time: O(k^3) for the mean and O(s^3 + s k^2) for each specimen per iteration (s semi-landmarks of k landmarks).
SlidSample slide_semilandmarks(const ShapeSample& sample, const SemiLandmarks& semi, const SlidingOptions& options = {});

}  // namespace ostraka
