// Selections whose borders run through the faces.
#include "meshes.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/geodesic.h"
#include "ostraka/select/recipe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace ostraka;
using namespace ostraka::test;

namespace {

constexpr double pi = std::numbers::pi;

Annotation selected(const Mesh& mesh, const std::string& select, const std::string& type = "region") {
    const std::string text = R"({"format": "ostraka-recipe", "version": 1, "annotations": [{"id": 1, "tag": "part", "type": ")" +
                             type + R"(", "outline": "free", "select": )" + select + "}]}";
    AnnotationSet set = apply_recipe(parse_json(text, "test"), mesh, {}, "test");
    check_annotations(set, mesh, "selected");
    return *set.find(1);
}

/// Errors at each refinement fall at least by three: they are of second order.
void expect_second_order(const std::vector<double>& errors, const std::string& what) {
    for (std::size_t i = 0; i + 1 < errors.size(); ++i) EXPECT_LT(errors[i + 1], errors[i] / 3) << what << ' ' << i;
}

/// A torus of radii 2 and 1 about z.
Mesh round_torus(Index n) {
    TriangleSoup soup = torus(2 * n, n);
    return build_mesh(soup);
}

}  // namespace

TEST(FreeSelection, HalfspacesAndBallsOnASphereAreOfSecondOrder) {
    std::vector<double> area, perimeter, ball_area, ball_perimeter;
    for (const int level : {3, 4, 5, 6}) {
        const Mesh mesh = build_mesh(octahedron_sphere(level));
        const RegionMeasures cap = measure_region(
            mesh, selected(mesh, R"({"halfspace": {"point": [0.1224, 0.1632, 0.272], "normal": [0.36, 0.48, 0.8]}})"));
        area.push_back(std::abs(cap.area / (2 * pi * (1 - 0.34)) - 1));
        perimeter.push_back(std::abs(cap.perimeter / (2 * pi * std::sqrt(1 - 0.34 * 0.34)) - 1));
        // A ball of radius r about a place on the unit sphere cuts off a cap of area pi r^2 exactly.
        const RegionMeasures ball =
            measure_region(mesh, selected(mesh, R"({"sphere": {"centre": [0.36, 0.48, 0.8], "radius": 0.7}})"));
        ball_area.push_back(std::abs(ball.area / (pi * 0.49) - 1));
        ball_perimeter.push_back(std::abs(ball.perimeter / (2 * pi * 0.7 * std::sqrt(1 - 0.49 / 4)) - 1));
    }
    expect_second_order(area, "area of the cap");
    expect_second_order(perimeter, "perimeter of the cap");
    expect_second_order(ball_area, "area in the ball");
    expect_second_order(ball_perimeter, "perimeter of the ball");
}

TEST(FreeSelection, GeodesicDiscsAreOfSecondOrder) {
    std::vector<double> area, perimeter;
    for (const int level : {3, 4, 5}) {
        const Mesh mesh = build_mesh(octahedron_sphere(level));
        const Annotation disc = selected(mesh, R"({"brush": {"points": [0], "radius": 0.8}})");
        const RegionMeasures measures = measure_region(mesh, disc);
        area.push_back(std::abs(measures.area / (2 * pi * (1 - std::cos(0.8))) - 1));
        perimeter.push_back(std::abs(measures.perimeter / (2 * pi * std::sin(0.8)) - 1));
    }
    expect_second_order(area, "area of the disc");
    expect_second_order(perimeter, "perimeter of the disc");
}

TEST(FreeSelection, CirclesOnATorusAreOfSecondOrder) {
    std::vector<double> area, perimeter;
    for (const Index n : {16U, 32U, 64U}) {
        const Mesh mesh = round_torus(n);
        // The radii as the mesh has them.
        double outer = 0, top = 0;
        for (const Vertex v : mesh.vertices()) {
            outer = std::max(outer, std::hypot(mesh.point(v).x(), mesh.point(v).y()));
            top = std::max(top, mesh.point(v).z());
        }
        const double r = top, R = outer - r, height = 0.37 * r;
        const RegionMeasures cap = measure_region(
            mesh, selected(mesh, R"({"halfspace": {"point": [0, 0, )" + std::to_string(height) + R"(], "normal": [0, 0, 1]}})"));
        const double angle = std::asin(height / r);
        // Two circles of latitude, and the surface of revolution between them.
        perimeter.push_back(std::abs(cap.perimeter / (4 * pi * R) - 1));
        area.push_back(std::abs(cap.area / (2 * pi * R * r * (pi - 2 * angle)) - 1));
    }
    expect_second_order(perimeter, "perimeter");
    expect_second_order(area, "area");
}

