// Contours of shapes whose slices are known: areas, nesting, orientation, vertices on the plane, open scans.
#include "ostraka/slicing/slice.h"

#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/stats/random.h"
#include "prisms.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

using namespace ostraka;
using namespace ostraka::test;

namespace {

double area(const Slice& slice) {
    double sum = 0;
    for (const auto& contour : slice.contours) sum += contour.area;
    return sum;
}
double length(const Slice& slice) {
    double sum = 0;
    for (const auto& contour : slice.contours) sum += contour.length;
    return sum;
}
Slice cut(const Mesh& mesh, double height, const Vector& normal = {0, 0, 1}, const Point& origin = {0, 0, 0}) {
    return slice_mesh(mesh, slice_frame(origin, normal), {height}).slices.at(0);
}

/// Invariants of every slice.
void expect_sound(const Mesh& mesh, const SliceStack& stack) {
    for (const auto& slice : stack.slices)
        for (std::size_t c = 0; c < slice.contours.size(); ++c) {
            const auto& contour = slice.contours[c];
            ASSERT_EQ(contour.points.size(), contour.faces.size() + !contour.closed);
            ASSERT_GE(contour.points.size(), contour.closed ? 3U : 2U);
            EXPECT_EQ(contour.hole, contour.area < 0);
            if (contour.parent >= 0) {
                ASSERT_LT(contour.parent, int(c));
                EXPECT_GT(contour.depth, slice.contours[std::size_t(contour.parent)].depth);
            }
            for (std::size_t i = 0; i < contour.faces.size(); ++i) {
                const auto &a = contour.points[i], &b = contour.points[(i + 1) % contour.points.size()];
                EXPECT_NE(a, b);
                // Each piece lies in its face, with the face's outside on its right.
                const auto [p, q, r] = corners(mesh, Face(contour.faces[i]));
                const Vector n = area_vector(mesh, Face(contour.faces[i]));
                const Point middle = stack.frame.point((a + b) / 2, slice.height);
                EXPECT_LT(std::abs((middle - mesh.point(p)) * n) / std::sqrt(n.squared_length()), 1e-9 * box_diagonal(mesh));
                if (stack.reversed) continue;
                const Vector right = CGAL::cross_product(stack.frame.point(b, slice.height) - stack.frame.point(a, slice.height),
                                                         stack.frame.normal);
                EXPECT_GE(right * n, -1e-12 * box_diagonal(mesh) * std::sqrt(n.squared_length()));
            }
        }
}

}  // namespace

TEST(SliceMesh, AnyMeshInAnyDirection) {
    for (const auto& [name, soup] : group()) {
        SCOPED_TRACE(name);
        const Mesh mesh = build_mesh(soup);
        for (const Vector& direction : {Vector(0, 0, 1), Vector(1, 0, 0), Vector(0, -1e-9, 0), Vector(1, 2, 3)}) {
            const auto box = bounding_box(mesh);
            const SliceFrame frame = slice_frame(Point(box.xmin(), box.ymin(), box.zmin()), direction);
            const auto [low, high] = height_range(mesh, frame);
            auto heights = slice_heights(low, high, 23);
            heights.insert(heights.end(), {low, high, low - 1, high + 1, heights[3]});
            const SliceStack stack = slice_mesh(mesh, frame, heights);
            ASSERT_EQ(stack.slices.size(), 28U);
            expect_sound(mesh, stack);
            for (std::size_t i = 0; i < 23 && name != "two components"; ++i) EXPECT_FALSE(stack.slices[i].contours.empty());
            EXPECT_TRUE(stack.slices[25].contours.empty());
            EXPECT_TRUE(stack.slices[26].contours.empty());
            EXPECT_EQ(stack.slices[27].contours.size(), stack.slices[3].contours.size());
            EXPECT_EQ(area(stack.slices[27]), area(stack.slices[3]));
            if (name == "patch" || name == "tube") continue;
            for (const auto& slice : stack.slices) EXPECT_TRUE(slice.completeness.complete());
            // The layers approximate the volume (midpoint rule).
            double sum = 0;
            for (std::size_t i = 0; i < 23; ++i) sum += area(stack.slices[i]) * (high - low) / 23;
            EXPECT_NEAR(sum / volume(mesh), 1, 0.01);
        }
    }
}

