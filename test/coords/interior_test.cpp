// Coordinates whose weights are not negative: harmonic, local, positive mean value.
#include "cages.h"
#include "ostraka/coords/certificate.h"
#include "ostraka/coords/coordinate_file.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/files/npy.h"
#include "scratch.h"

#include <cmath>

namespace ostraka {
namespace {

const std::vector<std::string> kinds{"harmonic", "local", "positive-mean-value"};

/// Sufficient to test the properties quickly.
CoordinateOptions quick(std::uint64_t nodes = 1500) {
    CoordinateOptions options;
    options.nodes = nodes;
    options.iterations = 60;
    return options;
}

TriangleSoup tetrahedron() {
    TriangleSoup soup;
    soup.points = {{0, 0, 0}, {2, 0, 0}, {0.3, 1.5, 0}, {0.4, 0.2, 1.8}};
    soup.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    return soup;
}

/// Two arms that stand up from a foot, a gap between them.
TriangleSoup fork() {
    // A U in the x-z plane, from (0, 0) to (5, 6): the gap from x = 2 to 3, above z = 1.
    const std::vector<std::array<double, 2>> outline{{0, 0}, {2, 0}, {3, 0}, {5, 0}, {5, 1}, {5, 3}, {5, 6}, {3, 6},
                                                     {3, 3}, {3, 1}, {2, 1}, {2, 3}, {2, 6}, {0, 6}, {0, 3}, {0, 1}};
    const std::vector<std::array<int, 4>> quads{{0, 1, 10, 15}, {1, 2, 9, 10},    {2, 3, 4, 9},    {4, 5, 8, 9},
                                                {5, 6, 7, 8},   {15, 10, 11, 14}, {14, 11, 12, 13}};
    TriangleSoup soup;
    const auto n = static_cast<Index>(outline.size());
    for (const double y : {0.0, 2.0})
        for (const auto& [x, z] : outline) soup.points.push_back({x, y, z});
    for (const auto& q : quads) {
        const auto corner = [&](int k) { return static_cast<Index>(q.at(static_cast<std::size_t>(k))); };
        // In front (y = 0) the outline runs counter-clockwise seen from -y.
        soup.triangles.push_back({corner(0), corner(1), corner(2)});
        soup.triangles.push_back({corner(0), corner(2), corner(3)});
        soup.triangles.push_back({corner(0) + n, corner(2) + n, corner(1) + n});
        soup.triangles.push_back({corner(0) + n, corner(3) + n, corner(2) + n});
    }
    for (Index i = 0; i < n; ++i) {
        const Index j = (i + 1) % n;
        soup.triangles.push_back({i, i + n, j + n});
        soup.triangles.push_back({i, j + n, j});
    }
    return soup;
}

std::vector<Point> grid_in(const std::array<double, 3>& low, const std::array<double, 3>& high, int count) {
    std::vector<Point> points;
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j)
            for (int k = 0; k < count; ++k) {
                const auto coordinate = [&](int axis, int step) {
                    const auto a = static_cast<std::size_t>(axis);
                    return low[a] + (high[a] - low[a]) * (step + 0.5) / count;
                };
                points.emplace_back(coordinate(0, i), coordinate(1, j), coordinate(2, k));
            }
    return points;
}

void expect_promises(const Coordinates& c, const Mesh& cage, const std::vector<Point>& points, const std::string& kind_name) {
    const CoordinateCertificate certificate = certify(c, cage, points, quick());
    EXPECT_LE(certificate.partition, 1e-11) << kind_name;
    EXPECT_LE(certificate.linear, 1e-11) << kind_name;
    EXPECT_EQ(certificate.negative, 0) << kind_name;
    ASSERT_TRUE(certificate.lagrange) << kind_name;
    EXPECT_LE(*certificate.lagrange, 1e-9) << kind_name;
    EXPECT_LE(*certificate.edges, 1e-9) << kind_name;
    EXPECT_LE(*certificate.on_faces, 1e-9) << kind_name;
    EXPECT_EQ(Eigen::MatrixXd(c.sparse), Eigen::MatrixXd(c.vertex)) << kind_name;
}

TEST(InteriorCoordinates, InATetrahedronAreBarycentric) {
    const Mesh cage = build_mesh(tetrahedron());
    const Point a = cage.point(Vertex(0)), b = cage.point(Vertex(1)), c = cage.point(Vertex(2)), d = cage.point(Vertex(3));
    std::vector<Point> points;
    const std::vector<std::array<double, 4>> weights{{0.25, 0.25, 0.25, 0.25}, {0.7, 0.1, 0.1, 0.1}, {0.05, 0.15, 0.2, 0.6},
                                                     {0.01, 0.01, 0.97, 0.01}, {0.5, 0.5, 0, 0},     {0, 0, 0, 1}};
    for (const auto& w : weights)
        points.push_back(CGAL::ORIGIN + (w[0] * (a - CGAL::ORIGIN) + w[1] * (b - CGAL::ORIGIN) + w[2] * (c - CGAL::ORIGIN) +
                                         w[3] * (d - CGAL::ORIGIN)));
    for (const std::string& kind : kinds) {
        const Coordinates coordinates = compute_coordinates(kind, cage, points, quick(300));
        for (std::size_t i = 0; i < weights.size(); ++i)
            for (std::size_t j = 0; j < 4; ++j)
                EXPECT_NEAR(coordinates.vertex(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)), weights[i][j], 1e-11)
                    << kind;
    }
}

