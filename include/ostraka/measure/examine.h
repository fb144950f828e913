// Summarises a set of annotations and finds its defects.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/finding.h"

namespace ostraka {

/// Size of one annotation: numbers of elements and components, area, length.
struct AnnotationSummary {
    std::size_t elements = 0;  ///< number of faces, edges or points
    std::size_t patches = 0;   ///< number of connected components of a region (over edges), poly-lines of a line, or points
    std::size_t outlines = 0;  ///< number of outlines of a region; 0 for other types
    double area = 0;           ///< area of a region, in the mesh's unit squared; 0 for other types
    double length = 0;         ///< perimeter of a region, or length of a line, in the mesh's unit
};
/// Computes the size of an annotation.
AnnotationSummary summarise(const Mesh& mesh, const Annotation& annotation);

/// Checks a set of annotations. Defects: empty selections, repeated points, poly-lines that traverse an edge twice, missing tags,
/// stale values, and values that differ from recomputed values by more than a millionth (relative). Remarks: regions with several
/// components, outlines that touch themselves or each other, tags used more than once. The set must have passed
/// `check_annotations`.
std::vector<Finding> examine(AnnotatedMeshView object);

}  // namespace ostraka
