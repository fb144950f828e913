#include "render/overlay.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"

#include <fmt/core.h>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/point_xy.hpp>

#include <algorithm>
#include <cmath>

namespace ostraka::detail {

namespace {
/// Distance from the surface at which a ray to the viewer starts, in units of half the box's largest side, so that points on
/// the surface are not hidden by it.
constexpr double sight_tolerance = 4e-3;

Rgb darker(const Rgb& colour) {
    const auto darken = [](std::uint8_t c) { return static_cast<std::uint8_t>(c * 2 / 5); };
    return {darken(colour.red), darken(colour.green), darken(colour.blue)};
}

struct Stroke {
    std::vector<Canvas::Place> places;
    const Line* line;
    bool hidden;
};

/// A sample of a line, about every 1.5 pixels.
struct Step {
    Eigen::Vector3d sight;
    Canvas::Place place;
    bool shown = false;
};

std::vector<Step> steps_along(const Line& line, const Camera& camera) {
    constexpr double spacing = 1.5;
    constexpr double maximum = 4096;  // maximum number of samples per segment: sufficient for any segment within the picture
    const auto& sight = line.sight.empty() ? line.points : line.sight;
    std::vector<Step> steps;
    const auto add = [&](const Eigen::Vector3d& point, const Eigen::Vector3d& from) {
        Step step{from, {}, false};
        if (camera.project(point, step.place.x, step.place.y)) steps.push_back(step);
    };
    for (std::size_t i = 0; i < line.points.size(); ++i) {
        if (i > 0) {
            double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
            double count = maximum;
            if (camera.project(line.points[i - 1], x0, y0) && camera.project(line.points[i], x1, y1))
                count = std::clamp(std::ceil(std::hypot(x1 - x0, y1 - y0) / spacing), 1.0, maximum);
            for (double k = 1; k < count; ++k)
                add(line.points[i - 1] + (k / count) * (line.points[i] - line.points[i - 1]),
                    sight[i - 1] + (k / count) * (sight[i] - sight[i - 1]));
        }
        add(line.points[i], sight[i]);
    }
    return steps;
}

double length_between(const std::vector<Step>& steps, std::size_t begin, std::size_t end) {
    double length = 0;
    for (std::size_t i = begin; i + 1 < end; ++i)
        length += std::hypot(steps[i + 1].place.x - steps[i].place.x, steps[i + 1].place.y - steps[i].place.y);
    return length;
}

void bridge(std::vector<Step>& steps, double longest) {
    std::size_t after_shown = 0;  // index after the last visible sample
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (!steps[i].shown) continue;
        if (after_shown > 0 && i > after_shown && length_between(steps, after_shown - 1, i + 1) < longest)
            for (std::size_t k = after_shown; k < i; ++k) steps[k].shown = true;
        after_shown = i + 1;
    }
}

double length_of(const std::vector<Canvas::Place>& places) {
    double length = 0;
    for (std::size_t i = 1; i < places.size(); ++i)
        length += std::hypot(places[i].x - places[i - 1].x, places[i].y - places[i - 1].y);
    return length;
}

/// Removes points that lie no farther than `tolerance` from the line between kept points (Douglas and Peucker 1973).
std::vector<Canvas::Place> thinned(const std::vector<Canvas::Place>& places, double tolerance) {
    namespace bg = boost::geometry;
    using Corner = bg::model::d2::point_xy<double>;
    bg::model::linestring<Corner> line, simplified;
    for (const Canvas::Place& place : places) line.push_back({place.x, place.y});
    bg::simplify(line, simplified, tolerance);
    std::vector<Canvas::Place> points;
    for (const Corner& corner : simplified) points.push_back({corner.x(), corner.y()});
    return points;
}
}  // namespace

bool is_visible(const Surface& surface, const Camera& camera, const Eigen::Vector3d& point) {
    return !surface.blocked(point, camera.to_viewer(point), sight_tolerance, camera.distance_to_viewer(point));
}