TEST(InteriorCoordinates, SatisfyTheirProperties) {
    for (const auto& [name, soup, points] : {std::tuple{"box", test::box(2), grid_in({0, 0, 0}, {1, 1, 1}, 4)},
                                             std::tuple{"fork", fork(), grid_in({0.1, 0.1, 1.2}, {1.9, 1.9, 5.9}, 4)},
                                             std::tuple{"box far away", test::moved(test::box(2), 1e-3, {1e3, -2e3, 5e2}),
                                                        grid_in({1e3, -2e3, 5e2}, {1e3 + 1e-3, -2e3 + 1e-3, 5e2 + 1e-3}, 3)}}) {
        const Mesh cage = build_mesh(soup);
        for (const std::string& kind : kinds)
            expect_promises(compute_coordinates(kind, cage, points, quick()), cage, points, kind + " in " + name);
    }
}

TEST(InteriorCoordinates, InAnOctahedronAreEqualForItsCorners) {
    const Mesh cage = build_mesh(test::octahedron_sphere(0));
    const std::vector<Point> middle{{0, 0, 0}};
    for (const std::string& kind : kinds) {
        const Coordinates c = compute_coordinates(kind, cage, middle, quick(4000));
        // The tetrahedra are not mirror images of each other: harmonic weights agree up to the discretisation.
        if (kind == "local") continue;
        for (Eigen::Index j = 0; j < 6; ++j) EXPECT_NEAR(c.vertex(0, j), 1.0 / 6, 0.02) << kind;
    }
}

/// The sum of the weights of one arm's end at points in the other.
double reach_over(const std::string& kind, const Mesh& cage, const CoordinateOptions& options) {
    const std::vector<Point> points = grid_in({0.2, 0.2, 4}, {1.8, 1.8, 5.8}, 3);
    const Coordinates c = compute_coordinates(kind, cage, points, options);
    double maximum = 0;
    for (Eigen::Index i = 0; i < c.vertex.rows(); ++i) {
        double sum = 0;
        for (const Vertex v : cage.vertices())
            if (cage.point(v).x() > 2.5 && cage.point(v).z() > 2) sum += std::abs(c.vertex(i, v.idx()));
        maximum = std::max(maximum, sum);
    }
    return maximum;
}

TEST(InteriorCoordinates, DoNotReachAcrossAGap) {
    const Mesh cage = build_mesh(fork());
    const double mean_value = reach_over("mean-value", cage, {});
    EXPECT_GT(mean_value, 0.01);
    for (const std::string& kind : kinds) EXPECT_LT(reach_over(kind, cage, quick()), mean_value / 10) << kind;
}

