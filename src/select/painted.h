// Painted figures: parts of a surface with similar colours, at the resolution of the image.
#pragma once

#include "select/texel_grid.h"

#include "ostraka/geom/surface_search.h"
#include "ostraka/geom/surface_trace.h"
#include "ostraka/image/colour_space.h"

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// What a painted figure looks like.
struct PaintedFigureQuery {
    using Interval = std::array<double, 2>;
    /// Colours of the figure; with `places` and without colours: the median colour around each place.
    std::vector<Lab> like;
    /// Places in the figure: only the connected figures there are selected; empty: the figure is selected wherever it is.
    std::vector<SurfaceHit> places;
    double tolerance = 16;                      ///< largest difference from a colour (CIEDE2000)
    bool sharpest = false;                      ///< true: the tolerance with the sharpest outline, up to `tolerance`
    std::optional<Interval> lightness, chroma;  ///< further bounds, in CIELAB
    std::optional<Interval> hue;                ///< angles in degrees, from the first counter-clockwise to the second
    double smallest = 0;  ///< patches and holes smaller than the square of this length are left out; 0: of six texels
    int blur = 2;         ///< rounds of smoothing, each over the neighbouring texels
};

/// A painted figure as the part of a surface where a function on the nodes of a texel grid, linear between them, is positive.
class PaintedFigure {
public:
    /// `colours` is shared, as several figures use it. `where`: file and place for errors. Throws Error (input) if there is no
    /// figure, or if its colour is not found at a place.
    PaintedFigure(std::shared_ptr<const TexelColours> colours, const PaintedFigureQuery& query, const std::string& where);

    [[nodiscard]] bool inside(Face face, const std::array<double, 3>& weights) const;  ///< whether a point is inside
    /// For each face, whether at least half of its area is inside.
    [[nodiscard]] std::vector<bool> faces() const;
    /// The outline, as straight pieces across one face each.
    [[nodiscard]] std::vector<SurfaceCurve> outline() const;
    [[nodiscard]] double tolerance() const { return tolerance_; }  ///< the tolerance used

private:
    /// Share of the way from the node with the smaller number to the other one at which the outline crosses.
    [[nodiscard]] double crossing(Index low, Index high) const;

    std::shared_ptr<const TexelColours> colours_;
    std::vector<float> value_;  ///< for each node: positive inside
    double tolerance_;
};

}  // namespace ostraka
