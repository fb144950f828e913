#include "ostraka/registration/mesh_registration.h"

#include "meshes.h"
#include "select/real_mesh.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/remesh/remesh.h"
#include "ostraka/remesh/simplify.h"
#include "ostraka/stats/random.h"
#include "ostraka/synthetic/make_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ostraka {
namespace {

using Eigen::Vector3d;

Mesh shaped(const Mesh& mesh, const std::function<Vector3d(const Vector3d&)>& map) {
    Mesh result = mesh;
    for (const Vertex v : result.vertices()) result.point(v) = point_of(map(eigen(mesh.point(v))));
    return result;
}

Mesh synthetic_mesh(const std::string& name, std::uint64_t vertices, std::uint64_t seed = 1) {
    MakeOptions options;
    options.vertices = vertices;
    options.seed = seed;
    return make_mesh(synthetic_object(name), options).mesh;
}

Mesh flipped_mesh(const Mesh& mesh, bool mirror) {
    TriangleSoup soup = to_soup(mesh);
    if (mirror)
        for (auto& p : soup.points) p[0] = -p[0];
    else
        for (auto& t : soup.triangles) std::swap(t[1], t[2]);
    return build_mesh(soup);
}

/// Mirrored, its faces outward again.
Mesh mirrored(const Mesh& mesh) { return flipped_mesh(flipped_mesh(mesh, true), false); }

Motion any_similarity(const Mesh& mesh, std::uint64_t seed) {
    Random random(seed);
    Motion motion;
    motion.rotation =
        Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal()).normalized().toRotationMatrix();
    motion.scale = std::pow(10, random.uniform(-3, 3));
    motion.translation = 300 * motion.scale * box_diagonal(mesh) * Vector3d(random.normal(), random.normal(), random.normal());
    return motion;
}

/// `source` and `target` are meshes of one surface in one pose: the source is moved and registered, and the remaining error is
/// compared.
void expect_found(const Mesh& source, const Mesh& target, std::uint64_t seed, double degrees, double scale) {
    const Motion motion = any_similarity(source, seed);
    const MeshRegistration registration = register_mesh(shaped(source, motion), target);
    EXPECT_EQ(registration.verdict, RegistrationVerdict::aligned) << message_about(registration, box_diagonal(target));
    const Motion remaining = registration.motion.after(motion);
    EXPECT_LT(Eigen::AngleAxisd(remaining.rotation).angle() * 180 / std::numbers::pi, degrees);
    EXPECT_NEAR(remaining.scale, 1, scale);
    const Vector3d corner = eigen(target.point(Vertex(0)));
    EXPECT_LT((remaining(corner) - corner).norm(), 2 * scale * box_diagonal(target));
}

TEST(MeshRegistration, FindsAnySimilarityOfACopyExactly) {
    const Mesh pot = synthetic_mesh("teapot", 2000);
    for (const std::uint64_t seed : {1, 2, 3}) expect_found(pot, pot, seed, 1e-4, 1e-6);
}

TEST(MeshRegistration, FindsMeshesGeneratedAtOtherResolutions) {
    for (const char* name : {"hand", "teapot", "chair"}) {
        SCOPED_TRACE(name);
        const Mesh coarse = synthetic_mesh(name, 5000, 1), fine = synthetic_mesh(name, 20000, 2);
        expect_found(coarse, fine, 4, 0.1, 1e-3);
        expect_found(fine, coarse, 5, 0.1, 1e-3);
    }
}

TEST(MeshRegistration, FindsRemeshedAndDecimatedScans) {
    OSTRAKA_SCAN(scan, "elephant.off");
    RemeshOptions remeshing;
    remeshing.vertices = 5000;
    expect_found(remesh(scan, remeshing).mesh, scan, 6, 0.1, 1e-3);
    SimplifyOptions simplifying;
    simplifying.vertices = 1500;
    Mesh few = scan;
    simplify(few, simplifying);
    few.collect_garbage();
    expect_found(few, scan, 7, 0.1, 1e-3);
}

TEST(MeshRegistration, OtherObjectsAreNeverAligned) {
    const Mesh hand = synthetic_mesh("hand", 2000), pot = synthetic_mesh("teapot", 2000), chair = synthetic_mesh("chair", 2000);
    EXPECT_EQ(register_mesh(hand, pot).verdict, RegistrationVerdict::different);
    EXPECT_EQ(register_mesh(pot, chair).verdict, RegistrationVerdict::different);
    EXPECT_EQ(register_mesh(chair, hand).verdict, RegistrationVerdict::different);
}

