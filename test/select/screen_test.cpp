#include "select/screen.h"

#include "annotation/example_meshes.h"
#include "ostraka/render/render.h"
#include "ostraka/synthetic/make_mesh.h"
#include "select/follow.h"
#include "select/real_mesh.h"

#include <random>

using namespace ostraka;
using namespace ostraka::example;
using namespace ostraka::test;

namespace {

std::string drawn(const std::string& camera, const std::string& from, const std::string& to, const std::string& rest = "") {
    return R"({"rectangle": {"camera": )" + camera + R"(, "from": )" + from + R"(, "to": )" + to + rest + "}}";
}

PictureCamera camera_of(const Mesh& mesh, const std::string& view, bool perspective, int width = 1200, int height = 900) {
    return fit_camera(mesh, {parse_view(view), {0, 0, 1}, perspective, 1, plain_pane(width, height)});
}

/// Every triangle tried in turn (Moeller and Trumbore 1997), with an uncertain answer if a hit is close to an edge.
enum class Sight { free, hidden, doubtful };
Sight brute_force(const Mesh& mesh, Vertex vertex, const Vector& ray, double max_distance) {
    const Point& p = mesh.point(vertex);
    bool doubtful = false;
    constexpr double margin = 1e-9;
    for (const Face face : mesh.faces()) {
        const auto [ia, ib, ic] = corners(mesh, face);
        if (ia == vertex || ib == vertex || ic == vertex) continue;
        const Point &a = mesh.point(ia), &b = mesh.point(ib), &c = mesh.point(ic);
        const Vector ab = b - a, ac = c - a, n = CGAL::cross_product(ray, ac), s = p - a;
        const double determinant = ab * n;
        if (determinant == 0) continue;
        const double u = (s * n) / determinant;
        if (u < -margin || u > 1 + margin) continue;
        const Vector q = CGAL::cross_product(s, ab);
        const double v = (ray * q) / determinant, t = (ac * q) / determinant / max_distance;
        if (v < -margin || u + v > 1 + margin || t < -margin || t > 1) continue;
        if (u > margin && v > margin && u + v < 1 - margin && t > margin) return Sight::hidden;
        doubtful = true;
    }
    return doubtful ? Sight::doubtful : Sight::free;
}

/// 10,000 pairs of a random vertex and a random camera.
void compare_with_brute_force(const Mesh& mesh) {
    std::mt19937_64 random(5);
    const SurfaceSearch search(mesh);
    const double diagonal = box_diagonal(mesh);
    std::size_t compared = 0, doubtful = 0, hidden = 0;
    for (int k = 0; k < 8; ++k) {
        const bool perspective = k % 2 == 0;
        const PictureCamera camera = camera_of(
            mesh, std::to_string(random() % 360) + "," + std::to_string(static_cast<int>(random() % 160) - 80), perspective);
        const auto seen = vertices_seen(
            mesh, camera, [](const Pixel&) { return true; }, &search);
        std::vector<bool> flag(mesh.number_of_vertices(), false);
        for (const Index v : seen) flag[v] = true;
        for (int i = 0; i < 1250; ++i) {
            const Vertex v(static_cast<Index>(random() % mesh.number_of_vertices()));
            if (mesh.is_isolated(v)) continue;
            Vector ray = perspective ? *camera.eye() - mesh.point(v) : camera.toward;
            const double max_distance = perspective ? std::sqrt(ray.squared_length()) : 10 * diagonal;
            if (perspective) ray = ray / max_distance;
            const Sight sight = brute_force(mesh, v, ray, max_distance);
            ++compared;
            doubtful += sight == Sight::doubtful;
            hidden += sight == Sight::hidden;
            if (sight != Sight::doubtful) {
                EXPECT_EQ(flag[v], sight == Sight::free) << "vertex " << v;
            }
        }
    }
    EXPECT_GE(compared, 9900U);
    EXPECT_LE(doubtful, compared / 1000);
    EXPECT_GT(hidden, compared / 5);
    EXPECT_LT(hidden, compared * 4 / 5);
}

}  // namespace

