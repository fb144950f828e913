#include "ostraka/fracture/facet_evidence.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/dense.h"
#include "ostraka/core/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/point_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ostraka {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Radii of neighbourhoods, as shares of the fragment's size.
constexpr std::array<double, 4> scales{0.025, 0.05, 0.1, 0.2};
/// Every so many samples are looked at in each: about a hundred.
constexpr std::array<std::size_t, 4> strides{1, 1, 4, 16};
constexpr std::size_t sample_count = 12000;

/// Points spread evenly over the surface.
struct Samples {
    std::vector<Point> points;
    std::vector<Index> patch;
};

Samples samples_on(const Mesh& mesh, const FacetGraph& graph) {
    Samples samples;
    const double step = graph.area / sample_count;
    double sum = 0;
    std::size_t k = 0;
    for (const Face f : mesh.faces()) {
        sum += face_area(mesh, f);
        while (k < sample_count && (static_cast<double>(k) + 0.5) * step < sum) {
            // The R2 sequence, folded into the triangle.
            const auto share = [&](double rate) { return std::fmod(0.5 + rate * static_cast<double>(k + 1), 1.0); };
            double u = share(0.7548776662466927), v = share(0.5698402909980532);
            if (u + v > 1) u = 1 - u, v = 1 - v;
            const auto [a, b, c] = corners(mesh, f);
            const Point &p = mesh.point(a), &q = mesh.point(b), &r = mesh.point(c);
            samples.points.push_back(p + u * (q - p) + v * (r - p));
            samples.patch.push_back(graph.patch_of_face[f]);
            ++k;
        }
    }
    return samples;
}

/// Every `stride`-th sample, to be found by place.
struct Level {
    PointTree tree;
    std::vector<Index> samples;
};

Level level_of(const Samples& samples, std::size_t stride) {
    Level level;
    std::vector<Point> points;
    for (std::size_t k = stride / 2; k < samples.points.size(); k += stride) {
        points.push_back(samples.points[k]);
        level.samples.push_back(static_cast<Index>(k));
    }
    level.tree = PointTree(points);
    return level;
}

/// The shape of the surface about a place.
struct Shape {
    double plane = 0, quadric = 0;  ///< root mean square distances from them, over the radius
    double bend = 0;                ///< how far normals differ: 1 less the length of their mean
    double side = 0;                ///< mean height over the tangent plane, over the radius: below 0 where convex
};

using Row6 = Eigen::Matrix<double, 6, 1>;

Shape shape_about(const Vector3d& place, const Vector3d& normal, double radius, const std::vector<Vector3d>& points,
                  const std::vector<Vector3d>& normals) {
    Shape shape;
    if (points.size() < 4) return shape;
    const Vector3d u = normal.unitOrthogonal(), w = normal.cross(u);
    Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
    Row6 right = Row6::Zero();
    Vector3d mean = Vector3d::Zero();
    double square = 0, count = 0, side = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const Vector3d d = (points[k] - place) / radius;
        const double x = u.dot(d), y = w.dot(d), z = normal.dot(d);
        side += z;
        mean += normals[k];
        if (normals[k].dot(normal) < 0.3) continue;  // round an edge: no function over the tangent plane
        Row6 row;
        row << 1, x, y, x * x, x * y, y * y;
        matrix.noalias() += row * row.transpose();
        right += z * row;
        square += z * z;
        ++count;
    }
    const double all = static_cast<double>(points.size());
    shape.side = side / all;
    shape.bend = 1 - mean.norm() / all;
    if (count < 4) return shape;
    const Eigen::Matrix3d flat = matrix.topLeftCorner<3, 3>() + 1e-9 * count * Matrix3d::Identity();
    const Vector3d plane = solve_ldlt<3>(flat, right.head<3>());
    shape.plane = std::sqrt(std::max(0.0, square - plane.dot(right.head<3>())) / count);
    if (count < 8) {
        shape.quadric = shape.plane;
        return shape;
    }
    matrix.diagonal().array() += 1e-9 * count;
    shape.quadric = std::sqrt(std::max(0.0, square - right.dot(solve_ldlt<6>(matrix, right))) / count);
    return shape;
}

