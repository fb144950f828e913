// Overlap of a region before and after transfer.
#pragma once

#include "ostraka/annotation/curves.h"
#include "ostraka/geom/polyline_distance.h"
#include "ostraka/transfer/transfer.h"

#include <functional>
#include <memory>

namespace ostraka {

/// One of the two meshes with its search tree (for a refined target: the tree of the target itself).
struct ScoredMesh {
    const Mesh& mesh;
    const SurfaceSearch& search;
};

/// Point location in a free region.
class FreeRegion {
public:
    FreeRegion(const Mesh& mesh, const Annotation& annotation);
    [[nodiscard]] bool contains(Index face, const Point& place) const;
    [[nodiscard]] bool cuts(Index face) const { return filling_.sides[face] == FaceSide::cut; }
    [[nodiscard]] double share(Index face) const;
    [[nodiscard]] const CurveFilling& filling() const { return filling_; }

private:
    CurveFilling filling_;
    CutFaces cut_;
};

/// The elements of a region on its mesh.
struct RegionArea {
    std::vector<Index> faces;  ///< faces in the region, completely or partly
    std::vector<Index> rim;    ///< vertices on its outline
    std::shared_ptr<const FreeRegion> free;
};
RegionArea region_area(const Mesh& mesh, const Annotation& annotation);

/// A region on both meshes, and the predicate whether a place on the target lies in it.
struct OverlapQuestion {
    RegionArea source, target;
    std::function<bool(const SurfaceHit&)> in_target;
    TransferScore* score;  ///< receives overlap and wrong_side; its areas are already set
};

/// Computes overlap and wrong side from both sides, since the surfaces differ: the part of the source region that arrived
/// inside, and the part of the target region that came from inside. Faces near the outline of a region are subdivided into up
/// to 64 triangles, finer than the other mesh's faces, and sampled at their centroids (only four triangles if these agree and
/// no corner is on the outline). Other faces are sampled at their centroids; of more than some thousand such faces, only a
/// regular subset. All regions are processed in parallel.
void score_overlaps(const ScoredMesh& source, const ScoredMesh& target, const std::vector<OverlapQuestion>& questions,
                    const CorrespondenceOptions& options);

/// Classifies the faces one by one: selects the target faces whose centroid has its nearest compatible point in the region.
std::vector<bool> region_by_vote(const Mesh& source, const SurfaceSearch& source_search, const std::vector<Index>& region,
                                 const Mesh& target, const CorrespondenceOptions& options);

/// The outline of a region, the segments of a line, or points as degenerate segments.
Segments segments_of(const Mesh& mesh, const Annotation& annotation);
double length_of(const Segments& segments);

}  // namespace ostraka
