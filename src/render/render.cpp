#include "ostraka/render/render.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"
#include "render/drawing.h"
#include "render/labels.h"
#include "render/options.h"
#include "render/overlay.h"
#include "render/shading.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>

namespace ostraka {

namespace {
using detail::Camera;
using detail::Canvas;
using detail::parse_size;
using detail::Size;
using detail::Surface;

/// A view of a scene with its pane and camera.
struct Plan {
    Pane pane;
    View view;
    std::string caption;
    Camera camera;
    double label_column = 0;  ///< width on both sides of the pane
};

/// Sets one scale for the panes of each scene, or of all scenes.
void equalise_scales(std::vector<Plan>& plans, const std::vector<std::unique_ptr<Surface>>& surfaces, bool across_scenes) {
    double largest = 0;
    for (const auto& surface : surfaces) largest = std::max(largest, surface->unit_length());
    const auto relative = [&](const Plan& plan) { return surfaces[plan.pane.scene]->unit_length() / largest; };
    for (std::size_t scene = 0; scene < surfaces.size(); ++scene) {
        double minimum = std::numeric_limits<double>::infinity();
        for (const Plan& plan : plans)
            if (across_scenes || plan.pane.scene == scene) minimum = std::min(minimum, plan.camera.scale / relative(plan));
        for (Plan& plan : plans) {
            if (plan.pane.scene != scene) continue;
            const double scale = minimum * relative(plan);
            if (plan.camera.distance > 0) plan.camera.distance *= plan.camera.scale / scale;
            plan.camera.scale = scale;
        }
    }
}

std::vector<LegendEntry> merged_legend(const std::vector<Scene>& scenes) {
    std::vector<LegendEntry> entries;
    for (const Scene& scene : scenes)
        for (const LegendEntry& entry : scene.legend) {
            const auto is_equal = [&](const LegendEntry& other) {
                return other.text == entry.text && other.colour == entry.colour && other.mark == entry.mark;
            };
            if (std::none_of(entries.begin(), entries.end(), is_equal)) entries.push_back(entry);
        }
    return entries;
}

/// Available size for the panes of a sheet.
struct PaneSize {
    double width = 0, height = 0;  ///< total of all panes
    double strip = 0;              ///< height under each pane for scale bar and caption
};

/// Number of columns. Six views of one object are in three columns, of several objects in one row each; up to three panes are
/// side by side. Otherwise the number of columns maximises the size of the objects: of the smallest one if they share a scale,
/// else the mean of the logarithms. `extents` holds width and height of each pane's object in its view.
std::size_t column_count(const std::vector<std::array<double, 2>>& extents, bool six, std::size_t scenes, bool one_scale,
                         const PaneSize& available) {
    const std::size_t panes = extents.size();
    if (six) return scenes == 1 ? 3 : 6;
    if (panes <= 3) return panes;
    std::size_t best = panes;
    double maximum = -std::numeric_limits<double>::infinity();
    for (std::size_t columns = panes; columns >= 1; --columns) {
        const std::size_t rows = (panes + columns - 1) / columns;
        const double width = available.width / double(columns),
                     height = std::max(1.0, available.height / double(rows) - available.strip);
        double minimum = std::numeric_limits<double>::infinity(), sum = 0;
        for (const auto& [object_width, object_height] : extents) {
            const double scale = std::min(width / object_width, height / object_height);
            minimum = std::min(minimum, scale);
            sum += std::log(scale);
        }
        // Rounding must not decide between equivalent numbers of columns.
        if (const double value = one_scale ? std::log(minimum) : sum; value > maximum + 1e-9) maximum = value, best = columns;
    }
    return best;
}

/// All points that the picture of a scene must contain.
class Framed {
public:
    Framed(const Scene& scene, const Surface& surface) : scene_(scene), surface_(surface) {}
    [[nodiscard]] std::size_t count() const { return surface_.used_points().size() + scene_.around.size(); }
    Eigen::Vector3d operator()(std::size_t k) const {
        const auto& used = surface_.used_points();
        return surface_.to_local(k < used.size() ? scene_.mesh.points[used[k]] : scene_.around[k - used.size()]);
    }

private:
    const Scene& scene_;
    const Surface& surface_;
};

/// Width and height of an object in a view, in the mesh's unit.
std::array<double, 2> extent_of(const Scene& scene, const Surface& surface, const View& view, const std::array<double, 3>& up) {
    // The scale of a pane limited only by its width, and only by its height.
    const Framed framed(scene, surface);
    const double scale_by_width = detail::fit_camera(framed.count(), framed, view, up, 1, 1e9, false).scale;
    const double scale_by_height = detail::fit_camera(framed.count(), framed, view, up, 1e9, 1, false).scale;
    return {surface.unit_length() / scale_by_width, surface.unit_length() / scale_by_height};
}

std::vector<Plan> plan_panes(const std::vector<Scene>& scenes, const RenderOptions& options) {
    const std::vector<View> views = detail::views_of(options);
    const bool several = views.size() > 1;
    std::vector<Plan> plans;
    for (std::size_t scene = 0; scene < scenes.size(); ++scene)
        for (const View& view : views) {
            Plan plan;
            plan.view = view;
            plan.pane.scene = scene;
            plan.pane.view = view.name;
            const std::string title = detail::clean_text(scenes[scene].title);
            plan.caption = !several ? title : scenes.size() == 1 || title.empty() ? view.name : title + ", " + view.name;
            plans.push_back(plan);
        }
    return plans;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void add_scale_bar(Canvas& canvas, Plan& plan, const Scene& scene, double unit_length, double strip, const detail::Style& style,
                   const std::string& print_scale) {
    Pane& pane = plan.pane;
    const double available_width = std::min(170 * style.size, 0.5 * pane.width);
    pane.bar_length = round_length(available_width / plan.camera.scale * unit_length);
    pane.bar_pixels = pane.bar_length / unit_length * plan.camera.scale;
    if (!(pane.bar_length > 0) || !(pane.bar_pixels >= 1)) {
        pane.bar_length = pane.bar_pixels = 0;
        return;
    }
    const std::string unit = detail::clean_text(scene.unit);
    const std::string text = (plan.camera.distance > 0 ? "\xE2\x89\x88 " : "") + digits(pane.bar_length, 6) +
                             (unit.empty() ? "" : " " + unit) + (print_scale.empty() ? "" : " (" + print_scale + ")");
    detail::draw_scale_bar(canvas, pane.left + 14 * style.size, pane.top + pane.height + strip - 8 * style.size, pane.bar_pixels,
                           text, style);
}
/// Copies the light of a pane into the whole picture.
void copy_into(std::vector<detail::Light>& target, int width, const std::vector<detail::Light>& light, const Pane& pane) {
    const auto columns = static_cast<std::size_t>(pane.width);
    for (std::size_t row = 0; row < static_cast<std::size_t>(pane.height); ++row)
        std::copy_n(light.begin() + static_cast<std::ptrdiff_t>(row * columns), columns,
                    target.begin() +
                        static_cast<std::ptrdiff_t>((static_cast<std::size_t>(pane.top) + row) * static_cast<std::size_t>(width) +
                                                    static_cast<std::size_t>(pane.left)));
}

/// The picture `over` composited over the surface, and this over the background, with gamma-coded colours as in cairo.
DeepPicture composed(const std::vector<detail::Light>& surface_light, const Picture& over, std::optional<Rgb> background) {
    DeepPicture picture{over.width, over.height, {}};
    picture.rgba.resize(surface_light.size());
    parallel_for(surface_light.size(), 4096, [&](std::size_t i) {
        std::array<double, 4> sum{0, 0, 0, 0};  // premultiplied, 0 to 1
        if (background) sum = {background->red / 255.0, background->green / 255.0, background->blue / 255.0, 1};
        const auto composite = [&](const std::array<double, 4>& top) {
            for (std::size_t k = 0; k < 4; ++k) sum[k] = top[k] + (1 - top[3]) * sum[k];
        };
        const auto surface = detail::to_deep(surface_light[i]);
        const double alpha = surface[3] / 65535.0;
        composite({alpha * surface[0] / 65535.0, alpha * surface[1] / 65535.0, alpha * surface[2] / 65535.0, alpha});
        const std::uint32_t pixel = over.argb[i];
        const auto byte = [&](unsigned shift) { return (pixel >> shift & 255U) / 255.0; };
        composite({byte(16), byte(8), byte(0), byte(24)});
        for (std::size_t k = 0; k < 4; ++k) {
            const double value = k == 3 ? sum[3] : sum[3] > 0 ? sum[k] / sum[3] : 0;
            picture.rgba[i][k] = static_cast<std::uint16_t>(std::lround(65535 * std::clamp(value, 0.0, 1.0)));
        }
    });
    return picture;
}

/// Draws the lines and dots that represent the surface or lie on it.
void draw_over(Canvas& canvas, const Scene& scene, const Surface& surface, const Camera& camera, const RenderOptions& options,
               const detail::Style& style, double drawn_size, PictureKind kind) {
    using Drawing = RenderOptions::Drawing;
    const double fine = kind == PictureKind::pixels ? 0 : 0.15;
    if (options.drawing == Drawing::points) {
        std::vector<Rgb> colours(scene.mesh.points.size(), style.ink);
        if (!scene.vertex_values.empty() && options.scale)
            for (std::size_t i = 0; i < colours.size(); ++i) colours[i] = colour_of(*options.scale, scene.vertex_values[i]);
        else if (scene.texture) detail::add_textured_points(colours, scene, surface, camera);
        else if (!scene.vertex_colours.empty()) colours = scene.vertex_colours;
        else if (!scene.face_colours.empty())
            for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t)
                for (const Index v : scene.mesh.triangles[t]) colours[v] = scene.face_colours[t];
        detail::draw_points(canvas, surface, camera, colours, std::max(0.7, 1.1 * drawn_size));
    }
    if (options.drawing == Drawing::wire)
        detail::draw_lines(canvas, detail::edge_lines(surface, style.ink, 0.7), surface, camera, {drawn_size, 0, 0, fine});
    if (options.drawing == Drawing::lines || options.contours)
        detail::draw_lines(canvas, detail::contour_lines(surface, camera, std::cos(options.crease * pi / 180), style.ink, 1.4),
                           surface, camera, {drawn_size, 5 * drawn_size, 12 * drawn_size, std::max(fine, 0.1)});
    detail::draw_lines(canvas, detail::lines_of(scene, surface), surface, camera, {drawn_size, 0, 0, fine});
}

detail::Style style_of(const RenderOptions& options, const Size& size) {
    const bool dark = options.theme == RenderOptions::Theme::dark;
    detail::Style style;
    style.background = options.background != "auto" ? parse_colour(options.background)
                       : dark                       ? Rgb{23, 25, 28}
                                                    : Rgb{255, 255, 255};
    style.size = detail::mark_size(size.width, size.height);
    const bool on_dark = style.background.red * 0.3 + style.background.green * 0.59 + style.background.blue * 0.11 < 110;
    if (dark || (!options.transparent && on_dark)) style.ink = {235, 235, 235};
    return style;
}

/// A picture of scenes: panes in columns and rows, each with a strip for scale bar and caption; a side column on the right.
class Sheet {
public:
    Sheet(const std::vector<Scene>& scenes, const RenderOptions& options, PictureKind kind)
        : scenes_(scenes), options_(options), kind_(kind), plans_(plan_panes(scenes, options)) {
        const bool contours = options.contours || options.drawing == RenderOptions::Drawing::lines;
        for (const Scene& scene : scenes)
            surfaces_.push_back(std::make_unique<Surface>(scene, contours || options.shading == RenderOptions::Shading::smooth));
        for (const Plan& plan : plans_)
            if (!plan.caption.empty()) caption_height_ = 30 * style_.size;
        if (deep_)
            surface_light_.assign(static_cast<std::size_t>(size_.width) * static_cast<std::size_t>(size_.height),
                                  detail::Light::Zero());
    }

