#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/surface_search.h"
#include "texture/face_clusters.h"
#include "texture/pack.h"
#include "texture/raster.h"
#include "texture/textured.h"

#include <gtest/gtest.h>

#include <map>

using namespace ostraka;
using namespace ostraka::test;

namespace {

Atlas atlas_of(const Mesh& mesh, double texel, int gutter = 2, int max_size = 8192) {
    AtlasOptions options;
    options.texel = texel;
    options.gutter = gutter;
    options.max_size = max_size;
    return make_atlas(mesh, options);
}

std::array<Vector2d, 3> texel_corners(const Atlas& atlas, Index face) {
    std::array<Vector2d, 3> result;
    for (std::size_t k = 0; k < 3; ++k) {
        const TexturePoint& at = atlas.layout.corner_texture[3 * static_cast<std::size_t>(face) + k];
        result[k] = {static_cast<double>(at[0]) * atlas.layout.width, static_cast<double>(at[1]) * atlas.layout.height};
    }
    return result;
}

double doubled_area(const std::array<Vector2d, 3>& t) {
    const Vector2d a = t[1] - t[0], b = t[2] - t[0];
    return a.x() * b.y() - a.y() * b.x();
}

/// Distance of a point inside a counter-clockwise triangle from its sides; negative outside.
double depth(const std::array<Vector2d, 3>& t, const Vector2d& p) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
        const Vector2d along = t[(k + 1) % 3] - t[k], from = p - t[k];
        least = std::min(least, (along.x() * from.y() - along.y() * from.x()) / along.norm());
    }
    return least;
}

/// The chart of each texel whose centre lies in a face; expects that no centre lies in two faces, and that charts keep away from
/// each other and from the border of the image.
void expect_apart(const Atlas& atlas, int gutter) {
    const int side = atlas.layout.width;
    std::map<std::array<int, 3>, Index> chart_of_texel;
    for (Index face = 0; face < atlas.face_chart.size(); ++face) {
        const auto t = texel_corners(atlas, face);
        Vector2d low = t[0], high = t[0];
        for (const Vector2d& corner : t) {
            low = low.cwiseMin(corner), high = high.cwiseMax(corner);
            for (const double c : {corner.x(), corner.y()}) {
                EXPECT_GE(c, gutter) << face;
                EXPECT_LE(c, side - gutter) << face;
            }
        }
        for (int y = static_cast<int>(low.y()); y <= high.y(); ++y)
            for (int x = static_cast<int>(low.x()); x <= high.x(); ++x) {
                if (!(depth(t, {x + 0.5, y + 0.5}) > 0.02)) continue;
                const std::array<int, 3> place{static_cast<int>(atlas.layout.face_image[face]), x, y};
                EXPECT_TRUE(chart_of_texel.emplace(place, atlas.face_chart[face]).second) << "two faces at " << x << ' ' << y;
            }
    }
    for (const auto& [place, chart] : chart_of_texel)
        for (int y = -2 * gutter; y <= 2 * gutter; ++y)
            for (int x = -2 * gutter; x <= 2 * gutter; ++x) {
                const auto other = chart_of_texel.find({place[0], place[1] + x, place[2] + y});
                if (other != chart_of_texel.end()) { EXPECT_EQ(other->second, chart); }
            }
}

}  // namespace

TEST(Atlas, ChartsNeitherOverlapNorTurnRound) {
    for (const auto& [name, soup] : group())
        for (const int gutter : {0, 2}) {
            SCOPED_TRACE(name + " gutter " + std::to_string(gutter));
            const Mesh mesh = build_mesh(soup);
            const double texel = box_diagonal(mesh) / 150;
            const Atlas atlas = atlas_of(mesh, texel, gutter);
            EXPECT_EQ(atlas.texel, texel);
            EXPECT_EQ(atlas.layout.images, 1U);
            EXPECT_EQ(atlas.layout.width, atlas.layout.height);
            EXPECT_GE(atlas.charts, 1U);
            expect_apart(atlas, gutter);
            double area = 0;
            for (const Face face : mesh.faces()) {
                const double doubled = doubled_area(texel_corners(atlas, face));
                EXPECT_GT(doubled, 0) << face;  // not turned round
                area += doubled / 2;
            }
            EXPECT_NEAR(area * texel * texel / surface_area(mesh), 1, 0.02);
            EXPECT_NEAR(texel_size(mesh, atlas.layout) / texel, 1, 0.01);
            EXPECT_LT(atlas.largest_stretch, 4);
            EXPECT_GT(atlas.used, 0.2);
        }
}

