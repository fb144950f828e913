// Expressions and picks through a camera.
#include "select/evaluator.h"

#include "ostraka/core/overloaded.h"
#include "ostraka/core/text.h"

#include <algorithm>

namespace ostraka {

namespace {

std::string text(const Pixel& pixel) { return "(" + digits(pixel[0], 6) + ", " + digits(pixel[1], 6) + ")"; }

bool within(const Pixel& pixel, const ScreenCamera& camera) {
    return 0 <= pixel[0] && pixel[0] <= camera.width && 0 <= pixel[1] && pixel[1] <= camera.height;
}

std::string size_of(const ScreenCamera& camera) { return digits(camera.width, 6) + " x " + digits(camera.height, 6); }

}  // namespace

const SurfaceSearch& ExpressionEvaluator::search(const std::string& at) const {
    if (!search_) in_place(at, [&] { search_.emplace(mesh_); });
    return *search_;
}

const SurfaceSearch* ExpressionEvaluator::visibility(const selection::DrawnArea& drawn, const std::string& at) const {
    return drawn.visible_only ? &search(at) : nullptr;
}

const ScreenCamera& ExpressionEvaluator::camera(const selection::Camera& description) const {
    const auto known = cameras_.find(description.at);
    if (known != cameras_.end()) return known->second;
    const auto place = [&](const selection::Position& position) { return point(position, description.at); };
    ScreenCamera result;
    in_place(description.at,
             [&] { result = screen_camera(description, mesh_, surroundings_.up, place, location(description.at)); });
    return cameras_.emplace(description.at, result).first->second;
}

SurfaceHit ExpressionEvaluator::seen(const selection::PixelPick& pick, const std::string& at) const {
    const ScreenCamera& from = camera(*pick.camera);
    if (!within(pick.pixel, from))
        fail(at + "/pixel", "pixel " + text(pick.pixel) + " lies outside the picture of " + size_of(from), "pick one within it");
    const auto hit = seen_at(search(at), from.camera, pick.pixel);
    if (!hit) fail(at + "/pixel", "pixel " + text(pick.pixel) + " shows the background", "pick one that shows the surface");
    return *hit;
}

ScreenArea ExpressionEvaluator::screen_area(const selection::DrawnArea& drawn, const std::string& at) const {
    const ScreenCamera& from = camera(*drawn.camera);
    const auto require_overlap = [&](const std::string& shape, const std::vector<Pixel>& points) {
        Pixel low = points.front(), high = low;
        for (const Pixel& p : points)
            for (std::size_t k = 0; k < 2; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
        if (high[0] < 0 || high[1] < 0 || low[0] > from.width || low[1] > from.height)
            fail(at,
                 "the " + shape + " from " + text(low) + " to " + text(high) + " lies outside the picture of " + size_of(from),
                 "draw it within the picture");
    };
    return std::visit(Overloaded{[&](const selection::Rectangle& rectangle) {
                                     require_overlap("rectangle", {rectangle.from, rectangle.to});
                                     return screen_rectangle(rectangle.from, rectangle.to);
                                 },
                                 [&](const selection::Polygon& polygon) {
                                     require_overlap("polygon", polygon.points);
                                     return screen_polygon(polygon.points, location(at));
                                 }},
                      drawn.shape);
}

}  // namespace ostraka
