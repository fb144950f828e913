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
    check_annotations({mesh, set}, "selected");
    return *set.find(1);
}

/// Errors decrease at least by a factor of three per refinement: second order.
void expect_second_order(const std::vector<double>& errors, const std::string& name) {
    for (std::size_t i = 0; i + 1 < errors.size(); ++i) EXPECT_LT(errors[i + 1], errors[i] / 3) << name << ' ' << i;
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
        // A ball of radius r about a point on the unit sphere cuts off a cap of area pi r^2 exactly.
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
        // The radii of the mesh.
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
    const auto node = [&](Index v) { return vertex_point(v); };
    EXPECT_NEAR(length_of(mesh, line),
                geodesic_distance(mesh, node(10), node(200)) + geodesic_distance(mesh, node(200), node(400)), 1e-9);
    const auto curve = geodesic_curve(mesh, node(10), node(200));
    ASSERT_TRUE(curve);
    EXPECT_NEAR(curve->length(mesh), geodesic_distance(mesh, node(10), node(200)), 1e-9);
}

TEST(FreeSelection, EditsKeepFreeOutlines) {
    const Mesh mesh = build_mesh(octahedron_sphere(4));
    const std::string text = R"({"format": "ostraka-recipe", "version": 1, "annotations": [
        {"id": 1, "tag": "part", "type": "region", "outline": "free",
         "select": {"sphere": {"centre": [0, 0, 1], "radius": 0.5}}},
        {"id": 1, "action": "add to", "select": {"sphere": {"centre": [0.4, 0, 0.9], "radius": 0.5}}},
        {"id": 1, "action": "remove from", "select": {"sphere": {"centre": [0.2, 0, 1], "radius": 0.2}}}]})";
    const AnnotationSet set = apply_recipe(parse_json(text, "test"), mesh, {}, "test");
    check_annotations({mesh, set}, "edited");
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

