#include "ostraka/transfer/bound_mesh.h"

#include "meshes.h"
#include "ostraka/annotation/annotation_file.h"

#include <gtest/gtest.h>

#include <set>

#include <cmath>
#include <set>

namespace ostraka {
namespace {

/// A ball whose upper cap is annotated, with a seam from the top down, its top as a point, labels and colours.
MeshFile labelled_ball() {
    MeshFile file{build_mesh(test::octahedron_sphere(4)), {}, {}, {}};
    for (const Face f : file.mesh.faces()) file.extras.face_labels.push_back(centroid(file.mesh, f).z() > 0 ? 4 : 9);
    for (const Vertex v : file.mesh.vertices())
        file.extras.vertex_colours.push_back({std::uint8_t(100 + 50 * file.mesh.point(v).x()), 7, 8, 255});
    return file;
}

AnnotationSet annotated(const Mesh& mesh) {
    AnnotationSet set;
    Annotation cap, seam, top;
    cap.id = 3, cap.tag = "cap", cap.type = AnnotationType::region;
    for (const Face f : mesh.faces())
        if (centroid(mesh, f).z() > 0.5) cap.faces.push_back(f);
    seam.id = 4, seam.tag = "seam", seam.type = AnnotationType::line, seam.polylines = {{4}};
    for (int i = 0; i < 8; ++i) {
        const Vertex v(seam.polylines[0].back());
        Vertex lowest = v;
        for (const Vertex w : CGAL::vertices_around_target(v, mesh))
            if (mesh.point(w).z() < mesh.point(lowest).z()) lowest = w;
        seam.polylines[0].push_back(lowest);
    }
    top.id = 5, top.tag = "top", top.type = AnnotationType::point, top.points = {4};
    set.annotations = {cap, seam, top};
    return set;
}

void expect_whole(const BoundMesh& bound) {
    EXPECT_EQ(bound.extras.face_labels.size(), bound.mesh.number_of_faces());
    ASSERT_EQ(bound.extras.vertex_colours.size(), bound.mesh.number_of_vertices());
    for (const Vertex v : bound.mesh.vertices())
        ASSERT_NEAR(bound.extras.vertex_colours[v][0], 100 + 50 * bound.mesh.point(v).x(), 8);
    check_annotations({bound.mesh, *bound.annotations}, "test");
    EXPECT_EQ(bound.after.vertices, bound.mesh.number_of_vertices());
    EXPECT_FALSE((bound.mesh.property_map<Face, std::uint32_t>(face_annotations).second));
    EXPECT_FALSE((bound.mesh.property_map<Face, std::int32_t>("f:file-label").second));
}

}  // namespace

TEST(BoundMesh, AProtectedRegionOfTheWholeMeshProtectsTheBorder) {
    const Mesh mesh = build_mesh(test::patch(24, 24));
    const auto border = [](const Mesh& surface) {
        std::set<Point> points;
        for (const Vertex v : surface.vertices())
            if (surface.is_border(v)) points.insert(surface.point(v));
        return points;
    };
    AnnotationSet listed, whole;
    ensure_root(whole, mesh);
    Annotation all_faces;
    all_faces.tag = "sheet";
    for (const Face f : mesh.faces()) all_faces.faces.push_back(f);
    listed.annotations = {all_faces};
    SimplifyOptions options;
    options.vertices = 200;
    for (const AnnotationSet* set : {&whole, &listed})
        for (const auto outlines : {SimplifyOptions::Outlines::protect, SimplifyOptions::Outlines::ignore}) {
            options.outlines = outlines;
            BoundMesh bound({mesh, {}, {}, {}}, *set);
            bound.simplify(options);
            EXPECT_EQ(bound.after.vertices, 200U);
            EXPECT_EQ(border(bound.mesh) == border(mesh), outlines == SimplifyOptions::Outlines::protect);
        }
}

TEST(BoundMesh, EverythingFollowsSuccessiveSteps) {
    MeshFile file = labelled_ball();
    const AnnotationSet set = annotated(file.mesh);
    BoundMesh bound(std::move(file), set);
    ASSERT_EQ(bound.changes.size(), 3U);
    EXPECT_EQ(bound.changes[0].before.elements, set.annotations[0].faces.size());
    EXPECT_EQ(bound.changes[1].before.elements, 8U);

    SimplifyOptions fewer;
    fewer.vertices = 300;
    EXPECT_TRUE(bound.simplify(fewer).reached);
    expect_whole(bound);
    EXPECT_EQ(bound.after.vertices, 300U);
    EXPECT_NEAR(bound.changes[0].after.area / bound.changes[0].before.area, 1, 0.1);
    EXPECT_LT(bound.changes[0].after.elements, bound.changes[0].before.elements);
    const BoundMesh::Change cap = bound.changes[0];

    RefineOptions more;
    more.levels = 1;
    EXPECT_EQ(bound.refine(more).levels, 1);
    expect_whole(bound);
    EXPECT_EQ(bound.changes[0].after.elements, 4 * cap.after.elements);
    EXPECT_NEAR(bound.changes[0].after.area, cap.after.area, 1e-9);
    EXPECT_EQ(bound.changes[0].before.elements, cap.before.elements);
    EXPECT_EQ(bound.before.vertices, 1026U);
    EXPECT_EQ(bound.annotations->find(5)->points.size(), 1U);
    EXPECT_EQ(bound.annotations->find(4)->polylines.size(), 1U);
}

TEST(BoundMesh, SmallAnnotationsDegenerateWithANote) {
    MeshFile file = labelled_ball();
    AnnotationSet set;
    for (int i = 0; i < 60; ++i) {
        Annotation& annotation = set.annotations.emplace_back();
        annotation.id = i, annotation.tag = "face " + std::to_string(i), annotation.type = AnnotationType::region,
        annotation.faces = {Index(i * 30)};
    }
    BoundMesh bound(std::move(file), set);
    SimplifyOptions few;
    few.vertices = 40;
    EXPECT_TRUE(bound.simplify(few).outlines_broken);
    std::size_t degenerate = 0;
    for (const BoundMesh::Change& change : bound.changes) {
        degenerate += change.degenerate ? 1 : 0;
        EXPECT_EQ(change.degenerate, bound.annotations->find(change.id)->type != AnnotationType::region);
        EXPECT_EQ(change.degenerate, !change.note.empty()) << change.note;
    }
    EXPECT_GT(degenerate, 0U);
}

/// A tube with two charts: u runs around the tube, from 0 to 1 on each half, v along the axis. Chart 1 has its own material.
MeshFile tube_in_two_charts() {
    MeshFile file{build_mesh(test::tube(64, 48)), {}, {}, {}};
    file.extras.appearance.materials.resize(2);
    for (const Face face : file.mesh.faces()) {
        const Point middle = centroid(file.mesh, face);
        const bool upper = middle.y() > 0;
        file.extras.face_materials.push_back(upper ? 1 : 0);
        for (const Vertex v : corners(file.mesh, face)) {
            const Point& p = file.mesh.point(v);
            double angle = std::atan2(p.y(), p.x());
            if (std::fabs(p.y()) < 1e-9) angle = p.x() > 0 ? 0 : upper ? M_PI : -M_PI;
            file.extras.corner_texture.push_back({static_cast<float>(std::fabs(angle) / M_PI), static_cast<float>(p.z() / 3)});
        }
    }
    return file;
}

/// Each corner has the texture coordinates of its place on the tube, within `tolerance`; seams are straight.
void expect_textured_tube(const BoundMesh& bound, double tolerance) {
    ASSERT_EQ(bound.extras.corner_texture.size(), 3 * bound.mesh.number_of_faces());
    ASSERT_EQ(bound.extras.face_materials.size(), bound.mesh.number_of_faces());
    for (const Face face : bound.mesh.faces()) {
        const bool upper = bound.extras.face_materials[face] == 1;
        const auto vertices = corners(bound.mesh, face);
        for (std::size_t k = 0; k < 3; ++k) {
            const Point& p = bound.mesh.point(vertices[k]);
            const auto [u, v] = bound.extras.corner_texture[3 * std::size_t(face) + k];
            ASSERT_NEAR(u, std::atan2(std::max(0.0, upper ? p.y() : -p.y()), p.x()) / M_PI, tolerance);
            ASSERT_NEAR(v, p.z() / 3, tolerance);
            ASSERT_GT(upper ? p.y() : -p.y(), -1e-9);  // no face crosses a seam
        }
    }
    EXPECT_TRUE(bound.notes.empty());
}

TEST(BoundMesh, TextureFollowsSimplificationAndRefinement) {
    BoundMesh bound(tube_in_two_charts());
    SimplifyOptions fewer;
    fewer.vertices = 300;
    EXPECT_TRUE(bound.simplify(fewer).reached);
    expect_textured_tube(bound, 0.02);
    RefineOptions more;
    more.levels = 1;
    bound.refine(more);
    // Midpoints lie inside the tube; their angle is exact by symmetry only up to the length of an edge.
    expect_textured_tube(bound, 0.03);
}

TEST(BoundMesh, SeamsAreKeptWhenOutlinesAreNot) {
    BoundMesh bound(tube_in_two_charts());
    SimplifyOptions fewer;
    fewer.vertices = 12;
    fewer.outlines = SimplifyOptions::Outlines::ignore;
    bound.simplify(fewer);
    std::set<Index> materials(bound.extras.face_materials.begin(), bound.extras.face_materials.end());
    EXPECT_EQ(materials.size(), 2U);
    expect_textured_tube(bound, 0.3);
}

TEST(BoundMesh, TheTextureOfAFlatChartIsExact) {
    MeshFile file{build_mesh(test::grid(30, 20, false, false,
                                        [](double u, double v) {
                                            return std::array<double, 3>{7 * u, 5 * v, 0};
                                        })),
                  {},
                  {},
                  {}};
    const auto texture_of = [](const Point& p) { return TexturePoint{float(0.1 + p.x() / 10), float(p.y() / 8 - p.x() / 20)}; };
    for (const Face face : file.mesh.faces())
        for (const Vertex v : corners(file.mesh, face)) file.extras.corner_texture.push_back(texture_of(file.mesh.point(v)));
    BoundMesh bound(std::move(file));
    SimplifyOptions fewer;
    fewer.vertices = 40;
    bound.simplify(fewer);
    RefineOptions more;
    more.vertices = 333;
    bound.refine(more);
    for (const Face face : bound.mesh.faces()) {
        const auto vertices = corners(bound.mesh, face);
        for (std::size_t k = 0; k < 3; ++k) {
            const TexturePoint expected = texture_of(bound.mesh.point(vertices[k])),
                               actual = bound.extras.corner_texture[3 * std::size_t(face) + k];
            ASSERT_NEAR(actual[0], expected[0], 1e-6);
            ASSERT_NEAR(actual[1], expected[1], 1e-6);
        }
    }
}

TEST(BoundMesh, ValuesOfVerticesAndFacesFollow) {
    MeshFile file{build_mesh(test::tube(32, 24)), {}, {}, {}};
    NamedValues height{"height", {}}, side{"side", {}};
    for (const Vertex v : file.mesh.vertices()) height.values.push_back(file.mesh.point(v).z());
    for (const Face f : file.mesh.faces()) side.values.push_back(centroid(file.mesh, f).x() > 0 ? 1 : -1);
    file.extras.vertex_values = {height};
    file.extras.face_values = {side};
    BoundMesh bound(std::move(file));
    SimplifyOptions fewer;
    fewer.vertices = 200;
    bound.simplify(fewer);
    RefineOptions more;
    more.levels = 1;
    bound.refine(more);
    ASSERT_EQ(bound.extras.vertex_values.size(), 1U);
    ASSERT_EQ(bound.extras.vertex_values[0].values.size(), bound.mesh.number_of_vertices());
    for (const Vertex v : bound.mesh.vertices())
        ASSERT_NEAR(bound.extras.vertex_values[0].values[v], bound.mesh.point(v).z(), 0.3);
    ASSERT_EQ(bound.extras.face_values[0].values.size(), bound.mesh.number_of_faces());
    for (const double value : bound.extras.face_values[0].values) ASSERT_EQ(std::fabs(value), 1);
}

}  // namespace ostraka