/// The share of the area below each value.
std::vector<double> ranks(const std::vector<double>& values, const std::vector<double>& areas) {
    std::vector<std::size_t> order(values.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return std::pair(values[a], a) < std::pair(values[b], b); });
    double all = 0, below = 0;
    for (const double a : areas) all += a;
    std::vector<double> result(values.size());
    for (const std::size_t k : order) {
        result[k] = (below + areas[k] / 2) / all;
        below += areas[k];
    }
    return result;
}

/// The value below which `share` of the area lies.
double quantile(const std::vector<double>& values, const std::vector<double>& areas, double share) {
    std::vector<std::pair<double, double>> sorted;
    double all = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
        sorted.emplace_back(values[k], areas[k]);
        all += areas[k];
    }
    std::sort(sorted.begin(), sorted.end());
    double below = 0;
    for (const auto& [value, area] : sorted)
        if ((below += area) >= share * all) return value;
    return 0;
}

/// Roots of logarithms: of a share that may vanish.
double level(double x) { return std::log10(1e-4 + x); }

/// A column a feature, each with its name: values are handed over a feature at a time.
class Columns {
public:
    explicit Columns(std::size_t rows) : rows_(rows) {}
    template <class Of>
    void add(const std::string& name, Of&& of) {
        names.push_back(name);
        auto& column = columns_.emplace_back(rows_);
        for (std::size_t r = 0; r < rows_; ++r) {
            const double value = of(r);
            column[r] = static_cast<float>(std::isfinite(value) ? std::clamp(value, -1e6, 1e6) : 1e6);
        }
    }
    [[nodiscard]] FeatureTable table() const {
        FeatureTable result;
        result.columns = columns_.size();
        result.values.reserve(rows_ * columns_.size());
        for (std::size_t r = 0; r < rows_; ++r)
            for (const auto& column : columns_) result.values.push_back(column[r]);
        return result;
    }
    std::vector<std::string> names;

private:
    std::size_t rows_;
    std::vector<std::vector<float>> columns_;
};

class Measurer {
public:
    Measurer(const Mesh& mesh, const FacetGraph& graph, const Walls& walls)
        : mesh_(mesh), graph_(graph), walls_(walls), columns_(graph.count()), samples_(samples_on(mesh, graph)) {
        for (const std::size_t stride : strides) levels_.push_back(level_of(samples_, stride));
        for (std::size_t s = 0; s < scales.size(); ++s) {
            // Less than the mesh resolves shows nothing.
            radii_[s] = std::max(scales[s] * graph.size, (1.5 + static_cast<double>(s)) * graph.edge);
            radii_[s] = std::min(radii_[s], 0.4 * graph.size);
        }
    }

    Columns run() {
        shapes();
        walls();
        edges();
        segments("part", convex_parts(graph_, 40 * degree));
        segments("small part", convex_parts(graph_, 25 * degree));
        columns_.add("edge of the mesh", [&](std::size_t) { return level(graph_.edge / graph_.size); });
        return std::move(columns_);
    }

private:
    /// Indices of samples around a patch on the same side of the surface.
    void around(std::size_t p, double radius, const Level& of, std::vector<Index>& found) const {
        of.tree.within(graph_.places[p], radius, found);
        std::size_t kept = 0;
        for (const Index k : found) {
            const Index sample = of.samples[k];
            if (graph_.normals[samples_.patch[sample]] * graph_.normals[p] > -0.4) found[kept++] = sample;
        }
        found.resize(kept);
    }

