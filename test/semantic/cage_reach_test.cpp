// Automatic choice of the space of the solve, and constraints that a cage can satisfy.
#include "caged.h"

#include "ostraka/geom/eigen.h"
#include "ostraka/semantic/cage_reach.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace ostraka;
using namespace ostraka::test;

namespace {

const std::vector<int> flowers{7, 8, 9, 10, 11};
const char* const stretched = R"({"select": {"all": true}, "stretch": {"direction": [0, 0, 1], "factor": 1.4}})";

RelationGraph graph_with(const Relationship& relationship) {
    RelationGraph graph;
    graph.relationships.push_back(relationship);
    return graph;
}

DeformResult automatic(const HandleSpace& space, const RelationGraph& graph, const std::string& steps) {
    DeformOptions options;
    options.space = DeformOptions::Space::automatic;
    return deform(space, graph, edit(steps), "e", options, deform_tolerances());
}

/// Maximum difference of the heights of the parts' area centroids.
double level_spread(const Caged& object, const std::vector<Point>& points, const std::vector<int>& ids) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const int id : ids) {
        double sum = 0, whole = 0;
        for (const Index f : object.set.find(id)->faces) {
            const auto [a, b, c] = corners(object.synthetic.mesh, Face(f));
            const double area = std::sqrt(CGAL::cross_product(points[b] - points[a], points[c] - points[a]).squared_length());
            sum += area * (points[a].z() + points[b].z() + points[c].z()) / 3;
            whole += area;
        }
        low = std::min(low, sum / whole), high = std::max(high, sum / whole);
    }
    return high - low;
}

}  // namespace

TEST(AutomaticSpace, SeatsOrnamentsWithAndWithoutACage) {
    const Caged& object = teapot();
    const RelationGraph graph = graph_with(constraint(0, "same level", flowers, "{}"));
    for (const HandleSpace& space : {object.handles(), object.bare()}) {
        const DeformResult result = automatic(space, graph, stretched);
        EXPECT_TRUE(result.acceptable) << (result.objections.empty() ? "" : result.objections.front());
        EXPECT_EQ(result.seated, std::vector<int>{0});
        EXPECT_EQ(result.space, DeformOptions::Space::mesh);
        EXPECT_LT(level_spread(object, result.points, flowers), 1e-9 * box_diagonal(object.synthetic.mesh));
    }
}

TEST(AutomaticSpace, SeatsNoPartWithSpecifiedShapes) {
    const Caged& object = teapot();
    for (const char* parameters : {R"({"shapes": "free"})", R"({"follow": true})", R"({"heights": "rest"})"}) {
        const DeformResult result =
            automatic(object.handles(), graph_with(constraint(0, "same level", flowers, parameters)), stretched);
        EXPECT_TRUE(result.seated.empty()) << parameters;
        EXPECT_TRUE(result.solved) << parameters;
    }
    // Spout and handle are not ornaments: they protrude.
    EXPECT_TRUE(automatic(object.handles(), graph_with(constraint(0, "same level", {5, 6}, "{}")), stretched).seated.empty());
    // Two constraints on one flower: it cannot be seated twice.
    RelationGraph two = graph_with(constraint(0, "same level", flowers, "{}"));
    two.relationships.push_back(constraint(1, "keep shape", {7}, "{}"));
    EXPECT_TRUE(automatic(object.handles(), two, stretched).seated.empty());
}

TEST(AutomaticSpace, WithoutConstraintsIsTheEdit) {
    const Caged& object = teapot();
    const DeformResult result = automatic(object.handles(), {}, stretched);
    EXPECT_FALSE(result.solved);
    EXPECT_EQ(result.points, result.edited);
}

TEST(AutomaticSpace, ThroughACageTheNamedPartMovesAsWithoutACage) {
    // The constraint must not undo half of the edit.
    const Caged& object = teapot();
    const RelationGraph graph = graph_with(constraint(0, "same level", {4, 14}, R"({"reference": "vertex", "hard": true})"));
    const DeformResult result =
        automatic(object.handles(), graph, R"({"select": {"annotation": "knob"}, "translate": [0, 0, 8]})");
    EXPECT_EQ(result.space, DeformOptions::Space::mesh);
    EXPECT_GT(result.followed.share, 0.9);
    EXPECT_EQ(result.constraints[0].verdict, Verdict::holds);
}

