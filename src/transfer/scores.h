// How much of a region arrived where it belongs.
#pragma once

#include "ostraka/annotation/curves.h"
#include "ostraka/transfer/transfer.h"

#include <functional>
#include <memory>

namespace ostraka {

/// One of the two meshes, with the search tree of its surface (for a refined target: that of the target itself).
struct ScoredMesh {
    const Mesh& mesh;
    const SurfaceSearch& search;
};

/// A free region, to be asked about places.
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

/// What a region holds of its mesh.
struct RegionArea {
    std::vector<Index> faces;  ///< in it, in part or whole
    std::vector<Index> rim;    ///< the vertices at its outline
    std::shared_ptr<const FreeRegion> free;
};
RegionArea region_area(const Mesh& mesh, const Annotation& annotation);

/// A region on both meshes, and whether a place on the target lies in it.
struct OverlapQuestion {
    RegionArea source, target;
    std::function<bool(const SurfaceHit&)> in_target;
    TransferScore* score;  ///< gets overlap and wrong side; its areas are known
};

/// Overlap and wrong side from both sides, since the surfaces differ: what of the source region arrived inside, and what of the
/// target region came from inside. Faces near a region's outline are sampled by up to 64 smaller triangles each, finer than the
/// other mesh's faces (four, if these agree, where no corner is on the outline); the others at their centroids, or, of more than
/// some thousand of them, every so many. All questions are worked on side by side.
void score_overlaps(const ScoredMesh& source, const ScoredMesh& target, const std::vector<OverlapQuestion>& questions,
                    const CorrespondenceOptions& options);

/// The region's faces found one by one: those target faces whose centroid has its nearest compatible point in the region.
std::vector<bool> region_by_vote(const Mesh& source, const SurfaceSearch& source_search, const std::vector<Index>& region,
                                 const Mesh& target, const CorrespondenceOptions& options);

/// Outline of a region, or the pieces of a line, or points as segments without length.
using Segments = std::vector<std::pair<Point, Point>>;
Segments segments_of(const Mesh& mesh, const Annotation& annotation);
double length_of(const Segments& segments);

}  // namespace ostraka
