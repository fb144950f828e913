// Measures the overlap of a region before and after transfer.
#pragma once

#include "ostraka/annotation/curves.h"
#include "ostraka/geom/polyline_distance.h"
#include "ostraka/transfer/transfer.h"

#include <functional>
#include <memory>

namespace ostraka {

/// One of the two meshes with its search tree (for a refined target: the search tree of the target itself).
struct ScoredMesh {
    const Mesh& mesh;
    const SurfaceSearch& search;
};

/// Point location in a region with a free outline.
class FreeRegion {
public:
    FreeRegion(const Mesh& mesh, const Annotation& annotation);
    [[nodiscard]] bool contains(Index face, const Point& place) const;  ///< whether a place in this face lies in the region
    /// Whether the outline crosses the face.
    [[nodiscard]] bool cuts(Index face) const { return filling_.sides[face] == FaceSide::cut; }
    [[nodiscard]] double share(Index face) const;  ///< share of the face's area that lies in the region
    [[nodiscard]] const CurveFilling& filling() const { return filling_; }

private:
    CurveFilling filling_;  ///< faces inside, outside and cut by the outline
    CutFaces cut_;          ///< parts of the faces that the outline cuts
};

/// The elements of a region on its mesh.
struct RegionArea {
    std::vector<Index> faces;                ///< faces in the region, completely or partly
    std::vector<Index> rim;                  ///< vertices on the outline of the region
    std::shared_ptr<const FreeRegion> free;  ///< point location, if the outline is free; null otherwise
};
/// The elements of a region.
RegionArea region_area(const Mesh& mesh, const Annotation& annotation);

/// A region on source and target, whose overlap is to be measured.
struct OverlapQuestion {
    RegionArea source, target;                         ///< the region on both meshes
    std::function<bool(const SurfaceHit&)> in_target;  ///< true for places on the target that lie in the target region
    TransferScore* score;                              ///< gets overlap and wrong_side; the areas are already set
};

/// Computes overlap and wrong side of each region in both directions, since the surfaces differ: the part of the source region
/// that is mapped inside the target region, and the part of the target region that is mapped inside the source region. Faces near
/// the outline of a region are subdivided into up to 64 triangles, finer than the other mesh's faces, and sampled at the
/// centroids of the triangles (only four triangles if these agree and no corner is on the outline). Other faces are sampled at
/// their centroids; if there are more than some thousand such faces, only a regular subset is sampled. All regions are processed
/// in parallel.
void score_overlaps(const ScoredMesh& source, const ScoredMesh& target, const std::vector<OverlapQuestion>& questions,
                    const CorrespondenceOptions& options);

/// For each face of the target, whether the point of the source that is nearest to its centroid and has a compatible normal is in
/// the region.
std::vector<bool> region_by_vote(const Mesh& source, const SurfaceSearch& source_search, const std::vector<Index>& region,
                                 const Mesh& target, const CorrespondenceOptions& options);

/// The outline of a region, the segments of a line, or points as segments of length zero.
Segments segments_of(const Mesh& mesh, const Annotation& annotation);
/// Total length of the segments.
double length_of(const Segments& segments);

}  // namespace ostraka
