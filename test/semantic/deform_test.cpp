// Effect of constraints on edits.
#include "caged.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/measure/measure.h"

#include <gtest/gtest.h>

#include <iostream>
#include <set>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// A synthetic hand whose ring and little finger have a bounding measure "length", upwards.
struct Hand {
    SyntheticMesh synthetic = make_mesh(synthetic_object("hand"), {.vertices = 6000});
    AnnotationSet set = apply_recipe(Path(OSTRAKA_SOURCE_DIR) / "data/hand.recipe.json", synthetic.mesh, synthetic.face_labels);
    Hand() {
        for (Annotation& annotation : set.annotations) {
            if (annotation.id != 6 && annotation.id != 7) continue;
            Attribute length;
            length.id = 50;
            length.name = "length";
            length.value = Measure();
            length.measure()->tool = "bounding";
            length.measure()->direction = {0, 0, 1};
            const auto ends = extremes(synthetic.mesh, annotation, {0, 0, 1});
            length.measure()->points.assign(ends.begin(), ends.end());
            annotation.attributes.push_back(length);
        }
    }
    [[nodiscard]] HandleSpace space() const { return {{synthetic.mesh, set}}; }
};

}  // namespace

TEST(Deform, AProportionStretchesThePartFromItsJoint) {
    // The length of the little finger must be 0.9 to 1 of that of the ring finger: it grows at its tip, and its joint with the
    // palm stays.
    const Hand hand;
    const Mesh& mesh = hand.synthetic.mesh;
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
    // Distant parts do not move.
    for (const Index v : vertices_of(mesh, *set.find(3)))
        ASSERT_LT(std::sqrt(CGAL::squared_distance(result.points[v], rest[v])), 1e-3 * diagonal);
}

TEST(Deform, ContradictionsAreReportedAndLeaveNoHoles) {
    const Caged& object = teapot();
    RelationGraph graph;
    // Two contradictory hard planes, vertical and horizontal, through one pair of flowers.
    graph.relationships.push_back(constraint(0, "keep shape", {5}, R"({"hard": true})"));
    graph.relationships.push_back(constraint(1, "same level", {5, 6}, R"({"hard": true, "direction": [1, 0, 0]})"));
    graph.relationships.push_back(constraint(2, "of my own", {5, 6}, "{}"));
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
    // The arm is moved forwards and outwards with its parts; the foot of its support must stay on the axis of the leg below.
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
    // A part that leaves the axis immediately has no segment to continue.
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "structural continuity", {3, 7}, R"({"angle": 5})"));
    EXPECT_NE(error_of(object.handles(), steps, graph).find("leaves it by more than"), std::string::npos)
        << error_of(object.handles(), steps, graph);
}

TEST(Deform, APartThatContinuesAnotherAlreadyKeepsItsThickness) {
    const SyntheticMesh synthetic = make_mesh(synthetic_object("chair"), {.vertices = 8000});
    const AnnotationSet set =
        apply_recipe(Path(OSTRAKA_SOURCE_DIR) / "data/chair.recipe.json", synthetic.mesh, synthetic.face_labels);
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "structural continuity", {6, 8}, R"({"hard": true})"));
    const DeformResult result =
        deform({{synthetic.mesh, set}}, graph, edit(R"({"select": {"vertices": [0]}, "translate": [0, 0, 0]})"), "e.edit.json");
    EXPECT_LT(result.constraints.at(0).before_values.at(1), 0.002 * box_diagonal(synthetic.mesh));
    EXPECT_EQ(result.points, result.edited) << "what holds is left alone";
    Mesh after = synthetic.mesh;
    for (const Vertex v : after.vertices()) after.point(v) = result.points[v];
    double area = 0, rest = 0;
    for (const Index f : set.find(6)->faces) area += face_area(after, Face(f)), rest += face_area(synthetic.mesh, Face(f));
    EXPECT_NEAR(area, rest, 0.02 * rest);
}

