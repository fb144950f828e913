// Relations that a deformation preserves, and positions and directions of single parts.
#include "caged.h"
#include "meshes.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/with_points.h"
#include "ostraka/measure/measure.h"
#include "ostraka/select/recipe.h"
#include "ostraka/semantic/measure_constraints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace ostraka;
using namespace ostraka::test;

namespace {

constexpr int foot = 1, shaft = 2, top = 3, left_line = 4, right_line = 5, whole = 6;

/// A closed column of radius 1 about z from 0 to 12: foot below 4, shaft, top above 8; two lines up its sides.
struct Column : AnnotatedMesh {
    Column() {
        constexpr Index around = 24, levels = 37;
        TriangleSoup soup;
        for (Index j = 0; j < levels; ++j)
            for (Index i = 0; i < around; ++i) {
                const double angle = 2 * std::numbers::pi * i / around;
                soup.points.push_back({std::cos(angle), std::sin(angle), 12.0 * j / (levels - 1)});
            }
        for (Index j = 0; j + 1 < levels; ++j)
            for (Index i = 0; i < around; ++i) {
                const Index a = j * around + i, b = j * around + (i + 1) % around;
                soup.triangles.push_back({a, b, b + around});
                soup.triangles.push_back({a, b + around, a + around});
            }
        const Index below = around * levels, above = below + 1;
        soup.points.push_back({0, 0, 0});
        soup.points.push_back({0, 0, 12});
        for (Index i = 0; i < around; ++i) {
            soup.triangles.push_back({below, (i + 1) % around, i});
            const Index last = around * (levels - 1);
            soup.triangles.push_back({above, last + i, last + (i + 1) % around});
        }
        mesh = build_mesh(soup);
        annotations.up = {0, 0, 1};
        annotations.unit = "mm";
        const auto region = [&](int id, const std::string& tag, double low, double high) {
            Annotation annotation;
            annotation.id = id;
            annotation.tag = tag;
            for (const Face f : mesh.faces())
                if (const double z = centroid(mesh, f).z(); z > low && z < high) annotation.faces.push_back(f.idx());
            annotations.annotations.push_back(annotation);
        };
        region(foot, "foot", -1, 4);
        region(shaft, "shaft", 4, 8);
        region(top, "top", 8, 13);
        for (const auto& [id, column] : {std::pair{left_line, Index{0}}, {right_line, around / 2}}) {
            Annotation line;
            line.id = id;
            line.tag = "line";
            line.type = AnnotationType::line;
            line.polylines.emplace_back();
            for (Index j = 12; j <= 24; ++j) line.polylines[0].push_back(j * around + column);
            annotations.annotations.push_back(line);
        }
        region(whole, "column", -1, 13);
    }
    [[nodiscard]] HandleSpace space() const { return {*this}; }
    [[nodiscard]] Eigen::Vector3d mean(int id, const std::vector<Point>& points) const {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        const auto vertices = vertices_of(mesh, *annotations.find(id));
        for (const Index v : vertices) sum += eigen(points[v]);
        return sum / static_cast<double>(vertices.size());
    }
};

DeformResult solved(const Column& column, const Relationship& relationship, const std::string& steps) {
    RelationGraph graph;
    graph.relationships.push_back(relationship);
    DeformOptions options;
    options.followed = 0;
    return deform(column.space(), graph, edit(steps), "e", options);
}

const std::string tilt_top =
    R"({"select": {"annotation": "top"}, "rotate": {"axis": [0, 1, 0], "angle": 40, "centre": [0, 0, 8]}})";

void expect_kept(const Column& column, const Relationship& relationship, const std::string& steps) {
    const DeformResult result = solved(column, relationship, steps);
    const ConstraintReport& report = result.constraints.at(0);
    EXPECT_TRUE(report.used) << relationship.type;
    EXPECT_EQ(report.before, Verdict::fails) << relationship.type;
    EXPECT_EQ(report.verdict, Verdict::holds)
        << relationship.type << ": " << report.text << (report.deviations.empty() ? 0 : *report.deviations[0].value);
    EXPECT_LE(report.cost, report.cost_before) << relationship.type;
    EXPECT_GT(report.cost_before, 0) << relationship.type;
}

/// Parameters of a hard constraint with a leading part.
std::string follows(const std::string& leader) { return R"({"hard": true, "follow": )" + leader + "}"; }

void measure_heights(Column& column) {
    for (const int id : {foot, top}) {
        Attribute height;
        height.id = 1;
        height.name = "height";
        height.value = Measure();
        height.measure()->tool = "bounding";
        height.measure()->direction = {0, 0, 1};
        const auto ends = extremes(column.mesh, *column.annotations.find(id), {0, 0, 1});
        height.measure()->points.assign(ends.begin(), ends.end());
        column.annotations.find(id)->attributes.push_back(height);
    }
}

}  // namespace

