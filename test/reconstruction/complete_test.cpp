// Fragments and template joined into one surface.
#include "ostraka/reconstruction/complete.h"

#include "meshes.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/submesh.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/io/diagnose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace ostraka {
namespace {

using Eigen::Vector3d;

/// The part of a mesh whose faces' centres satisfy a condition, as a fragment in its true pose.
PlacedFragment part(const Mesh& mesh, const std::function<bool(const Point&)>& inside) {
    std::vector<bool> keep(mesh.number_of_faces());
    for (const Face face : mesh.faces()) keep[face] = inside(centroid(mesh, face));
    PlacedFragment fragment;
    fragment.mesh = keep_faces(mesh, keep).mesh;
    return fragment;
}

Mesh grown(Mesh mesh, double factor) {
    for (const Vertex v : mesh.vertices()) mesh.point(v) = point_of(factor * eigen(mesh.point(v)));
    return mesh;
}

/// Sphere meshed differently from octahedron_sphere, rotated so that no two vertices coincide.
Mesh other_sphere(Index columns, double radius) {
    Mesh mesh = build_mesh(test::grid(columns, columns, true, false, [&](double u, double v) {
        const double a = 2 * M_PI * u, b = M_PI * (0.02 + 0.96 * v);
        const Vector3d p = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()) *
                           Vector3d(std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), -std::cos(b));
        return std::array<double, 3>{radius * p.x(), radius * p.y(), radius * p.z()};
    }));
    const Vector outward = area_vector(mesh, Face(0));
    if (outward * (centroid(mesh, Face(0)) - CGAL::ORIGIN) > 0) return mesh;
    TriangleSoup soup = to_soup(mesh);
    for (auto& t : soup.triangles) std::swap(t[1], t[2]);
    return build_mesh(soup);
}

void expect_sound(const CompletedObject& object, bool closed, int euler) {
    const MeshDiagnosis diagnosis = diagnose(to_soup(object.mesh));
    EXPECT_TRUE(diagnosis.manifold());
    EXPECT_TRUE(diagnosis.oriented());
    EXPECT_EQ(diagnosis.closed(), closed);
    EXPECT_EQ(diagnosis.euler(), euler);
    EXPECT_EQ(diagnosis.self_intersections, 0U);
    EXPECT_EQ(diagnosis.isolated_vertices, 0U);
    const std::size_t n = object.mesh.number_of_faces();
    ASSERT_EQ(object.origin.size(), n);
    ASSERT_EQ(object.fragment.size(), n);
    ASSERT_EQ(object.fragment_face.size(), n);
    ASSERT_EQ(object.template_face.size(), n);
    ASSERT_EQ(object.distance.size(), n);
    ASSERT_EQ(object.confidence.size(), n);
    for (std::size_t f = 0; f < n; ++f) {
        EXPECT_EQ(object.fragment_face[f] == no_index, object.template_face[f] != no_index);
        EXPECT_EQ(object.distance[f] == 0, object.origin[f] == Origin::observed);
        EXPECT_EQ(object.confidence[f] == 1, object.origin[f] == Origin::observed);
    }
}

/// Area of the faces that are a fragment's own.
double own_area(const CompletedObject& object, int fragment) {
    double sum = 0;
    for (const Face face : object.mesh.faces())
        if (object.fragment_face[face] != no_index && object.fragment[face] == fragment) sum += face_area(object.mesh, face);
    return sum;
}

TEST(Complete, AnotherMeshOfTheSurfaceIsJoinedWithoutAGap) {
    const Mesh ball = build_mesh(test::octahedron_sphere(4));
    for (const double radius : {1.0, 1.01, 0.99}) {
        const PlacedFragment cap = part(other_sphere(60, radius), [](const Point& p) { return p.z() > 0.2; });
        const CompletedObject object = complete(ball, {cap});
        EXPECT_TRUE(object.notes.empty());
        expect_sound(object, true, 2);
        EXPECT_EQ(object.joined.at(0), cap.mesh.number_of_faces());
        EXPECT_NEAR(own_area(object, 0), surface_area(cap.mesh), 1e-9);
        // Fragments' vertices are unchanged; the rest of the ball is the template's or near the seam.
        for (const Face face : object.mesh.faces())
            for (const Vertex v : corners(object.mesh, face)) {
                const double r = eigen(object.mesh.point(v)).norm();
                EXPECT_GT(r, std::min(1.0, radius) - 0.005);
                EXPECT_LT(r, std::max(1.0, radius) + 0.005);
            }
        EXPECT_NEAR(surface_area(object.mesh), 4 * M_PI, 0.2);
    }
}

