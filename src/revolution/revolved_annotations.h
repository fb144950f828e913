// Annotations of a template that is a surface of revolution.
#pragma once

#include "axis_frame.h"
#include "ostraka/revolution/surface_of_revolution.h"

namespace ostraka {

/// The rings of vertices of the template, one a point of its profile.
struct ProfileRings {
    std::vector<std::vector<Vertex>> vertices;
    std::vector<std::size_t> of_vertex;
};

/// Regions "outer", "inner", "base", lines "rim" or "upper end", "widest girth", "foot", points "base centre", "floor centre",
/// and the axis, whose foot is `lowest` above that of the frame.
void annotate_revolution(RevolutionTemplate& result, const AxisFrame& frame, double lowest, const ProfileRings& made);

}  // namespace ostraka
