// Clay of a vessel as rays from its axis meet it.
#pragma once

#include "axis_frame.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/revolution/surface_of_revolution.h"
#include "profile_outline.h"

namespace ostraka {

struct ClayImage {
    detail::ProfileImage image;
    std::vector<double> tops;  ///< in each direction: the highest clay, above the lowest row; none: -1

    /// Heights with too little wall do not count.
    void drop_rare(const TurnOptions& options);
    /// A rim: where there is wall near the top, it ends at one height.
    [[nodiscard]] bool has_rim(const TurnOptions& options) const;
};

/// How much clay rays from the axis meet, by height and radius.
ClayImage look_at_clay(const SurfaceSearch& search, const AxisFrame& frame, double low, double high, double far,
                       const TurnOptions& options);

}  // namespace ostraka