TEST(MeshRegistration, TheSameObjectWithOneOtherProportionIsNotAligned) {
    const Mesh hand = synthetic_mesh("hand", 8000);
    const auto box = bounding_box(hand);
    for (const double growth : {1.03, 1.1}) {
        const Mesh other = shaped(hand, [&](const Vector3d& p) {
            return Vector3d(p.x(), p.y(),
                            p.z() > 0.5 * (box.zmin() + box.zmax())
                                ? 0.5 * (box.zmin() + box.zmax()) + growth * (p.z() - 0.5 * (box.zmin() + box.zmax()))
                                : p.z());
        });
        EXPECT_EQ(register_mesh(other, hand).verdict, RegistrationVerdict::different) << growth;
    }
}

TEST(MeshRegistration, RefusesAndReportsMirrorImages) {
    const Mesh hand = synthetic_mesh("hand", 3000), other = synthetic_mesh("hand", 5000, 2);
    const MeshRegistration registration = register_mesh(mirrored(hand), other);
    EXPECT_EQ(registration.verdict, RegistrationVerdict::mirrored);
    EXPECT_LT(registration.mirrored.rms, 0.2 * registration.agreement.rms);
    // An axis reversed by an export, with unchanged faces: mirrored and inside out.
    EXPECT_EQ(register_mesh(flipped_mesh(hand, true), other).verdict, RegistrationVerdict::mirrored);
    // A mirror-symmetric object is aligned, but not in its original triangles, from which it was mirrored.
    const Mesh pot = synthetic_mesh("teapot", 3000);
    EXPECT_EQ(register_mesh(mirrored(synthetic_mesh("teapot", 5000, 2)), pot).verdict, RegistrationVerdict::aligned);
    EXPECT_EQ(register_mesh(mirrored(pot), pot).verdict, RegistrationVerdict::mirrored);
}

TEST(MeshRegistration, RegistersMeshesThatAreInsideOut) {
    const Mesh hand = synthetic_mesh("hand", 3000), turned = flipped_mesh(hand, false);
    using InsideOut = MeshRegistration::InsideOut;
    for (const auto& [source, target, which] :
         {std::tuple{&turned, &hand, InsideOut::source}, {&hand, &turned, InsideOut::target}}) {
        const MeshRegistration registration = register_mesh(*source, *target);
        EXPECT_EQ(registration.verdict, RegistrationVerdict::aligned);
        EXPECT_TRUE(registration.turned_over);
        EXPECT_EQ(registration.inside_out, which);
        EXPECT_LT(registration.agreement.rms, 1e-6 * box_diagonal(hand));
        ASSERT_FALSE(remarks_on(registration).empty());
        EXPECT_NE(remarks_on(registration).front().find("inside out"), std::string::npos);
    }
    EXPECT_FALSE(register_mesh(hand, hand).turned_over);
}

