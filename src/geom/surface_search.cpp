#include "ostraka/geom/surface_search.h"

#include "face_tree.h"

#include "ostraka/core/error.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

namespace ostraka {

namespace {
using Primitive = CGAL::AABB_face_graph_triangle_primitive<Mesh>;
using RayTraits = CGAL::AABB_traits<Kernel, Primitive>;
using AabbTree = CGAL::AABB_tree<RayTraits>;

/// Goes down the tree until a face that counts is met.
struct Obstacle {
    const AabbTree& tree;
    const std::function<bool(Index)>& ignored;
    bool met = false;

    [[nodiscard]] bool go_further() const { return !met; }
    void intersection(const Kernel::Segment_3& segment, const Primitive& face) {
        met = !ignored(face.id()) && tree.traits().do_intersect_object()(segment, face);
    }
    [[nodiscard]] bool do_intersect(const Kernel::Segment_3& segment, const CGAL::AABB_node<RayTraits>& node) const {
        return tree.traits().do_intersect_object()(segment, node.bbox());
    }
};

/// Triangles without area meet no line and stop none, and are nearest to nothing that another one is not; the exact predicates
/// would answer for them as for segments.
std::vector<Face> faces_with_area(const Mesh& mesh) {
    std::vector<Face> faces;
    faces.reserve(mesh.number_of_faces());
    for (const Face f : mesh.faces())
        if (area_vector(mesh, f).squared_length() > 0) faces.push_back(f);
    return faces;
}
}  // namespace

struct SurfaceSearch::Tree {
    const Mesh* mesh = nullptr;
    double typical_edge = 0;
    double diagonal = 0;

    const FaceTree& nearest() {
        std::call_once(nearest_once_, [this] { nearest_.emplace(*mesh, faces_with_area(*mesh)); });
        return *nearest_;
    }
    const AabbTree& lines() {
        std::call_once(lines_once_, [this] {
            const std::vector<Face> faces = faces_with_area(*mesh);
            lines_.insert(faces.begin(), faces.end(), *mesh);
            lines_.build();
            lines_.do_not_accelerate_distance_queries();
        });
        return lines_;
    }

private:
    std::once_flag nearest_once_, lines_once_;
    std::optional<FaceTree> nearest_;
    AabbTree lines_;
};

SurfaceSearch::SurfaceSearch(const Mesh& mesh, bool closest) : tree_(std::make_unique<Tree>()) {
    tree_->mesh = &mesh;
    const std::size_t count = faces_with_area(mesh).size();
    if (count == 0) fail_input("mesh", "has no face with an area", "check its scale or repair it");
    const double mean_area = surface_area(mesh) / static_cast<double>(count);
    tree_->typical_edge = std::sqrt(mean_area * 4 / std::sqrt(3.0));
    tree_->diagonal = box_diagonal(mesh);
    if (closest) tree_->nearest();
}

SurfaceSearch::~SurfaceSearch() = default;
SurfaceSearch::SurfaceSearch(SurfaceSearch&&) noexcept = default;

const Mesh& SurfaceSearch::mesh() const { return *tree_->mesh; }
double SurfaceSearch::typical_edge() const { return tree_->typical_edge; }
double SurfaceSearch::diagonal() const { return tree_->diagonal; }

Vector SurfaceSearch::normal(Index face) const {
    const Vector a = area_vector(*tree_->mesh, Face(face));
    const double length = std::sqrt(a.squared_length());
    return length > 0 ? a / length : Vector(0, 0, 0);
}

std::vector<SurfaceHit> SurfaceSearch::line_hits(const Point& origin, const Vector& direction, double max_distance) const {
    const Mesh& mesh = *tree_->mesh;
    std::vector<Face> faces;
    tree_->lines().all_intersected_primitives(
        Kernel::Segment_3(origin - max_distance * direction, origin + max_distance * direction), std::back_inserter(faces));
    std::vector<SurfaceHit> hits;
    hits.reserve(faces.size());
    for (const Face f : faces) {
        const auto [a, b, c] = corners(mesh, f);
        const Point &pa = mesh.point(a), &pb = mesh.point(b), &pc = mesh.point(c);
        const Vector n = CGAL::cross_product(pb - pa, pc - pa);
        const double along = n * direction;
        SurfaceHit hit;
        hit.face = f;
        // A line within the triangle's plane meets it in a segment: its point nearest to the origin stands for it.
        Point p = origin;
        if (along * along > 1e-24 * n.squared_length()) {
            const double t = (n * (pa - origin)) / along;
            p = origin + std::clamp(t, -max_distance, max_distance) * direction;
        }
        hit.barycentric = nearest_barycentric(pa, pb, pc, p);
        hit.point = point_at(mesh, hit.face, hit.barycentric);
        hit.distance = (hit.point - origin) * direction;
        hits.push_back(hit);
    }
    std::sort(hits.begin(), hits.end(), [](const SurfaceHit& x, const SurfaceHit& y) {
        return std::make_pair(std::abs(x.distance), x.face) < std::make_pair(std::abs(y.distance), y.face);
    });
    return hits;
}

bool SurfaceSearch::blocked(const Point& from, const Point& to, const std::function<bool(Index)>& ignored) const {
    Obstacle obstacle{tree_->lines(), ignored};
    tree_->lines().traversal(Kernel::Segment_3(from, to), obstacle);
    return obstacle.met;
}

SurfaceHit SurfaceSearch::closest(const Point& query) const {
    return *tree_->nearest().closest(query, Vector(0, 0, 0), -1, std::numeric_limits<double>::infinity());
}

std::optional<SurfaceHit> SurfaceSearch::closest_compatible(const Point& query, const Vector& normal, double min_cosine,
                                                            double search_radius) const {
    return tree_->nearest().closest(query, normal, min_cosine, search_radius);
}

std::array<double, 3> nearest_barycentric(const Point& a, const Point& b, const Point& c, const Point& p) {
    const Vector ab = b - a, ac = c - a, ap = p - a;
    const double d1 = ab * ap, d2 = ac * ap;
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    const Vector bp = p - b;
    const double d3 = ab * bp, d4 = ac * bp;
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        const double t = d1 / (d1 - d3);
        return {1 - t, t, 0};
    }
    const Vector cp = p - c;
    const double d5 = ab * cp, d6 = ac * cp;
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        const double t = d2 / (d2 - d6);
        return {1 - t, 0, t};
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0, 1 - t, t};
    }
    const double sum = va + vb + vc;
    if (!(sum > 0)) return {1, 0, 0};
    const double v = vb / sum, w = vc / sum;
    return {1 - v - w, v, w};
}

Point point_at(const Mesh& mesh, Index face, const std::array<double, 3>& barycentric) {
    const auto [a, b, c] = corners(mesh, Face(face));
    const Point &pa = mesh.point(a), &pb = mesh.point(b), &pc = mesh.point(c);
    const auto& [u, v, w] = barycentric;
    if (u == 1) return pa;
    if (v == 1) return pb;
    if (w == 1) return pc;
    return {u * pa.x() + v * pb.x() + w * pc.x(), u * pa.y() + v * pb.y() + w * pc.y(), u * pa.z() + v * pb.z() + w * pc.z()};
}

}  // namespace ostraka
