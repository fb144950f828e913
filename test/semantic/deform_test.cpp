// Edits through cages and without, and what constraints make of them.
#include "ostraka/semantic/deform.h"

#include "annotation/example_meshes.h"
#include "ostraka/cage/cage.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/measure/measure.h"
#include "ostraka/select/recipe.h"
#include "ostraka/shapes/make_mesh.h"

#include <gtest/gtest.h>
#include <Eigen/SVD>

#include <filesystem>
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

namespace {

Points points_matrix(const std::vector<Point>& list) {
    Points points(3, static_cast<Eigen::Index>(list.size()));
    for (std::size_t i = 0; i < list.size(); ++i) points.col(static_cast<Eigen::Index>(i)) = eigen(list[i]);
    return points;
}

/// A made hand whose ring and little finger have a bounding measure "length", upwards.
struct Hand {
    MadeMesh made = make_mesh(made_object("hand"), {.vertices = 6000});
    AnnotationSet set = apply_recipe(Path(OSTRAKA_SOURCE_DIR) / "data/hand.recipe.json", made.mesh, made.face_labels);
    Hand() {
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
    }
    [[nodiscard]] HandleSpace space() const { return {made.mesh, set}; }
};

}  // namespace

TEST(Deform, AProportionStretchesThePartFromItsJoint) {
    // The little finger is to be as long as 0.9 to 1 of the ring finger: it grows at its tip and stays where it joins the palm.
    const Hand hand;
    const Mesh& mesh = hand.made.mesh;
    const AnnotationSet& set = hand.set;
    RelationGraph graph;
    graph.relationships.push_back(constraint(
        0, "proportion", {7, 6}, R"({"measure1": "length", "measure2": 50, "minValue": 0.9, "maxValue": 1, "hard": true})"));
    const DeformResult result = deform(hand.space(), graph, edit(""), "e");
    ASSERT_TRUE(result.acceptable) << result.constraints[0].text;
    EXPECT_EQ(result.constraints[0].before, Verdict::fails);
    const auto height = [&](int id, const std::vector<Point>& points) {
        double low = 1e300, high = -1e300;
        for (const Index v : vertices_of(mesh, *set.find(id)))
            low = std::min(low, points[v].z()), high = std::max(high, points[v].z());
        return std::pair{low, high};
    };
    const auto rest = points_of(mesh);
    const auto [low, high] = height(7, result.points);
    const auto [was_low, was_high] = height(7, rest);
    const auto [ring_low, ring_high] = height(6, result.points);
    const double ratio = (high - low) / (ring_high - ring_low), diagonal = box_diagonal(mesh);
    EXPECT_GE(ratio, 0.9 - 1e-3);
    EXPECT_LE(ratio, 1 + 1e-3);
    EXPECT_GT(high - was_high, 0.02 * diagonal);
    EXPECT_LT(std::abs(low - was_low), 0.002 * diagonal);
    // What is far from the finger stays.
    for (const Index v : vertices_of(mesh, *set.find(3)))
        ASSERT_LT(std::sqrt(CGAL::squared_distance(result.points[v], rest[v])), 1e-3 * diagonal);
}

