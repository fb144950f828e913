// The report of a deformation agrees with its result.
#include "caged.h"
#include "io/soups.h"
#include "ostraka/geom/with_points.h"
#include "ostraka/measure/measure.h"
#include "ostraka/semantic/edit_words.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// A synthetic object with the annotations of its recipe.
struct Annotated {
    SyntheticMesh synthetic;
    AnnotationSet set;
    explicit Annotated(const std::string& name, std::uint64_t vertices = 6000)
        : synthetic(make_mesh(synthetic_object(name), {.vertices = vertices})),
          set(apply_recipe(Path(OSTRAKA_SOURCE_DIR) / "data" / (name + ".recipe.json"), synthetic.mesh, synthetic.face_labels)) {}
    [[nodiscard]] HandleSpace space() const { return {{synthetic.mesh, set}}; }
    [[nodiscard]] Annotation& tagged(const std::string& tag) {
        return *std::find_if(set.annotations.begin(), set.annotations.end(),
                             [&](const auto& annotation) { return annotation.tag == tag; });
    }
    void take(const std::string& tag, const std::string& name, const std::array<double, 3>& direction) {
        Measure measure;
        measure.tool = "bounding";
        measure.direction = direction;
        const auto pins = extremes(synthetic.mesh, tagged(tag), direction);
        measure.points.assign(pins.begin(), pins.end());
        add_measure(tagged(tag), name, measure);
    }
};

double extent(const Mesh& mesh, const Annotation& part, const Vector& along) {
    double low = 1e300, high = -1e300;
    for (const Index v : vertices_of(mesh, part)) {
        const double height = (mesh.point(Vertex(v)) - CGAL::ORIGIN) * along;
        low = std::min(low, height), high = std::max(high, height);
    }
    return high - low;
}

std::string translated(const std::string& tag, double x, double y, double z) {
    return R"({"select": {"annotation": ")" + tag + R"("}, "translate": [)" + std::to_string(x) + ", " + std::to_string(y) +
           ", " + std::to_string(z) + "]}";
}

bool objects(const DeformResult& result, const std::string& to) {
    return std::any_of(result.objections.begin(), result.objections.end(),
                       [&](const std::string& text) { return text.find(to) != std::string::npos; });
}

}  // namespace

TEST(DeformVerdict, AnEditThatIsUndoneIsNotAcceptable) {
    Annotated hand("hand");
    const double far = 0.05 * box_diagonal(hand.synthetic.mesh);
    RelationGraph graph;
    graph.relationships = {constraint(0, "closeness", {hand.tagged("little finger").id}, R"({"hard": true})")};
    const DeformResult result = deform(hand.space(), graph, edit(translated("little finger", 0, 0, far)), "e");
    EXPECT_LT(result.followed.share, 0.5);
    EXPECT_GT(result.followed.largest, 0.5 * far);
    EXPECT_FALSE(result.acceptable);
    EXPECT_TRUE(objects(result, "the result follows the edit by"));
    DeformOptions content;
    content.followed = 0;
    EXPECT_FALSE(objects(deform(hand.space(), graph, edit(translated("little finger", 0, 0, far)), "e", content), "follows"));
}

TEST(DeformVerdict, WithoutConstraintsAnEditIsFollowedAndItsSurroundingsFollow) {
    Annotated hand("hand");
    const double far = 0.03 * box_diagonal(hand.synthetic.mesh);
    const DeformResult result = deform(hand.space(), {}, edit(translated("ring finger", 0, 0, far)), "e");
    EXPECT_TRUE(result.acceptable);
    EXPECT_EQ(result.followed.share, 1);
    EXPECT_EQ(result.followed.vertices, vertices_of(hand.synthetic.mesh, hand.tagged("ring finger")).size());
    const Mesh now = with_points(hand.synthetic.mesh, result.points);
    for (const Index v : vertices_of(now, hand.tagged("ring finger")))
        ASSERT_NEAR(now.point(Vertex(v)).z(), hand.synthetic.mesh.point(Vertex(v)).z() + far, 1e-6);
    // No edge is stretched by more than a factor of three.
    const auto length = [](const Mesh& mesh, Halfedge h) {
        return std::sqrt(CGAL::squared_distance(mesh.point(mesh.source(h)), mesh.point(mesh.target(h))));
    };
    for (const Edge e : now.edges()) ASSERT_LT(length(now, now.halfedge(e)), 3 * length(hand.synthetic.mesh, now.halfedge(e)));
}