    Rendering draw() {
        if (!options_.transparent && !deep_) canvas_.fill(style_.background);
        const detail::SideColumn side = side_column();
        const double side_left = size_.width - side.width() - (side.width() > 0 ? edge_ / 2 : 0);
        place_panes(side_left);
        for (std::size_t i = 0; i < plans_.size(); ++i) draw_pane(i);
        side.draw(side_left, edge_);
        Rendering rendering;
        rendering.width = size_.width;
        rendering.height = size_.height;
        if (options_.dpi > 0 || !options_.print_scale.empty()) rendering.pixels_per_metre = dpi_ / 0.0254;
        if (kind_ == PictureKind::pixels) rendering.picture = canvas_.picture();
        else rendering.document = canvas_.document();
        if (deep_) {
            rendering.deep = composed(surface_light_, rendering.picture,
                                      options_.transparent ? std::nullopt : std::optional(style_.background));
            rendering.picture = {};
        }
        for (const Plan& plan : plans_) rendering.panes.push_back(plan.pane);
        return rendering;
    }

private:
    [[nodiscard]] detail::SideColumn side_column() {
        bool any_values = false;
        for (const Scene& scene : scenes_) any_values = any_values || !scene.vertex_values.empty() || !scene.face_values.empty();
        const bool show = !options_.no_legend;
        return {canvas_,
                show && !options_.labels ? merged_legend(scenes_) : std::vector<LegendEntry>{},
                show && any_values ? options_.scale : std::nullopt,
                0.3 * size_.width,
                size_.height - 2 * edge_,
                style_};
    }

