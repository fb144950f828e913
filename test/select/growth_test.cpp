#include "select/growth.h"

#include "annotation/example_meshes.h"
#include "ostraka/geom/geodesic.h"
#include "ostraka/select/scalars.h"
#include "ostraka/synthetic/make_mesh.h"
#include "select/follow.h"
#include "select/real_mesh.h"

#include <numbers>

using namespace ostraka;
using namespace ostraka::example;
using namespace ostraka::test;
using std::numbers::pi;

namespace {

std::size_t count(const std::vector<bool>& flags) {
    return static_cast<std::size_t>(std::count(flags.begin(), flags.end(), true));
}

bool contains(const std::vector<bool>& whole, const std::vector<bool>& part) {
    for (std::size_t i = 0; i < part.size(); ++i)
        if (part[i] && !whole[i]) return false;
    return true;
}

void expect_laws(const Mesh& mesh, const std::vector<bool>& part) {
    for (const int n : {1, 2, 5}) {
        EXPECT_TRUE(contains(shrink(mesh, grow(mesh, part, n), n), part));
        EXPECT_TRUE(contains(part, grow(mesh, shrink(mesh, part, n), n)));
        EXPECT_EQ(grow(mesh, grow(mesh, part, n), 1), grow(mesh, part, n + 1));
    }
    EXPECT_EQ(grow(mesh, part, 0), part);
    const double d = 3 * mean_edge_length(mesh);
    EXPECT_TRUE(contains(grow_by(mesh, part, d), part));
    EXPECT_TRUE(contains(part, shrink_by(mesh, part, d)));
    EXPECT_TRUE(contains(grow_by(mesh, part, 2 * d), grow_by(mesh, part, d)));
}

/// Spheres of radii 1 and 2 side by side.
Mesh two_sizes(int levels = 4) {
    TriangleSoup soup = to_soup(spheres(levels));
    const TriangleSoup large = to_soup(spheres(levels, {{6, 0, 0}}, 2));
    const auto shift = static_cast<Index>(soup.points.size());
    soup.points.insert(soup.points.end(), large.points.begin(), large.points.end());
    for (const auto& [a, b, c] : large.triangles) soup.triangles.push_back({a + shift, b + shift, c + shift});
    return build_mesh(soup);
}

/// Two balls of radius 20 joined by a rod of radius 6; labels 0, 1 for the balls and 2 for the rod.
SyntheticMesh dumbbell() {
    SyntheticObject object;
    object.name = "dumbbell";
    object.parts = {"one", "other", "rod"};
    object.part_colours = {{9, 9, 9}, {99, 9, 9}, {9, 99, 9}};
    SolidPose left, right;
    left.centre = {-50, 0, 0};
    right.centre = {50, 0, 0};
    object.members.push_back({make_ellipsoid(left, {20, 20, 20}), 0, false, {{1e9, 0}}});
    object.members.push_back({make_ellipsoid(right, {20, 20, 20}), 0, false, {{1e9, 1}}});
    object.members.push_back({make_tube({{{-50, 0, 0}, 6}, {{50, 0, 0}, 6}}), 0, false, {{1e9, 2}}});
    object.finish();
    MakeOptions options;
    options.vertices = 4000;
    return make_mesh(object, options);
}

}  // namespace