TEST(Deform, ContradictionsAreToldAndLeaveNoHoles) {
    const Caged& object = teapot();
    RelationGraph graph;
    // Upright and level planes at once, through one pair of flowers, both hard.
    graph.relationships.push_back(constraint(0, "keep shape", {5}, R"({"hard": true})"));
    graph.relationships.push_back(constraint(1, "same level", {5, 6}, R"({"hard": true, "direction": [1, 0, 0]})"));
    graph.relationships.push_back(constraint(2, "part similarity", {5, 6}, "{}"));
    DeformOptions options;
    options.rounds = 5;
    options.conflicts = 0;
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

namespace {

/// What happens around the flowers, faces within 1.6 of a flower's radius, against the made body stretched upwards by 1.4.
struct RingDistortion {
    double stretch = 0;   ///< mean of |s1 - 1| + |s2 - 1| over the singular values of edited -> final
    double angle = 0;     ///< mean angle between a face without a flower's vertex and the body beside it, degrees
    double distance = 0;  ///< root mean square distance of their vertices from the body
};

/// Value and gradient of the teapot's body, without flowers, stretched: it is round, so that a place between two flowers at the
/// same height tells.
std::pair<double, Eigen::Vector3d> stretched_body(const Eigen::Vector3d& p) {
    const double radius = std::hypot(p.x(), p.y()), free = 72 * M_PI / 180;
    const Point there(radius * std::cos(free), radius * std::sin(free), p.z() / 1.4);
    const Vector g = made_object("teapot").gradient(there);
    const double outwards = g.x() * std::cos(free) + g.y() * std::sin(free);
    const Eigen::Vector3d gradient(outwards * p.x() / radius, outwards * p.y() / radius, g.z() / 1.4);
    return {made_object("teapot").value(there), gradient};
}

RingDistortion distortion_around(const Caged& object, const std::vector<int>& flowers, const DeformResult& result) {
    RingDistortion sum;
    double area = 0, clear = 0;
    for (const int id : flowers) {
        const Annotation& flower = *object.set.find(id);
        const std::set<Index> inside(flower.faces.begin(), flower.faces.end());
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        double radius = 0;
        const auto own = vertices_of(object.made.mesh, flower);
        const std::set<Index> touched(own.begin(), own.end());
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
            sum.stretch += weight * (std::abs(s[0] - 1) + std::abs(s[1] - 1));
            const Eigen::Vector3d p = eigen(result.points[a]), q = eigen(result.points[b]), r = eigen(result.points[c]);
            const Eigen::Vector3d n = (q - p).cross(r - p).normalized();
            const Eigen::Vector3d m = stretched_body((p + q + r) / 3).second;
            area += weight;
            if (touched.count(a) + touched.count(b) + touched.count(c) > 0) continue;
            clear += weight;
            sum.angle += weight * std::atan2(n.cross(m).norm(), n.dot(m)) * 180 / M_PI;
            for (const auto& corner : {p, q, r}) {
                const auto [value, gradient] = stretched_body(corner);
                sum.distance += weight / 3 * std::pow(value / gradient.norm(), 2);
            }
        }
    }
    return {sum.stretch / area, sum.angle / clear, std::sqrt(sum.distance / clear)};
}

}  // namespace

TEST(Deform, APartThatContinuesAnotherAlreadyKeepsItsThickness) {
    const MadeMesh made = make_mesh(made_object("chair"), {.vertices = 8000});
    const AnnotationSet set = apply_recipe(Path(OSTRAKA_SOURCE_DIR) / "data/chair.recipe.json", made.mesh, made.face_labels);
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "structural continuity", {6, 8}, R"({"hard": true})"));
    const DeformResult result =
        deform({made.mesh, set}, graph, edit(R"({"select": {"vertices": [0]}, "translate": [0, 0, 0]})"), "e.edit.json");
    EXPECT_LT(result.constraints.at(0).before_values.at(1), 0.002 * box_diagonal(made.mesh));
    Mesh after = made.mesh;
    for (const Vertex v : after.vertices()) after.point(v) = result.points[v];
    double area = 0, rest = 0;
    for (const Index f : set.find(6)->faces) area += face_area(after, Face(f)), rest += face_area(made.mesh, Face(f));
    EXPECT_NEAR(area, rest, 0.02 * rest);
}

TEST(Deform, SurroundingsAreDistortedLessThanInTheThesis) {
    // The teapot stretched by 1.4 with rigid flowers on one level, to the rest shape's displacements as in the thesis, to those
    // of the edited shape, and with the flowers put back on the stretched body.
    const Caged object("teapot", 20000, 200);
    const std::string steps =
        R"({"select": {"all": true}, "stretch": {"direction": [0, 0, 1], "factor": 1.4, "from": [0, 0, 0]}})";
    const std::vector<int> flowers{7, 8, 9, 10, 11};
    const auto distortion = [&](const std::string& parameters, const std::string& details, double closeness) {
        RelationGraph graph;
        graph.relationships.push_back(constraint(0, "same level", flowers, parameters));
        DeformOptions options;
        options.details = details;
        options.closeness = closeness;
        const DeformResult result = deform(object.handles(), graph, edit(steps), "e", options);
        EXPECT_TRUE(result.acceptable);
        const RingDistortion ring = distortion_around(object, flowers, result);
        std::cout << parameters << ' ' << details << ' ' << closeness << ": stretch " << ring.stretch << ", angle " << ring.angle
                  << " degrees, distance " << ring.distance << '\n';
        return ring;
    };
    const std::string hard = R"({"hard": true})";
    distortion(R"({"shapes": "free"})", "edited", DeformOptions().closeness);
    // With a strong hold on each vertex the change is crowded into the rings; with a weak one it spreads.
    const RingDistortion ours = distortion(hard, "edited", DeformOptions().closeness);
    const RingDistortion rest = distortion(hard, "rest", DeformOptions().closeness), crowded = distortion(hard, "rest", 0.05);
    EXPECT_LT(ours.stretch, rest.stretch);
    EXPECT_LT(rest.stretch, crowded.stretch);
    const RingDistortion seated = distortion(R"({"shapes": "seat"})", "edited", DeformOptions().closeness);
    EXPECT_LT(seated.angle, rest.angle / 2);
    EXPECT_LT(seated.distance, rest.distance / 2);
}

