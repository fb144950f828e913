#include "shatter.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/remesh/remesh.h"
#include "ostraka/remesh/simplify.h"
#include "ostraka/stats/random.h"

#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/boost/graph/helpers.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <numeric>

namespace ostraka {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// A surface of revolution: rings with equal numbers of vertices; radius 0 gives a pole.
Mesh turned(const std::vector<Vector2d>& profile, int around) {
    TriangleSoup soup;
    std::vector<std::vector<Index>> rings;
    for (const Vector2d& p : profile) {
        auto& ring = rings.emplace_back();
        for (int k = 0; k < (p.x() > 0 ? around : 1); ++k) {
            const double angle = 2 * pi * k / around;
            ring.push_back(static_cast<Index>(soup.points.size()));
            soup.points.push_back({p.x() * std::cos(angle), p.x() * std::sin(angle), p.y()});
        }
    }
    for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
        const auto &p = rings[i], &q = rings[i + 1];
        for (std::size_t k = 0; k < static_cast<std::size_t>(around); ++k) {
            const std::size_t next = (k + 1) % static_cast<std::size_t>(around);
            if (p.size() > 1) soup.triangles.push_back({p[k], p[next], q[q.size() > 1 ? next : 0]});
            if (q.size() > 1) soup.triangles.push_back({p[p.size() > 1 ? k : 0], q[next], q[k]});
        }
    }
    return build_mesh(soup);
}

/// A sum of waves over the plane or in space.
template <class V>
struct Waves {
    struct Wave {
        V number;
        double phase, height;
    };
    std::vector<Wave> waves;
    [[nodiscard]] double add_at(const V& p, double sum) const {
        for (const Wave& wave : waves) sum += wave.height * std::sin(wave.number.dot(p) + wave.phase);
        return sum;
    }
};

/// The half-space on one side of a rough sheet, as a closed mesh.
struct Sheet : Waves<Vector2d> {
    Vector3d middle, normal, u, v;
    double extent = 1;
    Vector2d arch = Vector2d::Zero();  ///< heights at the extent, along u and v

    Sheet(const Vector3d& place, const Vector3d& across, double size, const ShatterOptions& options, Random& random)
        : middle(place), normal(across), extent(size) {
        u = normal.cross(std::abs(normal.x()) < 0.6 ? Vector3d::UnitX() : Vector3d::UnitY()).normalized();
        v = normal.cross(u);
        const int count = std::max(2, static_cast<int>(std::lround(14 * std::log(options.finest) / std::log(0.06))));
        for (int k = 0; k < count; ++k) {
            const double share = std::pow(options.finest, k / (count - 1.0)),
                         angle = random.uniform(0, 2 * pi) * (1 - options.streak);
            waves.push_back({2 * pi / (share * extent) * Vector2d(std::cos(angle), std::sin(angle)), random.uniform(0, 2 * pi),
                             options.roughness * extent * std::pow(share, options.hurst) * std::sqrt(2.0 / count)});
        }
        if (options.bow > 0) arch = options.bow * extent * Vector2d(random.uniform(-1, 1), random.uniform(-1, 1));
    }
    [[nodiscard]] double height(const Vector2d& p) const { return add_at(p, arch.dot((p / extent).cwiseAbs2())); }
    /// `side`: 1 for above, -1 for below. `uneven`: triangles of varying shapes.
    [[nodiscard]] Mesh half(double side, double edge, bool uneven) const {
        const int n = std::clamp(static_cast<int>(std::lround(2.2 * extent / edge)), 8, 300);
        TriangleSoup soup;
        const auto corner = [&](int i, int j) { return static_cast<Index>(i * (n + 1) + j); };
        const double far = 1.1 * extent;
        for (int i = 0; i <= n; ++i)
            for (int j = 0; j <= n; ++j) {
                Vector2d p(far * (2.0 * i / n - 1), far * (2.0 * j / n - 1));
                if (uneven && i > 0 && j > 0 && i < n && j < n)
                    p += 0.6 * far / n * Vector2d(std::cos(7.0 * corner(i, j)), std::sin(11.0 * corner(i, j)));
                const Vector3d at = middle + p.x() * u + p.y() * v + height(p) * normal;
                soup.points.push_back({at.x(), at.y(), at.z()});
            }
        const auto count = static_cast<Index>(soup.points.size());
        const Vector3d top = middle + side * 2 * far * normal;
        soup.points.push_back({top.x(), top.y(), top.z()});
        const auto add = [&](Index a, Index b, Index c) {
            if (side > 0) std::swap(b, c);
            soup.triangles.push_back({a, b, c});
        };
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                add(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1));
                add(corner(i, j), corner(i + 1, j + 1), corner(i, j + 1));
            }
        // A pyramid that contains the piece, with a distant tip.
        for (int i = 0; i < n; ++i) {
            add(corner(i + 1, 0), corner(i, 0), count);
            add(corner(i, n), corner(i + 1, n), count);
            add(corner(0, i), corner(0, i + 1), count);
            add(corner(n, i + 1), corner(n, i), count);
        }
        return build_mesh(soup);
    }
};

