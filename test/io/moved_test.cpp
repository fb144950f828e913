// Triangles after a motion; rounding to single precision far from the origin.
#include "ostraka/io/moved.h"
#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/io/diagnose.h"
#include "scratch.h"

#include <Eigen/Geometry>

using namespace ostraka;
using namespace ostraka::test;

namespace {

Eigen::Matrix3d rotation(double angle) {
    return Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
}

/// Squared lengths of all edges, by triangle.
std::vector<double> edge_lengths(const TriangleSoup& soup) {
    std::vector<double> lengths;
    for (const auto& triangle : soup.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto &a = soup.points[triangle[k]], &b = soup.points[triangle[(k + 1) % 3]];
            lengths.push_back(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
        }
    return lengths;
}

TriangleSoup moved_by(TriangleSoup soup, const Motion& motion) {
    MeshExtras extras;
    move_triangles(soup, extras, motion);
    return soup;
}

/// What writing the mesh as STL is refused with; empty: it is written.
std::string stl_refusal(const TriangleSoup& soup, std::vector<std::string>* notes = nullptr) {
    const Scratch scratch;
    try {
        const auto result = write_triangles(scratch / "a.stl", soup);
        if (notes != nullptr) *notes = result;
    } catch (const Error& error) {
        EXPECT_EQ(count_files(scratch.path()), 0U);
        return error.what();
    }
    return {};
}

}  // namespace

TEST(MovedTriangles, AMirroredSurfaceStaysOrientedOutwards) {
    for (const Eigen::Vector3d& signs : {Eigen::Vector3d(-1, 1, 1), Eigen::Vector3d(1, 1, -1), Eigen::Vector3d(-1, -1, -1)}) {
        const TriangleSoup cube = box(2), mirrored = moved_by(cube, {signs.asDiagonal(), {3, 0, 0}, 2});
        const MeshDiagnosis diagnosis = diagnose(mirrored);
        EXPECT_TRUE(diagnosis.defects().empty());
        EXPECT_NEAR(diagnosis.volume, 8, 1e-13);
        for (std::size_t v = 0; v < cube.points.size(); ++v)
            for (int k = 0; k < 3; ++k) EXPECT_EQ(mirrored.points[v][k], 2 * signs[k] * cube.points[v][k] + (k == 0 ? 3 : 0));
    }
}

TEST(MovedTriangles, CornersKeepTheirTextureAndTetrahedraTheirVolume) {
    TriangleSoup soup{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
    MeshExtras extras;
    extras.tetrahedra = {{0, 1, 2, 3}};
    for (const auto& triangle : soup.triangles)
        for (const Index v : triangle) extras.corner_texture.push_back({static_cast<float>(v), 0.5F});
    move_triangles(soup, extras, {Eigen::Vector3d(1, -1, 1).asDiagonal(), {0, 0, 0}, 1});
    for (std::size_t t = 0; t < soup.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_EQ(extras.corner_texture[3 * t + k][0], static_cast<float>(soup.triangles[t][k]));
    const auto at = [&](std::size_t k) {
        const auto& p = soup.points[extras.tetrahedra[0][k]];
        return Eigen::Vector3d(p[0], p[1], p[2]);
    };
    EXPECT_EQ((at(1) - at(0)).cross(at(2) - at(0)).dot(at(3) - at(0)), 1);
}

TEST(MovedTriangles, TranslationsByRepresentableNumbersAreExact) {
    const TriangleSoup soup = torus(20, 10);
    const Motion there{Eigen::Matrix3d::Identity(), {1024, -0.5, 65536}, 1};
    const TriangleSoup moved = moved_by(soup, there);
    for (std::size_t v = 0; v < soup.points.size(); ++v)
        for (int k = 0; k < 3; ++k) EXPECT_EQ(moved.points[v][k], soup.points[v][k] + there.translation[k]);
    EXPECT_EQ(moved_by(moved, there.inverse()).points,
              moved_by(moved, {Eigen::Matrix3d::Identity(), {-1024, 0.5, -65536}, 1}).points);
}

TEST(MovedTriangles, TheShapeOfADistantObjectIsKeptToRounding) {
    // Coordinates of a national grid, turned about the place of the object and moved to the origin.
    const TriangleSoup far = moved(torus(60, 30), 1, {3512345.5, 5412345.25, 250});
    const Eigen::Vector3d place(3512345.5, 5412345.25, 250);
    for (const double scale : {1.0, 1000.0}) {
        Motion motion{rotation(0.7), {0, 0, 0}, scale};
        motion.translation = -scale * (motion.rotation * place);
        const auto before = edge_lengths(far), after = edge_lengths(moved_by(far, motion));
        for (std::size_t e = 0; e < before.size(); ++e) EXPECT_NEAR(after[e] / (scale * before[e]), 1, 2e-14);
    }
}

TEST(MovedTriangles, RefusesCoordinatesBeyondTheLimit) {
    TriangleSoup soup = box(1);
    MeshExtras extras;
    EXPECT_THROW(move_triangles(soup, extras, {Eigen::Matrix3d::Identity(), {0, 0, 0}, 1e61}), Error);
}

TEST(StlRounding, IsRefusedFarFromTheOrigin) {
    std::vector<std::string> notes;
    const TriangleSoup cells = moved(box(20), 1, {0.1, 0.2, 0.3});  // edges from 0.05
    EXPECT_EQ(stl_refusal(cells, &notes), "");
    ASSERT_FALSE(notes.empty());
    EXPECT_EQ(notes[0], "STL stores coordinates in single precision; they were rounded");
    EXPECT_EQ(stl_refusal(moved(box(20), 1, {1000.1, 0.2, 0.3})), "") << "0.06 % of the edges";
    for (const double away : {3e4, 5e5, 5e6}) {
        const std::string refused = stl_refusal(moved(box(20), 1, {away + 0.1, 0.2, 0.3}));
        EXPECT_NE(refused.find("too far from the origin"), std::string::npos) << refused;
        EXPECT_NE(refused.find("mesh move"), std::string::npos) << refused;
    }
    // Far away, but with coordinates of single precision: nothing is rounded.
    EXPECT_EQ(stl_refusal(moved(box(16), 1024, {1 << 23, 0, 0})), "");
}

TEST(StlRounding, OfShortEdgesIsNotedWhereNoPlaceWouldBeBetter) {
    TriangleSoup soup = torus(40, 20);
    soup.points[0] = soup.points[1];
    soup.points[0][0] += 1e-7;
    std::vector<std::string> notes;
    EXPECT_EQ(stl_refusal(soup, &notes), "");
    ASSERT_FALSE(notes.empty());
    EXPECT_NE(notes[0].find("of the shortest edge"), std::string::npos) << notes[0];
}