std::vector<Line> lines_of(const Scene& scene, const Surface& surface) {
    std::vector<Line> lines;
    for (const SceneLine& scene_line : scene.lines) {
        Line& line = lines.emplace_back();
        for (const auto& point : scene_line.points) {
            for (const double c : point)
                if (!std::isfinite(c))
                    fail_input("picture", "a line has a coordinate that is not finite", "give finite coordinates");
            line.points.push_back(surface.to_local(point));
        }
        line.colour = scene_line.colour;
        line.width = scene_line.width;
        line.cased = scene_line.cased;
        line.through = scene_line.through;
    }
    return lines;
}

void draw_lines(Canvas& canvas, const std::vector<Line>& lines, const Surface& surface, const Camera& camera,
                const LineDrawing& drawing) {
    std::vector<std::vector<Step>> steps(lines.size());
    parallel_for(lines.size(), [&](std::size_t i) { steps[i] = steps_along(lines[i], camera); });
    std::vector<Step*> all_steps;
    for (auto& line_steps : steps)
        for (Step& step : line_steps) all_steps.push_back(&step);
    parallel_for(all_steps.size(), 256,
                 [&](std::size_t i) { all_steps[i]->shown = is_visible(surface, camera, all_steps[i]->sight); });
    if (drawing.bridged > 0)
        for (auto& line_steps : steps) bridge(line_steps, drawing.bridged);
    std::vector<Stroke> strokes;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const Line& line = lines[i];
        bool open = false;
        for (std::size_t k = 0; k < steps[i].size(); ++k) {
            const Step& step = steps[i][k];
            const bool turn = k > 0 && step.shown != steps[i][k - 1].shown;
            if (line.through && turn) {
                strokes.back().places.push_back(step.place);
                open = false;
            }
            if ((step.shown || line.through) && !open) strokes.push_back({{}, &line, !step.shown});
            open = step.shown || line.through;
            if (open) strokes.back().places.push_back(step.place);
        }
    }
    if (drawing.shortest > 0)
        std::erase_if(strokes, [&](const Stroke& stroke) { return length_of(stroke.places) < drawing.shortest; });
    if (drawing.thinning > 0)
        for (Stroke& stroke : strokes)
            if (stroke.places.size() > 2) stroke.places = thinned(stroke.places, drawing.thinning);
    for (const Stroke& stroke : strokes)
        if (stroke.line->cased && !stroke.hidden)
            canvas.polyline(stroke.places, darker(stroke.line->colour), (stroke.line->width + 2) * drawing.size);
    for (const Stroke& stroke : strokes) {
        if (stroke.hidden) canvas.dashed(stroke.places, stroke.line->colour, 0.7 * stroke.line->width * drawing.size);
        else canvas.polyline(stroke.places, stroke.line->colour, stroke.line->width * drawing.size);
    }
}

std::size_t draw_markers(Canvas& canvas, const Scene& scene, const Surface& surface, const Camera& camera, const Style& style) {
    std::size_t shown = 0;
    for (const SceneMarker& marker : scene.markers) {
        for (const double c : marker.point)
            if (!std::isfinite(c))
                fail_input("picture", "a marker has a coordinate that is not finite", "give finite coordinates");
        const Eigen::Vector3d point = surface.to_local(marker.point);
        Canvas::Place place{};
        if (!camera.project(point, place.x, place.y) || !(marker.through || is_visible(surface, camera, point))) continue;
        ++shown;
        canvas.disc(place, (marker.radius + 1.5) * style.size, darker(marker.colour));
        canvas.disc(place, (marker.radius + 0.5) * style.size, {255, 255, 255});
        canvas.disc(place, (marker.radius - 1) * style.size, marker.colour);
        if (!marker.label.empty())
            canvas.text(canvas.elide(clean_text(marker.label), 14 * style.size, 240 * style.size),
                        place.x + (marker.radius + 5) * style.size, place.y + 5 * style.size, 14 * style.size, style.ink,
                        Canvas::Align::left, &style.background);
    }
    return shown;
}