/// The same mesh with vertices and faces ordered by position only, since the order after cuts is not deterministic.
Mesh in_order(const Mesh& mesh) {
    const TriangleSoup soup = to_soup(mesh);
    std::vector<Index> order(soup.points.size()), place(order.size());
    std::iota(order.begin(), order.end(), Index(0));
    std::sort(order.begin(), order.end(), [&](Index a, Index b) { return soup.points[a] < soup.points[b]; });
    TriangleSoup sorted;
    for (const Index i : order) place[i] = static_cast<Index>(sorted.points.size()), sorted.points.push_back(soup.points[i]);
    for (const auto& t : soup.triangles) {
        std::array<Index, 3> corners{place[t[0]], place[t[1]], place[t[2]]};
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        sorted.triangles.push_back(corners);
    }
    std::sort(sorted.triangles.begin(), sorted.triangles.end());
    return build_mesh(sorted);
}

/// Intersection of two bodies; false if it cannot be computed: a rough sheet, or the result of earlier cuts, may
/// self-intersect.
bool intersected(Mesh body, Mesh half, Mesh& result) {
    namespace PMP = CGAL::Polygon_mesh_processing;
    try {
        return PMP::corefine_and_compute_intersection(body, half, result) && !result.is_empty();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception&) {  // of several types, all for self-intersecting bodies
        return false;
    }
}

/// Wears the sherd: moves fracture faces inwards, and smooths vertices near their edges. `share`: fraction of the wear at each
/// point.
template <class Share>
void wear(Sherd& sherd, double depth, const Share& share) {
    Mesh& mesh = sherd.mesh;
    const std::size_t n = mesh.number_of_vertices();
    std::vector<double> shares;
    for (const Vertex v : mesh.vertices()) shares.push_back(share(mesh.point(v)));
    std::vector<Vector3d> in(n, Vector3d::Zero());
    std::vector<double> distance(n, 1e300);
    std::vector<Vertex> rim;
    for (const Vertex v : mesh.vertices()) {
        bool some = false, all = true;
        for (const Face f : mesh.faces_around_target(mesh.halfedge(v))) {
            if (sherd.broken[f]) in[v] += eigen(area_vector(mesh, f));
            (sherd.broken[f] ? some : all) = sherd.broken[f];
        }
        if (some && in[v].norm() > 0) in[v] = shares[v] * depth * in[v].normalized();
        if (some && !all) distance[v] = 0, rim.push_back(v);
    }
    for (const Vertex v : mesh.vertices()) mesh.point(v) = point_of(eigen(mesh.point(v)) - in[v]);
    // Distances from the rim along edges, up to the relevant distance.
    std::vector<Vertex> front = rim;
    const double reach = 2 * depth;
    // Each round of smoothing extends one edge farther.
    const double edges = depth / mean_edge_length(mesh);
    const int rounds = std::clamp(static_cast<int>(std::ceil(edges * edges)), 3, 100);
    while (!front.empty()) {
        std::vector<Vertex> next;
        for (const Vertex v : front)
            for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(v))) {
                const Vertex w = mesh.source(h);
                const double d = distance[v] + (eigen(mesh.point(v)) - eigen(mesh.point(w))).norm();
                if (d < distance[w] && d < reach) distance[w] = d, next.push_back(w);
            }
        front = std::move(next);
    }
    for (int round = 0; round < rounds; ++round) {
        std::vector<Point> moved(n);
        for (const Vertex v : mesh.vertices()) {
            Vector3d mean = Vector3d::Zero();
            double count = 0;
            for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(v)))
                mean += eigen(mesh.point(mesh.source(h))), ++count;
            const double weight = distance[v] < reach ? 0.6 * std::min(1.0, shares[v]) * (1 - distance[v] / reach) : 0;
            moved[v] = point_of((1 - weight) * eigen(mesh.point(v)) + weight * mean / count);
        }
        for (const Vertex v : mesh.vertices()) mesh.point(v) = moved[v];
    }
}

