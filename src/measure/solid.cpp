#include "ostraka/measure/solid.h"

#include "ostraka/annotation/outline.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/fields/statistics.h"
#include "ostraka/mesh/disjoint_sets.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace ostraka {

namespace {

/// The centre of the region's box: sums relative to it keep their precision far from the origin.
Point middle_of(const Mesh& mesh, const std::vector<Index>& faces) {
    CGAL::Bbox_3 box;
    for (const Index face : faces)
        for (const Vertex v : corners(mesh, Face(face))) box += mesh.point(v).bbox();
    return faces.empty() ? Point(0, 0, 0)
                         : Point(box.xmin() + (box.xmax() - box.xmin()) / 2, box.ymin() + (box.ymax() - box.ymin()) / 2,
                                 box.zmin() + (box.zmax() - box.zmin()) / 2);
}

/// Compensated summation (Neumaier 1974).
class CompensatedSum {
public:
    CompensatedSum& operator+=(double x) {
        const double next = sum_ + x;
        compensation_ += std::abs(sum_) >= std::abs(x) ? (sum_ - next) + x : (x - next) + sum_;
        sum_ = next;
        return *this;
    }
    [[nodiscard]] double value() const { return sum_ + compensation_; }

private:
    double sum_ = 0, compensation_ = 0;
};

/// Sums of signed tetrahedra from an origin to oriented triangles.
class Tetrahedra {
public:
    explicit Tetrahedra(const Point& origin) : origin_(origin) {}
    void add(const Point& a, const Point& b, const Point& c) {
        const Vector u = a - origin_, v = b - origin_, w = c - origin_;
        // c . n A / 3 with the centroid c and the area vector n A of the triangle, relative to one corner for the precision of
        // the area.
        const Vector centre = (u + v + w) / 3, area = CGAL::cross_product(v - u, w - u) / 2;
        const double volume = centre * area / 3;
        volume_ += volume;
        x_ += volume * centre.x() * 0.75;
        y_ += volume * centre.y() * 0.75;
        z_ += volume * centre.z() * 0.75;
    }
    [[nodiscard]] double volume() const { return volume_.value(); }
    [[nodiscard]] Point centroid() const { return origin_ + Vector(x_.value(), y_.value(), z_.value()) / volume_.value(); }

private:
    Point origin_;
    CompensatedSum volume_, x_, y_, z_;
};

}  // namespace

double closed_volume(const Mesh& mesh) {
    for (const Halfedge h : mesh.halfedges())
        if (mesh.is_border(h)) return std::numeric_limits<double>::quiet_NaN();
    std::vector<Index> faces(mesh.number_of_faces());
    std::iota(faces.begin(), faces.end(), Index{0});
    return body_volume(mesh, faces).volume;
}

Point surface_centroid(const Mesh& mesh, const std::vector<Index>& faces) {
    check_region(mesh, faces);
    if (faces.empty()) fail_usage("the region has no faces", "select faces");
    const Point origin = middle_of(mesh, faces);
    CompensatedSum area, x, y, z, mean_x, mean_y, mean_z;
    for (const Index face : faces) {
        const double weight = face_area(mesh, Face(face));
        const auto [a, b, c] = corners(mesh, Face(face));
        const Vector centre = ((mesh.point(a) - origin) + (mesh.point(b) - origin) + (mesh.point(c) - origin)) / 3;
        area += weight;
        x += weight * centre.x(), y += weight * centre.y(), z += weight * centre.z();
        mean_x += centre.x(), mean_y += centre.y(), mean_z += centre.z();
    }
    if (area.value() > 0) return origin + Vector(x.value(), y.value(), z.value()) / area.value();
    return origin + Vector(mean_x.value(), mean_y.value(), mean_z.value()) / static_cast<double>(faces.size());
}

RegionSolid region_solid(const Mesh& mesh, const std::vector<Index>& faces) {
    check_cancelled();
    check_region(mesh, faces);
    RegionSolid result;
    if (faces.empty()) return result;
    Tetrahedra sum(middle_of(mesh, faces));
    for (const Index face : faces) {
        const auto [a, b, c] = corners(mesh, Face(face));
        sum.add(mesh.point(a), mesh.point(b), mesh.point(c));
    }
    for (const Outline& outline : extract_outlines(mesh, faces)) {
        std::vector<Point> points;
        for (const Index v : outline) points.push_back(mesh.point(Vertex(v)));
        Vector mean(0, 0, 0);
        for (const Point& p : points) mean += (p - points.front()) / static_cast<double>(points.size());
        const Point apex = points.front() + mean;
        for (std::size_t i = 0; i < points.size(); ++i) sum.add(points[(i + 1) % points.size()], points[i], apex);
        result.volume_bound += convex_hull_size(points).volume;
        ++result.outlines;
    }
    result.volume = sum.volume();
    const CGAL::Bbox_3 box = bounding_box(mesh);
    const double size = std::hypot(box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin());
    // A solid so thin that its volume is rounding error has no reliable centroid.
    result.centroid = std::abs(result.volume) > 1e-13 * size * size * size ? sum.centroid() : surface_centroid(mesh, faces);
    return result;
}

BodyVolume body_volume(const Mesh& mesh, const std::vector<Index>& faces) {
    check_region(mesh, faces);
    // Components of the region, connected over edges; closed if no edge leads out of the region.
    std::vector<bool> selected(mesh.number_of_faces(), false);
    for (const Index face : faces) selected[face] = true;
    DisjointSets sets(mesh.number_of_faces());
    std::vector<std::uint8_t> open(mesh.number_of_faces(), 0);
    const auto outside = [&](Halfedge h) { return mesh.is_border(h) || !selected[mesh.face(h)]; };
    for (const Index face : faces)
        for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(Face(face))))
            if (!outside(mesh.opposite(h))) sets.unite(face, mesh.face(mesh.opposite(h)));
    for (const Index face : faces)
        for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(Face(face))))
            if (outside(mesh.opposite(h))) open[sets.find(face)] = 1;
    std::vector<Index> open_faces;
    TriangleSoup closed;
    std::vector<Index> number(mesh.num_vertices(), no_index);
    for (const Index face : faces) {
        if (open[sets.find(face)] != 0) {
            open_faces.push_back(face);
            continue;
        }
        auto& triangle = closed.triangles.emplace_back();
        std::size_t k = 0;
        for (const Vertex v : corners(mesh, Face(face))) {
            if (number[v] == no_index) {
                number[v] = static_cast<Index>(closed.points.size());
                const Point& p = mesh.point(v);
                closed.points.push_back({p.x(), p.y(), p.z()});
            }
            triangle.at(k++) = number[v];
        }
    }
    if (closed.triangles.empty()) return {region_solid(mesh, faces), {}};
    const SolidBodies bodies = solid_bodies(closed);
    BodyVolume result{open_faces.empty() ? RegionSolid() : region_solid(mesh, open_faces), bodies.remarks()};
    if (open_faces.empty() && bodies.signed_volume == bodies.volume && bodies.closed == 1)
        return {region_solid(mesh, faces), {}};  // one body: the sum with the smallest rounding error
    const double volume = result.volume + bodies.volume;
    const Point own(bodies.centroid[0], bodies.centroid[1], bodies.centroid[2]);
    const double share = volume != 0 ? result.volume / volume : 0;
    result.centroid = open_faces.empty() ? own : own + share * (result.centroid - own);
    result.volume = volume, result.volume_bound += bodies.bound;
    return result;
}

}  // namespace ostraka