TEST(Screen, ARectangleOnATileFromAbove) {
    const Mesh mesh = grid(10);
    // 10 x 10 fill 92 % of a pane of 856 pixels' height about its middle (600, 428): 78.752 pixels a unit.
    const PictureCamera camera = camera_of(mesh, "top", false);
    EXPECT_NEAR(camera.scale, 78.752, 1e-9);
    const auto pixel = camera.project(Point(2, 3, 0));
    EXPECT_NEAR((*pixel)[0], 600 - 3 * 78.752, 1e-9);
    EXPECT_NEAR((*pixel)[1], 428 + 2 * 78.752, 1e-9);
    const std::string top = R"({"view": "top"})", from = "[363.744, 585.504]", to = "[757.504, 112.992]";
    const auto area = [&](const std::string& expression) {
        return measure_region(mesh, select("region", expression, mesh).faces).area;
    };
    EXPECT_DOUBLE_EQ(area(drawn(top, from, to)), 30) << "(2, 3) to (7, 9)";
    EXPECT_DOUBLE_EQ(area(drawn(top, to, from)), 30) << "any two opposite corners";
    EXPECT_DOUBLE_EQ(area(drawn(R"({"view": "bottom"})", "[0, 0]", "[600, 900]")), 50) << "an open surface has two sides";
    EXPECT_EQ(select("point", drawn(top, "[520, 340]", "[690, 510]"), mesh).points,
              (std::vector<Index>{48, 49, 50, 59, 60, 61, 70, 71, 72}));
    EXPECT_DOUBLE_EQ(
        area(R"({"polygon": {"camera": {"view": "top"}, "points": [[206.24, 821.76], [993.76, 821.76], [993.76, 34.24]]}})"), 50)
        << "a triangle of half the tile";
    const auto named = select("region", drawn("\"above\"", from, to), mesh, R"("cameras": {"above": {"view": "top"}}, )");
    EXPECT_EQ(named.faces, select("region", drawn(top, from, to), mesh).faces);
}

TEST(Screen, OnAConvexShapeFacesTowardsTheEyeAreVisible) {
    const Mesh mesh = spheres(4);
    const SurfaceSearch search(mesh);
    const auto all = [](const Pixel&) { return true; };
    for (const bool perspective : {false, true})
        for (const char* view : {"30,20", "front", "top", "200,-50"}) {
            const PictureCamera camera = camera_of(mesh, view, perspective);
            const auto seen = faces_seen(mesh, camera, all, &search);
            std::size_t count = 0;
            for (const Face f : mesh.faces()) {
                const Vector to_eye = perspective ? *camera.eye() - centroid(mesh, f) : camera.toward;
                const double facing = area_vector(mesh, f) * to_eye / std::sqrt(to_eye.squared_length()) / face_area(mesh, f);
                count += seen[f];
                if (std::abs(facing) > 0.02) {
                    EXPECT_EQ(seen[f], facing > 0) << "face " << f << " " << facing << " from " << view;
                }
            }
            EXPECT_GT(count, mesh.number_of_faces() / 4);
            EXPECT_LE(count, mesh.number_of_faces() * 11 / 20);
            const auto through = faces_seen(mesh, camera, all, nullptr);
            EXPECT_EQ(static_cast<std::size_t>(std::count(through.begin(), through.end(), true)), mesh.number_of_faces());
        }
}

TEST(Screen, OneSphereHidesAnother) {
    const Mesh mesh = spheres(3, {{0, 0, 0}, {0, 5, 0}});
    const Index half = static_cast<Index>(mesh.number_of_faces() / 2);
    const auto visible = select("region", drawn(R"({"view": "front"})", "[0, 0]", "[1200, 900]"), mesh).faces;
    EXPECT_LT(visible.back(), half);
    const auto behind = select("region", drawn(R"({"view": "back"})", "[0, 0]", "[1200, 900]"), mesh).faces;
    EXPECT_GE(behind.front(), half);
    EXPECT_EQ(
        select("region", drawn(R"({"view": "front"})", "[0, 0]", "[1200, 900]", R"(, "visible": false)"), mesh).faces.size(),
        mesh.number_of_faces());
}

TEST(Screen, AnIndependentRayTestAgreesOnASyntheticObject) {
    MakeOptions options;
    options.vertices = 6000;
    compare_with_brute_force(make_mesh(synthetic_object("teapot"), options).mesh);
}

TEST(Screen, AnIndependentRayTestAgreesOnAScan) {
    OSTRAKA_SCAN(mesh, "lion-head.off");
    compare_with_brute_force(mesh);
}