TEST(Complete, PiecesWithHolesAndSeveralFragmentsThatOverlap) {
    const Mesh ring = build_mesh(test::torus(96, 48));
    const PlacedFragment half = part(ring, [](const Point& p) { return p.x() > 0.123; });  // two borders on a handle
    const PlacedFragment front =
        part(ring, [](const Point& p) { return p.y() > 0.05 && std::hypot(p.x() + 0.6, p.y() - 0.6) > 0.2; });
    const CompletedObject object = complete(ring, {half, front});
    EXPECT_TRUE(object.notes.empty()) << object.notes.front().text;
    expect_sound(object, true, 0);
    EXPECT_EQ(object.joined[0], half.mesh.number_of_faces());
    EXPECT_GT(object.joined[1], 0U);
    EXPECT_LT(object.joined[1], front.mesh.number_of_faces());
    EXPECT_NEAR(object.on_template[0], 1, 1e-12);
    EXPECT_EQ(object.shared[0], 0);
    EXPECT_NEAR(object.shared[1], 0.5, 0.1);
    EXPECT_NEAR(surface_area(object.mesh), surface_area(ring), 1e-6 * surface_area(ring));
    // In the other order the result is also valid.
    expect_sound(complete(ring, {front, half}), true, 0);
}

TEST(Complete, OpenTemplatesStayOpen) {
    const Mesh ball = other_sphere(40, 1);
    const PlacedFragment side = part(build_mesh(test::octahedron_sphere(5)), [](const Point& p) { return p.y() < -0.3; });
    const CompletedObject object = complete(ball, {side});
    EXPECT_TRUE(object.notes.empty());
    const MeshDiagnosis before = diagnose(to_soup(ball));
    expect_sound(object, false, static_cast<int>(before.euler()));
    EXPECT_EQ(diagnose(to_soup(object.mesh)).border_edges, before.border_edges);
}

TEST(Complete, RoughBordersAreErodedUntilTheyAreSimple) {
    const Mesh ball = build_mesh(test::octahedron_sphere(4));
    PlacedFragment cap =
        part(other_sphere(80, 1), [](const Point& p) { return p.z() + 0.1 * std::sin(40 * p.x() * p.y()) > 0.1; });
    // Noise as large as an edge, along the surface and off it.
    std::uint64_t state = 1;
    const auto draw = [&] {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        return static_cast<double>(state >> 11) * 0x1p-53 - 0.5;
    };
    for (const Vertex v : cap.mesh.vertices())
        cap.mesh.point(v) = point_of(eigen(cap.mesh.point(v)) + 0.02 * Vector3d(draw(), draw(), draw()));
    const CompletedObject object = complete(ball, {cap});
    EXPECT_TRUE(object.notes.empty()) << object.notes.front().text;
    const MeshDiagnosis diagnosis = diagnose(to_soup(object.mesh));
    EXPECT_TRUE(diagnosis.manifold());
    EXPECT_TRUE(diagnosis.closed());
    EXPECT_EQ(diagnosis.euler(), 2);
    EXPECT_GT(own_area(object, 0), 0.5 * surface_area(cap.mesh));
}

TEST(Complete, NoiseCausesNoIntersectionsAtTheSeam) {
    const Mesh ball = build_mesh(test::octahedron_sphere(4));
    std::uint64_t state = 1;
    const auto draw = [&] {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        return static_cast<double>(state >> 11) * 0x1p-53 - 0.5;
    };
    for (int k = 0; k < 6; ++k) {
        PlacedFragment cap = part(other_sphere(80, 1), [](const Point& p) { return p.z() + 0.1 * std::sin(9 * p.x()) > 0.1; });
        for (const Vertex v : cap.mesh.vertices()) cap.mesh.point(v) = point_of((1 + 0.05 * draw()) * eigen(cap.mesh.point(v)));
        const CompletedObject object = complete(ball, {cap});
        EXPECT_TRUE(object.notes.empty());
        EXPECT_GT(own_area(object, 0), 0.8 * surface_area(cap.mesh));
        for (const auto& [a, b] : self_intersections(to_soup(object.mesh)).pairs)
            EXPECT_TRUE(object.template_face[a] == no_index && object.template_face[b] == no_index);
    }
}

