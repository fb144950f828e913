// Vertices that slide along the fragment's surface: curves where parts meet, faces that both meshes share, and the resulting
// correspondences.
#include "../../src/reconstruction/joint_curves.h"
#include "../../src/reconstruction/shared_faces.h"

#include "pieces.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/point_tree.h"
#include "ostraka/reconstruction/reconstruct.h"
#include "ostraka/remesh/simplify.h"

#include <CGAL/boost/graph/Euler_operations.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {
namespace {

using namespace test;
using Eigen::Vector3d;

/// The body of `pieces.h`, meshed irregularly from a rotated sphere: another mesh for each angle.
Mesh meshed_body(std::size_t vertices, double angle) {
    Mesh mesh = deformed_by(build_mesh(octahedron_sphere(5)), [angle](const Vector3d& p) {
        const Vector3d q = Eigen::AngleAxisd(angle, Vector3d(1, 2, 3).normalized()) * p;
        return body_place(q);
    });
    SimplifyOptions simplify_options;
    simplify_options.vertices = vertices;
    simplify(mesh, simplify_options);
    mesh.collect_garbage();
    return mesh;
}

/// Parts one above the other.
std::vector<int> parts_of(const Mesh& mesh) {
    std::vector<int> labels;
    for (const Face face : mesh.faces()) {
        const double z = centroid(mesh, face).z();
        labels.push_back(z < -0.9 ? 0 : z < 0.2 ? 1 : z < 1.1 ? 2 : 3);
    }
    return labels;
}

/// Another member of its class: wider one way, narrower the other, its upper part taller, leaning.
Vector3d member(const Vector3d& p) {
    const double z = p.z() + 0.25 * std::max(0.0, p.z() - 0.2);
    return {1.12 * p.x() + 0.05 * z * z, 0.95 * p.y(), z};
}

/// Regions by labels, and landmarks at the vertices nearest to given points.
AnnotationSet annotated(const Mesh& mesh, const std::vector<int>& labels, const std::vector<Point>& marks) {
    AnnotationSet set;
    for (int part = 0; part <= *std::max_element(labels.begin(), labels.end()); ++part) {
        Annotation region;
        region.id = part;
        region.tag = "part " + std::to_string(part);
        for (Index f = 0; f < labels.size(); ++f)
            if (labels[f] == part) region.faces.push_back(f);
        if (!region.faces.empty()) set.annotations.push_back(std::move(region));
    }
    const PointTree tree([&] {
        std::vector<Point> points(mesh.points().begin(), mesh.points().end());
        return points;
    }());
    for (std::size_t i = 0; i < marks.size(); ++i)
        set.annotations.push_back(landmark(100 + static_cast<int>(i), "mark " + std::to_string(i), tree.nearest(marks[i]).index));
    return set;
}

struct Fitted {
    double error = 0;  ///< mean distance of vertices from their true positions
    Reconstruction result;
};

/// The template fitted to a share of the member, as `other` meshes it.
Fitted fit_member(const Mesh& mesh, const Mesh& other, double share, const std::string& counterparts) {
    const Mesh original = deformed_by(other, member);
    FragmentOptions breaking;
    breaking.share = share;
    const SyntheticFragment piece = generate_fragment(original, Point(0, 0, 2), breaking);
    const Motion to_piece = piece.pose.inverse();
    std::vector<Point> marks, marks_there;
    for (Index i = 0; i < 9; ++i) {
        marks.push_back(mesh.point(Vertex(i * 97U)));
        marks_there.push_back(point_of(to_piece(member(eigen(marks.back())))));
    }
    const std::vector<int> of_whole = parts_of(other);
    std::vector<int> labels;
    for (const Index f : piece.faces) labels.push_back(of_whole[f]);
    Fragment fragment;
    fragment.mesh = piece.mesh;
    fragment.annotations = annotated(piece.mesh, labels, marks_there);
    std::erase_if(fragment.annotations.annotations, [&](const Annotation& annotation) {
        constexpr double min_distance = 0.1;  // an edge
        return annotation.type == AnnotationType::point &&
               CGAL::squared_distance(piece.mesh.point(Vertex(annotation.points.front())),
                                      marks_there[static_cast<std::size_t>(annotation.id - 100)]) > min_distance * min_distance;
    });
    ReconstructOptions reconstruct_options;
    reconstruct_options.completion.join = false;
    set_option(reconstruct_options.fit, "counterparts", counterparts);
    Fitted fitted;
    fitted.result = reconstruct({mesh, annotated(mesh, parts_of(mesh), marks)}, {}, {&fragment}, reconstruct_options);
    if (!fitted.result.placement.any()) throw Error(ErrorKind::failure, "member", "was not placed", "");
    const Motion frame = fitted.result.placement.fragments[0].pose.after(to_piece);
    for (const Vertex v : mesh.vertices())
        fitted.error += (eigen(fitted.result.points[v]) - frame(member(eigen(mesh.point(v))))).norm() /
                        static_cast<double>(mesh.number_of_vertices());
    return fitted;
}

TEST(Sliding, IsNoFartherFromTheTruthThanOtherCounterparts) {
    const Mesh mesh = meshed_body(900, 0), again = meshed_body(1100, 1);
    for (const bool same : {true, false})
        for (const double share : {1.0, 0.6}) {
            const double error = fit_member(mesh, same ? mesh : again, share, "sliding").error;
            for (const std::string other : {"surface", "one-to-one"})
                EXPECT_LE(error, fit_member(mesh, same ? mesh : again, share, other).error)
                    << other << ", " << share << (same ? ", the template's mesh" : ", its own mesh");
        }
}

TEST(Sliding, IsTheDefaultAndAnOption) {
    NonRigidOptions options;
    EXPECT_EQ(option_text(options, "counterparts"), "sliding");
    EXPECT_THROW(set_option(options, "counterparts", "gliding"), Error);
}

TEST(Sliding, TinyFragmentsAreFitted) {
    const Mesh mesh = body(3);
    const AnnotationSet set = landmarks_of(mesh);
    // One triangle, all of whose corners are landmarks; its region and the template's share no edge.
    Fragment fragment;
    fragment.name = "crumb";
    TriangleSoup soup;
    const Face face(0);
    for (const Vertex v : corners(mesh, face)) {
        const Point& p = mesh.point(v);
        fragment.annotations.annotations.push_back(landmark(static_cast<int>(soup.points.size()),
                                                            "corner " + std::to_string(soup.points.size()),
                                                            static_cast<Index>(soup.points.size())));
        soup.points.push_back({p.x(), p.y(), p.z()});
    }
    soup.triangles.push_back({0, 1, 2});
    fragment.mesh = build_mesh(soup);
    Annotation region;
    region.id = 50;
    region.tag = "region";
    region.faces = {0};
    fragment.annotations.annotations.push_back(region);
    AnnotationSet ours;
    int corner = 0;
    for (const Vertex v : corners(mesh, face)) {
        ours.annotations.push_back(landmark(corner, "corner " + std::to_string(corner), v.idx()));
        ++corner;
    }
    ours.annotations.push_back(region);
    const Reconstruction result = reconstruct({mesh, ours}, {}, {&fragment});
    ASSERT_EQ(result.points.size(), mesh.number_of_vertices());
    for (const Vertex v : mesh.vertices())
        EXPECT_LT(std::sqrt(CGAL::squared_distance(result.points[v], mesh.point(v))), 0.01 * box_diagonal(mesh));
}

/// A disc on a sphere, larger on the other one: closest points alone leave its rim unchanged.
TEST(JointCurves, TheRimOfAPartMovesToTheRimOfItsCounterpart) {
    const Mesh mesh = build_mesh(octahedron_sphere(4)), other = build_mesh(octahedron_sphere(5));
    const auto disc = [](const Mesh& sphere, double height) {
        Annotation annotation;
        annotation.id = 100;
        annotation.tag = "disc";
        for (const Face face : sphere.faces())
            if (centroid(sphere, face).z() > height) annotation.faces.push_back(face);
        return annotation;
    };
    AnnotationSet ours = landmarks_of(mesh), theirs;
    std::erase_if(ours.annotations, [](const Annotation& annotation) { return annotation.id % 10 != 0; });
    const PointTree tree(std::vector<Point>(other.points().begin(), other.points().end()));
    for (const Annotation& annotation : ours.annotations)
        if (mesh.point(Vertex(annotation.points.front())).z() < 0)
            theirs.annotations.push_back(
                landmark(annotation.id, annotation.tag, tree.nearest(mesh.point(Vertex(annotation.points.front()))).index));
    ours.annotations.push_back(disc(mesh, 0.85));
    theirs.annotations.push_back(disc(other, 0.75));
    std::map<std::string, double> rim;
    for (const std::string counterparts : {"sliding", "surface"}) {
        std::vector<PlacedFragment> fragments(1);
        fragments[0].mesh = other;
        fragments[0].annotations = &theirs;
        for (const Annotation& annotation : theirs.annotations) fragments[0].matches.push_back({annotation.id, annotation.id, 1});
        NonRigidOptions options;
        set_option(options, "counterparts", counterparts);
        const NonRigidFit fit = fit_template({mesh, ours}, fragments, options);
        double sum = 0, count = 0;
        const std::vector<bool> inside = face_flags(mesh, ours.find(100)->faces);
        for (const Edge e : mesh.edges()) {
            const Halfedge h = mesh.halfedge(e);
            if (inside[mesh.face(h)] == inside[mesh.face(mesh.opposite(h))]) continue;
            sum += std::abs(fit.points[mesh.source(h)].z() - 0.75);
            ++count;
        }
        rim[counterparts] = sum / count;
    }
    EXPECT_LT(rim["sliding"], 0.03);
    EXPECT_LT(rim["sliding"], 0.5 * rim["surface"]);
}

TEST(JointCurves, EndWhereTheFragmentEnds) {
    // Two strips of two triangles, side by side along x: labels 0 and 1 meet along y = 0 from x = 0 to 1.
    TriangleSoup soup;
    soup.points = {{0, -1, 0}, {1, -1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    soup.triangles = {{0, 1, 3}, {0, 3, 2}, {2, 3, 5}, {2, 5, 4}};
    const Mesh mesh = build_mesh(soup);
    JointCurves curves;
    const std::vector<bool> breaks(6, true);
    curves.add(0, mesh, {0, 0, 1, 1}, {}, breaks, 1);
    const auto middle = curves.nearest({0.5, 0.1, 0}, {0, 1}, 1);
    ASSERT_TRUE(middle.has_value());
    EXPECT_EQ(middle->match.fragment, 0);
    EXPECT_LT((middle->match.place - Vector3d(0.5, 0, 0)).norm(), 1e-12);
    EXPECT_NEAR(std::abs(middle->along.x()), 1, 1e-12);
    const auto beyond = curves.nearest({1.2, 0.1, 0}, {0, 1}, 1);
    ASSERT_TRUE(beyond.has_value());
    EXPECT_EQ(beyond->match.fragment, -1) << "its counterpart may be missing";
    EXPECT_FALSE(curves.nearest({0.5, 0.1, 0}, {0, 2}, 1).has_value()) << "no such labels meet";
    EXPECT_FALSE(curves.nearest({0.5, 0.1, 0}, {1}, 1).has_value());
    EXPECT_FALSE(curves.nearest({0.5, 0.1, 0}, {0, 1}, 0.05).has_value());
    JointCurves broken;
    broken.add(0, mesh, {0, 0, 1, 1}, {Facet::outer, Facet::outer, Facet::fracture, Facet::fracture}, breaks, 1);
    EXPECT_FALSE(broken.nearest({0.5, 0.1, 0}, {0, 1}, 1).has_value()) << "beside a fracture nothing of the object meets";
}

TEST(SharedFaces, APieceOfTheMeshInAnotherShapeIsRecognised) {
    const Mesh mesh = meshed_body(900, 0), original = deformed_by(mesh, member);
    FragmentOptions options;
    options.share = 0.8;
    options.noise = 0.002;
    options.moved = false;
    const SyntheticFragment piece = generate_fragment(original, original.point(Vertex(7)), options);
    EXPECT_EQ(shared_vertices(mesh, piece.mesh), piece.vertices);
    // Without a broken part; its faces need not be the template's.
    std::vector<bool> broken(piece.mesh.number_of_faces(), false);
    for (const Face face : piece.mesh.faces()) broken[face] = centroid(piece.mesh, face).z() > 0.5;
    const std::vector<Index> rest = shared_vertices(mesh, piece.mesh, 1, broken);
    std::size_t shared_count = 0;
    for (std::size_t v = 0; v < rest.size(); ++v)
        if (rest[v] != no_index) {
            ++shared_count;
            EXPECT_EQ(rest[v], piece.vertices[v]);
        }
    EXPECT_GT(shared_count, rest.size() / 4);
}

TEST(SharedFaces, OtherMeshesShareNone) {
    const Mesh mesh = meshed_body(900, 0);
    const auto none = [](const std::vector<Index>& vertices) {
        return std::all_of(vertices.begin(), vertices.end(), [](Index v) { return v == no_index; });
    };
    EXPECT_TRUE(none(shared_vertices(mesh, meshed_body(900, 1)))) << "the same surface with another mesh";
    Mesh changed = mesh;
    const Edge first = *changed.edges().begin();
    CGAL::Euler::flip_edge(changed.halfedge(first), changed);
    EXPECT_TRUE(none(shared_vertices(mesh, changed))) << "one edge is another";
    FragmentOptions small;
    small.share = 0.005;
    EXPECT_TRUE(none(shared_vertices(mesh, generate_fragment(mesh, mesh.point(Vertex(0)), small).mesh)));
    EXPECT_TRUE(none(shared_vertices(mesh, mesh, 1, std::vector<bool>(mesh.number_of_faces(), true))));
    EXPECT_TRUE(shared_vertices(mesh, Mesh()).empty());
}

TEST(SharedFaces, OnASymmetricMeshTheNearestPositionCounts) {
    const Mesh mesh = build_mesh(octahedron_sphere(4)),
               turned = deformed_by(mesh, [](const Vector3d&p) {
                   return Vector3d(Eigen::AngleAxisd(0.3, Vector3d::UnitZ()) * Vector3d(1.1 * p.x(), p.y(), 0.9 * p.z()));
               });
    const std::vector<Index> vertices = shared_vertices(mesh, turned);
    for (Index v = 0; v < vertices.size(); ++v) EXPECT_EQ(vertices[v], v);
}

}  // namespace
}  // namespace ostraka
