#include "ostraka/select/creases.h"

#include "meshes.h"
#include "scratch.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/error.h"
#include "ostraka/files/file.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/synthetic/make_mesh.h"

#include <algorithm>
#include <numbers>
#include <random>

namespace ostraka {
namespace {

/// An upright tube of radius 10 and height 60, closed by its ends' rounding, whose radius grows by `bump` around z = 30 with a
/// width of 1.5.
TriangleSoup ringed_tube(double bump, double noise = 0, double scale = 1) {
    std::mt19937_64 random(7);
    TriangleSoup soup = test::grid(160, 300, true, false, [&](double u, double v) {
        const double z = 60 * v, angle = 2 * std::numbers::pi * u, x = (z - 30) / 1.5;
        const double r = 10 + bump * std::exp(-x * x) + noise * (double(random() >> 11) * 0x1p-53 - 0.5);
        return std::array<double, 3>{scale * r * std::cos(angle), scale * r * std::sin(angle), scale * z};
    });
    return soup;
}

CreaseOptions fine() {
    CreaseOptions options;
    options.scale = 0.02;
    return options;
}

TEST(Creases, ARingOfClayIsOneClosedRidge) {
    for (const double scale : {1e-3, 1.0, 1e5}) {
        const Mesh mesh = build_mesh(ringed_tube(1, 0, scale));
        CreaseOptions options = fine();
        options.kind = CreaseOptions::Kind::ridge;
        const auto creases = find_creases(mesh, options);
        ASSERT_EQ(creases.size(), 1U) << scale;
        EXPECT_TRUE(creases[0].closed);
        EXPECT_TRUE(creases[0].ridge);
        for (const Index v : creases[0].line) EXPECT_NEAR(mesh.point(Vertex(v)).z() / scale, 30, 0.3);
        EXPECT_NEAR(creases[0].length / scale, 2 * std::numbers::pi * 11, 0.6);
        EXPECT_GT(creases[0].mean_curvature, 0);
        for (std::size_t i = 1; i < creases[0].line.size(); ++i)
            EXPECT_NE(find_halfedge(mesh, Vertex(creases[0].line[i - 1]), Vertex(creases[0].line[i])), Mesh::null_halfedge());
    }
}

TEST(Creases, AFurrowIsAHollow) {
    const Mesh mesh = build_mesh(ringed_tube(-1));
    CreaseOptions options = fine();
    options.kind = CreaseOptions::Kind::hollow;
    const auto creases = find_creases(mesh, options);
    ASSERT_EQ(creases.size(), 1U);
    EXPECT_TRUE(creases[0].closed);
    EXPECT_FALSE(creases[0].ridge);
    EXPECT_LT(creases[0].mean_curvature, 0);
}

TEST(Creases, NoiseHidesAndAddsNoCreases) {
    const Mesh mesh = build_mesh(ringed_tube(1, 0.1));
    CreaseOptions options = fine();
    options.kind = CreaseOptions::Kind::ridge;
    const auto creases = find_creases(mesh, options);
    ASSERT_EQ(creases.size(), 1U);
    EXPECT_TRUE(creases[0].closed);
    for (const Index v : creases[0].line) EXPECT_NEAR(mesh.point(Vertex(v)).z(), 30, 1.2);
}

TEST(Creases, SmoothShapesHaveNone) {
    EXPECT_TRUE(find_creases(build_mesh(ringed_tube(0)), fine()).empty());
    EXPECT_TRUE(find_creases(build_mesh(test::octahedron_sphere(5)), fine()).empty());
    EXPECT_TRUE(find_creases(build_mesh(test::grid(60, 60, false, false,
                                                   [](double u, double v) {
                                                       return std::array<double, 3>{u, v, 0};
                                                   })),
                             fine())
                    .empty());
    EXPECT_TRUE(find_creases(Mesh(), fine()).empty());
    // One triangle is too coarse for any scale.
    EXPECT_THROW(find_creases(build_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}), fine()), Error);
}

