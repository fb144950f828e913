#include "ostraka/fracture/facet_graph.h"

#include "fracture/facet_sides.h"
#include "ostraka/core/angles.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka {

Walls measure_walls(const Mesh& mesh, const FacetGraph& graph) {
    const SurfaceSearch search(mesh);
    const double diagonal = search.diagonal();
    constexpr int count = 7;
    constexpr double half = 12 * pi / 180;
    const std::size_t n = graph.count();
    Walls walls{std::vector<double>(n, std::numeric_limits<double>::infinity()), std::vector<double>(n, -1),
                std::vector<Index>(n, no_index), 0, 0};
    parallel_for(n, 64, [&](std::size_t p) {
        const Vector& normal = graph.normals[p];
        if (!(normal.squared_length() > 0)) return;
        const Vector axis = -normal;
        const Vector across = std::abs(axis.x()) < 0.6 ? Vector(0, -axis.z(), axis.y()) : Vector(axis.z(), 0, -axis.x());
        const Vector u = across / std::sqrt(across.squared_length()), w = CGAL::cross_product(axis, u);
        const Point& origin = graph.places[p];
        std::vector<double> distances;
        double opposite = 0;
        for (int i = 0; i < count; ++i) {
            // Evenly spread over the cone (Vogel's spiral).
            const double z = 1 - (1 - std::cos(half)) * (i + 0.5) / count, r = std::sqrt(1 - z * z),
                         turn = i * pi * (3 - std::sqrt(5.0));
            const Vector direction = r * std::cos(turn) * u + r * std::sin(turn) * w + z * axis;
            bool has_hit = false;
            for (double range = diagonal / 32; !has_hit; range *= 4) {
                range = std::min(range, 1.01 * diagonal);
                // The query segment extends in both directions: its middle is half way along the ray.
                for (const SurfaceHit& hit : search.line_hits(origin + direction * (range / 2), direction, range / 2)) {
                    const double distance = hit.distance + range / 2;
                    if (graph.patch_of_face[hit.face] == p || distance <= 1e-9 * diagonal ||
                        search.normal(hit.face) * direction <= 0)
                        continue;
                    distances.push_back(distance);
                    if (walls.behind[p] == no_index) walls.behind[p] = graph.patch_of_face[hit.face];
                    opposite -= graph.normals[graph.patch_of_face[hit.face]] * normal;
                    has_hit = true;
                    break;
                }
                if (range > diagonal) break;
            }
        }
        if (2 * distances.size() < count) return;
        walls.opposite[p] = opposite / static_cast<double>(distances.size());
        walls.depth[p] = upper_median(std::move(distances));
    });
    std::vector<std::pair<double, double>> depths;
    for (std::size_t p = 0; p < n; ++p)
        if (walls.opposite[p] > 0.7) depths.emplace_back(walls.depth[p], graph.areas[p]);
    walls.thickness = weighted_median(depths);
    for (const auto& [depth, area] : depths)
        if (depth < 1.5 * walls.thickness && depth > walls.thickness / 1.5) walls.share += area / graph.area;
    return walls;
}

}  // namespace ostraka
