// Matches the annotations of a fragment with the annotations of the template ("annotation correspondence", which section 5.4 of
// the thesis leaves open).
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/geom/rigid_fit.h"

#include <optional>
#include <vector>

namespace ostraka {

struct AnnotationMatchOptions {
    double min_score = 0.4;  ///< min score of a match, 0 to 1

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// An annotation of a fragment and its counterpart on the template.
struct AnnotationMatch {
    int fragment_annotation = 0, template_annotation = 0;  ///< annotation ids
    double score = 0;                                      ///< agreement of the two annotations, 0 to 1
    /// Terms of the score, each 0 to 1: agreement of attributes, of the tags of the containers, of position under the pose, and
    /// of extent.
    double attributes = 1, containers = 1, place = 1, extent = 1;
    bool stated = false;  ///< true: the match was stated by the user, not computed
};

/// A match stated by the user: names the counterpart of a fragment's annotation, or states that there is none.
struct StatedMatch {
    int fragment_annotation = 0;             ///< id of the fragment's annotation
    std::optional<int> template_annotation;  ///< id of the template's annotation; empty: no counterpart
};

/// Matches annotations of the same type and tag. Several annotations with one tag (two eyes) are distinguished by their
/// attributes, the tags of their containers, and their position and extent under the pose of the fragment; the assignment is
/// one-to-one, with the largest sum of scores. A part of a part (half an eye) may be smaller than its counterpart, but not
/// larger. `scaled`: the template at the scale and in the coordinates to which `pose` maps the fragment. Throws Error (input)
/// for ids in `stated` that do not exist.
std::vector<AnnotationMatch> match_annotations(AnnotatedMeshView scaled, AnnotatedMeshView fragment, const Motion& pose,
                                               const std::vector<StatedMatch>& stated = {},
                                               const AnnotationMatchOptions& options = {});

}  // namespace ostraka
