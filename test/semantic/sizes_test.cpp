// Several simultaneous measures of one object, measured on the result.
#include "caged.h"
#include "ostraka/geom/with_points.h"
#include "ostraka/measure/measure.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace ostraka;
using namespace ostraka::test;

namespace {

using Direction = std::array<double, 3>;
constexpr Direction x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

/// A requested measure of a part, relative to its rest value.
struct Asked {
    std::string tag;
    Direction direction;
    double share;
};

/// A synthetic object without a cage, and the extents of its parts.
struct Object {
    SyntheticMesh synthetic;
    AnnotationSet set;
    explicit Object(const std::string& name, std::uint64_t vertices = 4000)
        : synthetic(make_mesh(synthetic_object(name), {.vertices = vertices})),
          set(apply_recipe(Path(OSTRAKA_SOURCE_DIR) / "data" / (name + ".recipe.json"), synthetic.mesh, synthetic.face_labels)) {}
    [[nodiscard]] Annotation& tagged(const std::string& tag) {
        return *std::find_if(set.annotations.begin(), set.annotations.end(),
                             [&](const auto& annotation) { return annotation.tag == tag; });
    }
    [[nodiscard]] std::pair<double, double> span(const std::string& tag, const Direction& d, const std::vector<Point>& points) {
        double low = 1e300, high = -1e300;
        for (const Index v : vertices_of(synthetic.mesh, tagged(tag))) {
            const double at = d[0] * points[v].x() + d[1] * points[v].y() + d[2] * points[v].z();
            low = std::min(low, at), high = std::max(high, at);
        }
        return {low, high};
    }
    [[nodiscard]] double extent(const std::string& tag, const Direction& d, const std::vector<Point>& points) {
        const auto [low, high] = span(tag, d, points);
        return high - low;
    }
    /// Hard constraints for the requested measures.
    [[nodiscard]] RelationGraph ask(const std::vector<Asked>& list) {
        RelationGraph graph;
        for (std::size_t i = 0; i < list.size(); ++i) {
            Measure measure;
            measure.tool = "bounding";
            measure.direction = list[i].direction;
            const auto pins = extremes(synthetic.mesh, tagged(list[i].tag), list[i].direction);
            measure.points.assign(pins.begin(), pins.end());
            const std::string name = "asked " + std::to_string(tagged(list[i].tag).attributes.size());  // another one each time
            add_measure(tagged(list[i].tag), name, measure);
            const std::string wanted =
                std::to_string(list[i].share * extent(list[i].tag, list[i].direction, points_of(synthetic.mesh)));
            graph.relationships.push_back(constraint(
                static_cast<int>(i), "keep measure", {tagged(list[i].tag).id},
                R"({"hard": true, "measure": ")" + name + R"(", "minValue": )" + wanted + R"(, "maxValue": )" + wanted + "}"));
        }
        return graph;
    }
};

}  // namespace

TEST(Sizes, NestedPartsReachTheirMeasures) {
    const std::vector<std::pair<std::string, std::vector<Asked>>> cases{
        {"statuette", {{"cap", z, 0.85}, {"statuette", z, 0.73}, {"base", x, 0.71}}},
        {"statuette", {{"head", z, 0.9}, {"statuette", z, 1.2}, {"drum", z, 1.1}}},
        {"vase", {{"lip", z, 1.3}, {"vase", z, 0.8}, {"foot", x, 0.85}}},
        {"chair", {{"left support", z, 1.15}, {"chair", z, 1.1}, {"seat", x, 1.05}}},
    };
    for (const auto& [name, requests] : cases) {
        Object object(name);
        const RelationGraph graph = object.ask(requests);
        const std::vector<Point> rest = points_of(object.synthetic.mesh);
        const DeformResult result = deform({{object.synthetic.mesh, object.set}}, graph, edit(""), "e");
        for (std::size_t i = 0; i < requests.size(); ++i) {
            EXPECT_NEAR(object.extent(requests[i].tag, requests[i].direction, result.points) /
                            object.extent(requests[i].tag, requests[i].direction, rest),
                        requests[i].share, 1e-3 * requests[i].share)
                << name << ", " << requests[i].tag;
            EXPECT_EQ(result.constraints[i].verdict, Verdict::holds) << result.constraints[i].text;
        }
        EXPECT_TRUE(result.conflicts.empty()) << name;
        EXPECT_EQ(result.surface.folds, 0U) << name;
        EXPECT_EQ(result.surface.crossings_new, 0U) << name;
    }
}

TEST(Sizes, TwoMeasuresOfOnePart) {
    Object object("statuette");
    const std::vector<Asked> requests{{"base", x, 0.8}, {"base", y, 1.1}, {"base", z, 1.2}};
    const DeformResult result = deform({{object.synthetic.mesh, object.set}}, object.ask(requests), edit(""), "e");
    for (const Asked& request : requests)
        EXPECT_NEAR(object.extent(request.tag, request.direction, result.points) /
                        object.extent(request.tag, request.direction, points_of(object.synthetic.mesh)),
                    request.share, 1e-3 * request.share);
    EXPECT_TRUE(result.conflicts.empty());
}

