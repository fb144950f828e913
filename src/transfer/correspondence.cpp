#include "ostraka/transfer/correspondence.h"
#include "ostraka/algebra/dense.h"

#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka {

namespace {

Correspondence at(CorrespondenceKind kind, const SurfaceHit& hit, const Point& from, const Mesh& target,
                  const CorrespondenceOptions& options) {
    Correspondence result;
    result.kind = kind;
    result.place = hit;
    result.place.distance = std::sqrt(CGAL::squared_distance(hit.point, from));
    const Point& reference = options.vertex == CorrespondenceOptions::Corner::source ? from : hit.point;
    double best = std::numeric_limits<double>::infinity();
    for (const Vertex v : corners(target, Face(hit.face))) {
        const double distance = CGAL::squared_distance(target.point(v), reference);
        if (distance < best || (distance == best && static_cast<Index>(v) < result.vertex)) {
            best = distance;
            result.vertex = v;
        }
    }
    return result;
}

struct SearchRadii {
    double near, far, min_cosine;
};

SearchRadii radii_of(const SurfaceSearch& target, const CorrespondenceOptions& options) {
    const double far = options.max_distance * target.diagonal();
    return {std::min(far, 2 * target.typical_edge()), far, options.min_cosine()};
}

Correspondence find_one(const Mesh& source, Index vertex, const SurfaceSearch& target, const CorrespondenceOptions& options,
                        const SearchRadii& radii) {
    const Point& p = source.point(Vertex(vertex));
    const Vector normal = vertex_normal(source, Vertex(vertex));
    // A short line first: most correspondences lie within an edge length, and short lines intersect few boxes.
    if (normal.squared_length() > 0) {
        for (const double length : {radii.near, radii.far}) {
            for (const SurfaceHit& hit : target.line_hits(p, normal, length))
                if (target.normal(hit.face) * normal >= radii.min_cosine)
                    return at(CorrespondenceKind::ray, hit, p, target.mesh(), options);
            if (radii.near == radii.far) break;
        }
    }
    if (const auto hit = target.closest_compatible(p, normal, normal.squared_length() > 0 ? radii.min_cosine : -1, radii.far))
        return at(CorrespondenceKind::closest, *hit, p, target.mesh(), options);
    return {};
}

}  // namespace

std::vector<Correspondence> find_correspondences(const Mesh& source, const std::vector<Index>& vertices,
                                                 const SurfaceSearch& target, const CorrespondenceOptions& options) {
    check_options(options, "correspondence");
    const SearchRadii radii = radii_of(target, options);
    std::vector<Correspondence> result(vertices.size());
    parallel_for(vertices.size(), 64, [&](std::size_t i) { result[i] = find_one(source, vertices[i], target, options, radii); });
    return result;
}

std::vector<Correspondence> candidate_correspondences(const Mesh& source, Index vertex, const SurfaceSearch& target,
                                                      const CorrespondenceOptions& options) {
    const SearchRadii radii = radii_of(target, options);
    const Point& p = source.point(Vertex(vertex));
    const Vector normal = vertex_normal(source, Vertex(vertex));
    std::vector<Correspondence> result;
    if (normal.squared_length() > 0)
        for (const SurfaceHit& hit : target.line_hits(p, normal, radii.far))
            if (target.normal(hit.face) * normal >= radii.min_cosine)
                result.push_back(at(CorrespondenceKind::ray, hit, p, target.mesh(), options));
    if (const auto hit = target.closest_compatible(p, normal, normal.squared_length() > 0 ? radii.min_cosine : -1, radii.far))
        result.push_back(at(CorrespondenceKind::closest, *hit, p, target.mesh(), options));
    return result;
}

