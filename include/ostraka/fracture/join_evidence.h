// What would be seen of two breaks if they belonged together, and how likely that makes it.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace ostraka {

/// Of two breaks laid against each other. Lengths are shares of the tolerance (the last search radius), areas of its square,
/// unless they are shares of something else.
struct JoinEvidence {
    double area = 0;       ///< in contact: within the tolerance, facing each other; mean of both sides
    double share = 0;      ///< of the smaller fracture
    double coverage = 0;   ///< contact by the area that could touch: within three tolerances of the other's fracture
    double residual = 0;   ///< root mean square distance along the normals
    double relief = 0;     ///< root mean square deviation of what is in contact from a quadric
    double bending = 0;    ///< from a plane
    double grip = 0;       ///< how firmly contact and rim hold the pose: smallest eigenvalue of their normal equations over the
                           ///< mean one (Gelfand et al. 2003), 0 where they slide on each other
    double facing = 0;     ///< mean cosine between opposite normals in contact
    double rim = 0;        ///< length of the rim whose side the other continues
    double rim_share = 0;  ///< of the shorter rim
    double rim_coverage = 0;  ///< continued by what could be: within three tolerances of the other's rim
    double rim_step = 0;      ///< root mean square step across the side where it is continued
    double penetration = 0;   ///< area deeper in the other than the tolerance, both ways, by the contact
    double depth = 0;         ///< of the deepest point
    double widths = 0;        ///< absolute logarithm of the ratio of the two fractures' widths
    // The sides beside the rims, which wear leaves as they were: over what rim could continue.
    double side_turn = 1;    ///< root mean square sine between their normals
    double side_step = 1;    ///< root mean square offset from each other's planes, by the distance between their middles
    double side_length = 0;  ///< length of the rim that this is seen of

    // How well anything is seen of the two, wherever they are laid.
    double noise = 0;   ///< of the intact surfaces: root mean square deviation from quadrics over small neighbourhoods
    double edge = 0;    ///< mean length of the edges of the coarser mesh
    double breaks = 0;  ///< root mean square deviation of the smoother one's break from a quadric

    // Of a vessel the normals of the intact surfaces meet its axis, whatever wear took from the breaks: root mean square
    // distances from the best axis, shares of the smaller fragment's size.
    double axis = 0;      ///< of both together, beyond that of each from its own
    double own_axis = 0;  ///< of both, each from its own

    static constexpr std::size_t numbers = 23;  ///< above
    static constexpr std::size_t count = 24;    ///< features
    /// What the model is told: logarithms and shares, each of the order of 1.
    [[nodiscard]] std::array<double, count> features() const;
    static const std::array<std::string, count>& names();
    /// Whether a feature speaks for or against a join, not only of how well anything is seen.
    static bool of_the_join(std::size_t feature) { return feature != 18 && feature != 19 && feature != 23; }
};

/// Of the evidence alone: that two fragments were joined so, against what is seen by chance, as learnt from breaks whose truth is
/// known (data/joins.model.json).
double join_log_odds(const JoinEvidence& seen);
/// Calibrated: that a candidate is right, by its log odds and how far they are ahead of the best other candidate of its pair
/// (below 0: behind).
double join_probability(double log_odds, double lead);
/// What is added to the log odds of a pair among so many fragments: a fragment has about four neighbours, so the more there are,
/// the fewer pairs are joined. 0 where they are as many as in what was learnt from.
double log_odds_of_a_join_among(std::size_t fragments);
/// SHA-256 of the model: what was said by another one is not said by this.
std::string join_model_version();
/// What speaks most against a join, in words.
std::string weakest_evidence(const JoinEvidence& seen);

}  // namespace ostraka
