// Annotations of a mesh that is moved.
#include "ostraka/transfer/moved_annotations.h"
#include "meshes.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/annotation/fair_outlines.h"
#include "ostraka/io/moved.h"
#include "ostraka/measure/measure.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

using namespace ostraka;
using namespace ostraka::test;

namespace {

Attribute descriptor(int id, const std::string& name, std::vector<double> values, const std::string& unit,
                     const std::string& file = {}) {
    Attribute attribute;
    attribute.id = id;
    attribute.name = name;
    attribute.value = Descriptor();
    attribute.descriptor()->values = std::move(values);
    attribute.descriptor()->unit = unit;
    attribute.descriptor()->file = file;
    return attribute;
}

/// A sphere with a free cap, a free line and a measure with pins inside faces.
AnnotatedMesh annotated_sphere() {
    AnnotatedMesh object{build_mesh(octahedron_sphere(4)), {}};
    Annotation cap;
    cap.id = 1, cap.tag = "cap";
    for (const Face f : object.mesh.faces())
        if (centroid(object.mesh, f).z() + 0.2 * centroid(object.mesh, f).x() > 0.4) cap.faces.push_back(f);
    object.annotations.annotations = {cap};
    fair_outlines(object.mesh, object.annotations, {});
    object.annotations.unit = "mm";
    object.annotations.up = {0, 0, 1};
    Annotation& fair = object.annotations.annotations[0];
    Measure measure;
    measure.tool = "ruler";
    measure.points = {0, 5};
    measure.unit = "mm";
    for (const Index f : {7U, 400U}) measure.locations.push_back(stored_point(object.mesh, face_point(f, {0.2, 0.3, 0.5})));
    for (std::size_t k = 0; k < 2; ++k) measure.points[k] = nearest_vertex(object.mesh, measure.locations[k]);
    measure.direction = {1, 0, 0};
    add_measure(fair, "width", measure);
    return object;
}

Mesh moved_mesh(const Mesh& mesh, const Motion& motion) {
    TriangleSoup soup = to_soup(mesh);
    MeshExtras extras;
    move_triangles(soup, extras, motion);
    return build_mesh(soup);
}

}  // namespace

TEST(MovedAnnotations, FreeCurvesAndPinsStayInPlaceOnAMirroredMesh) {
    AnnotatedMesh object = annotated_sphere();
    ASSERT_TRUE(is_free(object.annotations.annotations[0]));
    refresh_measures(object.mesh, object.annotations);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    for (const Eigen::Matrix3d& rotation : {turn, Eigen::Matrix3d(turn * Eigen::Vector3d(-1, 1, 1).asDiagonal())}) {
        const Motion motion{rotation, {5, 6, 7}, 10};
        const Mesh mesh = moved_mesh(object.mesh, motion);
        AnnotationSet set = moved_annotations(object, motion, "mm");
        EXPECT_NO_THROW(check_annotations({mesh, set}, "moved"));
        const Annotation &before = object.annotations.annotations[0], &after = set.annotations[0];
        EXPECT_EQ(after.faces, before.faces);
        for (std::size_t c = 0; c < before.curves.size(); ++c)
            for (std::size_t i = 0; i < before.curves[c].size(); ++i) {
                const std::size_t last = before.curves[c].size() - 1, there = motion.mirrors() ? last - i : i;
                const Point p = position(object.mesh, before.curves[c][i]), q = position(mesh, after.curves[c][there]);
                const Eigen::Vector3d expected = motion({p.x(), p.y(), p.z()});
                EXPECT_LT(std::sqrt(CGAL::squared_distance(q, Point(expected.x(), expected.y(), expected.z()))), 1e-13);
            }
        EXPECT_NEAR(area_of(mesh, after) / (100 * area_of(object.mesh, before)), 1, 1e-12);
        Annotation elements = after;
        compute_elements(mesh, elements);
        EXPECT_EQ(elements.faces, before.faces) << "the interior is to the left";
        refresh_measures(mesh, set);
        EXPECT_NEAR(*set.annotations[0].attributes[0].measure()->value / (10 * *before.attributes[0].measure()->value), 1, 1e-13);
        const Eigen::Vector3d up = rotation.col(2), side = rotation.col(0);
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ((*set.up)[k], up[k]);
            EXPECT_EQ((*set.annotations[0].attributes[0].measure()->direction)[k], side[k]);
        }
    }
}

TEST(MovedAnnotations, StatisticsAreScaledAndFilesThatNoLongerFitAreStale) {
    AnnotatedMesh object = annotated_sphere();
    auto& attributes = object.annotations.annotations[0].attributes;
    attributes.clear();
    attributes.push_back(descriptor(1, "thickness mean", {2}, "mm"));
    attributes.push_back(descriptor(2, "mean curvature median", {2}, "1/mm"));
    attributes.push_back(descriptor(3, "Gaussian curvature mean", {2}, "1/mm^2"));
    attributes.push_back(descriptor(4, "weight", {2}, "g"));
    attributes.push_back(descriptor(5, "diameter in the inventory", {2}, "cm"));
    attributes.push_back(descriptor(6, "thickness", {}, "mm", "t.npy"));
    attributes.push_back(descriptor(7, "colour", {}, "per cent", "c.npy"));
    attributes.push_back(descriptor(8, "axis", {}, "", "a.json"));
    attributes.push_back(descriptor(9, "area", {1}, "mm^2"));
    const auto moved = [&](const Motion& motion, const std::string& unit) {
        return moved_annotations(object, motion, unit).annotations[0].attributes;
    };
    const Eigen::Matrix3d none = Eigen::Matrix3d::Identity();
    const auto same = moved({none, {1, 0, 0}, 1}, "mm"), metres = moved({none, {0, 0, 0}, 0.001}, "m"),
               larger = moved({none, {0, 0, 0}, 2}, "mm"), still = moved({}, "mm");
    EXPECT_NEAR(metres[0].descriptor()->values[0], 0.002, 1e-18);
    EXPECT_NEAR(metres[1].descriptor()->values[0], 2000, 1e-9);
    EXPECT_EQ(metres[1].descriptor()->unit, "1/m");
    EXPECT_NEAR(metres[2].descriptor()->values[0], 2e6, 1e-6);
    EXPECT_EQ(metres[8].descriptor()->unit, "m^2");
    EXPECT_EQ(larger[0].descriptor()->values[0], 4);
    EXPECT_EQ(larger[1].descriptor()->values[0], 1);
    EXPECT_EQ(larger[2].descriptor()->values[0], 0.5);
    for (const auto* list : {&same, &metres, &larger}) {
        EXPECT_EQ((*list)[3].descriptor()->values[0], 2);
        EXPECT_EQ((*list)[3].descriptor()->unit, "g");
        EXPECT_EQ((*list)[4].descriptor()->values[0], 2) << "a statement in its own unit";
        EXPECT_EQ((*list)[4].descriptor()->unit, "cm");
        EXPECT_FALSE((*list)[6].descriptor()->stale);
        EXPECT_TRUE((*list)[7].descriptor()->stale) << "an axis has a place";
    }
    EXPECT_FALSE(same[5].descriptor()->stale);
    EXPECT_FALSE(metres[5].descriptor()->stale) << "millimetres, as the attribute states";
    EXPECT_TRUE(larger[5].descriptor()->stale);
    EXPECT_FALSE(still[7].descriptor()->stale);
}
