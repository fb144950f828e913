#include "ostraka/remesh/refine.h"

#include "meshes.h"
#include "ostraka/core/error.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

double edge_length(const Mesh& mesh, Vertex a, Vertex b) {
    return std::sqrt(CGAL::squared_distance(mesh.point(a), mesh.point(b)));
}

class EveryScheme : public testing::TestWithParam<std::string> {};

}  // namespace

TEST_P(EveryScheme, ReachesTheNumberAndKeepsTopologyAndShape) {
    for (const auto& [name, soup] : group()) {
        SCOPED_TRACE(name);
        Mesh mesh = build_mesh(soup);
        const Mesh original = mesh;
        RefineOptions options;
        options.vertices = soup.points.size() * 9 + 5;
        set_option(options, "scheme", GetParam());
        const RefineResult result = refine(mesh, options);
        EXPECT_EQ(mesh.number_of_vertices(), options.vertices);
        EXPECT_TRUE(is_sound(mesh));
        EXPECT_EQ(euler_number(mesh), euler_number(original));
        EXPECT_EQ(border_loops(mesh), border_loops(original));
        EXPECT_EQ(components(mesh), components(original));
        EXPECT_EQ(result.parents.size(), mesh.number_of_vertices() - result.old_vertices);
        ASSERT_EQ(result.face_origin.size(), mesh.number_of_faces());
        ASSERT_EQ(result.edge_origin.size(), mesh.number_of_edges());
        if (GetParam() == "loop") continue;  // moves the surface
        for (const Vertex v : original.vertices()) ASSERT_EQ(mesh.point(v), original.point(v));
        std::vector<double> area(original.number_of_faces(), 0);
        for (const Face f : mesh.faces()) area[result.face_origin[f]] += face_area(mesh, f);
        for (const Face f : original.faces()) ASSERT_NEAR(area[f] / face_area(original, f), 1, 1e-6);
        std::vector<double> length(original.number_of_edges(), 0);
        for (const Edge e : mesh.edges())
            if (result.edge_origin[e] != no_index)
                length[result.edge_origin[e]] += edge_length(mesh, mesh.vertex(e, 0), mesh.vertex(e, 1));
        for (const Edge e : original.edges())
            ASSERT_NEAR(length[e] / edge_length(original, original.vertex(e, 0), original.vertex(e, 1)), 1, 1e-7);
    }
}

TEST_P(EveryScheme, PropertiesAreCarried) {
    for (const auto& [name, soup] : group()) {
        SCOPED_TRACE(name);
        Mesh mesh = build_mesh(soup);
        auto label = mesh.add_property_map<Face, Index>("f:label", 77).first;
        auto mark = mesh.add_property_map<Edge, int>("e:mark", -1).first;
        auto point = mesh.add_property_map<Vertex, Index>("v:mark", 5).first;
        for (const Face f : mesh.faces()) label[f] = Index(f) % 13;
        for (const Edge e : mesh.edges()) mark[e] = int(Index(e) % 7);
        for (const Vertex v : mesh.vertices()) point[v] = v;
        RefineOptions options;
        options.vertices = soup.points.size() * 6;
        set_option(options, "scheme", GetParam());
        const RefineResult result = refine(mesh, options);
        for (const Face f : mesh.faces()) ASSERT_EQ(label[f], result.face_origin[f] % 13);
        for (const Edge e : mesh.edges())
            ASSERT_EQ(mark[e], result.edge_origin[e] == no_index ? -1 : int(result.edge_origin[e] % 7));
        for (const Vertex v : mesh.vertices()) ASSERT_EQ(point[v], Index(v) < result.old_vertices ? Index(v) : 5);
    }
}

TEST_P(EveryScheme, SmallestMeshes) {
    for (const TriangleSoup& soup :
         {TriangleSoup{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}},
          TriangleSoup{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}}}) {
        for (std::uint64_t target = soup.points.size(); target < 40; ++target) {
            Mesh mesh = build_mesh(soup);
            RefineOptions options;
            options.vertices = target;
            set_option(options, "scheme", GetParam());
            refine(mesh, options);
            EXPECT_EQ(mesh.number_of_vertices(), target);
            EXPECT_TRUE(is_sound(mesh));
        }
    }
}

TEST_P(EveryScheme, IsDeterministic) {
    Mesh first = build_mesh(torus(48, 24)), second = first;
    RefineOptions options;
    options.vertices = 20000;
    set_option(options, "scheme", GetParam());
    refine(first, options);
    refine(second, options);
    EXPECT_EQ(mesh_checksum(first), mesh_checksum(second));
}

