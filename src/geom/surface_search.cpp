#include "ostraka/geom/surface_search.h"

#include "geom/face_tree.h"

#include "ostraka/core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka {

struct SurfaceSearch::Tree {
    FaceTree faces;
    double typical_edge = 0;
};

double typical_edge(double area, std::size_t faces) {
    return std::sqrt(area / static_cast<double>(std::max<std::size_t>(1, faces)) * 4 / std::sqrt(3.0));
}

SurfaceSearch::SurfaceSearch(const Mesh& mesh) : tree_(std::make_unique<Tree>(Tree{FaceTree(mesh)})) {
    const FaceTree& faces = tree_->faces;
    if (faces.size() == 0) fail_input("mesh", "has no face with an area", "check its scale or repair it");
    tree_->typical_edge = ostraka::typical_edge(faces.area(), faces.size());
}

SurfaceSearch::~SurfaceSearch() = default;
SurfaceSearch::SurfaceSearch(SurfaceSearch&&) noexcept = default;

const Mesh& SurfaceSearch::mesh() const { return tree_->faces.mesh(); }
double SurfaceSearch::typical_edge() const { return tree_->typical_edge; }
double SurfaceSearch::diagonal() const { return tree_->faces.diagonal(); }

Vector SurfaceSearch::normal(Index face) const {
    const Vector a = area_vector(mesh(), Face(face));
    const double length = std::sqrt(a.squared_length());
    return length > 0 ? a / length : Vector(0, 0, 0);
}

std::vector<SurfaceHit> SurfaceSearch::line_hits(const Point& origin, const Vector& direction, double max_distance) const {
    const Mesh& mesh = tree_->faces.mesh();
    const std::vector<Index> faces = tree_->faces.met(origin - max_distance * direction, origin + max_distance * direction);
    std::vector<SurfaceHit> hits;
    hits.reserve(faces.size());
    for (const Index f : faces) {
        const auto [a, b, c] = corners(mesh, Face(f));
        const Point &pa = mesh.point(a), &pb = mesh.point(b), &pc = mesh.point(c);
        const Vector n = CGAL::cross_product(pb - pa, pc - pa);
        const double along = n * direction;
        SurfaceHit hit;
        hit.face = f;
        // A line in the plane of the triangle intersects it in a segment, represented by its point nearest to the origin.
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

std::optional<SurfaceHit> SurfaceSearch::first_exit(const Point& origin, const Vector& direction, Index ignored,
                                                    double min_distance) const {
    return tree_->faces.first_exit(origin, direction, ignored, min_distance);
}

bool SurfaceSearch::blocked(const Point& from, const Point& to, const std::function<bool(Index)>& ignored) const {
    return tree_->faces.meets(from, to, ignored);
}

SurfaceHit SurfaceSearch::closest(const Point& query) const {
    return *tree_->faces.closest(query, Vector(0, 0, 0), -1, std::numeric_limits<double>::infinity());
}

std::optional<SurfaceHit> SurfaceSearch::closest_compatible(const Point& query, const Vector& normal, double min_cosine,
                                                            double search_radius) const {
    return tree_->faces.closest(query, normal, min_cosine, search_radius);
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

bool SurfaceSearch::inside(const Point& query) const {
    // Two lines, both followed in both directions from the query, in directions with which a mesh is unlikely to be aligned.
    const Vector lines[] = {Vector(0.36, 0.48, 0.8), Vector(-0.48, 0.64, 0.6)};
    const double far = 2 * diagonal() + std::sqrt(CGAL::squared_distance(query, mesh().point(Vertex(0))));
    int odd = 0;
    for (const Vector& direction : lines) {
        int ahead = 0, behind = 0;
        for (const SurfaceHit& hit : line_hits(query, direction, far)) ++(hit.distance > 0 ? ahead : behind);
        odd += ahead % 2 + behind % 2;
    }
    return odd >= 3;
}

Point point_at(const Point& a, const Point& b, const Point& c, const std::array<double, 3>& barycentric) {
    const auto& [u, v, w] = barycentric;
    if (u == 1) return a;
    if (v == 1) return b;
    if (w == 1) return c;
    return {u * a.x() + v * b.x() + w * c.x(), u * a.y() + v * b.y() + w * c.y(), u * a.z() + v * b.z() + w * c.z()};
}

Point point_at(const Mesh& mesh, Index face, const std::array<double, 3>& barycentric) {
    const auto [a, b, c] = corners(mesh, Face(face));
    return point_at(mesh.point(a), mesh.point(b), mesh.point(c), barycentric);
}

}  // namespace ostraka