TEST(Deform, SeatedFeaturesAreRigidAndLevelThroughTheCageToo) {
    const Caged& object = teapot();
    const std::vector<int> flowers{7, 8, 9, 10, 11};
    const std::string steps = R"({"select": {"all": true}, "stretch": {"direction": [0, 0, 1], "factor": 1.4}},
                                 {"select": {"annotation": "spout", "threshold": 0.15}, "translate": [0, 0, 12]})";
    const double diagonal = box_diagonal(object.made.mesh);
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "same level", flowers, ""));
    for (const auto& [space, bend] : {std::pair{"mesh", true}, {"cage", true}, {"mesh", false}}) {
        graph.relationships[0].constraint = bend ? R"({"shapes": "seat"})" : R"({"shapes": "seat", "bend": 0})";
        DeformOptions options;
        options.space = space;
        const DeformResult result = deform(object.handles(), graph, edit(steps), "e", options);
        EXPECT_TRUE(result.acceptable);
        EXPECT_LT(*result.constraints[0].deviations[0].value, 1e-9 * diagonal);
        const Points rest = points_matrix(points_of(object.made.mesh)), now = points_matrix(result.points);
        for (const int id : flowers) {
            const auto vertices = vertices_of(object.made.mesh, *object.set.find(id));
            const auto rigid = make_constraint("Rigid", {vertices.begin(), vertices.end()}, 1, {}, rest);
            // It bends by no more than it may.
            EXPECT_LT(std::sqrt(rigid->squared_distance(now) / static_cast<double>(vertices.size())),
                      (bend ? 7.6e-4 : 1e-9) * diagonal)
                << id;
        }
        // Nothing else moves farther than the flowers' size.
        EXPECT_EQ(result.points[object.made.mesh.number_of_vertices() - 1],
                  result.edited[object.made.mesh.number_of_vertices() - 1]);
    }
    // The whole object sits on nothing.
    graph.relationships[0] = constraint(0, "keep shape", {0}, R"({"mode": "seat"})");
    EXPECT_NE(error_of(object.handles(), steps, graph).find("sits on nothing"), std::string::npos);
    // A feature by itself keeps its place.
    graph.relationships[0] = constraint(0, "keep shape", {7}, R"({"mode": "seat", "bend": 0})");
    const DeformResult alone = deform(object.handles(), graph, edit(steps), "e");
    EXPECT_LT(*alone.constraints[0].deviations[0].value, 1e-9 * diagonal);
    // Features that touch cannot be moved one by one.
    graph.relationships[0] = constraint(0, "same level", flowers, R"({"shapes": "seat"})");
    graph.relationships[0].annotations = {1, 5};
    EXPECT_NE(error_of(object.handles(), steps, graph).find("touches another feature"), std::string::npos)
        << error_of(object.handles(), steps, graph);
}