TEST(DeformVerdict, NewCrossingsAreNotAcceptable) {
    // Two intersecting spheres are moved apart until they intersect in a smaller circle: fewer pairs, and different ones.
    const Mesh mesh = build_mesh(soups::both(soups::sphere(16, 32), soups::sphere(16, 32, 0.8, {0.9, 0, 0})));
    const auto half = static_cast<Index>(soups::sphere(16, 32).points.size());
    std::string vertices;
    for (Index v = half; v < mesh.number_of_vertices(); ++v) vertices += (vertices.empty() ? "" : ", ") + std::to_string(v);
    const AnnotationSet none;
    const DeformResult result =
        deform({{mesh, none}}, {}, edit(R"({"select": {"vertices": [)" + vertices + R"(]}, "translate": [0.6, 0, 0]})"), "e");
    EXPECT_GT(result.surface.crossings, 0U);
    EXPECT_LT(result.surface.crossings, result.surface.crossings_before);
    EXPECT_GT(result.surface.crossings_new, 0U);
    EXPECT_FALSE(result.acceptable);
}

TEST(DeformVerdict, CrossingsAreNotAcceptable) {
    Annotated hand("hand");
    const Annotation &ring = hand.tagged("ring finger"), &middle = hand.tagged("middle finger");
    const auto centre = [&](const Annotation& part) {
        Vector sum(0, 0, 0);
        for (const Index v : vertices_of(hand.synthetic.mesh, part)) sum += hand.synthetic.mesh.point(Vertex(v)) - CGAL::ORIGIN;
        return sum / static_cast<double>(vertices_of(hand.synthetic.mesh, part).size());
    };
    const Vector way = (centre(middle) - centre(ring)) * 0.7;
    const DeformResult result = deform(hand.space(), {}, edit(translated("ring finger", way.x(), way.y(), way.z())), "e");
    EXPECT_GT(result.surface.crossings, 0U);
    EXPECT_EQ(result.surface.crossings_before, 0U);
    EXPECT_FALSE(result.acceptable);
    EXPECT_TRUE(objects(result, "cross"));
}

TEST(DeformVerdict, AnExtentIsMeasuredOnTheResult) {
    // The finger is rotated, so that other vertices are outermost than at rest.
    Annotated hand("hand");
    hand.take("little finger", "reach", {0, 0, 1});
    const Annotation& finger = hand.tagged("little finger");
    const double at_rest = extent(hand.synthetic.mesh, finger, {0, 0, 1});
    RelationGraph graph;
    graph.relationships = {constraint(0, "keep measure", {finger.id}, R"({"measure": "reach"})", 200)};
    DeformOptions options;
    options.followed = 0;
    const DeformResult result =
        deform(hand.space(), graph,
               edit(R"({"select": {"annotation": "little finger"}, "rotate": {"axis": [1, 0, 0], "angle": 25}})"), "e", options);
    const Mesh now = with_points(hand.synthetic.mesh, result.points);
    const double measured = extent(now, finger, {0, 0, 1});
    const double off = 100 * std::abs(measured - at_rest) / at_rest;
    EXPECT_NEAR(*result.constraints[0].deviations[0].value, off, 1e-6);
    EXPECT_LT(off, result.constraints[0].before_values[0]);
    // As in the annotations of the result, with their pins at the new positions.
    AnnotationSet set = hand.set;
    move_extents({hand.synthetic.mesh, hand.set}, now, set);
    refresh_measures(now, set);
    for (const Attribute& attribute : set.find(finger.id)->attributes)
        if (attribute.name == "reach") {
            EXPECT_NEAR(*attribute.measure()->value, measured, 1e-9 * measured);
        }
}

TEST(DeformVerdict, LevelsStayAsAtRest) {
    // Feet whose heights differ by 0.3 % of the diagonal keep this difference, regardless of the back.
    Annotated chair("chair");
    const double diagonal = box_diagonal(chair.synthetic.mesh);
    for (const Index v : vertices_of(chair.synthetic.mesh, chair.tagged("front left leg"))) {
        Point& p = chair.synthetic.mesh.point(Vertex(v));
        p = p + Vector(0, 0, -0.003 * diagonal);
    }
    EditWords words;
    words.stretch = {"back=1.2"};
    words.level = {"legs"};
    RelationGraph graph;
    add_constraints(words, chair.set, graph);
    ASSERT_EQ(graph.relationships.size(), 1U);
    EXPECT_EQ(graph.relationships[0].annotations.size(), 4U);
    const DeformResult result = deform(chair.space(), graph, parse_edit(words, chair.set), "e");
    EXPECT_TRUE(result.acceptable) << (result.objections.empty() ? "" : result.objections.front());
    const Mesh now = with_points(chair.synthetic.mesh, result.points);
    for (const char* leg : {"front left leg", "rear right leg"})
        for (const Index v : vertices_of(now, chair.tagged(leg)))
            ASSERT_NEAR(now.point(Vertex(v)).z(), chair.synthetic.mesh.point(Vertex(v)).z(), 5e-3 * diagonal);
    EXPECT_NEAR(extent(now, chair.tagged("back"), {0, 0, 1}) / extent(chair.synthetic.mesh, chair.tagged("back"), {0, 0, 1}), 1.2,
                0.01);
}

