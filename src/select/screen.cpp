#include "select/screen.h"
#include "ostraka/core/angles.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

double orientation(const Pixel& a, const Pixel& b, const Pixel& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// True if c, which lies on the line through a and b, is between them.
bool between(const Pixel& a, const Pixel& b, const Pixel& c) {
    return std::min(a[0], b[0]) <= c[0] && c[0] <= std::max(a[0], b[0]) && std::min(a[1], b[1]) <= c[1] &&
           c[1] <= std::max(a[1], b[1]);
}

bool meet(const Pixel& a, const Pixel& b, const Pixel& c, const Pixel& d) {
    const double abc = orientation(a, b, c), abd = orientation(a, b, d), cda = orientation(c, d, a), cdb = orientation(c, d, b);
    if (((abc > 0 && abd < 0) || (abc < 0 && abd > 0)) && ((cda > 0 && cdb < 0) || (cda < 0 && cdb > 0))) return true;
    return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) || (cda == 0 && between(c, d, a)) ||
           (cdb == 0 && between(c, d, b));
}

Pixel meeting_place(const Pixel& a, const Pixel& b, const Pixel& c, const Pixel& d) {
    const double along = orientation(c, d, a) - orientation(c, d, b);
    const double t = along == 0 ? 0 : orientation(c, d, a) / along;
    return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
}

bool inside(const std::vector<Pixel>& points, const Pixel& p) {
    bool odd = false;
    for (std::size_t i = 0, j = points.size() - 1; i < points.size(); j = i++) {
        const Pixel &a = points[j], &b = points[i];
        if ((a[1] > p[1]) == (b[1] > p[1])) continue;
        if ((orientation(a, b, p) > 0) == (b[1] > a[1])) odd = !odd;
    }
    return odd;
}

/// Tests which of `count` points are seen; `place(i)` returns a point, `ignored(i)` the faces that cannot hide it.
template <class Place, class Ignored>
std::vector<char> seen(std::size_t count, const PictureCamera& camera, const ScreenArea& area, const SurfaceSearch* search,
                       const Place& place, const Ignored& ignored) {
    const auto eye = camera.eye();
    const Vector away = search == nullptr ? Vector(0, 0, 0) : 2 * search->diagonal() * camera.toward;
    std::vector<char> result(count, 0);
    parallel_for(count, [&](std::size_t i) {
        const std::optional<Point> point = place(i);
        if (!point) return;
        const auto pixel = camera.project(*point);
        if (!pixel || !area(*pixel)) return;
        result[i] = search == nullptr || !search->blocked(*point, eye ? *eye : *point + away, ignored(i)) ? 1 : 0;
    });
    return result;
}

}  // namespace

ScreenArea screen_rectangle(const Pixel& one, const Pixel& other) {
    const auto [left, right] = std::minmax(one[0], other[0]);
    const auto [top, bottom] = std::minmax(one[1], other[1]);
    return
        [l = left, r = right, t = top, b = bottom](const Pixel& p) { return l <= p[0] && p[0] <= r && t <= p[1] && p[1] <= b; };
}

ScreenArea screen_polygon(const std::vector<Pixel>& drawn, const std::string& where) {
    std::vector<Pixel> points;
    for (const Pixel& p : drawn)
        if (points.empty() || points.back() != p) points.push_back(p);
    while (points.size() > 1 && points.front() == points.back()) points.pop_back();
    const std::size_t n = points.size();
    if (n < 3) fail_input(where, "the polygon has " + std::to_string(n) + " different points", "draw three points or more");
    const auto next = [&](std::size_t i) -> const Pixel& { return points[(i + 1) % n]; };
    double area = 0;
    for (std::size_t i = 0; i < n; ++i) area += orientation(points[0], points[i], next(i));
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j) {
            const bool neighbours = j == i + 1 || (i == 0 && j == n - 1);
            const Pixel &a = points[i], &b = next(i), &c = points[j], &d = next(j);
            // Neighbouring sides share a corner; they overlap if one runs back along the other.
            const Pixel &shared = j == i + 1 ? b : a, &before = j == i + 1 ? a : b, &after = j == i + 1 ? d : c;
            const bool crossing =
                !neighbours
                    ? meet(a, b, c, d)
                    : n > 3 && orientation(before, shared, after) == 0 &&
                          (before[0] - shared[0]) * (after[0] - shared[0]) + (before[1] - shared[1]) * (after[1] - shared[1]) > 0;
            if (!crossing) continue;
            const Pixel at = neighbours ? shared : meeting_place(a, b, c, d);
            fail_input(where,
                       "the polygon crosses itself: the sides after points " + std::to_string(i) + " and " + std::to_string(j) +
                           " meet at pixel (" + digits(at[0], 6) + ", " + digits(at[1], 6) + ")",
                       "draw a line around the part that does not cross itself");
        }
    if (area == 0) fail_input(where, "the polygon has no area", "draw a line around the part");
    return [points](const Pixel& p) { return inside(points, p); };
}

