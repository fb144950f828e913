// Limits of simplification, and refused input.
#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/remesh/simplify.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

SimplifyResult down_to(Mesh& mesh, std::uint64_t vertices, const std::string& outlines = "follow",
                       const MarkedParts& marked = {}) {
    SimplifyOptions options;
    options.vertices = vertices;
    set_option(options, "outlines", outlines);
    return simplify(mesh, options, marked);
}

const TriangleSoup triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
const TriangleSoup tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};

}  // namespace

TEST(SimplifyLimits, SmallestMeshesAreUnchanged) {
    for (const TriangleSoup& soup : {triangle, tetrahedron}) {
        Mesh mesh = build_mesh(soup);
        const SimplifyResult result = down_to(mesh, 2);
        EXPECT_FALSE(result.reached);
        EXPECT_FALSE(result.stop_reason.empty());
        EXPECT_EQ(mesh.number_of_vertices(), soup.points.size());
        EXPECT_EQ(mesh_checksum(mesh), mesh_checksum(build_mesh(soup)));
    }
}

// Closed surfaces of genus zero go down to a tetrahedron-like mesh of few vertices, a torus needs seven (Moebius); no topology is
// ever lost.
TEST(SimplifyLimits, TopologyIsAlwaysPreserved) {
    for (const auto& [name, soup] : group()) {
        SCOPED_TRACE(name);
        Mesh mesh = build_mesh(soup);
        const long euler = euler_number(mesh);
        const std::size_t loops = border_loops(mesh), parts = components(mesh);
        down_to(mesh, 3);
        EXPECT_TRUE(is_sound(mesh));
        EXPECT_EQ(euler_number(mesh), euler);
        EXPECT_EQ(border_loops(mesh), loops);
        EXPECT_EQ(components(mesh), parts);
        EXPECT_LT(mesh.number_of_vertices(), 60u);
    }
}

TEST(SimplifyLimits, TheSameNumberChangesNothing) {
    const Mesh original = build_mesh(torus(20, 10));
    Mesh mesh = original;
    const SimplifyResult result = down_to(mesh, 200);
    EXPECT_TRUE(result.reached);
    EXPECT_EQ(result.collapses, 0u);
    EXPECT_EQ(mesh_checksum(mesh), mesh_checksum(original));
}

TEST(SimplifyLimits, FlatMeshesStayFlatWithTheirBorder) {
    Mesh mesh = build_mesh(grid(30, 20, false, false, [](double u, double v) { return std::array<double, 3>{3 * u, 2 * v, 7}; }));
    const SimplifyResult result = down_to(mesh, 40);
    EXPECT_TRUE(result.reached) << result.stop_reason;
    EXPECT_NEAR(surface_area(mesh), 6, 1e-3);
    for (const Vertex v : mesh.vertices()) EXPECT_NEAR(mesh.point(v).z(), 7, 1e-9);
    for (const Face f : mesh.faces()) EXPECT_GT(area_vector(mesh, f).z(), 0);  // none flipped
}

// Faces without area, as from duplicate positions, neither stop nor affect the simplification.
TEST(SimplifyLimits, FlatFacesAndDuplicatePositions) {
    TriangleSoup soup = torus(40, 20);
    for (std::size_t i = 0; i + 1 < soup.points.size(); i += 37) soup.points[i + 1] = soup.points[i];
    Mesh mesh = build_mesh(soup);
    EXPECT_TRUE(down_to(mesh, 150).reached);
    EXPECT_TRUE(is_sound(mesh));
    EXPECT_EQ(euler_number(mesh), 0);
    Mesh point = build_mesh(moved(octahedron_sphere(2), 0, {1, 2, 3}));  // all vertices coincide
    EXPECT_FALSE(down_to(point, 10).reached);
}

TEST(SimplifyLimits, IsolatedVerticesAreDroppedAndCounted) {
    TriangleSoup soup = octahedron_sphere(3);
    soup.points.insert(soup.points.begin() + 5, {9, 9, 9});
    for (auto& t : soup.triangles)
        for (Index& v : t) v += v >= 5;
    Mesh mesh = build_mesh(soup);
    const SimplifyResult result = down_to(mesh, 100);
    EXPECT_TRUE(result.reached);
    EXPECT_EQ(mesh.number_of_vertices(), 100u);
    EXPECT_EQ(result.isolated_dropped, 1u);
    EXPECT_EQ(result.vertex_map[5], no_index);
    EXPECT_TRUE(is_sound(mesh));
}

