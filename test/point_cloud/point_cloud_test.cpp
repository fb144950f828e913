#include "ostraka/point_cloud/point_cloud.h"

#include "meshes.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/reconstruction/fragment_file.h"
#include "ostraka/stats/random.h"
#include "scratch.h"
#include "sherds.h"

#include <cstring>
#include <memory>
#include <numeric>
#include <sstream>

namespace ostraka {
namespace {

using test::Scratch;

std::vector<Point> ball(std::size_t count, double scale, const Vector& shift) {
    Random random(5);
    std::vector<Point> points;
    for (std::size_t i = 0; i < count; ++i) {
        Eigen::Vector3d p(random.normal(), random.normal(), random.normal());
        p = scale * p.normalized();
        points.push_back(point_of(p) + shift);
    }
    return points;
}

TEST(PointCloud, NormalsOfABallPointOutward) {
    for (const double scale : {1e-6, 1.0, 1e6}) {
        const Vector shift = 100 * scale * Vector(1, -2, 3);
        const auto points = ball(3000, scale, shift);
        const auto normals = estimate_normals(points);
        ASSERT_EQ(normals.size(), points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vector away = (points[i] - CGAL::ORIGIN - shift) / scale;
            ASSERT_GT(normals[i] * away, std::cos(8 * M_PI / 180)) << i;
        }
    }
}

TEST(PointCloud, CoincidentPointsHaveTheNormalOfTheirPlace) {
    std::vector<Point> points = ball(3000, 1, {0, 0, 0});
    const std::vector<Vector> expected = estimate_normals(points);
    points.insert(points.end(), 100, points[7]);
    const std::vector<Vector> normals = estimate_normals(points);
    for (std::size_t i = 0; i < 3000; ++i) ASSERT_EQ(normals[i], expected[i]) << i;
    for (std::size_t i = 3000; i < points.size(); ++i) EXPECT_EQ(normals[i], expected[7]);
    // Beside a point that is far away all others coincide.
    std::vector<Point> far = ball(100, 1, {0, 0, 0});
    far.emplace_back(1e38, 0, 0);
    EXPECT_THROW(estimate_normals(far), Error);
}

TEST(PointCloud, SurfaceOfABall) {
    for (const double scale : {1e-6, 1.0, 1e6}) {
        PointCloud cloud;
        cloud.points = ball(4000, scale, 100 * scale * Vector(1, -2, 3));
        const CloudSurface surface = reconstruct_surface(cloud);
        EXPECT_EQ(surface.border_loops, 0U);
        EXPECT_EQ(test::border_edges(surface.mesh), 0U);
        EXPECT_EQ(test::euler_number(surface.mesh), 2);
        EXPECT_NEAR(surface_area(surface.mesh), 4 * M_PI * scale * scale, 0.02 * 4 * M_PI * scale * scale);
        EXPECT_GT(test::volume(surface.mesh), 0) << "looks out";
        ASSERT_EQ(surface.sources.size(), surface.mesh.number_of_vertices());
        for (const Vertex v : surface.mesh.vertices()) EXPECT_EQ(surface.mesh.point(v), cloud.points[surface.sources[v]]);
    }
}

TEST(PointCloud, GivenNormalsDetermineTheOutside) {
    PointCloud cloud;
    for (int i = 0; i < 30; ++i)
        for (int j = 0; j < 30; ++j) cloud.points.emplace_back(i + 0.01 * ((7 * i + 3 * j) % 5), j, 0.02 * ((3 * i + 5 * j) % 7));
    for (const double side : {1.0, -1.0}) {
        cloud.normals.assign(cloud.points.size(), Vector(0, 0, side));
        CloudOptions open;
        open.close_holes = 0;
        const CloudSurface surface = reconstruct_surface(cloud, open);
        Vector sum(0, 0, 0);
        for (const Face face : surface.mesh.faces()) sum += area_vector(surface.mesh, face);
        EXPECT_NEAR(sum.z() * side, 29 * 29, 60);
    }
}

/// A box of unit squares: nearly all distances occur many times. Some points lie inside.
PointCloud box_of_squares(int size) {
    PointCloud cloud;
    for (int i = 0; i <= size; ++i)
        for (int j = 0; j <= size; ++j)
            for (int k = 0; k <= size; ++k) {
                const bool outside = std::min({i, j, k}) == 0 || std::max({i, j, k}) == size;
                if (outside || (i + j + k) % 5 == 0) cloud.points.emplace_back(i, j, k);
            }
    return cloud;
}

/// Blocks of many sizes, freed in random order: the next allocations get scattered addresses.
void scatter_free_memory(std::uint64_t seed) {
    Random random(seed);
    std::vector<std::unique_ptr<char[]>> blocks;
    static std::vector<std::unique_ptr<char[]>> kept;
    for (int i = 0; i < 60'000; ++i) blocks.push_back(std::make_unique<char[]>(16 + 8 * random.below(24)));
    random.shuffle(blocks);
    kept.insert(kept.end(), std::make_move_iterator(blocks.begin()), std::make_move_iterator(blocks.begin() + 20'000));
}

TEST(PointCloud, SurfaceDoesNotDependOnAddresses) {
    const PointCloud cloud = box_of_squares(12);
    const Mesh expected = reconstruct_surface(cloud).mesh;
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
        scatter_free_memory(seed);
        const Mesh mesh = reconstruct_surface(cloud).mesh;
        ASSERT_EQ(mesh.number_of_faces(), expected.number_of_faces());
        for (const Face face : mesh.faces()) ASSERT_EQ(corners(mesh, face), corners(expected, face)) << face;
    }
}

TEST(PointCloud, SpacingIsThatOfAGrid) {
    std::vector<Point> points;
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 40; ++j) points.emplace_back(3 * i, 3 * j, 0);
    // Sixth nearest: a diagonal neighbour, but at the rim.
    EXPECT_NEAR(point_spacing(points), 3 * std::sqrt(2), 0.2);
}

TEST(PointCloud, FilesWithNormals) {
    const Scratch scratch;
    std::ostringstream ascii, text;
    std::string binary, big;
    const auto add = [](std::string& to, float value, bool swap) {
        std::array<char, 4> bytes{};
        std::memcpy(bytes.data(), &value, 4);
        if (swap) std::reverse(bytes.begin(), bytes.end());
        to.append(bytes.data(), 4);
    };
    const std::string head =
        "element vertex 30\nproperty float x\nproperty float nx\nproperty float y\nproperty float ny\nproperty float nz\n"
        "property float z\nend_header\n";
    ascii << "ply\nformat ascii 1.0\n" << head;
    binary = "ply\nformat binary_little_endian 1.0\n" + head;
    big = "ply\nformat binary_big_endian 1.0\n" + head;
    text << "# x y z nx ny nz\n";
    for (int i = 0; i < 30; ++i) {
        const std::array<float, 6> row{float(i), 0.6F, float(i % 5), 0, 0.8F, float(i % 3)};
        for (const float x : row) {
            ascii << x << ' ';
            add(binary, x, false);
            add(big, x, true);
        }
        ascii << '\n';
        text << i << ", " << i % 5 << ", " << i % 3 << ", 0.6, 0, 0.8\r\n";
    }
    for (const Path& file : {scratch.file("a.ply", ascii.str()), scratch.file("b.ply", binary), scratch.file("c.ply", big),
                             scratch.file("d.xyz", text.str())}) {
        const auto cloud = read_point_cloud(file);
        ASSERT_TRUE(cloud.has_value()) << file;
        ASSERT_EQ(cloud->points.size(), 30U) << file;
        ASSERT_EQ(cloud->normals.size(), 30U) << file;
        EXPECT_EQ(cloud->points[7], Point(7, 2, 1)) << file;
        EXPECT_NEAR(cloud->normals[7].x(), 0.6, 1e-6) << file;
        EXPECT_NEAR(cloud->normals[7].z(), 0.8, 1e-6) << file;
    }
    const auto colours = read_point_cloud(scratch.file("e.xyz", "1 2 3 255 0 0\n2 2 3 0 0 0\n"));
    EXPECT_TRUE(colours->normals.empty());
    EXPECT_EQ(colours->points.size(), 2U);
    write_mesh(scratch / "mesh.ply", build_mesh(test::box(2)));
    EXPECT_FALSE(read_point_cloud(scratch / "mesh.ply").has_value());
}

TEST(PointCloud, ErrorsAreReported) {
    const Scratch scratch;
    for (const char* wrong : {"1 2\n", "1 2 3\n1 2 3 4\n", "1 2 x\n", "1 2 nan\n", "", "# nothing\n", "1 2 1e300\n"})
        EXPECT_THROW(read_point_cloud(scratch.file("w.xyz", wrong)), Error) << wrong;
    EXPECT_THROW(read_point_cloud(scratch / "absent.xyz"), Error);
    EXPECT_THROW(estimate_normals({}), Error);
    EXPECT_THROW(estimate_normals(std::vector<Point>(100, Point(1, 2, 3))), Error);
    EXPECT_THROW(point_spacing({Point(0, 0, 0)}), Error);
    PointCloud line;
    for (int i = 0; i < 100; ++i) line.points.emplace_back(i, 2 * i, 3 * i);
    EXPECT_THROW(reconstruct_surface(line), Error);
    CloudOptions options;
    options.neighbours = 1;
    EXPECT_THROW(estimate_normals(ball(100, 1, {0, 0, 0}), options), Error);
}

TEST(FragmentFile, PointsBecomeAFragmentWithFacets) {
    const Scratch scratch;
    const test::SyntheticSherd bar = test::synthetic_bar(2);
    std::ostringstream text;
    text.precision(17);
    for (const Vertex v : bar.mesh.vertices()) text << bar.mesh.point(v) << '\n';
    EXPECT_TRUE(read_fragment(scratch.file("alone.xyz", text.str())).notes.empty());
    write_file(scratch / "bar.ant.json", "{}");
    const FragmentFile file = read_fragment(scratch.file("bar.xyz", text.str()));
    ASSERT_FALSE(file.notes.empty());
    EXPECT_NE(file.notes.back().find("bar.ant.json is not read"), std::string::npos) << file.notes.back();
    EXPECT_TRUE(file.points);
    EXPECT_EQ(file.facets_from, "shape");
    double broken = 0, truth = 0;
    // The flat end may be cut or formed.
    for (const Face face : file.fragment.mesh.faces())
        if (centroid(file.fragment.mesh, face).z() > 0.1)
            broken += file.fragment.facets[face] == Facet::fracture ? face_area(file.fragment.mesh, face) : 0;
    for (const Face face : bar.mesh.faces()) truth += bar.facets[face] == Facet::fracture ? face_area(bar.mesh, face) : 0;
    EXPECT_NEAR(broken, truth, 0.1 * truth);
}

TEST(FragmentFile, ALooseScrapDoesNotMakeAFragmentOpen) {
    const Scratch scratch;
    TriangleSoup soup = to_soup(test::synthetic_sherd(1, 2, 0, 1).mesh);
    const auto [a, b, c] = soup.triangles[100];
    auto apex = soup.points[c];
    for (double& x : apex) x *= 1.01;
    soup.points.push_back(apex);
    soup.triangles.push_back({a, b, static_cast<Index>(soup.points.size() - 1)});  // a third triangle on an edge
    write_triangles(scratch / "sherd.ply", soup);
    const FragmentFile file = read_fragment(scratch / "sherd.ply");
    EXPECT_EQ(file.facets_from, "shape");
    EXPECT_FALSE(file.notes.empty());
    EXPECT_TRUE(file.found.shell);
}

TEST(FragmentFile, AnnotationsOverrideTheShape) {
    const Scratch scratch;
    const test::SyntheticSherd sherd = test::synthetic_sherd(1, 2, 0, 1);
    write_mesh(scratch / "sherd.ply", sherd.mesh);
    using FacetSource = FragmentFileOptions::FacetSource;
    FragmentFileOptions options;
    EXPECT_EQ(read_fragment(scratch / "sherd.ply", options).facets_from, "shape") << "closed, not annotated";
    options.facets = FacetSource::none;
    EXPECT_EQ(read_fragment(scratch / "sherd.ply", options).fragment.facets.size(), 0U);
    // A tenth of the faces are annotated as fracture, regardless of their shape.
    AnnotationSet set;
    Annotation stated;
    stated.tag = "Fracture";
    for (Index f = 0; f < sherd.facets.size(); f += 10) stated.faces.push_back(f);
    set.annotations.push_back(stated);
    write_annotations(scratch / "sherd.ant.json", {sherd.mesh, set}, "sherd.ply", {});
    options.facets = FacetSource::either;
    const FragmentFile either = read_fragment(scratch / "sherd.ply", options);
    EXPECT_EQ(either.facets_from, "annotations");
    options.facets = FacetSource::automatic;
    const FragmentFile both = read_fragment(scratch / "sherd.ply", options);
    EXPECT_EQ(both.facets_from, "shape and annotations");
    for (std::size_t f = 0; f < sherd.facets.size(); ++f) {
        EXPECT_EQ(either.fragment.facets[f], f % 10 == 0 ? Facet::fracture : Facet::outer);
        EXPECT_EQ(both.fragment.facets[f], f % 10 == 0 ? Facet::fracture : both.found.of_face[f]);
    }
    // The whole mesh is a region too.
    set.annotations[0].all = true;
    set.annotations[0].faces.resize(sherd.facets.size());
    std::iota(set.annotations[0].faces.begin(), set.annotations[0].faces.end(), 0U);
    write_annotations(scratch / "sherd.ant.json", {sherd.mesh, set}, "sherd.ply", {});
    const FragmentFile fragment = read_fragment(scratch / "sherd.ply", options);
    EXPECT_EQ(fragment.facets_from, "shape and annotations");
    EXPECT_EQ(fragment.fragment.facets, std::vector<Facet>(sherd.facets.size(), Facet::fracture));
    options.facets = FacetSource::annotated;
    std::filesystem::remove(scratch / "sherd.ant.json");
    EXPECT_EQ(read_fragment(scratch / "sherd.ply", options).facets_from, "nowhere");
    EXPECT_THROW(set_option(options, "facets", "guess"), Error);
}

}  // namespace
}  // namespace ostraka