    /// Positions and cameras of the panes, left of `side_left`.
    void place_panes(double side_left) {
        std::vector<std::array<double, 2>> extents;
        for (const Plan& plan : plans_)
            extents.push_back(extent_of(scenes_[plan.pane.scene], *surfaces_[plan.pane.scene], plan.view, up_));
        const bool one_scale = options_.fit == RenderOptions::Fit::all;
        const std::size_t columns = column_count(extents, options_.views == "six", scenes_.size(), one_scale,
                                                 {side_left, static_cast<double>(size_.height), bar_height_ + caption_height_});
        const std::size_t rows = (plans_.size() + columns - 1) / columns;
        const double cell_width = side_left / static_cast<double>(columns),
                     cell_height = size_.height / static_cast<double>(rows);
        for (std::size_t i = 0; i < plans_.size(); ++i) {
            Plan& plan = plans_[i];
            Pane& pane = plan.pane;
            pane.left = static_cast<int>(cell_width * static_cast<double>(i % columns));
            const std::size_t row = i / columns;
            pane.top = static_cast<int>(cell_height * static_cast<double>(row));
            pane.width = std::max(1, static_cast<int>(cell_width));
            pane.height = std::max(1, static_cast<int>(cell_height - bar_height_ - caption_height_));
            const Scene& scene = scenes_[pane.scene];
            plan.label_column = options_.labels ? detail::label_column(canvas_, scene, pane.width, style_) : 0;
            pane.left += static_cast<int>(plan.label_column);
            pane.width = std::max(1, pane.width - 2 * static_cast<int>(plan.label_column));
            const Framed framed(scene, *surfaces_[pane.scene]);
            plan.camera = detail::fit_camera(framed.count(), framed, plan.view, up_, pane.width, pane.height,
                                             options_.projection == RenderOptions::Projection::perspective);
        }
        equalise_scales(plans_, surfaces_, one_scale);
        for (Plan& plan : plans_) plan.camera.scale *= options_.zoom;
        if (!options_.print_scale.empty()) print_at_scale();
    }