TEST(Deform, TellsWhichConstraintsFight) {
    // The ring finger twice as long as the little finger, and the little finger as long as the ring finger.
    const Hand hand;
    RelationGraph graph;
    graph.relationships.push_back(
        constraint(3, "proportion", {7, 6}, R"({"measure1": "length", "measure2": "length", "minValue": 0.95, "maxValue": 1})"));
    graph.relationships.push_back(
        constraint(4, "proportion", {6, 7}, R"({"measure1": "length", "measure2": "length", "minValue": 2, "maxValue": 3})"));
    graph.relationships.push_back(constraint(5, "keep shape", {3}, "{}"));
    for (auto& r : graph.relationships) r.constraint.insert(1, r.constraint.size() > 2 ? "\"hard\": true, " : "\"hard\": true");
    DeformOptions options;
    options.rounds = 30;
    const DeformResult result = deform(hand.space(), graph, edit(""), "e", options);
    EXPECT_FALSE(result.acceptable);
    std::set<std::pair<int, int>> fights;
    for (const ConstraintConflict& conflict : result.conflicts)
        for (const int freed : conflict.freed) fights.insert({conflict.id, freed});
    for (const auto& [a, b] : fights) {
        EXPECT_NE(a, 5);
        EXPECT_NE(b, 5);
    }
    EXPECT_TRUE(fights.count({3, 4}) == 1 || fights.count({4, 3}) == 1);
    // What cannot hold leaves a compromise, not a wreck.
    for (const Vertex v : hand.made.mesh.vertices())
        ASSERT_LT(std::sqrt(CGAL::squared_distance(result.points[v], result.edited[v])), 0.5 * box_diagonal(hand.made.mesh));
    for (const ConstraintConflict& conflict : result.conflicts) {
        ASSERT_EQ(conflict.deviations.size(), 1U);
        // The ring finger is some 1.3 times as long: either would have to give by tens of per cent.
        EXPECT_GT(*conflict.deviations[0].value, 10) << conflict.id;
        EXPECT_EQ(conflict.deviations[0].unit, "%");
    }
    options.conflicts = 0;
    EXPECT_TRUE(deform(hand.space(), graph, edit(""), "e", options).conflicts.empty());
}

TEST(Deform, AxesFollowTheirReference) {
    // The whole chair is turned: its back leg's axis is elsewhere, and the support goes there, not to where the axis was.
    const Caged object("chair", 8000, 200);
    const std::string steps = R"({"select": {"all": true}, "rotate": {"axis": [1, 0, 0], "angle": 20}},
                                 {"select": {"annotation": "left arm", "threshold": 0.3}, "translate": [0, -15, 0]})";
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "structural continuity", {4, 7}, R"({"hard": true})", 200));
    const DeformResult result = deform(object.handles(), graph, edit(steps), "e");
    ASSERT_EQ(result.constraints[0].deviations.size(), 2U);
    EXPECT_LT(*result.constraints[0].deviations[0].value, 1);
    EXPECT_EQ(result.constraints[0].verdict, Verdict::holds);
    EXPECT_GT(result.passes, 1);
}

TEST(Deform, AxesBecomeParallelAndPerpendicular) {
    const Caged chair("chair", 8000, 200);
    for (const bool parallel : {true, false}) {
        // A leg, or an arm, is bent out of its direction against the leg before it.
        const int moved = parallel ? 9 : 3;
        const std::string bent =
            R"({"select": {"annotation": )" + std::to_string(moved) + R"(}, "rotate": {"axis": [0, 1, 0], "angle": 12}})";
        RelationGraph graph;
        graph.relationships.push_back(
            constraint(0, parallel ? "parallel axes" : "perpendicular axes", {moved, 7}, R"({"hard": true})", 10));
        DeformOptions options;
        options.handles = 0.01;
        options.conflicts = 0;
        const DeformResult result = deform(chair.bare(), graph, edit(bent), "e", options);
        ASSERT_EQ(result.constraints[0].deviations.size(), 1U) << result.constraints[0].text;
        std::cout << result.constraints[0].type << ": " << result.constraints[0].before_values[0] << " -> "
                  << *result.constraints[0].deviations[0].value << " degrees\n";
        EXPECT_LT(*result.constraints[0].deviations[0].value, 2);
        EXPECT_GT(result.constraints[0].before_values[0], 5);
    }
}

