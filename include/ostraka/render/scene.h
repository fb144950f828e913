// Contents of a picture of one object.
#pragma once

#include "ostraka/image/appearance.h"
#include "ostraka/mesh/mesh.h"
#include "ostraka/render/picture.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace ostraka {

/// A poly-line of points on or near the surface.
struct SceneLine {
    std::vector<std::array<double, 3>> points;  ///< successive points of the line
    Rgb colour;
    double width = 2.5;    ///< width in pixels, for a picture 900 pixels high
    bool cased = false;    ///< true: drawn with a dark outline, to be visible on any surface
    bool through = false;  ///< true: parts hidden by the surface are drawn dashed
};

/// A dot on or near the surface.
struct SceneMarker {
    std::array<double, 3> point{};
    Rgb colour;
    double radius = 6;     ///< radius in pixels, for a picture 900 pixels high
    std::string label;     ///< text beside the marker
    bool through = false;  ///< true: drawn even if hidden by the surface
};

/// A label for a part of the object, written beside the object with a line to a visible point of the part.
struct SceneLabel {
    std::string text;  ///< the label
    Rgb colour;
    std::vector<Index> faces = {};                   ///< faces of the labelled region
    std::vector<std::array<double, 3>> points = {};  ///< points of the labelled poly-line or point; used if `faces` is empty
    bool through = false;                            ///< true: points hidden by the surface count as visible
};

/// One colour of a triangle that has several colours. A point in the triangle takes the colour with the largest interpolated
/// weight.
struct ScenePatch {
    Index triangle = 0;  ///< index of the triangle
    Rgb colour;
    std::array<float, 3> weights{};  ///< weights of the colour at the corners
};

enum class LegendMark { area, line, point };  ///< symbol of a legend entry

struct LegendEntry {
    std::string text;  ///< description
    Rgb colour;
    LegendMark mark = LegendMark::area;  ///< symbol beside the description
};

/// An object, with the values, colours, lines and labels that are drawn on it. The triangles may be any triangle soup. Of the
/// lists of values and colours, only the first non-empty one (in the order of declaration) is used; if all are empty, the
/// surface has the colour of clay. A texture is used unless there are values; colours multiply it.
struct Scene {
    TriangleSoup mesh;                  ///< triangles of the object
    std::vector<double> vertex_values;  ///< one value per point, interpolated and coloured by RenderOptions::scale; or empty
    std::vector<double> face_values;    ///< one value per triangle, coloured by RenderOptions::scale; or empty
    std::vector<Rgb> face_colours;      ///< one colour per triangle; or empty
    std::vector<Rgb> vertex_colours;    ///< one colour per point, interpolated; or empty
    /// Colours of triangles with several colours, ascending by triangle; they replace the other colours of these triangles.
    std::vector<ScenePatch> patches;
    /// Reads the colours of the materials; null: no texture. The object may be shared by several scenes and pictures.
    std::shared_ptr<const TextureSampler> texture;
    std::vector<TexturePoint> corner_texture;  ///< texture coordinates, three per triangle; empty: images are not shown
    /// Index of each triangle's material, or no_index: a triangle without texture; empty: the first material on all triangles.
    std::vector<Index> face_materials;
    std::vector<SceneLine> lines;
    std::vector<SceneMarker> markers;
    std::vector<SceneLabel> labels;
    std::vector<LegendEntry> legend;
    std::vector<std::array<double, 3>> around;  ///< additional points that must be inside the picture
    std::string title;                          ///< text under the object
    std::string unit;                           ///< unit of the coordinates, written at the scale bar
    double unit_metres = 0;                     ///< length of the unit in metres, for pictures at a scale; 0: unknown
};

/// Default colour of a surface: clay.
inline constexpr Rgb clay{201, 184, 160};

}  // namespace ostraka