    /// Sets the cameras to the scale on paper.
    void print_at_scale() {
        constexpr double metres_per_inch = 0.0254, margin = 0.92;  // fraction of a pane that an object fills at most (camera.cpp)
        const double pixels_per_metre = dpi_ / metres_per_inch * parse_print_scale(options_.print_scale);
        double needed = 0;  // size of the picture that has room for the objects, relative to this one
        for (Plan& plan : plans_) {
            const double scale =
                scenes_[plan.pane.scene].unit_metres * pixels_per_metre * surfaces_[plan.pane.scene]->unit_length();
            needed = std::max(needed, margin * scale / plan.camera.scale);
            plan.camera.scale = scale;
        }
        if (needed <= 1) return;
        const auto side = [&](int pixels) { return static_cast<int>(std::ceil(1.02 * needed * pixels / 10)) * 10; };
        fail_usage(fmt::format("at the scale {} and {} dpi the object is larger than the picture", options_.print_scale, dpi_),
                   fmt::format("give --size {}x{}, or a smaller --dpi or --scale", side(size_.width), side(size_.height)));
    }

    void draw_pane(std::size_t index) {
        Plan& plan = plans_[index];
        Pane& pane = plan.pane;
        const Scene& scene = scenes_[pane.scene];
        const Surface& surface = *surfaces_[pane.scene];
        pane.pixels_per_unit = plan.camera.scale / surface.unit_length();
        if (options_.drawing == RenderOptions::Drawing::surface) draw_surface(plan);
        Camera sheet_camera = plan.camera;
        sheet_camera.middle_x += pane.left;
        sheet_camera.middle_y += pane.top;
        pane.camera = detail::in_mesh_coordinates(sheet_camera, surface.middle(), surface.unit_length());
        canvas_.clip(pane.left, pane.top, pane.width, pane.height);
        draw_over(canvas_, scene, surface, sheet_camera, options_, style_, overlay_style_.size, kind_);
        pane.markers_shown = detail::draw_markers(canvas_, scene, surface, sheet_camera, overlay_style_);
        const PixelBox box{double(pane.left), double(pane.top), double(pane.width), double(pane.height)};
        if (options_.axes) detail::draw_axes(canvas_, box, plan.camera, overlay_style_);
        canvas_.unclip();
        if (plan.label_column > 0) {
            pane.labels = detail::place_labels(canvas_, scene, surface, sheet_camera, box, plan.label_column, style_);
            detail::draw_labels(canvas_, pane.labels, style_);
        }
        const bool first_of_scene = index == 0 || plans_[index - 1].pane.scene != pane.scene;
        const bool every_bar = options_.fit == RenderOptions::Fit::each && scenes_.size() > 1;
        if (!options_.no_scale_bar && (index == 0 || (every_bar && first_of_scene)))
            add_scale_bar(canvas_, plan, scene, surface.unit_length(), bar_height_, style_, options_.print_scale);
        if (!plan.caption.empty())
            canvas_.text(canvas_.elide(plan.caption, 17 * style_.size, 0.94 * pane.width), pane.left + pane.width / 2.0,
                         pane.top + pane.height + bar_height_ + 19 * style_.size, 17 * style_.size, style_.ink,
                         Canvas::Align::centre);
    }