/// The sherd remeshed with independent vertices and edges.
Sherd meshed_anew(const Sherd& sherd, double edge, Random& random) {
    // Random sizes and order: identical triangles would give identical meshes.
    const TriangleSoup soup = to_soup(sherd.mesh);
    TriangleSoup shuffled;
    const std::vector<std::size_t> points = random.permutation(soup.points.size()),
                                   triangles = random.permutation(soup.triangles.size());
    std::vector<Index> place(points.size());
    for (const std::size_t i : points)
        place[i] = static_cast<Index>(shuffled.points.size()), shuffled.points.push_back(soup.points[i]);
    for (const std::size_t t : triangles) {
        const auto& corner = soup.triangles[t];
        shuffled.triangles.push_back({place[corner[0]], place[corner[1]], place[corner[2]]});
    }
    const double length = edge * random.uniform(0.85, 1.15);
    RemeshOptions how;
    // Equilateral triangles, two per vertex.
    how.vertices = std::max<std::uint64_t>(
        60, static_cast<std::uint64_t>(std::lround(surface_area(sherd.mesh) / (std::sqrt(3.0) / 2 * length * length))));
    Sherd result{remesh(build_mesh(shuffled), how).mesh, {}};
    result.broken = broken_of_nearest(result.mesh, sherd);
    return result;
}

}  // namespace

Vector3d surface_centre(const Mesh& mesh) {
    Vector3d sum = Vector3d::Zero();
    double area = 0;
    for (const Face f : mesh.faces()) {
        const double a = face_area(mesh, f);
        sum += a * eigen(centroid(mesh, f));
        area += a;
    }
    return sum / area;
}

Mesh make_pot(const PotOptions& options) {
    check_options(options, "pot");
    if (options.wall > 0.5 * options.radius) fail_usage("the wall is thicker than half of the radius", "make it thinner");
    Random random(options.shape, 3);
    const double a = random.uniform(0.15, 0.4), b = random.uniform(0.05, 0.2), c = random.uniform(0, 2 * pi),
                 foot = random.uniform(0.4, 0.6);
    const auto radius = [&](double t) {
        return options.radius * (foot + (1 - foot) * std::sin(0.5 * pi * std::min(1.0, 1.8 * t)) - a * std::pow(t, 3) +
                                 b * std::sin(5 * t + c) * t);
    };
    const int rows = std::max(8, static_cast<int>(std::lround(1.15 * options.height / options.edge))),
              steps = std::max(2, static_cast<int>(std::lround(radius(0) / options.edge)));
    std::vector<Vector2d> line{{0, 0}};
    for (int k = 1; k < steps; ++k) line.push_back({radius(0) * k / steps, 0});
    for (int k = 0; k <= rows; ++k) line.push_back({radius(double(k) / rows), options.height * k / rows});
    // Inside: the same curve, offset inwards, down to the floor.
    std::vector<Vector2d> inner;
    for (int k = rows; k >= 0; --k) {
        const double t = double(k) / rows, step = 1e-4;
        Vector2d along(radius(t + step) - radius(t - step), 2 * step * options.height);
        along.normalize();
        const Vector2d p = Vector2d(radius(t), options.height * t) + options.wall * Vector2d(-along.y(), along.x());
        if (p.y() > options.wall * 1.3 && p.x() > 0) inner.push_back(p);
    }
    line.insert(line.end(), inner.begin(), inner.end());
    const double floor = inner.back().x();
    const int floors = std::max(2, static_cast<int>(std::lround(floor / options.edge)));
    for (int k = floors; k > 0; --k) line.push_back({floor * (k - 0.5) / floors, options.wall});
    line.push_back({0, options.wall});
    return turned(line, std::max(12, static_cast<int>(std::lround(2 * pi * 0.8 * options.radius / options.edge))));
}

