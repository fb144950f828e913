// How much of a region arrived where it belongs.
#pragma once

#include "ostraka/transfer/transfer.h"

#include <functional>

namespace ostraka {

/// Area of a region of `mesh` whose places on the other mesh lie in the corresponding region there, as `contains` tells. Faces
/// near the region's outline are sampled by up to 64 smaller triangles each, finer than the other mesh's faces (four, if these
/// agree, where no corner is on the outline); the others at their centroids, or, of more than `max_inner` of them, every so
/// many.
double overlapping_area(const Mesh& mesh, const std::vector<Index>& region, const SurfaceSearch& other,
                        const CorrespondenceOptions& options, std::size_t max_inner,
                        const std::function<bool(const SurfaceHit&)>& contains);

/// A region of a mesh, with the search tree of the surface it was made for (for a refined target: that of the target itself).
struct RegionOn {
    const Mesh& mesh;
    const std::vector<Index>& faces;
    const SurfaceSearch& search;
};
/// Overlap and wrong side of a score, from both sides, since the surfaces differ: what of the source region arrived inside, and
/// what of the target region came from inside.
void score_overlap(const RegionOn& source, const RegionOn& target, const CorrespondenceOptions& options,
                   const std::function<bool(const SurfaceHit&)>& in_target, TransferScore& score);

/// The region's faces found one by one: those target faces whose centroid has its nearest compatible point in the region.
std::vector<bool> region_by_vote(const Mesh& source, const SurfaceSearch& source_search, const std::vector<Index>& region,
                                 const Mesh& target, const CorrespondenceOptions& options);

/// Outline of a region, or the edges of a line, or points as segments without length.
using Segments = std::vector<std::pair<Point, Point>>;
Segments segments_of(const Mesh& mesh, const Annotation& annotation);
double length_of(const Segments& segments);

}  // namespace ostraka