TEST(EditWords, PartsAreFoundByWords) {
    Annotated chair("chair", 2000);
    const auto count = [&](const std::string& words) { return parts_named(chair.set, words).size(); };
    EXPECT_EQ(count("legs"), 4U);
    EXPECT_EQ(count("front left leg"), 1U);
    EXPECT_EQ(count("seat, back"), 2U);
    EXPECT_EQ(count("seat,seat"), 1U);
    EXPECT_EQ(count("arms"), 2U) << "not the points at their ends";
    EXPECT_EQ(count("1"), 1U);
    for (const char* wrong : {"", "sea", "seat,", "eg"})
        EXPECT_THROW(static_cast<void>(parts_named(chair.set, wrong)), Error) << wrong;
    try {
        static_cast<void>(parts_named(chair.set, "saet"));
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("did you mean 'seat'"), std::string::npos) << error.what();
    }
}

TEST(EditWords, StepsAndConstraints) {
    Annotated chair("chair", 2000);
    EditWords words;
    words.stretch = {"back=1.2"};
    words.raise = {"seat=3,-x"};
    words.rotate = {"left arm=-5,z"};
    words.keep = {"seat thickness", "back"};
    const std::vector<EditStep> steps = parse_edit(words, chair.set).steps;
    ASSERT_EQ(steps.size(), 3U);
    EXPECT_EQ(std::get<EditStep::Translate>(steps[1].operation).by.x(), -3);
    RelationGraph graph;
    EXPECT_THROW(add_constraints(words, chair.set, graph), Error) << "the seat has no such measure yet";
    graph.relationships.clear();
    add_missing_measures(words, chair.synthetic.mesh, chair.set);
    add_missing_measures(words, chair.synthetic.mesh, chair.set);
    const auto& attributes = chair.tagged("seat").attributes;
    EXPECT_EQ(std::count_if(attributes.begin(), attributes.end(),
                            [](const Attribute& attribute) { return attribute.name == "thickness"; }),
              1);
    add_constraints(words, chair.set, graph);
    ASSERT_EQ(graph.relationships.size(), 2U);
    EXPECT_EQ(graph.relationships[0].type, "keep measure");
    EXPECT_EQ(graph.relationships[1].type, "keep shape");
    const auto refused = [&](std::vector<std::string> EditWords::*list, const char* text) {
        EditWords wrong;
        (wrong.*list).emplace_back(text);
        EXPECT_THROW(
            {
                static_cast<void>(parse_edit(wrong, chair.set));
                add_constraints(wrong, chair.set, graph);
            },
            Error);
    };
    refused(&EditWords::stretch, "back");
    refused(&EditWords::stretch, "back=0");
    refused(&EditWords::stretch, "back=much");
    refused(&EditWords::stretch, "=1.2");
    refused(&EditWords::raise, "back=1,w");
    refused(&EditWords::raise, "back=inf");
    refused(&EditWords::keep, "seat colour");
    refused(&EditWords::level, "seat");
    refused(&EditWords::raise, "back=2cm");
    EditWords counted;  // a tag that ends in a number is a part, and its number no part of a measure's name
    counted.keep = {"part 0 thickness"};
    counted.stretch = {"part 0=1.2,up"};
    chair.tagged("seat").tag = "part 0";
    graph.relationships.clear();
    add_missing_measures(counted, chair.synthetic.mesh, chair.set);
    add_constraints(counted, chair.set, graph);
    ASSERT_EQ(graph.relationships.size(), 1U);
    EXPECT_NE(graph.relationships[0].constraint.find("\"thickness\""), std::string::npos) << graph.relationships[0].constraint;
    EXPECT_EQ(std::get<EditStep::Stretch>(parse_edit(counted, chair.set).steps[0].operation).factor, 1.2);
    chair.set.up.reset();
    refused(&EditWords::stretch, "back=1.2");
}