TEST(Screen, APixelOfAPictureSelectsTheVisibleElement) {
    MakeOptions make;
    make.vertices = 4000;
    const Mesh mesh = make_mesh(synthetic_object("teapot"), make).mesh;
    const SurfaceSearch search(mesh);
    const std::array<Rgb, 3> palette{Rgb{255, 0, 0}, Rgb{0, 255, 0}, Rgb{0, 0, 255}};
    Scene scene;
    scene.mesh = to_soup(mesh);
    for (const Face f : mesh.faces()) scene.face_colours.push_back(palette[(f.idx() / 7) % 3]);
    for (const bool perspective : {false, true})
        for (const char* view : {"30,20", "200,-35"}) {
            RenderOptions options;
            options.size = "360x300";
            options.view = view;
            options.projection = perspective ? RenderOptions::Projection::perspective : RenderOptions::Projection::orthographic;
            options.samples = 1;
            const Rendering rendering = render({scene}, options);
            const PictureCamera drawn_by = rendering.panes[0].camera, camera = camera_of(mesh, view, perspective, 360, 300);
            EXPECT_EQ(drawn_by.centre, camera.centre);
            EXPECT_EQ(drawn_by.scale, camera.scale);
            EXPECT_EQ(drawn_by.distance, camera.distance);
            std::size_t compared = 0, different = 0, surface = 0;
            for (int y = 0; y < rendering.panes[0].height; ++y)
                for (int x = 0; x < 360; ++x) {
                    const auto hit = seen_at(search, camera, {x + 0.5, y + 0.5});
                    const std::uint32_t argb = rendering.picture.at(x, y);
                    const int red = argb >> 16 & 255, green = argb >> 8 & 255, blue = argb & 255;
                    ++compared;
                    if (red == green && green == blue) {  // the background, or too dark to classify
                        different += hit.has_value() && red > 200;
                        continue;
                    }
                    ++surface;
                    const int shown = red > green && red > blue ? 0 : green > blue ? 1 : 2;
                    different += !hit || static_cast<int>((hit->face / 7) % 3) != shown;
                    if (hit) {
                        const auto back = camera.project(hit->point);
                        EXPECT_NEAR((*back)[0], x + 0.5, 1e-6);
                        EXPECT_NEAR((*back)[1], y + 0.5, 1e-6);
                    }
                }
            EXPECT_GT(surface, compared / 5);
            EXPECT_LE(different, compared / 2000) << "rays along edges may go either way";
        }
}

TEST(Screen, TheEyeCanBeSpecified) {
    const Mesh mesh = spheres(4);
    const std::string camera =
        R"({"eye": [0, -10, 0], "target": [0, 0, 0], "projection": "perspective", "angle": 30, "picture": [400, 400],
                                  "pane": [0, 0, 400, 400]})";
    // The middle pixel sees the nearest point.
    const auto point = select("point", R"({"vertices": [{"camera": )" + camera + R"(, "pixel": [200, 200]}]})", mesh).points;
    EXPECT_EQ(mesh.point(Vertex(point.at(0))), Point(0, -1, 0));
    // Seen from ten radii, a cap up to the height 1 / 10 is visible: 0.45 of the sphere's area.
    const auto cap = select("region", drawn(camera, "[0, 0]", "[400, 400]"), mesh).faces;
    EXPECT_NEAR(measure_region(mesh, cap).area / surface_area(mesh), 0.45, 0.02);
    // The camera that a picture reports is that of its view.
    const PictureCamera fitted = camera_of(mesh, "30,20", true);
    std::ostringstream text;
    text.precision(17);
    const Point eye = *fitted.eye();
    text << R"({"eye": [)" << eye.x() << "," << eye.y() << "," << eye.z() << R"(], "target": [)" << fitted.centre.x() << ","
         << fitted.centre.y() << "," << fitted.centre.z() << R"(], "projection": "perspective", "pixelsPerUnit": )"
         << fitted.scale << "}";
    EXPECT_EQ(select("region", drawn(text.str(), "[400, 300]", "[800, 500]"), mesh).faces,
              select("region", drawn(R"({"projection": "perspective"})", "[400, 300]", "[800, 500]"), mesh).faces);
}

