#include "catalogue/views.h"

#include "ostraka/image/image.h"
#include "ostraka/render/render.h"
#include "ostraka/slicing/silhouette.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka::detail {

namespace {

/// Directions of a view as vectors.
struct Axes {
    Vector right, up, toward;
    explicit Axes(const View& view) {
        const ViewAxes axes = view_axes(view, {0, 0, 1});
        const auto vector = [](const std::array<double, 3>& a) { return Vector(a[0], a[1], a[2]); };
        right = vector(axes.right), up = vector(axes.up), toward = vector(axes.toward);
    }
};

Pixels to_pixels(const Picture& picture) {
    Pixels pixels{picture.width, picture.height, {}};
    pixels.rgba.reserve(picture.argb.size());
    for (const std::uint32_t p : picture.argb)
        pixels.rgba.push_back({static_cast<std::uint8_t>(p >> 16U & 255U), static_cast<std::uint8_t>(p >> 8U & 255U),
                               static_cast<std::uint8_t>(p & 255U), 255});
    return pixels;
}

/// Renders the object so that it fills a picture of its own proportions.
void add_picture(CatalogueView& result, const TriangleSoup& soup, const View& view, int pixels) {
    const double width = result.object_right - result.object_left, height = result.object_high - result.object_low;
    const double longer = std::max(width, height);
    if (!(longer > 0)) return;
    const auto side = [&](double length) { return std::max(64, static_cast<int>(std::lround(pixels * length / longer)) + 40); };
    RenderOptions options;
    options.size = fmt::format("{}x{}", side(width), side(height));
    options.view = fmt::format("{:.17g},{:.17g}", view.azimuth, view.elevation);
    options.up = "z";
    options.background = "white";
    options.no_scale_bar = options.no_legend = true;
    Scene scene;
    scene.mesh = soup;
    constexpr std::uint8_t grey = 214;
    scene.face_colours.assign(soup.triangles.size(), {grey, grey, grey});
    const Rendering rendering = render({scene}, options);
    const PictureCamera& camera = rendering.panes.at(0).camera;
    const auto origin = camera.project(Point(0, 0, 0));
    if (!origin || !(camera.scale > 0)) return;
    result.left = -(*origin)[0] / camera.scale;
    result.low = ((*origin)[1] - rendering.picture.height) / camera.scale;
    result.width = rendering.picture.width / camera.scale;
    result.height = rendering.picture.height / camera.scale;
    constexpr int quality = 88;
    result.jpeg = encode(to_pixels(rendering.picture), ImageFormat::jpeg, "view.jpg", quality).bytes;
}

}  // namespace

CatalogueView make_view(const TriangleSoup& soup, const Mesh& mesh, const View& view, const ViewStyle& style) {
    const Axes axes(view);
    CatalogueView result;
    result.name = view.name;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    result.object_left = result.object_low = infinity;
    result.object_right = result.object_high = -infinity;
    for (const auto& triangle : soup.triangles)
        for (const Index i : triangle) {
            const Vector p(soup.points[i][0], soup.points[i][1], soup.points[i][2]);
            const double x = axes.right * p, y = axes.up * p;
            result.object_left = std::min(result.object_left, x), result.object_right = std::max(result.object_right, x);
            result.object_low = std::min(result.object_low, y), result.object_high = std::max(result.object_high, y);
        }
    if (style.shaded) add_picture(result, soup, view, style.pixels);
    if (style.outlined) {
        SliceFrame frame;
        frame.u = axes.right, frame.v = axes.up, frame.normal = axes.toward;
        constexpr int cells = 800;
        result.outline = silhouette(mesh, frame, cells);
    }
    return result;
}

void mark_landmarks(CatalogueView& view, const View& direction, const SurfaceSearch& surface,
                    const std::vector<std::array<double, 3>>& landmarks) {
    const Axes axes(direction);
    const double lift = 0.01 * surface.diagonal(), away = 2 * surface.diagonal();
    for (std::size_t i = 0; i < landmarks.size(); ++i) {
        const Point p(landmarks[i][0], landmarks[i][1], landmarks[i][2]);
        if (surface.blocked(p + lift * axes.toward, p + away * axes.toward, [](Index) { return false; })) continue;
        view.marks.push_back({i + 1, {axes.right * (p - CGAL::ORIGIN), axes.up * (p - CGAL::ORIGIN)}});
    }
}

Mesh loose_mesh(const TriangleSoup& soup) {
    TriangleSoup loose;
    loose.points.reserve(3 * soup.triangles.size());
    for (const auto& triangle : soup.triangles) {
        const auto first = static_cast<Index>(loose.points.size());
        for (const Index corner : triangle) loose.points.push_back(soup.points[corner]);
        loose.triangles.push_back({first, first + 1, first + 2});
    }
    return build_mesh(loose);
}

}  // namespace ostraka::detail