    void shapes() {
        const std::size_t n = graph_.count();
        std::array<std::vector<Shape>, scales.size()> shapes;
        for (std::size_t s = 0; s < scales.size(); ++s) {
            shapes[s].resize(n);
            parallel_for(
                n,
                [&](std::size_t p) {
                    std::vector<Index> found;
                    around(p, radii_[s], levels_[s], found);
                    std::vector<Vector3d> points, normals;
                    for (const Index k : found) {
                        points.push_back(eigen(samples_.points[k]));
                        normals.push_back(eigen(graph_.normals[samples_.patch[k]]));
                    }
                    shapes[s][p] = shape_about(eigen(graph_.places[p]), eigen(graph_.normals[p]), radii_[s], points, normals);
                },
                64);
        }
        // Means over the next two larger neighbourhoods, so that a place shows what its surroundings are like.
        for (std::size_t s = 0; s < scales.size(); ++s) {
            const std::string at = " at " + std::to_string(s);
            const auto& here = shapes[s];
            columns_.add("plane" + at, [&](std::size_t p) { return level(here[p].plane); });
            columns_.add("quadric" + at, [&](std::size_t p) { return level(here[p].quadric); });
            columns_.add("bend" + at, [&](std::size_t p) { return here[p].bend; });
            columns_.add("side" + at, [&](std::size_t p) { return here[p].side; });
        }
        const std::vector<double>& areas = graph_.areas;
        for (std::size_t s = 0; s < 3; ++s) {
            const std::string at = " at " + std::to_string(s);
            std::vector<double> rough(n), bent(n);
            const std::vector<double> mean_rough = [&] {
                std::vector<double> values(n);
                for (std::size_t p = 0; p < n; ++p) values[p] = shapes[s][p].quadric;
                return averaged(values, std::min<std::size_t>(s + 1, 2));
            }();
            for (std::size_t p = 0; p < n; ++p) rough[p] = level(mean_rough[p]), bent[p] = shapes[s][p].bend;
            bent = averaged(bent, std::min<std::size_t>(s + 1, 2));
            const double low = quantile(rough, areas, 0.2), middle = quantile(rough, areas, 0.5);
            const std::vector<double> rank = ranks(rough, areas), bend_rank = ranks(bent, areas);
            columns_.add("roughness" + at, [&](std::size_t p) { return rough[p]; });
            columns_.add("roughness over the smooth" + at, [&](std::size_t p) { return rough[p] - low; });
            columns_.add("roughness over the usual" + at, [&](std::size_t p) { return rough[p] - middle; });
            columns_.add("rank of roughness" + at, [&](std::size_t p) { return rank[p]; });
            columns_.add("mean bend" + at, [&](std::size_t p) { return bent[p]; });
            columns_.add("rank of bend" + at, [&](std::size_t p) { return bend_rank[p]; });
            if (s == 1) rough_ = rough, bent_ = bent;
        }
    }

    /// Means over the samples around each patch that face the same way.
    [[nodiscard]] std::vector<double> averaged(const std::vector<double>& values, std::size_t s) const {
        std::vector<double> result(values.size());
        parallel_for(
            values.size(),
            [&](std::size_t p) {
                std::vector<Index> found;
                levels_[s].tree.within(graph_.places[p], radii_[s], found);
                double sum = 1e-3 * values[p], count = 1e-3;
                for (const Index k : found) {
                    const Index q = samples_.patch[levels_[s].samples[k]];
                    if (graph_.normals[q] * graph_.normals[p] < 0.5) continue;
                    sum += values[q];
                    ++count;
                }
                result[p] = sum / count;
            },
            64);
        return result;
    }

    [[nodiscard]] bool over_wall(std::size_t p) const {
        return walls_.opposite[p] > 0.7 && walls_.depth[p] < 1.6 * walls_.typical;
    }

