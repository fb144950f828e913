// Smoothed borders for display: close to those of the labels, without steps, and without losing regions.
#include "ostraka/annotation/smooth_regions.h"
#include "meshes.h"
#include "ostraka/geom/chains.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// Faces with centroids above a plane: the border runs in steps.
std::vector<int> halves(const Mesh& mesh, const Vector& normal) {
    std::vector<int> labels;
    for (const Face face : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, face);
        labels.push_back((CGAL::centroid(mesh.point(a), mesh.point(b), mesh.point(c)) - CGAL::ORIGIN) * normal > 0.01 ? 7 : 3);
    }
    return labels;
}

double length_of(const std::vector<std::vector<Point>>& lines) {
    double length = 0;
    for (const auto& line : lines)
        for (std::size_t i = 1; i < line.size(); ++i) length += std::sqrt(CGAL::squared_distance(line[i - 1], line[i]));
    return length;
}

}  // namespace

TEST(SmoothRegions, TheBorderOfAHalfSphereIsNearlyACircle) {
    const Mesh mesh = build_mesh(octahedron_sphere(5));
    const Vector normal(0.48, 0.6, 0.64);
    const std::vector<int> labels = halves(mesh, normal);
    const SmoothRegions regions = smooth_regions(mesh, labels);
    ASSERT_EQ(regions.outlines.size(), 1U);
    EXPECT_EQ(regions.outlines[0].front(), regions.outlines[0].back()) << "closed";
    double steps = 0;  // along the edges
    for (const Edge edge : mesh.edges()) {
        const Halfedge h = mesh.halfedge(edge);
        if (labels[mesh.face(h).idx()] != labels[mesh.face(mesh.opposite(h)).idx()])
            steps += std::sqrt(CGAL::squared_distance(mesh.point(mesh.source(h)), mesh.point(mesh.target(h))));
    }
    const double length = length_of(regions.outlines);
    EXPECT_GT(steps, 1.2 * 6.2832);
    EXPECT_NEAR(length, 6.2832, 0.05 * 6.2832);
    for (const Point& p : regions.outlines[0]) EXPECT_NEAR((p - CGAL::ORIGIN) * normal, 0.01, 0.05);
    // In the middle of a face far from the border its own label is on top; weights sum to one.
    std::set<Index> mixed;
    for (std::size_t i = 0; i < regions.patches.size(); i += 2) {
        const auto &a = regions.patches[i], &b = regions.patches[i + 1];
        ASSERT_EQ(a.face, b.face);
        EXPECT_LT(a.label, b.label);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(a.weights[k] + b.weights[k], 1, 1e-5);
        mixed.insert(a.face);
    }
    for (const Face face : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, face);
        if (std::abs((CGAL::centroid(mesh.point(a), mesh.point(b), mesh.point(c)) - CGAL::ORIGIN) * normal) > 0.3) {
            EXPECT_FALSE(mixed.contains(face.idx()));
        }
    }
}

TEST(SmoothRegions, SmallRegionsKeepTheirFaces) {
    const Mesh mesh = build_mesh(octahedron_sphere(3));
    std::vector<int> labels(mesh.number_of_faces(), 1);
    labels[100] = 2;
    const SmoothRegions regions = smooth_regions(mesh, labels);
    EXPECT_TRUE(regions.patches.empty());
    ASSERT_EQ(regions.outlines.size(), 1U);
    EXPECT_EQ(regions.outlines[0].size(), 4U) << "its three edges, closed";
}

TEST(SmoothRegions, ThreeLabelsMeetInOnePointPerJunction) {
    const Mesh mesh = build_mesh(octahedron_sphere(4));
    std::vector<int> labels;
    for (const Face face : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, face);
        const Point p = CGAL::centroid(mesh.point(a), mesh.point(b), mesh.point(c));
        labels.push_back(std::atan2(p.y(), p.x()) < -1.3 ? -1 : std::atan2(p.y(), p.x()) < 0.8 ? 5 : 8);
    }
    const SmoothRegions regions = smooth_regions(mesh, labels);
    EXPECT_EQ(regions.outlines.size(), 3U) << "three meridians from pole to pole";
    std::map<std::array<double, 3>, int> ends;
    for (const auto& line : regions.outlines)
        for (const Point* p : {&line.front(), &line.back()}) ++ends[{p->x(), p->y(), p->z()}];
    EXPECT_EQ(ends.size(), 2U);
    for (const auto& [end, count] : ends) {
        SCOPED_TRACE(std::to_string(end[0]) + " " + std::to_string(end[1]) + " " + std::to_string(end[2]));
        EXPECT_EQ(count, 3);
        EXPECT_GT(std::abs(end[2]), 0.9);
    }
}

TEST(SmoothRegions, DegenerateMeshes) {
    EXPECT_TRUE(smooth_regions(Mesh(), {}).outlines.empty());
    TriangleSoup triangle;
    triangle.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle.triangles = {{0, 1, 2}};
    EXPECT_TRUE(smooth_regions(build_mesh(triangle), {4}).patches.empty());
    TriangleSoup flat;  // no area anywhere
    flat.points = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
    flat.triangles = {{0, 1, 2}, {0, 2, 3}};
    EXPECT_NO_THROW(smooth_regions(build_mesh(flat), {4, 5}));
}

TEST(Chains, JoinAtTwoNeighboursAndStopAtBranchings) {
    using Chain = std::vector<std::size_t>;
    EXPECT_TRUE(chains_of({}).empty());
    EXPECT_EQ(chains_of({{4, 7}, {7, 9}, {2, 4}}), (std::vector<Chain>{{9, 7, 4, 2}}));
    EXPECT_EQ(chains_of({{1, 2}, {2, 3}, {3, 1}}), (std::vector<Chain>{{1, 2, 3, 1}}));
    // Three regions that meet: each ends there.
    EXPECT_EQ(chains_of({{1, 0}, {2, 0}, {0, 3}}), (std::vector<Chain>{{1, 0}, {2, 0}, {0, 3}}));
}