TEST(Growth, RingsOnATile) {
    const Mesh mesh = grid(10);
    std::vector<bool> cell(mesh.number_of_faces(), false);
    cell[2 * 55] = cell[2 * 55 + 1] = true;  // the cell from (5, 5) to (6, 6)
    // Of the 18 faces of the 3 x 3 cells around, two touch none of the cell's corners.
    EXPECT_EQ(count(grow(mesh, cell, 1)), 16U);
    EXPECT_EQ(shrink(mesh, grow(mesh, cell, 1), 1), cell);
    EXPECT_EQ(count(shrink(mesh, cell, 1)), 0U);
    EXPECT_EQ(grow_vertices(mesh, {60}, 1), (std::vector<Index>{48, 49, 59, 60, 61, 71, 72}));
    EXPECT_EQ(shrink_vertices(mesh, {48, 49, 59, 60, 61, 71, 72}, 1), std::vector<Index>{60});
    // The border of the mesh is not a border of the selection.
    EXPECT_EQ(count(shrink(mesh, std::vector<bool>(200, true), 3)), 200U);
    EXPECT_DOUBLE_EQ(area_of(R"({"grow": {"of": {"faces": [110, 111]}, "rings": 1}})", mesh), 8);
    EXPECT_DOUBLE_EQ(area_of(R"({"grow": {"of": {"box": {"min": [0, 0, 0], "max": [4, 10, 0]}}, "distance": 2}})", mesh), 60);
    EXPECT_DOUBLE_EQ(area_of(R"({"shrink": {"of": {"box": {"min": [0, 0, 0], "max": [4, 10, 0]}}, "distance": 2}})", mesh), 20);
    EXPECT_EQ(select("point", R"({"grow": {"of": {"vertices": [0]}, "rings": 1}})", mesh).points,
              (std::vector<Index>{0, 1, 11, 12}));
    EXPECT_EQ(select("point", R"({"invert": {"threshold": {"coordinate": [1, 0, 0], "above": 1}}})", mesh).points.size(), 11U);
}

TEST(Growth, LawsOnSyntheticObjectsAndAScan) {
    MakeOptions options;
    options.vertices = 3000;
    const SyntheticMesh vase = make_mesh(synthetic_object("vase"), options);
    std::vector<bool> part(vase.mesh.number_of_faces());
    for (std::size_t f = 0; f < part.size(); ++f) part[f] = vase.face_labels[f] == 1;
    expect_laws(vase.mesh, part);
    OSTRAKA_SCAN(mesh, "lion-head.off");
    std::vector<bool> half(mesh.number_of_faces());
    for (const Face f : mesh.faces()) half[f] = f.idx() % 97 == 0;
    for (const int n : {1, 3}) EXPECT_TRUE(contains(shrink(mesh, grow(mesh, half, n), n), half));
}

TEST(Brush, IsAGeodesicDisc) {
    EXPECT_NEAR(area_of(R"({"brush": {"points": [[50, 50, 0]], "radius": 30}})", grid(100)), 900 * pi, 0.01 * 900 * pi);
    EXPECT_EQ(select("point", R"({"brush": {"points": [60], "radius": 1.2}})", grid(10)).points,
              (std::vector<Index>{49, 59, 60, 61, 71}));
    // A cap of the geodesic radius r has the area 2 pi (1 - cos r).
    const Mesh sphere = spheres(5);
    for (const double r : {0.3, 1.0, 2.5}) {
        const double area = area_of(R"({"brush": {"points": [[0, 0, 1]], "radius": )" + std::to_string(r) + "}}", sphere);
        EXPECT_NEAR(area, 2 * pi * (1 - std::cos(r)), 0.02 * 2 * pi * (1 - std::cos(r)) + 0.01) << r;
    }
    // Distances are measured along the surface: the other sphere is near only in space.
    const Mesh two = spheres(4, {{0, 0, 0}, {2.02, 0, 0}});
    const auto faces = faces_of(R"({"brush": {"points": [[1, 0, 0]], "radius": 0.5}})", two);
    EXPECT_LT(faces.back(), two.number_of_faces() / 2);
    // A stroke of width 2 r along a straight line, with round ends.
    EXPECT_NEAR(area_of(R"({"brush": {"points": [[20, 50, 0], [80, 50, 0]], "radius": 10, "stroke": true}})", grid(100)),
                1200 + 100 * pi, 0.02 * (1200 + 100 * pi));
    EXPECT_NEAR(area_of(R"({"frame": "box", "brush": {"points": [[0.5, 0.5, 0]], "radius": 0.1}})", grid(100)), pi * 200,
                0.02 * pi * 200);
}