TEST(FreeSelection, SetOperationsAddUp) {
    const Mesh mesh = build_mesh(octahedron_sphere(4));
    const std::string a = R"({"halfspace": {"point": [0, 0, 0.21], "normal": [0, 0.3, 1]}})",
                      b = R"({"sphere": {"centre": [0.36, 0.48, 0.8], "radius": 0.9}})";
    const auto area = [&](const std::string& select) { return area_of(mesh, selected(mesh, select)); };
    const double both = area("{\"intersection\": [" + a + ", " + b + "]}");
    EXPECT_NEAR(area("{\"union\": [" + a + ", " + b + "]}"), area(a) + area(b) - both, 1e-9);
    EXPECT_NEAR(area("{\"difference\": [" + a + ", " + b + "]}"), area(a) - both, 1e-9);
    EXPECT_NEAR(area("{\"invert\": " + b + "}"), surface_area(mesh) - area(b), 1e-9);
}

TEST(FreeSelection, APolygonOnAPictureIsAsDrawn) {
    const Mesh mesh = build_mesh(box(6));
    // The front of the box in a parallel projection: a triangle drawn on it has the area of the triangle in pixels.
    const std::string camera = R"("camera": {"view": "front", "projection": "orthographic", "picture": [800, 600]})";
    const RegionMeasures part = measure_region(
        mesh, selected(mesh, "{\"polygon\": {" + camera + R"(, "points": [[360, 280], [450, 250], [420, 340]]}})"));
    const RegionMeasures large =
        measure_region(mesh, selected(mesh, "{\"rectangle\": {" + camera + R"(, "from": [370, 260], "to": [430, 320]}})"));
    const double pixel = std::sqrt(large.area) / 60;  // a square of 60 pixels
    EXPECT_NEAR(large.perimeter, 4 * 60 * pixel, 1e-9);
    EXPECT_NEAR(part.area / (pixel * pixel), 0.5 * std::abs(90.0 * 60 - 60 * -30.0), 1e-6);
    EXPECT_NEAR(part.perimeter / pixel, std::hypot(90, 30) + std::hypot(30, 90) + std::hypot(60, 60), 1e-6);
}

TEST(FreeSelection, PathsAreGeodesics) {
    const Mesh mesh = build_mesh(octahedron_sphere(4));
    const Annotation line = selected(mesh, R"({"path": {"points": [10, 200, 400]}})", "line");
    ASSERT_TRUE(is_free(line));
    const auto node = [&](Index v) { return surface_node(mesh, Vertex(v)); };
    EXPECT_NEAR(length_of(mesh, line),
                geodesic_distance(mesh, node(10), node(200)) + geodesic_distance(mesh, node(200), node(400)), 1e-9);
    const auto curve = geodesic_curve(mesh, node(10), node(200));
    ASSERT_TRUE(curve);
    EXPECT_NEAR(curve->length(), geodesic_distance(mesh, node(10), node(200)), 1e-9);
}

TEST(FreeSelection, EditsKeepItFree) {
    const Mesh mesh = build_mesh(octahedron_sphere(4));
    const std::string text = R"({"format": "ostraka-recipe", "version": 1, "annotations": [
        {"id": 1, "tag": "part", "type": "region", "outline": "free",
         "select": {"sphere": {"centre": [0, 0, 1], "radius": 0.5}}},
        {"id": 1, "action": "add to", "select": {"sphere": {"centre": [0.4, 0, 0.9], "radius": 0.5}}},
        {"id": 1, "action": "remove from", "select": {"sphere": {"centre": [0.2, 0, 1], "radius": 0.2}}}]})";
    const AnnotationSet set = apply_recipe(parse_json(text, "test"), mesh, {}, "test");
    check_annotations(set, mesh, "edited");
    const Annotation& part = set.annotations.front();
    ASSERT_TRUE(is_free(part));
    EXPECT_EQ(part.curves.size(), 2U);  // with a hole
    const auto area = [&](const char* centre, double radius) {
        return area_of(mesh, selected(mesh, "{\"sphere\": {\"centre\": " + std::string(centre) +
                                                ", \"radius\": " + std::to_string(radius) + "}}"));
    };
    const double both = area_of(mesh, selected(mesh, R"({"union": [{"sphere": {"centre": [0, 0, 1], "radius": 0.5}},
                                                                   {"sphere": {"centre": [0.4, 0, 0.9], "radius": 0.5}}]})"));
    EXPECT_NEAR(area_of(mesh, part), both - area("[0.2, 0, 1]", 0.2), 1e-9);
}

