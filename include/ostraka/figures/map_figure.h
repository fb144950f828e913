// Pictures of a map on an object, with the distribution of its values.
#pragma once

#include "ostraka/files/file.h"
#include "ostraka/render/colour_scale.h"
#include "ostraka/render/picture.h"

#include <string>
#include <vector>

namespace ostraka {

/// A rendered map and its histogram, whose bars have the colours of the map and so stand for a colour bar.
struct MapFigure {
    std::string title;               ///< title of the figure
    Picture picture;                 ///< the rendered object, drawn with two pixels per point
    ColourScale scale;               ///< colours of the map; values outside the scale are counted in the bars at its ends
    std::vector<double> values;      ///< values that the histogram counts, each for the same area; NaN values are not counted
    std::vector<double> lines;       ///< values at which dashed lines are drawn, such as tolerances
    std::vector<std::string> facts;  ///< lines of text below the picture
};

/// Writes the figure as .svg, .pdf or .png, atomically, creating folders; the object is an embedded image. Throws Error (usage)
/// for any other extension, (input) if no value is finite.
void write_plot(const Path& file, const MapFigure& figure);

}  // namespace ostraka