TEST(FreeSelection, SelectionsThatMissTheSurfaceAreRefused) {
    const Mesh mesh = build_mesh(octahedron_sphere(2));
    EXPECT_THROW(selected(mesh, R"({"sphere": {"centre": [9, 9, 9], "radius": 1}})"), Error);
    // The whole mesh has no outline.
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

TEST(FreeSelection, SetsOfFacesEndAtIsolines) {
    const Mesh mesh = build_mesh(octahedron_sphere(5));
    // Labels by a plane not aligned with edges: their border is a sawtooth line, the isoline nearly a circle.
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
        check_annotations({mesh, set}, "labelled");
        return measure_region(mesh, *set.find(1));
    };
    const double circle = 2 * pi * std::sqrt(1 - 0.34 * 0.34), cap = 2 * pi * (1 - 0.34);
    const RegionMeasures saw = region("edges", R"({"labels": [7]})"), line = region("free", R"({"labels": [7]})");
    EXPECT_GT(saw.perimeter, 1.15 * circle);
    EXPECT_LT(line.perimeter, 1.06 * circle);
    EXPECT_NEAR(line.area / cap, 1, 0.01);
    // Both labels together cover the whole, without gap or overlap; growth and shrinkage by a ring also follow isolines.
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

namespace {

/// A region from a recipe without `outline`, after a first annotation of label 7.
AnnotationSet by_default(const Mesh& mesh, const std::vector<std::int32_t>& labels, const std::string& select,
                         const std::string& more = "") {
    const std::string text = R"({"format": "ostraka-recipe", "version": 1, "annotations": [
        {"id": 1, "tag": "labelled", "type": "region", "select": {"labels": [7]}},
        {"id": 2, "tag": "part", "type": "region", "select": )" +
                             select + "}" + more + "]}";
    AnnotationSet set = apply_recipe(parse_json(text, "test"), mesh, labels, "test");
    check_annotations({mesh, set}, "by default");
    return set;
}

std::vector<std::int32_t> labels_by_plane(const Mesh& mesh) {
    std::vector<std::int32_t> labels;
    for (const Face f : mesh.faces()) labels.push_back(centroid(mesh, f).x() + 0.3 * centroid(mesh, f).y() > 0.1 ? 7 : 3);
    return labels;
}

}  // namespace

TEST(FreeSelection, LevelSetsAreFreeAndSetsOfFacesKeepTheirEdges) {
    const Mesh mesh = build_mesh(octahedron_sphere(3));
    const std::vector<std::int32_t> labels = labels_by_plane(mesh);
    const std::string ball = R"({"sphere": {"centre": [0.36, 0.48, 0.8], "radius": 0.7}})";
    const std::string around =
        R"("points": [[0.9, 0.1, 0.3], [0.1, 0.9, 0.3], [-0.9, 0.1, 0.3], [0.1, -0.9, 0.3]], "seed": [0, 0, 1])";
    for (const std::string& level : std::vector<std::string>{
             ball, R"({"box": {"min": [-2, -2, 0.3], "max": [2, 2, 2]}})",
             R"({"halfspace": {"point": [0, 0, 0.31], "normal": [0.1, 0, 1]}})",
             R"({"rectangle": {"camera": {"view": "front", "picture": [400, 300]}, "from": [150, 100], "to": [220, 190]}})",
             R"({"threshold": {"coordinate": [0.1, 0.2, 1], "above": 0.37}})", R"({"brush": {"points": [0], "radius": 0.6}})",
             "{\"lasso\": {" + around + "}}", R"({"grow": {"of": {"labels": [7]}, "distance": 0.2}})",
             "{\"invert\": " + ball + "}", "{\"component\": {\"seed\": [0.36, 0.48, 0.8], \"of\": " + ball + "}}",
             "{\"difference\": [{\"labels\": [7]}, " + ball + "]}"})
        EXPECT_TRUE(is_free(*by_default(mesh, labels, level).find(2))) << level;
    for (const std::string& faces : std::vector<std::string>{
             R"({"labels": [7]})", R"({"faces": [1, 2, 3]})", R"({"all": true})", R"({"component": {"seed": 5}})",
             R"({"threshold": {"thickness": true, "above": 0}})", "{\"grow\": {\"of\": " + ball + ", \"rings\": 1}}",
             "{\"lasso\": {" + around + ", \"metric\": \"combined\"}}", R"({"annotation": 1})", R"({"invert": {"labels": [7]}})"})
        EXPECT_FALSE(is_free(*by_default(mesh, labels, faces).find(2))) << faces;
    // As requested, for any selection.
    EXPECT_FALSE(is_free(*by_default(mesh, labels, ball + R"(, "outline": "edges")").find(2)));
    EXPECT_TRUE(is_free(*by_default(mesh, labels, R"({"labels": [7]}, "outline": "free")").find(2)));
}

TEST(FreeSelection, MixedSelectionsKeepTheEdgesOfSetsOfFaces) {
    const Mesh mesh = build_mesh(octahedron_sphere(4));
    const std::vector<std::int32_t> labels = labels_by_plane(mesh);
    const std::string ball = R"({"sphere": {"centre": [0.36, 0.48, 0.8], "radius": 0.7}})", of_label = R"({"labels": [7]})";
    const auto area = [&](const std::string& select) { return area_of(mesh, *by_default(mesh, labels, select).find(2)); };
    double labelled = 0;
    for (const Face f : mesh.faces())
        if (labels[f] == 7) labelled += face_area(mesh, f);
    const std::string both = "[" + of_label + ", " + ball + "]";
    EXPECT_NEAR(area("{\"union\": " + both + "}"), labelled + area(ball) - area("{\"intersection\": " + both + "}"), 1e-12);
    EXPECT_NEAR(area("{\"difference\": " + both + "}"), labelled - area("{\"intersection\": " + both + "}"), 1e-12);
}

TEST(FreeSelection, EditsKeepTheKindOfAnOutlineAndReplacementsAreNew) {
    const Mesh mesh = build_mesh(octahedron_sphere(3));
    const std::vector<std::int32_t> labels = labels_by_plane(mesh);
    const std::string ball = R"({"sphere": {"centre": [0.36, 0.48, 0.8], "radius": 0.7}})";
    const auto after = [&](const std::string& select, const std::string& step) {
        return *by_default(mesh, labels, select, ", {\"id\": 2, " + step + "}").find(2);
    };
    EXPECT_FALSE(is_free(after(R"({"faces": [1, 2, 3]})", R"("action": "add to", "select": )" + ball)));
    EXPECT_TRUE(is_free(after(ball, R"("action": "add to", "select": {"faces": [1, 2, 3]})")));
    EXPECT_TRUE(is_free(after(R"({"faces": [1, 2, 3]})", R"("action": "replace", "select": )" + ball)));
    EXPECT_FALSE(is_free(after(ball, R"("action": "replace", "select": {"faces": [1, 2, 3]})")));
    // Along the edges from now on, including the existing part.
    const Annotation both = after(ball, R"("action": "add to", "outline": "edges", "select": {"faces": [1, 2, 3]})");
    EXPECT_FALSE(is_free(both));
    EXPECT_GT(both.faces.size(), by_default(mesh, labels, ball).find(2)->faces.size());
}

TEST(FreeSelection, WithoutAFreeOutlineItRunsAlongTheEdges) {
    // A plate of 8 by 8 squares; some of its triangles have a neighbour without area along one side, which cannot be cut inside.
    constexpr Index n = 8;
    TriangleSoup soup;
    for (Index y = 0; y <= n; ++y)
        for (Index x = 0; x <= n; ++x) soup.points.push_back({static_cast<double>(x), static_cast<double>(y), 0});
    for (Index i = 0; i < 2 * n * n; ++i) {
        const Index low = i / 2 / n * (n + 1) + i / 2 % n, high = low + n + 2;
        const Index a = low, b = i % 2 == 0 ? low + 1 : high, c = i % 2 == 0 ? high : high - 1;
        if (i % 2 == 0 && ((i >= 36 && i <= 38) || (i >= 50 && i <= 54) || (i >= 66 && i <= 70))) {
            const Index middle = static_cast<Index>(soup.points.size());
            soup.points.push_back({soup.points[a][0] + 0.4 * (soup.points[b][0] - soup.points[a][0]),
                                   soup.points[a][1] + 0.4 * (soup.points[b][1] - soup.points[a][1]), 0});
            soup.triangles.insert(soup.triangles.end(), {{a, middle, c}, {middle, b, c}, {a, b, middle}});
        } else {
            soup.triangles.push_back({a, b, c});
        }
    }
    const Mesh mesh = build_mesh(soup);
    std::size_t along_edges = 0;
    for (const double x : {3.6, 4.0, 4.4})
        for (const double radius : {0.9, 1.3, 1.7, 2.1}) {
            const std::string text = R"({"format": "ostraka-recipe", "version": 1, "annotations": [{"id": 1, "tag": "disc",
                "type": "region", "select": {"sphere": {"centre": [)" +
                                     std::to_string(x) + ", 3, 0], \"radius\": " + std::to_string(radius) + "}}}]}";
            const AnnotationSet set = apply_recipe(parse_json(text, "test"), mesh, {}, "test");
            check_annotations({mesh, set}, "plate");
            const bool free = is_free(*set.find(1));
            EXPECT_EQ(set.notes.empty(), free) << x << ' ' << radius;
            if (free || set.notes.empty()) continue;
            ++along_edges;
            EXPECT_NE(set.notes.front().find("runs along the edges"), std::string::npos) << set.notes.front();
        }
    EXPECT_GT(along_edges, 0U);
    EXPECT_LT(along_edges, 12U);
}