TEST(PartsKept, SelectionsDoNotChangeWithTheShape) {
    const Column column;
    for (const auto& relationship :
         {constraint(0, "containment", {whole, top}, "{}"), constraint(0, "equal selections", {whole, top}, "{}")}) {
        const DeformResult result = solved(column, relationship, tilt_top);
        EXPECT_TRUE(result.constraints.at(0).used);
        EXPECT_EQ(result.constraints[0].verdict, relationship.type == "containment" ? Verdict::holds : Verdict::fails)
            << relationship.type;
        EXPECT_EQ(result.constraints[0].low_level, 0U);
    }
}

TEST(PartsKept, ASupportStaysLevel) {
    expect_kept(Column(), constraint(0, "horizontal support", {shaft, top}, "{}", 1000), tilt_top);
}

TEST(PartsKept, ADirectionStaysUpright) {
    expect_kept(Column(), constraint(0, "keep direction", {top}, "{}", 1000), tilt_top);
    expect_kept(Column(), constraint(0, "keep direction", {top}, R"({"angle": 0})", 1000), tilt_top);
    // Without a constraint the top follows the edit: it leans by 40 degrees.
    const Column column;
    const DeformResult result = solved(column, constraint(0, "keep direction", {top}, R"({"angle": 40})", 1000), tilt_top);
    EXPECT_EQ(result.constraints[0].before, Verdict::holds) << *result.constraints[0].deviations[0].value;
}

TEST(PartsKept, APositionStays) {
    const Column column;
    const std::string push = R"({"select": {"annotation": "top"}, "translate": [2, 0, 0]})";
    const auto rest = points_of(column.mesh);
    const DeformResult result = solved(column, constraint(0, "keep position", {shaft}, "{}", 1000), push);
    EXPECT_EQ(result.constraints[0].verdict, Verdict::holds);
    EXPECT_LT((column.mean(shaft, result.points) - column.mean(shaft, rest)).norm(), 0.03);
    const DeformResult moved = solved(column, constraint(0, "keep position", {shaft}, R"({"point": [0, 1, 6]})", 1000), push);
    EXPECT_EQ(moved.constraints[0].verdict, Verdict::holds);
    EXPECT_LT((column.mean(shaft, moved.points) - Eigen::Vector3d(0, 1, 6)).norm(), 0.03);
}

TEST(PartsKept, LinesOfEqualLengthStayEqual) {
    // The column bends: the line inside the bend gets shorter than that outside.
    expect_kept(Column(), constraint(0, "same length", {left_line, right_line}, "{}", 1e4),
                R"({"select": {"annotation": "top"}, "rotate": {"axis": [0, 1, 0], "angle": 60, "centre": [0, 0, 6]}})");
}

TEST(PartsKept, SimilarPartsStaySimilar) {
    const Column column;
    expect_kept(column, constraint(0, "part similarity", {foot, top}, "{}", 1000),
                R"({"select": {"annotation": "top"}, "stretch": {"direction": [0, 0, 1], "factor": 1.5}})");
}

TEST(PartsKept, EqualAttributesAreThoseOfTheRelation) {
    Column column;
    measure_heights(column);
    Relationship equal = constraint(0, "equal attributes", {foot, top}, "{}", 1000);
    equal.parameters.attribute = "height";
    expect_kept(column, equal, R"({"select": {"annotation": "top"}, "stretch": {"direction": [0, 0, 1], "factor": 1.5}})");
    equal.parameters.attribute = "width";
    RelationGraph graph;
    graph.relationships.push_back(equal);
    EXPECT_NE(error_of(column.space(), tilt_top, graph).find("has no measure"), std::string::npos);
}

