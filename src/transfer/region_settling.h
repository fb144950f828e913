// Interior of projected curves.
#pragma once

#include "ostraka/geom/surface_search.h"
#include "ostraka/transfer/project_curves.h"

#include <vector>

namespace ostraka {

/// Computes the elements of annotations from their projected curves, and resolves intersecting outlines. The arguments must
/// outlive this object.
class RegionSettling {
public:
    RegionSettling(const Mesh& source, const SurfaceSearch& target, const CorrespondenceOptions& options);

    /// `outlines`: number of outlines of the region on the source.
    void settle(const Annotation& from, std::size_t outlines, ProjectedAnnotation& projected) const;

private:
    [[nodiscard]] std::vector<Index> whole_components(const Annotation& from) const;
    void untangle(const Annotation& from, double expected, std::size_t outlines, ProjectedAnnotation& projected) const;
    [[nodiscard]] bool is_plausible(double area, double expected) const;

    const Mesh& source_;
    const SurfaceSearch& search_;
    const Mesh& target_;
    const CorrespondenceOptions& options_;
    double edge_, far_, min_cosine_;
};

}  // namespace ostraka
