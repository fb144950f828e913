// Edits through cages and without, and what constraints make of them.
#include "ostraka/semantic/deform.h"

#include "annotation/example_meshes.h"
#include "ostraka/cage/cage.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/measure/measure.h"
#include "ostraka/select/recipe.h"
#include "ostraka/shapes/make_mesh.h"

#include <gtest/gtest.h>
#include <Eigen/SVD>

#include <iostream>
#include <set>

using namespace ostraka;
using namespace ostraka::example;

namespace {

Json edit(const std::string& steps) {
    return parse_json(R"({"format": "ostraka-edit", "version": 1, "steps": [)" + steps + "]}", "e");
}

/// A made object with the annotations of its recipe, a cage and mean value coordinates.
struct Caged {
    MadeMesh made;
    AnnotationSet set;
    Mesh cage;
    Coordinates coordinates;
    Caged(const std::string& name, std::uint64_t vertices, std::uint64_t cage_vertices)
        : made(make_mesh(made_object(name), {.vertices = vertices})),
          set(apply_recipe(Path(OSTRAKA_SOURCE_DIR) / "data" / (name + ".recipe.json"), made.mesh, made.face_labels)),
          cage(make_cage(made.mesh, {.vertices = cage_vertices}).cage),
          coordinates(compute_coordinates("mean-value", cage, made.mesh)) {}
    [[nodiscard]] HandleSpace handles() const { return {made.mesh, set, &cage, &coordinates}; }
    [[nodiscard]] HandleSpace bare() const { return {made.mesh, set}; }
};

const Caged& teapot() {
    static const Caged object("teapot", 5000, 150);
    return object;
}

Relationship constraint(int id, const std::string& type, std::vector<int> members, const std::string& parameters,
                        double weight = 1) {
    Relationship r;
    r.id = id;
    r.type = type;
    r.annotations = std::move(members);
    r.is_constraint = true;
    r.weight = weight;
    r.constraint = parameters;
    return r;
}

std::string error_of(const HandleSpace& space, const std::string& steps, const RelationGraph& graph = {}) {
    try {
        deform(space, graph, edit(steps), "e.edit.json");
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

double level_spread(const Caged& object, const std::vector<Point>& points, const std::vector<int>& ids) {
    double low = 1e300, high = -1e300;
    for (const int id : ids) {
        double mean = 0;
        const auto vertices = vertices_of(object.made.mesh, *object.set.find(id));
        for (const Index v : vertices) mean += points[v].z() / static_cast<double>(vertices.size());
        low = std::min(low, mean), high = std::max(high, mean);
    }
    return high - low;
}

}  // namespace

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

TEST(Deform, FlowersOnOneLevelKeepTheirShape) {
    // One side of the teapot is lifted by a turn about y: flowers leave their level and are sheared.
    const Caged& object = teapot();
    const std::vector<int> flowers{7, 8, 9, 10, 11};
    const std::string steps = R"({"select": {"all": true}, "stretch": {"direction": [0, 0, 1], "factor": 1.4}},
                                 {"select": {"annotation": "spout", "threshold": 0.15}, "translate": [0, 0, 12]})";
    const double diagonal = box_diagonal(object.made.mesh);
    for (const bool hard : {false, true}) {
        RelationGraph graph;
        graph.relationships.push_back(constraint(0, "same level", flowers, hard ? R"({"hard": true})" : "{}", 50));
        const DeformResult result = deform(object.handles(), graph, edit(steps), "e");
        ASSERT_EQ(result.constraints.size(), 1U);
        EXPECT_TRUE(result.constraints[0].used);
        EXPECT_EQ(result.constraints[0].low_level, 6U);
        std::cout << (hard ? "hard" : "soft") << ": level spread " << level_spread(object, result.edited, flowers) << " -> "
                  << level_spread(object, result.points, flowers) << " of " << diagonal << ", " << result.summary.iterations
                  << " iterations\n";
        EXPECT_LT(level_spread(object, result.points, flowers), (hard ? 1e-3 : 1e-2) * diagonal);
        // Each flower is a rigid copy of what it was.
        for (const int id : flowers) {
            const auto vertices = vertices_of(object.made.mesh, *object.set.find(id));
            const Points rest = [&] {
                Points p(3, static_cast<Eigen::Index>(object.made.mesh.number_of_vertices()));
                for (const Vertex v : object.made.mesh.vertices()) p.col(v.idx()) = eigen(object.made.mesh.point(v));
                return p;
            }();
            Points now = rest;
            for (const Vertex v : object.made.mesh.vertices()) now.col(v.idx()) = eigen(result.points[v]);
            const auto rigid = make_constraint("Rigid", {vertices.begin(), vertices.end()}, 1, {}, rest);
            const double off = std::sqrt(rigid->squared_distance(now) / static_cast<double>(vertices.size()));
            EXPECT_LT(off, (hard ? 1e-3 : 5e-3) * diagonal) << id;
        }
    }
}

TEST(Deform, ThroughTheCageItComesAsNearAsTheCageCan) {
    const Caged& object = teapot();
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "same level", {7, 8, 9, 10, 11}, "{}", 10));
    DeformOptions options;
    options.space = "cage";
    const DeformResult result =
        deform(object.handles(), graph,
               edit(R"({"select": {"annotation": "spout", "threshold": 0.15}, "translate": [0, 0, 12]})"), "e", options);
    EXPECT_TRUE(result.solved);
    EXPECT_EQ(result.cage.size(), object.cage.number_of_vertices());
    // The mesh is what the weights make of the cage.
    const auto again = deformed(object.coordinates, object.cage, result.cage);
    for (std::size_t i = 0; i < again.size(); ++i)
        ASSERT_LT(std::sqrt(CGAL::squared_distance(again[i], result.points[i])), 1e-9 * box_diagonal(object.made.mesh));
    EXPECT_LE(level_spread(object, result.points, {7, 8, 9, 10, 11}),
              level_spread(object, result.edited, {7, 8, 9, 10, 11}) + 1e-9);
}