TEST(Deform, MeasuresAreKeptAndMadeEqual) {
    const Hand hand;
    const auto length = [&](int id, const std::vector<Point>& points) {
        double low = 1e300, high = -1e300;
        for (const Index v : vertices_of(hand.made.mesh, *hand.set.find(id)))
            low = std::min(low, points[v].z()), high = std::max(high, points[v].z());
        return high - low;
    };
    const auto rest = points_of(hand.made.mesh);
    const double was = length(6, rest);
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "keep measure", {6},
                                             R"({"measure": "length", "hard": true, "minValue": )" + std::to_string(1.2 * was) +
                                                 R"(, "maxValue": )" + std::to_string(1.3 * was) + "}"));
    const DeformResult kept = deform(hand.space(), graph, edit(""), "e");
    EXPECT_TRUE(kept.acceptable) << kept.constraints[0].text;
    EXPECT_NEAR(length(6, kept.points), 1.2 * was, 2e-3 * was);
    // Two fingers that meet half-way, each from its joint.
    graph.relationships[0] = constraint(0, "same measure", {6, 7}, R"({"measure": "length", "hard": true})");
    const DeformResult equal = deform(hand.space(), graph, edit(""), "e");
    EXPECT_TRUE(equal.acceptable);
    EXPECT_GT(equal.constraints[0].before_values[0], 10);
    EXPECT_NEAR(length(6, equal.points), length(7, equal.points), 0.01 * was);
    EXPECT_GT(length(7, equal.points), length(7, rest) * 1.05);
    EXPECT_LT(length(6, equal.points), length(6, rest) * 0.95);
    // Of a tape the line changes.
    Caged tape("hand", 6000, 100);
    Annotation& finger = *tape.set.find(6);
    Attribute attribute;
    attribute.id = 51;
    attribute.name = "way";
    attribute.type = AttributeType::measure;
    attribute.measure.tool = "tape";
    const auto ends = extremes(tape.made.mesh, finger, {0, 0, 1});
    attribute.measure.points.assign(ends.begin(), ends.end());
    finger.attributes.push_back(attribute);
    const double way = evaluate(tape.made.mesh, finger, attribute.measure);
    graph.relationships[0] = constraint(0, "keep measure", {6},
                                        R"({"measure": "way", "hard": true, "minValue": )" + std::to_string(1.1 * way) +
                                            R"(, "maxValue": )" + std::to_string(1.2 * way) + "}");
    const DeformResult longer = deform(tape.bare(), graph, edit(""), "e");
    EXPECT_TRUE(longer.acceptable) << longer.constraints[0].text;
}

TEST(Deform, TheOtherSideFollowsAMirror) {
    // One arm of the chair is moved; the other follows.
    const Caged object("chair", 8000, 200);
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "mirror symmetry", {3, 5}, R"({"hard": true})", 10));
    const std::string arm = R"({"select": {"annotation": 3}, "translate": [0, 0, 20]})";
    const DeformResult result = deform(object.bare(), graph, edit(arm), "e");
    ASSERT_EQ(result.constraints[0].deviations.size(), 1U);
    std::cout << "mirror: " << result.constraints[0].before_values[0] << " -> " << *result.constraints[0].deviations[0].value
              << '\n';
    EXPECT_GT(result.constraints[0].before_values[0], 10);
    EXPECT_TRUE(result.acceptable);
    double moved = 0;
    const auto other = vertices_of(object.made.mesh, *object.set.find(5));
    for (const Index v : other) moved += (result.points[v].z() - result.edited[v].z()) / static_cast<double>(other.size());
    EXPECT_NEAR(moved, 20, 1);
    // A part that mirrors nothing is refused.
    graph.relationships[0].constraint = R"({"direction": [1, 0, 0], "point": [500, 0, 0]})";
    EXPECT_NE(error_of(object.bare(), arm, graph).find("mirror image"), std::string::npos);
}

