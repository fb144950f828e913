// Preserves partitions of a whole surface by free regions when curves are projected.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/transfer/project_curves.h"

#include <vector>

namespace ostraka {

/// Whether two or more of the annotations are regions that partition the whole surface of the mesh: the areas of the regions add
/// up to the area of the mesh, to rounding. The annotation of the whole mesh (`all`) is ignored.
bool part_surface(const Mesh& mesh, const std::vector<const Annotation*>& annotations);

/// If the regions among the annotations partition the whole surface of `source`, makes their projections partition `target` as
/// well: pieces that belong to no region or several regions are assigned to the region with which they share most of their
/// border. Does nothing if the projections already partition `target`. Time: O(n log n) for n faces of the target cut along all
/// outlines.
void keep_partition(const Mesh& source, const std::vector<const Annotation*>& annotations, const Mesh& target,
                    std::vector<ProjectedAnnotation>& projected);

}  // namespace ostraka
