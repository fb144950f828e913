// Off-screen rendering of meshes, without a window or a graphics card.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/render/camera.h"
#include "ostraka/render/colour_scale.h"
#include "ostraka/render/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

struct RenderOptions {
    std::string size = "1200x900";
    std::string view = "30,20";
    std::string views;  ///< "six", or several values of `view` separated by ";"; empty: `view`
    std::string up = "auto";
    enum class Projection { orthographic, perspective } projection = Projection::orthographic;
    double zoom = 1;
    enum class Fit { all, each } fit = Fit::all;  ///< several objects: all at the same scale, or each as large as possible
    enum class Shading { smooth, flat } shading = Shading::smooth;
    double crease = 40;
    int ambient_occlusion = 0;
    int samples = 8;
    bool edges = false;
    enum class Drawing { surface, lines, wire, points } drawing = Drawing::surface;
    bool contours = false;
    bool labels = false;
    bool axes = false;
    int supersample = 0;
    bool deep = false;
    enum class Theme { light, dark } theme = Theme::light;
    std::string background = "auto";
    bool transparent = false;
    bool no_scale_bar = false;
    bool no_legend = false;
    std::optional<ColourScale> scale;  ///< colours of values, and the colour bar beside the picture

    void describe(OptionList& visit);
};

/// Throws Error (usage) for options that `render` would refuse. Call it before reading the meshes.
void check_render_options(const RenderOptions& options);

/// A name beside an object; coordinates in pixels of the whole picture.
struct PaneLabel {
    std::string text;
    Rgb colour;
    double left = 0, top = 0, width = 0, height = 0;
    double place_x = 0, place_y = 0;  ///< visible point of the labelled part
};

/// Layout of a picture, for tests and for drawing over the picture.
struct Pane {
    std::size_t scene = 0;
    std::string view;
    int left = 0, top = 0, width = 0, height = 0;  ///< pixels
    double pixels_per_unit = 0;                    ///< scale; in perspective that of the object's middle
    double bar_length = 0;                         ///< length of the scale bar in the mesh's unit; 0 if there is none
    double bar_pixels = 0;
    std::size_t markers_shown = 0;  ///< number of visible markers
    std::vector<PaneLabel> labels;
    PictureCamera camera;  ///< in pixel coordinates of the whole picture
};

struct Rendering {
    int width = 0, height = 0;  ///< pixels
    Picture picture;            ///< for pixel output
    DeepPicture deep;           ///< the same with 16 bits per channel, if requested
    std::string document;       ///< for SVG and PDF: the contents of the file
    std::vector<Pane> panes;
    double build_seconds = 0;  ///< seconds spent building the search tree
    double draw_seconds = 0;   ///< seconds spent on everything else
};

/// Draws the scenes side by side. Rays are traced through a bounding volume hierarchy (Embree); the first hit is shaded by a
/// light near the viewer's head and a soft sky, with more rays where neighbouring pixels differ. Lines and markers are drawn
/// where the ray to the viewer is free, with a tolerance of 0.2 % of the largest side of the box. The picture is bit-identical
/// for any number of threads. O((n + pixels) log n). In documents the surface is an embedded image; everything else is vector
/// graphics. Throws Error (usage) for invalid options; Error (input) for an index out of range, a coordinate that is not finite
/// or a list of the wrong length.
Rendering render(const std::vector<Scene>& scenes, const RenderOptions& options = {}, PictureKind kind = PictureKind::pixels);

}  // namespace ostraka