Mesh with_relief(const Mesh& mesh, double height, double longest, std::uint64_t seed) {
    Random random(seed, 5);
    const double diagonal = box_diagonal(mesh);
    Waves<Vector3d> relief;
    constexpr int count = 16;
    double power = 0;
    for (int k = 0; k < count; ++k) {
        const double share = std::pow(0.1, k / (count - 1.0));
        const Vector3d direction = Vector3d(random.normal(), random.normal(), random.normal()).normalized();
        relief.waves.push_back({2 * pi / (share * longest * diagonal) * direction, random.uniform(0, 2 * pi), std::sqrt(share)});
        power += share / 2;
    }
    Mesh result = mesh;
    for (const Vertex v : mesh.vertices()) {
        const Vector3d p = eigen(mesh.point(v));
        result.point(v) =
            point_of(p + height * diagonal / std::sqrt(power) * relief.add_at(p, 0) * eigen(vertex_normal(mesh, v)));
    }
    return result;
}

std::vector<Sherd> shatter(const Mesh& whole, const ShatterOptions& options) {
    check_options(options, "shatter");
    namespace PMP = CGAL::Polygon_mesh_processing;
    if (whole.number_of_faces() == 0 || !CGAL::is_closed(whole)) fail_input("mesh", "is not closed, so that it has no inside");
    Random random(options.seed, 4);
    const SurfaceSearch skin(whole);
    const double diagonal = skin.diagonal(), edge = skin.typical_edge();
    std::vector<Mesh> pieces{whole};
    for (int attempt = 0; static_cast<int>(pieces.size()) < options.pieces; ++attempt) {
        if (attempt > 20 * options.pieces)
            throw Error(ErrorKind::failure, "mesh", "cannot be cut into so many pieces", "ask for fewer, or another seed");
        const auto largest = static_cast<std::size_t>(
            std::max_element(pieces.begin(), pieces.end(),
                             [](const Mesh& x, const Mesh& y) { return surface_area(x) < surface_area(y); }) -
            pieces.begin());
        const Mesh piece = pieces[largest];
        const Vector3d middle = surface_centre(piece);
        Vector3d across(random.normal(), random.normal(), random.normal());
        double extent = 0;
        for (const Point& p : piece.points()) extent = std::max(extent, (eigen(p) - middle).norm());
        const bool coarse = options.sheet > 0;
        const Sheet sheet(middle + 0.15 * extent * random.uniform(-1, 1) * across.normalized(), across.normalized(), 1.2 * extent,
                          options, random);
        std::vector<Mesh> parts;
        bool sound = true;
        for (const double side : {1.0, -1.0}) {
            Mesh result;
            sound = sound && intersected(piece, sheet.half(side, coarse ? options.sheet * extent : edge, coarse), result);
            if (!sound) break;
            result.collect_garbage();
            result = in_order(result);
            const std::size_t before = parts.size();
            std::vector<Mesh> components;
            PMP::split_connected_components(result, components);
            for (const Mesh& one : components) parts.push_back(in_order(one));
            std::sort(parts.begin() + static_cast<std::ptrdiff_t>(before), parts.end(),
                      [](const Mesh& x, const Mesh& y) { return surface_area(x) > surface_area(y); });
        }
        // Very small pieces are rejected: cut again.
        const double minimum = 0.15 / options.pieces * surface_area(whole);
        for (const Mesh& part : parts) sound = sound && CGAL::is_closed(part) && surface_area(part) > minimum;
        if (!sound) continue;
        pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(largest));
        for (Mesh& part : parts) pieces.push_back(std::move(part));
    }
    std::vector<Sherd> sherds;
    for (Mesh& piece : pieces) {
        Sherd sherd{std::move(piece), {}};
        for (const Face f : sherd.mesh.faces())
            sherd.broken.push_back(skin.closest(centroid(sherd.mesh, f)).distance > 1e-7 * diagonal);
        if (options.edge > 0) {
            Random own(options.seed, 10000 + sherds.size());
            sherd = meshed_anew(sherd, options.edge * diagonal, own);
        }
        if (options.erosion > 0) {
            Random own(options.seed, 20000 + sherds.size());
            const Vector3d along = Vector3d(own.normal(), own.normal(), own.normal()).normalized();
            const double phase = own.uniform(0, 2 * pi), turns = 2 * pi * own.uniform(1, 4) / diagonal;
            wear(sherd, options.erosion * diagonal,
                 [&](const Point& p) { return 1 + options.patchiness * std::sin(turns * along.dot(eigen(p)) + phase); });
        }
        if (options.noise > 0) {
            Random own(options.seed, 100 + sherds.size());
            std::vector<Vector3d> normals(sherd.mesh.number_of_vertices(), Vector3d::Zero());
            for (const Face f : sherd.mesh.faces())
                for (const Vertex v : corners(sherd.mesh, f)) normals[v] += eigen(area_vector(sherd.mesh, f));
            for (const Vertex v : sherd.mesh.vertices())
                sherd.mesh.point(v) =
                    point_of(eigen(sherd.mesh.point(v)) + own.normal() * options.noise * diagonal * normals[v].normalized());
        }
        sherds.push_back(std::move(sherd));
    }
    return sherds;
}

