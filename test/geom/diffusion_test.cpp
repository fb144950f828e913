#include "ostraka/geom/diffusion.h"

#include "meshes.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"

#include <gtest/gtest.h>

#include <numbers>

namespace ostraka {
namespace {

/// On the unit sphere x, y, z are eigenfunctions of the Laplacian with eigenvalue 2: they shrink by exp(-2 t), t = sigma^2 / 2.
TEST(Diffusion, ShrinksTheCoordinatesOfASphereByTheHeatEquation) {
    const double sigma = 0.4;
    double last = 1;
    for (const int levels : {3, 4, 5}) {
        const Mesh mesh = build_mesh(test::octahedron_sphere(levels));
        const Eigen::MatrixXd x = Diffusion(mesh).smoothed(positions(mesh), sigma, 40);
        double error = 0;
        for (Eigen::Index v = 0; v < x.rows(); ++v) error = std::max(error, std::abs(x.row(v).norm() - std::exp(-sigma * sigma)));
        EXPECT_LT(error, 0.5 * last) << levels;
        last = error;
    }
    EXPECT_LT(last, 3e-3);
}

TEST(Diffusion, ScalesWithTheMeshAndIgnoresItsPosition) {
    const Mesh unit = build_mesh(test::octahedron_sphere(3));
    const Eigen::MatrixXd expected = Diffusion(unit).smoothed(positions(unit), 0.3, 2);
    for (const double scale : {1e-6, 1e6}) {
        const Mesh mesh = build_mesh(test::moved(test::octahedron_sphere(3), scale, {3 * scale, 0, -scale}));
        const Eigen::MatrixXd x = Diffusion(mesh).smoothed(positions(mesh), 0.3 * scale, 2);
        const Eigen::RowVector3d by(3 * scale, 0, -scale);
        EXPECT_LT(((x.rowwise() - by) / scale - expected).cwiseAbs().maxCoeff(), 1e-8) << scale;
    }
}

TEST(Diffusion, KeepsConstantsAndTheBorder) {
    const Mesh mesh = build_mesh(test::patch(12, 9));
    const Eigen::MatrixXd start = positions(mesh);
    const Eigen::MatrixXd ones = Eigen::MatrixXd::Ones(start.rows(), 1);
    EXPECT_LT((Diffusion(mesh).smoothed(ones, 2.0, 3) - ones).cwiseAbs().maxCoeff(), 1e-9);
    const Eigen::MatrixXd after = Diffusion(mesh).smoothed(start, 2.0, 3);
    for (const Vertex v : mesh.vertices()) {
        if (!mesh.is_border(v)) continue;
        const auto row = static_cast<Eigen::Index>(v.idx());
        EXPECT_EQ((after.row(row) - start.row(row)).norm(), 0);
    }
}

TEST(Diffusion, NothingOvershoots) {
    const Mesh mesh = build_mesh(test::torus(30, 12));
    Eigen::MatrixXd spike = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(mesh.number_of_vertices()), 1);
    spike(17, 0) = 1;
    const Eigen::MatrixXd after = Diffusion(mesh).smoothed(spike, 0.5);
    EXPECT_GE(after.minCoeff(), -1e-12);
    EXPECT_LT(after.maxCoeff(), 1);
    EXPECT_EQ((Diffusion(mesh).smoothed(spike, 0) - spike).norm(), 0);
}

TEST(Diffusion, RefusesInvalidArguments) {
    const Mesh mesh = build_mesh(test::octahedron_sphere(1));
    const Diffusion diffusion(mesh);
    EXPECT_THROW((void)diffusion.smoothed(positions(mesh), -1), Error);
    EXPECT_THROW((void)diffusion.smoothed(Eigen::MatrixXd::Zero(2, 1), 1), Error);
    EXPECT_EQ(Diffusion(Mesh()).smoothed(Eigen::MatrixXd(0, 3), 1).rows(), 0);
}

}  // namespace
}  // namespace ostraka