    void walls() {
        const double typical = walls_.typical > 0 ? walls_.typical : graph_.size;
        columns_.add("depth", [&](std::size_t p) { return std::min(3.0, walls_.depth[p] / graph_.size); });
        columns_.add("depth in walls", [&](std::size_t p) { return std::min(20.0, walls_.depth[p] / typical); });
        columns_.add("opposite", [&](std::size_t p) { return walls_.opposite[p]; });
        columns_.add("usual wall", [&](std::size_t) { return typical / graph_.size; });
        columns_.add("area over walls", [&](std::size_t) { return walls_.share; });
        // The way through the wall nearby: the main direction of normals of what has a wall under it.
        const std::size_t n = graph_.count();
        std::vector<double> along(n, -1), sides(n, 0), reach(n, 1);
        const double radius = std::min(1.6 * typical, 0.3 * graph_.size);
        // About a hundred samples.
        const auto stride =
            static_cast<std::size_t>(std::clamp(sample_count * pi * radius * radius / (100 * graph_.area), 1.0, 32.0));
        const Level level = level_of(samples_, stride);
        parallel_for(
            n,
            [&](std::size_t p) {
                std::vector<Index> found;
                level.tree.within(graph_.places[p], radius, found);
                Matrix3d sum = Matrix3d::Zero();
                double count = 0, nearest = radius;
                for (const Index k : found) {
                    const Index q = samples_.patch[level.samples[k]];
                    if (!over_wall(q)) continue;
                    const Vector3d normal = eigen(graph_.normals[q]);
                    sum += normal * normal.transpose();
                    ++count;
                    nearest = std::min(nearest, std::sqrt(CGAL::squared_distance(graph_.places[p], graph_.places[q])));
                }
                if (!found.empty()) sides[p] = count / static_cast<double>(found.size());
                reach[p] = nearest / radius;
                if (count < 3) return;
                const SymmetricEigen<3> main(sum);
                along[p] = std::abs(main.eigenvectors().col(2).dot(eigen(graph_.normals[p])));
            },
            64);
        columns_.add("along the wall's normal", [&](std::size_t p) { return along[p]; });
        columns_.add("share of sides nearby", [&](std::size_t p) { return sides[p]; });
        columns_.add("distance to a side", [&](std::size_t p) { return reach[p]; });
    }

    /// Distance from sharp edges, and how many there are, outward and inward.
    void edges() {
        const std::size_t n = graph_.count();
        for (const bool outward : {true, false}) {
            std::vector<Point> places;
            std::vector<double> lengths;
            for (const auto& c : graph_.contacts)
                if ((outward ? c.turn : -c.turn) > 35 * degree) places.push_back(c.middle), lengths.push_back(c.length);
            const PointTree tree(places);
            std::vector<double> nearest(n, 1), density(n, 0);
            const double radius = 0.1 * graph_.size;
            parallel_for(
                n,
                [&](std::size_t p) {
                    const PointTree::Near near = tree.nearest(graph_.places[p], graph_.size);
                    if (near.index == no_index) return;
                    nearest[p] = std::sqrt(near.squared) / graph_.size;
                    if (nearest[p] > 0.1) return;
                    std::vector<Index> found;
                    tree.within(graph_.places[p], radius, found);
                    for (const Index k : found) density[p] += lengths[k] / radius;
                },
                64);
            const std::string name = outward ? "outward edges" : "inward edges";
            columns_.add("distance to " + name, [&](std::size_t p) { return nearest[p]; });
            columns_.add("density of " + name, [&](std::size_t p) { return density[p]; });
        }
    }