TEST(MeshRegistration, CountsThePosesOfASymmetricObjectAndChoosesTheNearest) {
    const Mesh box =
        shaped(build_mesh(test::box(12)), [](const Vector3d& p) { return Vector3d(p.x(), 1.5 * p.y(), 2.2 * p.z()); });
    Motion little;
    little.rotation = Eigen::AngleAxisd(0.2, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    const MeshRegistration registration = register_mesh(shaped(box, little), box);
    EXPECT_EQ(registration.verdict, RegistrationVerdict::aligned);
    EXPECT_EQ(registration.others.size(), 3U);
    EXPECT_LT(Eigen::AngleAxisd(registration.motion.after(little).rotation).angle(), 1e-3);
    ASSERT_FALSE(remarks_on(registration).empty());
    EXPECT_NE(remarks_on(registration).front().find("4 poses fit equally"), std::string::npos);
    EXPECT_TRUE(register_mesh(synthetic_mesh("hand", 2000), synthetic_mesh("hand", 2000)).others.empty());
}

TEST(MeshRegistration, ReportsSlippableMotions) {
    const Mesh ball = build_mesh(test::octahedron_sphere(4)), ring = build_mesh(test::torus(60, 30));
    const MeshRegistration of_ball = register_mesh(shaped(ball, any_similarity(ball, 8)), ball);
    EXPECT_EQ(of_ball.verdict, RegistrationVerdict::aligned);
    EXPECT_EQ(of_ball.slippable.kind, SlippableKind::sphere);
    EXPECT_TRUE(of_ball.others.empty());
    const MeshRegistration of_ring = register_mesh(shaped(ring, any_similarity(ring, 9)), ring);
    EXPECT_EQ(of_ring.verdict, RegistrationVerdict::aligned);
    EXPECT_EQ(of_ring.slippable.kind, SlippableKind::rotation);
    EXPECT_GT(std::abs(of_ring.slippable.direction.z()), 0.999);
    EXPECT_LE(of_ring.others.size(), 1U);  // turned over
}

TEST(MeshRegistration, WithoutScaleSizesMustAgree) {
    const Mesh pot = synthetic_mesh("teapot", 2000);
    MeshRegistrationOptions options;
    options.scale = false;
    const Motion motion = any_similarity(pot, 10);
    EXPECT_EQ(register_mesh(shaped(pot, motion), pot, options).verdict, RegistrationVerdict::different);
    Motion rigid = motion;
    rigid.scale = 1;
    const MeshRegistration registration = register_mesh(shaped(pot, rigid), pot, options);
    EXPECT_EQ(registration.verdict, RegistrationVerdict::aligned);
    EXPECT_EQ(registration.motion.scale, 1);
    EXPECT_LT(Eigen::AngleAxisd(registration.motion.after(rigid).rotation).angle(), 1e-4);
}

TEST(MeshRegistration, AnySizeOfBothMeshes) {
    const Mesh pot = synthetic_mesh("teapot", 1500);
    for (const double size : {1e-12, 1e12}) {
        Motion tiny, huge;
        tiny.scale = size;
        huge.scale = 1 / size;
        const MeshRegistration registration = register_mesh(shaped(pot, tiny), shaped(pot, huge));
        EXPECT_EQ(registration.verdict, RegistrationVerdict::aligned);
        EXPECT_NEAR(registration.motion.scale * size * size, 1, 1e-6);
    }
}

TEST(MeshRegistration, DegenerateMeshesAreRefusedOrHandled) {
    TriangleSoup triangle;
    triangle.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle.triangles = {{0, 1, 2}};
    TriangleSoup point = triangle;
    for (auto& p : point.points) p = {1, 1, 1};
    const Mesh flat = build_mesh(test::grid(5, 5, false, false, [](double u, double v) {
        return std::array<double, 3>{u, 2 * v, 0};
    }));
    const Mesh pot = synthetic_mesh("teapot", 1500);
    for (const Mesh& bad : {build_mesh(triangle), build_mesh(point), flat, Mesh()}) {
        EXPECT_THROW(register_mesh(bad, pot), Error);
        EXPECT_THROW(register_mesh(pot, bad), Error);
    }
    // Coincident points next to a valid surface, and faces without area.
    TriangleSoup soup = to_soup(pot);
    const Index n = static_cast<Index>(soup.points.size());
    for (int k = 0; k < 3; ++k) soup.points.push_back(soup.points[0]);
    soup.triangles.push_back({n, n + 1, n + 2});
    EXPECT_EQ(register_mesh(build_mesh(soup), pot).verdict, RegistrationVerdict::aligned);
}

TEST(MeshRegistration, SameForAnyNumberOfThreadsAndCancelled) {
    const Mesh a = synthetic_mesh("hand", 3000, 1), b = synthetic_mesh("hand", 5000, 2);
    const int before = threads();
    set_threads(1);
    const MeshRegistration single_threaded = register_mesh(a, b);
    set_threads(3);
    const MeshRegistration three = register_mesh(a, b);
    set_threads(before);
    EXPECT_EQ(single_threaded.motion, three.motion);
    EXPECT_EQ(single_threaded.agreement.rms, three.agreement.rms);
    EXPECT_EQ(single_threaded.mirrored.rms, three.mirrored.rms);
    Watch watch;
    watch.cancel();
    const WatchScope scope(&watch);
    EXPECT_THROW(register_mesh(a, b), Error);
}

}  // namespace
}  // namespace ostraka
