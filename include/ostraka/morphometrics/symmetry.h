// Symmetric and asymmetric components of shape (Mardia, Bookstein and Moreton 2000; Klingenberg, Barluenga and Meyer 2002).
#pragma once

#include "ostraka/morphometrics/shape_sample.h"
#include "ostraka/stats/permuted_model.h"

namespace ostraka {

/// How the specimens of a symmetry analysis belong together.
struct SymmetryDesign {
    std::vector<std::string> individuals;  ///< for each specimen, its individual; measurements of one individual are replicates
    /// Matching symmetry: for each specimen, its side; two sides. Empty: object symmetry.
    std::vector<std::string> sides;
    LandmarkPairs pairs;  ///< object symmetry: landmarks on both sides
};

/// Result of a symmetry analysis.
struct SymmetryAnalysis {
    Anova shape;                             ///< terms individual, side, individual:side, and residuals (replicates)
    std::optional<Anova> size;               ///< matching symmetry: the same of log centroid size
    Landmarks mean;                          ///< mean shape; for object symmetry it is symmetric
    std::vector<std::string> individuals;    ///< names of the individuals, in the order of the specimens
    std::vector<Landmarks> symmetric;        ///< for each individual, its symmetric shape
    std::vector<Landmarks> asymmetric;       ///< for each individual, the mean plus its difference of sides, halved
    Landmarks directional;                   ///< mean plus the mean of the left-right differences: directional asymmetry
    std::vector<double> asymmetry;           ///< for each individual, norm of the difference of its sides, halved
    std::vector<double> fluctuating;         ///< the same after the directional asymmetry is subtracted
    double symmetric_share = 0;              ///< share of the variation of individuals and their sides that is symmetric
    std::optional<Repeatability> replicate;  ///< agreement of replicates, if there are any
    std::vector<std::string> notes;
};

/// Two-way analysis of variance of individuals and sides. Object symmetry: each configuration and its relabelled mirror are
/// superimposed together and stand for the two sides; matching symmetry: configurations of the second side (in the order of
/// names) are mirrored. Configurations are scaled to centroid size 1. Individuals and sides are tested against their interaction,
/// which is tested against the residuals if there are replicates. Throws Error (input) for incomplete configurations, fewer than
/// two individuals, matching symmetry unless there are two sides, or an individual with one side alone.
SymmetryAnalysis symmetry_analysis(const ShapeSample& sample, const SymmetryDesign& design,
                                   const PermutationOptions& options = {});

}  // namespace ostraka