TEST(Deform, ConstraintsMayBeStatedByTheirOwnNames) {
    const Caged& object = teapot();
    RelationGraph graph;
    const auto solve = [&](const std::string& type, int annotation, const std::string& parameters) {
        graph.relationships = {constraint(0, type, {annotation}, parameters, 100)};
        return deform(object.bare(), graph, edit(""), "e");
    };
    const auto flat = solve("plane", 7, "{}");
    EXPECT_EQ(flat.constraints[0].low_level, 1U);
    EXPECT_LT(*flat.constraints[0].deviations[0].value, flat.constraints[0].before_values[0] / 10);
    const auto faces = object.set.find(7)->faces.size();
    EXPECT_EQ(solve("triangle strain", 7, R"({"minValue": 1, "maxValue": 1})").constraints[0].low_level, faces);
    EXPECT_EQ(solve("laplacian", 7, "{}").constraints[0].low_level, vertices_of(object.made.mesh, *object.set.find(7)).size());
    EXPECT_GT(solve("bending", 7, "{}").constraints[0].low_level, faces);
    const auto tilted = solve("orientation", 7, R"({"direction": [0, 0, 1], "hard": true})");
    double low = 1e300, high = -1e300;
    for (const Index v : vertices_of(object.made.mesh, *object.set.find(7)))
        low = std::min(low, tilted.points[v].z()), high = std::max(high, tilted.points[v].z());
    EXPECT_LT(high - low, 1e-3 * box_diagonal(object.made.mesh));
    const auto refused = [&](const std::string& type, const std::string& parameters, const std::string& words) {
        graph.relationships = {constraint(0, type, {7}, parameters)};
        EXPECT_NE(error_of(object.bare(), "", graph).find(words), std::string::npos) << error_of(object.bare(), "", graph);
    };
    refused("orientation", "{}", "direction");
    refused("plane", R"({"minvalue": 2})", "minvalue");
    refused("plane", R"({"hard": 1})", "neither true nor false");
    refused("rectangle", "{}", "4");
    refused("area", R"({"minValue": 2, "maxValue": 1})", "min");
}

TEST(Deform, PartsThatAreNearStayNear) {
    // Two balls apart by little: pieces of one mesh that no edge joins.
    const double width = 2;
    const Mesh both = spheres(3, {{0, 0, 0}, {1.01 * width, 0, 0}});
    const std::size_t faces = both.number_of_faces() / 2;
    AnnotationSet set;
    for (int k = 0; k < 2; ++k) {
        Annotation ball;
        ball.id = k;
        ball.tag = "ball";
        for (std::size_t f = 0; f < faces; ++f) ball.faces.push_back(static_cast<Index>(f + static_cast<std::size_t>(k) * faces));
        set.annotations.push_back(ball);
    }
    RelationGraph graph;
    graph.relationships = {constraint(0, "keep shape", {1}, R"({"hard": true})"),
                           constraint(1, "adjacency", {0, 1}, R"({"hard": true})")};
    DeformOptions options;
    options.conflicts = 0;
    options.closeness = 1e-6;
    RelationOptions tolerances;
    tolerances.distance = 0.02;
    const double away = 0.2 * width;
    const DeformResult result =
        deform({both, set}, graph, edit(R"({"select": {"annotation": 0}, "translate": [)" + std::to_string(-away) + ", 0, 0]}"),
               "e", options, tolerances);
    EXPECT_GT(result.constraints[1].before_values[0], 0.9 * away);
    EXPECT_LT(*result.constraints[1].deviations[0].value, 0.02 * width) << result.constraints[1].text;
    // Parts of one surface cannot come apart.
    graph.relationships = {constraint(0, "adjacency", {5, 1}, "{}")};
    const DeformResult joined = deform(teapot().bare(), graph, edit(""), "e");
    EXPECT_NE(joined.constraints[0].text.find("common vertices"), std::string::npos);
    EXPECT_TRUE(joined.acceptable);
}

