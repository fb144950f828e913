// Section of the wall of a vessel, as rays from its axis meet it.
#pragma once

#include "axis_frame.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/revolution/surface_of_revolution.h"
#include "profile_outline.h"

namespace ostraka {

struct WallSection {
    detail::ProfileImage image;
    std::vector<double> tops;  ///< in each direction: the highest wall, above the lowest row; none: -1

    /// Heights with too little wall do not count.
    void drop_rare(const RevolutionOptions& options);
    /// A rim: where there is wall near the top, it ends at one height.
    [[nodiscard]] bool has_rim(const RevolutionOptions& options) const;
};

/// How much of the wall rays from the axis meet, by height and radius.
WallSection wall_section(const SurfaceSearch& search, const AxisFrame& frame, double low, double high, double far,
                         const RevolutionOptions& options);

}  // namespace ostraka