TEST(Creases, APartialRidgeIsAnOpenLine) {
    // The ring only over half of the circle.
    TriangleSoup soup = ringed_tube(0);
    for (auto& p : soup.points) {
        const double r = std::hypot(p[0], p[1]), x = (p[2] - 30) / 1.5;
        if (p[1] <= 0) continue;
        const double factor = 1 + 0.1 * std::exp(-x * x) * std::min(1.0, p[1] / 3);
        p[0] *= factor, p[1] *= factor;
        EXPECT_GT(r, 0);
    }
    CreaseOptions options = fine();
    options.kind = CreaseOptions::Kind::ridge;
    const auto creases = find_creases(build_mesh(soup), options);
    ASSERT_EQ(creases.size(), 1U);
    EXPECT_FALSE(creases[0].closed);
    EXPECT_NEAR(creases[0].length, std::numbers::pi * 10.5, 5);
}

TEST(Creases, JointsOfASyntheticObjectAreHollows) {
    MakeOptions options;
    options.vertices = 30000;
    const SyntheticObject& object = synthetic_object("teapot");
    const SyntheticMesh object_mesh = make_mesh(object, options);
    const auto label = [&](const std::string& name) {
        return static_cast<int>(std::find(object.parts.begin(), object.parts.end(), name) - object.parts.begin());
    };
    CreaseOptions finding;
    finding.kind = CreaseOptions::Kind::hollow;
    finding.scale = 0.015;
    std::vector<Point> crest;
    for (const Crease& crease : find_creases(object_mesh.mesh, finding))
        for (const Index v : crease.line) crest.push_back(object_mesh.mesh.point(Vertex(v)));
    ASSERT_FALSE(crest.empty());
    const double tolerance = 0.02 * box_diagonal(object_mesh.mesh);
    for (const auto& [part_name, neighbour_name] :
         {std::pair{"handle", "body"}, {"spout", "body"}, {"base", "body"}, {"lid", "knob"}}) {
        std::size_t near = 0, total = 0;
        for (const Edge e : object_mesh.mesh.edges()) {
            const Halfedge h = object_mesh.mesh.halfedge(e);
            const int a = object_mesh.face_labels[object_mesh.mesh.face(h)],
                      b = object_mesh.face_labels[object_mesh.mesh.face(object_mesh.mesh.opposite(h))];
            if (std::minmax(a, b) != std::minmax(label(part_name), label(neighbour_name))) continue;
            double minimum = 1e300;
            for (const Point& p : crest)
                minimum = std::min(minimum, CGAL::squared_distance(p, object_mesh.mesh.point(object_mesh.mesh.source(h))));
            near += std::sqrt(minimum) < tolerance ? 1 : 0;
            ++total;
        }
        ASSERT_GT(total, 10U) << part_name;
        EXPECT_GT(double(near), 0.7 * double(total)) << part_name << " on " << neighbour_name;
    }
}

TEST(Creases, AsAnnotations) {
    std::vector<Crease> creases(3);
    creases[0].line = {1, 2, 3};
    creases[0].faces = {4};
    creases[0].length = 7;
    creases[1].ridge = false;
    const AnnotationSet lines = annotate_creases(creases, false, "mm"), regions = annotate_creases(creases, true);
    ASSERT_EQ(lines.annotations.size(), 3U);
    EXPECT_EQ(lines.unit, "mm");
    EXPECT_EQ(regions.unit, "");
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(lines.annotations[i].id, static_cast<int>(i));
        EXPECT_EQ(lines.annotations[i].tag, (std::vector<std::string>{"ridge 1", "hollow 1", "ridge 2"}[i]));
        EXPECT_EQ(lines.annotations[i].type, AnnotationType::line);
        EXPECT_EQ(regions.annotations[i].type, AnnotationType::region);
        EXPECT_EQ(lines.annotations[i].attributes.size(), 4U);
        EXPECT_EQ(regions.annotations[i].attributes.size(), 3U) << "a region has no length";
    }
    EXPECT_EQ(lines.annotations[0].polylines, std::vector<std::vector<Index>>{creases[0].line});
    EXPECT_EQ(regions.annotations[0].faces, creases[0].faces);
    EXPECT_EQ(lines.annotations[0].attributes[0].name, "length");
    EXPECT_NE(lines.annotations[0].colour, lines.annotations[2].colour);
    EXPECT_TRUE(annotate_creases({}, false).annotations.empty());
}

