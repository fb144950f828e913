// Curves carried from one mesh to another, through the triangles of both.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/transfer/correspondence.h"

#include <string>
#include <vector>

namespace ostraka {

/// What became of one annotation that was laid on another mesh.
struct Laid {
    Annotation annotation;  ///< id, tag, colour, type, note and curves; elements settled; no attributes
    std::size_t places = 0, by_ray = 0, by_closest_point = 0, without_place = 0;
    std::size_t detours = 0;  ///< neighbours joined along edges, since no trace led from one to the other
    bool untangled = false;   ///< its outlines crossed; the interior was found by winding numbers
    bool lost = false;        ///< nothing of it has a place on the target
    std::string note;         ///< what else is to be known: that the number of its outlines changed
};

/// Lays annotations of `source`, by their curves or along their edges, on the target, without a vertex added. Places correspond
/// along the interpolated vertex normals of the coarser of the two meshes, so that there and back is the same place; where no
/// such line meets the other surface, the nearest place with a compatible normal is taken. Pieces longer than an edge of the
/// target are divided first; neighbours are joined by traces over the target, which are found once for each piece, so that
/// common borders stay common. Places in folds that the normal meets elsewhere before, and small loops, are left out between near
/// places; regions that part the whole source among them part the whole target. Places nearer than a ten-thousandth of an edge to
/// the straight piece between their neighbours are left out. Regions that are the whole mesh (`all`) stay that. O(k log n) for k
/// places. Results do not depend on threads.
std::vector<Laid> lay_curves(const Mesh& source, const std::vector<const Annotation*>& annotations, const SurfaceSearch& target,
                             const CorrespondenceOptions& options = {});

/// Gives the free annotations of `to`, a set on the target that has them under the same ids, their curves on it, from `from` on
/// `source`, and adds those that are missing there though they have a place. Returns what there is to say.
std::vector<std::string> lay_free_annotations(const Mesh& source, const AnnotationSet& from, const Mesh& target,
                                              AnnotationSet& to, const CorrespondenceOptions& options = {});

}  // namespace ostraka