INSTANTIATE_TEST_SUITE_P(Schemes, EveryScheme, testing::Values("midpoint", "loop", "longest-edge"), [](const auto& scheme) {
    return scheme.param == "longest-edge" ? std::string("LongestEdge") : scheme.param;
});

TEST(Refine, LevelsMultiplyFacesByFour) {
    for (const auto& [name, soup] : group()) {
        Mesh mesh = build_mesh(soup);
        RefineOptions options;
        options.levels = 2;
        const RefineResult result = refine(mesh, options);
        EXPECT_EQ(mesh.number_of_faces(), 16 * soup.triangles.size());
        EXPECT_TRUE(is_sound(mesh));
        EXPECT_EQ(result.levels, 2);
    }
}

// Loop's limit surface has continuous normals, so the octahedron's refinement rounds off: the angles between neighbouring faces
// decrease.
TEST(Refine, LoopSmooths) {
    Mesh mesh = build_mesh(octahedron_sphere(0));
    RefineOptions options;
    options.levels = 5;
    options.scheme = RefineOptions::Scheme::loop;
    refine(mesh, options);
    double minimum = 1;
    for (const Edge e : mesh.edges()) {
        const Vector a = area_vector(mesh, mesh.face(mesh.halfedge(e, 0))), b = area_vector(mesh, mesh.face(mesh.halfedge(e, 1)));
        minimum = std::min(minimum, a * b / std::sqrt(a.squared_length() * b.squared_length()));
    }
    EXPECT_GT(minimum, std::cos(0.15));
}

// A flat grid stays flat and keeps its border lines under Loop's rules.
TEST(Refine, LoopKeepsPlanes) {
    Mesh mesh = build_mesh(grid(6, 5, false, false, [](double u, double v) { return std::array<double, 3>{u, v, 2}; }));
    RefineOptions options;
    options.levels = 2;
    options.scheme = RefineOptions::Scheme::loop;
    refine(mesh, options);
    for (const Vertex v : mesh.vertices()) ASSERT_NEAR(mesh.point(v).z(), 2, 1e-12);
}

// Halving longest edges keeps every angle above half of the smallest one (Rivara).
TEST(Refine, HalvingKeepsAnglesBounded) {
    const auto smallest_angle = [](const Mesh& mesh) {
        double minimum = M_PI;
        for (const Face f : mesh.faces()) {
            const auto c = corners(mesh, f);
            for (int k = 0; k < 3; ++k) {
                const Vector a = mesh.point(c[(k + 1) % 3]) - mesh.point(c[k]), b = mesh.point(c[(k + 2) % 3]) - mesh.point(c[k]);
                minimum = std::min(minimum, std::atan2(std::sqrt(CGAL::cross_product(a, b).squared_length()), a * b));
            }
        }
        return minimum;
    };
    Mesh mesh = build_mesh(patch(7, 40));
    const double original_angle = smallest_angle(mesh);
    RefineOptions options;
    options.vertices = 20000;
    options.scheme = RefineOptions::Scheme::longest_edge;
    refine(mesh, options);
    EXPECT_GE(smallest_angle(mesh), 0.5 * original_angle * (1 - 1e-9));
}

TEST(Refine, InvalidRequests) {
    Mesh mesh = build_mesh(octahedron_sphere(2));
    const auto kind_of = [&](auto change) {
        RefineOptions options;
        try {
            change(options);
            Mesh copy = mesh;
            refine(copy, options);
        } catch (const Error& error) {
            return int(error.kind());
        }
        return -1;
    };
    const int usage = int(ErrorKind::usage);
    EXPECT_EQ(kind_of([](RefineOptions&) {}), usage);
    EXPECT_EQ(kind_of([](RefineOptions& o) { o.vertices = 100, o.levels = 1; }), usage);
    EXPECT_EQ(kind_of([](RefineOptions& o) { o.vertices = 10; }), usage);
    EXPECT_EQ(kind_of([](RefineOptions& o) { o.levels = 13; }), usage);
    EXPECT_EQ(kind_of([](RefineOptions& o) { o.levels = 12; }), usage);  // too many edges for 32 bits
    EXPECT_EQ(kind_of([](RefineOptions& o) { o.levels = 1, o.scheme = RefineOptions::Scheme::longest_edge; }), usage);
    EXPECT_EQ(kind_of([](RefineOptions& o) { set_option(o, "scheme", "butterfly"); }), usage);
    Mesh empty_mesh;
    RefineOptions options;
    options.levels = 1;
    EXPECT_THROW(refine(empty_mesh, options), Error);
    // All vertices coincide: no edge can be halved.
    Mesh point = build_mesh({{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}});
    options.levels = 0;
    options.vertices = 10;
    options.scheme = RefineOptions::Scheme::longest_edge;
    EXPECT_THROW(refine(point, options), Error);
}