TEST(Deform, AReferenceIsFixedWhileAPartIsMovedToIt) {
    // A leg cut in halves, the lower one rotated. If it were free, the upper half would lean with it, further in each pass.
    const SyntheticMesh synthetic = make_mesh(synthetic_object("chair"), {.vertices = 8000});
    AnnotationSet set = apply_recipe(Path(OSTRAKA_SOURCE_DIR) / "data/chair.recipe.json", synthetic.mesh, synthetic.face_labels);
    Annotation& leg = *std::find_if(set.annotations.begin(), set.annotations.end(), [](const auto& a) { return a.id == 7; });
    double low = 1e300, high = -1e300;
    for (const Index v : vertices_of(synthetic.mesh, leg)) {
        const double z = synthetic.mesh.point(Vertex(v)).z();
        low = std::min(low, z), high = std::max(high, z);
    }
    Annotation half = leg;
    half.id = 60;
    half.tag = "lower half";
    half.attributes.clear();
    half.faces.clear();
    std::vector<Index> upper;
    for (const Index f : leg.faces) {
        double z = 0;
        for (const Index v : corners(synthetic.mesh, Face(f))) z += synthetic.mesh.point(Vertex(v)).z() / 3;
        (z < (low + high) / 2 ? half.faces : upper).push_back(f);
    }
    leg.faces = upper;
    leg.attributes.clear();
    Eigen::Vector3d joint = Eigen::Vector3d::Zero();
    int shared = 0;
    const auto above = vertices_of(synthetic.mesh, leg);
    for (const Index v : vertices_of(synthetic.mesh, half))
        if (std::find(above.begin(), above.end(), v) != above.end()) joint += eigen(synthetic.mesh.point(Vertex(v))), ++shared;
    joint /= shared;
    set.annotations.push_back(half);
    const std::string steps =
        R"({"select": {"annotation": "lower half"}, "rotate": {"axis": [0, 1, 0], "angle": 8, "centre": [)" +
        std::to_string(joint.x()) + ", " + std::to_string(joint.y()) + ", " + std::to_string(joint.z()) + "]}}";
    for (const int passes : {1, DeformOptions().passes}) {
        RelationGraph graph;
        graph.relationships.push_back(constraint(0, "structural continuity", {60, 7}, R"({"hard": true})"));
        DeformOptions options;
        options.passes = passes;
        const DeformResult result = deform({{synthetic.mesh, set}}, graph, edit(steps), "e", options);
        const ConstraintReport& report = result.constraints.at(0);
        ASSERT_EQ(report.deviations.size(), 2U);
        std::cout << "angle " << report.before_values[0] << " -> " << *report.deviations[0].value << " in " << result.passes
                  << " passes, distance " << *report.deviations[1].value << ", greatest residual " << report.distance << '\n';
        EXPECT_GT(report.before_values[0], 5);
        EXPECT_LT(*report.deviations[0].value, 0.5);
        EXPECT_EQ(result.surface.crossings_new, 0U);
        // The residual is that of the returned shape: the distance that its verdict measures.
        EXPECT_NEAR(report.distance, *report.deviations[1].value, 1e-9 * box_diagonal(synthetic.mesh));
    }
}

TEST(Deform, ResidualsAreThoseOfTheShapeWithItsFeaturesSeated) {
    const Caged& object = teapot();
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "plane", {7}, "{}", 10));
    graph.relationships.push_back(constraint(1, "keep shape", {7}, R"({"mode": "seat"})"));
    const DeformResult result = deform(
        object.handles(), graph, edit(R"({"select": {"all": true}, "stretch": {"direction": [0, 0, 1], "factor": 1.3}})"), "e");
    const ConstraintReport& report = result.constraints.at(0);
    ASSERT_EQ(report.low_level, 1U);
    Eigen::AlignedBox3d box;
    for (const Index v : vertices_of(object.synthetic.mesh, *object.set.find(7)))
        box.extend(eigen(object.synthetic.mesh.point(Vertex(v))));
    EXPECT_GT(*report.deviations.at(0).value, 1e-3);
    EXPECT_NEAR(100 * report.maximum / box.diagonal().norm(), *report.deviations[0].value, 1e-9);
}