std::vector<bool> faces_seen(const Mesh& mesh, const PictureCamera& camera, const ScreenArea& area, const SurfaceSearch* search) {
    const auto place = [&](std::size_t i) { return std::optional<Point>(centroid(mesh, Face(static_cast<Index>(i)))); };
    const auto ignored = [](std::size_t i) { return [i](Index face) { return face == i; }; };
    const auto flags = seen(mesh.number_of_faces(), camera, area, search, place, ignored);
    return {flags.begin(), flags.end()};
}

std::vector<Index> vertices_seen(const Mesh& mesh, const PictureCamera& camera, const ScreenArea& area,
                                 const SurfaceSearch* search) {
    const auto place = [&](std::size_t i) {
        const Vertex v(static_cast<Index>(i));
        return mesh.is_isolated(v) ? std::nullopt : std::optional<Point>(mesh.point(v));
    };
    const auto ignored = [&](std::size_t i) {
        return [&mesh, i](Index face) {
            const auto at = corners(mesh, Face(face));
            return std::any_of(at.begin(), at.end(), [i](Vertex v) { return v.idx() == i; });
        };
    };
    const auto flags = seen(mesh.number_of_vertices(), camera, area, search, place, ignored);
    std::vector<Index> result;
    for (std::size_t i = 0; i < flags.size(); ++i)
        if (flags[i] != 0) result.push_back(static_cast<Index>(i));
    return result;
}

std::optional<SurfaceHit> seen_at(const SurfaceSearch& search, const PictureCamera& camera, const Pixel& pixel) {
    const auto ray = camera.ray(pixel[0], pixel[1]);
    const Mesh& mesh = search.mesh();
    const Point& somewhere = mesh.point(mesh.target(mesh.halfedge(*mesh.faces().begin())));
    const double max_distance = std::sqrt(CGAL::squared_distance(ray.origin, somewhere)) + search.diagonal();
    // Parallel rays start in the plane through the centre; the part of the surface in front of that plane counts as well.
    const Point start = camera.distance == 0 ? ray.origin - max_distance * ray.direction : ray.origin;
    for (const SurfaceHit& hit : search.line_hits(start, ray.direction, 2 * max_distance))
        if (hit.distance >= 0) return hit;
    return std::nullopt;
}

bool is_inside(const Mesh& mesh, const Point& point) {
    double sum = 0;
    for (const Face face : mesh.faces()) {
        Halfedge h = mesh.halfedge(face);
        for (int k = 0; k < 3; ++k, h = mesh.next(h))
            if (mesh.is_border(mesh.opposite(h))) return false;
        const auto [a, b, c] = corners(mesh, face);
        // Solid angle of a triangle, Van Oosterom and Strackee 1983.
        const Vector x = mesh.point(a) - point, y = mesh.point(b) - point, z = mesh.point(c) - point;
        const double lx = std::sqrt(x.squared_length()), ly = std::sqrt(y.squared_length()), lz = std::sqrt(z.squared_length());
        sum += 2 * std::atan2(x * CGAL::cross_product(y, z), lx * ly * lz + (x * y) * lz + (y * z) * lx + (z * x) * ly);
    }
    return std::abs(sum) > 2 * pi;
}

}  // namespace ostraka
