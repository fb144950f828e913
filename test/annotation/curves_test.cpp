// Free annotations: curves through the faces.
#include "ostraka/annotation/curves.h"
#include "meshes.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/cut_extras.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/surface_search.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace ostraka;
using namespace ostraka::test;

namespace {

constexpr double pi = std::numbers::pi;

/// The closed curve through the nearest surface points of given points, counter-clockwise seen from outside.
std::vector<SurfacePoint> drawn(const Mesh& mesh, const SurfaceSearch& search, const std::vector<Point>& points) {
    std::vector<SurfacePoint> places;
    const auto node_of = [&](const Point& p) {
        const SurfaceHit hit = search.closest(p);
        return surface_point(mesh, hit.face, hit.barycentric);
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
        const SurfacePoint a = node_of(points[i]), b = node_of(points[(i + 1) % points.size()]);
        const SurfaceHit hit = search.closest(points[i]);
        const auto line = trace_line(mesh, a, b, search.normal(hit.face), 10);
        EXPECT_TRUE(line);
        if (!line) return {};
        for (std::size_t k = i == 0 ? 0 : 1; k < line->points.size(); ++k)
            if (places.empty() || places.back() != stored_point(mesh, line->points[k]))
                places.push_back(stored_point(mesh, line->points[k]));
    }
    return places;
}

/// A circle on the unit sphere at an angle from an axis not aligned with the mesh.
std::vector<Point> circle(double angle, int n, const Point& centre = Point(0, 0, 0)) {
    const Vector axis(0.36, 0.48, 0.8), u(0.8, -0.6, 0), v = CGAL::cross_product(axis, u);
    std::vector<Point> points;
    for (int i = 0; i < n; ++i) {
        const double t = 2 * pi * i / n;
        points.push_back(centre + std::cos(angle) * axis + std::sin(angle) * (std::cos(t) * u + std::sin(t) * v));
    }
    return points;
}

Annotation region(const Mesh& mesh, std::vector<std::vector<SurfacePoint>> curves) {
    Annotation annotation;
    annotation.tag = "cap";
    annotation.curves = std::move(curves);
    compute_elements(mesh, annotation);
    return annotation;
}

}  // namespace

TEST(FreeOutline, CircleOnASphereIsOfSecondOrder) {
    std::vector<double> off_area, off_perimeter;
    for (const int levels : {3, 4, 5, 6}) {
        const Mesh mesh = build_mesh(octahedron_sphere(levels));
        const SurfaceSearch search(mesh);
        const double angle = 0.7;
        const Annotation cap = region(mesh, {drawn(mesh, search, circle(angle, 40 << levels))});
        const RegionMeasures measures = measure_region(mesh, cap);
        // Of the area of the mesh itself, which is less than the sphere's.
        off_area.push_back(std::abs(measures.area / (2 * pi * (1 - std::cos(angle))) - 1));
        off_perimeter.push_back(std::abs(measures.perimeter / (2 * pi * std::sin(angle)) - 1));
    }
    for (std::size_t i = 0; i + 1 < off_area.size(); ++i) {
        EXPECT_LT(off_area[i + 1], off_area[i] / 3) << i;
        EXPECT_LT(off_perimeter[i + 1], off_perimeter[i] / 3) << i;
    }
    EXPECT_LT(off_perimeter.back(), 1e-3);
}

TEST(FreeOutline, InsideAndOutsidePartitionTheMesh) {
    for (const Vector& shift : {Vector(0, 0, 0), Vector(1e6, -2e6, 3e6)})
        for (const double size : {1.0, 1e-6, 1e6}) {
            const Mesh unit = build_mesh(octahedron_sphere(4));
            TriangleSoup soup = to_soup(unit);
            const SurfaceSearch unit_search(unit);
            const std::vector<SurfacePoint> curve = drawn(unit, unit_search, circle(1.1, 300));
            for (auto& p : soup.points)
                p = {p[0] * size + shift.x() * size, p[1] * size + shift.y() * size, p[2] * size + shift.z() * size};
            const Mesh mesh = build_mesh(soup);
            const Annotation cap = region(mesh, {curve}),
                             rest = region(mesh, {std::vector<SurfacePoint>(curve.rbegin(), curve.rend())});
            EXPECT_NEAR((area_of(mesh, cap) + area_of(mesh, rest)) / surface_area(mesh), 1, 1e-8);
            EXPECT_NEAR(measure_region(mesh, cap).perimeter / measure_region(mesh, rest).perimeter, 1, 1e-12);
            const CurveFilling filling = filling_of(mesh, cap);
            EXPECT_EQ(filling.conflicts, 0U);
            for (const auto& [face, share] : filling.cut) {
                EXPECT_GT(share, 0);
                EXPECT_LT(share, 1);
            }
        }
}

