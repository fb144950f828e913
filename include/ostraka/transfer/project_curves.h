// Projects curves that run through the triangles of one mesh onto another mesh.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/transfer/correspondence.h"

#include <string>
#include <vector>

namespace ostraka {

/// Result of projecting one annotation onto another mesh.
struct ProjectedAnnotation {
    Annotation annotation;  ///< id, tag, colour, type, note, curves and the elements that follow from the curves; no attributes
    /// Number of places (points of the curves) in total, of places projected along a normal, of places projected to the closest
    /// point, and of places without a corresponding place.
    std::size_t places = 0, by_ray = 0, by_closest_point = 0, without_place = 0;
    std::size_t detours = 0;  ///< number of pairs of consecutive places connected along edges, because no trace connected them
    bool untangled = false;   ///< true: the outlines intersected, and the interior was computed by winding numbers
    bool lost = false;        ///< true: no part of the annotation has a corresponding place on the target
    std::string note;         ///< further messages, for example that the number of outlines changed
};

/// Projects annotations of `source`, given by curves or edge paths, onto the target, without adding vertices. Places correspond
/// along the interpolated vertex normals of the coarser of the two meshes, so that the mapping is invertible; where no such line
/// meets the other surface, the nearest place with a compatible normal is used. Segments longer than an edge of the target are
/// subdivided first. Consecutive places are connected by traces on the target. Each segment is traced only once, so that
/// adjacent regions still share their border. Small loops between nearby places are removed, and places in folds (where the
/// line along the normal first hits another part of the surface). If regions partition the whole source, their projections
/// partition the whole target. Places closer than a ten-thousandth of an edge to the straight segment between their neighbours
/// are dropped. Regions that are the whole mesh (`all`) stay the whole mesh. Time: O(k log n) for k places. The result does not
/// depend on the number of threads.
std::vector<ProjectedAnnotation> project_curves(const Mesh& source, const std::vector<const Annotation*>& annotations,
                                                const SurfaceSearch& target, const CorrespondenceOptions& options = {});

/// Projects the free annotations of `source` onto the target and stores their curves in the annotations of `to` with the same
/// ids. Annotations missing in `to` are added if they have corresponding places. Returns notes.
std::vector<std::string> project_free_annotations(AnnotatedMeshView source, const Mesh& target, AnnotationSet& to,
                                                  const CorrespondenceOptions& options = {});

}  // namespace ostraka