TEST(Deform, AScannedBustKeepsWhatSitsOnIt) {
    const Path file = Path(OSTRAKA_SHARED_DATA) / "heritage-scans" / "Laurana50k.ply";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "there is no " << file;
    const Mesh mesh = read_mesh(file).mesh;
    // Two patches, as large as the diagonal over 15, stand for details on it.
    AnnotationSet set;
    const double diagonal = box_diagonal(mesh);
    Eigen::AlignedBox3d box;
    for (const Vertex v : mesh.vertices()) box.extend(eigen(mesh.point(v)));
    for (int k = 0; k < 2; ++k) {
        const Eigen::Vector3d goal = box.min() + (box.max() - box.min()).cwiseProduct(Eigen::Vector3d(k, 1, 0.45 + 0.1 * k));
        Index seed = 0;
        for (const Vertex v : mesh.vertices())
            if ((eigen(mesh.point(v)) - goal).norm() < (eigen(mesh.point(Vertex(seed))) - goal).norm()) seed = v.idx();
        Annotation patch;
        patch.id = k + 1;
        patch.tag = "patch " + std::to_string(k + 1);
        for (const Face f : mesh.faces())
            if ((eigen(centroid(mesh, f)) - eigen(mesh.point(Vertex(seed)))).norm() < diagonal / 15)
                patch.faces.push_back(f.idx());
        set.annotations.push_back(patch);
    }
    const std::string stretch = R"({"select": {"all": true}, "stretch": {"direction": [0, 0, 1], "factor": 1.3}},
        {"select": {"annotation": 1}, "translate": [0, 0, 15]})";
    for (const std::string parameters : {R"({"shapes": "seat", "direction": [0, 0, 1]})", R"({"direction": [0, 0, 1]})"}) {
        RelationGraph graph;
        graph.relationships.push_back(constraint(0, "same level", {1, 2}, parameters, 1e4));
        DeformOptions options;
        options.handles = 0.01;
        const DeformResult result = deform({mesh, set}, graph, edit(stretch), "e", options);
        EXPECT_TRUE(result.acceptable) << result.constraints[0].text;
        EXPECT_GT(result.constraints[0].before_values[0], 0.01 * diagonal);
        const Points rest = points_matrix(points_of(mesh)), now = points_matrix(result.points);
        ASSERT_TRUE(now.allFinite());
        for (const Annotation& patch : set.annotations) {
            const auto vertices = vertices_of(mesh, patch);
            const auto rigid = make_constraint("Rigid", {vertices.begin(), vertices.end()}, 1, {}, rest);
            EXPECT_LT(std::sqrt(rigid->squared_distance(now) / static_cast<double>(vertices.size())), 1e-3 * diagonal);
        }
    }
}

TEST(Deform, APartBetweenOthersIsMovedOnAllSides) {
    // The palm, with fingers, thumb and wrist around it, is made narrower: all of it, and they follow.
    const Hand hand;
    const double diagonal = box_diagonal(hand.made.mesh);
    const auto area = [&](const std::vector<Point>& points) {
        Mesh mesh = hand.made.mesh;
        for (const Vertex v : mesh.vertices()) mesh.point(v) = points[v];
        double sum = 0;
        for (const Index f : hand.set.find(1)->faces) sum += face_area(mesh, Face(f));
        return sum;
    };
    double width = 0;
    for (const Attribute& attribute : hand.set.find(1)->attributes)
        if (attribute.name == "width") width = evaluate(hand.made.mesh, *hand.set.find(1), attribute.measure);
    ASSERT_GT(width, 0);
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "keep measure", {1},
                                             R"({"measure": "width", "hard": true, "minValue": )" + std::to_string(0.9 * width) +
                                                 R"(, "maxValue": )" + std::to_string(0.92 * width) + "}"));
    const DeformResult result = deform(hand.space(), graph, edit(""), "e");
    EXPECT_TRUE(result.acceptable) << result.constraints[0].text;
    const double share = area(result.points) / area(points_of(hand.made.mesh));
    EXPECT_GT(share, 0.92);
    EXPECT_LT(share, 0.98);
    for (const Vertex v : hand.made.mesh.vertices())
        ASSERT_LT(std::sqrt(CGAL::squared_distance(result.points[v], hand.made.mesh.point(v))), 0.05 * diagonal);
    // As a whole: its height changes like its width.
    graph.relationships[0].constraint.insert(1, R"("mode": "scale", )");
    const DeformResult whole = deform(hand.space(), graph, edit(""), "e");
    EXPECT_TRUE(whole.acceptable);
    EXPECT_NEAR(area(whole.points) / area(points_of(hand.made.mesh)), 0.92 * 0.92, 0.02);
}

TEST(Deform, ThroughACageNothingFliesApart) {
    const Caged object("chair", 8000, 150);
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "structural continuity", {4, 7}, R"({"hard": true})"));
    DeformOptions options;
    options.space = "cage";
    const DeformResult result = deform(
        object.handles(), graph,
        edit(R"({"select": {"annotation": "left arm"}, "stretch": {"direction": [1, 0, 0], "factor": 1.3}})"), "e", options);
    for (const Vertex v : object.made.mesh.vertices())
        ASSERT_LT(std::sqrt(CGAL::squared_distance(result.points[v], result.edited[v])), 0.5 * box_diagonal(object.made.mesh));
}