TEST(InteriorCoordinates, LocalWeightsAreSparser) {
    const Mesh cage = build_mesh(fork());
    const std::vector<Point> points = grid_in({0.1, 0.1, 0.1}, {1.9, 1.9, 5.9}, 5);
    CoordinateOptions options = quick(3000);
    options.iterations = 300;
    const CoordinateCertificate local = certify(compute_coordinates("local", cage, points, options), cage, points, options),
                                harmonic = certify(compute_coordinates("harmonic", cage, points, options), cage, points, options);
    EXPECT_LT(local.dominant_weights_mean, harmonic.dominant_weights_mean);
}

TEST(InteriorCoordinates, AreTheSameForAnyNumberOfThreads) {
    const Mesh cage = build_mesh(fork());
    const std::vector<Point> points = grid_in({0.1, 0.1, 1.2}, {1.9, 1.9, 5.9}, 4);
    for (const std::string& kind : kinds) {
        set_threads(1);
        const Coordinates sequential = compute_coordinates(kind, cage, points, quick());
        set_threads(2);
        const Coordinates parallel = compute_coordinates(kind, cage, points, quick());
        set_threads(0);
        EXPECT_EQ(sequential.vertex, parallel.vertex) << kind;
    }
}

TEST(InteriorCoordinates, MoveTheSameBySparseAndDenseWeights) {
    const Mesh cage = build_mesh(fork());
    const std::vector<Point> points = grid_in({0.1, 0.1, 1.2}, {1.9, 1.9, 5.9}, 4);
    Coordinates c = compute_coordinates("harmonic", cage, points, quick());
    std::vector<Point> moved = points_of(cage);
    moved[3] += Vector(0.3, -0.1, 0.2);
    const std::vector<Point> sparse = deformed(c, cage, moved);
    EXPECT_LT(c.stored_share(), 1);
    c.sparse = {};
    EXPECT_EQ(c.stored_share(), 1);
    const std::vector<Point> dense = deformed(c, cage, moved);
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_LT((sparse[i] - dense[i]).squared_length(), 1e-26);
}

TEST(InteriorCoordinates, RejectPointsWhereTheyAreUndefined) {
    const Mesh cage = build_mesh(test::box(2));
    TriangleSoup crossing = test::joined(test::box(1), test::moved(test::box(1), 1, {0.5, 0.5, 0.5}));
    for (const std::string& kind : kinds) {
        try {
            (void)compute_coordinates(kind, cage, std::vector<Point>{{0.5, 0.5, 0.5}, {1.5, 0, 0}}, quick());
            ADD_FAILURE() << kind << " outside";
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("not inside it: 1"), std::string::npos) << error.what();
        }
        EXPECT_THROW((void)compute_coordinates(kind, build_mesh(crossing), std::vector<Point>{{0.25, 0.25, 0.25}}, quick()),
                     Error)
            << kind;
    }
}

TEST(InteriorCoordinates, RoundTripIsExactAndChangedFilesAreRejected) {
    const test::Scratch scratch;
    const Mesh cage = build_mesh(test::box(2));
    Mesh mesh = build_mesh(test::moved(test::box(3), 0.5, {0.25, 0.25, 0.25}));
    const Coordinates c = compute_coordinates("positive-mean-value", cage, mesh, quick());
    const CoordinateCertificate certificate = certify(c, cage, points_of(mesh), quick());
    const Path file = scratch / "w.npy";
    write_coordinates(file, c, mesh, cage, certificate, Provenance{"test", {}, {}});
    const Coordinates reread = read_coordinates(file, mesh, cage);
    EXPECT_EQ(reread.kind, c.kind);
    EXPECT_EQ(reread.vertex, c.vertex);
    EXPECT_EQ(reread.sparse.nonZeros(), c.sparse.nonZeros());
    EXPECT_EQ(read_coordinate_header(file).vertex.rows, static_cast<std::size_t>(c.sparse.nonZeros()));
    std::vector<std::int64_t> columns = read_npy_integers(sparse_columns_file(file)).values;
    columns[0] = 1000000;
    write_npy(sparse_columns_file(file), columns, {columns.size()});
    EXPECT_THROW((void)read_coordinates(file, mesh, cage), Error);
    std::filesystem::remove(sparse_columns_file(file));
    EXPECT_THROW((void)read_coordinates(file, mesh, cage), Error);
}

}  // namespace
}  // namespace ostraka