TEST(Deform, AProportionStretchesThePartFromItsJoint) {
    // The little finger is to be as long as 0.9 to 1 of the ring finger: it grows at its tip and stays where it joins the palm.
    const MadeMesh made = make_mesh(made_object("hand"), {.vertices = 6000});
    AnnotationSet set = apply_recipe(Path(OSTRAKA_SOURCE_DIR) / "data/hand.recipe.json", made.mesh, made.face_labels);
    for (Annotation& annotation : set.annotations) {
        if (annotation.id != 6 && annotation.id != 7) continue;
        Attribute length;
        length.id = 50;
        length.name = "length";
        length.type = AttributeType::measure;
        length.measure.tool = "bounding";
        length.measure.direction = {0, 0, 1};
        const auto ends = extremes(made.mesh, annotation, {0, 0, 1});
        length.measure.points.assign(ends.begin(), ends.end());
        annotation.attributes.push_back(length);
    }
    RelationGraph graph;
    graph.relationships.push_back(constraint(
        0, "proportion", {7, 6}, R"({"measure1": "length", "measure2": 50, "minValue": 0.9, "maxValue": 1, "hard": true})"));
    const DeformResult result = deform({made.mesh, set}, graph, edit(""), "e");
    ASSERT_TRUE(result.acceptable) << result.constraints[0].text;
    EXPECT_EQ(result.constraints[0].before, Verdict::fails);
    const auto height = [&](int id, const std::vector<Point>& points) {
        double low = 1e300, high = -1e300;
        for (const Index v : vertices_of(made.mesh, *set.find(id)))
            low = std::min(low, points[v].z()), high = std::max(high, points[v].z());
        return std::pair{low, high};
    };
    const auto rest = points_of(made.mesh);
    const auto [low, high] = height(7, result.points);
    const auto [was_low, was_high] = height(7, rest);
    const auto [ring_low, ring_high] = height(6, result.points);
    const double ratio = (high - low) / (ring_high - ring_low), diagonal = box_diagonal(made.mesh);
    EXPECT_GE(ratio, 0.9 - 1e-3);
    EXPECT_LE(ratio, 1 + 1e-3);
    EXPECT_GT(high - was_high, 0.02 * diagonal);
    EXPECT_LT(std::abs(low - was_low), 0.002 * diagonal);
    // What is far from the finger stays.
    for (const Index v : vertices_of(made.mesh, *set.find(3)))
        ASSERT_LT(std::sqrt(CGAL::squared_distance(result.points[v], rest[v])), 1e-3 * diagonal);
}

TEST(Deform, ContradictionsAreToldAndLeaveNoHoles) {
    const Caged& object = teapot();
    RelationGraph graph;
    // Upright and level planes at once, through one pair of flowers, both hard.
    graph.relationships.push_back(constraint(0, "keep shape", {5}, R"({"hard": true})"));
    graph.relationships.push_back(constraint(1, "same level", {5, 6}, R"({"hard": true, "direction": [1, 0, 0]})"));
    graph.relationships.push_back(constraint(2, "adjacency", {5, 6}, "{}"));
    DeformOptions options;
    options.rounds = 5;
    const DeformResult result = deform(object.handles(), graph, edit(""), "e", options);
    EXPECT_FALSE(result.acceptable);
    for (const Point& p : result.points) ASSERT_TRUE(std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.z()));
    EXPECT_FALSE(result.constraints[2].used);
    EXPECT_NE(result.constraints[2].text.find("left out"), std::string::npos);
    // Weights all zero: nothing to solve, nothing moves.
    for (auto& r : graph.relationships) r.weight = 0;
    const DeformResult none = deform(object.handles(), graph, edit(""), "e");
    EXPECT_FALSE(none.solved);
    EXPECT_EQ(none.points, none.edited);
}

