// Fragments registered to a template by landmarks that both have (thesis, section 5.3.1, step 3, with its erratum): one scale, on
// the template, for all fragments together; each fragment moves rigidly.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"
#include "ostraka/geom/rigid_fit.h"

#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// A place that the template and a fragment both have.
struct LandmarkPair {
    std::string name;
    Eigen::Vector3d on_template, on_fragment;
    Index vertex = no_index;  ///< of the template
};

/// Point annotations of one point that both sets have under one tag, each tag once on either side, by tag. `notes` says which
/// tags could not be used and why.
std::vector<LandmarkPair> common_landmarks(const Mesh& template_mesh, const AnnotationSet& of_template, const Mesh& fragment,
                                           const AnnotationSet& of_fragment, std::vector<std::string>* notes = nullptr);

struct PlacementOptions {
    double outlier = 0.25;    ///< a landmark farther off than this, as a share of the spread of all, may be a wrong one
    double unit_ratio = 3;    ///< a fragment whose own scale differs from the others' by more is of another unit
    double collinear = 0.03;  ///< landmarks whose second extent is below this share of the first are on a line

    void describe(OptionList& visit);
};

/// How one landmark fits.
struct LandmarkResidual {
    std::string name;
    double distance = 0;  ///< between the moved landmark and the scaled template's, in the fragment's unit
    bool used = true;     ///< false: a wrong one, left out
};

struct FragmentPlacement {
    Motion pose;           ///< rigid: from the fragment's file to the scaled template
    double own_scale = 0;  ///< of the template, if this fragment alone had to say: a diagnostic
    std::vector<LandmarkResidual> landmarks;
    double residual = 0;    ///< root mean square over the landmarks used, in the fragment's unit
    bool mirrored = false;  ///< its mirror image fits far better than itself
    std::vector<std::pair<std::string, std::string>> swapped;  ///< landmarks whose tags look exchanged
    std::string problem;                                       ///< why it is not placed, in words with the remedy; empty if it is
};

struct CommonPlacement {
    double scale = 1;  ///< of the template, about its origin
    std::vector<FragmentPlacement> fragments;
    [[nodiscard]] bool any() const;  ///< a fragment is placed
};

/// Minimises the sum over fragments k and landmarks i of |R_k f_ki + t_k - s p_i|^2 in closed form (rotations from the singular
/// values of the covariances, Umeyama 1991; they do not depend on s; s from all fragments together). Wrong landmarks are found
/// fragment by fragment: of the similarities through three of them the one that has the nearest five sixths nearest (least
/// quantile of squares, Rousseeuw 1984; all triples where there are at most 4000, else as many drawn with a fixed seed) tells who
/// belongs; a sixth of them at most, and of five or more one, are left out, each off by four times the root mean square of the
/// others. A fragment that cannot be placed has a `problem` (fewer than three landmarks, all on a line, a mirror image, another
/// unit) and does not count for the scale.
CommonPlacement place_by_landmarks(const std::vector<std::vector<LandmarkPair>>& pairs, const PlacementOptions& options = {});

}  // namespace ostraka