TEST(PartsThatFollow, GrowAsMuchAsTheEditedPart) {
    const Column column;
    const std::string grow = R"({"select": {"annotation": "top"}, "scale": {"factor": 1.4, "centre": [0, 0, 8]}})";
    const double foot_area = area_of(column.mesh, column.annotations.find(foot)->faces);
    const double top_area = area_of(column.mesh, column.annotations.find(top)->faces);
    for (const char* follow : {"true", R"("top")", "3"}) {
        const DeformResult result = solved(column, constraint(0, "part similarity", {foot, top}, follows(follow)), grow);
        EXPECT_EQ(result.constraints[0].verdict, Verdict::holds);
        const Mesh deformed = with_points(column.mesh, result.points);
        EXPECT_NEAR(area_of(deformed, column.annotations.find(foot)->faces) / foot_area, 1.96, 1e-4) << follow;
        EXPECT_NEAR(area_of(deformed, column.annotations.find(top)->faces) / top_area, 1.96, 1e-4) << follow;
    }
    // Without it all parts change to their mean; if the unedited part leads, nothing grows.
    const Mesh alike =
        with_points(column.mesh, solved(column, constraint(0, "part similarity", {foot, top}, R"({"hard": true})"), grow).points);
    EXPECT_LT(area_of(alike, column.annotations.find(top)->faces) / top_area, 1.7);
    const Mesh led =
        with_points(column.mesh, solved(column, constraint(0, "part similarity", {foot, top}, follows("\"foot\"")), grow).points);
    const double led_foot = area_of(led, column.annotations.find(foot)->faces) / foot_area;
    EXPECT_NEAR(led_foot, 1, 0.002);
    EXPECT_NEAR(area_of(led, column.annotations.find(top)->faces) / top_area, led_foot, 1e-4);
}

TEST(PartsThatFollow, AdoptTheMeasureAndLengthOfTheLeaderAndKeepAProportion) {
    Column column;
    measure_heights(column);
    const std::string stretch = R"({"select": {"annotation": "top"}, "stretch": {"direction": [0, 0, 1], "factor": 1.5}})";
    const auto height = [&](const DeformResult& result, int id) {
        const Mesh deformed = with_points(column.mesh, result.points);
        const auto ends = extremes(deformed, *column.annotations.find(id), {0, 0, 1});
        return std::abs(deformed.point(Vertex(ends[1])).z() - deformed.point(Vertex(ends[0])).z());
    };
    const auto rest = points_of(column.mesh);
    DeformResult still;
    still.points = rest;
    const double top_height = 1.5 * height(still, top);
    // In a proportion the first part changes, unless it is the leader.
    for (const auto& relationship :
         {constraint(0, "same measure", {foot, top}, R"({"measure": "height", "hard": true, "follow": true})"),
          constraint(
              0, "proportion", {top, foot},
              R"({"measure1": "height", "measure2": "height", "minValue": 1, "maxValue": 1, "hard": true, "follow": true})"),
          constraint(
              0, "proportion", {foot, top},
              R"({"measure1": "height", "measure2": "height", "minValue": 1, "maxValue": 1, "hard": true, "follow": true})")}) {
        const DeformResult result = solved(column, relationship, stretch);
        EXPECT_EQ(result.constraints[0].verdict, Verdict::holds) << relationship.type;
        EXPECT_NEAR(height(result, top), top_height, 1e-3) << relationship.type;
        EXPECT_NEAR(height(result, foot), top_height, 0.01) << relationship.type;
    }
    const auto length = [&](const DeformResult& result, int id) {
        double sum = 0;
        const auto& way = column.annotations.find(id)->polylines[0];
        for (std::size_t i = 1; i < way.size(); ++i)
            sum += (eigen(result.points[way[i]]) - eigen(result.points[way[i - 1]])).norm();
        return sum;
    };
    const DeformResult result = solved(column, constraint(0, "same length", {left_line, right_line}, follows("true")),
                                       R"({"select": {"annotation": 4}, "scale": {"factor": 1.1}})");
    EXPECT_NEAR(length(result, left_line), 1.1 * length(still, left_line), 1e-4);
    EXPECT_NEAR(length(result, right_line), 1.1 * length(still, left_line), 0.005);
}