void draw_axes(Canvas& canvas, const PixelBox& pane, const Camera& camera, const Style& style) {
    struct Axis {
        const char* name;
        Eigen::Vector3d direction;
        Rgb colour;
    };
    std::array<Axis, 3> axes{
        {{"x", {1, 0, 0}, {204, 102, 119}}, {"y", {0, 1, 0}, {60, 150, 80}}, {"z", {0, 0, 1}, {88, 120, 200}}}};
    std::stable_sort(axes.begin(), axes.end(), [&](const Axis& a, const Axis& b) {
        return a.direction.dot(camera.toward) < b.direction.dot(camera.toward);  // the nearest last
    });
    const double length = 34 * style.size, head = 8 * style.size;
    const Canvas::Place origin{pane.left + pane.width - 58 * style.size, pane.top + pane.height - 50 * style.size};
    for (const Axis& axis : axes) {
        const double x = axis.direction.dot(camera.right), y = -axis.direction.dot(camera.up),
                     projected_length = std::hypot(x, y);
        if (projected_length < 0.1) {
            canvas.disc(origin, 4 * style.size, axis.colour);
        } else {
            const Canvas::Place tip{origin.x + x * length, origin.y + y * length};
            const double along_x = x / projected_length * std::min(head, projected_length * length),
                         along_y = y / projected_length * std::min(head, projected_length * length);
            canvas.polyline({origin, {tip.x - along_x, tip.y - along_y}}, axis.colour, 2.2 * style.size);
            canvas.polygon({tip,
                            {tip.x - along_x - 0.45 * along_y, tip.y - along_y + 0.45 * along_x},
                            {tip.x - along_x + 0.45 * along_y, tip.y - along_y - 0.45 * along_x}},
                           axis.colour);
        }
        // The name of an axis that points to the viewer is below its dot.
        const double name_x = projected_length < 0.1 ? 0 : x / projected_length,
                     name_y = projected_length < 0.1 ? 1 : y / projected_length;
        canvas.text(axis.name, origin.x + x * length + name_x * 10 * style.size,
                    origin.y + y * length + name_y * 10 * style.size + 5 * style.size, 14 * style.size, style.ink,
                    Canvas::Align::centre, &style.background);
    }
}

void draw_scale_bar(Canvas& canvas, double x, double y, double pixels, const std::string& text, const Style& style) {
    const double thick = std::max(2.0, 3 * style.size), cap = 4 * style.size;
    canvas.rectangle(x, y - thick, pixels, thick, style.ink);
    canvas.rectangle(x, y - thick - cap, std::max(1.0, thick / 2), thick + cap, style.ink);
    canvas.rectangle(x + pixels - std::max(1.0, thick / 2), y - thick - cap, std::max(1.0, thick / 2), thick + cap, style.ink);
    canvas.text(text, x + pixels / 2, y - thick - cap - 4 * style.size, 14 * style.size, style.ink, Canvas::Align::centre);
}

SideColumn::SideColumn(Canvas& canvas, std::vector<LegendEntry> legend, std::optional<ColourScale> scale, double width_limit,
                       double height, const Style& style)
    : canvas_(canvas), legend_(std::move(legend)), scale_(std::move(scale)), style_(style), height_(height) {
    const double size = style.size;
    font_ = 15 * size;
    if (!legend_.empty()) {
        const double available_height = scale_ ? height * 0.45 : height;
        const double needed_height = 1.65 * font_ * static_cast<double>(legend_.size());
        if (needed_height > available_height) font_ = std::max(0.62 * font_, font_ * available_height / needed_height);
        const auto rows = static_cast<std::size_t>(std::max(1.0, available_height / (1.65 * font_)));
        if (legend_.size() > rows) {
            omitted_ = legend_.size() - rows + 1;
            legend_.resize(rows - 1);
        }
        for (LegendEntry& entry : legend_) {
            entry.text = canvas.elide(clean_text(entry.text), font_, width_limit - 3.2 * font_);
            width_ = std::max(width_, canvas.text_width(entry.text, font_) + 3.2 * font_);
        }
        width_ = std::max(width_, 9 * font_);
        legend_height_ = 1.65 * font_ * static_cast<double>(legend_.size() + (omitted_ > 0 ? 1 : 0));
    }
    if (scale_) {
        ticks_ = ticks(*scale_, 7);
        const double step = ticks_.size() > 1 ? ticks_[1] - ticks_[0] : 0;
        for (const double tick : ticks_) {
            tick_texts_.push_back(tick_text(tick, step));
            tick_width_ = std::max(tick_width_, canvas.text_width(tick_texts_.back(), 14 * size));
        }
        width_ = std::max(width_, (20 + 10 + 12 + 22 + 12) * size + tick_width_);
    }
}

