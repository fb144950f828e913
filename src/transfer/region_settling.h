// Computes the interior of projected curves.
#pragma once

#include "ostraka/geom/surface_search.h"
#include "ostraka/transfer/project_curves.h"

#include <vector>

namespace ostraka {

/// Computes the faces, vertices and edges of annotations from their projected curves, and resolves intersecting outlines. The
/// arguments must outlive this object.
class RegionSettling {
public:
    RegionSettling(const Mesh& source, const SurfaceSearch& target, const CorrespondenceOptions& options);

    /// Computes the elements of one annotation. `from`: annotation on the source; `outlines`: number of its outlines on the
    /// source.
    void settle(const Annotation& from, std::size_t outlines, ProjectedAnnotation& projected) const;

private:
    /// Components of the target that lie completely in the region.
    [[nodiscard]] std::vector<Index> whole_components(const Annotation& from) const;
    /// Computes the interior of a region whose outlines intersect.
    void untangle(const Annotation& from, double expected, std::size_t outlines, ProjectedAnnotation& projected) const;
    /// Whether the area of the projected region agrees with the expected area.
    [[nodiscard]] bool is_plausible(double area, double expected) const;

    const Mesh& source_;
    const SurfaceSearch& search_;
    const Mesh& target_;
    const CorrespondenceOptions& options_;
    double edge_, far_, min_cosine_;  ///< edge length of the target; search radius; cosine of the max angle between normals
};

}  // namespace ostraka