TEST(Brush, OnAScanItMatchesTheDistance) {
    OSTRAKA_SCAN(mesh, "lion-head.off");
    const double radius = 0.06 * box_diagonal(mesh);
    const Vertex centre(1000);
    const auto points = brushed_vertices(mesh, {centre}, radius);
    const auto distance = geodesic_distances(mesh, {centre});
    std::vector<Index> expected;
    for (const Vertex v : mesh.vertices())
        if (distance[v] <= radius) expected.push_back(v);
    EXPECT_EQ(points, expected) << "the bound on the search changes nothing";
    EXPECT_GT(points.size(), 20U);
    const auto faces = brushed_faces(mesh, {centre}, radius);
    for (const Face f : mesh.faces())
        if (faces[f]) {
            EXPECT_LE(std::sqrt(CGAL::squared_distance(centroid(mesh, f), mesh.point(centre))),
                      radius + mean_edge_length(mesh) * 4);
        }
}

TEST(Threshold, OnEveryScalar) {
    const Mesh sphere = spheres(5);
    EXPECT_NEAR(area_of(R"({"threshold": {"coordinate": [0, 0, 2], "above": 0.5}})", sphere), pi, 0.01 * pi);
    EXPECT_NEAR(area_of(R"({"frame": "box", "threshold": {"coordinate": [0, 0, 1], "above": 0.25, "below": 0.75}})", sphere),
                2 * pi, 0.02 * pi);
    EXPECT_NEAR(
        area_of(R"({"threshold": {"coordinate": [1, 1, 0], "above": 0.9, "quantiles": true}})", sphere) / surface_area(sphere),
        0.1, 0.005);
    EXPECT_NEAR(area_of(R"({"threshold": {"distance": [[0, 0, 1]], "below": 1}})", sphere), 2 * pi * (1 - std::cos(1.0)), 0.05);
    const Mesh mesh = two_sizes();
    const std::vector<Index> small = faces_of(R"({"component": {"seed": 0}})", mesh);
    EXPECT_EQ(faces_of(R"({"threshold": {"curvature": "mean", "scale": 0.03, "above": 0.75}})", mesh), small);
    EXPECT_EQ(faces_of(R"({"threshold": {"curvature": "gaussian", "scale": 0.03, "above": 0.6}})", mesh), small);
    EXPECT_EQ(faces_of(R"({"threshold": {"thickness": true, "below": 2.5}})", mesh), small);
    EXPECT_EQ(select("point", R"({"threshold": {"thickness": true, "below": 2.5}})", mesh).points.size(),
              mesh.number_of_vertices() / 2);
    // The same numbers for any unit, if lengths are fractions of the box's diagonal.
    const double diagonal = box_diagonal(mesh);
    EXPECT_EQ(faces_of(R"({"frame": "box", "threshold": {"curvature": "mean", "scale": 0.03, "above": )" +
                           std::to_string(0.75 * diagonal) + "}}",
                       mesh),
              small);
    EXPECT_EQ(
        faces_of(R"({"frame": "box", "threshold": {"thickness": true, "below": )" + std::to_string(2.5 / diagonal) + "}}", mesh),
        small);
}