std::vector<bool> broken_of_nearest(const Mesh& mesh, const Sherd& sherd) {
    const SurfaceSearch skin(sherd.mesh);
    std::vector<bool> broken;
    for (const Face f : mesh.faces()) broken.push_back(sherd.broken[skin.closest(centroid(mesh, f)).face]);
    return broken;
}

Sherd simplified(const Sherd& sherd, std::uint64_t vertices) {
    Sherd result = sherd;
    if (vertices >= sherd.mesh.number_of_vertices()) return result;
    SimplifyOptions how;
    how.vertices = vertices;
    simplify(result.mesh, how);
    result.broken = broken_of_nearest(result.mesh, sherd);
    return result;
}

void PotOptions::declare_options(OptionList& list) {
    list("height", height, "of the vessel", Range{1e-9, 1e9});
    list("radius", radius, "of the body", Range{1e-9, 1e9});
    list("wall", wall, "thickness of the wall", Range{1e-9, 1e9});
    list("edge", edge, "length of the triangles' edges", Range{1e-9, 1e9});
    list("shape", shape, "of the profile: another number is another vessel", Range{0, 9007199254740992.0});
}

void ShatterOptions::declare_options(OptionList& list) {
    list("pieces", pieces, "at least so many pieces", Range{1, 1000});
    list("roughness", roughness, "height of the breaks' waves", Range{0, 0.2}, "share of the piece's extent");
    list("hurst", hurst, "power of a wave's length that its height goes with", Range{0, 2});
    list("finest", finest, "shortest wave of a break", Range{0.002, 0.5}, "share of the piece's extent");
    list("streak", streak, "how far breaks' waves run one way", Range{0, 1});
    list("bow", bow, "height by which breaks arch", Range{0, 1}, "share of the piece's extent");
    list("sheet", sheet, "edge of the breaks' facets; 0: as fine as the mesh", Range{0, 1}, "share of the piece's extent");
    list("remesh-edge", edge, "edges of each sherd, meshed by itself; 0: as cut", Range{0, 0.2}, "share of the diagonal");
    list("erosion", erosion, "what is worn off breaks and their edges", Range{0, 0.1}, "share of the diagonal");
    list("patchiness", patchiness, "how far erosion differs over the surface", Range{0, 1});
    list("noise", noise, "scan noise: standard deviation of the vertex displacements along the normals", Range{0, 0.1},
         "share of the diagonal");
    list("seed", seed, "of cuts and noise", Range{0, 9007199254740992.0});
}

}  // namespace ostraka
