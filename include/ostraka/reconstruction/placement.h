// Registers fragments to a template by common landmarks (thesis, section 5.3.1, step 3, with its erratum): one scale, on the
// template, for all fragments together; each fragment moves rigidly.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/geom/rigid_fit.h"

#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// A landmark common to the template and a fragment.
struct LandmarkPair {
    std::string name;
    Eigen::Vector3d on_template, on_fragment;
    Index vertex = no_index;  ///< vertex of the template
};

/// Point annotations of one point with the same tag in both sets, if the tag is unique in either, ordered by tag. `notes` gets
/// the tags that could not be used, with the reason.
std::vector<LandmarkPair> common_landmarks(AnnotatedMeshView template_object, AnnotatedMeshView fragment,
                                           std::vector<std::string>* notes = nullptr);

struct PlacementOptions {
    double outlier = 0.25;    ///< residual of a potential outlier, as a share of the spread of all landmarks
    double unit_ratio = 3;    ///< a fragment whose own scale differs from the others' by a larger factor is in another unit
    double collinear = 0.03;  ///< max ratio of second to first extent of collinear landmarks

    void describe(OptionList& visit);
};

/// Residual of one landmark.
struct LandmarkResidual {
    std::string name;
    double distance = 0;  ///< between the moved landmark and that of the scaled template, in the fragment's unit
    bool used = true;     ///< false: an outlier, left out
};

struct FragmentPlacement {
    Motion pose;           ///< rigid: from the fragment's file to the scaled template
    double own_scale = 0;  ///< scale of the template from this fragment alone: a diagnostic
    std::vector<LandmarkResidual> landmarks;
    double residual = 0;    ///< root mean square over the landmarks used, in the fragment's unit
    bool mirrored = false;  ///< its mirror image fits far better
    std::vector<std::pair<std::string, std::string>> swapped;  ///< landmarks whose tags seem to be exchanged
    std::string problem;                                       ///< why it is not placed, with the remedy; empty if it is placed
};

struct CommonPlacement {
    double scale = 1;  ///< scale of the template, about its origin
    std::vector<FragmentPlacement> fragments;
    [[nodiscard]] bool any() const;  ///< whether any fragment is placed
};

/// Minimises the sum over fragments k and landmarks i of |R_k f_ki + t_k - s p_i|^2 in closed form (rotations from the singular
/// value decomposition of the covariances, Umeyama 1991; they do not depend on s; s from all fragments together). Outliers are
/// detected per fragment by least quantile of squares (Rousseeuw 1984): the similarity through three landmarks with the
/// smallest residual quantile at five sixths defines the inliers (all triples if there are at most 4000, else that number drawn
/// with a fixed seed). At most a sixth of the landmarks, and one of five or more, are left out, each with a residual of more
/// than four times the root mean square of the others. A fragment that cannot be placed has a `problem` (fewer than three
/// landmarks, collinear landmarks, a mirror image, another unit) and does not count for the scale.
CommonPlacement place_by_landmarks(const std::vector<std::vector<LandmarkPair>>& pairs, const PlacementOptions& options = {});

}  // namespace ostraka