TEST(PartsThatFollow, ReachTheLevelOfTheLeaderAndMirrorIt) {
    Column column;
    const DeformResult level = solved(column, constraint(0, "same level", {left_line, right_line}, follows("true")),
                                      R"({"select": {"annotation": 5}, "translate": [0, 0, 0.5]})");
    EXPECT_NEAR(column.mean(right_line, level.points).z(), 6.5, 1e-4);
    EXPECT_NEAR(column.mean(left_line, level.points).z(), 6.5, 1e-4);
    for (const double side : {-1, 1}) {
        Annotation half;
        half.id = side < 0 ? 7 : 8;
        half.tag = side < 0 ? "left" : "right";
        for (const Index f : column.annotations.find(shaft)->faces)
            if (side * centroid(column.mesh, Face(f)).x() > 0.5) half.faces.push_back(f);
        column.annotations.annotations.push_back(half);
    }
    const DeformResult mirrored = solved(
        column,
        constraint(0, "mirror symmetry", {7, 8}, R"({"direction": [1, 0, 0], "point": [0, 0, 0], "hard": true, "follow": true})"),
        R"({"select": {"annotation": "right"}, "translate": [0.3, 0, 0.2]})");
    const Eigen::Vector3d at_rest = column.mean(8, points_of(column.mesh));
    EXPECT_LT((column.mean(8, mirrored.points) - at_rest - Eigen::Vector3d(0.3, 0, 0.2)).norm(), 1e-4);
    EXPECT_LT((column.mean(7, mirrored.points) - Eigen::Vector3d(-at_rest.x() - 0.3, at_rest.y(), at_rest.z() + 0.2)).norm(),
              1e-3);
}

TEST(PartsThatFollow, ALeaderThatIsNotAMemberIsRefused) {
    const Column column;
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "part similarity", {foot, top}, follows("\"spout\"")));
    EXPECT_NE(error_of(column.space(), tilt_top, graph).find("follow names none of its annotations"), std::string::npos);
}

TEST(PartsKept, InvalidConstraintsAreRefused) {
    const Column column;
    const auto message_of = [&](const Relationship& relationship) {
        RelationGraph graph;
        graph.relationships.push_back(relationship);
        return error_of(column.space(), tilt_top, graph);
    };
    EXPECT_NE(message_of(constraint(0, "horizontal support", {foot, top}, "{}")).find("common outline"), std::string::npos);
    EXPECT_NE(message_of(constraint(0, "same length", {foot, top}, "{}")).find("poly-line"), std::string::npos);
    EXPECT_NE(message_of(constraint(0, "keep direction", {left_line}, "{}")).find("region"), std::string::npos);
    EXPECT_NE(message_of(constraint(0, "keep direction", {top}, R"({"angle": 120})")).find("angle"), std::string::npos);
    EXPECT_NE(message_of(constraint(0, "keep position", {top}, R"({"point": [1, 2]})")).find("three numbers"), std::string::npos);
}

TEST(PartsKept, PositionAndShapeOrDirectionTogether) {
    // Each constraint holds for the original part; neither must move the other halfway.
    const Column column;
    const std::string bend = R"({"select": {"annotation": "shaft"}, "rotate": {"axis": [0, 1, 0], "angle": 8}})";
    const Eigen::Vector3d place = column.mean(top, points_of(column.mesh));
    for (const auto& [other, parameters] :
         {std::pair{"keep shape", R"({"hard": true})"}, {"keep direction", R"({"hard": true, "angle": 0})"}}) {
        RelationGraph graph;
        graph.relationships.push_back(constraint(0, other, {top}, parameters));
        graph.relationships.push_back(constraint(1, "keep position", {top}, R"({"hard": true})"));
        const DeformResult result = deform({column}, graph, edit(bend), "e", DeformOptions(), deform_tolerances());
        for (const ConstraintReport& constraint_report : result.constraints)
            EXPECT_EQ(constraint_report.verdict, Verdict::holds) << constraint_report.type;
        EXPECT_TRUE(result.conflicts.empty()) << other;
        EXPECT_LT((column.mean(top, result.points) - place).norm(), 1e-6) << other;
    }
}