TEST(Sizes, APartCannotBeLongerThanItsContainer) {
    Object object("statuette");
    const std::vector<Point> rest = points_of(object.synthetic.mesh);
    const double all = object.extent("statuette", z, rest), body = object.extent("body", z, rest);
    const RelationGraph graph = object.ask({{"statuette", z, 0.7}, {"body", z, 0.8 * all / body}, {"cap", z, 1.1}});
    const DeformResult result = deform({{object.synthetic.mesh, object.set}}, graph, edit(""), "e");
    EXPECT_FALSE(result.acceptable);
    EXPECT_TRUE(result.constraints[0].verdict == Verdict::fails || result.constraints[1].verdict == Verdict::fails);
    ASSERT_FALSE(result.conflicts.empty());
    for (const ConstraintConflict& conflict : result.conflicts) EXPECT_NE(conflict.id, 2) << "the cap fights with neither";
    // A failing measure is reported with two vertices and their deviation in the result.
    for (std::size_t i = 0; i < 2; ++i) {
        if (result.constraints[i].verdict != Verdict::fails) continue;
        EXPECT_NE(result.constraints[i].text.find("vertices"), std::string::npos) << result.constraints[i].text;
        EXPECT_NE(result.constraints[i].text.find("cannot both be"), std::string::npos) << result.constraints[i].text;
    }
    for (const Point& p : result.points) ASSERT_LT(std::sqrt((p - CGAL::ORIGIN).squared_length()), 10 * all);
}

TEST(Sizes, ASatisfiedMeasureIsNotSolvedFor) {
    Object object("statuette");
    const DeformResult result =
        deform({{object.synthetic.mesh, object.set}}, object.ask({{"cap", z, 1}, {"base", x, 1}}), edit(""), "e");
    EXPECT_TRUE(result.acceptable);
    EXPECT_EQ(result.points, result.edited);
    // A measure that others would violate is solved for.
    const DeformResult pulled =
        deform({{object.synthetic.mesh, object.set}}, object.ask({{"cap", z, 1}, {"statuette", z, 1.2}}), edit(""), "e");
    EXPECT_TRUE(pulled.constraints[0].verdict == Verdict::holds && pulled.constraints[1].verdict == Verdict::holds);
    EXPECT_NEAR(object.extent("cap", z, pulled.points), object.extent("cap", z, points_of(object.synthetic.mesh)), 0.05);
}

TEST(Sizes, PartsThatMovedAreListedForAnEditWithoutSteps) {
    Object object("statuette");
    const double diagonal = box_diagonal(object.synthetic.mesh);
    const std::vector<Point> rest = points_of(object.synthetic.mesh);
    const DeformResult result = deform({{object.synthetic.mesh, object.set}}, object.ask({{"head", z, 1.4}}), edit(""), "e");
    std::size_t listed = 0;
    for (const Annotation& annotation : object.set.annotations) {
        double sum = 0, largest = 0;
        const auto vertices = vertices_of(object.synthetic.mesh, annotation);
        for (const Index v : vertices) {
            const double way = std::sqrt(CGAL::squared_distance(result.points[v], rest[v])) / diagonal;
            sum += way / static_cast<double>(vertices.size()), largest = std::max(largest, way);
        }
        const auto moved_part = std::find_if(result.followed.others.begin(), result.followed.others.end(),
                                             [&](const auto& part) { return part.annotation == annotation.id; });
        EXPECT_EQ(moved_part != result.followed.others.end(), sum > 1e-3 || largest > 5e-3) << annotation.tag;
        if (moved_part == result.followed.others.end()) continue;
        ++listed;
        EXPECT_NEAR(moved_part->share, sum, 1e-9);
        EXPECT_NEAR(moved_part->largest, largest, 1e-9);
    }
    EXPECT_GT(listed, 1U);
}

TEST(Sizes, AMeasureIsMovedToTheNearerEndOfItsRange) {
    for (const double share : {0.7, 1.4}) {
        Object object("vase");
        RelationGraph graph = object.ask({{"lip", z, share}});
        const double rest = object.extent("lip", z, points_of(object.synthetic.mesh));
        Json parameters = parse_json(graph.relationships[0].constraint, "test");
        parameters["minValue"].SetDouble(share < 1 ? 0.5 * rest : share * rest);
        parameters["maxValue"].SetDouble(share < 1 ? share * rest : 2 * rest);
        graph.relationships[0].constraint = to_compact_text(parameters);
        const DeformResult result = deform({{object.synthetic.mesh, object.set}}, graph, edit(""), "e");
        EXPECT_NEAR(object.extent("lip", z, result.points) / rest, share, 2e-4);
    }
}
