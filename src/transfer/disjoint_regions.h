// Regions that share no face keep none in common.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/geom/surface_search.h"

#include <functional>

namespace ostraka {

/// `selected`: for each annotation of the set flags of the faces of `mesh` that it took, an empty list where it has none. A face
/// that several regions took which share no face on the source goes to the one that holds most of it there, of equal ones to the
/// first; and where the regions of the set part the whole source among them, a face that none took likewise. The region that is
/// the whole object does not count. `source_search` is asked for only where there is such a face. Linear but for those faces.
void keep_disjoint(const Mesh& source, const AnnotationSet& set, const std::function<const SurfaceSearch&()>& source_search,
                   const Mesh& mesh, std::vector<std::vector<bool>>& selected);

}  // namespace ostraka
