// Expressions and picks through a camera.
#include "select/expression.h"

#include "ostraka/core/text.h"

#include <algorithm>

namespace ostraka {

namespace {

Pixel pixel_of(const JsonValue& list) { return {list[0].GetDouble(), list[1].GetDouble()}; }

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

ScreenCamera ExpressionEvaluator::camera(const JsonValue& owner, PlaceFrame frame, const std::string& at) const {
    const auto read = [&](const JsonValue& value, PlaceFrame around, const std::string& here) {
        const PlaceFrame own = frame_of(value, around);
        const auto place = [&](const JsonValue& list) { return point(list, own, here); };
        ScreenCamera result;
        in_place(here, [&] { result = read_camera(value, mesh_, surroundings_.up, place, where_ + ", at " + here); });
        return result;
    };
    const JsonValue& value = owner["camera"];
    if (!value.IsString()) return read(value, frame, at + "/camera");
    const std::string name = text_of(value);
    const JsonValue* named = surroundings_.cameras == nullptr ? nullptr : find_member(*surroundings_.cameras, name);
    if (named == nullptr)
        fail(at + "/camera", "no camera has the name '" + name + "'", "define it under \"cameras\" of the recipe");
    const auto known = cameras_.find(name);
    if (known != cameras_.end()) return known->second;
    return cameras_.emplace(name, read(*named, surroundings_.frame, "/cameras/" + name)).first->second;
}

SurfaceHit ExpressionEvaluator::seen(const JsonValue& pick, PlaceFrame frame, const std::string& at) const {
    const ScreenCamera from = camera(pick, frame, at);
    const Pixel pixel = pixel_of(pick["pixel"]);
    if (!within(pixel, from))
        fail(at + "/pixel", "pixel " + text(pixel) + " lies outside the picture of " + size_of(from), "pick one within it");
    const auto hit = seen_at(search(at), from.camera, pixel);
    if (!hit) fail(at + "/pixel", "pixel " + text(pixel) + " shows the background", "pick one that shows the surface");
    return *hit;
}

ScreenArea ExpressionEvaluator::screen_area(const std::string& kind, const JsonValue& value, const ScreenCamera& camera,
                                            const std::string& at) const {
    const auto require_overlap = [&](const Pixel& low, const Pixel& high) {
        if (high[0] < 0 || high[1] < 0 || low[0] > camera.width || low[1] > camera.height)
            fail(at,
                 "the " + kind + " from " + text(low) + " to " + text(high) + " lies outside the picture of " + size_of(camera),
                 "draw it within the picture");
    };
    if (kind == "rectangle") {
        const Pixel from = pixel_of(value["from"]), to = pixel_of(value["to"]);
        if (from[0] == to[0] || from[1] == to[1]) fail(at, "the rectangle has no area", "give two opposite corners");
        require_overlap({std::min(from[0], to[0]), std::min(from[1], to[1])},
                        {std::max(from[0], to[0]), std::max(from[1], to[1])});
        return screen_rectangle(from, to);
    }
    std::vector<Pixel> points;
    for (const auto& point : value["points"].GetArray()) points.push_back(pixel_of(point));
    Pixel low = points.front(), high = low;
    for (const Pixel& p : points)
        for (std::size_t k = 0; k < 2; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    require_overlap(low, high);
    return screen_polygon(points, where_ + ", at " + at);
}

}  // namespace ostraka
