#include "ostraka/reconstruction/fit.h"

#include "pieces.h"

#include "ostraka/annotation/outline.h"
#include "ostraka/geom/submesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ostraka {
namespace {

using namespace test;
using Eigen::Vector3d;

/// A sphere whose parts have slid on it: closest points cannot distinguish it from the original surface.
class SlidParts : public ::testing::Test {
protected:
    SlidParts() : mesh(build_mesh(octahedron_sphere(5))) {}

    /// Rotated about the z axis by `degrees` within a polar angle, decreasing beyond it.
    [[nodiscard]] Mesh slid(double degrees, double within) const {
        return deformed_by(mesh, [=](const Vector3d& p) {
            const double polar = std::acos(std::clamp(p.z(), -1.0, 1.0)),
                         share = std::clamp((1.3 - polar) / (1.3 - within), 0.0, 1.0);
            const double angle = degrees * std::numbers::pi / 180 * share * share * (3 - 2 * share);
            return Vector3d(Eigen::AngleAxisd(angle, Vector3d::UnitZ()) * p);
        });
    }
    /// The faces between two polar angles.
    [[nodiscard]] Annotation band(int id, const std::string& tag, double from, double to) const {
        Annotation annotation;
        annotation.id = id;
        annotation.tag = tag;
        for (const Face face : mesh.faces()) {
            const Vector3d c = eigen(centroid(mesh, face)).normalized();
            const double polar = std::acos(std::clamp(c.z(), -1.0, 1.0));
            if (polar >= from && polar < to) annotation.faces.push_back(face);
        }
        return annotation;
    }
    /// The vertex of the annotation's outlines nearest to a point.
    [[nodiscard]] Index on_outline(const Annotation& region, const Vector3d& place) const {
        Index best = no_index;
        for (const Outline& loop : extract_outlines(mesh, region.faces))
            for (const Index v : loop)
                if (best == no_index ||
                    (eigen(mesh.point(Vertex(v))) - place).norm() < (eigen(mesh.point(Vertex(best))) - place).norm())
                    best = v;
        return best;
    }
    /// `kept`: one flag per face of the fragment; empty: all.
    struct Result {
        std::vector<Point> points;
        std::vector<bool> is_observed;  ///< vertices that the fragment has
    };
    [[nodiscard]] Result fit(AnnotatedMeshView object, const std::vector<bool>& kept, bool outlines,
                             const std::vector<int>& left_out = {}, const std::string& counterparts = "surface") const {
        SubMesh sub = keep_faces(object.mesh, kept.empty() ? std::vector<bool>(object.mesh.number_of_faces(), true) : kept);
        std::vector<Index> face(object.mesh.number_of_faces(), no_index), vertex(object.mesh.number_of_vertices(), no_index);
        for (Index f = 0; f < sub.faces.size(); ++f) face[sub.faces[f]] = f;
        Result result;
        result.is_observed.assign(object.mesh.number_of_vertices(), false);
        for (Index v = 0; v < sub.vertices.size(); ++v) {
            vertex[sub.vertices[v]] = v;
            result.is_observed[sub.vertices[v]] = true;
        }
        AnnotationSet theirs;
        PlacedFragment fragment;
        for (const Annotation& annotation : object.annotations.annotations) {
            Annotation other = annotation;
            other.faces.clear();
            other.points.clear();
            other.polylines.clear();
            for (const Index f : annotation.faces)
                if (face[f] != no_index) other.faces.push_back(face[f]);
            std::sort(other.faces.begin(), other.faces.end());
            for (const Index v : annotation.points)
                if (vertex[v] != no_index) other.points.push_back(vertex[v]);
            for (const auto& line : annotation.polylines) {
                std::vector<Index> part;
                for (const Index v : line)
                    if (vertex[v] != no_index) part.push_back(vertex[v]);
                std::reverse(part.begin(), part.end());  // in the opposite direction
                if (part.size() > 1) other.polylines.push_back(part);
            }
            if (other.faces.empty() && other.points.empty() && other.polylines.empty()) continue;
            if (std::find(left_out.begin(), left_out.end(), annotation.id) != left_out.end()) continue;
            theirs.annotations.push_back(other);
            fragment.matches.push_back({annotation.id, annotation.id, 1});
        }
        fragment.mesh = std::move(sub.mesh);
        fragment.annotations = &theirs;
        std::vector<PlacedFragment> fragments;
        fragments.push_back(std::move(fragment));
        NonRigidOptions options;
        options.outlines = outlines;
        set_option(options, "counterparts", counterparts);
        result.points = fit_template({mesh, object.annotations}, fragments, options).points;
        return result;
    }
    /// Root mean square distance of the vertices of a region from their slid positions, for vertices on the fragment.
    [[nodiscard]] double error(const Result& result, const Mesh& original, const Annotation& region) const {
        double sum = 0, count = 0;
        for (const Index v : touched_vertices(mesh, region)) {
            if (!result.is_observed[v]) continue;
            sum += CGAL::squared_distance(result.points[v], original.point(Vertex(v)));
            ++count;
        }
        return std::sqrt(sum / count);
    }
    Mesh mesh;
};

TEST_F(SlidParts, AnOutlineDeterminesHowFarARegionHasSlid) {
    const Annotation disc = band(100, "disc", 0, 0.6);
    AnnotationSet set;
    set.annotations = {disc, landmark(1, "left", on_outline(disc, {-0.6, 0, 0.8})),
                       landmark(2, "right", on_outline(disc, {0.6, 0, 0.8}))};
    const Mesh original = slid(20, 0.7);
    const Result with_outlines = fit({original, set}, {}, true), without_outlines = fit({original, set}, {}, false);
    EXPECT_LT(error(with_outlines, original, disc), 0.5 * error(without_outlines, original, disc));
    EXPECT_LT(error(with_outlines, original, disc), 0.02);
}

TEST_F(SlidParts, EachOfSeveralOutlinesCounts) {
    const Annotation ring = band(100, "ring", 0.35, 0.7);
    AnnotationSet set;
    set.annotations = {ring, landmark(1, "inner", on_outline(ring, {0.34, 0, 0.94})),
                       landmark(2, "outer", on_outline(ring, {-0.64, 0, 0.77}))};
    const Mesh original = slid(15, 0.75);
    const Result with_outlines = fit({original, set}, {}, true), without_outlines = fit({original, set}, {}, false);
    EXPECT_LT(error(with_outlines, original, ring), 0.5 * error(without_outlines, original, ring));
}

TEST_F(SlidParts, APartOfAnOutlineWithOneLandmarkHelps) {
    const Annotation disc = band(100, "disc", 0, 0.6);
    AnnotationSet set;
    set.annotations = {disc, landmark(1, "left", on_outline(disc, {-0.6, 0, 0.8})),
                       landmark(2, "right", on_outline(disc, {0.6, 0, 0.8}))};
    const Mesh original = slid(20, 0.7);
    std::vector<bool> half(mesh.number_of_faces());
    for (const Face face : mesh.faces()) half[face] = centroid(mesh, face).x() < 0.1;
    const Result with_outlines = fit({original, set}, half, true), without_outlines = fit({original, set}, half, false);
    EXPECT_LT(error(with_outlines, original, disc), 0.8 * error(without_outlines, original, disc));
}

TEST_F(SlidParts, LinesCorrespondInEitherDirection) {
    // A meridian's part, and its end as a landmark; the fragment's line runs in the opposite direction.
    Annotation line;
    line.id = 100;
    line.tag = "crease";
    line.type = AnnotationType::line;
    std::vector<Index> vertices;
    for (const Vertex v : mesh.vertices())
        if (std::abs(mesh.point(v).y()) < 1e-12 && mesh.point(v).z() > 0.5 && mesh.point(v).x() > -1e-12) vertices.push_back(v);
    std::sort(vertices.begin(), vertices.end(),
              [&](Index a, Index b) { return mesh.point(Vertex(a)).z() > mesh.point(Vertex(b)).z(); });
    for (std::size_t i = 0; i + 1 < vertices.size(); ++i)
        ASSERT_NE(find_halfedge(mesh, Vertex(vertices[i]), Vertex(vertices[i + 1])), Mesh::null_halfedge());
    line.polylines = {vertices};
    AnnotationSet set;
    set.annotations = {line, landmark(1, "top", vertices.front()), landmark(2, "end", vertices.back())};
    const Mesh original = slid(15, 1.1);
    const Result with_outlines = fit({original, set}, {}, true), without_outlines = fit({original, set}, {}, false);
    EXPECT_LT(error(with_outlines, original, line), 0.6 * error(without_outlines, original, line));
}

TEST_F(SlidParts, AnOuterPartDoesNotOverrideAnInnerOne) {
    // The inner part has slid, the outer one's outline has not.
    const Annotation inner = band(100, "inner", 0, 0.35), outer = band(101, "outer", 0, 1.35);
    AnnotationSet set;
    set.annotations = {inner,
                       outer,
                       landmark(1, "a", on_outline(inner, {0.34, 0, 0.94})),
                       landmark(2, "b", on_outline(inner, {-0.34, 0, 0.94})),
                       landmark(3, "c", on_outline(outer, {1, 0, 0.2})),
                       landmark(4, "d", on_outline(outer, {-1, 0, 0.2}))};
    const Mesh original = slid(20, 0.4);
    for (const std::string counterparts : {"surface", "best"}) {
        const double alone = error(fit({original, set}, {}, true, {101, 3, 4}, counterparts), original, inner);
        const double both = error(fit({original, set}, {}, true, {}, counterparts), original, inner);
        const double without = error(fit({original, set}, {}, true, {100, 1, 2}, counterparts), original, inner);
        EXPECT_LT(both, alone + 0.05 * without) << counterparts;
        EXPECT_LT(both, 0.2 * without) << counterparts;
    }
}

}  // namespace
}  // namespace ostraka