TEST(Deform, ReportsConflictingConstraints) {
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
    // Contradictory constraints give a compromise, not a destroyed shape.
    for (const Vertex v : hand.synthetic.mesh.vertices())
        ASSERT_LT(std::sqrt(CGAL::squared_distance(result.points[v], result.edited[v])), 0.5 * box_diagonal(hand.synthetic.mesh));
    for (const ConstraintConflict& conflict : result.conflicts) {
        ASSERT_EQ(conflict.deviations.size(), 1U);
        // The ring finger is about 1.3 times as long: either constraint would have to yield by tens of per cent.
        EXPECT_GT(*conflict.deviations[0].value, 10) << conflict.id;
        EXPECT_EQ(conflict.deviations[0].unit, "%");
    }
    options.conflicts = 0;
    EXPECT_TRUE(deform(hand.space(), graph, edit(""), "e", options).conflicts.empty());
}

TEST(Deform, AxesFollowTheirReference) {
    // The whole chair is rotated: the support moves to the new axis of the back leg, not to the old one.
    const Caged object("chair", 8000, 200);
    const std::string steps = R"({"select": {"all": true}, "rotate": {"axis": [1, 0, 0], "angle": 20}},
                                 {"select": {"annotation": "left arm", "threshold": 0.3}, "translate": [0, -45, 0]})";
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "structural continuity", {4, 7}, R"({"hard": true})", 200));
    const DeformResult result = deform(object.handles(), graph, edit(steps), "e");
    ASSERT_EQ(result.constraints[0].deviations.size(), 2U);
    EXPECT_EQ(result.constraints[0].before, Verdict::fails);
    EXPECT_LT(*result.constraints[0].deviations[0].value, 1);
    EXPECT_EQ(result.constraints[0].verdict, Verdict::holds) << result.constraints[0].text;
    EXPECT_GT(result.passes, 1);
}

