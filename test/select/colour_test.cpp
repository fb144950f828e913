// Selections by the colours and the values of the mesh file.
#include "meshes.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/core/error.h"
#include "ostraka/select/recipe.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

/// A flat square of side 1 with a dark disc of radius 0.3 painted on its vertices, and the distance from its centre as values.
MeshFile painted() {
    MeshFile file{build_mesh(test::grid(80, 80, false, false,
                                        [](double u, double v) {
                                            return std::array<double, 3>{u, v, 0};
                                        })),
                  {},
                  {},
                  {}};
    NamedValues distance{"distance", {}}, half{"half", {}};
    for (const Vertex v : file.mesh.vertices()) {
        const Point& p = file.mesh.point(v);
        const double r = std::hypot(p.x() - 0.5, p.y() - 0.5);
        distance.values.push_back(r);
        file.extras.vertex_colours.push_back(r < 0.3 ? Colour{60, 20, 10, 255} : Colour{200, 150, 100, 255});
    }
    for (const Face f : file.mesh.faces()) half.values.push_back(centroid(file.mesh, f).x() < 0.5 ? 1 : 2);
    file.extras.vertex_values = {distance};
    file.extras.face_values = {half};
    return file;
}

AnnotationSet select(const MeshFile& file, const std::string& threshold, bool attributes = true) {
    const Json recipe = parse_json(R"({"format": "ostraka-recipe", "version": 1, "annotations": [
        {"id": 1, "tag": "disc", "type": "region", "select": {"threshold": )" +
                                       threshold + "}}]}",
                                   "recipe");
    RecipeStart start;
    if (attributes) start.attributes = &file.extras;
    return follow_recipe(recipe, file.mesh, std::move(start), "recipe");
}

double area_of(const MeshFile& file, const AnnotationSet& set) { return measure_region(file.mesh, *set.find(1)).area; }

TEST(SelectColour, APaintedDiscIsFoundByItsColour) {
    const MeshFile file = painted();
    // The border lies within the edges that cross the painted border, here of 0.0125 and 0.0177.
    const double disc = M_PI * 0.3 * 0.3;
    for (const std::string colour : {R"("#3c140a")", R"({"at": [0.5, 0.5, 0]})"})
        EXPECT_NEAR(area_of(file, select(file, R"({"colour": )" + colour + R"(, "below": 10})")), disc, 0.07 * disc) << colour;
    EXPECT_NEAR(area_of(file, select(file, R"({"colour": {"at": [0, 0, 0]}, "below": 10})")), 1 - disc, 0.07 * disc);
}

TEST(SelectColour, ValuesOfTheFileAreQuantities) {
    const MeshFile file = painted();
    EXPECT_NEAR(area_of(file, select(file, R"({"values": "distance", "below": 0.25})")), M_PI * 0.0625, 0.002);
    EXPECT_NEAR(area_of(file, select(file, R"({"values": "half", "above": 1.5})")), 0.5, 1e-9);
}

TEST(SelectColour, MissingColoursAndValuesAreNamed) {
    const MeshFile file = painted();
    const auto refusal = [&](const std::string& threshold, bool attributes) {
        try {
            select(file, threshold, attributes);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(refusal(R"({"colour": "#3c140a", "below": 10})", false).find("neither an image nor colours"), std::string::npos);
    EXPECT_NE(refusal(R"({"values": "quality", "below": 10})", true).find("distance"), std::string::npos);
    EXPECT_NE(refusal(R"({"values": "quality", "below": 10})", false).find("no values 'quality'"), std::string::npos);
}

}  // namespace
}  // namespace ostraka