TEST(FreeOutline, AlongEdgesTheRegionEqualsThatOfTheEdges) {
    const Mesh mesh = build_mesh(octahedron_sphere(3));
    std::vector<Index> faces;
    for (const Face f : mesh.faces())
        if (centroid(mesh, f).z() > 0.3) faces.push_back(f);
    const RegionMeasures expected = measure_region(mesh, faces);
    std::vector<std::vector<SurfacePoint>> curves;
    for (const Outline& outline : extract_outlines(mesh, faces)) {
        auto& curve = curves.emplace_back();
        for (std::size_t i = 0; i <= outline.size(); ++i) curve.push_back(vertex_point(outline[i % outline.size()]));
    }
    const Annotation annotation = region(mesh, curves);
    EXPECT_EQ(annotation.faces, faces);
    EXPECT_TRUE(filling_of(mesh, annotation).cut.empty());
    EXPECT_NEAR(measure_region(mesh, annotation).area, expected.area, 1e-12);
    EXPECT_NEAR(measure_region(mesh, annotation).perimeter, expected.perimeter, 1e-12);
}

TEST(FreeOutline, CutAndBroughtBackIsTheIdentity) {
    const Mesh mesh = build_mesh(octahedron_sphere(4));
    const SurfaceSearch search(mesh);
    AnnotationSet set;
    // Two overlapping annotations, one inside a single face, and one along edges.
    set.annotations.push_back(region(mesh, {drawn(mesh, search, circle(0.7, 200))}));
    set.annotations.push_back(region(mesh, {drawn(mesh, search, circle(1.2, 150))}));
    const auto corner = corners(mesh, Face(77));
    std::vector<SurfacePoint> small;
    for (const auto& [u, v] : {std::pair{0.2, 0.2}, {0.5, 0.2}, {0.2, 0.5}, {0.2, 0.2}})
        small.push_back(face_point(77, {1 - u - v, u, v}));
    set.annotations.push_back(region(mesh, {small}));
    EXPECT_TRUE(set.annotations.back().faces.empty());
    EXPECT_NEAR(area_of(mesh, set.annotations.back()) / face_area(mesh, Face(77)), 0.09, 1e-12);
    EXPECT_NEAR(measure_region(mesh, set.annotations.back()).perimeter,
                0.3 * (std::sqrt(CGAL::squared_distance(mesh.point(corner[0]), mesh.point(corner[1]))) +
                       std::sqrt(CGAL::squared_distance(mesh.point(corner[1]), mesh.point(corner[2]))) +
                       std::sqrt(CGAL::squared_distance(mesh.point(corner[2]), mesh.point(corner[0])))),
                1e-12);
    Annotation plain;
    plain.tag = "plain";
    plain.faces = {3, 4, 5, 100, 200};
    set.annotations.push_back(plain);
    for (std::size_t i = 0; i < set.annotations.size(); ++i) set.annotations[i].id = static_cast<int>(i);
    check_annotations({mesh, set}, "test");

    const CutMesh cut = cut_along_curves({mesh, set});
    check_annotations(cut, "cut");
    EXPECT_NEAR(surface_area(cut.mesh), surface_area(mesh), 1e-10);
    for (std::size_t i = 0; i < set.annotations.size(); ++i) {
        const RegionMeasures before = measure_region(mesh, set.annotations[i]),
                             after = measure_region(cut.mesh, cut.annotations.annotations[i].faces);
        EXPECT_NEAR(before.area, after.area, 1e-10) << i;
        EXPECT_NEAR(before.perimeter, after.perimeter, 1e-10) << i;
        Annotation back = cut.annotations.annotations[i];
        uncut_annotation(mesh, cut, back);
        EXPECT_NEAR(measure_region(mesh, back).area, before.area, 1e-10) << i;
        EXPECT_NEAR(measure_region(mesh, back).perimeter, before.perimeter, 1e-10) << i;
        EXPECT_EQ(back.faces, set.annotations[i].faces) << i;
        EXPECT_EQ(is_free(back), is_free(set.annotations[i])) << i;
    }
}

