// Where annotations want the vertices of a cage, and the plane that a symmetric cage is mirrored in.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/cage/cage.h"

namespace ostraka {

/// Density of cage vertices by the annotation that is nearest (thesis, section 6.1.1). With `factors` (id, factor) the largest
/// factor of the regions, lines and points within a twentieth of the diagonal counts; without, places that near to an annotated
/// point, to a line, or to an outline of a region other than the whole get 4. Elsewhere 1. The result owns what it needs.
CageDensity annotation_density(const Mesh& mesh, const AnnotationSet& set,
                               const std::vector<std::pair<int, double>>& factors = {});

/// The plane in which the whole object is mirror-symmetric (relation/geometric.h). Throws Error (failure) that names `where` if
/// there is none.
MirrorPlane find_mirror_plane(const Mesh& mesh, AnnotationSet set, const std::string& where);

}  // namespace ostraka
