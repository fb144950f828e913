// Regions given by the coordinates of their outlines, found again on a mesh.
#pragma once

#include "placing.h"

namespace ostraka::interchange {

/// What of a region lies on one connected component of its own mesh.
struct RegionPart {
    double area = 0;
    Point inside{0, 0, 0};
    std::vector<std::vector<Index>>
        outlines;  ///< vertices of the mesh at hand nearest to the outline's; none: the whole component
};

/// The faces of the region, ascending. Outlines are joined along edges and filled by winding number; `remarks` says where the
/// area changed by more than a twentieth or nothing was left.
std::vector<Index> region_of(Placer& placer, const std::vector<RegionPart>& parts, const std::string& where,
                             std::vector<std::string>& remarks);

}  // namespace ostraka::interchange
