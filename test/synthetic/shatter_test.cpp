#include "shatter.h"

#include "meshes.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"

#include <CGAL/boost/graph/helpers.h>
#include <gtest/gtest.h>

#include <algorithm>
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

TEST(Shatter, APotIsClosedAndAsThickAsRequested) {
    for (const std::uint64_t shape : {1, 2, 3}) {
        PotOptions options = coarse();
        options.shape = shape;
        const Mesh pot = make_pot(options);
        EXPECT_TRUE(CGAL::is_closed(pot));
        // Area times half of the wall thickness, up to rim and curvature.
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
    for (const Sherd& sherd : sherds) {
        EXPECT_TRUE(CGAL::is_closed(sherd.mesh));
        EXPECT_GT(volume(sherd.mesh), 0);
        sum += volume(sherd.mesh);
        Eigen::Vector3d broken = Eigen::Vector3d::Zero();
        for (const Face f : sherd.mesh.faces()) {
            if (sherd.broken[f]) broken += eigen(area_vector(sherd.mesh, f));
            else intact += face_area(sherd.mesh, f);
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
    for (const Sherd& sherd : a) worn += volume(sherd.mesh);
    EXPECT_LT(worn, volume(pot));
}

TEST(Shatter, BreaksArchAndWearDiffersOverThem) {
    const Mesh ball = build_mesh(test::octahedron_sphere(5));
    ShatterOptions options;
    options.pieces = 2;
    options.roughness = 0;
    const auto flat = shatter(ball, options);
    options.bow = 0.3;
    const auto arched = shatter(ball, options);
    // A plane through the centroids of the fracture's faces; the spread is measured perpendicular to it.
    const auto off_plane = [](const Sherd& sherd) {
        Eigen::Vector3d mean = Eigen::Vector3d::Zero();
        double count = 0;
        for (const Face f : sherd.mesh.faces())
            if (sherd.broken[f]) mean += eigen(centroid(sherd.mesh, f)), ++count;
        mean /= count;
        Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
        for (const Face f : sherd.mesh.faces()) {
            const Eigen::Vector3d d = eigen(centroid(sherd.mesh, f)) - mean;
            if (sherd.broken[f]) spread += d * d.transpose() / count;
        }
        return std::sqrt(std::max(0.0, symmetric_eigenvalues(spread)[0]));
    };
    EXPECT_NEAR(off_plane(flat[0]), 0, 1e-6);
    EXPECT_GT(off_plane(arched[0]), 0.01);
    options.bow = 0;
    options.erosion = 0.02;
    options.patchiness = 1;
    const auto worn = shatter(ball, options);
    ASSERT_EQ(worn[0].mesh.number_of_vertices(), flat[0].mesh.number_of_vertices());
    const SurfaceSearch cut(flat[0].mesh);
    double least = 1, most = 0;
    for (const Face f : worn[0].mesh.faces()) {
        const double depth = cut.closest(centroid(worn[0].mesh, f)).distance;
        if (worn[0].broken[f]) least = std::min(least, depth), most = std::max(most, depth);
    }
    EXPECT_GT(most, 5 * least);
    EXPECT_LT(most, 2.1 * options.erosion * box_diagonal(ball));
}

TEST(Shatter, RemeshedSherdsShareOnlyTheirShape) {
    const Mesh pot = make_pot(coarse());
    ShatterOptions options;
    options.pieces = 3;
    const auto cut = shatter(pot, options);
    options.edge = 0.012;
    const auto anew = shatter(pot, options);
    ASSERT_EQ(anew.size(), cut.size());
    const double length = options.edge * box_diagonal(pot);
    std::vector<std::array<double, 3>> places;
    for (std::size_t k = 0; k < anew.size(); ++k) {
        EXPECT_TRUE(CGAL::is_closed(anew[k].mesh));
        EXPECT_NEAR(mean_edge_length(anew[k].mesh), length, 0.25 * length);
        EXPECT_NEAR(volume(anew[k].mesh), volume(cut[k].mesh), 0.02 * volume(cut[k].mesh));
        ASSERT_EQ(anew[k].broken.size(), anew[k].mesh.number_of_faces());
        double before = 0, after = 0;
        for (const Face f : cut[k].mesh.faces()) before += cut[k].broken[f] ? face_area(cut[k].mesh, f) : 0;
        for (const Face f : anew[k].mesh.faces()) after += anew[k].broken[f] ? face_area(anew[k].mesh, f) : 0;
        EXPECT_NEAR(after, before, 0.1 * before);
        const SurfaceSearch surface(cut[k].mesh);
        for (const Vertex v : anew[k].mesh.vertices()) {
            EXPECT_LT(surface.closest(anew[k].mesh.point(v)).distance, 0.1 * length);
            const Point p = anew[k].mesh.point(v);
            places.push_back({p.x(), p.y(), p.z()});
        }
    }
    std::sort(places.begin(), places.end());
    EXPECT_EQ(std::adjacent_find(places.begin(), places.end()), places.end()) << "no vertex is on two sherds";
}

TEST(Shatter, ReliefDisplacesTheSurfaceAsRequested) {
    const Mesh ball = build_mesh(test::octahedron_sphere(5));
    const Mesh rough = with_relief(ball, 0.005, 0.2, 1);
    double square = 0;
    for (const Vertex v : rough.vertices()) square += std::pow(eigen(rough.point(v)).norm() - 1, 2);
    EXPECT_NEAR(std::sqrt(square / static_cast<double>(rough.number_of_vertices())), 0.005 * box_diagonal(ball), 0.002);
}

TEST(Shatter, NeedsAnInside) {
    TriangleSoup open = test::octahedron_sphere(2);
    open.triangles.pop_back();
    EXPECT_THROW((void)shatter(build_mesh(open), {}), Error);
    EXPECT_THROW((void)shatter(Mesh(), {}), Error);
    ShatterOptions options;
    options.pieces = 1;
    EXPECT_EQ(shatter(build_mesh(test::octahedron_sphere(2)), options).size(), 1U);
}

TEST(Shatter, ABodyThatCrossesItselfIsRefusedAsAnErrorOrBroken) {
    // Nested pots: cuts run along their intersection.
    const Mesh pot = make_pot(coarse());
    TriangleSoup soup = to_soup(pot);
    const std::size_t points = soup.points.size(), triangles = soup.triangles.size();
    for (std::size_t k = 0; k < points; ++k) {
        const auto p = soup.points[k];
        soup.points.push_back({p[0] + 0.31, p[1] + 0.17, p[2] + 0.23});
    }
    for (std::size_t k = 0; k < triangles; ++k) {
        auto corner = soup.triangles[k];
        for (Index& index : corner) index += static_cast<Index>(points);
        soup.triangles.push_back(corner);
    }
    const Mesh both = build_mesh(soup);
    for (const std::uint64_t seed : {1, 2, 3}) {
        ShatterOptions options;
        options.pieces = 3;
        options.seed = seed;
        try {
            for (const Sherd& sherd : shatter(both, options)) EXPECT_TRUE(CGAL::is_closed(sherd.mesh));
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::failure) << error.what();
        }
    }
}

}  // namespace
}  // namespace ostraka
