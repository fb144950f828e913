// Influence of annotations on cages.
#include "ostraka/semantic/cage_density.h"

#include "annotation/example_meshes.h"
#include "meshes.h"
#include "ostraka/core/error.h"

#include <gtest/gtest.h>

using namespace ostraka;

TEST(CageDensity, MoreVerticesNearAnnotations) {
    const Mesh mesh = example::spheres(3);
    AnnotationSet set;
    Annotation& mark = set.annotations.emplace_back();
    mark.id = 3;
    mark.tag = "top";
    mark.type = AnnotationType::point;
    mark.points = {4};
    const CageDensity plain = annotation_density({mesh, set}), stated = annotation_density({mesh, set}, {{3, 9}});
    EXPECT_EQ(plain(mesh.point(Vertex(4))), 4);
    EXPECT_EQ(stated(mesh.point(Vertex(4))), 9);
    EXPECT_EQ(plain(mesh.point(Vertex(5))), 1);
}

TEST(CageDensity, ThePlaneOfASymmetricObject) {
    const MirrorPlane plane = find_mirror_plane(build_mesh(test::moved(test::box(2), 1, {5, 0, 0})), {}, "box.ply");
    EXPECT_NEAR(std::sqrt(plane.normal.squared_length()), 1, 1e-9);
    Mesh bent = example::spheres(3);
    for (const Vertex v : bent.vertices()) {
        const Point p = bent.point(v);
        bent.point(v) =
            Point(3 * p.x() + p.y() * p.y() * p.z(), 2 * p.y() + std::exp(p.x() - p.z()), p.z() + p.x() * p.x() * p.y());
    }
    try {
        static_cast<void>(find_mirror_plane(bent, {}, "bent.ply"));
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::failure);
        EXPECT_EQ(error.where(), "bent.ply");
    }
}
