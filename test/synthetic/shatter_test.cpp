#include "shatter.h"

#include "meshes.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"

#include <CGAL/boost/graph/helpers.h>
#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

double volume(const Mesh& mesh) {
    double sum = 0;
    for (const Face f : mesh.faces()) sum += eigen(centroid(mesh, f)).dot(eigen(area_vector(mesh, f))) / 3;
    return sum;
}

PotOptions coarse() {
    PotOptions options;
    options.edge = 0.6;
    return options;
}

TEST(Shatter, APotIsClosedAndAsThickAsAsked) {
    for (const std::uint64_t shape : {1, 2, 3}) {
        PotOptions options = coarse();
        options.shape = shape;
        const Mesh pot = make_pot(options);
        EXPECT_TRUE(CGAL::is_closed(pot));
        // Area times half of the wall, but for rim and curvature.
        EXPECT_NEAR(volume(pot), 0.5 * options.wall * surface_area(pot), 0.15 * volume(pot));
    }
    PotOptions thick = coarse();
    thick.wall = 4;
    EXPECT_THROW((void)make_pot(thick), Error);
}

TEST(Shatter, PiecesMakeTheWhole) {
    const Mesh pot = make_pot(coarse());
    ShatterOptions options;
    options.pieces = 5;
    const std::vector<Sherd> sherds = shatter(pot, options);
    EXPECT_GE(sherds.size(), 5U);
    double sum = 0, intact = 0, up = 0;
    for (const Sherd& one : sherds) {
        EXPECT_TRUE(CGAL::is_closed(one.mesh));
        EXPECT_GT(volume(one.mesh), 0);
        sum += volume(one.mesh);
        Eigen::Vector3d broken = Eigen::Vector3d::Zero();
        for (const Face f : one.mesh.faces()) {
            if (one.broken[f]) broken += eigen(area_vector(one.mesh, f));
            else intact += face_area(one.mesh, f);
        }
        up += broken.z();
    }
    EXPECT_NEAR(sum, volume(pot), 1e-9 * sum);
    EXPECT_NEAR(intact, surface_area(pot), 1e-6 * intact);
    EXPECT_NEAR(up, 0, 1e-6 * intact) << "breaks face each other";
}

TEST(Shatter, SameSeedSamePieces) {
    const Mesh pot = make_pot(coarse());
    ShatterOptions options;
    options.pieces = 3;
    options.erosion = 0.003;
    options.noise = 0.0005;
    const auto a = shatter(pot, options), b = shatter(pot, options);
    options.seed = 2;
    const auto c = shatter(pot, options);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(mesh_checksum(a[k].mesh), mesh_checksum(b[k].mesh));
    EXPECT_NE(mesh_checksum(a[0].mesh), mesh_checksum(c[0].mesh));
    double worn = 0;
    for (const Sherd& one : a) worn += volume(one.mesh);
    EXPECT_LT(worn, volume(pot));
}

TEST(Shatter, NeedsAnInside) {
    TriangleSoup open = test::octahedron_sphere(2);
    open.triangles.pop_back();
    EXPECT_THROW((void)shatter(build_mesh(open), {}), Error);
    EXPECT_THROW((void)shatter(Mesh(), {}), Error);
    ShatterOptions one;
    one.pieces = 1;
    EXPECT_EQ(shatter(build_mesh(test::octahedron_sphere(2)), one).size(), 1U);
}

}  // namespace
}  // namespace ostraka
