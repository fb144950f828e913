// Matches the annotations of a fragment with those of the template (thesis, section 5.4: "annotation correspondence", left open
// there).
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/geom/rigid_fit.h"

#include <optional>
#include <vector>

namespace ostraka {

struct AnnotationMatchOptions {
    double min_score = 0.4;

    void describe(OptionList& visit);
};

/// An annotation of a fragment and its counterpart.
struct AnnotationMatch {
    int of_fragment = 0, of_template = 0;  ///< ids
    double score = 0;                      ///< 0 to 1
    /// Terms of the score, each 0 to 1: common attributes, containers, position under the pose, extent.
    double attributes = 1, containers = 1, place = 1, extent = 1;
    bool stated = false;  ///< stated by the user
};

/// A match stated by the user: the counterpart of a fragment's annotation, or (no template annotation) that it has none.
struct StatedMatch {
    int of_fragment = 0;
    std::optional<int> of_template;
};

/// Annotations of the same type and tag are candidates. If several have a tag (two eyes), they are distinguished by their
/// attributes, the tags of their containers, and their position and extent under the pose of the fragment; the assignment is
/// one-to-one, with the largest sum of scores. A part of a part (half an eye) may be smaller, not larger. `scaled` is the
/// template in the target frame of the pose. Throws Error (input) for stated ids that do not exist.
std::vector<AnnotationMatch> match_annotations(AnnotatedMeshView scaled, AnnotatedMeshView fragment, const Motion& pose,
                                               const std::vector<StatedMatch>& stated = {},
                                               const AnnotationMatchOptions& options = {});

}  // namespace ostraka