TEST(Deform, ASupportContinuesItsLegWhileTheArmIsMoved) {
    const Caged object("chair", 8000, 200);
    // The arm is drawn forwards and outwards with what is on it; its support's foot is to stay on the axis of the leg below.
    const std::string steps = R"({"select": {"annotation": "left arm", "threshold": 0.3}, "translate": [0, -25, 0]})";
    double angle_soft = 0;
    for (const bool hard : {false, true}) {
        RelationGraph graph;
        graph.relationships.push_back(
            constraint(0, "structural continuity", {4, 7}, hard ? R"({"hard": true})" : R"({"angle": 20})", 200));
        const DeformResult result = deform(object.handles(), graph, edit(steps), "e");
        const ConstraintReport& report = result.constraints[0];
        ASSERT_TRUE(report.used);
        ASSERT_EQ(report.deviations.size(), 2U);
        std::cout << (hard ? "hard" : "soft") << ": angle " << report.before_values[0] << " -> " << *report.deviations[0].value
                  << ", distance " << report.before_values[1] << " -> " << *report.deviations[1].value << '\n';
        EXPECT_GT(report.before_values[0], 3);
        if (hard) {
            EXPECT_LT(*report.deviations[0].value, 1);
            EXPECT_EQ(report.verdict, Verdict::holds);
        } else {
            angle_soft = *report.deviations[0].value;
            EXPECT_LT(angle_soft, report.before_values[0]);
        }
    }
    // A part that leaves the axis at once has nothing to continue.
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "structural continuity", {3, 7}, R"({"angle": 5})"));
    EXPECT_NE(error_of(object.handles(), steps, graph).find("leaves it by more than"), std::string::npos)
        << error_of(object.handles(), steps, graph);
}

TEST(Deform, SurroundingsAreDistortedLessThanInTheThesis) {
    // The teapot stretched by 1.4; the ring around each flower: faces within 1.6 of its radius. How far a face is stretched
    // against the edited shape, which is what is wanted there: singular values of the map from the edited to the final face.
    const Caged& object = teapot();
    const std::string steps = R"({"select": {"all": true}, "stretch": {"direction": [0, 0, 1], "factor": 1.4}})";
    const std::vector<int> flowers{7, 8, 9, 10, 11};
    const auto distortion = [&](const std::string& details, double closeness) {
        RelationGraph graph;
        graph.relationships.push_back(constraint(0, "same level", flowers, R"({"hard": true})"));
        DeformOptions options;
        options.details = details;
        options.closeness = closeness;
        const DeformResult result = deform(object.handles(), graph, edit(steps), "e", options);
        EXPECT_TRUE(result.acceptable);
        double sum = 0, area = 0;
        for (const int id : flowers) {
            const Annotation& flower = *object.set.find(id);
            const std::set<Index> inside(flower.faces.begin(), flower.faces.end());
            Eigen::Vector3d middle = Eigen::Vector3d::Zero();
            double radius = 0;
            const auto own = vertices_of(object.made.mesh, flower);
            for (const Index v : own) middle += eigen(object.made.mesh.point(Vertex(v))) / static_cast<double>(own.size());
            for (const Index v : own) radius = std::max(radius, (eigen(object.made.mesh.point(Vertex(v))) - middle).norm());
            for (const Face f : object.made.mesh.faces()) {
                if (inside.count(f.idx()) > 0 || (eigen(centroid(object.made.mesh, f)) - middle).norm() > 1.6 * radius) continue;
                const auto [a, b, c] = corners(object.made.mesh, f);
                const auto frame = [&](const std::vector<Point>& p) {
                    const Eigen::Vector3d u = eigen(p[b] - p[a]), v = eigen(p[c] - p[a]), x = u.normalized();
                    Eigen::Matrix2d m;
                    m << u.norm(), x.dot(v), 0, (v - x * x.dot(v)).norm();
                    return m;
                };
                const Eigen::Matrix2d map = frame(result.points) * frame(result.edited).inverse();
                const Eigen::Vector2d s = Eigen::JacobiSVD<Eigen::Matrix2d>(map).singularValues();
                const double weight = face_area(object.made.mesh, f);
                sum += weight * (std::abs(s[0] - 1) + std::abs(s[1] - 1));
                area += weight;
            }
        }
        return sum / area;
    };
    // With a strong hold on each vertex the change is crowded into the rings; with a weak one it spreads.
    const double ours = distortion("edited", DeformOptions().closeness), rest = distortion("rest", DeformOptions().closeness);
    const double crowded = distortion("rest", 0.05);
    std::cout << "mean stretch of the rings: " << ours << ", to the rest shape's displacements " << rest << ", held strongly "
              << crowded << '\n';
    EXPECT_LT(ours, rest);
    EXPECT_LT(rest, crowded);
}