TEST(FreeOutline, FileRoundTripIsExact) {
    const Mesh mesh = build_mesh(octahedron_sphere(3));
    const SurfaceSearch search(mesh);
    AnnotationSet set;
    set.annotations.push_back(region(mesh, {drawn(mesh, search, circle(0.9, 100))}));
    Annotation line = set.annotations.front();
    line.id = 1;
    line.type = AnnotationType::line;
    line.curves.front().resize(20);
    line.faces.clear();
    compute_elements(mesh, line);
    set.annotations.push_back(line);
    Annotation point = line;
    point.id = 2;
    point.type = AnnotationType::point;
    point.polylines.clear();
    point.curves = {{line.curves.front()[3]}, {line.curves.front()[7]}};
    compute_elements(mesh, point);
    EXPECT_EQ(point.points.size(), 2U);
    set.annotations.push_back(point);
    const Json document = annotations_to_json({mesh, set}, "sphere.ply", {});
    EXPECT_EQ(document["version"].GetInt(), 2);
    const AnnotationSet read = annotations_from_json(document, mesh, "again");
    ASSERT_EQ(read.annotations.size(), 3U);
    EXPECT_TRUE(read.notes.empty());
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(read.annotations[i].curves, set.annotations[i].curves);
        EXPECT_EQ(read.annotations[i].faces, set.annotations[i].faces);
        EXPECT_EQ(read.annotations[i].polylines, set.annotations[i].polylines);
        EXPECT_EQ(read.annotations[i].points, set.annotations[i].points);
    }
    EXPECT_EQ(to_text(annotations_to_json({mesh, read}, "sphere.ply", {})), to_text(document));
}

TEST(FreeOutline, InvalidCurvesAreRefused) {
    const Mesh mesh = build_mesh(octahedron_sphere(3));
    const SurfaceSearch search(mesh);
    const std::vector<SurfacePoint> good = drawn(mesh, search, circle(0.9, 100));
    const auto refused = [&](std::vector<SurfacePoint> curve, const std::string& why) {
        Annotation annotation;
        annotation.tag = "cap";
        annotation.curves = {std::move(curve)};
        try {
            compute_elements(mesh, annotation);
            ADD_FAILURE() << why;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input);
            EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
            EXPECT_FALSE(error.remedy().empty());
        }
    };
    auto open = good;
    open.pop_back();
    refused(open, "does not close");
    auto gap = good;
    gap.erase(gap.begin() + 10, gap.begin() + 30);
    refused(gap, "no common face");
    auto beyond = good;
    beyond[5] = vertex_point(1000000);
    refused(beyond, "does not have");
    auto outside = good;
    for (SurfacePoint& place : outside)
        if (place.is_on_edge()) place.weights = {-0.5, 1.5, 0};
    refused(outside, "not within the edge");
    // Contradictory elements are corrected.
    AnnotationSet set;
    set.annotations.push_back(region(mesh, {good}));
    set.annotations.front().faces.pop_back();
    EXPECT_THROW(check_annotations({mesh, set}, "test"), Error);
}