TEST(SliceMesh, TheSameBitsForAnyNumberOfThreads) {
    const Mesh mesh = build_mesh(joined(octahedron_sphere(5), moved(torus(60, 40), 1, {0.5, 0, 0})));
    const SliceFrame frame = slice_frame(Point(0, 0, -1), Vector(0.1, 0.2, 1));
    const auto heights = slice_heights(0, 2, 40);
    set_threads(1);
    const SliceStack sequential = slice_mesh(mesh, frame, heights);
    set_threads(3);
    const SliceStack parallel = slice_mesh(mesh, frame, heights);
    set_threads(0);
    for (std::size_t i = 0; i < heights.size(); ++i) {
        ASSERT_EQ(sequential.slices[i].contours.size(), parallel.slices[i].contours.size());
        for (std::size_t c = 0; c < sequential.slices[i].contours.size(); ++c) {
            EXPECT_EQ(sequential.slices[i].contours[c].points, parallel.slices[i].contours[c].points);
            EXPECT_EQ(sequential.slices[i].contours[c].faces, parallel.slices[i].contours[c].faces);
            EXPECT_EQ(sequential.slices[i].contours[c].parent, parallel.slices[i].contours[c].parent);
        }
    }
}

TEST(SliceMesh, ABoxThroughVerticesEdgesAndFaces) {
    for (const double scale : {1.0, 1e-6, 1e6})
        for (const double away : {0.0, 1000.0}) {
            const Mesh mesh = build_mesh(moved(box(8), scale, {away * scale, 2 * away * scale, -away * scale}));
            const Point corner(away * scale, 2 * away * scale, -away * scale);
            // The base, between rows, through rows of vertices, the lid, and slightly next to them.
            for (const double h : {0.0, 0.3, 0.5, 0.125, 1.0, 1e-10, -1e-10, 0.5 + 1e-10, 0.5 - 1e-10, 1 + 1e-10}) {
                const Slice slice = cut(mesh, h * scale, {0, 0, 1}, corner);
                ASSERT_EQ(slice.contours.size(), 1U) << h;
                EXPECT_FALSE(slice.contours[0].hole);
                EXPECT_NEAR(area(slice), scale * scale, 1e-12 * scale * scale);
                EXPECT_NEAR(length(slice), 4 * scale, 1e-11 * scale);
                // Through a row of vertices, the contour passes the vertices themselves and nothing between.
                if (h != 0.3) {
                    EXPECT_EQ(slice.contours[0].points.size(), 32U) << h;
                }
            }
            // A plane through an edge alone, or a corner alone, cuts nothing off.
            EXPECT_TRUE(cut(mesh, 0, {1, 0, 1}, corner).contours.empty());
            EXPECT_TRUE(cut(mesh, 0, {1, 1, 1}, corner).contours.empty());
            EXPECT_TRUE(cut(mesh, std::sqrt(3.0) * scale, {1, 1, 1}, corner).contours.empty());
            EXPECT_TRUE(cut(mesh, std::sqrt(2.0) * scale, {1, 0, 1}, corner).contours.empty());
            // The diagonal, along edges of the walls' triangles and the base's.
            const Slice diagonal = cut(mesh, 0, {1, -1, 0}, corner);
            ASSERT_EQ(diagonal.contours.size(), 1U);
            EXPECT_NEAR(area(diagonal), std::sqrt(2.0) * scale * scale, 1e-11 * scale * scale);
        }
}

TEST(SliceMesh, ThroughManyVerticesAtOnceIsTheLimitFromBelow) {
    // Coordinates on a coarse grid: planes pass through vertices, edges and faces everywhere, and faces fold onto each other.
    for (const double grid_size : {0.5, 0.25, 0.1})
        for (TriangleSoup soup :
             {octahedron_sphere(4), torus(40, 30), joined(torus(24, 16), moved(octahedron_sphere(3), 1.3, {0.5, 0, 0}))}) {
            for (auto& p : soup.points)
                for (double& x : p) x = grid_size * std::round(x / grid_size);
            const Mesh mesh = build_mesh(soup);
            for (const Vector& direction : {Vector(0, 0, 1), Vector(1, 0, 0), Vector(1, 1, 0), Vector(1, -1, 1)}) {
                const SliceFrame frame = slice_frame({0, 0, 0}, direction);
                const auto [low, high] = height_range(mesh, frame);
                const double step = grid_size / std::sqrt(direction.squared_length()), below = 1e-8 * box_diagonal(mesh);
                for (double k = std::ceil(low / step) + 1; k * step <= high; ++k) {
                    const auto stack = slice_mesh(mesh, frame, {k * step, k * step - below});
                    for (const auto& slice : stack.slices)
                        for (const auto& contour : slice.contours) ASSERT_TRUE(contour.closed);
                    EXPECT_NEAR(area(stack.slices[0]), area(stack.slices[1]), 1e-5);
                }
                const auto base = slice_mesh(mesh, frame, {low, low + below});
                EXPECT_NEAR(area(base.slices[0]), area(base.slices[1]), 1e-5);
            }
        }
}