TEST(Atlas, FewChartsForSimpleShapes) {
    EXPECT_EQ(atlas_of(build_mesh(patch(20, 20)), 0.01).charts, 1U);
    EXPECT_EQ(atlas_of(build_mesh(box(12)), 0.01).charts, 6U);
    const Atlas sphere = atlas_of(build_mesh(octahedron_sphere(5)), 0.01);
    EXPECT_LE(sphere.charts, 24U);
    EXPECT_LT(sphere.largest_stretch, 1.8);
}

TEST(Atlas, StretchIsBoundedByTheCone) {
    AtlasOptions options;
    options.texel = 0.001;
    options.cone = 20;
    const Mesh mesh = build_mesh(octahedron_sphere(4));
    const Atlas atlas = make_atlas(mesh, options);
    EXPECT_LT(atlas.largest_stretch, 1.1);
    // The stretch is that of the faces.
    double largest = 0;
    for (const Face face : mesh.faces()) {
        const auto t = texel_corners(atlas, face);
        const auto v = corners(mesh, face);
        for (std::size_t k = 0; k < 3; ++k)
            largest = std::max(largest, std::sqrt(CGAL::squared_distance(mesh.point(v[k]), mesh.point(v[(k + 1) % 3]))) /
                                            ((t[(k + 1) % 3] - t[k]).norm() * atlas.texel));
    }
    EXPECT_LE(largest, atlas.largest_stretch * 1.001);
    EXPECT_GE(largest, atlas.largest_stretch * 0.9);
}

TEST(Atlas, ASpiralRampIsDividedWhereItOverlapsItself) {
    const auto ramp = [](double u, double v) {
        const double angle = 6 * std::numbers::pi * u, radius = 1 + v;
        return std::array<double, 3>{radius * std::cos(angle), radius * std::sin(angle), 3 * u};
    };
    TriangleSoup soup;
    const Index columns = 120, rows = 4;
    for (Index i = 0; i <= columns; ++i)
        for (Index j = 0; j <= rows; ++j) soup.points.push_back(ramp(i / static_cast<double>(columns), j / static_cast<double>(rows)));
    for (Index i = 0; i < columns; ++i)
        for (Index j = 0; j < rows; ++j) {
            const Index a = i * (rows + 1) + j, b = a + rows + 1;
            soup.triangles.push_back({a, a + 1, b});
            soup.triangles.push_back({b, a + 1, b + 1});
        }
    const Mesh mesh = build_mesh(soup);
    const Atlas atlas = atlas_of(mesh, 0.03);
    EXPECT_GE(atlas.charts, 3U);
    EXPECT_LE(atlas.charts, 8U);
    expect_apart(atlas, 2);
}

