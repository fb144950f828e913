#include "ostraka/revolution/surface_of_revolution.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"

#include <CGAL/boost/graph/Euler_operations.h>
#include <gtest/gtest.h>

#include "pot_sherds.h"
#include "sherds.h"

#include <cmath>
#include <numbers>

namespace ostraka {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double pi = std::numbers::pi;

using test::inside;
using test::outside;
using test::sherd;
using test::tilted;

Motion shifted(const Motion& motion, const Vector3d& by) {
    Motion other;
    other.translation = by;
    return other.after(motion);
}

/// Largest distance of the true wall from the template, both on one axis with their lowest points at the same height.
double worst(const RevolutionTemplate& revolved) {
    double maximum = 0;
    const double low = outside(0).y();
    for (int i = 0; i <= 50; ++i)
        for (const Vector2d& p : {outside(0.04 + 0.92 * i / 50), inside(0.04 + 0.92 * i / 50)}) {
            double minimum = 1e300;
            for (std::size_t k = 0; k + 1 < revolved.profile.size(); ++k) {
                const Vector2d a = revolved.profile[k], d = revolved.profile[k + 1] - a, q = p - Vector2d(0, low) - a;
                minimum = std::min(minimum, (q - std::clamp(q.dot(d) / d.squaredNorm(), 0.0, 1.0) * d).norm());
            }
            maximum = std::max(maximum, minimum);
        }
    return maximum;
}

TEST(RevolutionTemplate, IsTheVesselOfItsSherds) {
    const Motion pose = tilted();
    const Vector3d up = pose.rotation * Vector3d::UnitZ();
    const Fragment a = sherd(0, 2, 0, 0.7, pose), b = sherd(2.2, 4, 0.3, 1, pose), c = sherd(4.1, 6, 0, 1, pose);
    const RevolutionTemplate revolved = template_of_revolution({&a, &b, &c});
    EXPECT_GT(std::abs(eigen(revolved.axis.direction).dot(up)), 1 - 1e-5);
    EXPECT_LT((eigen(revolved.axis.point) - pose.translation).cross(up).norm(), 0.01);
    EXPECT_FALSE(revolved.base);
    EXPECT_TRUE(revolved.rim);
    EXPECT_TRUE(CGAL::is_closed(revolved.mesh));
    EXPECT_NEAR(double(revolved.mesh.number_of_vertices()), 25000, 1000);
    // Either end may be up: there is no base.
    const bool same_way = eigen(revolved.axis.direction).dot(up) > 0;
    if (same_way) {
        EXPECT_LT(worst(revolved), 0.02);
    }
    const SurfaceSearch surface(revolved.mesh);
    for (const Fragment* fragment : {&a, &b, &c})
        for (const Vertex v : fragment->mesh.vertices()) EXPECT_LT(surface.closest(fragment->mesh.point(v)).distance, 0.12);
    for (const SherdOnProfile& sherd_on_profile : revolved.sherds) {
        EXPECT_TRUE(sherd_on_profile.axis.found);
        EXPECT_LT(sherd_on_profile.lean, 0.3);
        EXPECT_LT(sherd_on_profile.aside, 0.01);
        EXPECT_LT(sherd_on_profile.residual, 0.01);
    }
    ASSERT_NO_THROW(check_annotations(revolved, "turned"));
    double outer = 0, inner = 0;
    for (const Annotation& annotation : revolved.annotations.annotations) {
        if (annotation.tag == "outer") outer = double(annotation.faces.size());
        if (annotation.tag == "inner") inner = double(annotation.faces.size());
    }
    EXPECT_GT(outer, inner);
    EXPECT_EQ(outer + inner, double(revolved.mesh.number_of_faces()));
}

TEST(RevolutionTemplate, GapsOfALayoutAreClosed) {
    const Motion pose = tilted();
    const Vector3d up = pose.rotation * Vector3d::UnitZ(), x = pose.rotation * Vector3d::UnitX();
    const Fragment a = sherd(0, 2, 0, 1, shifted(pose, 0.08 * x + 0.05 * up)), b = sherd(2.2, 4, 0, 1, pose),
                   c = sherd(4.1, 6, 0, 1, shifted(pose, -0.06 * x));
    const RevolutionTemplate revolved = template_of_revolution({&a, &b, &c});
    for (const SherdOnProfile& sherd_on_profile : revolved.sherds) EXPECT_LT(sherd_on_profile.residual, 0.02);
    EXPECT_GT((revolved.sherds[0].motion.translation - revolved.sherds[1].motion.translation).norm(), 0.05);
    EXPECT_NEAR((revolved.sherds[0].motion(pose.translation + 0.05 * up) - revolved.sherds[1].motion(pose.translation)).dot(up),
                0, 0.03);
}

TEST(RevolutionTemplate, OneSherdIsEnough) {
    const Fragment single = sherd(0, 2.5, 0, 1, {});
    const RevolutionTemplate revolved = template_of_revolution({&single});
    EXPECT_GT(std::abs(revolved.axis.direction.z()), 1 - 1e-4);
    EXPECT_TRUE(CGAL::is_closed(revolved.mesh));
    double widest = 0;
    for (const Vector2d& p : revolved.profile) widest = std::max(widest, p.x());
    EXPECT_NEAR(widest, 1.5, 0.02);
}

TEST(RevolutionTemplate, RefusesWhatIsNoSurfaceOfRevolution) {
    EXPECT_THROW(template_of_revolution({}), Error);
    Fragment open = sherd(0, 2, 0, 1, {});
    const Face first = *open.mesh.faces().begin();
    CGAL::Euler::remove_face(open.mesh.halfedge(first), open.mesh);
    open.mesh.collect_garbage();
    EXPECT_THROW(template_of_revolution({&open}), Error);
}

/// A flat piece: 1 x 1 x 0.1, its middle at the origin.
Fragment tile(const Motion& motion) {
    std::vector<int> side;
    const TriangleSoup soup = test::box_grid(
        {10, 10, 2},
        [&](double u, double v, double w) {
            const Vector3d p = motion({u - 0.5, v - 0.5, 0.1 * w - 0.05});
            return std::array<double, 3>{p.x(), p.y(), p.z()};
        },
        side);
    Fragment fragment;
    fragment.name = "tile";
    fragment.mesh = build_mesh(soup);
    return fragment;
}

Fragment named(const std::string& name, Fragment fragment) {
    fragment.name = name;
    return fragment;
}

std::vector<const Fragment*> pointers(const std::vector<Fragment>& fragments) {
    std::vector<const Fragment*> result;
    for (const Fragment& fragment : fragments) result.push_back(&fragment);
    return result;
}

/// Five sherds of the pot, from foot to rim, each below a third of the turn.
std::vector<Fragment> five_sherds(const Motion& pose) {
    std::vector<Fragment> sherds;
    sherds.push_back(named("a", sherd(0, 1.2, 0, 0.6, pose)));
    sherds.push_back(named("b", sherd(1.5, 2.6, 0.4, 1, pose)));
    sherds.push_back(named("c", sherd(2.8, 4, 0, 0.5, pose)));
    sherds.push_back(named("d", sherd(4, 5, 0.45, 1, pose)));
    sherds.push_back(named("e", sherd(5.2, 6.2, 0.2, 0.8, pose)));
    return sherds;
}

TEST(RevolutionTemplate, ThreeOfEightSherdsAreLeftOut) {
    const Motion pose = tilted();
    const Vector3d up = pose.rotation * Vector3d::UnitZ();
    std::vector<Fragment> sherds = five_sherds(pose);
    Motion anywhere;
    anywhere.rotation = Eigen::AngleAxisd(1.1, Vector3d(1, 0.2, 0.4).normalized()).toRotationMatrix();
    anywhere.translation = pose.translation + Vector3d(2, 1, 0.5);
    sherds.insert(sherds.begin() + 1, named("elsewhere", sherd(0, 1.5, 0, 0.9, anywhere)));
    Motion beside = pose;
    beside.translation += pose.rotation * Vector3d(1.4, 0.2, 1.3);
    beside.rotation = pose.rotation * Eigen::AngleAxisd(0.5, Vector3d::UnitX()).toRotationMatrix();
    sherds.insert(sherds.begin() + 3, named("flat", tile(beside)));
    Fragment large = named("inches", sherd(2.6, 4, 0.2, 0.9, pose));
    large.mesh = scaled_by(large.mesh, 25.4);
    sherds.push_back(std::move(large));
    const RevolutionTemplate revolved = template_of_revolution(pointers(sherds));
    for (const SherdOnProfile& sherd_on_profile : revolved.sherds) {
        const bool belongs = sherd_on_profile.name.size() == 1;
        EXPECT_EQ(sherd_on_profile.use == SherdUse::left_out, !belongs)
            << sherd_on_profile.name << ": " << sherd_on_profile.reason;
        EXPECT_EQ(sherd_on_profile.reason.empty(), sherd_on_profile.use == SherdUse::used) << sherd_on_profile.name;
        if (belongs) {
            EXPECT_LT(sherd_on_profile.residual, 0.01) << sherd_on_profile.name;
            EXPECT_GT(sherd_on_profile.weight, 0.02) << sherd_on_profile.name;
        }
    }
    EXPECT_GT(std::abs(eigen(revolved.axis.direction).dot(up)), 1 - 1e-5);
    EXPECT_LT((eigen(revolved.axis.point) - pose.translation).cross(up).norm(), 0.01);
    EXPECT_LT(revolved.direction_error, 1);
    if (eigen(revolved.axis.direction).dot(up) > 0) {
        EXPECT_LT(worst(revolved), 0.02);
    }
    EXPECT_TRUE(CGAL::is_closed(revolved.mesh));
}

TEST(RevolutionTemplate, AShortArcContributesItsWallsButLittleToTheAxis) {
    const Motion pose = tilted();
    const std::vector<Fragment> sherds{named("wide", sherd(0, 2.2, 0, 1, pose)), named("wider", sherd(2.4, 5, 0, 1, pose)),
                                       named("narrow", sherd(5.2, 5.4, 0.4, 0.5, pose))};
    const RevolutionTemplate revolved = template_of_revolution(pointers(sherds));
    EXPECT_EQ(revolved.sherds[0].use, SherdUse::used);
    EXPECT_EQ(revolved.sherds[1].use, SherdUse::used);
    EXPECT_NE(revolved.sherds[2].use, SherdUse::left_out) << revolved.sherds[2].reason;
    EXPECT_LT(revolved.sherds[2].weight, 0.8 * std::min(revolved.sherds[0].weight, revolved.sherds[1].weight));
    EXPECT_LT(revolved.sherds[2].residual, 0.01);
    double sum = 0;
    for (const SherdOnProfile& sherd_on_profile : revolved.sherds) sum += sherd_on_profile.weight;
    EXPECT_NEAR(sum, 1, 1e-6);
}

TEST(RevolutionTemplate, AnOpenSherdContributesItsAxisAndAnInvertedOneIsReversed) {
    const Motion pose = tilted();
    std::vector<Fragment> sherds = five_sherds(pose);
    CGAL::Euler::remove_face(sherds[2].mesh.halfedge(*sherds[2].mesh.faces().begin()), sherds[2].mesh);
    sherds[2].mesh.collect_garbage();
    TriangleSoup soup = to_soup(sherds[3].mesh);
    for (auto& t : soup.triangles) std::swap(t[1], t[2]);
    sherds[3].mesh = build_mesh(soup);
    const RevolutionTemplate revolved = template_of_revolution(pointers(sherds));
    EXPECT_EQ(revolved.sherds[2].use, SherdUse::partly);
    EXPECT_NE(revolved.sherds[2].reason.find("not closed"), std::string::npos);
    EXPECT_NE(revolved.sherds[2].remedy.find("mesh repair"), std::string::npos);
    EXPECT_GT(revolved.sherds[2].weight, 0.05);
    EXPECT_EQ(revolved.sherds[3].use, SherdUse::used);
    EXPECT_LT(revolved.sherds[3].residual, 0.01);
    ASSERT_FALSE(revolved.notes.empty());
    EXPECT_NE(revolved.notes[0].find("inside out"), std::string::npos);
    double area = 0, volume = 0;
    for (const Face f : revolved.mesh.faces()) {
        const auto [a, b, c] = corners(revolved.mesh, f);
        area += face_area(revolved.mesh, f);
        volume += eigen(revolved.mesh.point(a)).dot(eigen(revolved.mesh.point(b)).cross(eigen(revolved.mesh.point(c)))) / 6;
    }
    EXPECT_GT(volume, 0) << area;
}

TEST(RevolutionTemplate, HalfAFloorIsEnough) {
    std::vector<Fragment> sherds = five_sherds({});
    std::vector<int> side;
    Fragment& floor = sherds.emplace_back();
    floor.name = "floor";
    // Broken along the plane through the axis; its edge lies a little inside the wall's.
    floor.mesh = build_mesh(test::box_grid(
        {30, 15, 4},
        [](double u, double v, double w) {
            const double x = 1.8 * u - 0.9;
            return std::array<double, 3>{x, v * std::sqrt(0.93 * 0.93 - x * x), 0.2 * w};
        },
        side));
    for (const int side_number : side)
        floor.facets.push_back(side_number < 4 ? Facet::fracture : side_number == 4 ? Facet::outer : Facet::inner);
    const RevolutionTemplate revolved = template_of_revolution(pointers(sherds));
    ASSERT_EQ(revolved.axis.direction.z() > 0.99, true);
    EXPECT_TRUE(revolved.base);
    EXPECT_NE(revolved.sherds.back().use, SherdUse::left_out) << revolved.sherds.back().reason;
    double low = 1, high = -1;
    for (const Vector2d& p : revolved.profile)
        if (p.x() > 0.2 && p.x() < 0.6 && p.y() < 0.5) low = std::min(low, p.y()), high = std::max(high, p.y());
    EXPECT_NEAR(low, 0, 0.03);
    EXPECT_NEAR(high - low, 0.2, 0.02);
}

TEST(RevolutionTemplate, IfNoSherdIsUsableAllAreNamed) {
    Fragment few;
    few.name = "few";
    few.mesh = build_mesh(to_soup(tile({}).mesh));
    std::vector<int> side;
    few.mesh = build_mesh(test::box_grid(
        {1, 1, 1},
        [](double u, double v, double w) {
            return std::array<double, 3>{u, v, w};
        },
        side));
    Motion other = tilted();
    const std::vector<Fragment> sherds{named("first tile", tile({})), named("second tile", tile(other)), few, {}};
    try {
        template_of_revolution(pointers(sherds));
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        const std::string text = error.what();
        for (const char* name : {"first tile", "second tile", "few", "no faces"})
            EXPECT_NE(text.find(name), std::string::npos) << text;
        EXPECT_FALSE(error.remedy().empty());
    }
}

TEST(RevolutionTemplate, OneOfTwoContradictingSherdsIsLeftOut) {
    Motion aside;
    aside.rotation = Eigen::AngleAxisd(0.7, Vector3d::UnitX()).toRotationMatrix();
    const Fragment a = sherd(0, 2.5, 0, 1, {}), b = sherd(2.7, 4, 0, 1, aside);
    const RevolutionTemplate revolved = template_of_revolution({&a, &b});
    EXPECT_EQ(revolved.sherds[0].use, SherdUse::used);
    EXPECT_EQ(revolved.sherds[1].use, SherdUse::left_out);
    EXPECT_NE(revolved.sherds[1].reason.find("leans by 40"), std::string::npos) << revolved.sherds[1].reason;
    EXPECT_FALSE(revolved.sherds[1].remedy.empty());
    EXPECT_GT(std::abs(revolved.axis.direction.z()), 1 - 1e-5);
}

}  // namespace
}  // namespace ostraka