TEST(PartsKept, TheBaseConsistsOfTheCurrentlyLowestVertices) {
    // The parts are tilted, so that the lowest vertices differ from those at rest; these define the level.
    Column column;
    for (const bool hard : {true, false}) {
        RelationGraph graph;
        graph.relationships.push_back(
            constraint(0, "same level", {left_line, right_line},
                       hard ? R"({"reference": "base", "shapes": "free", "hard": true})" : R"({"reference": "base"})", 10));
        const DeformResult result =
            deform({column}, graph, edit(R"({"select": {"all": true}, "rotate": {"axis": [0, 1, 0], "angle": 10}})"), "e",
                   DeformOptions());
        const auto base = [&](int id) {
            const auto vertices = vertices_of(column.mesh, *column.annotations.find(id));
            double low = 1e300, high = -1e300, sum = 0, count = 0;
            for (const Index v : vertices) low = std::min(low, result.points[v].z()), high = std::max(high, result.points[v].z());
            for (const Index v : vertices)
                if (result.points[v].z() <= low + 0.05 * (high - low)) sum += result.points[v].z(), ++count;
            return sum / count;
        };
        const Deviation& deviation = result.constraints[0].deviations.front();
        EXPECT_NEAR(*deviation.value, std::abs(base(left_line) - base(right_line)), 1e-9) << "they are on one level at rest";
        if (hard) {
            EXPECT_EQ(result.constraints[0].verdict, Verdict::holds) << *deviation.value;
        }
    }
}

TEST(PartsKept, OnOneLevelFollowersGrowWithTheirLeader) {
    const Column column;
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "part similarity", {foot, top}, follows("true")));
    graph.relationships.push_back(constraint(1, "same level", {foot, top}, R"({"hard": true})"));
    const DeformResult result =
        deform({column}, graph, edit(R"({"select": {"annotation": "top"}, "scale": {"factor": 1.2, "centre": [0, 0, 8]}})"), "e");
    const Mesh deformed = with_points(column.mesh, result.points);
    for (const int id : {foot, top})
        EXPECT_NEAR(
            area_of(deformed, column.annotations.find(id)->faces) / area_of(column.mesh, column.annotations.find(id)->faces),
            1.44, 1e-3)
            << id;
}

TEST(PartsKept, AreasOfFreePartsAreMeasuredByTheirCurves) {
    // Caps of the same size on a coarse sphere: their nearest triangles differ by far more than the caps.
    const Mesh mesh = build_mesh(octahedron_sphere(3));
    const auto deviation = [&](const std::string& outline) {
        const std::string head = R"(", "type": "region", "outline": ")" + outline + R"(", "select": {"sphere": {"centre": )";
        const std::string text = R"({"format": "ostraka-recipe", "version": 1, "annotations": [{"id": 1, "tag": "a)" + head +
                                 R"([0, 0, 1], "radius": 0.3}}}, {"id": 2, "tag": "b)" + head +
                                 R"([0.36, 0.48, 0.8], "radius": 0.3}}}]})";
        const AnnotationSet set = apply_recipe(parse_json(text, "test"), mesh, {}, "test");
        RelationGraph graph;
        graph.relationships.push_back(constraint(0, "part similarity", {1, 2}, "{}"));
        const ConstraintReport judged = judge_constraints({mesh, set}, graph).at(0);
        EXPECT_FALSE(judged.deviations.empty()) << judged.text;
        for (const Deviation& judged_deviation : judged.deviations)
            if (judged_deviation.quantity == "area") return judged_deviation.value.value();
        return -1.0;
    };
    const double free = deviation("free"), edges = deviation("edges");
    EXPECT_GE(free, 0);
    EXPECT_LT(free, 1);  // of second order in the edges' length
    EXPECT_GT(edges, 2 * free + 1);
}