TEST(Deform, AxesBecomeParallelAndPerpendicular) {
    const Caged chair("chair", 8000, 200);
    for (const bool parallel : {true, false}) {
        // A leg or an arm is bent relative to the leg in front of it.
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

TEST(Deform, PartsMoveToTheAxisOfAnother) {
    // The synthetic parts: the body is cut open by spout and handle, so that its centroid is off its axis.
    const SyntheticMesh synthetic = make_mesh(synthetic_object("teapot"), {.vertices = 3000});
    AnnotationSet set;
    for (const int id : {0, 1, 2}) {
        Annotation& part = set.annotations.emplace_back();
        part.id = id, part.tag = "part " + std::to_string(id), part.type = AnnotationType::region;
        for (const Face f : synthetic.mesh.faces())
            if (synthetic.face_labels[f.idx()] == id) part.faces.push_back(f.idx());
    }
    RelationGraph graph;
    graph.relationships = {constraint(0, "co-axiality", {2, 0}, R"({"hard": true})"),
                           constraint(1, "co-axiality", {1, 0}, R"({"hard": true})")};
    const DeformResult result =
        deform({{synthetic.mesh, set}}, graph, edit(R"({"select": {"annotation": "part 0"}, "translate": [8, 0, 0]})"), "e");
    for (const ConstraintReport& report : result.constraints) EXPECT_EQ(report.verdict, Verdict::holds) << report.text;
}

TEST(Deform, PartsThatAreNotNamedStay) {
    // Flowers follow one that is raised; a tenth of the diagonal away from all of them hardly anything moves.
    const Caged pot("teapot", 3000, 100);
    const Mesh& mesh = pot.synthetic.mesh;
    RelationGraph graph;
    graph.relationships = {
        constraint(0, "same level", {7, 8, 9, 10, 11}, R"({"follow": true, "heights": "equal", "hard": true})")};
    const DeformResult result =
        deform(pot.bare(), graph, edit(R"({"select": {"annotation": "flower 1"}, "translate": [0, 0, 4]})"), "e");
    EXPECT_TRUE(result.acceptable);
    const double diagonal = box_diagonal(mesh);
    std::vector<Point> flowers;
    for (const int id : graph.relationships[0].annotations)
        for (const Index v : vertices_of(mesh, *pot.set.find(id))) flowers.push_back(mesh.point(Vertex(v)));
    double farthest = 0;
    std::size_t count = 0;
    for (const Vertex v : mesh.vertices()) {
        const Point& p = mesh.point(v);
        if (std::any_of(flowers.begin(), flowers.end(),
                        [&](const Point& q) { return CGAL::squared_distance(p, q) < 0.01 * diagonal * diagonal; }))
            continue;
        ++count;
        farthest = std::max(farthest, std::sqrt(CGAL::squared_distance(result.points[v.idx()], result.edited[v.idx()])));
    }
    EXPECT_GT(count, mesh.number_of_vertices() / 4);
    EXPECT_LT(farthest, 0.003 * diagonal) << 100 * farthest / diagonal << " %";
}

TEST(Deform, MeasuresAreKeptAndEqualised) {
    const Hand hand;
    const auto length = [&](int id, const std::vector<Point>& points) {
        double low = 1e300, high = -1e300;
        for (const Index v : vertices_of(hand.synthetic.mesh, *hand.set.find(id)))
            low = std::min(low, points[v].z()), high = std::max(high, points[v].z());
        return high - low;
    };
    const auto rest = points_of(hand.synthetic.mesh);
    const double was = length(6, rest);
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "keep measure", {6},
                                             R"({"measure": "length", "hard": true, "minValue": )" + std::to_string(1.2 * was) +
                                                 R"(, "maxValue": )" + std::to_string(1.3 * was) + "}"));
    const DeformResult result = deform(hand.space(), graph, edit(""), "e");
    EXPECT_TRUE(result.acceptable) << result.constraints[0].text;
    EXPECT_NEAR(length(6, result.points), 1.2 * was, 2e-3 * was);
    // Two fingers that change to their mean, each from its joint.
    graph.relationships[0] = constraint(0, "same measure", {6, 7}, R"({"measure": "length", "hard": true})");
    const DeformResult equal = deform(hand.space(), graph, edit(""), "e");
    EXPECT_TRUE(equal.acceptable);
    EXPECT_GT(equal.constraints[0].before_values[0], 10);
    EXPECT_NEAR(length(6, equal.points), length(7, equal.points), 0.01 * was);
    EXPECT_GT(length(7, equal.points), length(7, rest) * 1.05);
    EXPECT_LT(length(6, equal.points), length(6, rest) * 0.95);
    // Another measure excludes the nearer end of the range, but not the whole range.
    const auto range = [&](double from, double to) {
        return R"(, "hard": true, "minValue": )" + std::to_string(from) + R"(, "maxValue": )" + std::to_string(to) + "}";
    };
    const double ratio = was / length(7, rest);
    graph.relationships = {
        constraint(0, "keep measure", {6}, R"({"measure": "length")" + range(1.2 * was, 1.2 * was)),
        constraint(1, "proportion", {6, 7}, R"({"measure1": "length", "measure2": "length")" + range(1.12 * ratio, 1.3 * ratio))};
    const DeformResult within = deform(hand.space(), graph, edit(""), "e");
    EXPECT_TRUE(within.conflicts.empty());
    for (const ConstraintReport& constraint_report : within.constraints)
        EXPECT_EQ(constraint_report.verdict, Verdict::holds) << constraint_report.text;
    EXPECT_NEAR(length(6, within.points), 1.2 * was, 2e-3 * was);
    graph.relationships.pop_back();
    // For a tape, the line changes.
    Caged tape("hand", 6000, 100);
    Annotation& finger = *tape.set.find(6);
    Attribute attribute;
    attribute.id = 51;
    attribute.name = "way";
    attribute.value = Measure();
    attribute.measure()->tool = "tape";
    const auto ends = extremes(tape.synthetic.mesh, finger, {0, 0, 1});
    attribute.measure()->points.assign(ends.begin(), ends.end());
    finger.attributes.push_back(attribute);
    const double way = evaluate(tape.synthetic.mesh, finger, *attribute.measure());
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
    const auto other = vertices_of(object.synthetic.mesh, *object.set.find(5));
    for (const Index v : other) moved += (result.points[v].z() - result.edited[v].z()) / static_cast<double>(other.size());
    EXPECT_NEAR(moved, 20, 1);
    // A part without a mirror image is refused.
    graph.relationships[0].constraint = R"({"direction": [1, 0, 0], "point": [500, 0, 0]})";
    EXPECT_NE(error_of(object.bare(), arm, graph).find("mirror image"), std::string::npos);
}

