#include "facet_evidence.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/parallel.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka {

std::vector<Vector> filtered_normals(const Mesh& mesh, double length) {
    std::vector<Vector> areas(mesh.number_of_faces()), now(areas.size());
    const auto unit = [](const Vector& v) {
        const double squared = v.squared_length();
        return squared > 0 ? v / std::sqrt(squared) : Vector(0, 0, 0);
    };
    parallel_for(areas.size(), [&](std::size_t f) {
        areas[f] = area_vector(mesh, Face(static_cast<Index>(f)));
        now[f] = unit(areas[f]);
    });
    const double edge = mean_edge_length(mesh);
    const int steps = edge > 0 ? static_cast<int>(std::clamp(length / edge * (length / edge), 3.0, 60.0)) : 0;
    std::vector<Vector> next(now.size());
    for (int step = 0; step < steps; ++step) {
        parallel_for(now.size(), [&](std::size_t f) {
            const Face face(static_cast<Index>(f));
            Vector sum = std::sqrt(areas[f].squared_length()) * now[f];
            Halfedge h = mesh.halfedge(face);
            for (int k = 0; k < 3; ++k, h = mesh.next(h)) {
                const Face other = mesh.face(mesh.opposite(h));
                if (other == Mesh::null_face()) continue;
                constexpr double alike = 0.5;  // of unit vectors: 29 degrees
                const double apart = (now[other] - now[f]).squared_length() / (alike * alike);
                sum += std::exp(-apart) * std::sqrt(areas[other].squared_length()) * now[other];
            }
            next[f] = unit(sum);
        });
        std::swap(now, next);
    }
    return now;
}

std::vector<double> turns(const Mesh& mesh, const std::vector<Vector>& normals) {
    std::vector<double> result(mesh.number_of_edges(), 0);
    parallel_for(result.size(), [&](std::size_t e) {
        const Halfedge h = mesh.halfedge(Edge(static_cast<Index>(e)));
        const Face a = mesh.face(h), b = mesh.face(mesh.opposite(h));
        if (a == Mesh::null_face() || b == Mesh::null_face()) return;
        const Vector cross = CGAL::cross_product(normals[a], normals[b]);
        const double angle = std::atan2(std::sqrt(cross.squared_length()), normals[a] * normals[b]);
        const Vector along = mesh.point(mesh.target(h)) - mesh.point(mesh.source(h));
        result[e] = cross * along >= 0 ? angle : -angle;
    });
    return result;
}

Walls walls_under(const Mesh& mesh, const std::vector<Vector>& normals, std::size_t step) {
    const SurfaceSearch search(mesh);
    const double diagonal = search.diagonal();
    constexpr int count = 9;
    constexpr double half = 12 * pi / 180;
    Walls walls{std::vector<double>(normals.size(), std::numeric_limits<double>::infinity()),
                std::vector<double>(normals.size(), -1)};
    parallel_for(
        (normals.size() + step - 1) / step,
        [&](std::size_t k) {
            const std::size_t f = k * step;
            const Vector axis = -normals[f];
            if (!(axis.squared_length() > 0)) return;
            const Vector across = std::abs(axis.x()) < 0.6 ? Vector(0, -axis.z(), axis.y()) : Vector(axis.z(), 0, -axis.x());
            const Vector u = across / std::sqrt(across.squared_length()), w = CGAL::cross_product(axis, u);
            const Point origin = centroid(mesh, Face(static_cast<Index>(f)));
            std::vector<double> ways;
            double opposite = 0;
            for (int i = 0; i < count; ++i) {
                // Evenly over the cone (Vogel's spiral).
                const double z = 1 - (1 - std::cos(half)) * (i + 0.5) / count, r = std::sqrt(1 - z * z),
                             turn = i * pi * (3 - std::sqrt(5.0));
                const Vector direction = r * std::cos(turn) * u + r * std::sin(turn) * w + z * axis;
                bool met = false;
                for (double range = diagonal / 32; !met; range *= 4) {
                    range = std::min(range, 1.01 * diagonal);
                    // The segment of the query runs both ways: its middle stands half way along the ray.
                    for (const SurfaceHit& hit : search.line_hits(origin + direction * (range / 2), direction, range / 2)) {
                        const double way = hit.distance + range / 2;
                        if (hit.face == f || way <= 1e-9 * diagonal || search.normal(hit.face) * direction <= 0) continue;
                        ways.push_back(way);
                        opposite -= normals[hit.face] * normals[f];
                        met = true;
                        break;
                    }
                    if (range > diagonal) break;
                }
            }
            if (2 * ways.size() < count) return;
            walls.opposite[f] = opposite / static_cast<double>(ways.size());
            walls.depth[f] = upper_median(std::move(ways));
        },
        64);
    return walls;
}

}  // namespace ostraka
