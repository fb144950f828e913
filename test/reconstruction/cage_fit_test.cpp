#include "ostraka/reconstruction/reconstruct.h"

#include "pieces.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/stats/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

using namespace test;
using Eigen::Vector3d;

/// A template in its cage, and an object that is the template with the cage moved.
class CageFit : public ::testing::Test {
protected:
    void make(int levels, std::uint64_t vertices) {
        mesh = body(levels);
        cage = generated_cage(mesh, vertices);
        Random random(7, 0);
        std::vector<Point> points;
        for (const Vertex v : cage.cage.vertices()) {
            const Vector3d p = eigen(cage.cage.point(v));
            const Vector3d drawn(random.uniform(), random.uniform(), random.uniform());
            points.push_back(
                point_of(Vector3d(1.05 * p.x(), p.y() + 0.05 * p.z(), 1.08 * p.z()) + 0.03 * (drawn - Vector3d(0.5, 0.5, 0.5))));
        }
        original = mesh;
        const std::vector<Point> deformed_points = deformed(cage.coordinates, cage.cage, points);
        for (const Vertex v : original.vertices()) original.point(v) = deformed_points[v];
    }
    [[nodiscard]] static std::vector<PlacedFragment> placed(const Mesh& fragment) {
        static const AnnotationSet none;
        std::vector<PlacedFragment> fragments;
        PlacedFragment fragment_placed;
        fragment_placed.mesh = fragment;
        fragment_placed.annotations = &none;
        fragments.push_back(std::move(fragment_placed));
        return fragments;
    }
    [[nodiscard]] double worst(const NonRigidFit& fit) const {
        double maximum = 0;
        for (const Vertex v : original.vertices())
            maximum = std::max(maximum, std::sqrt(CGAL::squared_distance(fit.points[v], original.point(v))));
        return maximum / box_diagonal(mesh);
    }
    [[nodiscard]] static NonRigidOptions in(const std::string& space) {
        NonRigidOptions options;
        set_option(options, "space", space);
        return options;
    }
    Mesh mesh, original;
    AnnotationSet set;
    TemplateCage cage;
};

TEST_F(CageFit, RecoversADeformationByTheCage) {
    make(4, 60);
    TemplateFitter fitter({mesh, set}, &cage);
    const double in_cage = worst(fitter.fit(1, placed(original), in("cage"))),
                 direct = worst(fitter.fit(1, placed(original), in("mesh"))),
                 both = worst(fitter.fit(1, placed(original), in("both")));
    EXPECT_LT(in_cage, 1e-7);
    EXPECT_LT(in_cage, 1e-3 * direct);
    EXPECT_LT(both, 2 * direct);
}

TEST_F(CageFit, RecoversTheDeformationOfALargeTemplate) {
    make(6, 80);
    TemplateFitter fitter({mesh, set}, &cage);
    EXPECT_LT(worst(fitter.fit(1, placed(original), in("cage"))), 1e-4) << "levels are solved on a simplified template";
}

TEST_F(CageFit, NoiseFoldsNoFace) {
    make(4, 60);
    Random random(3, 0);
    Mesh rough = original;
    const double amount = 0.01 * box_diagonal(mesh);
    for (const Vertex v : rough.vertices())
        rough.point(v) = rough.point(v) + amount * (2 * random.uniform() - 1) * vertex_normal(original, v);
    std::vector<Point> points = TemplateFitter({mesh, set}, &cage).fit(1, placed(rough), in("cage")).points;
    Mesh fitted = mesh;
    for (const Vertex v : fitted.vertices()) fitted.point(v) = points[v];
    for (const Face face : mesh.faces()) EXPECT_GT(area_vector(fitted, face) * area_vector(original, face), 0);
}

TEST_F(CageFit, TheSameForAnyNumberOfThreadsAndAfterEarlierFits) {
    make(3, 40);
    TemplateFitter fitter({mesh, set}, &cage);
    const int before = threads();
    set_threads(1);
    const NonRigidFit alone = fitter.fit(1, placed(original), in("cage"));
    set_threads(4);
    (void)fitter.fit(1.1, placed(original), in("mesh"));
    const NonRigidFit many = fitter.fit(1, placed(original), in("cage"));
    set_threads(before);
    EXPECT_EQ(alone.points, many.points);
}

TEST_F(CageFit, FragmentsOfTheObjectThroughTheCage) {
    make(4, 60);
    const AnnotationSet landmarks = landmarks_of(mesh);
    FragmentOptions options;
    options.share = 0.5;
    const Cut cut_piece = cut({original, landmarks}, Point(0, 0, 1.9), options);
    ReconstructOptions options_in_cage;
    options_in_cage.fit.space = NonRigidOptions::Space::cage;
    const Reconstruction result = reconstruct({mesh, landmarks}, {}, {&cut_piece.fragment}, options_in_cage, {}, nullptr, &cage);
    ASSERT_TRUE(result.placement.any());
    EXPECT_NEAR(result.observed_share, 0.5, 0.08);
    EXPECT_EQ(result.crossings, 0U);
}

TEST_F(CageFit, RefusesAnInvalidCage) {
    make(3, 40);
    Mesh small = cage.cage;
    for (const Vertex v : small.vertices()) small.point(v) = point_of(0.5 * eigen(small.point(v)));
    try {
        (void)template_in_cage(mesh, small);
        FAIL() << "the cage does not contain the template";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_NE(std::string(error.what()).find("outside"), std::string::npos) << error.what();
    }
    EXPECT_THROW((void)TemplateFitter({mesh, set}).fit(1, placed(original), in("cage")), Error);
    ReconstructOptions options_in_cage;
    options_in_cage.fit.space = NonRigidOptions::Space::both;
    const RelationGraph graph;
    EXPECT_THROW(Reconstructor({mesh, set}, graph, options_in_cage), Error);
    const TemplateCage green{cage.cage, compute_coordinates("green", cage.cage, mesh)};
    EXPECT_THROW(TemplateFitter({mesh, set}, &green), Error);
    const Mesh other = body(2);
    EXPECT_THROW(TemplateFitter({other, set}, &cage), Error);
}

}  // namespace
}  // namespace ostraka
