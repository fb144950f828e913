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
    /// Contact area: where the fracture surfaces face each other within the tolerance; mean of both sides.
    double area = 0;
    double share = 0;  ///< contact area as a fraction of the smaller fracture surface
    /// Contact area divided by the area within three tolerances of the other fracture surface.
    double coverage = 0;
    /// Root mean square distance between the fracture surfaces in contact, along the normals.
    double residual = 0;
    double relief = 0;   ///< root mean square deviation of the contact area from a quadric
    double bending = 0;  ///< root mean square deviation of the contact area from a plane
    /// How firmly contact area and rim constrain the pose: smallest eigenvalue of the normal equations divided by the mean
    /// eigenvalue (Gelfand et al. 2003); 0 if the fragments can slide.
    double grip = 0;
    double facing = 0;        ///< mean cosine between opposite normals in contact
    double rim = 0;           ///< length of the rim along which the other fragment continues the intact side
    double rim_share = 0;     ///< `rim` as a fraction of the shorter rim
    double rim_coverage = 0;  ///< `rim` divided by the length of rim within three tolerances of the other rim
    double rim_step = 0;      ///< root mean square step between the intact sides along the continued rim
    /// Area of each fragment that is deeper inside the other fragment than the tolerance, both together, divided by the contact
    /// area.
    double penetration = 0;
    double depth = 0;   ///< depth of the point of one fragment that lies deepest inside the other fragment
    double widths = 0;  ///< absolute logarithm of the ratio of the widths of the two fracture surfaces
    // The next members compare the intact sides beside the rims, which wear preserves, along the rim that could be continued.
    double side_turn = 1;  ///< root mean square sine of the angle between the normals of the two intact sides
    /// Root mean square offset of each intact side from the plane of the other, divided by the distance between their centroids.
    double side_step = 1;
    double side_length = 0;  ///< length of the rim over which side_turn and side_step are measured

    // The next members describe the quality of the data, independent of the pose.
    double noise = 0;      ///< noise of the intact surfaces: root mean square deviation from quadrics over small neighbourhoods
    double edge = 0;       ///< mean edge length of the coarser mesh
    double roughness = 0;  ///< root mean square deviation of the smoother fracture surface from a quadric

    // The next members are root mean square distances of the normals of intact surfaces from a fitted axis, as fractions of the
    // smaller fragment's size. On a vessel the normals meet its axis, however worn the fractures are.
    /// Distance of both fragments' normals from one common axis, less the distance from each fragment's own axis (root of the
    /// difference of squares).
    double axis = 0;
    double own_axis = 0;  ///< distance of both fragments' normals, each from the axis of its own fragment

    static constexpr std::size_t numbers = 23;  ///< number of features that are members of this struct
    static constexpr std::size_t count = 24;    ///< number of features of the model
    /// The features as input of the model: logarithms and fractions, each of the order of 1.
    [[nodiscard]] std::array<double, count> features() const;
    static const std::array<std::string, count>& names();  ///< names of the features
    /// True if the feature with this index describes the join, false if it describes the quality of the data.
    static bool is_join_feature(std::size_t feature) { return feature != 18 && feature != 19 && feature != 23; }
};

/// Log odds of a true join against chance from the evidence alone, learnt from fractures with known truth
/// (data/joins.model.json).
double join_log_odds(const JoinEvidence& evidence);
/// Calibrated probability that a candidate pose of a pair is correct. `log_odds`: of the candidate; `lead`: its log odds minus
/// the largest log odds of the other candidates of the pair.
double join_probability(double log_odds, double lead);
/// Correction added to the log odds of a pair for the number of fragments: a fragment has about four neighbours, so the more
/// fragments there are, the smaller the fraction of pairs that join. The correction is 0 if this fraction equals the fraction in
/// the training data.
double join_log_odds_correction(std::size_t fragments);
/// SHA-256 of the join model (data/joins.model.json); results of different models are not comparable.
std::string join_model_version();
/// The feature that is the strongest evidence against a join, as text.
std::string weakest_evidence(const JoinEvidence& evidence);

}  // namespace ostraka