TEST(Deform, ConstraintsOfTheSolverCanBeUsedByName) {
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
    EXPECT_EQ(solve("laplacian", 7, "{}").constraints[0].low_level,
              vertices_of(object.synthetic.mesh, *object.set.find(7)).size());
    EXPECT_GT(solve("bending", 7, "{}").constraints[0].low_level, faces);
    const auto tilted = solve("orientation", 7, R"({"direction": [0, 0, 1], "hard": true})");
    double low = 1e300, high = -1e300;
    for (const Index v : vertices_of(object.synthetic.mesh, *object.set.find(7)))
        low = std::min(low, tilted.points[v].z()), high = std::max(high, tilted.points[v].z());
    EXPECT_LT(high - low, 1e-3 * box_diagonal(object.synthetic.mesh));
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

TEST(Deform, AdjacentPartsStayAdjacent) {
    // Two balls with a small gap: separate components of one mesh.
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
    options.spread = 10;
    RelationOptions tolerances;
    tolerances.distance = 0.02;
    const double away = 0.2 * width;
    const DeformResult result =
        deform({{both, set}}, graph, edit(R"({"select": {"annotation": 0}, "translate": [)" + std::to_string(-away) + ", 0, 0]}"),
               "e", options, tolerances);
    EXPECT_GT(result.constraints[1].before_values[0], 0.9 * away);
    EXPECT_LT(*result.constraints[1].deviations[0].value, 0.02 * width) << result.constraints[1].text;
    // Parts of one surface cannot come apart.
    graph.relationships = {constraint(0, "adjacency", {5, 1}, "{}")};
    const DeformResult joined = deform(teapot().bare(), graph, edit(""), "e");
    EXPECT_NE(joined.constraints[0].text.find("common vertices"), std::string::npos);
    EXPECT_TRUE(joined.acceptable);
}

TEST(Deform, APartBetweenOthersIsMovedOnAllSides) {
    // The palm, with fingers, thumb and wrist around it, is made narrower, and they follow.
    const Hand hand;
    const double diagonal = box_diagonal(hand.synthetic.mesh);
    const auto area = [&](const std::vector<Point>& points) {
        Mesh mesh = hand.synthetic.mesh;
        for (const Vertex v : mesh.vertices()) mesh.point(v) = points[v];
        double sum = 0;
        for (const Index f : hand.set.find(1)->faces) sum += face_area(mesh, Face(f));
        return sum;
    };
    double width = 0;
    for (const Attribute& attribute : hand.set.find(1)->attributes)
        if (attribute.name == "width") width = evaluate(hand.synthetic.mesh, *hand.set.find(1), *attribute.measure());
    ASSERT_GT(width, 0);
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "keep measure", {1},
                                             R"({"measure": "width", "hard": true, "minValue": )" + std::to_string(0.9 * width) +
                                                 R"(, "maxValue": )" + std::to_string(0.92 * width) + "}"));
    const DeformResult result = deform(hand.space(), graph, edit(""), "e");
    EXPECT_TRUE(result.acceptable) << result.constraints[0].text;
    const double share = area(result.points) / area(points_of(hand.synthetic.mesh));
    EXPECT_GT(share, 0.92);
    EXPECT_LT(share, 0.98);
    for (const Vertex v : hand.synthetic.mesh.vertices())
        ASSERT_LT(std::sqrt(CGAL::squared_distance(result.points[v], hand.synthetic.mesh.point(v))), 0.05 * diagonal);
    // Scaled as a whole: its height changes like its width.
    graph.relationships[0].constraint.insert(1, R"("mode": "scale", )");
    const DeformResult whole = deform(hand.space(), graph, edit(""), "e");
    EXPECT_TRUE(whole.acceptable);
    EXPECT_NEAR(area(whole.points) / area(points_of(hand.synthetic.mesh)), 0.92 * 0.92, 0.02);
}

TEST(Deform, ThroughACagePartsStayConnected) {
    const Caged object("chair", 8000, 150);
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "structural continuity", {4, 7}, R"({"hard": true})"));
    DeformOptions options;
    options.space = DeformOptions::Space::cage;
    const DeformResult result = deform(
        object.handles(), graph,
        edit(R"({"select": {"annotation": "left arm"}, "stretch": {"direction": [1, 0, 0], "factor": 1.3}})"), "e", options);
    for (const Vertex v : object.synthetic.mesh.vertices())
        ASSERT_LT(std::sqrt(CGAL::squared_distance(result.points[v], result.edited[v])),
                  0.5 * box_diagonal(object.synthetic.mesh));
}