TEST(Threshold, OnAMapNextToTheRecipe) {
    const Mesh mesh = grid(2);
    const Scratch scratch;
    (void)scratch.file("v.txt", "0\n1\n2\n0\n1\n2\n0\n1\nnan\n");
    (void)scratch.file("f.txt", "0\n0\n0\n5\n0\n0\n0\n7\n");
    (void)scratch.file("short.txt", "0\n1\n");
    const auto from = [&](const std::string& type, const std::string& expression) {
        RecipeStart start;
        start.folder = scratch.path();
        return follow(R"({"id": 0, "tag": "t", "type": ")" + type + R"(", "select": )" + expression + "}", mesh, "",
                      std::move(start))
            .annotations[0];
    };
    EXPECT_EQ(from("point", R"({"threshold": {"map": "v.txt", "above": 2}})").points, (std::vector<Index>{2, 5}));
    EXPECT_EQ(from("region", R"({"threshold": {"map": "f.txt", "above": 1, "below": 6}})").faces, std::vector<Index>{3});
    EXPECT_EQ(from("region", R"({"threshold": {"map": "v.txt", "above": 1.5}})").faces, std::vector<Index>{2})
        << "NaN is never selected";
    EXPECT_THROW((void)from("region", R"({"threshold": {"map": "short.txt", "above": 1}})"), Error);
    EXPECT_THROW((void)from("region", R"({"threshold": {"map": "none.txt", "above": 1}})"), Error);
    EXPECT_THROW((void)from("region", R"({"threshold": {"map": "f.txt", "on": "vertex", "above": 1}})"), Error);
    // A recipe reads only files in its own folder.
    std::filesystem::create_directory(scratch / "sub");
    std::filesystem::create_symlink("..", scratch / "sub" / "up");
    for (const std::string& name :
         {std::string("../v.txt"), (scratch / "v.txt").string(), std::string("x/../../v.txt"), std::string("up/v.txt")}) {
        RecipeStart start;
        start.folder = scratch / "sub";
        const std::string text = R"({"threshold": {"map": ")" + name + R"(", "above": 2}})";
        EXPECT_THROW(
            (void)follow(R"({"id": 0, "tag": "t", "type": "point", "select": )" + text + "}", mesh, "", std::move(start)), Error)
            << name;
        EXPECT_THROW((void)files_named_by(parse_json(text, "r"), scratch / "sub"), Error) << name;
    }
    EXPECT_EQ(files_named_by(parse_json(R"({"threshold": {"map": "v.txt"}})", "r"), scratch.path()),
              std::vector<Path>{scratch / "v.txt"});
}

TEST(Threshold, OnAScan) {
    OSTRAKA_SCAN(mesh, "elephant.off");
    for (const char* kind : {R"("curvature": "mean", "scale": 0.02)", R"("thickness": true)", R"("coordinate": [0, 1, 0])"}) {
        const std::string prefix = R"({"threshold": {)" + std::string(kind) + R"(, "quantiles": true, )";
        const auto low = faces_of(prefix + R"("below": 0.3}})", mesh), high = faces_of(prefix + R"("above": 0.3}})", mesh);
        EXPECT_NEAR(measure_region(mesh, low).area / surface_area(mesh), 0.3, 0.01) << kind;
        std::vector<Index> both(low);
        both.insert(both.end(), high.begin(), high.end());
        std::sort(both.begin(), both.end());
        both.erase(std::unique(both.begin(), both.end()), both.end());
        EXPECT_EQ(both.size(), mesh.number_of_faces()) << kind;
    }
}

TEST(Segments, TheBallsOfADumbbell) {
    const SyntheticMesh object = dumbbell();
    const Mesh& mesh = object.mesh;
    const std::string by_seed = R"({"segments": {"clusters": 2, "smoothing": 0.3, "seeds": [[)";
    const std::vector<std::pair<std::string, int>> seeds{{"-70, 0, 0", 0}, {"70, 0, 0", 1}, {"0, 6, 0", 2}};
    for (const auto& [seed, label] : seeds) {
        const auto faces = faces_of(by_seed + seed + "]]}}", mesh);
        double shared = 0, all = 0;
        std::vector<bool> flag(mesh.number_of_faces(), false);
        for (const Index f : faces) flag[f] = true;
        for (const Face f : mesh.faces()) {
            const bool truth = object.face_labels[f] == label;
            if (flag[f] && truth) shared += face_area(mesh, f);
            if (flag[f] || truth) all += face_area(mesh, f);
        }
        EXPECT_GT(shared / all, 0.8) << seed;
    }
    // Numbered from the largest, and together the whole mesh.
    const auto first = faces_of(R"({"segments": {"clusters": 2, "smoothing": 0.3, "numbers": [0]}})", mesh);
    const auto last = faces_of(R"({"segments": {"clusters": 2, "smoothing": 0.3, "numbers": [2]}})", mesh);
    EXPECT_GE(measure_region(mesh, first).area, measure_region(mesh, last).area);
    EXPECT_EQ(faces_of(R"({"segments": {"clusters": 2, "smoothing": 0.3, "numbers": [0, 1, 2]}})", mesh).size(),
              mesh.number_of_faces());
}

