#include "ostraka/remesh/simplify.h"

#include "meshes.h"
#include "ostraka/core/error.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// Faces labelled by the octant of their centroid, seen from the box's centre.
Mesh::Property_map<Face, int> label_octants(Mesh& mesh) {
    auto label = mesh.add_property_map<Face, int>("f:label", -1).first;
    const CGAL::Bbox_3 box = bounding_box(mesh);
    for (const Face f : mesh.faces()) {
        const Point c = centroid(mesh, f);
        label[f] = (c.x() > (box.xmin() + box.xmax()) / 2) + 2 * (c.y() > (box.ymin() + box.ymax()) / 2);
    }
    return label;
}

std::vector<bool> label_outlines(const Mesh& mesh, const Mesh::Property_map<Face, int>& label) {
    std::vector<bool> marked(mesh.number_of_edges(), false);
    for (const Edge e : mesh.edges()) {
        const Face f = mesh.face(mesh.halfedge(e, 0)), g = mesh.face(mesh.halfedge(e, 1));
        marked[e] = f.is_valid() && g.is_valid() && label[f] != label[g];
    }
    return marked;
}

class EveryMesh : public testing::TestWithParam<std::string> {};

}  // namespace

TEST_P(EveryMesh, KeepsTopologyAndReachesTheNumber) {
    for (const auto& [name, soup] : group()) {
        SCOPED_TRACE(name);
        Mesh mesh = build_mesh(soup);
        const long euler = euler_number(mesh);
        const std::size_t loops = border_loops(mesh), parts = components(mesh);
        const double area = surface_area(mesh), enclosed = volume(mesh);
        const std::size_t face_count = mesh.number_of_faces();
        SimplifyOptions options;
        options.vertices = soup.points.size() / 4;
        set_option(options, "method", GetParam());
        const SimplifyResult result = simplify(mesh, options);
        EXPECT_TRUE(result.reached) << result.stop_reason;
        EXPECT_EQ(mesh.number_of_vertices(), options.vertices);
        EXPECT_TRUE(is_sound(mesh));
        EXPECT_EQ(euler_number(mesh), euler);
        EXPECT_EQ(border_loops(mesh), loops);
        EXPECT_EQ(components(mesh), parts);
        EXPECT_NEAR(surface_area(mesh) / area, 1, 0.02);
        if (loops == 0) {
            EXPECT_NEAR(volume(mesh) / enclosed, 1, 0.02);
        }
        // The maps are total and onto.
        EXPECT_EQ(result.face_map.size(), face_count);
        std::vector<int> vertex_hit(mesh.number_of_vertices(), 0), face_hit(mesh.number_of_faces(), 0);
        for (const Index v : result.vertex_map) ++vertex_hit.at(v);
        for (const Index f : result.face_map)
            if (f != no_index) ++face_hit.at(f);
        for (const int hit : vertex_hit) EXPECT_GE(hit, 1);
        for (const int hit : face_hit) EXPECT_EQ(hit, 1);
    }
}

TEST_P(EveryMesh, NeighboursStayNeighboursOrMerge) {
    for (const auto& [name, soup] : group()) {
        SCOPED_TRACE(name);
        Mesh mesh = build_mesh(soup);
        const Mesh original = mesh;
        SimplifyOptions options;
        options.vertices = soup.points.size() / 10;
        set_option(options, "method", GetParam());
        const SimplifyResult result = simplify(mesh, options);
        for (const Edge e : original.edges()) {
            const Vertex a(result.vertex_map[original.vertex(e, 0)]), b(result.vertex_map[original.vertex(e, 1)]);
            ASSERT_TRUE(a == b || find_halfedge(mesh, a, b) != Mesh::null_halfedge());
        }
    }
}

TEST_P(EveryMesh, LabelsFollowWithTheirTopology) {
    for (const auto& [name, soup] : group()) {
        for (const char* outlines : {"follow", "protect"}) {
            SCOPED_TRACE(name + ", " + outlines);
            Mesh mesh = build_mesh(soup);
            auto label = label_octants(mesh);
            const MarkedParts marked{label_outlines(mesh, label), {}};
            std::array<std::size_t, 4> component_count{};
            std::array<double, 4> area{};
            for (int k = 0; k < 4; ++k) component_count[k] = components(mesh, [&](Face f) { return label[f] == k; });
            for (const Face f : mesh.faces()) area[label[f]] += face_area(mesh, f);
            SimplifyOptions options;
            options.vertices = soup.points.size() / 3;
            set_option(options, "outlines", outlines);
            set_option(options, "method", GetParam());
            const SimplifyResult result = simplify(mesh, options, marked);
            EXPECT_TRUE(result.reached) << result.stop_reason;
            EXPECT_FALSE(result.outlines_broken);
            label = mesh.property_map<Face, int>("f:label").first;
            std::array<double, 4> area_after{};
            for (const Face f : mesh.faces()) {
                ASSERT_GE(label[f], 0);
                area_after[label[f]] += face_area(mesh, f);
            }
            for (int k = 0; k < 4; ++k) {
                EXPECT_EQ(components(mesh, [&](Face f) { return label[f] == k; }), component_count[k]);
                EXPECT_NEAR(area_after[k] / area[k], 1, 0.1);
            }
        }
    }
}

TEST_P(EveryMesh, ProtectedOutlinesStayToTheBit) {
    for (const auto& [name, soup] : group()) {
        SCOPED_TRACE(name);
        Mesh mesh = build_mesh(soup);
        const Mesh original = mesh;
        const auto label = label_octants(mesh);
        MarkedParts marked{label_outlines(mesh, label), std::vector<bool>(mesh.number_of_vertices(), false)};
        marked.vertices[7] = true;
        SimplifyOptions options;
        options.vertices = soup.points.size() / 3;
        options.outlines = SimplifyOptions::Outlines::protect;
        set_option(options, "method", GetParam());
        const SimplifyResult result = simplify(mesh, options, marked);
        EXPECT_EQ(mesh.point(Vertex(result.vertex_map[7])), original.point(Vertex(7)));
        for (const Edge e : original.edges()) {
            if (!marked.edges[e]) continue;
            const Vertex a = original.vertex(e, 0), b = original.vertex(e, 1);
            const Vertex a2(result.vertex_map[a]), b2(result.vertex_map[b]);
            ASSERT_EQ(mesh.point(a2), original.point(a));
            ASSERT_EQ(mesh.point(b2), original.point(b));
            ASSERT_NE(find_halfedge(mesh, a2, b2), Mesh::null_halfedge());
        }
    }
}

TEST_P(EveryMesh, IsDeterministic) {
    for (const auto& [name, soup] : group()) {
        SCOPED_TRACE(name);
        Mesh first = build_mesh(soup), second = build_mesh(soup);
        SimplifyOptions options;
        options.vertices = soup.points.size() / 5;
        set_option(options, "method", GetParam());
        simplify(first, options);
        simplify(second, options);
        EXPECT_EQ(mesh_checksum(first), mesh_checksum(second));
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryMesh, testing::Values("qem", "lindstrom-turk"), [](const auto& method) {
    return method.param == "qem" ? std::string("Quadrics") : std::string("LindstromTurk");
});
