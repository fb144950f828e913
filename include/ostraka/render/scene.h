// Contents of a picture of one object.
#pragma once

#include "ostraka/mesh/mesh.h"
#include "ostraka/render/picture.h"

#include <array>
#include <string>
#include <vector>

namespace ostraka {

/// A poly-line of points on or near the surface.
struct SceneLine {
    std::vector<std::array<double, 3>> points;
    Rgb colour;
    double width = 2.5;    ///< width in pixels, for a picture 900 pixels high
    bool cased = false;    ///< drawn with a dark outline, to be visible on any surface
    bool through = false;  ///< parts hidden by the surface are drawn dashed
};

/// A dot on or near the surface.
struct SceneMarker {
    std::array<double, 3> point{};
    Rgb colour;
    double radius = 6;     ///< radius in pixels, for a picture 900 pixels high
    std::string label;     ///< text beside the marker
    bool through = false;  ///< drawn even if hidden by the surface
};

/// A label for a part of the object, written beside the object with a line to a visible point of the part.
struct SceneLabel {
    std::string text;
    Rgb colour;
    std::vector<Index> faces = {};                   ///< faces of a region
    std::vector<std::array<double, 3>> points = {};  ///< otherwise points of a poly-line or a point
    bool through = false;                            ///< whether hidden points count as visible
};

/// One colour of a triangle that has several. A point in the triangle takes the colour with the largest interpolated weight.
struct ScenePatch {
    Index triangle = 0;
    Rgb colour;
    std::array<float, 3> weights{};  ///< weights at the corners
};

enum class LegendMark { area, line, point };

struct LegendEntry {
    std::string text;
    Rgb colour;
    LegendMark mark = LegendMark::area;
};

/// An object and what is drawn on it. The triangles may be any soup. At most one of the colour lists is used, in the order
/// below; without any, the surface has the colour of clay.
struct Scene {
    TriangleSoup mesh;
    std::vector<double> vertex_values;  ///< empty or one per point: coloured by RenderOptions::scale, interpolated
    std::vector<double> face_values;    ///< empty or one per triangle
    std::vector<Rgb> face_colours;      ///< empty or one per triangle
    std::vector<Rgb> vertex_colours;    ///< empty or one per point, interpolated
    std::vector<ScenePatch> patches;    ///< ascending by triangle; they replace the colours of these triangles
    std::vector<SceneLine> lines;
    std::vector<SceneMarker> markers;
    std::vector<SceneLabel> labels;
    std::vector<LegendEntry> legend;
    std::vector<std::array<double, 3>> around;  ///< additional points that must be in the picture
    std::string title;                          ///< written under the object
    std::string unit;                           ///< unit of the coordinates, for the scale bar
};

/// Default colour of a surface.
inline constexpr Rgb clay{201, 184, 160};

}  // namespace ostraka
