// Cylinders and a sheet, annotated, with shapes that satisfy or violate each type of constraint.
#pragma once

#include "caged.h"
#include "meshes.h"
#include "ostraka/geom/eigen.h"

#include <cmath>
#include <numbers>

namespace ostraka::test {

using Eigen::Vector3d;

using Places = std::vector<Vector3d>;
using Shape = std::function<void(Places&, double wrong)>;

inline constexpr int a = 1, b = 2, a_lower = 3, a_upper = 4, a_line = 5, b_line = 6, ring = 7, cross = 8, corner = 9, solid = 10,
                     two_rings = 11, a_sides = 12, sheet = 13, neighbour = 14, above = 15, lying = 16;

/// Closed cylinders about z and a flat sheet, each a separate component: 13 rings of 24 vertices from below, then the centres of
/// the ends.
struct Bench : AnnotatedMesh {
    static constexpr Index around = 24, levels = 13;
    std::map<int, Index> first;  ///< vertex of a cylinder

    Bench() {
        TriangleSoup soup;
        std::map<int, std::pair<std::size_t, std::size_t>> faces;
        const auto cylinder = [&](int id, double x, double y, double z, double radius, double height) {
            const auto start = static_cast<Index>(soup.points.size());
            first[id] = start;
            faces[id].first = soup.triangles.size();
            for (Index j = 0; j < levels; ++j)
                for (Index i = 0; i < around; ++i) {
                    const double angle = 2 * std::numbers::pi * i / around;
                    soup.points.push_back(
                        {x + radius * std::cos(angle), y + radius * std::sin(angle), z + height * j / (levels - 1)});
                }
            for (Index j = 0; j + 1 < levels; ++j)
                for (Index i = 0; i < around; ++i) {
                    const Index p = start + j * around + i, q = start + j * around + (i + 1) % around;
                    soup.triangles.push_back({p, q, q + around});
                    soup.triangles.push_back({p, q + around, p + around});
                }
            const auto below = static_cast<Index>(soup.points.size()), top = start + around * (levels - 1);
            soup.points.push_back({x, y, z});
            soup.points.push_back({x, y, z + height});
            for (Index i = 0; i < around; ++i) {
                soup.triangles.push_back({below, start + (i + 1) % around, start + i});
                soup.triangles.push_back({below + 1, top + i, top + (i + 1) % around});
            }
            faces[id].second = soup.triangles.size();
        };
        cylinder(a, 0, 0, 0, 1, 6);
        cylinder(b, 10, 0, 0, 1, 6);
        cylinder(neighbour, 0, 2.05, 0, 1, 6);
        cylinder(above, 0, 0, 7, 1, 6);
        cylinder(lying, 20, 0, 0, 1, 6);
        for (Index v = first[lying]; v < soup.points.size(); ++v) {  // along x
            auto& p = soup.points[v];
            p = {20 + p[2], p[1], 20 - p[0]};
        }
        const auto start = static_cast<Index>(soup.points.size());
        first[sheet] = start;
        constexpr Index side = 9;
        for (Index j = 0; j < side; ++j)
            for (Index i = 0; i < side; ++i) soup.points.push_back({0.5 * i, 15 + 0.5 * j, 0});
        std::vector<Index> inside;
        for (Index j = 0; j + 1 < side; ++j)
            for (Index i = 0; i + 1 < side; ++i) {
                const Index p = start + j * side + i;
                if (std::min(i, j) >= 2 && std::max(i, j) <= 5)
                    for (Index k = 0; k < 2; ++k) inside.push_back(static_cast<Index>(soup.triangles.size()) + k);
                soup.triangles.push_back({p, p + 1, p + 1 + side});
                soup.triangles.push_back({p, p + 1 + side, p + side});
            }
        mesh = build_mesh(soup);
        annotations.up = {0, 0, 1};
        annotations.unit = "mm";
        for (const auto& [id, range] : faces) region(id, {range.first, range.second}, [](double) { return true; });
        region(a_lower, faces[a], [](double z) { return z < 3; });
        region(a_upper, faces[a], [](double z) { return z > 3; });
        region(a_sides, faces[a], [](double z) { return z > 1 && z < 5; });
        add(sheet, AnnotationType::region).faces = inside;
        for (const auto& [id, tube] : {std::pair{a_line, a}, {b_line, b}}) {
            std::vector<Index> way;
            for (Index j = 0; j < levels; ++j) way.push_back(first[tube] + j * around);
            add(id, AnnotationType::line).polylines.push_back(way);
        }
        const auto at = [&](Index i, Index j) { return first[a] + j * around + i; };
        add(ring, AnnotationType::point).points = {at(0, 6), at(6, 6), at(12, 6), at(18, 6)};
        add(cross, AnnotationType::point).points = {at(0, 6), at(12, 6), at(6, 6), at(18, 6)};
        add(corner, AnnotationType::point).points = {at(0, 6), at(6, 6), at(18, 6)};
        add(solid, AnnotationType::point).points = {at(0, 6), at(6, 6), at(12, 6), at(0, 12)};
        add(two_rings, AnnotationType::point).points = {at(0, 0),  at(6, 0),  at(12, 0), at(18, 0),
                                                        at(3, 12), at(9, 12), at(15, 12)};
        for (const int id : {a, b}) add_height(id);
    }