    /// What the part of the surface that a patch lies in is like, and how it compares.
    void segments(const std::string& name, const std::vector<std::size_t>& part) {
        std::size_t count = 0;
        for (const std::size_t p : part) count = std::max(count, p + 1);
        struct Segment {
            double area = 0, rough = 0, bent = 0, wall = 0, length = 0, turn = 0, uneven = 0, thin = 0;
            Vector3d normal = Vector3d::Zero(), middle = Vector3d::Zero();
        };
        std::vector<Segment> list(count);
        for (std::size_t p = 0; p < part.size(); ++p) {
            Segment& s = list[part[p]];
            const double a = graph_.areas[p];
            s.area += a;
            s.rough += a * rough_[p];
            s.bent += a * bent_[p];
            s.wall += over_wall(p) ? a : 0;
            s.normal += a * eigen(graph_.normals[p]);
            s.middle += a * eigen(graph_.places[p]);
        }
        for (const auto& c : graph_.contacts)
            if (part[c.a] != part[c.b])
                for (const Index p : {c.a, c.b}) list[part[p]].length += c.length, list[part[p]].turn += c.length * c.turn;
        std::vector<double> roughs, areas;
        for (Segment& s : list) {
            const double a = s.area > 0 ? s.area : 1;
            s.rough /= a, s.bent /= a, s.wall /= a, s.normal /= a, s.middle /= a;
            s.turn /= s.length > 0 ? s.length : 1;
            s.thin = s.length > 0 ? s.area / (s.length * graph_.size) : 1;
            roughs.push_back(s.rough);
            areas.push_back(s.area);
        }
        uneven(part, list);
        const std::vector<double> rank = ranks(roughs, areas);
        const double low = quantile(roughs, areas, 0.1), middle = quantile(roughs, areas, 0.5);
        const auto of = [&](std::size_t p) -> const Segment& { return list[part[p]]; };
        columns_.add(name + ": area", [&](std::size_t p) { return of(p).area / graph_.area; });
        columns_.add(name + ": roughness", [&](std::size_t p) { return of(p).rough; });
        columns_.add(name + ": roughness over the smoothest", [&](std::size_t p) { return of(p).rough - low; });
        columns_.add(name + ": roughness over the usual", [&](std::size_t p) { return of(p).rough - middle; });
        columns_.add(name + ": rank of roughness", [&](std::size_t p) { return rank[part[p]]; });
        columns_.add(name + ": bend", [&](std::size_t p) { return of(p).bent; });
        columns_.add(name + ": one way", [&](std::size_t p) { return of(p).normal.norm(); });
        columns_.add(name + ": unevenness", [&](std::size_t p) { return level(of(p).uneven); });
        columns_.add(name + ": over walls", [&](std::size_t p) { return of(p).wall; });
        columns_.add(name + ": turn at its boundary", [&](std::size_t p) { return of(p).turn; });
        columns_.add(name + ": width", [&](std::size_t p) { return of(p).thin; });
    }

    /// Root mean square distance of each part from the quadric over its mean plane, over the square root of its area; 1 where it
    /// does not lie over a plane.
    template <class Segment>
    void uneven(const std::vector<std::size_t>& part, std::vector<Segment>& list) const {
        struct Fit {
            Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
            Row6 right = Row6::Zero();
            double square = 0;
        };
        std::vector<Fit> fits(list.size());
        for (std::size_t p = 0; p < part.size(); ++p) {
            const Segment& s = list[part[p]];
            if (!(s.area > 0) || s.normal.norm() < 0.5) continue;
            const Vector3d normal = s.normal.normalized(), u = normal.unitOrthogonal(), w = normal.cross(u),
                           d = (eigen(graph_.places[p]) - s.middle) / std::sqrt(s.area);
            const double x = u.dot(d), y = w.dot(d), z = normal.dot(d), share = graph_.areas[p] / s.area;
            Row6 row;
            row << 1, x, y, x * x, x * y, y * y;
            fits[part[p]].matrix += share * row * row.transpose();
            fits[part[p]].right += share * z * row;
            fits[part[p]].square += share * z * z;
        }
        for (std::size_t k = 0; k < list.size(); ++k) {
            list[k].uneven = 1;
            if (!(list[k].area > 0) || list[k].normal.norm() < 0.5) continue;
            Fit& fit = fits[k];
            fit.matrix.diagonal().array() += 1e-9;
            list[k].uneven = std::sqrt(std::max(0.0, fit.square - fit.right.dot(solve_ldlt<6>(fit.matrix, fit.right))));
        }
    }

    const Mesh& mesh_;
    const FacetGraph& graph_;
    const Walls& walls_;
    Columns columns_;
    Samples samples_;
    std::vector<Level> levels_;
    std::array<double, scales.size()> radii_{};
    std::vector<double> rough_, bent_;  ///< of each patch, in the middle scale
};

}  // namespace

FacetEvidence facet_evidence(const Mesh& mesh) {
    FacetEvidence evidence;
    evidence.graph = facet_graph(mesh);
    evidence.walls = walls_under(mesh, evidence.graph);
    evidence.features = Measurer(mesh, evidence.graph, evidence.walls).run().table();
    return evidence;
}

const std::vector<std::string>& FacetEvidence::names() {
    static const std::vector<std::string> names = [] {
        TriangleSoup soup;
        soup.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        soup.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
        const Mesh mesh = build_mesh(soup);
        const FacetGraph graph = facet_graph(mesh);
        return Measurer(mesh, graph, walls_under(mesh, graph)).run().names;
    }();
    return names;
}

}  // namespace ostraka
