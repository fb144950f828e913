#include "../../src/geom/face_tree.h"

#include "meshes.h"
#include "ostraka/execution/parallel.h"

#include <CGAL/Intersections_3/Segment_3_Triangle_3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// Brute force over all faces, with exact predicates.
std::vector<Index> met_one_by_one(const Mesh& mesh, const Point& p, const Point& q) {
    std::vector<Index> faces;
    for (const Face f : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, f);
        const Kernel::Triangle_3 triangle(mesh.point(a), mesh.point(b), mesh.point(c));
        if (triangle.is_degenerate()) continue;
        if (p == q ? triangle.has_on(p) : CGAL::do_intersect(Kernel::Segment_3(p, q), triangle)) faces.push_back(f);
    }
    return faces;
}

/// Segments of every kind around a mesh.
class SegmentMaker {
public:
    explicit SegmentMaker(const Mesh& mesh) : mesh_(mesh), box_(bounding_box(mesh)), diagonal_(box_diagonal(mesh)) {}

    static constexpr int kinds = 14;
    std::pair<Point, Point> make(int kind) {
        const Face face(static_cast<Index>(random_() % mesh_.number_of_faces()));
        const auto [u, v, w] = corners(mesh_, face);
        const Point &a = mesh_.point(u), &b = mesh_.point(v), &c = mesh_.point(w);
        const Point middle = centroid(mesh_, face);
        const Vector step = diagonal_ * Vector(uniform(), uniform(), uniform());
        switch (kind) {
            case 0:
                return {anywhere(), anywhere()};
            case 1:
                return {a, b};
            case 2:
                return {a, a + (b - a) * uniform()};
            case 3:
                return {a - step, a + step};
            case 4:
                return axis_parallel(a);
            case 5:
                return axis_parallel(middle);
            case 6:
                return {CGAL::midpoint(a, b), CGAL::midpoint(a, c)};
            case 7:
                return {b + (b - c), c + (c - b)};
            case 8:
                return {a, a};
            case 9:
                return {CGAL::midpoint(a, b), CGAL::midpoint(a, b)};
            case 10:
                return {middle, middle};
            case 11:
                return {middle - 1e7 * step, middle + 1e7 * step};
            case 12:
                return {middle - 1e12 * step, middle + 1e12 * step};
            default: {
                const auto [from, to] = axis_parallel(a);
                return {from, to + Vector(1e-320, 0, -1e-300)};
            }
        }
    }

private:
    double uniform() { return distribution_(random_); }
    Point anywhere() {
        const Point centre(0.5 * (box_.xmin() + box_.xmax()), 0.5 * (box_.ymin() + box_.ymax()),
                           0.5 * (box_.zmin() + box_.zmax()));
        return centre + 0.8 * diagonal_ * Vector(uniform(), uniform(), uniform());
    }
    std::pair<Point, Point> axis_parallel(const Point& through) {
        double from[3] = {through.x(), through.y(), through.z()}, to[3] = {from[0], from[1], from[2]};
        const std::size_t k = random_() % 3;
        from[k] -= diagonal_ * (0.3 + uniform());
        to[k] += diagonal_ * (0.3 + uniform());
        return {Point(from[0], from[1], from[2]), Point(to[0], to[1], to[2])};
    }

    const Mesh& mesh_;
    CGAL::Bbox_3 box_;
    double diagonal_;
    std::mt19937_64 random_{17};
    std::uniform_real_distribution<double> distribution_{-1, 1};
};

std::vector<Named> group_of_all_sizes() {
    std::vector<Named> list = group();
    TriangleSoup flat = patch(20, 20);
    for (auto& p : flat.points) p[2] = 0.25;
    list.push_back({"flat", flat});
    list.push_back({"very tiny", moved(torus(24, 12), 1e-45, {0, 0, 0})});
    list.push_back({"very huge", moved(torus(24, 12), 1e45, {0, 0, 0})});
    list.push_back({"one triangle", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}});
    TriangleSoup needles = patch(12, 12);
    for (std::size_t i = 0; i < needles.points.size(); i += 5) needles.points[i] = needles.points[i + 1];
    list.push_back({"with faces without area", needles});
    return list;
}

}  // namespace

TEST(FaceTree, HitFacesEqualBruteForce) {
    for (const auto& [name, soup] : group_of_all_sizes()) {
        const Mesh mesh = build_mesh(soup);
        const FaceTree tree(mesh);
        SegmentMaker segments(mesh);
        std::size_t met_some = 0;
        for (int i = 0; i < 12 * SegmentMaker::kinds; ++i) {
            const int kind = i % SegmentMaker::kinds;
            const auto [from, to] = segments.make(kind);
            std::vector<Index> faces = tree.met(from, to);
            std::sort(faces.begin(), faces.end());
            ASSERT_EQ(faces, met_one_by_one(mesh, from, to)) << name << ", kind " << kind << ", number " << i;
            met_some += !faces.empty();
            EXPECT_EQ(tree.meets(from, to, [](Index) { return false; }), !faces.empty()) << name;
            EXPECT_FALSE(tree.meets(from, to, [&](Index f) { return std::binary_search(faces.begin(), faces.end(), f); }));
            if (faces.size() > 1) {
                EXPECT_TRUE(tree.meets(from, to, [&](Index f) { return f == faces.back(); })) << name;
            }
        }
        EXPECT_GT(met_some, 12U * 7) << name;
    }
}

TEST(FaceTree, IsTheSameForAnyNumberOfThreads) {
    const Mesh mesh = build_mesh(joined(torus(500, 250), moved(octahedron_sphere(5), 1e-3, {40, 3, 2})));
    std::vector<std::vector<Index>> met;
    std::vector<std::optional<SurfaceHit>> nearest;
    double area = 0;
    for (const int thread_count : {1, 2, 5}) {
        set_threads(thread_count);
        const FaceTree tree(mesh);
        set_threads(0);
        EXPECT_EQ(tree.size(), mesh.number_of_faces());
        SegmentMaker segments(mesh);
        for (std::size_t i = 0; i < 400; ++i) {
            const auto [from, to] = segments.make(static_cast<int>(i) % SegmentMaker::kinds);
            const auto faces = tree.met(from, to);  // their order depends on the tree's structure
            const auto hit = tree.closest(from, Vector(0, 0, 1), 0.2, 3);
            if (thread_count == 1) {
                met.push_back(faces);
                nearest.push_back(hit);
                area = tree.area();
                continue;
            }
            EXPECT_EQ(faces, met[i]);
            ASSERT_EQ(hit.has_value(), nearest[i].has_value());
            if (!hit) continue;
            EXPECT_EQ(hit->face, nearest[i]->face);
            EXPECT_EQ(hit->point, nearest[i]->point);
        }
        EXPECT_EQ(tree.area(), area);
    }
    EXPECT_NEAR(area, surface_area(mesh), 1e-9 * area);
}

TEST(FaceTree, ManyFacesInOnePlace) {
    // All codes are equal: the tree is built by halving.
    TriangleSoup soup = octahedron_sphere(0);
    for (Index i = 1; i < 400; ++i) soup = joined(std::move(soup), octahedron_sphere(0));
    const Mesh mesh = build_mesh(soup);
    const FaceTree tree(mesh);
    EXPECT_EQ(tree.met(Point(0.3, 0.2, 3), Point(0.3, 0.2, -3)).size(), 800U);
    const auto hit = tree.closest(Point(1, 1, 1), Vector(0, 0, 0), -1, 10);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->face, 0U) << "the lowest of equally near ones";
}
