// What laid curves enclose.
#pragma once

#include "ostraka/geom/surface_search.h"
#include "ostraka/transfer/lay_curves.h"

#include <vector>

namespace ostraka {

/// Finds the elements of annotations whose curves were laid, and untangles outlines that cross. All must outlive it.
class RegionSettling {
public:
    RegionSettling(const Mesh& source, const SurfaceSearch& target, const CorrespondenceOptions& options);

    /// `outlines` is the number that the region has on the source.
    void settle(const Annotation& from, std::size_t outlines, Laid& laid) const;

private:
    [[nodiscard]] std::vector<Index> whole_components(const Annotation& from) const;
    void untangle(const Annotation& from, double expected, std::size_t outlines, Laid& laid) const;
    [[nodiscard]] bool is_plausible(double area, double expected) const;

    const Mesh& source_;
    const SurfaceSearch& search_;
    const Mesh& target_;
    const CorrespondenceOptions& options_;
    double edge_, far_, min_cosine_;
};

}  // namespace ostraka
