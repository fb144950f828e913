// Loops of curves, and leftover parts of outlines.
#include "../../src/transfer/curve_loops.h"

#include "meshes.h"
#include "ostraka/annotation/outline.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/geom/surface_trace.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// A curve over the plane patch of n by n squares of side 1 / n, straight from point to point.
std::vector<SurfacePoint> drawn(const Mesh& mesh, const std::vector<Point>& corners_) {
    const SurfaceSearch search(mesh);
    const auto node = [&](const Point& p) {
        const SurfaceHit hit = search.closest(p);
        return surface_point(mesh, hit.face, hit.barycentric);
    };
    std::vector<SurfacePoint> places{stored_point(mesh, node(corners_.front()))};
    for (std::size_t i = 0; i + 1 < corners_.size(); ++i) {
        const SurfacePoint a = node(corners_[i]), b = node(corners_[i + 1]);
        const auto line = trace_line(mesh, a, b, Vector(0, 0, 1), 100);
        EXPECT_TRUE(line);
        for (std::size_t k = 1; line && k < line->points.size(); ++k) places.push_back(stored_point(mesh, line->points[k]));
    }
    return places;
}

double length(const Mesh& mesh, const std::vector<SurfacePoint>& places) { return curve_through(mesh, places).length(mesh); }

/// A plane, in the unit of the squares.
Mesh plane(Index n) {
    return build_mesh(grid(n, n, false, false, [](double x, double y) { return std::array{x, y, 0.0}; }));
}

}  // namespace

TEST(CurveLoops, ASmallLoopIsDissolvedAtItsCrossing) {
    const Mesh mesh = plane(20);
    const double side = std::sqrt(CGAL::squared_distance(mesh.point(Vertex(0)), mesh.point(Vertex(1))));
    const auto at = [&](double x, double y) { return Point(x * side, y * side, 0); };
    // A path with a loop of half a square's width, and the straight path.
    const auto looped = drawn(mesh, {at(2.1, 5.3), at(9.4, 5.3), at(9.4, 5.9), at(8.7, 5.9), at(8.7, 5.1), at(15.2, 5.1)});
    const auto result = without_small_loops(mesh, looped, side, false);
    EXPECT_EQ(result.front(), looped.front());
    EXPECT_EQ(result.back(), looped.back());
    // From the start to (8.7, 5.3), where it crosses itself, then down and to the end.
    EXPECT_NEAR(length(mesh, result) / side, 8.7 - 2.1 + 0.2 + 15.2 - 8.7, 1e-6);
    // A loop around more than a square stays: relative to an edge of a third of the side it is not small.
    EXPECT_EQ(without_small_loops(mesh, looped, side / 3, false), looped);
}

TEST(CurveLoops, BacktrackingIsRemoved) {
    const Mesh mesh = plane(20);
    const double side = std::sqrt(CGAL::squared_distance(mesh.point(Vertex(0)), mesh.point(Vertex(1))));
    const auto at = [&](double x, double y) { return Point(x * side, y * side, 0); };
    auto straight = drawn(mesh, {at(2.1, 5.3), at(9.4, 5.3)});
    const auto aside = drawn(mesh, {at(9.4, 5.3), at(9.4, 7.8)});
    auto places = straight;
    places.insert(places.end(), aside.begin() + 1, aside.end());
    places.insert(places.end(), aside.rbegin() + 1, aside.rend());
    const auto on = drawn(mesh, {at(9.4, 5.3), at(12.2, 5.3)});
    places.insert(places.end(), on.begin() + 1, on.end());
    straight.insert(straight.end(), on.begin() + 1, on.end());
    EXPECT_EQ(without_small_loops(mesh, places, side, false), straight);
    EXPECT_EQ(without_small_loops(mesh, straight, side, false), straight);
}

TEST(CurveLoops, AClosedCurveStaysClosedWhereverTheLoopIs) {
    const Mesh mesh = plane(20);
    const double side = std::sqrt(CGAL::squared_distance(mesh.point(Vertex(0)), mesh.point(Vertex(1))));
    const auto at = [&](double x, double y) { return Point(x * side, y * side, 0); };
    // A square whose first corner is overshot: the loop holds the start.
    const auto overshot = drawn(mesh, {at(4.7, 4.3), at(4.3, 4.3), at(4.3, 4.6), at(15.2, 4.6), at(15.2, 15.3), at(4.6, 15.3),
                                       at(4.6, 4.4), at(4.7, 4.3)});
    const auto result = without_small_loops(mesh, overshot, side, true);
    EXPECT_EQ(result.front(), result.back());
    EXPECT_NEAR(length(mesh, result) / side, 2 * (15.2 - 4.6) + 2 * (15.3 - 4.6), 1e-6);
    // A curve that starts at a junction with others keeps its start.
    EXPECT_EQ(without_small_loops(mesh, overshot, side, false).front(), overshot.front());
    // A small closed curve alone is not a loop of another curve.
    const auto small = drawn(mesh, {at(4.2, 4.3), at(4.8, 4.3), at(4.5, 4.8), at(4.2, 4.3)});
    const auto cleaned = without_small_loops(mesh, small, side, true);
    EXPECT_EQ(cleaned.front(), cleaned.back());
    EXPECT_NEAR(length(mesh, cleaned), length(mesh, small), 1e-12);
}

TEST(CurveLoops, SmallPartsAndHolesAreRemovedUntilTheNumberOfOutlinesMatches) {
    const Mesh mesh = plane(20);
    const double side = std::sqrt(CGAL::squared_distance(mesh.point(Vertex(0)), mesh.point(Vertex(1))));
    std::vector<bool> disc(mesh.number_of_faces(), false);
    Index hole = no_index, islet = no_index;
    for (const Face f : mesh.faces()) {
        const Point p = centroid(mesh, f);
        const double r = std::hypot(p.x() / side - 10, p.y() / side - 10);
        disc[f] = r < 6;
        if (hole == no_index && r < 2) hole = f;
        if (islet == no_index && r > 8) islet = f;
    }
    std::vector<bool> given = disc;
    given[hole] = false;
    given[islet] = true;
    ASSERT_EQ(extract_outlines(mesh, given).size(), 3U);
    std::vector<bool> selected = given;
    dissolve_small_parts(mesh, side * side, 1, selected);
    EXPECT_EQ(selected, disc);
    selected = given;
    dissolve_small_parts(mesh, side * side, 3, selected);  // the required number
    EXPECT_EQ(selected, given);
    selected = given;
    dissolve_small_parts(mesh, 0.1 * side * side, 1, selected);  // none is small enough
    EXPECT_EQ(selected, given);
}