namespace {

/// Area-weighted moments of a surface about its centroid.
struct Moments {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    Eigen::Vector3d skewness = Eigen::Vector3d::Zero();  ///< third central moment along x, y, z,
                                                         ///< divided by the cubed standard deviation
    double volume = 0;                                   ///< signed, relative to the centroid, as a
                                                         ///< fraction of area times extent
};

/// Sums over faces: first the moments independent of the centroid, then those relative to it.
struct PlaceSums {
    double area = 0;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    Eigen::Array3d squares = Eigen::Array3d::Zero(), products = Eigen::Array3d::Zero();  ///< xx, yy, zz; yz, zx, xy
    void add(const PlaceSums& other) {
        area += other.area;
        centre += other.centre;
        squares += other.squares;
        products += other.products;
    }
};
struct CentralSums {
    Eigen::Vector3d cubes = Eigen::Vector3d::Zero();
    double volume = 0, extent = 0;
    void add(const CentralSums& other) {
        cubes += other.cubes;
        volume += other.volume;
        extent = std::max(extent, other.extent);
    }
};

/// Sums `add_face(sums, face)` over all faces: per block, then over the blocks in order.
template <class Sums, class AddFace>
Sums sums_over_faces(const Mesh& mesh, const AddFace& add_face) {
    constexpr std::size_t block = 16384;
    std::vector<Sums> parts((mesh.number_of_faces() + block - 1) / block);
    parallel_blocks(mesh.number_of_faces(), block, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) add_face(parts[begin / block], Face(static_cast<Index>(f)));
    });
    Sums sums;
    for (const Sums& part : parts) sums.add(part);
    return sums;
}

Moments moments(const Mesh& mesh) {
    Moments m;
    const CGAL::Bbox_3 box = bounding_box(mesh);
    const Eigen::Vector3d origin(box.xmin(), box.ymin(), box.zmin());
    const auto position = [&](Vertex v) -> Eigen::Vector3d {
        return Eigen::Vector3d(mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z()) - origin;
    };
    const auto about_origin = sums_over_faces<PlaceSums>(mesh, [&](PlaceSums& sums, Face f) {
        const auto [a, b, c] = corners(mesh, f);
        const Eigen::Vector3d p = position(a), q = position(b), r = position(c), s = p + q + r;
        const double w = (q - p).cross(r - p).norm() / 2;
        sums.area += w;
        sums.centre += w / 3 * s;
        for (Eigen::Index i = 0; i < 3; ++i) {
            const Eigen::Index j = i == 2 ? 0 : i + 1, k = i == 0 ? 2 : i - 1;
            sums.squares[i] += w / 12 * (p[i] * p[i] + q[i] * q[i] + r[i] * r[i] + s[i] * s[i]);
            sums.products[i] += w / 12 * (p[j] * p[k] + q[j] * q[k] + r[j] * r[k] + s[j] * s[k]);
        }
    });
    const double area = about_origin.area;
    if (area > 0) {
        m.centre = about_origin.centre / area;
        const Eigen::Array3d &square = about_origin.squares, &product = about_origin.products;
        m.covariance << square[0], product[2], product[1], product[2], square[1], product[0], product[1], product[0], square[2];
        m.covariance = (m.covariance / area - m.centre * m.centre.transpose()).eval();
    }
    const auto about_centre = sums_over_faces<CentralSums>(mesh, [&](CentralSums& sums, Face f) {
        const auto [a, b, c] = corners(mesh, f);
        const Eigen::Vector3d p = position(a) - m.centre, q = position(b) - m.centre, r = position(c) - m.centre,
                              g = (p + q + r) / 3;
        sums.cubes += (q - p).cross(r - p).norm() / 2 * Eigen::Vector3d(g.array().cube());
        sums.volume += p.dot(q.cross(r)) / 6;
        sums.extent = std::max(sums.extent, g.squaredNorm());
    });
    const double extent = std::sqrt(about_centre.extent);
    if (area > 0 && extent > 0) {
        m.volume = about_centre.volume / (area * extent);
        for (int i = 0; i < 3; ++i) {
            const double deviation = std::sqrt(std::max(0.0, m.covariance(i, i)));
            if (deviation > 1e-6 * extent) m.skewness[i] = about_centre.cubes[i] / (area * deviation * deviation * deviation);
        }
    }
    m.centre += origin;
    return m;
}

