// View directions of pictures.
#pragma once

#include "ostraka/core/options.h"

#include <array>
#include <string>
#include <vector>

namespace ostraka {

/// View direction in degrees. Azimuth 0 shows the front of the object; azimuth 90 shows the side that is on the right in the
/// front view; elevation 90 shows the object from above. The front is the side towards -y (towards +z if the object's upward
/// direction is y or -y).
struct View {
    std::string name;                     ///< name of the view for labels
    double azimuth = 30, elevation = 20;  ///< rotation about the upward direction, and angle above the horizontal plane
};

/// Parses a view: "front", "back", "left", "right", "top", "bottom", "iso" (45, 35.26) or "azimuth,elevation" in degrees. Throws
/// Error (usage) for any other text.
View parse_view(const std::string& text);

/// Rule of an option whose values `parse_view` accepts.
Words view_words();

/// The views that the option `--views six` shows: front, right, back, left, top, bottom.
std::vector<View> standard_views();

/// Parses an upward direction: "x", "y", "z", "-x", "-y", "-z" or three numbers such as "0,0.6,0.8"; "auto" is z. Returns a unit
/// vector. Throws Error (usage) for any other text.
std::array<double, 3> parse_up(const std::string& text);

/// The axes of a view in the object's coordinates: unit vectors; toward = right x up points to the viewer.
struct ViewAxes {
    std::array<double, 3> right, up, toward;
};
/// Axes of a view of an object with this upward direction.
ViewAxes view_axes(const View& view, const std::array<double, 3>& up);

}  // namespace ostraka
