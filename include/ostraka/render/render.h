// Renders meshes to pictures without a window or a graphics card.
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
    std::string size = "1200x900";  ///< width and height of the picture, pixels
    std::string view = "30,20";     ///< view direction, as `parse_view` accepts
    std::string views;              ///< several views on one sheet: "six", or values of `view` separated by ";"; empty: one view
    std::string up = "auto";        ///< upward direction of the object, as `parse_up` accepts
    /// Parallel projection, or perspective of a pinhole camera.
    enum class Projection { orthographic, perspective } projection = Projection::orthographic;
    double zoom = 1;  ///< magnification about the centre; 1 shows the whole object
    /// Scale of several objects. all: the same scale for all objects; each: each object as large as possible.
    enum class Fit { all, each } fit = Fit::all;
    /// Smooth: normals are interpolated across edges; flat: one normal per face.
    enum class Shading { smooth, flat } shading = Shading::smooth;
    /// Lighting. shaded: by a light near the viewer's head; flat: none, colours are exactly those of the image or file.
    enum class Light { shaded, flat } light = Light::shaded;
    double crease = 40;         ///< smooth shading: edges whose face normals differ by more than this angle (degrees) look sharp
    int ambient_occlusion = 0;  ///< number of ambient occlusion rays per pixel; 0: none
    int samples = 8;            ///< number of rays per pixel where neighbouring pixels differ in colour; 1: no additional rays
    bool edges = false;         ///< true: draw the edges of the mesh over the surface
    /// Drawing style; lines: visible contours, creases and borders; wire: edges.
    enum class Drawing { surface, lines, wire, points } drawing = Drawing::surface;
    bool contours = false;     ///< true: draw contours, creases and borders over the surface
    bool labels = false;       ///< true: write names beside the object, with leader lines, instead of a legend
    bool axes = false;         ///< true: draw the directions of the coordinate axes
    int supersample = 0;       ///< number of samples per pixel in each direction; 0: 1 in a PNG, 2 in SVG and PDF
    bool sixteen_bit = false;  ///< true: write a PNG with 16 bits per channel
    double dpi = 0;           ///< pixels per inch of paper; 0: 300 with `print_scale`, else 96 in SVG and PDF and unstated in PNG
    std::string print_scale;  ///< scale on paper such as "1:2" (half the size), see parse_print_scale; empty: as large as fits
    enum class Theme { light, dark } theme = Theme::light;  ///< colours of text and background
    std::string background = "auto";   ///< colour of the background, as `parse_colour` accepts; auto: colour of the theme
    bool transparent = false;          ///< true: the background is transparent
    bool no_scale_bar = false;         ///< true: omit the scale bar
    bool no_legend = false;            ///< true: omit the legend and the colour bar
    std::optional<ColourScale> scale;  ///< colour scale of values, shown as a colour bar beside the picture; empty: no colour bar

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// The factor from lengths of the object to lengths on paper: "1:2" is 0.5, "3:1" is 3; 0 for an empty text. Throws Error (usage)
/// for a text that is not two positive numbers separated by a colon.
double parse_print_scale(const std::string& text);

/// Throws Error (usage) for options that `render` would refuse. Call this function before reading the meshes.
void check_render_options(const RenderOptions& options);

/// A name written beside an object; coordinates in pixels of the whole picture.
struct PaneLabel {
    std::string text;                                 ///< the name
    Rgb colour;                                       ///< colour of the labelled part
    double left = 0, top = 0, width = 0, height = 0;  ///< rectangle of the text
    double place_x = 0, place_y = 0;                  ///< visible point of the labelled part, where the leader line ends
};

/// Position and contents of the part of a picture that shows one object; for tests and for drawing over the picture.
struct Pane {
    std::size_t scene = 0;                         ///< index of the scene that the pane shows
    std::string view;                              ///< name of the view
    int left = 0, top = 0, width = 0, height = 0;  ///< rectangle of the pane, pixels
    double pixels_per_unit = 0;     ///< pixels per unit of length; with perspective, at the depth of the object's middle
    double bar_length = 0;          ///< length that the scale bar represents, in the mesh's unit; 0: no scale bar
    double bar_pixels = 0;          ///< length of the scale bar, pixels
    std::size_t markers_shown = 0;  ///< number of markers that are visible
    std::vector<PaneLabel> labels;  ///< names beside the object
    PictureCamera camera;           ///< camera, in pixel coordinates of the whole picture
};

/// A rendered picture or document.
struct Rendering {
    int width = 0, height = 0;    ///< pixels
    Picture picture;              ///< the picture, if the output format is pixels
    DeepPicture deep;             ///< the picture with 16 bits per channel, if requested
    std::string document;         ///< contents of the file, if the output format is SVG or PDF
    double pixels_per_metre = 0;  ///< resolution on paper, for write_png; 0: unstated
    std::vector<Pane> panes;      ///< panes of the picture, one per scene and view
    double build_seconds = 0;     ///< seconds spent building the search trees
    double draw_seconds = 0;      ///< seconds spent on the rest of the rendering
};

/// Draws the scenes side by side. Rays are traced through a bounding volume hierarchy (Embree); the first hit is shaded by a
/// light near the viewer's head and a soft sky, with more rays where neighbouring pixels differ. Textures are averaged over the
/// area of a pixel on the surface. Lines and markers are drawn
/// where the ray to the viewer is unobstructed, with a tolerance of 0.2 % of the largest side of the bounding box. The picture is
/// bit-identical for any number of threads. Time: O((n + pixels) log n). In SVG and PDF the surface is an embedded image;
/// everything else is vector graphics. Throws Error (usage) for invalid options; Error (input) for an index out of range, a
/// coordinate that is not finite or a list of the wrong length.
Rendering render(const std::vector<Scene>& scenes, const RenderOptions& options = {}, PictureKind kind = PictureKind::pixels);

}  // namespace ostraka