std::string known_ratio(double scale) {
    const struct {
        double ratio;
        const char* units;
    } known[] = {{1000, "metres and millimetres"},   {100, "metres and centimetres"},  {10, "centimetres and millimetres"},
                 {25.4, "inches and millimetres"},   {2.54, "inches and centimetres"}, {1e6, "metres and micrometres"},
                 {39.37007874, "metres and inches"}, {3.280839895, "metres and feet"}, {12, "feet and inches"},
                 {304.8, "feet and millimetres"}};
    const double ratio = scale > 1 ? scale : 1 / scale;
    for (const auto& entry : known)
        if (std::abs(ratio / entry.ratio - 1) < 0.05) return std::string(", as ") + entry.units + " would be";
    return {};
}

}  // namespace

Agreement compare_alignment(const Mesh& source, const Mesh& target) {
    Agreement result;
    const double source_size = box_diagonal(source), target_size = box_diagonal(target);
    const Moments s = moments(source), t = moments(target);
    result.opposite = std::min(std::abs(s.volume), std::abs(t.volume)) > 1e-3 && s.volume * t.volume < 0;
    if (!(source_size > 0) || !(target_size > 0)) {
        result.problem = "one of the meshes has no extent";
        return result;
    }
    result.scale = target_size / source_size;
    if (result.scale < 0.9 || result.scale > 1 / 0.9) {
        result.problem = "the meshes differ in size: the target is " + digits(result.scale, 6) + " times as large as the source" +
                         known_ratio(result.scale) + "; bring them to one unit first";
        return result;
    }
    result.offset = (t.centre - s.centre).norm() / std::max(source_size, target_size);
    const SymmetricEigen3 es(s.covariance), et(t.covariance);
    // An axis is compared if its moment differs clearly from the others on both meshes.
    const auto distinct = [](const Eigen::Vector3d& values, int i) {
        for (int j = 0; j < 3; ++j)
            if (j != i && std::abs(values[i] - values[j]) < 0.1 * values[2]) return false;
        return true;
    };
    for (int i = 0; i < 3; ++i) {
        if (!distinct(es.eigenvalues(), i) || !distinct(et.eigenvalues(), i)) continue;
        const double cosine = std::min(1.0, std::abs(es.eigenvectors().col(i).dot(et.eigenvectors().col(i))));
        result.rotation = std::max(result.rotation, std::acos(cosine) * 180 / pi);
    }
    if (result.rotation > 5) {
        result.problem = "the meshes are not aligned: their principal axes differ by " + digits(result.rotation, 3) +
                         " degrees; register them first";
    } else if (result.offset > 0.02) {
        const Eigen::Vector3d d = t.centre - s.centre;
        result.problem = "the meshes are not aligned: the target's centre lies " + digits(100 * result.offset, 3) +
                         " % of the diagonal away (" + digits(d.x(), 6) + ", " + digits(d.y(), 6) + ", " + digits(d.z(), 6) +
                         "); move it there first";
    } else {
        for (int i = 0; i < 3; ++i) {
            if (std::min(std::abs(s.skewness[i]), std::abs(t.skewness[i])) < 0.15 || s.skewness[i] * t.skewness[i] > 0) continue;
            result.problem = std::string("the meshes are not aligned: along ") + "xyz"[i] +
                             " one is turned round or mirrored; register them first";
            break;
        }
    }
    return result;
}

void CorrespondenceOptions::declare_options(OptionList& list) {
    list("max-distance", max_distance, "maximum distance of a vertex from its counterpart", Range{1e-9, 1},
         "share of the box diagonal");
    list("max-angle", max_angle, "maximum angle between the normal of a vertex and the normal of the target face", Range{0, 180},
         "degrees");
    list(
        "vertex", vertex,
        "corner of the hit face that corresponds to a vertex: the corner nearest to the projected point, or to the source vertex",
        Choices{"projection", "source"});
}

}  // namespace ostraka
