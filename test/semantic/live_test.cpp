// Dragging of cage handles under constraints.
#include "caged.h"

#include "ostraka/geom/with_points.h"
#include "ostraka/semantic/live.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace ostraka;
using namespace ostraka::test;

namespace {

double farthest(const std::vector<Point>& a, const std::vector<Point>& b) {
    double far = 0;
    for (std::size_t i = 0; i < a.size(); ++i) far = std::max(far, std::sqrt(CGAL::squared_distance(a[i], b[i])));
    return far;
}

/// The handles of an annotation.
std::vector<Index> handles_of(const Caged& object, int annotation) {
    const std::vector<Index> rows = vertices_of(object.synthetic.mesh, *object.set.find(annotation));
    return influential(object.coordinates, rows, influence_threshold(object.coordinates.vertex, "auto-mesh", rows));
}

std::string numbers(const std::vector<Index>& list) {
    std::string text;
    for (const Index i : list) text += (text.empty() ? "" : ",") + std::to_string(i);
    return text;
}

}  // namespace

TEST(LiveDeformation, WithoutConstraintsIsTheEdit) {
    const Caged& object = teapot();
    const std::vector<Index> handles = handles_of(object, 2);
    LiveDeformation live(object.handles(), {}, edit(""), handles);
    EXPECT_FALSE(live.has_constraints());
    EXPECT_EQ(live.cage(), points_of(object.cage));
    std::vector<Point> places;
    for (const Index h : handles) places.push_back(live.cage()[h] + Vector(1, 2, 3));
    const auto shape = deformed(object.coordinates, object.cage, live.follow(places));
    const auto step = edit(R"({"select": {"cageVertices": [)" + numbers(handles) + R"(]}, "translate": [1, 2, 3]})");
    EXPECT_LT(farthest(shape, deform(object.handles(), {}, step, "e").points), 1e-9 * box_diagonal(object.synthetic.mesh));
}

TEST(LiveDeformation, ConvergesToTheExactSolution) {
    // The knob is lifted; a flower and the spout stay on one level.
    const Caged& object = teapot();
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "same level", {3, 5}, R"({"direction": [0, 0, 1]})", 10));
    const std::vector<Index> handles = handles_of(object, 3);
    DeformOptions options;
    options.space = DeformOptions::Space::cage;
    options.conflicts = 0;
    LiveDeformation live(object.handles(), graph, edit(""), handles, options);
    ASSERT_TRUE(live.has_constraints());
    const double diagonal = box_diagonal(object.synthetic.mesh);
    const Vector way(0.02 * diagonal, 0, 0.05 * diagonal);
    std::vector<Point> start, places;
    for (const Index h : handles) start.push_back(live.cage()[h]);
    std::vector<Point> cage;
    for (int frame = 1; frame <= 60; ++frame) {
        places.clear();
        for (const Point& p : start) places.push_back(p + std::min(1.0, frame / 20.0) * way);
        cage = live.follow(places);
    }
    const auto shape = deformed(object.coordinates, object.cage, cage);
    const auto step = edit(R"({"select": {"cageVertices": [)" + numbers(handles) + R"(]}, "translate": [)" +
                           std::to_string(way.x()) + ",0," + std::to_string(way.z()) + "]}");
    const DeformResult exact = deform(object.handles(), graph, step, "e", options);
    EXPECT_LT(farthest(shape, exact.points), 0.01 * diagonal);
    // It differs from the edit alone.
    EXPECT_GT(farthest(exact.points, exact.edited), 0.01 * diagonal);
}

TEST(LiveDeformation, RefusesInvalidHandlesAndPositions) {
    const Caged& object = teapot();
    EXPECT_THROW(LiveDeformation(object.bare(), {}, edit(""), {0}), Error);
    EXPECT_THROW(LiveDeformation(object.handles(), {}, edit(""), {100000}), Error);
    LiveDeformation live(object.handles(), {}, edit(""), {0, 1});
    EXPECT_THROW(live.follow({Point(0, 0, 0)}), Error);
    EXPECT_THROW(live.follow({Point(0, 0, 0), Point(std::nan(""), 0, 0)}), Error);
    EXPECT_EQ(live.cage(), points_of(object.cage)) << "nothing has moved";
}
