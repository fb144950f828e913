// How much of a region arrived where it belongs.
#pragma once

#include "ostraka/transfer/transfer.h"

#include <functional>

namespace ostraka {

/// Area of the source region whose places on the target lie in the transferred region. Faces are sampled at their centroids,
/// those near the region's outline by up to 64 smaller triangles, so that the sampling is finer than the target's faces there.
/// `contains` says whether a place on the target belongs to the transferred region.
double overlapping_area(const Mesh& source, const std::vector<Index>& region, const SurfaceSearch& target,
                        const CorrespondenceOptions& options, const std::function<bool(const SurfaceHit&)>& contains);

/// The region's faces found one by one: those target faces whose centroid has its nearest compatible point in the region.
std::vector<bool> region_by_vote(const Mesh& source, const SurfaceSearch& source_search, const std::vector<Index>& region,
                                 const Mesh& target, const CorrespondenceOptions& options);

/// Outline of a region, or the edges of a line, or points as segments without length.
using Segments = std::vector<std::pair<Point, Point>>;
Segments segments_of(const Mesh& mesh, const Annotation& annotation);

}  // namespace ostraka
