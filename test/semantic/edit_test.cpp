// Edits through cages and without.
#include "caged.h"
#include "ostraka/geom/eigen.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

TEST(Edit, OfAWholeCageIsThatOfTheMesh) {
    const Caged& object = teapot();
    const double diagonal = box_diagonal(object.made.mesh);
    const auto expect = [&](const std::string& operation, auto&& move) {
        const DeformResult result = deform(object.handles(), {}, edit(R"({"select": {"all": true}, )" + operation + "}"), "e");
        for (const Vertex v : object.made.mesh.vertices())
            ASSERT_LT((eigen(result.points[v]) - move(eigen(object.made.mesh.point(v)))).norm(), 1e-9 * diagonal) << operation;
    };
    using V = Eigen::Vector3d;
    expect(R"("translate": [1, 2, 3])", [](const V& p) -> V { return p + V(1, 2, 3); });
    expect(R"("scale": {"factor": 2, "centre": [0, 0, 0]})", [](const V& p) -> V { return 2 * p; });
    expect(R"("rotate": {"axis": [0, 0, 2], "angle": 90, "centre": [0, 0, 0]})", [](const V& p) -> V {
        return {-p.y(), p.x(), p.z()};
    });
    expect(R"("stretch": {"direction": [0, 0, 1], "factor": 1.4, "from": [0, 0, 0]})", [](const V& p) -> V {
        return {p.x(), p.y(), 1.4 * p.z()};
    });
}

TEST(Edit, SelectsByInfluence) {
    const Caged& object = teapot();
    const WeightMatrix& w = object.coordinates.vertex;
    const double rows = influence_threshold(w, "auto-mesh"), columns = influence_threshold(w, "auto-cage");
    EXPECT_EQ(rows, w.rowwise().maxCoeff().minCoeff());
    EXPECT_EQ(columns, w.colwise().maxCoeff().minCoeff());
    for (Index v = 0; v < 50; ++v) EXPECT_FALSE(influential(object.coordinates, {v}, rows).empty());
    std::vector<Index> everything(object.made.mesh.number_of_vertices());
    for (Index v = 0; v < everything.size(); ++v) everything[v] = v;
    EXPECT_EQ(influential(object.coordinates, everything, columns).size(), object.cage.number_of_vertices());
    // A part's own handles move it more than the rest.
    const auto states = follow_edit(edit(R"({"select": {"annotation": "spout", "threshold": 0.2}, "translate": [0, 0, 5]})"),
                                    object.handles(), "e");
    EXPECT_EQ(states.front().selected, influential(object.coordinates, vertices_of(object.made.mesh, *object.set.find(5)), 0.2));
    EXPECT_NE(error_of(object.handles(), R"({"select": {"annotation": "spout", "threshold": 2}, "translate": [0, 0, 5]})")
                  .find("the largest is"),
              std::string::npos);
}

TEST(Edit, StepsFollowEachOther) {
    const Caged& object = teapot();
    const auto states = follow_edit(edit(R"({"select": {"vertices": [3, 4]}, "translate": [1, 0, 0]},
        {"select": {"box": {"min": [-1000, -1000, -1000], "max": [1000, 1000, 1000]}}, "translate": [0, 1, 0]},
        {"select": {"vertices": [3]}, "moveTo": [[7, 8, 9]]})"),
                                    object.bare(), "e");
    ASSERT_EQ(states.size(), 3U);
    const Point p = object.made.mesh.point(Vertex(4));
    EXPECT_EQ(states[0].handles[4], Point(p.x() + 1, p.y(), p.z()));
    EXPECT_EQ(states[1].handles[4], Point(p.x() + 1, p.y() + 1, p.z()));
    EXPECT_EQ(states[2].handles[3], Point(7, 8, 9));
    EXPECT_EQ(std::count(states[0].touched.begin(), states[0].touched.end(), true), 2);
}

TEST(Edit, WhatMakesNoSenseIsRefused) {
    const Caged& object = teapot();
    const auto refused = [&](const std::string& step, const std::string& words) {
        const std::string text = error_of(object.handles(), step);
        EXPECT_NE(text.find(words), std::string::npos) << step << ": " << text;
        EXPECT_TRUE(text.empty() || text.find("/steps/0") != std::string::npos || text.find("e.edit.json") != std::string::npos)
            << text;
    };
    refused(R"({"select": {"annotation": "nose"}, "translate": [0, 0, 1]})", "no annotation tagged 'nose'");
    refused(R"({"select": {"annotation": 99}, "translate": [0, 0, 1]})", "no annotation 99");
    refused(R"({"select": {"cageVertices": [150]}, "translate": [0, 0, 1]})", "is not one of the 150");
    refused(R"({"select": {"box": {"min": [1, 0, 0], "max": [0, 1, 1]}}, "translate": [0, 0, 1]})", "min > max");
    refused(R"({"select": {"box": {"min": [1e5, 0, 0], "max": [2e5, 1, 1]}}, "translate": [0, 0, 1]})", "selects nothing");
    refused(R"({"select": {"all": true}})", "no operation");
    refused(R"({"select": {"all": true}, "translate": [0, 0, 1], "scale": {"factor": 2}})", "more than one operation");
    refused(R"({"select": {"all": true}, "rotate": {"axis": [0, 0, 0], "angle": 3}})", "axis is zero");
    refused(R"({"select": {"all": true}, "stretch": {"direction": [0, 0, 1], "factor": -1}})", "factor");
    refused(R"({"select": {"cageVertices": [1, 2]}, "moveTo": [[0, 0, 0]]})", "1 positions for 2");
    refused(R"({"select": {"all": true, "cageVertices": [1]}, "translate": [0, 0, 1]})", "2 ways");
    EXPECT_NE(error_of(object.bare(), R"({"select": {"cageVertices": [1]}, "translate": [0, 0, 1]})").find("without a cage"),
              std::string::npos);
}
