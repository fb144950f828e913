// Green coordinates against their defining integrals, and their properties.
#include "cages.h"
#include "ostraka/core/error.h"

#include <cmath>

namespace ostraka {
namespace {

/// Integral over the triangle abc by cutting it into n x n equal ones, with the seven-point rule of degree 5 on each.
template <class Function>
double integral(const Point& a, const Point& b, const Point& c, int n, Function&& f) {
    static const double r = std::sqrt(15.0), s = (6 - r) / 21, t = (6 + r) / 21;
    const std::array<std::array<double, 3>, 7> rule{{{1.0 / 3, 1.0 / 3, 9.0 / 40},
                                                     {s, s, (155 - r) / 1200},
                                                     {1 - 2 * s, s, (155 - r) / 1200},
                                                     {s, 1 - 2 * s, (155 - r) / 1200},
                                                     {t, t, (155 + r) / 1200},
                                                     {1 - 2 * t, t, (155 + r) / 1200},
                                                     {t, 1 - 2 * t, (155 + r) / 1200}}};
    const double area = std::sqrt(CGAL::cross_product(b - a, c - a).squared_length()) / 2 / n / n;
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n - i; ++j)
            for (const bool flipped : {false, true}) {
                if (flipped && j == n - i - 1) continue;
                for (const auto& [u, v, weight] : rule) {
                    const double U = flipped ? (i + 1 - u) / n : (i + u) / n, V = flipped ? (j + 1 - v) / n : (j + v) / n;
                    sum += weight * area * f(a + (U * (b - a) + V * (c - a)), 1 - U - V, U, V);
                }
            }
    return sum;
}

TEST(Green, MatchTheDefiningIntegrals) {
    const Mesh cage = build_mesh(test::torus(9, 6));
    const std::vector<Point> points{{2.1, 0.1, 0.2}, {-1.5, 1.2, -0.3}, {0.2, -1.8, 0.4}};
    const Coordinates c = compute_coordinates("green", cage, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        std::vector<double> phi(cage.number_of_vertices(), 0);
        for (const Face f : cage.faces()) {
            const auto corner = corners(cage, f);
            const Point A = cage.point(corner[0]), B = cage.point(corner[1]), C = cage.point(corner[2]);
            Vector n = CGAL::cross_product(B - A, C - A);
            n = n / std::sqrt(n.squared_length());
            const double psi = integral(A, B, C, 40, [&](const Point& y, double, double, double) {
                return 1 / (4 * M_PI * std::sqrt((y - points[i]).squared_length()));
            });
            EXPECT_NEAR(c.normal(Eigen::Index(i), f.idx()), psi, 1e-9);
            for (std::size_t k = 0; k < 3; ++k)
                phi[corner[k]] += integral(A, B, C, 40, [&](const Point& y, double g0, double g1, double g2) {
                    const Vector r = y - points[i];
                    return (k == 0 ? g0 : k == 1 ? g1 : g2) * (r * n) / (4 * M_PI * std::pow(r.squared_length(), 1.5));
                });
        }
        for (std::size_t j = 0; j < phi.size(); ++j) EXPECT_NEAR(c.vertex(Eigen::Index(i), Eigen::Index(j)), phi[j], 1e-9);
    }
}

TEST(Green, FollowSimilaritiesOfTheCageWithTheirNormals) {
    const Mesh cage = build_mesh(test::octahedron_sphere(1));
    std::vector<Point> points;
    for (const Vertex v : cage.vertices()) points.push_back(CGAL::ORIGIN + 0.7 * (cage.point(v) - CGAL::ORIGIN));
    const Coordinates c = compute_coordinates("green", cage, points);
    const auto move = [](const Point& p) {
        return Point(2.5 * (0.6 * p.x() - 0.8 * p.y()) + 10, 2.5 * (0.8 * p.x() + 0.6 * p.y()), 2.5 * p.z() - 3);
    };
    std::vector<Point> moved;
    for (const Vertex v : cage.vertices()) moved.push_back(move(cage.point(v)));
    const auto result = deformed(c, cage, moved);
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_LT(std::sqrt((result[i] - move(points[i])).squared_length()), 1e-13);
    // A stretch is followed only approximately, which preserves angles. The normals have an influence.
    Coordinates without = c;
    without.normal.resize(0, 0);
    EXPECT_GT(std::sqrt((deformed(without, cage, moved)[0] - move(points[0])).squared_length()), 0.1);
}

TEST(Green, RejectsPointsThatAreNotStrictlyInside) {
    const Mesh cage = build_mesh(test::box(2));
    const auto problem = [&](const std::vector<Point>& points, const Mesh& mesh) {
        try {
            (void)compute_coordinates("green", mesh, points);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input);
            EXPECT_FALSE(error.remedy().empty());
            return error.problem();
        }
        return std::string("accepted");
    };
    const Point inside(0.4, 0.3, 0.6);
    EXPECT_EQ(problem({inside}, cage), "accepted");
    EXPECT_EQ(problem({inside, {0.5, 0.5, 1 - 1e-12}}, cage), "accepted");
    EXPECT_NE(problem({inside, {2, 0, 0}}, cage).find("1 point does not lie strictly inside"), std::string::npos);
    EXPECT_NE(problem({inside, {2, 0, 0}}, cage).find(": 1"), std::string::npos);
    // On a face, across an edge of coplanar faces, on an edge, on a vertex, in the plane of a face but outside.
    for (const Point& p :
         {Point(0.3, 0.2, 1), {0.25, 0.25, 0}, {0.5, 0.25, 1}, {1, 1, 0.3}, {0, 0, 0}, {0.5, 0.5, 1}, {1.5, 0.2, 1}})
        EXPECT_NE(problem({inside, inside, p}, cage).find(": 2"), std::string::npos) << p;
    Mesh inverted = cage;
    for (const Vertex v : inverted.vertices()) {
        const Point p = cage.point(v);
        inverted.point(v) = Point(-p.x(), p.y(), p.z());
    }
    EXPECT_NE(problem({{-0.4, 0.3, 0.6}}, inverted).find("inside out"), std::string::npos);
}

}  // namespace
}  // namespace ostraka