TEST(SliceMesh, FlatPlacesAboveTheBase) {
    // A step: the tread lies in the plane and counts as above, so that the slice is that of a plane just below.
    const Mesh step = build_mesh(joined(box(2), moved(box(2), 0.5, {3, 0, 0})));
    const Slice top_of_small = cut(step, 0.5);
    ASSERT_EQ(top_of_small.contours.size(), 2U);
    EXPECT_NEAR(area(top_of_small), 1.25, 1e-12);
    // A floor above the lowest point has no outline: just below it there is no material.
    const Mesh hung = build_mesh(joined(box(2), moved(box(2), 0.5, {3, 0, 0.25})));
    EXPECT_NEAR(area(cut(hung, 0.25)), 1, 1e-12);
    EXPECT_NEAR(area(cut(hung, 0.2501)), 1.25, 1e-12);
}

TEST(SliceMesh, PlanesNearTheBaseInAnyOrder) {
    const Mesh mesh = build_mesh(box(3));
    const double hair = on_plane_share * box_diagonal(mesh);
    const SliceStack stack =
        slice_mesh(mesh, slice_frame({0, 0, 0}, {0, 0, 1}), {1.1 * hair, 0.9 * hair, 0, -0.9 * hair, -1.1 * hair});
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(area(stack.slices[i]), 1, 1e-8) << i;
    EXPECT_TRUE(stack.slices[4].contours.empty());
}

TEST(SliceMesh, ATorusHasAHoleAcrossAndTwoDiscsAlong) {
    const Mesh mesh = build_mesh(torus(200, 100));
    const Slice horizontal = cut(mesh, 0);
    ASSERT_EQ(horizontal.contours.size(), 2U);
    EXPECT_FALSE(horizontal.contours[0].hole);
    EXPECT_TRUE(horizontal.contours[1].hole);
    EXPECT_EQ(horizontal.contours[1].parent, 0);
    EXPECT_EQ(horizontal.contours[1].depth, 1);
    EXPECT_NEAR(area(horizontal), 8 * M_PI, 0.02);
    EXPECT_EQ(components(horizontal).size(), 1U);
    const Slice vertical = cut(mesh, 0, {1, 0, 0});
    ASSERT_EQ(vertical.contours.size(), 2U);
    EXPECT_EQ(vertical.contours[1].parent, -1);
    EXPECT_FALSE(vertical.contours[1].hole);
    EXPECT_NEAR(area(vertical), 2 * M_PI, 0.01);
    EXPECT_EQ(components(vertical).size(), 2U);
}

TEST(SliceMesh, AreasConvergeQuadratically) {
    double previous_error = 0;
    for (int level = 3; level <= 6; ++level) {
        const Mesh mesh = build_mesh(octahedron_sphere(level));
        const double error = std::abs(area(cut(mesh, 0.31, {0.2, 0.5, 1})) - M_PI * (1 - 0.31 * 0.31));
        if (level > 3) {
            EXPECT_NEAR(std::log2(previous_error / error), 2, 0.3) << level;
        }
        previous_error = error;
    }
}

