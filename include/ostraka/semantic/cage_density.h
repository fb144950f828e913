// Computes the vertex density of a cage from annotations, and the mirror plane for a symmetric cage.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/cage/cage.h"

namespace ostraka {

/// Density of cage vertices as a function of position, from the nearest annotation (thesis, section 6.1.1). With `factors` (pairs
/// of annotation id and factor) the density is the largest factor of the regions, lines and points within a twentieth of the
/// mesh's diagonal. Without factors the density is 4 within this distance of an annotated point, a line, or the outline of a
/// region other than the whole. Elsewhere the density is 1. The result keeps no references to the arguments.
CageDensity annotation_density(AnnotatedMeshView object, const std::vector<std::pair<int, double>>& factors = {});

/// The mirror plane of the whole object (relation/geometric.h). `where` names the object in errors. Throws Error (failure) if the
/// object is not mirror-symmetric.
MirrorPlane find_mirror_plane(const Mesh& mesh, AnnotationSet set, const std::string& where);

}  // namespace ostraka
