// Parts cut out along their outlines.
#include "ostraka/annotation/part.h"
#include "meshes.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/error.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

Annotation region(int id, const std::string& tag, std::vector<Index> faces) {
    Annotation annotation;
    annotation.id = id;
    annotation.tag = tag;
    annotation.faces = std::move(faces);
    return annotation;
}

/// A sphere with the upper half, the part of that with x > 0, the north pole, and the whole.
AnnotationSet halves(const Mesh& mesh) {
    AnnotationSet set;
    std::vector<Index> upper, corner;
    for (const Face f : mesh.faces()) {
        const Point c = centroid(mesh, f);
        if (c.z() > 0) upper.push_back(f);
        if (c.z() > 0 && c.x() > 0) corner.push_back(f);
    }
    set.annotations = {region(1, "upper", upper), region(2, "corner", corner)};
    Annotation pole = region(3, "pole", {});
    pole.type = AnnotationType::point;
    for (const Vertex v : mesh.vertices())
        if (mesh.point(v).z() > 0.9999) pole.points = {v};
    set.annotations.push_back(pole);
    ensure_root(set, mesh);
    return set;
}

}  // namespace

TEST(Part, HasTheAreaOfItsRegionAndWhatIsAnnotatedOnIt) {
    const Mesh mesh = build_mesh(octahedron_sphere(4));
    const AnnotationSet set = halves(mesh);
    const CutPart part = cut_out_part({mesh, set}, {1});
    EXPECT_NEAR(surface_area(part.mesh), area_of(mesh, set.annotations[1].faces), 1e-12);
    check_annotations(part, "part");
    ASSERT_NE(part.annotations.find(2), nullptr);
    EXPECT_EQ(part.annotations.find(2)->faces.size(), set.find(2)->faces.size());
    EXPECT_EQ(part.annotations.find(3)->points.size(), 1U);
    EXPECT_EQ(part.cuts, 1U);
    EXPECT_EQ(part.closed, 0U);
    for (std::size_t f = 0; f < part.faces.size(); ++f)
        EXPECT_EQ(centroid(part.mesh, Face(Index(f))), centroid(mesh, Face(part.faces[f])));
}

TEST(Part, LeavesOthersOut) {
    const Mesh mesh = build_mesh(octahedron_sphere(4));
    const AnnotationSet set = halves(mesh);
    const double upper = area_of(mesh, set.find(1)->faces), corner = area_of(mesh, set.find(2)->faces);
    EXPECT_NEAR(surface_area(cut_out_part({mesh, set}, {1}, {2}).mesh), upper - corner, 1e-12);
    EXPECT_NEAR(surface_area(cut_out_part({mesh, set}, {}, {1}).mesh), surface_area(mesh) - upper, 1e-12);
    EXPECT_THROW(cut_out_part({mesh, set}, {2}, {1}), Error);  // nothing is left
    EXPECT_THROW(cut_out_part({mesh, set}, {3}), Error);       // a point
}

TEST(Part, IsClosedAcrossThePlaneOfItsCut) {
    const Mesh mesh = build_mesh(octahedron_sphere(4));
    const AnnotationSet set = halves(mesh);
    const CutPart part = cut_out_part({mesh, set}, {1}, {}, true);
    EXPECT_EQ(part.closed, 1U);
    EXPECT_TRUE(CGAL::is_closed(part.mesh));
    // The equator of this sphere is a circle of edges: the lid adds no volume.
    EXPECT_NEAR(volume(part.mesh), volume(mesh) / 2, 1e-9);
    check_annotations(part, "part");
    const Annotation& cap = part.annotations.annotations.back();
    EXPECT_EQ(cap.tag, "cut");
    for (const Index f : cap.faces) {
        EXPECT_EQ(part.faces[f], no_index);
        EXPECT_NEAR(centroid(part.mesh, Face(f)).z(), 0, 1e-12);
    }
    const Annotation* root = part.annotations.find(set.annotations[0].id);
    ASSERT_NE(root, nullptr);
    EXPECT_EQ(root->faces.size(), part.mesh.number_of_faces());
}

TEST(Part, OfAnOpenMeshClosesItsCutsOnly) {
    const Mesh whole = build_mesh(octahedron_sphere(4));
    const CutPart bowl = cut_out_part({whole, halves(whole)}, {1});
    AnnotationSet set;
    std::vector<Index> band;
    for (const Face f : bowl.mesh.faces())
        if (centroid(bowl.mesh, f).z() < 0.5) band.push_back(f);
    set.annotations = {region(1, "band", band)};
    const CutPart part = cut_out_part({bowl.mesh, set}, {0}, {}, true);
    EXPECT_EQ(part.cuts, 1U);
    EXPECT_EQ(holes_of(part.mesh).size(), 1U);  // the rim of the bowl
}

TEST(Part, FollowsFreeOutlines) {
    const Mesh mesh = build_mesh(octahedron_sphere(3));
    AnnotationSet set = halves(mesh);
    Annotation free = region(7, "lens", {});
    // A small triangle within the face of the pole.
    Index face = no_index;
    for (const Face f : mesh.faces())
        for (const Vertex v : corners(mesh, f))
            if (face == no_index && mesh.point(v).z() > 0.9999) face = f;
    const auto at = [&](double a, double b, double c) { return stored_point(mesh, surface_point(mesh, face, {a, b, c})); };
    free.curves = {{at(0.6, 0.2, 0.2), at(0.2, 0.6, 0.2), at(0.2, 0.2, 0.6), at(0.6, 0.2, 0.2)}};
    compute_elements(mesh, free);
    set.annotations.push_back(free);
    const CutPart part = cut_out_part({mesh, set}, {set.annotations.size() - 1});
    EXPECT_NEAR(surface_area(part.mesh), 0.16 * face_area(mesh, Face(face)), 1e-12);
    ASSERT_TRUE(part.whole);
    for (const Index f : part.faces) EXPECT_EQ(part.whole->face_origin[f], face);
}

TEST(Part, OfOneTriangle) {
    TriangleSoup soup;
    soup.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    soup.triangles = {{0, 1, 2}};
    const Mesh mesh = build_mesh(soup);
    AnnotationSet set;
    set.annotations = {region(0, "all of it", {0})};
    const CutPart part = cut_out_part({mesh, set}, {0}, {}, true);
    EXPECT_EQ(part.mesh.number_of_faces(), 1U);
    EXPECT_EQ(part.cuts, 0U);  // its border was there before
}
