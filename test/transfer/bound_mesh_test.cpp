#include "ostraka/transfer/bound_mesh.h"

#include "meshes.h"
#include "ostraka/annotation/annotation_file.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

/// A ball whose upper cap is annotated, with a seam from the top down, its top as a point, labels and colours.
MeshFile labelled_ball() {
    MeshFile file{build_mesh(test::octahedron_sphere(4)), {}, {}, {}};
    for (const Face f : file.mesh.faces()) file.extras.face_labels.push_back(centroid(file.mesh, f).z() > 0 ? 4 : 9);
    for (const Vertex v : file.mesh.vertices())
        file.extras.vertex_colours.push_back({std::uint8_t(100 + 50 * file.mesh.point(v).x()), 7, 8, 255});
    return file;
}

AnnotationSet annotated(const Mesh& mesh) {
    AnnotationSet set;
    Annotation cap, seam, top;
    cap.id = 3, cap.tag = "cap", cap.type = AnnotationType::region;
    for (const Face f : mesh.faces())
        if (centroid(mesh, f).z() > 0.5) cap.faces.push_back(f);
    seam.id = 4, seam.tag = "seam", seam.type = AnnotationType::line, seam.polylines = {{4}};
    for (int i = 0; i < 8; ++i) {
        const Vertex v(seam.polylines[0].back());
        Vertex lowest = v;
        for (const Vertex w : CGAL::vertices_around_target(v, mesh))
            if (mesh.point(w).z() < mesh.point(lowest).z()) lowest = w;
        seam.polylines[0].push_back(lowest);
    }
    top.id = 5, top.tag = "top", top.type = AnnotationType::point, top.points = {4};
    set.annotations = {cap, seam, top};
    return set;
}

void expect_whole(const BoundMesh& bound) {
    EXPECT_EQ(bound.extras.face_labels.size(), bound.mesh.number_of_faces());
    ASSERT_EQ(bound.extras.vertex_colours.size(), bound.mesh.number_of_vertices());
    for (const Vertex v : bound.mesh.vertices())
        ASSERT_NEAR(bound.extras.vertex_colours[v][0], 100 + 50 * bound.mesh.point(v).x(), 8);
    check_annotations({bound.mesh, *bound.annotations}, "test");
    EXPECT_EQ(bound.after.vertices, bound.mesh.number_of_vertices());
    EXPECT_FALSE((bound.mesh.property_map<Face, std::uint32_t>(face_annotations).second));
    EXPECT_FALSE((bound.mesh.property_map<Face, std::int32_t>("f:file-label").second));
}

}  // namespace

TEST(BoundMesh, EverythingFollowsSuccessiveSteps) {
    MeshFile file = labelled_ball();
    const AnnotationSet set = annotated(file.mesh);
    BoundMesh bound(std::move(file), set);
    ASSERT_EQ(bound.changes.size(), 3U);
    EXPECT_EQ(bound.changes[0].before.elements, set.annotations[0].faces.size());
    EXPECT_EQ(bound.changes[1].before.elements, 8U);

    SimplifyOptions fewer;
    fewer.vertices = 300;
    EXPECT_TRUE(bound.simplify(fewer).reached);
    expect_whole(bound);
    EXPECT_EQ(bound.after.vertices, 300U);
    EXPECT_NEAR(bound.changes[0].after.area / bound.changes[0].before.area, 1, 0.1);
    EXPECT_LT(bound.changes[0].after.elements, bound.changes[0].before.elements);
    const BoundMesh::Change cap = bound.changes[0];

    RefineOptions more;
    more.levels = 1;
    EXPECT_EQ(bound.refine(more).levels, 1);
    expect_whole(bound);
    EXPECT_EQ(bound.changes[0].after.elements, 4 * cap.after.elements);
    EXPECT_NEAR(bound.changes[0].after.area, cap.after.area, 1e-9);
    EXPECT_EQ(bound.changes[0].before.elements, cap.before.elements);
    EXPECT_EQ(bound.before.vertices, 1026U);
    EXPECT_EQ(bound.annotations->find(5)->points.size(), 1U);
    EXPECT_EQ(bound.annotations->find(4)->polylines.size(), 1U);
}

TEST(BoundMesh, SmallAnnotationsDegenerateWithANote) {
    MeshFile file = labelled_ball();
    AnnotationSet set;
    for (int i = 0; i < 60; ++i) {
        Annotation& annotation = set.annotations.emplace_back();
        annotation.id = i, annotation.tag = "face " + std::to_string(i), annotation.type = AnnotationType::region,
        annotation.faces = {Index(i * 30)};
    }
    BoundMesh bound(std::move(file), set);
    SimplifyOptions few;
    few.vertices = 40;
    EXPECT_TRUE(bound.simplify(few).outlines_broken);
    std::size_t degenerate = 0;
    for (const BoundMesh::Change& change : bound.changes) {
        degenerate += change.degenerate ? 1 : 0;
        EXPECT_EQ(change.degenerate, bound.annotations->find(change.id)->type != AnnotationType::region);
        EXPECT_EQ(change.degenerate, !change.note.empty()) << change.note;
    }
    EXPECT_GT(degenerate, 0U);
}

TEST(BoundMesh, TextureOfCornersIsLeftOutWithANote) {
    MeshFile file = labelled_ball();
    file.extras.corner_texture.resize(3 * file.mesh.number_of_faces());
    BoundMesh bound(std::move(file));
    EXPECT_EQ(bound.notes.size(), 1U);
    SimplifyOptions fewer;
    fewer.vertices = 500;
    bound.simplify(fewer);
    EXPECT_TRUE(bound.extras.corner_texture.empty());
    EXPECT_FALSE(bound.annotations.has_value());
    EXPECT_TRUE(bound.changes.empty());
}

}  // namespace ostraka
