// Mean value coordinates against closed forms, an independent reference and the formula in longer arithmetic.
#include "cages.h"
#include "ostraka/core/error.h"

#include <fstream>

namespace ostraka {
namespace {

using test::Cage;
using Real = long double;
using Real3 = std::array<Real, 3>;

Real3 cross(const Real3& a, const Real3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Real dot(const Real3& a, const Real3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Real length(const Real3& a) { return std::sqrt(dot(a, a)); }

/// The definition, w_i = sum over the faces of m . c_i / det, without stabilisation, in long double.
std::vector<double> by_definition(const Mesh& cage, const Point& x) {
    std::vector<Real> w(cage.number_of_vertices(), 0);
    for (const Face f : cage.faces()) {
        const auto corner = corners(cage, f);
        std::array<Real3, 3> p, c;
        Real3 m{0, 0, 0};
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < 3; ++i) p[k][i] = Real(cage.point(corner[k])[int(i)]) - Real(x[int(i)]);
        for (std::size_t k = 0; k < 3; ++k) {
            const Real3 &a = p[(k + 1) % 3], &b = p[(k + 2) % 3];
            c[k] = cross(a, b);
            const Real sine = length(c[k]), theta = std::atan2(sine, dot(a, b));
            for (std::size_t i = 0; i < 3; ++i) m[i] += 0.5L * theta / sine * c[k][i];
        }
        const Real det = dot(p[0], c[0]);
        for (std::size_t k = 0; k < 3; ++k) w[corner[k]] += dot(m, c[k]) / det;
    }
    Real sum = 0;
    for (const Real weight : w) sum += weight;
    std::vector<double> result;
    for (const Real weight : w) result.push_back(static_cast<double>(weight / sum));
    return result;
}

double difference(const Coordinates& c, Eigen::Index row, const std::vector<double>& w) {
    double maximum = 0;
    for (std::size_t j = 0; j < w.size(); ++j) maximum = std::max(maximum, std::abs(c.vertex(row, Eigen::Index(j)) - w[j]));
    return maximum;
}

TriangleSoup tetrahedron() {
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

TEST(MeanValue, InATetrahedronTheyAreBarycentric) {
    const Mesh cage = build_mesh(tetrahedron());
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(-0.3, 1.2);
    std::vector<Point> points{{0.25, 0.25, 0.25}, {0.2, 0.3, 0.5}, {0, 0.1, 0}, {1, 0, 0}, {1.0 / 3, 1.0 / 3, 1.0 / 3}};
    for (int i = 0; i < 2000; ++i) points.emplace_back(unit(random), unit(random), unit(random));
    const Coordinates c = compute_coordinates("mean-value", cage, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point& p = points[i];
        EXPECT_LT(difference(c, Eigen::Index(i), {1 - p.x() - p.y() - p.z(), p.x(), p.y(), p.z()}), 1e-13) << p;
    }
}

TEST(MeanValue, InARegularSolidTheCentreGivesEqualWeights) {
    for (const auto& soup : {test::octahedron_sphere(0), test::box(1)}) {
        const Mesh cage = build_mesh(soup);
        const double half = soup.points.size() == 8 ? 0.5 : 0;
        const Coordinates c = compute_coordinates("mean-value", cage, std::vector<Point>{{half, half, half}});
        // The box's diagonals favour the corners where they meet, but opposite corners stay equal.
        if (half == 0) {
            EXPECT_LT(difference(c, 0, std::vector<double>(6, 1.0 / 6)), 1e-15);
        }
        EXPECT_NEAR(c.vertex.sum(), 1, 1e-15);
    }
}

TEST(MeanValue, AgreeWithTheDefinitionInLongerArithmetic) {
    for (const Cage& cage : test::cages()) {
        if (cage.name == "tiny" || cage.name == "huge") continue;
        std::mt19937_64 random(11);
        std::uniform_real_distribution<double> unit(-0.1, 1.1);
        const CGAL::Bbox_3 box = bounding_box(cage.mesh);
        std::vector<Point> points;
        for (int i = 0; i < 100; ++i)
            points.emplace_back(box.xmin() + unit(random) * (box.xmax() - box.xmin()),
                                box.ymin() + unit(random) * (box.ymax() - box.ymin()),
                                box.zmin() + unit(random) * (box.zmax() - box.zmin()));
        const Coordinates c = compute_coordinates("mean-value", cage.mesh, points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            // Outside weights grow: relative to the largest.
            const double maximum = c.vertex.row(Eigen::Index(i)).cwiseAbs().maxCoeff();
            EXPECT_LT(difference(c, Eigen::Index(i), by_definition(cage.mesh, points[i])), 1e-10 * std::max(1.0, maximum))
                << cage.name << ' ' << points[i];
        }
    }
}

/// If the plane of a distant face passes through the point, or near it, the face's weights vanish with the distance: no jump, no
/// noise.
TEST(MeanValue, AreContinuousAcrossThePlaneOfADistantFace) {
    // An L whose inner corner lies at (1, 1): the plane x = 1 of one wall runs through the inside.
    const Mesh cage = build_mesh(
        {{{0, 0, 0},
          {2, 0, 0},
          {2, 1, 0},
          {1, 1, 0},
          {1, 2, 0},
          {0, 2, 0},
          {0, 0, 1},
          {2, 0, 1},
          {2, 1, 1},
          {1, 1, 1},
          {1, 2, 1},
          {0, 2, 1}},
         {{0, 3, 1}, {1, 3, 2}, {0, 5, 3}, {3, 5, 4}, {6, 7, 9}, {7, 8, 9},  {6, 9, 11}, {9, 10, 11}, {0, 1, 6},  {1, 7, 6},
          {1, 2, 7}, {2, 8, 7}, {2, 3, 8}, {3, 9, 8}, {3, 4, 9}, {4, 10, 9}, {4, 5, 10}, {5, 11, 10}, {5, 0, 11}, {0, 6, 11}}});
    const std::vector<double> heights{0, 1e-18, 1e-15, -1e-15, 1e-13, 1e-11, 1e-9, -1e-9, 1e-7, 1e-5, 1e-4, 1e-3, 3e-3};
    for (const auto& [y, z] : {std::pair{0.3, 0.4}, {0.6, 0.5}, {0.9, 0.2}, {0.15, 0.81}}) {
        std::vector<Point> points;
        for (const double h : heights) points.emplace_back(1 + h, y, z);
        const Coordinates c = compute_coordinates("mean-value", cage, points);
        for (std::size_t i = 1; i < points.size(); ++i) {
            const double h = std::abs(points[i].x() - 1);
            const double step = (c.vertex.row(Eigen::Index(i)) - c.vertex.row(0)).cwiseAbs().maxCoeff();
            EXPECT_LT(step, 10 * h + 1e-14) << h;
            if (h > 1e-8) {
                EXPECT_LT(difference(c, Eigen::Index(i), by_definition(cage, points[i])), 1e-15 / h + 1e-14) << h;
            }
        }
    }
    // The same on a slanted copy, where the plane cannot be met exactly.
    const double a = 0.3, b = 0.7;
    const auto rotated = [&](const Point& p) {
        const Point q(std::cos(a) * p.x() - std::sin(a) * p.y(), std::sin(a) * p.x() + std::cos(a) * p.y(), p.z());
        return Point(q.x(), std::cos(b) * q.y() - std::sin(b) * q.z(), std::sin(b) * q.y() + std::cos(b) * q.z());
    };
    Mesh rotated_cage = cage;
    for (const Vertex v : rotated_cage.vertices()) rotated_cage.point(v) = rotated(cage.point(v));
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(0.05, 0.95);
    std::vector<Point> flat, slanted;
    for (int i = 0; i < 500; ++i) flat.emplace_back(1, unit(random), unit(random)), slanted.push_back(rotated(flat.back()));
    const Coordinates f = compute_coordinates("mean-value", cage, flat),
                      s = compute_coordinates("mean-value", rotated_cage, slanted);
    EXPECT_LT((f.vertex - s.vertex).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(MeanValue, PublishedWeightsOfAnArm) {
    const Path folder = Path(OSTRAKA_SHARED_DATA) / "cage-supercages-arm";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no reference weights in " << folder;
    const Mesh arm = read_mesh(folder / "arm.obj").mesh, cage = read_mesh(folder / "arm_cage.obj").mesh;
    const Coordinates c = compute_coordinates("mean-value", cage, arm);
    ASSERT_EQ(c.vertex.rows(), 2089);
    ASSERT_EQ(c.vertex.cols(), 58);
    std::ifstream file(folder / "arm_cage_cageWeights.txt");
    Eigen::Index column = 0, row = 0;
    double weight = 0, worst = 0;
    std::size_t count = 0;
    while (file >> column >> row >> weight) {
        ASSERT_TRUE(column < 58 && row < 2089);
        worst = std::max(worst, std::abs(c.vertex(row, column) - weight));
        ++count;
    }
    EXPECT_EQ(count, 58U * 2089U);
    EXPECT_LT(worst, 3e-6);
    std::cout << "largest difference from the published weights: " << worst << '\n';
}

TEST(MeanValue, OnTheCageTheyAreLinear) {
    const Mesh cage = build_mesh(test::torus(12, 7));
    for (const Vertex v : cage.vertices()) {
        const Coordinates c = compute_coordinates("mean-value", cage, std::vector<Point>{cage.point(v)});
        EXPECT_EQ(c.vertex(0, v.idx()), 1);
        EXPECT_EQ(c.vertex.cwiseAbs().sum(), 1);
    }
}

TEST(MeanValue, AreInvariantToSimilarities) {
    const Mesh cage = build_mesh(test::torus(12, 7));
    std::vector<Point> points;
    for (const Vertex v : cage.vertices()) {
        const Point& p = cage.point(v);
        const double r = std::hypot(p.x(), p.y());
        // Towards the core circle.
        points.emplace_back(p.x() * (0.4 + 1.2 / r), p.y() * (0.4 + 1.2 / r), 0.3 * p.z());
    }
    const Coordinates c = compute_coordinates("mean-value", cage, points);
    for (const double scale : {1e-100, 0.3, 1e100}) {
        Mesh moved_cage = cage;
        std::vector<Point> moved;
        const auto move = [&](const Point& p) {
            return Point(scale * (0.6 * p.x() - 0.8 * p.y() + 3), scale * (0.8 * p.x() + 0.6 * p.y()), scale * (p.z() - 1));
        };
        for (const Vertex v : moved_cage.vertices()) moved_cage.point(v) = move(cage.point(v));
        for (const Point& p : points) moved.push_back(move(p));
        EXPECT_LT((compute_coordinates("mean-value", moved_cage, moved).vertex - c.vertex).cwiseAbs().maxCoeff(), 1e-13) << scale;
    }
}

}  // namespace
}  // namespace ostraka
