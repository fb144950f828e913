// View directions of pictures.
#pragma once

#include "ostraka/core/options.h"

#include <array>
#include <string>
#include <vector>

namespace ostraka {

/// View direction in degrees. Azimuth 0 is the front, 90 the object's right as it appears in the front view; elevation 90 is
/// above. The front is the side towards -y (towards +z if y is up or down).
struct View {
    std::string name;  ///< name for labels
    double azimuth = 30, elevation = 20;
};

/// "front", "back", "left", "right", "top", "bottom", "iso" (45, 35.26) or "azimuth,elevation" in degrees.
/// Throws Error (usage) for anything else.
View parse_view(const std::string& text);

/// The values that `parse_view` accepts, as the rule of an option.
Words view_words();

/// The views of `--views six`: front, right, back, left, top, bottom.
std::vector<View> standard_views();

/// "x", "y", "z", "-x", "-y", "-z" or three numbers "0,0.6,0.8"; "auto" is z. Unit length. Throws Error (usage).
std::array<double, 3> parse_up(const std::string& text);

/// The picture's axes in the object's coordinates: unit vectors, right x up = towards the viewer.
struct ViewAxes {
    std::array<double, 3> right, up, toward;
};
ViewAxes view_axes(const View& view, const std::array<double, 3>& up);

}  // namespace ostraka
