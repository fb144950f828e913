#include "ostraka/geom/submesh.h"

#include "meshes.h"

#include "ostraka/core/error.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

TEST(SubMesh, KeepsMarkedFacesAtTheirPositions) {
    const Mesh mesh = build_mesh(test::moved(test::torus(20, 10), 0.3, {100, 0, 5}));
    std::vector<bool> keep(mesh.number_of_faces());
    std::size_t count = 0;
    for (std::size_t f = 0; f < keep.size(); ++f) keep[f] = f % 7 < 4, count += keep[f] ? 1 : 0;
    const SubMesh part = keep_faces(mesh, keep);
    EXPECT_TRUE(test::is_sound(part.mesh));
    ASSERT_EQ(part.mesh.number_of_faces(), count);
    for (const Face face : part.mesh.faces()) {
        EXPECT_TRUE(keep[part.faces[face]]);
        EXPECT_EQ(face_area(part.mesh, face), face_area(mesh, Face(part.faces[face])));
    }
    for (const Vertex v : part.mesh.vertices()) EXPECT_EQ(part.mesh.point(v), mesh.point(Vertex(part.vertices[v])));
}

TEST(SubMesh, TheLargestComponentHasTheLargestArea) {
    const Mesh mesh = build_mesh(test::joined(test::octahedron_sphere(3), test::moved(test::octahedron_sphere(1), 2, {9, 0, 0})));
    const SubMesh part = keep_faces(mesh, std::vector<bool>(mesh.number_of_faces(), true), true);
    EXPECT_EQ(part.mesh.number_of_faces(), build_mesh(test::octahedron_sphere(1)).number_of_faces());
}

TEST(SubMesh, WithoutMarksIsEmpty) {
    const Mesh mesh = build_mesh(test::octahedron_sphere(1));
    EXPECT_EQ(keep_faces(mesh, std::vector<bool>(mesh.number_of_faces(), false), true).mesh.number_of_faces(), 0U);
    EXPECT_THROW((void)keep_faces(mesh, {true}), Error);
}

}  // namespace
}  // namespace ostraka
