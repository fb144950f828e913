// What a set of annotations amounts to, and what is doubtful about it.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/finding.h"

namespace ostraka {

/// Figures of one annotation.
struct AnnotationSummary {
    std::size_t elements = 0;  ///< faces, edges or points
    std::size_t patches = 0;   ///< parts of a region connected over edges; poly-lines of a line; points
    std::size_t outlines = 0;  ///< of a region
    double area = 0;           ///< of a region, in the mesh's unit squared
    double length = 0;         ///< perimeter of a region, length of a line
};
AnnotationSummary summarise(const Mesh& mesh, const Annotation& annotation);

/// Looks for empty selections, repeated points, poly-lines that run twice over an edge, missing tags, stale values, and values
/// that differ from those computed anew by more than a millionth of themselves (defects); regions in several patches, outlines
/// that touch themselves or each other, tags used more than once (remarks). The set must have passed `check_annotations`.
std::vector<Finding> examine(const Mesh& mesh, const AnnotationSet& set);

}  // namespace ostraka