void SideColumn::draw(double left, double top) const {
    if (!legend_.empty() || omitted_ > 0) draw_legend(left, top);
    if (scale_) draw_colour_bar(left, top + legend_height_);
}

void SideColumn::draw_legend(double left, double top) const {
    const double row = 1.65 * font_, box = 1.05 * font_;
    double y = top;
    for (const LegendEntry& entry : legend_) {
        const double middle = y + row / 2;
        switch (entry.mark) {
            case LegendMark::area:
                canvas_.rectangle(left, middle - box / 2, box, box, darker(entry.colour));
                canvas_.rectangle(left + style_.size, middle - box / 2 + style_.size, box - 2 * style_.size,
                                  box - 2 * style_.size, entry.colour);
                break;
            case LegendMark::line:
                canvas_.polyline({{left + 2, middle}, {left + box - 2, middle}}, darker(entry.colour), 0.34 * font_);
                canvas_.polyline({{left + 2, middle}, {left + box - 2, middle}}, entry.colour, 0.22 * font_);
                break;
            case LegendMark::point:
                canvas_.disc({left + box / 2, middle}, 0.42 * font_, darker(entry.colour));
                canvas_.disc({left + box / 2, middle}, 0.34 * font_, entry.colour);
                break;
        }
        canvas_.text(entry.text, left + 1.6 * font_, middle + 0.36 * font_, font_, style_.ink);
        y += row;
    }
    if (omitted_ > 0)
        canvas_.text(fmt::format("and {} more", omitted_), left + 1.6 * font_, y + row / 2 + 0.36 * font_, font_, style_.ink);
}

void SideColumn::draw_colour_bar(double left, double top) const {
    const double size = style_.size, available_height = height_ - legend_height_;
    const double bar_height = std::max(40 * size, std::min(0.62 * available_height, 460 * size)), bar_width = 20 * size;
    const double bar_top = top + std::max(0.0, (available_height - bar_height) / 2);
    const int bands = static_cast<int>(bar_height);
    for (int i = 0; i < bands; ++i) {
        const double fraction = 1 - (i + 0.5) / bands;
        const double value = scale_->minimum * (1 - fraction) + scale_->maximum * fraction;
        canvas_.rectangle(left, bar_top + i, bar_width, 1.5, colour_of(*scale_, value));
    }
    const double width = scale_->maximum / 2 - scale_->minimum / 2;
    for (std::size_t i = 0; i < ticks_.size(); ++i) {
        const double fraction = width > 0 ? (ticks_[i] / 2 - scale_->minimum / 2) / width : 0.5;
        const double y = bar_top + (1 - fraction) * bar_height;
        canvas_.rectangle(left + bar_width, y - 0.5, 5 * size, std::max(1.0, size), style_.ink);
        canvas_.text(tick_texts_[i], left + bar_width + 10 * size + tick_width_, y + 5 * size, 14 * size, style_.ink,
                     Canvas::Align::right);
    }
    const std::string label = canvas_.elide(clean_text(scale_->label), 15 * size, std::max(60.0, available_height - 20 * size));
    canvas_.upward_text(label, left + bar_width + 10 * size + tick_width_ + 24 * size, bar_top + bar_height / 2, 15 * size,
                        style_.ink);
}

}  // namespace ostraka::detail
