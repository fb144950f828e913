// Seams of a texture stay where they are when a mesh is simplified.
#include "meshes.h"
#include "ostraka/geom/distance.h"
#include "ostraka/remesh/simplify.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

double distance_from_segment(const Point& p, const Point& a, const Point& b) {
    const Vector d = b - a;
    const double share = std::clamp((p - a) * d / d.squared_length(), 0.0, 1.0);
    return std::sqrt(CGAL::squared_distance(p, a + share * d));
}

/// A flat square whose columns of vertices are waves; the middle column is a seam.
TEST(SeamDrift, AWaveStaysWithinTheDistance) {
    constexpr int cells = 60;
    for (const double limit : {0.001, 0.01}) {
        Mesh mesh = build_mesh(test::grid(cells, cells, false, false, [](double u, double v) {
            return std::array<double, 3>{u + 0.03 * std::sin(12 * v), v, 0};
        }));
        const auto is_on_seam = [&](Vertex v) {
            const Point& p = mesh.point(v);
            return std::abs(p.x() - 0.03 * std::sin(12 * p.y()) - 0.5) < 1e-9;
        };
        MarkedParts marked;
        marked.seams.resize(mesh.number_of_edges());
        for (const Edge e : mesh.edges()) marked.seams[e] = is_on_seam(mesh.vertex(e, 0)) && is_on_seam(mesh.vertex(e, 1));
        std::vector<Vertex> seam;
        std::vector<Point> places;
        for (const Vertex v : mesh.vertices())
            if (is_on_seam(v)) seam.push_back(v);
        std::sort(seam.begin(), seam.end(), [&](Vertex a, Vertex b) { return mesh.point(a).y() < mesh.point(b).y(); });
        for (const Vertex v : seam) places.push_back(mesh.point(v));
        ASSERT_EQ(seam.size(), std::size_t{cells + 1});
        const double diagonal = box_diagonal(mesh);
        SimplifyOptions options;
        options.vertices = 60;
        options.seam_drift = limit;
        const SimplifyResult result = simplify(mesh, options, marked);
        EXPECT_LT(mesh.number_of_vertices(), 300U);
        std::vector<Point> after;
        for (const Vertex v : seam)
            if (const Point p = mesh.point(Vertex(result.vertex_map[v])); after.empty() || after.back() != p) after.push_back(p);
        EXPECT_LT(after.size(), seam.size());
        const auto farthest = [](const std::vector<Point>& points, const std::vector<Point>& line) {
            double most = 0;
            for (const Point& p : points) {
                double least = std::numeric_limits<double>::infinity();
                for (std::size_t i = 0; i + 1 < line.size(); ++i)
                    least = std::min(least, distance_from_segment(p, line[i], line[i + 1]));
                most = std::max(most, least);
            }
            return most;
        };
        EXPECT_LE(farthest(places, after), limit * diagonal);
        EXPECT_LE(farthest(after, places), limit * diagonal);
    }
}

}  // namespace
}  // namespace ostraka