TEST(AutomaticSpace, IsNeverWorseThanTheMesh) {
    // Two incompatible levels: nothing is acceptable, and the result is that of mesh space or a better one.
    const Caged& object = teapot();
    RelationGraph graph = graph_with(
        constraint(0, "keep measure", {0}, R"({"measure": "height", "minValue": 100, "maxValue": 101, "hard": true})"));
    graph.relationships.push_back(
        constraint(1, "keep measure", {0}, R"({"measure": "height", "minValue": 150, "maxValue": 151, "hard": true})"));
    DeformOptions options;
    const auto failing = [](const DeformResult& result) {
        return std::count_if(result.constraints.begin(), result.constraints.end(),
                             [](const ConstraintReport& report) { return report.verdict != Verdict::holds; });
    };
    const DeformResult mesh = deform(object.handles(), graph, edit(stretched), "e", options, deform_tolerances());
    const DeformResult result = automatic(object.handles(), graph, stretched);
    EXPECT_FALSE(result.acceptable);
    EXPECT_LE(failing(result), failing(mesh));
    EXPECT_FALSE(result.conflicts.empty() && result.untried == 0 && failing(result) < 2) << "conflicts are looked for";
}

TEST(CageReach, APointCanReachAnyPosition) {
    // One row whose weights sum to one: every cage can satisfy it, with rank 1.
    const Caged& object = teapot();
    const auto list = cage_reach(object.handles(), graph_with(constraint(4, "keep position", {14}, "{}")));
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].id, 4);
    EXPECT_EQ(list[0].rank, 1u);
    EXPECT_TRUE(list[0].reached) << describe(list[0], object.set);
    EXPECT_EQ(describe(list[0], object.set), "");
}

TEST(CageReach, SmallRigidPartsNeedControlPointsNearby) {
    const Caged& object = teapot();
    const RelationGraph graph = graph_with(constraint(0, "same level", flowers, "{}"));
    const auto list = cage_reach(object.handles(), graph);
    ASSERT_EQ(list.size(), 1u);
    const ConstraintReach& coarse = list[0];
    EXPECT_FALSE(coarse.reached);
    EXPECT_GT(coarse.remaining_distance, coarse.tolerance);
    EXPECT_LT(coarse.remaining_distance, coarse.distance_after_edit) << "solving makes it better";
    EXPECT_LE(coarse.rank, std::min<std::size_t>(coarse.rows, object.cage.number_of_vertices()));
    ASSERT_TRUE(coarse.lacking);
    EXPECT_TRUE(std::find(flowers.begin(), flowers.end(), *coarse.lacking) != flowers.end());
    EXPECT_NE(describe(coarse, object.set).find("'" + object.set.find(*coarse.lacking)->tag + "'"), std::string::npos);
    // A cage made for the constraints leaves a smaller deviation, and is valid.
    const ConstraintCage adapted = make_cage_for_constraints({object.synthetic.mesh, object.set}, graph, {.vertices = 150});
    ASSERT_EQ(adapted.reach.size(), 1u);
    EXPECT_LT(adapted.reach[0].remaining_distance, 0.8 * coarse.remaining_distance);
    EXPECT_LE(adapted.made.cage.number_of_vertices(), 300u);
    EXPECT_TRUE(check_cage(adapted.made.cage, object.synthetic.mesh).outside.empty());
    // Seated parts are put back as rigid copies: no cage has to reproduce them.
    EXPECT_TRUE(cage_reach(object.handles(), graph_with(constraint(0, "same level", flowers, R"({"shapes": "seat"})"))).empty());
}

TEST(CageReach, EvaluatesTheGivenEdit) {
    const Caged& object = teapot();
    const RelationGraph graph = graph_with(constraint(0, "same level", flowers, "{}"));
    const Edit strong = edit(stretched), none = edit(R"({"select": {"all": true}, "translate": [1, 2, 3]})");
    const auto far = cage_reach(object.handles(), graph, &strong), still = cage_reach(object.handles(), graph, &none);
    ASSERT_EQ(far.size(), 1u);
    ASSERT_EQ(still.size(), 1u);
    EXPECT_TRUE(still[0].reached) << "what moves as a whole keeps its shape: " << describe(still[0], object.set);
    EXPECT_GT(far[0].remaining_distance, 2 * cage_reach(object.handles(), graph)[0].remaining_distance)
        << "four times as strong an edit";
}

TEST(CageReach, WithoutConstraintsIsEmpty) {
    const Caged& object = teapot();
    EXPECT_TRUE(cage_reach(object.handles(), {}).empty());
    EXPECT_TRUE(cage_reach(object.handles(), graph_with(constraint(0, "same level", flowers, "{}", 0))).empty());
    EXPECT_THROW(cage_reach(object.bare(), {}), Error);
    EXPECT_THROW(cage_reach(object.handles(), graph_with(constraint(0, "same level", {99, 100}, "{}"))), Error);
    const ConstraintCage adapted = make_cage_for_constraints({object.synthetic.mesh, object.set}, {}, {.vertices = 100});
    EXPECT_EQ(adapted.made.cage.number_of_vertices(), 100u);
    EXPECT_TRUE(adapted.reach.empty());
}