    Annotation& add(int id, AnnotationType type) {
        Annotation annotation;
        annotation.id = id;
        annotation.tag = "part " + std::to_string(id);
        annotation.type = type;
        annotations.annotations.push_back(annotation);
        return annotations.annotations.back();
    }
    void region(int id, std::pair<std::size_t, std::size_t> range, const std::function<bool(double)>& has) {
        Annotation& annotation = add(id, AnnotationType::region);
        for (std::size_t f = range.first; f < range.second; ++f)
            if (has(centroid(mesh, Face(static_cast<Index>(f))).z())) annotation.faces.push_back(static_cast<Index>(f));
    }
    void add_height(int id) {
        Attribute height;
        height.name = "height";
        height.value = Measure();
        height.measure()->tool = "bounding";
        height.measure()->points = {first[id], first[id] + (levels - 1) * around};
        height.measure()->direction = {0, 0, 1};
        for (Annotation& annotation : annotations.annotations)
            if (annotation.id == id) annotation.attributes.push_back(height);
    }
    [[nodiscard]] std::vector<Index> vertices(int id) const { return vertices_of(mesh, *annotations.find(id)); }
    [[nodiscard]] Places at_rest() const {
        Places places;
        for (const Vertex v : mesh.vertices()) places.push_back(eigen(mesh.point(v)));
        return places;
    }
    [[nodiscard]] double diagonal() const {
        Eigen::AlignedBox3d box;
        for (const Vector3d& p : at_rest()) box.extend(p);
        return box.diagonal().norm();
    }

    // Quantities computed from positions, independently of the library.
    [[nodiscard]] Vector3d end(const Places& p, int id, bool upper) const {
        Vector3d sum(0, 0, 0);
        for (Index i = 0; i < around; ++i) sum += p[first.at(id) + (upper ? (levels - 1) * around : 0) + i] / around;
        return sum;
    }
    [[nodiscard]] Vector3d axis(const Places& p, int id) const { return (end(p, id, true) - end(p, id, false)).normalized(); }
    [[nodiscard]] double length(const Places& p, int id) const { return (end(p, id, true) - end(p, id, false)).norm(); }
    [[nodiscard]] Vector3d middle(const Places& p, int id) const {
        Vector3d sum(0, 0, 0);
        const auto list = vertices(id);
        for (const Index v : list) sum += p[v] / static_cast<double>(list.size());
        return sum;
    }
    [[nodiscard]] double height(const Places& p, int id) const {
        double low = 1e300, high = -1e300;
        for (const Index v : vertices(id)) low = std::min(low, p[v].z()), high = std::max(high, p[v].z());
        return high - low;
    }
    [[nodiscard]] const Vector3d& point(const Places& p, int id, std::size_t i) const {
        return p[annotations.find(id)->points[i]];
    }
};

inline const Bench& bench() {
    static const Bench instance;
    return instance;
}

inline double degrees(const Vector3d& p, const Vector3d& q) {
    return std::atan2(p.cross(q).norm(), std::abs(p.dot(q))) * 180 / std::numbers::pi;
}

/// All points of a part relative to its mean.
inline Shape each(int id, const std::function<Vector3d(const Vector3d& from_middle, double wrong)>& to) {
    return [=](Places& p, double wrong) {
        const Vector3d middle = bench().middle(p, id);
        for (const Index v : bench().vertices(id)) p[v] = middle + to(p[v] - middle, wrong);
    };
}
inline Shape rotated(int id, const Vector3d& about, double first = 0) {
    return each(id, [=](const Vector3d& d, double wrong) -> Vector3d {
        return Eigen::AngleAxisd((first + wrong) * std::numbers::pi / 180, about) * d;
    });
}
inline Shape moved(int id, const Vector3d& way) {
    return each(id, [=](const Vector3d& d, double wrong) -> Vector3d { return d + wrong * way; });
}
/// Scaled by 1 + wrong along the coordinates in `along`.
inline Shape stretched(int id, const Vector3d& along) {
    return each(id, [=](const Vector3d& d, double wrong) -> Vector3d { return d + wrong * along.cwiseProduct(d); });
}
/// One point of a point annotation.
inline Shape pulled(int id, std::size_t i, const Vector3d& way) {
    return [=](Places& p, double wrong) { p[bench().annotations.find(id)->points[i]] += wrong * way; };
}

struct Case {
    const char* type;
    std::vector<int> members;
    const char* parameters;
    Shape shape;
    std::array<double, 3> wrong;  ///< right, slightly wrong, very wrong
    std::function<double(const Places&)> value;
    double tolerance;   ///< of `value`, by which it holds
    bool rest = false;  ///< it can be judged only against the shape at rest
    bool exact = true;  ///< the verdict's first deviation is `value` itself
};

inline double sides_differ(const Places& p, int id) {
    std::vector<double> sides;
    for (std::size_t i = 0; i < 4; ++i) sides.push_back((bench().point(p, id, (i + 1) % 4) - bench().point(p, id, i)).norm());
    const auto [low, high] = std::minmax_element(sides.begin(), sides.end());
    return 100 * (*high / *low - 1);
}
/// Maximum distance between the points of two centred shapes, relative to the part's size.
inline double changed(const Places& p, int id) {
    const Places rest = bench().at_rest();
    const Vector3d now = bench().middle(p, id), then = bench().middle(rest, id);
    double size = 0, off = 0;
    for (const Index v : bench().vertices(id)) {
        size = std::max(size, (rest[v] - then).norm());
        off = std::max(off, (p[v] - now - rest[v] + then).norm());
    }
    return 100 * off / size;
}

const Vector3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), all(1, 1, 1);

}  // namespace ostraka::test
