// What there is to see in one picture of one object.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/render/picture.h"

#include <array>
#include <string>
#include <vector>

namespace ostraka {

/// A poly-line of points on or near the surface.
struct SceneLine {
    std::vector<std::array<double, 3>> points;
    Rgb colour;
    double width = 2.5;    ///< pixels, in a picture 900 pixels high
    bool cased = false;    ///< drawn with a dark rim, to stand out from any surface
    bool through = false;  ///< what the surface hides of it is drawn dashed
};

/// A dot on or near the surface.
struct SceneMarker {
    std::array<double, 3> point{};
    Rgb colour;
    double radius = 6;     ///< pixels, in a picture 900 pixels high
    std::string label;     ///< written beside it
    bool through = false;  ///< drawn even where the surface hides it
};

/// A name for a part of the picture, written beside the object with a line to a place of the part that is in sight.
struct SceneLabel {
    std::string text;
    Rgb colour;
    std::vector<Index> faces = {};                   ///< of a region
    std::vector<std::array<double, 3>> points = {};  ///< else of a poly-line or a point
    bool through = false;                            ///< whether hidden places count as in sight
};

/// A colour of a triangle that has several. A place in the triangle has the colour of its largest interpolated weight.
struct ScenePatch {
    Index triangle = 0;
    Rgb colour;
    std::array<float, 3> weights{};  ///< at the corners
};

enum class LegendMark { area, line, point };

struct LegendEntry {
    std::string text;
    Rgb colour;
    LegendMark mark = LegendMark::area;
};

/// An object and what is drawn on it. The triangles may be any soup. Of the colour lists at most one is used, in the order
/// below; without any the surface has the colour of clay.
struct Scene {
    TriangleSoup mesh;
    std::vector<double> vertex_values;  ///< empty or one per point: coloured by RenderOptions::scale, interpolated
    std::vector<double> face_values;    ///< empty or one per triangle
    std::vector<Rgb> face_colours;      ///< empty or one per triangle
    std::vector<Rgb> vertex_colours;    ///< empty or one per point, interpolated
    std::vector<ScenePatch> patches;    ///< by ascending triangle; those triangles' colours are not used
    std::vector<SceneLine> lines;
    std::vector<SceneMarker> markers;
    std::vector<SceneLabel> labels;
    std::vector<LegendEntry> legend;
    std::vector<std::array<double, 3>> around;  ///< places beside the mesh that shall be in the picture too
    std::string title;                          ///< written under the object
    std::string unit;                           ///< of the coordinates, for the scale bar
};

/// The colour of a surface of which nothing is said.
inline constexpr Rgb clay{201, 184, 160};

}  // namespace ostraka