// A hundred small regions on a sphere: with forty vertices their outlines cannot all stay.
TEST(SimplifyLimits, OutlinesAreBrokenOnlyWhenFollowed) {
    Mesh mesh = build_mesh(octahedron_sphere(5));
    MarkedParts marked{std::vector<bool>(mesh.number_of_edges(), false), {}};
    for (Index f = 0; f < mesh.number_of_faces(); f += 80)
        for (const Halfedge h : CGAL::halfedges_around_face(mesh.halfedge(Face(f)), mesh)) marked.edges[mesh.edge(h)] = true;
    Mesh followed = mesh;
    const SimplifyResult followed_result = down_to(followed, 40, "follow", marked);
    EXPECT_TRUE(followed_result.reached) << followed_result.stop_reason;
    EXPECT_TRUE(followed_result.outlines_broken);
    EXPECT_TRUE(is_sound(followed));
    Mesh protected_mesh = mesh;
    const SimplifyResult protected_result = down_to(protected_mesh, 40, "protect", marked);
    EXPECT_FALSE(protected_result.reached);
    EXPECT_FALSE(protected_result.outlines_broken);
    EXPECT_NE(protected_result.stop_reason.find("protected"), std::string::npos) << protected_result.stop_reason;
    Mesh ignored = mesh;
    EXPECT_TRUE(down_to(ignored, 40, "ignore", marked).reached);
}

TEST(SimplifyLimits, VisitorSeesEveryMerge) {
    struct Counter : CollapseVisitor {
        std::size_t vertices = 0, edges = 0;
        void merge_vertices(Mesh& mesh, Vertex kept, Vertex removed) override {
            vertices += !mesh.is_removed(kept) && !mesh.is_removed(removed);
        }
        void merge_edges(Mesh& mesh, Edge kept, Edge removed) override {
            edges += !mesh.is_removed(kept) && !mesh.is_removed(removed);
        }
    } counter;
    Mesh mesh = build_mesh(octahedron_sphere(3));
    const std::size_t vertices = mesh.number_of_vertices(), edges = mesh.number_of_edges();
    SimplifyOptions options;
    options.vertices = 50;
    const SimplifyResult result = simplify(mesh, options, {}, &counter);
    EXPECT_EQ(counter.vertices, result.collapses);
    EXPECT_EQ(vertices - mesh.number_of_vertices(), result.collapses);
    EXPECT_EQ(counter.edges, 2 * result.collapses);
    EXPECT_EQ(edges - mesh.number_of_edges(), 3 * result.collapses);
}

TEST(SimplifyLimits, InvalidRequests) {
    const Mesh original = build_mesh(octahedron_sphere(2));
    const auto kind_of = [&](const SimplifyOptions& options, const MarkedParts& marked = {}) {
        Mesh mesh = original;
        try {
            simplify(mesh, options, marked);
        } catch (const Error& error) {
            EXPECT_EQ(mesh_checksum(mesh), mesh_checksum(original));
            return int(error.kind());
        }
        return -1;
    };
    const int usage = int(ErrorKind::usage);
    SimplifyOptions options;
    EXPECT_EQ(kind_of(options), usage);
    options.vertices = 67;  // one more than there are
    EXPECT_EQ(kind_of(options), usage);
    options.vertices = 30;
    EXPECT_EQ(kind_of(options, {{true, false}, {}}), usage);
    EXPECT_EQ(kind_of(options, {{}, {true}}), usage);
    EXPECT_THROW(set_option(options, "method", "fast"), Error);
    options.max_normal_change = 120;
    EXPECT_EQ(kind_of(options), usage);
    options.max_normal_change = 60;
    EXPECT_EQ(kind_of(options), -1);
    Mesh empty_mesh;
    EXPECT_THROW(simplify(empty_mesh, options), Error);
}

// A vertex with thousands of neighbours, in a disc and at the tips of a double cone.
TEST(SimplifyLimits, VerticesOfHighValence) {
    constexpr Index n = 6000;
    for (const bool closed : {false, true}) {
        TriangleSoup soup;
        for (Index i = 0; i < n; ++i) soup.points.push_back({std::cos(2 * M_PI * i / n), std::sin(2 * M_PI * i / n), 0});
        soup.points.push_back({0, 0, closed ? 1.0 : 0.0});
        soup.points.push_back({0, 0, -1});
        for (Index i = 0; i < n; ++i) {
            soup.triangles.push_back({i, (i + 1) % n, n});
            if (closed) soup.triangles.push_back({(i + 1) % n, i, n + 1});
        }
        if (!closed) soup.points.pop_back();
        Mesh mesh = build_mesh(soup);
        const double area = surface_area(mesh);
        const SimplifyResult result = down_to(mesh, 60);
        EXPECT_TRUE(result.reached) << result.stop_reason;
        EXPECT_TRUE(is_sound(mesh));
        EXPECT_NEAR(surface_area(mesh) / area, 1, 0.01);
    }
}

// With both metrics the vertices of a simplified sphere are close to the sphere.
TEST(SimplifyLimits, VolumeOfASphere) {
    for (const char* method : {"qem", "lindstrom-turk"}) {
        Mesh mesh = build_mesh(octahedron_sphere(6));
        SimplifyOptions options;
        options.vertices = 500;
        set_option(options, "method", method);
        simplify(mesh, options);
        EXPECT_NEAR(volume(mesh), 4 * M_PI / 3, 0.01 * 4 * M_PI / 3) << method;
        for (const Vertex v : mesh.vertices()) EXPECT_NEAR(std::sqrt((mesh.point(v) - CGAL::ORIGIN).squared_length()), 1, 0.02);
    }
}
