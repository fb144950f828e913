// Features of a candidate join and its learnt probability.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace ostraka {

/// Features of two fracture surfaces in a given relative pose. Lengths are divided by the tolerance (the last search radius),
/// areas by the squared tolerance, except for members described as ratios.
struct JoinEvidence {
    /// Contact area: area where the fracture surfaces face each other at a distance of at most the tolerance; mean of both
    /// surfaces.
    double area = 0;
    double share = 0;  ///< contact area as a fraction of the smaller fracture surface
    /// Contact area divided by the area that lies within three times the tolerance of the other fracture surface.
    double coverage = 0;
    /// Root mean square distance between the fracture surfaces over the contact area, along the normals.
    double residual = 0;
    double relief = 0;   ///< root mean square deviation of the contact area from a quadric
    double bending = 0;  ///< root mean square deviation of the contact area from a plane
    /// Degree to which contact area and rim determine the relative pose: smallest eigenvalue of the normal equations divided by
    /// the mean eigenvalue (Gelfand et al. 2003); 0 if the fragments can slide.
    double stability = 0;
    /// Mean over the contact area of the cosine between the normal of one fracture surface and the reversed normal of the
    /// other.
    double facing = 0;
    /// Length of the rim (border of the fracture surface) along which the other fragment continues the intact surface.
    double rim = 0;
    double rim_share = 0;  ///< `rim` as a fraction of the shorter rim
    /// `rim` divided by the length of the rim that lies within three times the tolerance of the other rim.
    double rim_coverage = 0;
    double rim_step = 0;  ///< root mean square offset between the two intact surfaces along `rim`
    /// Area of both fragments that lies inside the other fragment by more than the tolerance, divided by the contact area.
    double penetration = 0;
    double depth = 0;            ///< largest depth of a point of one fragment inside the other fragment
    double width_log_ratio = 0;  ///< absolute logarithm of the ratio of the widths of the two fracture surfaces
    // The next members compare the intact surfaces of both fragments beside the rims; wear changes these surfaces less than the
    // fracture surfaces. The comparison is made along the part of the rim where the fragments are close.
    double side_turn = 1;  ///< root mean square sine of the angle between the normals of the two intact surfaces
    /// Root mean square offset of each intact surface from the plane of the other one, divided by the distance between their
    /// centroids.
    double side_step = 1;
    double side_length = 0;  ///< length of the rim over which side_turn and side_step are measured

    // The next members describe the quality of the data, independent of the pose.
    double noise = 0;      ///< noise of the intact surfaces: root mean square deviation from quadrics over small neighbourhoods
    double edge = 0;       ///< mean edge length of the coarser mesh
    double roughness = 0;  ///< root mean square deviation of the smoother fracture surface from a quadric

    // The next members are root mean square distances of the normals of intact surfaces from a fitted axis, as fractions of the
    // smaller fragment's size. The normals of a vessel's surface meet its axis, even if the fractures are worn.
    /// Increase of the distance of the normals from the axis when both fragments share one axis instead of having one axis each
    /// (square root of the difference of the squared distances).
    double axis = 0;
    double own_axis = 0;  ///< distance of the normals of both fragments from the axis of their own fragment

    static constexpr std::size_t numbers = 23;  ///< number of features that are members of this struct
    static constexpr std::size_t count = 24;    ///< number of features of the model
    /// The features as input of the model, transformed to logarithms and fractions of the order of 1.
    [[nodiscard]] std::array<double, count> features() const;
    static const std::array<std::string, count>& names();  ///< names of the features
    /// True if the feature with this index describes the join, false if it describes the quality of the data.
    static bool is_join_feature(std::size_t feature) { return feature != 18 && feature != 19 && feature != 23; }
};

/// Log odds that the join is correct, predicted from the evidence alone by a model trained on fractures whose true joins are
/// known (data/joins.model.json).
double join_log_odds(const JoinEvidence& evidence);
/// Calibrated probability that a candidate pose of a pair is correct. `log_odds`: log odds of the candidate; `lead`: `log_odds`
/// minus the largest log odds of the pair's other candidates.
double join_probability(double log_odds, double lead);
/// Correction of the log odds of a pair for the number of fragments, to be added. A fragment has about four neighbours, so the
/// fraction of pairs that join decreases with the number of fragments. The correction is 0 if this fraction equals the fraction
/// in the training data.
double join_log_odds_correction(std::size_t fragments);
/// SHA-256 of the join model (data/joins.model.json); results of different models are not comparable.
std::string join_model_version();
/// The feature that is the strongest evidence against a join, as text.
std::string weakest_evidence(const JoinEvidence& evidence);

}  // namespace ostraka