TEST(Segments, OnAScan) {
    OSTRAKA_SCAN(mesh, "elephant.off");
    const std::string expression = R"({"segments": {"clusters": 4, "smoothing": 0.2, "numbers": [0]}})";
    const auto largest = faces_of(expression, mesh);
    EXPECT_EQ(faces_of(expression, mesh), largest);
    const double share = measure_region(mesh, largest).area / surface_area(mesh);
    EXPECT_GT(share, 0.1);
    EXPECT_LT(share, 1);
}

TEST(Reckoned, ErrorsNameTheProblem) {
    const Mesh mesh = grid(4);
    expect_error(R"({"brush": {"points": [0], "radius": -1}})", mesh, "/brush/radius", "needs a number");
    expect_error(R"({"brush": {"points": [99], "radius": 1}})", mesh, "/brush/points/0", "99");
    expect_error(R"({"brush": {"points": [12], "radius": 0}})", mesh, "", "selects no face");
    expect_error(R"({"brush": {"points": [12], "radius": 1}})", mesh, "/brush", "poly-lines", "line");
    expect_error(R"({"grow": {"of": {"all": true}}})", mesh, "/grow", "neither rings nor a distance");
    expect_error(R"({"grow": {"of": {"all": true}, "rings": 1, "distance": 1}})", mesh, "/grow", "both rings and a distance");
    expect_error(R"({"grow": {"of": {"vertices": [0]}, "distance": 1}})", mesh, "/grow/distance", "rings only", "point");
    expect_error(R"({"shrink": {"of": {"box": {"min": [0, 0, 0], "max": [1, 1, 0]}}, "rings": 2}})", mesh, "", "selects no face");
    expect_error(R"({"threshold": {"above": 1}})", mesh, "/threshold", "on nothing");
    expect_error(R"({"threshold": {"thickness": true, "coordinate": [0, 0, 1], "above": 1}})", mesh, "/threshold",
                 "both coordinate and thickness");
    expect_error(R"({"threshold": {"coordinate": [1, 0, 0]}})", mesh, "/threshold", "neither above nor below");
    expect_error(R"({"threshold": {"coordinate": [1, 0, 0], "above": 2, "below": 1}})", mesh, "/threshold",
                 "above exceeds below");
    expect_error(R"({"threshold": {"coordinate": [0, 0, 0], "above": 2}})", mesh, "/threshold/coordinate", "no length");
    expect_error(R"({"frame": "box", "threshold": {"coordinate": [0, 0, 1], "above": 0}})", mesh, "/threshold/coordinate",
                 "flat");
    expect_error(R"({"threshold": {"coordinate": [1, 0, 0], "above": 2, "quantiles": true}})", mesh, "/threshold/above",
                 "quantile");
    expect_error(R"({"segments": {"clusters": 3}})", mesh, "/segments", "without seeds or numbers");
    expect_error(R"({"segments": {"numbers": [0]}})", mesh, "/segments", "thickness");
    const Mesh sphere = spheres(3);
    expect_error(R"({"segments": {"clusters": 2, "numbers": [77]}})", sphere, "/segments/numbers/0", "segment 77 of");
}
