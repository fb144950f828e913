// Relationships of an object that is moved.
#include "ostraka/semantic/moved_graph.h"
#include "ostraka/files/json.h"

#include <gtest/gtest.h>

using namespace ostraka;

namespace {

/// Mirrors x, then turns x to y, doubles all lengths and shifts.
const Motion motion{(Eigen::Matrix3d() << 0, -1, 0, -1, 0, 0, 0, 0, 1).finished(), {10, 20, 30}, 2};

Relationship constraint(const std::string& type, const std::string& parameters) {
    Relationship relationship;
    relationship.type = type;
    relationship.annotations = {1};
    relationship.is_constraint = true;
    relationship.constraint = parameters;
    return relationship;
}

/// The parameters of a constraint after the motion.
std::string moved_parameters(const std::string& type, const std::string& parameters) {
    const RelationGraph graph{{constraint(type, parameters)}, {}};
    return to_compact_text(parse_json(moved_graph(graph, motion, "mm", "mm").relationships[0].constraint, "test"));
}

}  // namespace

TEST(MovedGraph, PlanesAxesAndLengthsFollow) {
    Relationship relationship = extracted_relationship(GeometricRelation::mirror_symmetry, 4, {1, 2});
    relationship.parameters.plane = {{1, 2, 3}, {1, 0, 0}};
    relationship.parameters.axis = {{0, 0, 1}, {0, 0, 1}};
    relationship.parameters.up = {0, 1, 0};
    relationship.parameters.deviations = {{"distance", 0.5, 2.0, "mm"}, {"angle", 3.0, {}, "degree"}, {"share", 4.0, 5.0, "%"}};
    RelationGraph graph;
    graph.relationships = {relationship};
    const RelationParameters moved = moved_graph(graph, motion, "mm", "cm").relationships[0].parameters;
    using Triple = std::array<double, 3>;
    EXPECT_EQ(moved.plane->point, (Triple{6, 18, 36}));
    EXPECT_EQ(moved.plane->direction, (Triple{0, -1, 0}));
    EXPECT_EQ(moved.axis->point, (Triple{10, 20, 32}));
    EXPECT_EQ(moved.axis->direction, (Triple{0, 0, 1}));
    EXPECT_EQ(*moved.up, (Triple{-1, 0, 0}));
    EXPECT_EQ(*moved.deviations[0].value, 1);
    EXPECT_EQ(*moved.deviations[0].tolerance, 4);
    EXPECT_EQ(moved.deviations[0].unit, "cm");
    EXPECT_EQ(*moved.deviations[1].value, 3);
    EXPECT_EQ(moved.deviations[1].unit, "degree");
    EXPECT_EQ(*moved.deviations[2].tolerance, 5);

    // Without a unit, lengths are known in geometric relations only.
    graph.relationships[0].parameters.deviations = {{"distance", 0.5, 2.0, ""}};
    EXPECT_EQ(*moved_graph(graph, motion, "", "").relationships[0].parameters.deviations[0].value, 1);
    graph.relationships[0].type = "glazed before";
    EXPECT_EQ(*moved_graph(graph, motion, "", "").relationships[0].parameters.deviations[0].value, 0.5);
}

TEST(MovedGraph, ParametersOfConstraintsFollow) {
    EXPECT_EQ(moved_parameters("keep position", R"({"point":[1,2,3],"hard":true})"), R"({"point":[6.0,18.0,36.0],"hard":true})");
    EXPECT_EQ(moved_parameters("same level", R"({"direction":[1,0,0]})"), R"({"direction":[0.0,-1.0,0.0]})");
    EXPECT_EQ(moved_parameters("keep measure", R"({"measure":"height","minValue":3,"maxValue":5})"),
              R"({"measure":"height","minValue":6.0,"maxValue":10.0})");
    for (const auto& [type, factor] : {std::pair{"polyline length", "6.0"},
                                       {"Edge strain", "6.0"},
                                       {"bending", "6.0"},
                                       {"area", "12.0"},
                                       {"volume", "24.0"}}) {
        EXPECT_EQ(moved_parameters(type, R"({"absolute":true,"minValue":3})"),
                  std::string(R"({"absolute":true,"minValue":)") + factor + "}");
        EXPECT_EQ(moved_parameters(type, R"({"minValue":3})"), R"({"minValue":3})") << "relative to the rest shape";
    }
    // Ratios and angles have no unit of length.
    for (const char* type : {"proportion", "angle", "similarity"})
        EXPECT_EQ(moved_parameters(type, R"({"minValue":1,"maxValue":2})"), R"({"minValue":1,"maxValue":2})");
    // What is no parameter of this form is kept, for the reader to refuse.
    EXPECT_EQ(moved_parameters("keep position", R"({"point":[1,2],"direction":"z"})"), R"({"point":[1,2],"direction":"z"})");
}