TEST(Complete, PiecesThatLieOnTheFragmentItselfAreLeftOut) {
    // A scan with flakes: 30 small pieces just above the rest.
    const Mesh ball = build_mesh(test::octahedron_sphere(4));
    TriangleSoup soup = to_soup(part(other_sphere(80, 1), [](const Point& p) { return p.z() > -0.1; }).mesh);
    const Mesh fine = other_sphere(300, 1.004);
    for (int k = 0; k < 30; ++k) {
        const double a = 2.399963 * k, z = 0.15 + 0.7 * k / 30, r = std::sqrt(1 - z * z);
        const Vector3d centre(r * std::cos(a), r * std::sin(a), z);
        const TriangleSoup flake = to_soup(part(fine, [&](const Point& p) { return (eigen(p) - centre).norm() < 0.09; }).mesh);
        const auto first = static_cast<Index>(soup.points.size());
        soup.points.insert(soup.points.end(), flake.points.begin(), flake.points.end());
        for (const auto& t : flake.triangles) soup.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    PlacedFragment scan;
    scan.mesh = build_mesh(soup);
    CompleteOptions options;
    options.min_piece = 1e-4;
    const CompletedObject object = complete(ball, {scan}, options);
    EXPECT_TRUE(object.notes.empty()) << object.notes.front().text;
    expect_sound(object, true, 2);
    EXPECT_NEAR(own_area(object, 0), 2.2 * M_PI, 0.1);
}

TEST(Complete, DistantOppositeAndFractureFacesAreNotUsed) {
    const Mesh ball = build_mesh(test::octahedron_sphere(4));
    const PlacedFragment far_away = part(grown(ball, 1.2), [](const Point& p) { return p.z() > 0; });
    TriangleSoup inside_out = to_soup(part(ball, [](const Point& p) { return p.z() > 0; }).mesh);
    for (auto& t : inside_out.triangles) std::swap(t[1], t[2]);
    PlacedFragment turned, broken = part(ball, [](const Point&p) { return p.z() > 0; });
    turned.mesh = build_mesh(inside_out);
    broken.facets.assign(broken.mesh.number_of_faces(), Facet::fracture);
    for (const PlacedFragment* fragment : std::vector<const PlacedFragment*>{&far_away, &turned, &broken}) {
        const CompletedObject object = complete(ball, {*fragment});
        EXPECT_EQ(object.mesh.number_of_faces(), ball.number_of_faces());
        ASSERT_EQ(object.notes.size(), 1U);
        EXPECT_NE(object.notes[0].text.find("no part of it lies on the fitted template"), std::string::npos);
        for (const Origin origin : object.origin) EXPECT_EQ(origin, Origin::hypothesis);
        for (const double d : object.distance) EXPECT_EQ(d, -1);
    }
    EXPECT_THROW(complete(Mesh(), {far_away}), Error);
}

TEST(Complete, WholeSurfacesAndTheTemplatesOwnTriangles) {
    const Mesh ball = build_mesh(test::octahedron_sphere(3));
    PlacedFragment whole_ball;
    whole_ball.mesh = ball;
    EXPECT_EQ(complete(ball, {whole_ball}).mesh.number_of_faces(), ball.number_of_faces());
    CompleteOptions options;
    options.join = false;
    const CompletedObject object = complete(ball, {part(other_sphere(60, 1), [](const Point& p) { return p.z() > 0; })}, options);
    EXPECT_EQ(object.mesh.number_of_faces(), ball.number_of_faces());
    for (const Face face : ball.faces()) {
        const double z = centroid(ball, face).z();
        if (std::abs(z) > 0.3) {
            EXPECT_EQ(object.origin[face], z > 0 ? Origin::observed : Origin::hypothesis);
        }
    }
}

TEST(Complete, TheSameForAnyNumberOfThreadsAtAnyScaleAndFarAway) {
    const int before = threads();
    for (const double scale : {1.0, 1e-6, 1e6}) {
        const auto place = [&](Mesh mesh, const Vector3d& shift) {
            for (const Vertex v : mesh.vertices()) mesh.point(v) = point_of(scale * (eigen(mesh.point(v)) + shift));
            return mesh;
        };
        for (const Vector3d& shift : {Vector3d(0, 0, 0), Vector3d(1000, 0, 0)}) {
            PlacedFragment cap = part(other_sphere(60, 1.005), [](const Point& p) { return p.x() > 0.2; });
            cap.mesh = place(cap.mesh, shift);
            const Mesh ball = place(build_mesh(test::octahedron_sphere(4)), shift);
            set_threads(1);
            const CompletedObject single = complete(ball, {cap});
            set_threads(2);
            const CompletedObject two = complete(ball, {cap});
            set_threads(before);
            EXPECT_TRUE(single.notes.empty());
            EXPECT_TRUE(diagnose(to_soup(single.mesh)).closed());
            EXPECT_EQ(mesh_checksum(single.mesh), mesh_checksum(two.mesh));
            EXPECT_EQ(single.confidence, two.confidence);
        }
    }
}

}  // namespace
}  // namespace ostraka
