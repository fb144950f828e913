// Which annotation of a fragment is which of the template (thesis, section 5.4: "annotation correspondence", left open there).
#pragma once

#include "ostraka/annotation/annotation.h"
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
    /// What the score is made of, each 0 to 1: attributes they both have, containers, place under the pose, extent.
    double attributes = 1, containers = 1, place = 1, extent = 1;
    bool stated = false;  ///< by a person
};

/// What a person says: this one is that one, or (no template annotation) is none.
struct StatedMatch {
    int of_fragment = 0;
    std::optional<int> of_template;
};

/// Annotations of the same type and tag are candidates. Where several have a tag (two eyes), attributes, the tags of what
/// contains them, and the place and extent under the pose of the fragment distinguish them; each template annotation is given to
/// one of the fragment at most, with the largest sum of scores. A part of a part (half an eye) may be smaller, not larger.
/// `scaled` is the template at the scale and place of the pose's goal. Throws Error (input) for stated ids that are not there.
std::vector<AnnotationMatch> match_annotations(const Mesh& scaled, const AnnotationSet& of_template, const Mesh& fragment,
                                               const AnnotationSet& of_fragment, const Motion& pose,
                                               const std::vector<StatedMatch>& stated = {},
                                               const AnnotationMatchOptions& options = {});

}  // namespace ostraka
