// Keeps regions disjoint on the target if they share no face on the source.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/geom/surface_search.h"

#include <functional>

namespace ostraka {

/// `selected`: for each annotation of the set, flags of the faces of `mesh` that were assigned to the annotation; empty if it has
/// no faces. A face assigned to several regions that share no face on the source is assigned to the region that covers most of
/// the face's projection onto the source (the first of several regions with equal coverage). If the regions of the set partition
/// the whole source, unassigned faces are assigned in the same way. The region of the whole object is ignored. `source_search` is
/// called only if there is such a face. Linear, except for these faces.
void keep_disjoint(AnnotatedMeshView source, const std::function<const SurfaceSearch&()>& source_search, const Mesh& mesh,
                   std::vector<std::vector<bool>>& selected);

}  // namespace ostraka