TEST(FreeOutline, OnAnOpenMeshTheBorderCloses) {
    // A square with two triangles per cell; a curve across it from border to border.
    TriangleSoup soup;
    const int n = 8;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) soup.points.push_back({i / double(n), j / double(n), 0});
    const auto at = [&](int i, int j) { return static_cast<Index>(j * (n + 1) + i); };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            soup.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            soup.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    const Mesh mesh = build_mesh(soup);
    const SurfaceSearch search(mesh);
    const auto node = [&](double x, double y) {
        const SurfaceHit hit = search.closest(Point(x, y, 0));
        return surface_point(mesh, hit.face, hit.barycentric);
    };
    const auto line = trace_line(mesh, node(0.31, 0), node(0.77, 1), Vector(0, 0, 1), 10);
    ASSERT_TRUE(line);
    std::vector<SurfacePoint> curve;
    for (const SurfacePoint& point : line->points) curve.push_back(stored_point(mesh, point));
    const Annotation left = region(mesh, {curve});
    const double length = std::hypot(0.46, 1.0);
    EXPECT_NEAR(area_of(mesh, left), 0.54, 1e-9);
    EXPECT_NEAR(measure_region(mesh, left).perimeter, length + 1 + 0.31 + 0.77, 1e-9);
    std::reverse(curve.begin(), curve.end());
    const Annotation right = region(mesh, {curve});
    EXPECT_NEAR(area_of(mesh, right), 0.46, 1e-9);
    EXPECT_NEAR(measure_region(mesh, right).perimeter, length + 1 + 0.69 + 0.23, 1e-9);
    AnnotationSet set;
    set.annotations = {left, right};
    set.annotations[1].id = 1;
    const CutMesh cut = cut_along_curves({mesh, set});
    for (std::size_t i = 0; i < 2; ++i) {
        Annotation back = cut.annotations.annotations[i];
        EXPECT_NEAR(measure_region(cut.mesh, back.faces).perimeter, measure_region(mesh, set.annotations[i]).perimeter, 1e-9);
        uncut_annotation(mesh, cut, back);
        EXPECT_NEAR(measure_region(mesh, back).area, area_of(mesh, set.annotations[i]), 1e-9);
    }
}

TEST(CutExtras, TextureAndColoursStayWhereTheyWere) {
    AnnotatedMesh object;
    object.mesh = build_mesh(octahedron_sphere(4));
    const SurfaceSearch search(object.mesh);
    object.annotations.annotations.push_back(region(object.mesh, {drawn(object.mesh, search, circle(0.6, 40))}));
    MeshExtras extras;
    // Functions of the place: linear in each face, and different in the two halves of the sphere, as on both sides of a seam.
    const auto place_of = [](const Point& p, bool upper) {
        return TexturePoint{static_cast<float>(p.x() + (upper ? 3 : 0)), static_cast<float>(p.y() - p.z())};
    };
    const auto is_upper = [&](Index face) { return centroid(object.mesh, Face(face)).z() > 0; };
    for (const Face face : object.mesh.faces()) {
        extras.face_materials.push_back(is_upper(face.idx()) ? 1 : 0);
        extras.face_labels.push_back(static_cast<std::int32_t>(face.idx()));
        for (const Vertex v : corners(object.mesh, face))
            extras.corner_texture.push_back(place_of(object.mesh.point(v), is_upper(face.idx())));
    }
    for (const Vertex v : object.mesh.vertices()) {
        const double height = 100 + 100 * object.mesh.point(v).z();
        extras.vertex_colours.push_back({static_cast<std::uint8_t>(std::lround(height)), 10, 20, 255});
    }
    const CutMesh cut = cut_along_curves(object);
    ASSERT_GT(cut.mesh.number_of_vertices(), object.mesh.number_of_vertices());
    const MeshExtras of_cut = cut_extras(cut, object.mesh, extras);
    ASSERT_EQ(of_cut.corner_texture.size(), 3 * cut.mesh.number_of_faces());
    ASSERT_EQ(of_cut.vertex_colours.size(), cut.mesh.number_of_vertices());
    std::size_t corner = 0;
    for (const Face face : cut.mesh.faces()) {
        const Index origin = cut.face_origin[face.idx()];
        EXPECT_EQ(of_cut.face_materials[face.idx()], extras.face_materials[origin]);
        EXPECT_EQ(of_cut.face_labels[face.idx()], static_cast<std::int32_t>(origin));
        for (const Vertex v : corners(cut.mesh, face)) {
            const TexturePoint expected = place_of(cut.mesh.point(v), is_upper(origin));
            for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(of_cut.corner_texture[corner][k], expected[k], 1e-5);
            ++corner;
        }
    }
    for (const Vertex v : cut.mesh.vertices())
        EXPECT_NEAR(of_cut.vertex_colours[v.idx()][0], 100 + 100 * cut.mesh.point(v).z(), 1.1);
    for (std::size_t v = 0; v < extras.vertex_colours.size(); ++v) EXPECT_EQ(of_cut.vertex_colours[v], extras.vertex_colours[v]);
}