TEST(SliceMesh, IslandsInHoles) {
    // Rings around rings, in shuffled order.
    std::vector<Polygon> rings;
    for (const int k : {2, 5, 0, 4, 1, 3}) {
        const Polygon square = rectangle(12 - 2 * k, 12 - 2 * k);
        rings.push_back(k % 2 == 0 ? square : reversed(square));
    }
    rings.push_back(rectangle(1, 1, {20, 0}));
    const Slice slice = cut(walls(rings), 0.4);
    ASSERT_EQ(slice.contours.size(), 7U);
    for (int k = 0; k < 6; ++k) {
        EXPECT_EQ(slice.contours[std::size_t(k)].depth, k);
        EXPECT_EQ(slice.contours[std::size_t(k)].parent, k - 1);
        EXPECT_EQ(slice.contours[std::size_t(k)].hole, k % 2 == 1);
    }
    EXPECT_EQ(slice.contours[6].depth, 0);
    const auto parts = components(slice);
    ASSERT_EQ(parts.size(), 4U);
    EXPECT_NEAR(area(parts[0]), 144 - 100, 1e-12);
    EXPECT_NEAR(area(parts[1]), 64 - 36, 1e-12);
    EXPECT_NEAR(area(parts[3]), 1, 1e-12);
}

TEST(SliceMesh, NestingWhereContoursTouch) {
    // A hole that touches the outline at a corner, one with a side along it, one that covers the whole of it.
    const Polygon outer = rectangle(4, 4);
    const std::vector<Polygon> holes{
        {{-2, 0}, {-1, 1}, {0, 0}, {-1, -1}}, reversed(rectangle(2, 2, {1, 0})), reversed(outer), {{-2, -2}, {-2, 2}, {2, 2}}};
    for (const auto& hole : holes) {
        const Slice slice = cut(walls({outer, area(cut(walls({hole}), 0.5)) < 0 ? hole : reversed(hole)}), 0.5);
        ASSERT_EQ(slice.contours.size(), 2U);
        const std::size_t h = slice.contours[0].hole ? 0 : 1;
        EXPECT_EQ(slice.contours[h].parent, h == 1 ? 0 : -1);
    }
    // Neighbours that share a corner or a side do not contain each other; nor does a figure in the bay of another.
    EXPECT_EQ(cut(walls({outer, rectangle(2, 2, {3, 3})}), 0.5).contours[1].parent, -1);
    EXPECT_EQ(cut(walls({outer, rectangle(2, 2, {3, 0})}), 0.5).contours[1].parent, -1);
    const Polygon bay{{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
    EXPECT_EQ(cut(walls({bay, {{1, 1}, {2, 1}, {2, 3}, {1, 3}}}), 0.5).contours[1].parent, -1);
}

TEST(SliceMesh, ManySmallContours) {
    // Hundreds of tiles with a hole each on a large ring.
    std::vector<Polygon> polygons{ellipse(400, 50, 50), reversed(ellipse(300, 45, 45))};
    for (int i = -14; i <= 14; ++i)
        for (int j = -14; j <= 14; ++j) {
            polygons.push_back(rectangle(1, 1, {2.0 * i, 2.0 * j}));
            polygons.push_back(reversed(rectangle(0.5, 0.5, {2.0 * i, 2.0 * j})));
        }
    const Slice slice = cut(walls(polygons), 0.5);
    ASSERT_EQ(slice.contours.size(), polygons.size());
    std::size_t tiles = 0, holes = 0;
    for (const auto& contour : slice.contours) {
        tiles += contour.depth == 2 && contour.parent == 1;
        holes += contour.depth == 3 && slice.contours[std::size_t(contour.parent)].depth == 2;
    }
    EXPECT_EQ(tiles, 29U * 29);
    EXPECT_EQ(holes, 29U * 29);
    EXPECT_EQ(components(slice).size(), 1 + 29U * 29);
}

TEST(SliceMesh, OpenScansStayOpen) {
    const double missing = M_PI / 3;
    const Mesh mesh = build_mesh(grid(600, 4, false, false, [&](double s, double t) {
        const double a = missing / 2 + s * (2 * M_PI - missing);
        return std::array<double, 3>{std::cos(a), std::sin(a), t};
    }));
    const Slice slice = cut(mesh, 0.37);
    ASSERT_EQ(slice.contours.size(), 1U);
    const Contour& contour = slice.contours[0];
    EXPECT_FALSE(contour.closed);
    EXPECT_FALSE(contour.hole);
    EXPECT_EQ(contour.area, 0);
    EXPECT_NEAR(contour.gap, 1, 1e-12);  // a chord of 60 degrees
    EXPECT_NEAR(contour.length, 2 * M_PI - missing, 1e-4);
    EXPECT_FALSE(slice.completeness.complete());
    EXPECT_EQ(slice.completeness.closed_share, 0);
    EXPECT_NEAR(slice.completeness.share_at_most, contour.length / (contour.length + 1), 1e-12);
    EXPECT_NEAR(slice.completeness.angle(), 2 * M_PI - missing, 1e-6);
    EXPECT_TRUE(components(slice).empty());
    // It runs with the material, which lies within, to its left.
    EXPECT_GT(contour.points[0].x() * contour.points[1].y() - contour.points[0].y() * contour.points[1].x(), 0);
    // A part of a closed mesh is open where it was cut off.
    const Mesh ball = build_mesh(octahedron_sphere(4));
    std::vector<Index> half;
    for (const Face f : ball.faces())
        if (centroid(ball, f).x() > 0) half.push_back(f.idx());
    const Slice half_slice = slice_mesh(ball, slice_frame({0, 0, 0}, {0, 0, 1}), {0.3}, half).slices[0];
    ASSERT_EQ(half_slice.contours.size(), 1U);
    EXPECT_FALSE(half_slice.contours[0].closed);
    EXPECT_NEAR(half_slice.completeness.angle(), M_PI, 0.2);
    for (const Index f : half_slice.contours[0].faces) EXPECT_TRUE(std::binary_search(half.begin(), half.end(), f));
}

TEST(Completeness, OfAnArcIsItsFractionOfTheCircle) {
    const auto wall = [](double degrees, double noise) {
        Random random(7);
        return build_mesh(grid(300, 2, false, false, [&](double s, double t) {
            const double a = s * degrees * M_PI / 180, r = 100 + noise * random.normal();
            return std::array<double, 3>{r * std::cos(a), r * std::sin(a), 40 * t};
        }));
    };
    for (const double degrees : {4.6, 30.0, 90.0, 180.0, 300.0}) {
        const Completeness exact = cut(wall(degrees, 0), 13).completeness;
        EXPECT_NEAR(exact.share, degrees / 360, 1e-5) << degrees;
        EXPECT_LE(exact.share_low, exact.share);
        EXPECT_GE(exact.share_high, exact.share);
        EXPECT_LT(exact.share_high - exact.share_low, 1e-4);
        EXPECT_GE(exact.share_at_most, exact.share);
        // Noise widens the interval, which still holds the truth.
        const Completeness noisy = cut(wall(degrees, 0.02), 13).completeness;
        EXPECT_LT(noisy.share_low, degrees / 360) << degrees;
        EXPECT_GT(noisy.share_high, degrees / 360) << degrees;
        EXPECT_GT(noisy.share_high - noisy.share_low, exact.share_high - exact.share_low);
    }
    // Half a turn over two: the ends of a straight wall carry no information on the rest, those of three sides of a square hardly
    // any.
    for (const std::vector<std::array<double, 2>>& line :
         {std::vector<std::array<double, 2>>{{0, 0}, {5, 0}}, {{5, 0}, {5, 5}, {0, 5}, {0, 0}}}) {
        const auto sides = static_cast<Index>(line.size() - 1);
        const Completeness straight =
            cut(build_mesh(grid(40 * sides, 2, false, false,
                                [&](double s, double t) {
                                    const double at = std::min(s * sides, sides - 1e-9);
                                    const auto k = static_cast<std::size_t>(at);
                                    const double u = at - double(k);
                                    return std::array<double, 3>{(1 - u) * line[k][0] + u * line[k + 1][0],
                                                                 (1 - u) * line[k][1] + u * line[k + 1][1], t};
                                })),
                0.3)
                .completeness;
        EXPECT_TRUE(std::isnan(straight.share)) << sides;
        EXPECT_TRUE(std::isnan(straight.angle()));
        EXPECT_NEAR(straight.share_at_most, sides == 1 ? 0.5 : 0.75, 1e-3);
    }
}

TEST(SliceMesh, InsideOutAndSelfIntersecting) {
    TriangleSoup soup = box(4);
    for (auto& t : soup.triangles) std::swap(t[1], t[2]);
    const Mesh reversed_mesh = build_mesh(soup);
    const SliceStack stack = slice_mesh(reversed_mesh, slice_frame({0, 0, 0}, {0, 0, 1}), {0.4});
    EXPECT_TRUE(stack.reversed);
    EXPECT_NEAR(area(stack.slices[0]), 1, 1e-12);
    expect_sound(reversed_mesh, stack);
    const Mesh crossed = build_mesh(joined(octahedron_sphere(4), moved(octahedron_sphere(4), 1, {1, 0.1, 0.05})));
    const Slice slice = cut(crossed, 0.1);
    ASSERT_EQ(slice.contours.size(), 2U);
    for (const auto& contour : slice.contours) EXPECT_FALSE(contour.hole || contour.parent >= 0);
}

TEST(SliceMesh, RejectsInvalidInput) {
    const Mesh mesh = build_mesh(box(1));
    const SliceFrame frame = slice_frame({0, 0, 0}, {0, 0, 1});
    EXPECT_THROW(slice_mesh(Mesh(), frame, {0}), Error);
    EXPECT_THROW(slice_mesh(mesh, frame, {std::nan("")}), Error);
    EXPECT_THROW(slice_mesh(mesh, frame, {0}, {12}), Error);
    SliceFrame left_handed = frame;
    std::swap(left_handed.u, left_handed.v);
    EXPECT_THROW(slice_mesh(mesh, left_handed, {0}), Error);
    EXPECT_THROW(slice_frame({0, 0, 0}, {0, 0, 0}), Error);
    EXPECT_THROW(slice_heights(1, 0, 3), Error);
    EXPECT_THROW(slice_heights(0, 1, 0), Error);
    EXPECT_THROW(slice_heights_spaced(0, 1, 0), Error);
    EXPECT_THROW(slice_heights_spaced(0, 1, 1e-9), Error);
    EXPECT_TRUE(slice_mesh(mesh, frame, {}).slices.empty());
    EXPECT_EQ(slice_heights_spaced(0, 1, 0.1).size(), 11U);
    EXPECT_EQ(slice_heights_spaced(2, 2, 0.1), std::vector<double>{2});
    EXPECT_EQ(slice_heights(0, 1, 2), (std::vector<double>{0.25, 0.75}));
    EXPECT_EQ(slice_frame({0, 0, 0}, {0, 0, 7}).u, Vector(1, 0, 0));
    EXPECT_EQ(slice_frame({0, 0, 0}, {0, 0, 7}).v, Vector(0, 1, 0));
}

TEST(SliceMesh, MatchesReferenceSections) {
    const Path folder = Path(OSTRAKA_SHARED_DATA) / "reference-sections";
    if (!std::filesystem::exists(folder / "sections.tsv")) GTEST_SKIP() << "NOT CHECKED: " << folder << " is not there";
    std::ifstream table(folder / "sections.tsv");
    std::string line;
    std::getline(table, line);
    std::size_t rows = 0;
    while (std::getline(table, line)) {
        std::istringstream cells(line);
        std::string file;
        double ox, oy, oz, nx, ny, nz, expected_area, expected_perimeter;
        std::size_t loops, segments;
        cells >> file >> ox >> oy >> oz >> nx >> ny >> nz >> expected_area >> expected_perimeter >> loops >> segments;
        ASSERT_TRUE(cells) << line;
        // The table names some folders as they once were.
        Path path = Path(OSTRAKA_SHARED_DATA) / file;
        if (!std::filesystem::exists(path)) {
            const auto suffix_start = file.find("-dev/");
            ASSERT_NE(suffix_start, std::string::npos) << file;
            path = Path(OSTRAKA_SHARED_DATA) / (file.substr(0, suffix_start) + file.substr(suffix_start + 4));
        }
        ASSERT_TRUE(std::filesystem::exists(path)) << path;
        SCOPED_TRACE(line);
        const Slice slice = cut(read_mesh(path).mesh, 0, {nx, ny, nz}, {ox, oy, oz});
        // The table has ten digits.
        EXPECT_NEAR(std::abs(area(slice)) / expected_area, 1, 1e-9);
        EXPECT_NEAR(length(slice) / expected_perimeter, 1, 1e-9);
        EXPECT_EQ(slice.contours.size(), loops);
        std::size_t segment_count = 0;
        for (const auto& contour : slice.contours) segment_count += contour.faces.size();
        EXPECT_EQ(segment_count, segments);
        ++rows;
    }
    EXPECT_EQ(rows, 24U);
}