TEST(Creases, OptionsOutOfRangeAreRefused) {
    CreaseOptions options;
    options.scale = 0;
    EXPECT_THROW(find_creases(Mesh(), options), Error);
    EXPECT_THROW(set_option(options, "kind", "groove"), Error);
}

TEST(CreasesCommand, WritesAnnotationsOrReportsThatThereAreNone) {
    const test::Scratch scratch;
    write_mesh(scratch / "tube.ply", build_mesh(ringed_tube(1)));
    write_mesh(scratch / "ball.ply", build_mesh(test::octahedron_sphere(6)));
    const auto run = [&](const std::string& mesh, const std::string& flags) {
        return test::run_command("annotation creases " + (scratch / mesh).string() + " " + (scratch / "out.ant.json").string() +
                                 flags);
    };
    const Mesh mesh = read_mesh(scratch / "tube.ply").mesh;
    for (const char* flags : {" --scale 0.02 --kind ridge --unit mm", " --scale 0.02 --kind ridge --regions"}) {
        const auto result = run("tube.ply", flags);
        EXPECT_EQ(result.code, 0) << result.err;
        const AnnotationSet set = read_annotations(scratch / "out.ant.json", mesh, {});
        ASSERT_EQ(set.annotations.size(), 1U);
        EXPECT_EQ(set.annotations[0].tag, "ridge 1");
        const std::string provenance = to_text(set.provenance);
        for (const char* option : {"\"regions\"", "\"scale\"", "\"kind\"", "\"floor\""})
            EXPECT_NE(provenance.find(option), std::string::npos) << provenance;
        EXPECT_EQ(provenance.find("\"unit\": \"mm\"") != std::string::npos, set.unit == "mm") << provenance;
        const bool has_unit = std::string(flags).find("--unit") != std::string::npos;
        EXPECT_EQ(result.out.find("mean curvature 1/mm") != std::string::npos, has_unit) << result.out;
        EXPECT_NE(result.out.find("robust standard deviations"), std::string::npos) << result.out;
    }
    // Earlier contents of the file are kept.
    const std::string before = read_file(scratch / "out.ant.json");
    const auto none = run("ball.ply", "");
    EXPECT_EQ(none.code, 3);
    EXPECT_EQ(read_file(scratch / "out.ant.json"), before);
    EXPECT_NE(none.err.find("is not written"), std::string::npos) << none.err;
    const auto fine = run("tube.ply", " --scale 0.0001");
    EXPECT_EQ(fine.code, 2);
    EXPECT_NE(fine.err.find("too coarse"), std::string::npos) << fine.err;
    // With the suggested scale it works.
    const auto at = fine.err.find("use --scale ");
    ASSERT_NE(at, std::string::npos) << fine.err;
    EXPECT_NE(run("tube.ply", " --scale " + fine.err.substr(at + 12, fine.err.find(' ', at + 12) - at - 12)).code, 2);
    const auto above = run("tube.ply", " --weak 7");
    EXPECT_EQ(above.code, 2);
    EXPECT_NE(above.err.find("--weak"), std::string::npos) << above.err;
    EXPECT_NE(none.err.find("--scale"), std::string::npos);
    EXPECT_EQ(run("tube.ply", " --scale 0").code, 2);
    EXPECT_EQ(run("gone.ply", "").code, 1);
}

}  // namespace
}  // namespace ostraka
