#include "render/options.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <cmath>
#include <cstdio>
#include <sstream>

namespace ostraka {

namespace detail {

Size parse_size(const std::string& text) {
    constexpr int minimum = 16, maximum = 16384;
    constexpr double max_pixels = 1 << 25;
    Size size{};
    char cross = 0, trailing = 0;
    const bool valid = text.size() < 16 &&
                       std::sscanf(text.c_str(), "%d%c%d%c", &size.width, &cross, &size.height, &trailing) == 3 && cross == 'x';
    if (!valid || size.width < minimum || size.height < minimum || size.width > maximum || size.height > maximum ||
        double(size.width) * size.height > max_pixels)
        fail_usage(fmt::format("the size '{}' is invalid", text),
                   "use WIDTHxHEIGHT such as 1200x900, each 16 to 16384, at most 33 million pixels");
    return size;
}

std::vector<View> views_of(const RenderOptions& options) {
    if (options.views == "six") return standard_views();
    std::vector<View> views;
    std::istringstream stream(options.views);
    for (std::string view; std::getline(stream, view, ';');) views.push_back(parse_view(view));
    if (views.empty()) views.push_back(parse_view(options.view));
    return views;
}

}  // namespace detail

double parse_print_scale(const std::string& text) {
    if (text.empty()) return 0;
    double paper = 0, object = 0;
    char trailing = 0;
    const bool valid = text.size() < 40 && std::sscanf(text.c_str(), "%lf:%lf%c", &paper, &object, &trailing) == 2;
    const double factor = valid && paper > 0 && object > 0 ? paper / object : 0;
    if (!(factor >= 1e-9 && factor <= 1e9))
        fail_usage(fmt::format("the scale '{}' is invalid", text), "use two numbers such as 1:2 (half the size) or 3:1");
    return factor;
}

void check_render_options(const RenderOptions& options) {
    check_options(options, "render");
    (void)detail::parse_size(options.size);
    (void)parse_view(options.view);
    (void)detail::views_of(options);
    (void)parse_up(options.up);
    if (options.background != "auto") (void)parse_colour(options.background);
    if (parse_print_scale(options.print_scale) > 0) {
        if (options.projection == RenderOptions::Projection::perspective)
            fail_usage("--scale with --projection perspective", "only a parallel projection has one scale");
        if (options.zoom != 1) fail_usage("--scale with --zoom", "give one of them");
    }
    if (options.light == RenderOptions::Light::flat && options.ambient_occlusion > 0)
        fail_usage("--light flat with --ambient-occlusion", "flat light has no shade: give one of them");
}

void RenderOptions::declare_options(OptionList& list) {
    list("size", size, "width and height of the picture in pixels, such as 1200x900");
    list("view", view, "view direction", view_words());
    list("views", views, "several views on one sheet",
         Words{{"", "six"}, "views like 'front;iso;120,10'", [](const std::string& text) {
                   RenderOptions candidate;
                   candidate.views = text;
                   static_cast<void>(detail::views_of(candidate));
               }});
    list("up", up, "upward axis of the object; auto: the upward direction of the annotations, or z",
         Words{{"auto", "x", "y", "z", "-x", "-y", "-z"}, "three numbers like 0,0,1", [](const std::string& text) {
                   static_cast<void>(parse_up(text));
               }});
    list("projection", projection, "projection of the camera: orthographic or perspective",
         Choices{"orthographic", "perspective"});
    list("zoom", zoom, "magnification about the centre; 1 shows the whole object", Range{0.01, 1000});
    list("fit", fit, "several objects: draw all at one scale (all), or each as large as fits its pane (each)",
         Choices{"all", "each"});
    list("shading", shading, "shading of the surface: smooth (interpolated normals) or flat", Choices{"smooth", "flat"});
    list("light", light,
         "lighting: shaded (by a light at the viewer's upper left) or flat (no shading: colours exactly as in the image or file)",
         Choices{"shaded", "flat"});
    list("crease", crease, "smooth shading: minimum dihedral angle of edges that are drawn sharp", Range{0, 180}, "degrees");
    list("ambient-occlusion", ambient_occlusion, "number of ambient occlusion rays per pixel; 0: no ambient occlusion",
         Range{0, 1024});
    list("samples", samples, "number of rays per pixel where colours change (antialiasing); 1: no antialiasing", Range{1, 64});
    list("edges", edges, "draw the edges of the mesh");
    list("drawing", drawing,
         "how the object is drawn: surface; lines (visible contours, creases and borders); wire (edges of the mesh); points",
         Choices{"surface", "lines", "wire", "points"});
    list("contours", contours, "draw contours, creases and borders over the surface");
    list("labels", labels, "write the tags of annotations beside the object with leader lines, instead of a legend");
    list("axes", axes, "draw the directions of the coordinate axes of the mesh");
    list("supersample", supersample,
         "number of samples per pixel in each direction, which are averaged in PNG and kept in SVG and PDF; 0: 1 for PNG, 2 for "
         "SVG and PDF",
         Range{0, 4});
    list("sixteen-bit", sixteen_bit, "write a PNG with 16 bits per channel");
    list("dpi", dpi,
         "pixels of the picture per inch of paper, written into the file; 0: 300 with --scale, otherwise 96 in SVG and PDF, and "
         "not stated in PNG",
         Range{0, 10000});
    list("scale", print_scale, "scale on paper: 1:2 draws the object at half its size; by default it is as large as fits",
         Words{{"", "1:1", "1:2", "1:5", "2:1"}, "two numbers such as 1:3", [](const std::string& text) {
                   static_cast<void>(parse_print_scale(text));
               }});
    list("theme", theme, "colours of text and background: light or dark", Choices{"light", "dark"});
    list("background", background, "colour of the background; auto: the background of --theme",
         Words{{"auto", "white", "black", "grey"}, "#rrggbb", [](const std::string& text) {
                   if (text != "auto") static_cast<void>(parse_colour(text));
               }});
    list("transparent", transparent, "leave the background transparent");
    list("no-scale-bar", no_scale_bar, "leave out the scale bar");
    list("no-legend", no_legend, "leave out the legend and the colour bar");
}

}  // namespace ostraka
