#include "io/formats.h"

#include "meshes.h"
#include "ostraka/io/carry_extras.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

PolygonSoup triangles_of(const TriangleSoup& soup) {
    PolygonSoup polygons;
    polygons.points = soup.points;
    for (const auto& triangle : soup.triangles) {
        polygons.corners.insert(polygons.corners.end(), triangle.begin(), triangle.end());
        polygons.polygon_begin.push_back(static_cast<Index>(polygons.corners.size()));
    }
    return polygons;
}

/// Every corner has its own vertex, as in files without an index.
PolygonSoup torn(const TriangleSoup& soup) {
    PolygonSoup polygons = triangles_of(soup);
    std::vector<std::array<double, 3>> points;
    for (Index& corner : polygons.corners) {
        points.push_back(polygons.points[corner]);
        polygons.extras.vertex_values.resize(1);
        polygons.extras.vertex_values[0].values.push_back(corner);
        corner = static_cast<Index>(points.size() - 1);
    }
    polygons.points = std::move(points);
    return polygons;
}

TEST(Seams, DoubledVerticesAreJoined) {
    const TriangleSoup sphere = test::octahedron_sphere(3);
    PolygonSoup polygons = torn(sphere);
    const std::vector<std::array<double, 3>> file_points = polygons.points;
    io::join_seams(polygons);
    EXPECT_EQ(polygons.points.size(), sphere.points.size());
    ASSERT_EQ(polygons.vertex_of_file_vertex.size(), file_points.size());
    for (std::size_t v = 0; v < file_points.size(); ++v)
        EXPECT_EQ(polygons.points[polygons.vertex_of_file_vertex[v]], file_points[v]);
    EXPECT_EQ(polygons.extras.vertex_values[0].values.size(), polygons.points.size());
    for (std::size_t v = 0; v < polygons.points.size(); ++v)
        EXPECT_EQ(polygons.points[v], sphere.points[static_cast<std::size_t>(polygons.extras.vertex_values[0].values[v])]);
    EXPECT_EQ(polygons.notes.size(), 1U);
    const TriangulatedSoup result = triangulate(std::move(polygons));
    Mesh mesh;
    EXPECT_FALSE(try_build_mesh(result.soup, mesh).any());
    EXPECT_TRUE(CGAL::is_closed(mesh));
}

TEST(Seams, SheetsThatTouchOrFaceTheSameWayStayApart) {
    // Two copies of a square: the borders coincide in the same direction, so they are not two sides of a seam.
    PolygonSoup twice;
    for (int copy = 0; copy < 2; ++copy)
        for (const auto& point : {std::array<double, 3>{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}) twice.points.push_back(point);
    twice.corners = {0, 1, 2, 3, 4, 5, 6, 7};
    twice.polygon_begin = {0, 4, 8};
    io::join_seams(twice);
    EXPECT_EQ(twice.points.size(), 8U);
    // Three sheets along one edge: none is the other side of another.
    PolygonSoup fan;
    for (const auto& tip : {std::array<double, 3>{0, 1, 0}, {0, 0, 1}, {0, -1, 0}}) {
        const auto first = static_cast<Index>(fan.points.size());
        fan.points.insert(fan.points.end(), {{0, 0, 0}, {1, 0, 0}, tip});
        fan.corners.insert(fan.corners.end(), {first, first + 1, first + 2});
        fan.polygon_begin.push_back(static_cast<Index>(fan.corners.size()));
    }
    io::join_seams(fan);
    EXPECT_EQ(fan.points.size(), 9U);
    PolygonSoup empty;
    io::join_seams(empty);
    EXPECT_TRUE(empty.points.empty());
}

TEST(Seams, TexturedVerticesAreTheDistinctPairs) {
    TriangleSoup soup = test::octahedron_sphere(1);
    soup.points.push_back({5, 5, 5});  // without a face
    std::vector<TexturePoint> texture;
    for (const auto& triangle : soup.triangles)
        for (const Index v : triangle) texture.push_back({v == 0 ? static_cast<float>(texture.size() / 3 % 2) : 0.5F, 0});
    const io::TexturedVertices pairs = io::textured_vertices(soup, texture);
    EXPECT_EQ(pairs.vertex.size(), soup.points.size() + 1);
    for (std::size_t corner = 0; corner < texture.size(); ++corner) {
        const Index pair = pairs.pair_of_corner[corner];
        EXPECT_EQ(pairs.vertex[pair], soup.triangles[corner / 3][corner % 3]);
        EXPECT_EQ(pairs.texture[pair], texture[corner]);
    }
    EXPECT_TRUE(std::is_sorted(pairs.vertex.begin(), pairs.vertex.end()));
}

TEST(Seams, EdgesWithDifferentCoordinatesOrMaterialsAreSeams) {
    const Mesh mesh = build_mesh(test::box(2));
    MeshExtras extras;
    extras.appearance.materials.resize(2);
    for (const Face f : mesh.faces()) extras.face_materials.push_back(centroid(mesh, f).z() > 0 ? 1 : 0);
    const auto count = [&] {
        const std::vector<bool> seams = texture_seams(mesh, extras);
        return std::count(seams.begin(), seams.end(), true);
    };
    const auto between_materials = count();
    EXPECT_GT(between_materials, 0);
    extras.corner_texture.assign(3 * mesh.number_of_faces(), TexturePoint{0, 0});
    EXPECT_EQ(count(), between_materials);
    extras.face_materials.clear();
    EXPECT_EQ(count(), 0);
    extras.corner_texture[0] = {1, 0};
    EXPECT_EQ(count(), 2);
    EXPECT_TRUE(texture_seams(Mesh(), {}).empty());
}

TEST(Seams, CarriedAttributesComeFromTheirSources) {
    MeshExtras extras;
    extras.vertex_colours = {{1, 2, 3, 4}, {5, 6, 7, 8}};
    extras.face_materials = {0, no_index};
    extras.face_values = {{"area", {2, 3}}};
    extras.corner_texture = {{0, 0}, {1, 0}, {0, 1}, {2, 2}, {3, 3}, {4, 4}};
    extras.appearance.materials.resize(1);
    const std::vector<Index> vertices{1, no_index, 0}, faces{1, 0, no_index}, corner_list{3, 4, 5, 0, 1, no_index, 2, 2, 2};
    const MeshExtras result = carried(extras, {&vertices, &faces, &corner_list});
    EXPECT_EQ(result.vertex_colours, (std::vector<Colour>{{5, 6, 7, 8}, {255, 255, 255, 255}, {1, 2, 3, 4}}));
    EXPECT_EQ(result.face_materials, (std::vector<Index>{no_index, 0, no_index}));
    EXPECT_EQ(result.face_values[0].values[1], 2);
    EXPECT_TRUE(std::isnan(result.face_values[0].values[2]));
    EXPECT_EQ(result.corner_texture[5], (TexturePoint{0, 0}));
    EXPECT_EQ(result.corner_texture[0], (TexturePoint{2, 2}));
    EXPECT_EQ(result.appearance.materials.size(), 1U);
}

}  // namespace
}  // namespace ostraka