    /// The shaded surface of a pane, supersampled: averaged for pixel output, kept for documents.
    void draw_surface(const Plan& plan) {
        const Pane& pane = plan.pane;
        const bool pixels = kind_ == PictureKind::pixels;
        const int requested_factor = options_.supersample > 0 ? options_.supersample : pixels ? 1 : 2;
        const int factor = std::clamp(16384 / std::max(pane.width, pane.height), 1, requested_factor);
        Camera camera = plan.camera;
        for (double* value : {&camera.scale, &camera.middle_x, &camera.middle_y}) *value *= factor;
        auto light = detail::shade(scenes_[pane.scene], *surfaces_[pane.scene], camera, pane.width * factor, pane.height * factor,
                                   shading(factor));
        const bool average = pixels && factor > 1;
        if (average) light = detail::averaged(light, pane.width, pane.height, factor);
        const int samples_wide = average ? pane.width : pane.width * factor,
                  samples_high = average ? pane.height : pane.height * factor;
        if (deep_) return copy_into(surface_light_, size_.width, light, pane);
        canvas_.paint(detail::to_pixels(light), samples_wide, samples_high, pane.left, pane.top, pane.width, pane.height);
    }

    [[nodiscard]] detail::Shading shading(int factor) const {
        detail::Shading shading;
        shading.smooth = options_.shading == RenderOptions::Shading::smooth;
        shading.crease_cosine = std::cos(options_.crease * pi / 180);
        shading.ambient_occlusion = options_.ambient_occlusion;
        shading.samples = options_.samples;
        shading.edges = options_.edges;
        shading.flat_light = options_.light == RenderOptions::Light::flat;
        shading.edge_width = std::max(0.6, 0.9 * style_.size) * factor;
        if (options_.scale) shading.scale = *options_.scale;
        return shading;
    }

    const std::vector<Scene>& scenes_;
    const RenderOptions& options_;
    PictureKind kind_;
    Size size_ = parse_size(options_.size);
    std::array<double, 3> up_ = parse_up(options_.up);
    bool deep_ = options_.sixteen_bit && kind_ == PictureKind::pixels;
    std::vector<Plan> plans_;
    std::vector<std::unique_ptr<Surface>> surfaces_;
    detail::Style style_ = style_of(options_, size_);
    detail::Style overlay_style_ = scaled_style();  ///< of lines, markers and axes: smaller on a sheet of many panes
    double dpi_ = options_.dpi > 0 ? options_.dpi : options_.print_scale.empty() ? detail::css_dpi : 300;
    Canvas canvas_{size_.width, size_.height, kind_, dpi_};
    std::vector<detail::Light> surface_light_;  ///< of the whole sheet, for 16 bits per channel
    double edge_ = 18 * style_.size;
    double bar_height_ = options_.no_scale_bar ? 0 : detail::bar_strip * style_.size;
    double caption_height_ = 0;

    [[nodiscard]] detail::Style scaled_style() const {
        detail::Style smaller = style_;
        if (plans_.size() > 2) smaller.size *= 0.75;
        return smaller;
    }
};

}  // namespace

Rendering render(const std::vector<Scene>& scenes, const RenderOptions& options, PictureKind kind) {
    check_render_options(options);
    if (scenes.empty() || scenes.size() > 64) fail_usage("a picture shows 1 to 64 objects", "render several pictures");
    for (const Scene& scene : scenes)
        if (!options.print_scale.empty() && !(scene.unit_metres > 0))
            fail_usage(fmt::format("--scale {} needs the unit of the coordinates", options.print_scale),
                       "give a length such as --unit mm");
    const auto start = std::chrono::steady_clock::now();
    Sheet sheet(scenes, options, kind);
    const double build_seconds = seconds_since(start);
    const auto drawing_start = std::chrono::steady_clock::now();
    Rendering rendering = sheet.draw();
    rendering.build_seconds = build_seconds;
    rendering.draw_seconds = seconds_since(drawing_start);
    return rendering;
}

}  // namespace ostraka
