// Features of a candidate join and its learnt probability.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace ostraka {

/// Features of two fractures in a given relative pose. Lengths are divided by the tolerance (the last search radius), areas by
/// its square, unless they are ratios of something else.
struct JoinEvidence {
    double area = 0;      ///< contact area: within the tolerance, facing each other; mean of both sides
    double share = 0;     ///< contact area as a share of the smaller fracture
    double coverage = 0;  ///< contact area divided by the area within three tolerances of the other's fracture
    double residual = 0;  ///< root mean square distance along the normals
    double relief = 0;    ///< root mean square deviation of the contact area from a quadric
    double bending = 0;   ///< root mean square deviation of the contact area from a plane
    double grip = 0;  ///< how firmly contact and rim constrain the pose: smallest eigenvalue of their normal equations divided by
                      ///< the mean one (Gelfand et al. 2003); 0 where the fragments can slide
    double facing = 0;        ///< mean cosine between opposite normals in contact
    double rim = 0;           ///< length of the rim whose side the other fragment continues
    double rim_share = 0;     ///< the same as a share of the shorter rim
    double rim_coverage = 0;  ///< the same divided by the length within three tolerances of the other's rim
    double rim_step = 0;      ///< root mean square step across the side where it is continued
    double penetration = 0;  ///< area deeper inside the other than the tolerance, in both directions, divided by the contact area
    double depth = 0;        ///< depth of the deepest point
    double widths = 0;       ///< absolute logarithm of the ratio of the two fractures' widths
    // The intact sides beside the rims, which wear preserves: measured over the rim that could continue.
    double side_turn = 1;  ///< root mean square sine of the angle between their normals
    double side_step = 1;  ///< root mean square offset from each other's planes, divided by the distance between their centroids
    double side_length = 0;  ///< length of the rim over which this is measured

    // Quality of the data, independent of the pose.
    double noise = 0;      ///< noise of the intact surfaces: root mean square deviation from quadrics over small neighbourhoods
    double edge = 0;       ///< mean edge length of the coarser mesh
    double roughness = 0;  ///< root mean square deviation of the smoother fracture from a quadric

    // On a vessel the normals of the intact surfaces meet its axis, however worn the fractures are: root mean square distances
    // of the normals from the best axis, as shares of the smaller fragment's size.
    double axis = 0;      ///< excess of both together, from one common axis, over each from its own
    double own_axis = 0;  ///< deviation of both fragments, each from its own axis

    static constexpr std::size_t numbers = 23;  ///< number of members above
    static constexpr std::size_t count = 24;    ///< number of features
    /// Input of the model: logarithms and shares, each of the order of 1.
    [[nodiscard]] std::array<double, count> features() const;
    static const std::array<std::string, count>& names();
    /// Whether a feature is evidence about the join, rather than about the quality of the data.
    static bool is_join_feature(std::size_t feature) { return feature != 18 && feature != 19 && feature != 23; }
};

/// Log odds of a true join against chance from the evidence alone, learnt from fractures with known truth
/// (data/joins.model.json).
double join_log_odds(const JoinEvidence& evidence);
/// Calibrated probability that a candidate is right, from its log odds and their lead over the best other candidate of its pair
/// (below 0: behind).
double join_probability(double log_odds, double lead);
/// Correction of the log odds of a pair among this number of fragments: a fragment has about four neighbours, so the more
/// fragments there are, the smaller the share of joined pairs. 0 where the share is that of the training data.
double join_log_odds_correction(std::size_t fragments);
/// SHA-256 of the model: results of different models are not comparable.
std::string join_model_version();
/// The feature that is the strongest evidence against a join, as text.
std::string weakest_evidence(const JoinEvidence& evidence);

}  // namespace ostraka