TEST(Atlas, OneTriangleDegenerateFacesAndLooseFaces) {
    TriangleSoup one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    const Atlas single = atlas_of(build_mesh(one), 0.1);
    EXPECT_EQ(single.charts, 1U);
    EXPECT_NEAR(single.largest_stretch, 1, 1e-9);
    expect_apart(single, 2);
    TriangleSoup flat{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
    const Atlas degenerate = atlas_of(build_mesh(flat), 0.1);
    EXPECT_EQ(degenerate.charts, 1U);
    expect_apart(degenerate, 2);
    TriangleSoup point{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}};
    expect_apart(atlas_of(build_mesh(point), 0.1), 2);
    TriangleSoup loose;
    for (Index i = 0; i < 300; ++i) {
        const double x = i;
        for (const auto& p : one.points) loose.points.push_back({p[0] + 2 * x, p[1], p[2] + (i % 7)});
        loose.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const Atlas many = atlas_of(build_mesh(loose), 0.05);
    EXPECT_EQ(many.charts, 300U);
    expect_apart(many, 2);
    EXPECT_THROW(atlas_of(Mesh(), 0.1), Error);
    EXPECT_THROW(atlas_of(build_mesh(one), 0), Error);
    EXPECT_THROW(atlas_of(build_mesh(one), std::numeric_limits<double>::quiet_NaN()), Error);
}

TEST(Atlas, SliversDoNotDivideCharts) {
    // A flat patch with a vertex moved so that a face becomes a sliver that points backwards.
    TriangleSoup soup = patch(10, 10);
    for (auto& p : soup.points) p[2] = 0;
    TriangleSoup sliver = soup;
    const auto [a, b, c] = sliver.triangles[50];
    for (std::size_t k = 0; k < 2; ++k) sliver.points[c][k] = (sliver.points[a][k] + sliver.points[b][k]) / 2;
    sliver.points[c][2] = -1e-7;
    EXPECT_LE(atlas_of(build_mesh(sliver), 0.01).charts, 3U);
}

TEST(Atlas, FarFromTheOriginAndAtAnyScale) {
    const TriangleSoup soup = torus(40, 20);
    const Mesh mesh = build_mesh(soup);
    const Atlas near = atlas_of(mesh, box_diagonal(mesh) / 200);
    for (const double scale : {1e-6, 1.0, 1e6}) {
        const Mesh far = build_mesh(moved(soup, scale, {3e6 * scale, -5e6 * scale, 1e5 * scale}));
        const Atlas atlas = atlas_of(far, scale * box_diagonal(mesh) / 200);
        EXPECT_NEAR(static_cast<double>(atlas.charts), static_cast<double>(near.charts), 0.2 * static_cast<double>(near.charts));
        EXPECT_NEAR(atlas.largest_stretch, near.largest_stretch, 0.5);
        expect_apart(atlas, 2);
    }
}

TEST(Atlas, SurfacesThatDoNotFitGetSeveralImagesThenLargerTexels) {
    const Mesh mesh = build_mesh(octahedron_sphere(4));
    const Atlas several = atlas_of(mesh, 0.03, 2, 128);
    EXPECT_GT(several.layout.images, 1U);
    EXPECT_EQ(several.layout.width, 128);
    EXPECT_EQ(several.texel, 0.03);
    expect_apart(several, 2);
    const Atlas larger = atlas_of(mesh, 1e-5, 2, 128);
    EXPECT_LE(larger.layout.images, max_atlas_images);
    EXPECT_EQ(larger.layout.width, 128);
    EXPECT_GT(larger.texel, 1e-5);
    expect_apart(larger, 2);
}

TEST(Atlas, IsTheSameForAnyNumberOfThreads) {
    const Mesh mesh = build_mesh(torus(60, 30));
    const int before = threads();
    set_threads(1);
    const Atlas single = atlas_of(mesh, 0.01);
    set_threads(4);
    const Atlas several = atlas_of(mesh, 0.01);
    set_threads(before);
    EXPECT_EQ(single.layout.corner_texture, several.layout.corner_texture);
    EXPECT_EQ(single.face_chart, several.face_chart);
}

TEST(Atlas, TrianglesThatShareEdgesCoverEachTexelOnce) {
    // A fan around a texel centre, with corners on texel centres and edges through them.
    const std::vector<texture::GridPoint> ring{texture::grid_point(8.5, 2.5), texture::grid_point(8.5, 8.5),
                                               texture::grid_point(2.5, 8.5), texture::grid_point(0.3, 4.5),
                                               texture::grid_point(2.5, 0.5)};
    std::vector<int> covered(100);
    for (std::size_t i = 0; i < ring.size(); ++i)
        texture::for_each_span({texture::grid_point(4.5, 4.5), ring[i], ring[(i + 1) % ring.size()]}, 10, 0, 10,
                               [&](std::int64_t row, std::int64_t begin, std::int64_t end) {
                                   for (std::int64_t column = begin; column < end; ++column)
                                       ++covered[static_cast<std::size_t>(10 * row + column)];
                               });
    EXPECT_EQ(*std::max_element(covered.begin(), covered.end()), 1);
    for (int row = 3; row < 8; ++row)
        for (int column = 3; column < 8; ++column) EXPECT_EQ(covered[static_cast<std::size_t>(10 * row + column)], 1);
}

TEST(Atlas, RectanglesArePackedApart) {
    std::vector<texture::PackedRectangle> rectangles;
    for (int i = 0; i < 200; ++i) rectangles.push_back({5 + 37 * i % 61, 3 + 11 * i % 17});
    const texture::Packing packing = texture::pack(rectangles, 128);
    EXPECT_GT(packing.images, 1U);
    std::map<std::array<std::size_t, 3>, int> taken;
    for (const auto& r : rectangles)
        for (int y = r.y; y < r.y + r.height; ++y)
            for (int x = r.x; x < r.x + r.width; ++x) {
                EXPECT_LT(std::max(x, y), packing.size);
                const std::array<std::size_t, 3> place{r.image, static_cast<std::size_t>(x), static_cast<std::size_t>(y)};
                EXPECT_EQ(++taken[place], 1);
            }
}

TEST(Atlas, TexelSizeOfASource) {
    const MeshFile source = textured_box(4, 64, waves, 3);
    EXPECT_NEAR(texel_size(source), 3.0 / 64, 1e-5);
    const TextureLayout layout = layout_of(source, "box");
    EXPECT_EQ(layout.width, 6 * 72);
    EXPECT_EQ(layout.height, 72);
    EXPECT_NEAR(texel_size(source.mesh, layout), 3.0 / 64, 1e-5);
    MeshFile plain;
    plain.mesh = source.mesh;
    EXPECT_NEAR(texel_size(plain), mean_edge_length(plain.mesh) / 2, 1e-12);
    EXPECT_THROW(layout_of(plain, "plain"), Error);
}
