#include "ostraka/render/view.h"
#include "ostraka/core/angles.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace ostraka {

namespace {
using Triple = std::array<double, 3>;

Triple cross(const Triple& a, const Triple& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Triple combine(double s, const Triple& a, double t, const Triple& b) {
    return {s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]};
}
Triple unit(const Triple& a) {
    const double length = std::sqrt(dot(a, a));
    return {a[0] / length, a[1] / length, a[2] / length};
}

/// Numbers separated by commas; empty for any other text.
std::vector<double> numbers(const std::string& text) {
    std::vector<double> values;
    const char* position = text.c_str();
    for (;;) {
        char* end = nullptr;
        if (std::isspace(static_cast<unsigned char>(*position)) != 0) return {};
        const double value = std::strtod(position, &end);
        if (end == position || !std::isfinite(value)) return {};
        values.push_back(value);
        if (*end == '\0') return values;
        if (*end != ',') return {};
        position = end + 1;
    }
}

/// Sine that is exact at multiples of a right angle, so that the standard views have exact axes.
double sine(double degrees) {
    const double angle = std::remainder(degrees, 360.0);
    if (angle == 0 || std::abs(angle) == 180) return 0;
    if (angle == 90) return 1;
    if (angle == -90) return -1;
    return std::sin(angle * pi / 180);
}
double cosine(double degrees) { return sine(degrees + 90); }
}  // namespace

View parse_view(const std::string& text) {
    for (const View& view : standard_views())
        if (view.name == text) return view;
    if (text == "iso") return {"iso", 45, std::atan(1 / std::numbers::sqrt2) * 180 / pi};
    const auto angles = numbers(text);
    if (angles.size() != 2 || std::abs(angles[1]) > 90 || std::abs(angles[0]) > 3600) {
        const Words words = view_words();
        fail_usage(fmt::format("the view '{}' is unknown", text),
                   fmt::format("use {} or {} with an elevation of -90 to 90", joined(words.names), words.others));
    }
    return {text, angles[0], angles[1]};
}

Words view_words() {
    return {{"front", "back", "left", "right", "top", "bottom", "iso"},
            "azimuth,elevation in degrees",
            [](const std::string& text) { static_cast<void>(parse_view(text)); }};
}

std::vector<View> standard_views() {
    return {{"front", 0, 0}, {"right", 90, 0}, {"back", 180, 0}, {"left", 270, 0}, {"top", 0, 90}, {"bottom", 0, -90}};
}

std::array<double, 3> parse_up(const std::string& text) {
    if (text == "auto" || text == "z") return {0, 0, 1};
    if (text == "x") return {1, 0, 0};
    if (text == "y") return {0, 1, 0};
    if (text == "-x") return {-1, 0, 0};
    if (text == "-y") return {0, -1, 0};
    if (text == "-z") return {0, 0, -1};
    const auto components = numbers(text);
    const double largest =
        components.size() == 3 ? std::max({std::abs(components[0]), std::abs(components[1]), std::abs(components[2])}) : 0;
    if (!(largest > 0))
        fail_usage(fmt::format("the up axis '{}' is unknown", text),
                   "use x, y, z, -x, -y, -z or three numbers such as 0,0.6,0.8");
    return unit({components[0] / largest, components[1] / largest, components[2] / largest});
}

ViewAxes view_axes(const View& view, const std::array<double, 3>& up) {
    const Triple reference = std::abs(up[1]) > 0.8 ? Triple{0, 0, 1} : Triple{0, -1, 0};
    const Triple front = unit(combine(1, reference, -dot(reference, up), up));
    const Triple side = cross(up, front);
    const Triple level = combine(cosine(view.azimuth), front, sine(view.azimuth), side);
    ViewAxes axes;
    axes.toward = combine(cosine(view.elevation), level, sine(view.elevation), up);
    axes.up = combine(-sine(view.elevation), level, cosine(view.elevation), up);
    axes.right = cross(axes.up, axes.toward);
    return axes;
}

}  // namespace ostraka
