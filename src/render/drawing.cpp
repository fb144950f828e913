#include "render/drawing.h"

#include "ostraka/execution/parallel.h"
#include "ostraka/geom/chains.h"

#include <algorithm>
#include <unordered_map>

namespace ostraka::detail {

namespace {

struct Side {
    Index from, to;  ///< from < to
    Index triangle;
    friend bool operator<(const Side& a, const Side& b) {
        return std::tie(a.from, a.to, a.triangle) < std::tie(b.from, b.to, b.triangle);
    }
};

/// The sides of all triangles, grouped by edge.
std::vector<Side> sorted_sides(const Surface& surface) {
    std::vector<Side> sides;
    sides.reserve(3 * surface.triangle_count());
    for (Index t = 0; t < surface.triangle_count(); ++t) {
        const auto& corners = surface.corners(t);
        for (std::size_t k = 0; k < 3; ++k) {
            const Index a = corners[k], b = corners[(k + 1) % 3];
            if (a != b) sides.push_back({std::min(a, b), std::max(a, b), t});
        }
    }
    std::sort(sides.begin(), sides.end());
    return sides;
}

template <class Visit>  // called with the range of sides of each edge
void for_each_edge(const std::vector<Side>& sides, Visit visit) {
    for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
        while (end < sides.size() && sides[end].from == sides[begin].from && sides[end].to == sides[begin].to) ++end;
        visit(sides.data() + begin, sides.data() + end);
    }
}

}  // namespace

std::vector<Line> contour_lines(const Surface& surface, const Camera& camera, double crease_cosine, const Rgb& colour,
                                double width) {
    std::vector<Line> lines;
    const std::vector<Side> sides = sorted_sides(surface);
    std::vector<std::array<std::size_t, 2>> segments;
    for_each_edge(sides, [&](const Side* begin, const Side* end) {
        const bool crease = end - begin != 2 ||
                            surface.face_normal(begin[0].triangle).dot(surface.face_normal(begin[1].triangle)) < crease_cosine;
        if (crease) segments.push_back({begin->from, begin->to});
    });
    for (const auto& chain : chains_of(segments)) {
        Line& line = lines.emplace_back(Line{{}, colour, width});
        for (const std::size_t v : chain) line.points.push_back(surface.point(static_cast<Index>(v)));
    }

    // Smooth silhouettes: segments across triangles from side to side, identified by edges.
    std::vector<std::size_t> edge_of_side(3 * surface.triangle_count());
    std::size_t edges = 0;
    for_each_edge(sides, [&](const Side* begin, const Side* end) {
        for (const Side* side = begin; side != end; ++side) {
            const auto& corners = surface.corners(side->triangle);
            for (std::size_t k = 0; k < 3; ++k)
                if (std::minmax(corners[k], corners[(k + 1) % 3]) == std::minmax(side->from, side->to))
                    edge_of_side[3 * side->triangle + k] = edges;
        }
        ++edges;
    });
    struct Crossing {
        Eigen::Vector3d point, sight;
    };
    std::unordered_map<std::size_t, Crossing> crossings;
    segments.clear();
    for (Index t = 0; t < surface.triangle_count(); ++t) {
        const Eigen::Vector3d flat = surface.face_normal(t);
        if (flat.isZero()) continue;
        const auto& corners = surface.corners(t);
        std::array<Eigen::Vector3d, 3> point, normal;
        std::array<double, 3> facing{};
        for (std::size_t k = 0; k < 3; ++k) {
            point[k] = surface.point(corners[k]);
            normal[k] = surface.corner_normal(corners[k], flat.cast<float>(), static_cast<float>(crease_cosine)).cast<double>();
            facing[k] = normal[k].dot(camera.to_viewer(point[k]));
        }
        std::array<std::size_t, 3> crossed{};
        std::size_t count = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            if ((facing[k] < 0) == (facing[next] < 0)) continue;
            const double weight = facing[k] / (facing[k] - facing[next]);
            const Eigen::Vector3d crossing_point = point[k] + weight * (point[next] - point[k]);
            const Eigen::Vector3d outward = ((1 - weight) * normal[k] + weight * normal[next]).normalized();
            // Lifted, because facets bulge beyond the smooth contour by a fraction of their size.
            const double lift = std::max(2e-3, 0.5 * (point[next] - point[k]).norm());
            crossed[count++] = edge_of_side[3 * t + k];
            crossings.try_emplace(crossed[count - 1], Crossing{crossing_point, crossing_point + lift * outward});
        }
        if (count == 2 && crossed[0] != crossed[1]) segments.push_back({crossed[0], crossed[1]});
    }
    for (const auto& chain : chains_of(segments)) {
        Line& line = lines.emplace_back(Line{{}, colour, width});
        for (const std::size_t edge : chain) {
            line.points.push_back(crossings.at(edge).point);
            line.sight.push_back(crossings.at(edge).sight);
        }
    }
    return lines;
}

std::vector<Line> edge_lines(const Surface& surface, const Rgb& colour, double width) {
    std::vector<Line> lines;
    for_each_edge(sorted_sides(surface), [&](const Side* begin, const Side* /*end*/) {
        lines.push_back({{surface.point(begin->from), surface.point(begin->to)}, colour, width});
    });
    return lines;
}

void draw_points(Canvas& canvas, const Surface& surface, const Camera& camera, const std::vector<Rgb>& colours, double radius) {
    const std::vector<Index>& points = surface.used_points();
    std::vector<char> visible(points.size(), 0);
    parallel_for(points.size(), 1024,
                 [&](std::size_t i) { visible[i] = is_visible(surface, camera, surface.point(points[i])) ? 1 : 0; });
    for (std::size_t i = 0; i < points.size(); ++i) {
        Canvas::Place place{};
        if (visible[i] != 0 && camera.project(surface.point(points[i]), place.x, place.y))
            canvas.disc(place, radius, colours[points[i]]);
    }
}

}  // namespace ostraka::detail
