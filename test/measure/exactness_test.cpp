// Measures and descriptors of polyhedra are exact to rounding, at any position.
#include "measure/solids.h"
#include "ostraka/measure/descriptors.h"
#include "ostraka/measure/measure.h"

#include <gtest/gtest.h>

#include <map>
#include <numbers>

namespace ostraka {
namespace {

using namespace test;

TEST(Exactness, OfPolyhedraUnderRigidMotionToRounding) {
    // A box of 60,000 triangles: area, volume, centroid, box, ruler, tape along its edges, bounding: known, at any position.
    const double a = 1, b = 2, c = 5, diagonal = std::sqrt(a * a + b * b + c * c);
    const TriangleSoup soup = box(70, a, b, c);
    const auto corner = [&](double x, double y, double z) {
        for (Index i = 0; i < soup.points.size(); ++i)
            if (soup.points[i] == std::array<double, 3>{x, y, z}) return i;
        return no_index;
    };
    const Index o = corner(0, 0, 0), far = corner(a, b, c), up = corner(0, 0, c);
    for (const double offset : {0.0, 10.0, 1e3, 1e6}) {
        const Vector3d translation = offset * Vector3d(1, -2, 3).normalized();
        const Eigen::Matrix3d rotation = offset == 0 ? Eigen::Matrix3d::Identity() : some_rotation(static_cast<int>(offset));
        const Mesh mesh = build_mesh(moved(soup, rotation, translation));
        const Annotation root = whole(mesh);
        const double tolerance = 1e-12 * (1 + offset / diagonal);
        DescriptorSearch search(mesh);
        const auto value = [&](const std::string& name) { return search.find(root, name)->values.front(); };
        const auto expect_near = [&](double x, double exact, const char* quantity) {
            EXPECT_LE(std::abs(x - exact), tolerance * std::abs(exact)) << quantity << " at " << offset;
        };
        expect_near(value("area"), 2 * (a * b + b * c + c * a), "area");
        expect_near(value("volume"), a * b * c, "volume");
        EXPECT_EQ(value("volume bound"), 0);
        expect_near(value("mean curvature integral"), std::numbers::pi * (a + b + c), "mean curvature");
        const Vector3d middle = rotation * Vector3d(a / 2, b / 2, c / 2) + translation;
        for (const char* name : {"centroid", "solid centroid", "box centre"}) {
            const auto centre = search.find(root, name)->values;
            const double allowed = (std::string(name) == "box centre" ? 1e-6 : tolerance) * (diagonal + offset);
            EXPECT_LE((Vector3d(centre[0], centre[1], centre[2]) - middle).norm(), allowed) << name << " at " << offset;
        }
        expect_near(evaluate(mesh, root, pins("ruler", {o, far})), diagonal, "ruler");
        expect_near(evaluate(mesh, root, pins("tape", {o, up})), c, "tape");
        Measure bounding = pins("bounding", {o, far});
        const Vector3d z = rotation * Vector3d::UnitZ();
        bounding.direction = std::array<double, 3>{z[0], z[1], z[2]};
        expect_near(evaluate(mesh, root, bounding), c, "bounding");
        Annotation side;  // the faces on x = 0
        for (const Face f : mesh.faces())
            if (std::abs((rotation.transpose() * (Vector3d(centroid(mesh, f).x(), centroid(mesh, f).y(), centroid(mesh, f).z()) -
                                                  translation))[0]) < 1e-6)
                side.faces.push_back(f);
        expect_near(search.find(side, "area")->values.front(), b * c, "area of a side");
        expect_near(search.find(side, "perimeter")->values.front(), 2 * (b + c), "perimeter of a side");
        expect_near(search.find(side, "circularity")->values.front(), 4 * (b + c) * (b + c) / (b * c), "circularity");
    }
}

/// Each triangle split into four, flat.
TriangleSoup in_four(const TriangleSoup& soup) {
    TriangleSoup result{soup.points, {}};
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index p, Index q) {
        const auto [entry, fresh] = middles.try_emplace(std::minmax(p, q), static_cast<Index>(result.points.size()));
        if (fresh) {
            const auto a = result.points[p], b = result.points[q];
            result.points.push_back({(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2});
        }
        return entry->second;
    };
    for (const auto& [p, q, r] : soup.triangles) {
        const Index u = middle(p, q), v = middle(q, r), w = middle(r, p);
        for (const auto& t : {std::array{p, u, w}, {u, q, v}, {w, v, r}, {u, v, w}}) result.triangles.push_back(t);
    }
    return result;
}

TEST(Exactness, OfRegularPolyhedra) {
    const double s3 = std::sqrt(3.0), golden = (1 + std::sqrt(5.0)) / 2;
    struct Solid {
        TriangleSoup soup;
        double area, volume, width;  ///< width: extent along x
    };
    std::vector<Solid> solids;
    // Edge length 2 sqrt(2), sqrt(2), 2.
    solids.push_back(
        {{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}}, 8 * s3, 8.0 / 3, 2});
    solids.push_back({{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                       {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}},
                      4 * s3,
                      4.0 / 3,
                      2});
    Solid ball{{}, 20 * s3, 10.0 / 3 * (3 + std::sqrt(5.0)), 2 * golden};
    for (const double a : {-1.0, 1.0})
        for (const double b : {-golden, golden}) {
            ball.soup.points.push_back({0, a, b});
            ball.soup.points.push_back({a, b, 0});
            ball.soup.points.push_back({b, 0, a});
        }
    const auto squared_distance = [&](Index i, Index j) {
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k) sum += std::pow(ball.soup.points[i][k] - ball.soup.points[j][k], 2);
        return sum;
    };
    for (Index i = 0; i < 12; ++i)
        for (Index j = i + 1; j < 12; ++j)
            for (Index k = j + 1; k < 12; ++k) {
                if (squared_distance(i, j) > 4.1 || squared_distance(j, k) > 4.1 || squared_distance(k, i) > 4.1) continue;
                const Vector3d p(ball.soup.points[i].data()), q(ball.soup.points[j].data()), r(ball.soup.points[k].data());
                const bool outward = (q - p).cross(r - p).dot(p) > 0;
                ball.soup.triangles.push_back(outward ? std::array{i, j, k} : std::array{i, k, j});
            }
    ASSERT_EQ(ball.soup.triangles.size(), 20U);
    solids.push_back(ball);
    for (Solid& solid : solids) {
        for (int k = 0; k < 4; ++k) solid.soup = in_four(solid.soup);
        for (const double offset : {0.0, 1e3, 1e6}) {
            const Vector3d translation = offset * Vector3d(2, 1, -2) / 3;
            const Eigen::Matrix3d rotation = some_rotation(static_cast<int>(offset) + 5);
            const Mesh mesh = build_mesh(moved(solid.soup, rotation, translation));
            const Annotation root = whole(mesh);
            const double diagonal = box_diagonal(mesh), tolerance = 1e-12 * (1 + offset / diagonal);
            DescriptorSearch search(mesh);
            EXPECT_LE(std::abs(search.find(root, "area")->values[0] - solid.area), tolerance * solid.area) << offset;
            EXPECT_LE(std::abs(search.find(root, "volume")->values[0] - solid.volume), tolerance * solid.volume) << offset;
            for (const char* name : {"centroid", "solid centroid"}) {
                const auto at = search.find(root, name)->values;
                EXPECT_LE((Vector3d(at[0], at[1], at[2]) - translation).norm(), tolerance * (diagonal + offset))
                    << name << offset;
            }
            Measure bounding = pins("bounding", {0, 1});
            const Vector3d x = rotation * Vector3d::UnitX();
            bounding.direction = std::array<double, 3>{x[0], x[1], x[2]};
            const auto ends = extremes(mesh, root, *bounding.direction);
            bounding.points.assign(ends.begin(), ends.end());
            EXPECT_LE(std::abs(evaluate(mesh, root, bounding) - solid.width), tolerance * solid.width) << offset;
        }
    }
}

TEST(Exactness, OfTheExactTape) {
    const double a = 1, b = 2, c = 5, diagonal = std::sqrt(a * a + b * b + c * c);
    const TriangleSoup soup = box(8, a, b, c);
    Index first = 0, last = 0;
    for (Index i = 0; i < soup.points.size(); ++i) {
        if (soup.points[i] == std::array<double, 3>{0, 0, 0}) first = i;
        if (soup.points[i] == std::array<double, 3>{a, b, c}) last = i;
    }
    for (const double offset : {0.0, 10.0, 1e3, 1e6}) {
        const Mesh mesh =
            build_mesh(moved(soup, some_rotation(static_cast<int>(offset) + 1), offset * Vector3d(1, -2, 3).normalized()));
        Measure exact = pins("tape", {first, last});
        exact.exact = true;
        EXPECT_NEAR(evaluate(mesh, whole(mesh), exact), std::hypot(a + b, c),
                    1e-12 * (1 + offset / diagonal) * std::hypot(a + b, c));
    }
}

}  // namespace
}  // namespace ostraka