TEST(FreeSelection, WhatMissesTheSurfaceIsRefused) {
    const Mesh mesh = build_mesh(octahedron_sphere(2));
    EXPECT_THROW(selected(mesh, R"({"sphere": {"centre": [9, 9, 9], "radius": 1}})"), Error);
    // The whole is the whole, and has no outline.
    EXPECT_TRUE(selected(mesh, R"({"sphere": {"centre": [0, 0, 0], "radius": 9}})").all);
}

TEST(FreeSelection, GrowthByADistanceIsOfSecondOrder) {
    // A cap that is grown and shrunk along the surface: caps again.
    std::vector<double> grown, shrunk, length;
    for (const int level : {3, 4, 5}) {
        const Mesh mesh = build_mesh(octahedron_sphere(level));
        const std::string cap = R"({"halfspace": {"point": [0.3024, 0.4032, 0.672], "normal": [0.36, 0.48, 0.8]}})";
        const double angle = std::acos(0.84);
        const RegionMeasures more = measure_region(mesh, selected(mesh, R"({"grow": {"of": )" + cap + R"(, "distance": 0.3}})"));
        const RegionMeasures less =
            measure_region(mesh, selected(mesh, R"({"shrink": {"of": )" + cap + R"(, "distance": 0.3}})"));
        grown.push_back(std::abs(more.area / (2 * pi * (1 - std::cos(angle + 0.3))) - 1));
        shrunk.push_back(std::abs(less.area / (2 * pi * (1 - std::cos(angle - 0.3))) - 1));
        length.push_back(std::abs(more.perimeter / (2 * pi * std::sin(angle + 0.3)) - 1));
    }
    expect_second_order(grown, "area of the grown cap");
    expect_second_order(shrunk, "area of the shrunk cap");
    expect_second_order(length, "perimeter of the grown cap");
}

TEST(FreeSelection, WhatIsChosenFaceByFaceEndsAtIsolines) {
    const Mesh mesh = build_mesh(octahedron_sphere(5));
    // Labels by a plane that follows no edges: their border is a saw, the isoline nearly the circle.
    std::vector<std::int32_t> labels;
    for (const Face f : mesh.faces()) {
        const Point c = centroid(mesh, f);
        labels.push_back(0.36 * c.x() + 0.48 * c.y() + 0.8 * c.z() > 0.34 ? 7 : 3);
    }
    const auto region = [&](const std::string& outline, const std::string& select) {
        const std::string text = R"({"format": "ostraka-recipe", "version": 1, "annotations": [
            {"id": 1, "tag": "part", "type": "region", "outline": ")" +
                                 outline + R"(", "select": )" + select + "}]}";
        AnnotationSet set = apply_recipe(parse_json(text, "test"), mesh, labels, "test");
        check_annotations(set, mesh, "labelled");
        return measure_region(mesh, *set.find(1));
    };
    const double circle = 2 * pi * std::sqrt(1 - 0.34 * 0.34), cap = 2 * pi * (1 - 0.34);
    const RegionMeasures saw = region("edges", R"({"labels": [7]})"), line = region("free", R"({"labels": [7]})");
    EXPECT_GT(saw.perimeter, 1.15 * circle);
    EXPECT_LT(line.perimeter, 1.06 * circle);
    EXPECT_NEAR(line.area / cap, 1, 0.01);
    // Both labels together are the whole, without a gap or an overlap; a ring more or less is along isolines as well.
    const RegionMeasures rest = region("free", R"({"invert": {"labels": [7]}})");
    EXPECT_NEAR((line.area + rest.area) / surface_area(mesh), 1, 1e-12);
    const RegionMeasures ring = region("free", R"({"grow": {"of": {"labels": [7]}, "rings": 1}})");
    EXPECT_GT(ring.area, line.area);
    EXPECT_LT(ring.perimeter, region("edges", R"({"grow": {"of": {"labels": [7]}, "rings": 1}})").perimeter);
    // A single triangle has no vertex with half of its faces: it stays as it is.
    labels.assign(labels.size(), 3);
    labels[11] = 7;
    EXPECT_NEAR(region("free", R"({"labels": [7]})").area, face_area(mesh, Face(11)), 1e-12);
}
