// All that is asked of a fragment when its break is laid against others, made once.
#pragma once

#include "break_side.h"
#include "ostraka/fracture/break_pair.h"
#include "ostraka/geom/surface_search.h"

namespace ostraka {

struct PreparedBreak::Parts {
    Mesh mesh;
    std::string name;
    double size = 0;   ///< square root of the surface's area
    double width = 0;  ///< of the fracture: twice its area by the length of its rim; of a sherd that is its wall
    BreakSide side;
    PointTree fracture, frames;
    std::vector<Eigen::Vector3d> places, normals;  ///< fracture first, then intact surface
    std::unique_ptr<SampleGrid> grid;              ///< of places
    std::unique_ptr<SurfaceSearch> surface;
};

}  // namespace ostraka
