// Properties that hold for every cage and every point.
#include "cages.h"

namespace ostraka {
namespace {

using test::Cage;
using test::cages;

double relative_error(const Coordinates& c, const Mesh& cage, const std::vector<Point>& points, double& partition) {
    double maximum = 0;
    partition = 0;
    const std::vector<Vector> normals = stretched_normals(cage, points_of(cage));
    const double diagonal = box_diagonal(cage);
    for (Eigen::Index i = 0; i < c.vertex.rows(); ++i) {
        double sum = 0;
        Vector error(0, 0, 0);
        for (const Vertex v : cage.vertices()) {
            sum += c.vertex(i, v.idx());
            error += c.vertex(i, v.idx()) * (cage.point(v) - points[static_cast<std::size_t>(i)]);
        }
        if (c.has_normals())
            for (const Face f : cage.faces()) error += c.normal(i, f.idx()) * normals[f];
        partition = std::max(partition, std::abs(sum - 1));
        maximum = std::max(maximum, std::sqrt(error.squared_length()) / diagonal);
    }
    return maximum;
}

TEST(Laws, MeanValue) {
    for (const Cage& cage : cages()) {
        const auto points = test::places(cage.mesh);
        const Coordinates c = compute_coordinates("mean-value", cage.mesh, points);
        double partition = 0;
        const double linear = relative_error(c, cage.mesh, points, partition);
        EXPECT_LE(partition, 1e-12) << cage.name;
        EXPECT_LE(linear, 1e-11) << cage.name;
    }
}

TEST(Laws, Green) {
    for (const Cage& cage : cages()) {
        std::vector<Point> points;
        for (const Point& p : test::places(cage.mesh)) {
            const double winding_number = test::winding_number(cage.mesh, p);
            if (winding_number > 0.999 && winding_number < 1.001 && test::distance(cage.mesh, p) > 1e-12) points.push_back(p);
        }
        const Coordinates c = compute_coordinates("green", cage.mesh, points);
        double partition = 0;
        const double linear = relative_error(c, cage.mesh, points, partition);
        EXPECT_LE(partition, 1e-10) << cage.name;
        EXPECT_LE(linear, 1e-10) << cage.name;
    }
}

}  // namespace
}  // namespace ostraka