TEST(Screen, ErrorsNameTheProblem) {
    const Mesh mesh = spheres(3);
    const std::string front = R"({"view": "front"})";
    expect_error(drawn(front, "[1300, 0]", "[1400, 100]"), mesh, "/rectangle", "outside the picture");
    expect_error(drawn(front, "[300, 0]", "[300, 100]"), mesh, "/rectangle", "no area");
    expect_error(drawn(front, "[0, 0]", "[5, 5]"), mesh, "", "selects no face");
    expect_error(drawn(front, "[0, 0]", "[5, 5]"), mesh, "", "selects no vertex", "point");
    expect_error(drawn(R"({"view": "sideways"})", "[0, 0]", "[5, 5]"), mesh, "/rectangle/camera", "sideways");
    expect_error(drawn("\"nobody\"", "[0, 0]", "[5, 5]"), mesh, "/rectangle/camera", "nobody");
    expect_error(
        drawn(R"({"eye": [0, 0.5, 0], "target": [0, 9, 0], "projection": "perspective", "angle": 40})", "[0, 0]", "[5, 5]"), mesh,
        "/rectangle/camera", "inside the object");
    expect_error(
        drawn(R"({"eye": [0, 5, 0], "target": [0, 9, 0], "projection": "perspective", "angle": 40})", "[0, 0]", "[5, 5]"), mesh,
        "/rectangle/camera", "behind the camera");
    expect_error(drawn(R"({"eye": [0, 5, 0], "target": [0, 5, 0], "pixelsPerUnit": 4})", "[0, 0]", "[5, 5]"), mesh,
                 "/rectangle/camera", "at the target");
    expect_error(drawn(R"({"eye": [0, 0, 5], "target": [0, 0, 0], "pixelsPerUnit": 4})", "[0, 0]", "[5, 5]"), mesh,
                 "/rectangle/camera", "along the view");
    expect_error(drawn(R"({"eye": [0, 5, 0]})", "[0, 0]", "[5, 5]"), mesh, "/rectangle/camera", "without a target");
    expect_error(drawn(R"({"view": "front", "angle": 5})", "[0, 0]", "[5, 5]"), mesh, "/rectangle/camera", "without an eye");
    expect_error(R"({"polygon": {"camera": {"view": "front"}, "points": [[400, 300], [700, 600], [700, 300], [400, 600]]}})",
                 mesh, "/polygon", "points 0 and 2 meet at pixel (550, 450)");
    expect_error(R"({"polygon": {"camera": {"view": "front"}, "points": [[400, 300], [700, 600], [400, 300]]}})", mesh,
                 "/polygon", "2 different points");
    expect_error(R"({"polygon": {"camera": {"view": "front"}, "points": [[400, 300], [500, 300], [600, 300]]}})", mesh,
                 "/polygon", "no area");
    expect_error(R"({"vertices": [{"camera": {"view": "front"}, "pixel": [3, 3]}]})", mesh, "/vertices/0/pixel", "background",
                 "point");
    expect_error(R"({"vertices": [{"camera": {"view": "front"}, "pixel": [-3, 3]}]})", mesh, "/vertices/0/pixel",
                 "outside the picture", "point");
}

TEST(Screen, ThePlaceAndScaleOfTheObjectDoNotMatter) {
    const Mesh ball = spheres(3);
    const auto moved = [&](double scale, const std::array<double, 3>& by) {
        TriangleSoup soup = to_soup(ball);
        for (auto& p : soup.points)
            for (std::size_t k = 0; k < 3; ++k) p[k] = p[k] * scale + by[k];
        return build_mesh(soup);
    };
    for (const char* projection : {"orthographic", "perspective"}) {
        const std::string expression =
            drawn(R"({"view": "37,23", "projection": ")" + std::string(projection) + "\"}", "[431.3, 211.7]", "[777.9, 640.1]");
        const auto expected = faces_of(expression, ball);
        EXPECT_GT(expected.size(), 20U);
        EXPECT_EQ(faces_of(expression, moved(1e-9, {0, 0, 0})), expected);
        EXPECT_EQ(faces_of(expression, moved(1e9, {0, 0, 0})), expected);
        EXPECT_EQ(faces_of(expression, moved(1, {1e5, -2e5, 3e5})), expected);
    }
}

TEST(Screen, MeshesWithFewVisibleElements) {
    TriangleSoup soup;
    const std::string everything = drawn(R"({"view": "top"})", "[0, 0]", "[1200, 900]");
    expect_error(everything, build_mesh(soup), "/rectangle/camera", "no vertices");
    soup.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    soup.triangles = {{0, 1, 2}};
    EXPECT_EQ(faces_of(everything, build_mesh(soup)), std::vector<Index>{0});
    EXPECT_EQ(select("point", everything, build_mesh(soup)).points, (std::vector<Index>{0, 1, 2}));
    soup.points[2] = {2, 0, 0};  // without area
    expect_error(everything, build_mesh(soup), "/rectangle", "no face with an area");
    // Two coincident sheets hide each other, so that nothing is selected.
    soup.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    soup.triangles = {{0, 1, 2}, {3, 4, 5}};
    expect_error(everything, build_mesh(soup), "", "selects no face");
}
