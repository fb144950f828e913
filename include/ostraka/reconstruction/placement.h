// Registers fragments to a template by common landmarks (thesis, section 5.3.1, step 3, with its erratum): the template is
// scaled by one factor for all fragments, and each fragment is moved rigidly.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/geom/rigid_fit.h"

#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// A landmark that the template and a fragment have in common.
struct LandmarkPair {
    std::string name;                          ///< tag of the landmark
    Eigen::Vector3d on_template, on_fragment;  ///< position on the template, and position on the fragment
    Index vertex = no_index;                   ///< index of the landmark's vertex on the template
};

/// Landmarks common to the template and a fragment, ordered by tag: point annotations of one point with the same tag in both
/// sets, if the tag is unique in each set. Messages about tags that could not be used are added to `notes`.
std::vector<LandmarkPair> common_landmarks(AnnotatedMeshView template_object, AnnotatedMeshView fragment,
                                           std::vector<std::string>* notes = nullptr);

struct PlacementOptions {
    /// A landmark can be an outlier only if its residual is at least this share of the spread of all landmarks.
    double outlier = 0.25;
    /// A fragment is taken to be in another unit if its own scale differs from the scale of the others by more than this
    /// factor.
    double unit_ratio = 3;
    double collinear = 0.03;  ///< landmarks are collinear if their second principal extent is at most this share of the first

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Distance of one landmark of a placed fragment from the template's landmark.
struct LandmarkResidual {
    std::string name;     ///< tag of the landmark
    double distance = 0;  ///< distance of the moved landmark from the scaled template's landmark, in the fragment's unit
    bool used = true;     ///< false: the landmark is an outlier and is not used for the pose
};

/// Pose of a fragment on the scaled template.
struct FragmentPlacement {
    Motion pose;                              ///< rigid motion from the fragment's file to the scaled template
    double own_scale = 0;                     ///< scale of the template estimated from this fragment alone; for diagnosis
    std::vector<LandmarkResidual> landmarks;  ///< residual of each landmark
    double residual = 0;                      ///< root mean square residual of the landmarks used, in the fragment's unit
    bool mirrored = false;                    ///< true: the mirror image of the fragment fits far better
    std::vector<std::pair<std::string, std::string>> swapped;  ///< pairs of landmarks whose tags seem to be exchanged
    std::string problem;  ///< why the fragment is not placed, with the remedy; empty if it is placed
};

/// Poses of all fragments on the template at a common scale.
struct CommonPlacement {
    double scale = 1;                          ///< scale of the template, about its origin
    std::vector<FragmentPlacement> fragments;  ///< placement of each fragment
    [[nodiscard]] bool any() const;            ///< true if at least one fragment is placed
};

/// Places fragments by minimising the sum over fragments k and landmarks i of |R_k f_ki + t_k - s p_i|^2 in closed form
/// (rotations R_k from the singular value decomposition of the covariances, Umeyama 1991, independent of s; scale s from all
/// fragments together). Outliers are detected for each fragment by least quantile of squares (Rousseeuw 1984): among similarity
/// motions fitted to three landmarks, the one whose 5/6 quantile of the residuals is smallest defines the inliers (all triples
/// if there are at most 4000, else 4000 triples drawn with a fixed seed). At most a sixth of the landmarks, and one of five or
/// more, are excluded, each with a residual of more than four times the root mean square of the other residuals. A fragment
/// that cannot be placed has a `problem` (fewer than three landmarks, collinear landmarks, a mirror image, another unit) and is
/// not used for the scale.
CommonPlacement place_by_landmarks(const std::vector<std::vector<LandmarkPair>>& pairs, const PlacementOptions& options = {});

}  // namespace ostraka
