#include "ostraka/fracture/facet_evidence.h"

#include "facet_columns.h"
#include "facet_sides.h"
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

class Measurer {
public:
    explicit Measurer(FacetEvidence& evidence)
        : evidence_(evidence),
          graph_(evidence.graph),
          walls_(evidence.walls),
          samples_(evidence.samples),
          columns_(graph_.count()) {}

    FeatureColumns run() {
        shapes();
        walls();
        edges();
        segments("part", evidence_.parts[0]);
        segments("small part", evidence_.parts[1]);
        columns_.add("edge of the mesh", [&](std::size_t) { return level(graph_.edge / graph_.size); });
        return std::move(columns_);
    }

private:
    void shapes() {
        const std::size_t n = graph_.count();
        std::array<std::vector<Shape>, scale_count> shapes;
        for (std::size_t s = 0; s < scale_count; ++s) {
            shapes[s].resize(n);
            parallel_for(
                n,
                [&](std::size_t p) {
                    const Neighbourhoods& around = evidence_.around[s];
                    std::vector<Vector3d> points, normals;
                    for (std::size_t k = around.first[p]; k < around.first[p + 1]; ++k) {
                        const Index sample = around.samples[k];
                        const Vector& normal = graph_.normals[samples_.patch[sample]];
                        if (normal * graph_.normals[p] <= -0.4) continue;  // another side
                        points.push_back(eigen(samples_.points[sample]));
                        normals.push_back(eigen(normal));
                    }
                    shapes[s][p] = shape_about(eigen(graph_.places[p]), eigen(graph_.normals[p]), evidence_.around[s].radius,
                                               points, normals);
                },
                64);
        }
        // Means over the next two larger neighbourhoods, so that a place shows what its surroundings are like.
        for (std::size_t s = 0; s < scale_count; ++s) {
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
            const auto& here = shapes[s];
            std::vector<double> rough(n), bent(n);
            const std::vector<double> mean_rough = [&] {
                std::vector<double> values(n);
                for (std::size_t p = 0; p < n; ++p) values[p] = shapes[s][p].quadric;
                return averaged(values, s);
            }();
            for (std::size_t p = 0; p < n; ++p) rough[p] = level(mean_rough[p]), bent[p] = shapes[s][p].bend;
            bent = averaged(bent, s);
            const double low = quantile(rough, areas, 0.2), middle = quantile(rough, areas, 0.5);
            const std::vector<double> rank = ranks(rough, areas), bend_rank = ranks(bent, areas);
            columns_.add("roughness" + at, [&](std::size_t p) { return rough[p]; });
            columns_.add("roughness over the smooth" + at, [&](std::size_t p) { return rough[p] - low; });
            columns_.add("roughness over the usual" + at, [&](std::size_t p) { return rough[p] - middle; });
            columns_.add("rank of roughness" + at, [&](std::size_t p) { return rank[p]; });
            columns_.add("mean bend" + at, [&](std::size_t p) { return bent[p]; });
            columns_.add("rank of bend" + at, [&](std::size_t p) { return bend_rank[p]; });
            if (s == 1) rough_ = rough, bent_ = bent;
            if (s == 2)
                for (std::size_t p = 0; p < n; ++p) side_.push_back(here[p].side);
            if (s == 0)
                for (std::size_t p = 0; p < n; ++p) evidence_.convexity.push_back(std::max(0.0, -here[p].side));
        }
    }

    [[nodiscard]] std::vector<double> averaged(const std::vector<double>& values, std::size_t s) const {
        const std::size_t larger = std::min<std::size_t>(s + 1, 2);
        return mean_about(evidence_, larger, values);
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
        thin_walls();
        // The way through the wall nearby: the main direction of normals of what has a wall under it.
        const std::size_t n = graph_.count();
        std::vector<double> along(n, -1), sides(n, 0), reach(n, 1);
        const double radius = std::min(1.6 * typical, 0.3 * graph_.size);
        const Neighbourhoods around = neighbourhoods(graph_, samples_, radius);
        parallel_for(
            n,
            [&](std::size_t p) {
                Matrix3d sum = Matrix3d::Zero();
                double count = 0, nearest = radius;
                for (std::size_t k = around.first[p]; k < around.first[p + 1]; ++k) {
                    const Index q = samples_.patch[around.samples[k]];
                    if (!over_wall(q)) continue;
                    const Vector3d normal = eigen(graph_.normals[q]);
                    sum += normal * normal.transpose();
                    ++count;
                    nearest = std::min(nearest, std::sqrt(CGAL::squared_distance(graph_.places[p], graph_.places[q])));
                }
                const auto all = static_cast<double>(around.first[p + 1] - around.first[p]);
                if (all > 0) sides[p] = count / all;
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

    /// A wall is thin beside the fragment. Where most of the area lies over one, what does not is a break or a rim.
    void thin_walls() {
        std::vector<std::pair<double, double>> depths;
        double thin = 0;
        for (std::size_t p = 0; p < graph_.count(); ++p)
            if (walls_.opposite[p] > 0.7 && walls_.depth[p] < 0.25 * graph_.size) {
                thin += graph_.areas[p] / graph_.area;
                depths.emplace_back(walls_.depth[p], graph_.areas[p]);
            }
        const double thickness = depths.empty() ? graph_.size : weighted_median(depths);
        const auto ramp = [](double x, double low, double high) { return std::clamp((x - low) / (high - low), 0.0, 1.0); };
        columns_.add("area over thin walls", [&](std::size_t) { return thin; });
        columns_.add("over a thin wall", [&](std::size_t p) {
            return ramp(walls_.opposite[p], 0.3, 0.8) * (1 - ramp(walls_.depth[p] / thickness, 1.6, 2.6));
        });
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
            double area = 0, rough = 0, bent = 0, wall = 0, length = 0, turn = 0, uneven = 0, bumpy = 0, thin = 0, side = 0,
                   bulge = 0, spread = 0;
            Vector3d normal = Vector3d::Zero(), middle = Vector3d::Zero();
        };
        std::vector<Segment> list(count);
        for (std::size_t p = 0; p < part.size(); ++p) {
            Segment& s = list[part[p]];
            const double a = graph_.areas[p];
            s.area += a;
            s.rough += a * rough_[p];
            s.bent += a * bent_[p];
            s.side += a * side_[p];
            s.bulge += a * std::abs(side_[p]);
            s.spread += a * rough_[p] * rough_[p];
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
            s.side /= a, s.bulge /= a, s.rough /= a, s.bent /= a,
                s.spread = std::sqrt(std::max(0.0, s.spread / a - s.rough * s.rough)), s.wall /= a, s.normal /= a, s.middle /= a;
            s.turn /= s.length > 0 ? s.length : 1;
            s.thin = s.length > 0 ? s.area / (s.length * graph_.size) : 1;
            roughs.push_back(s.rough);
            areas.push_back(s.area);
        }
        uneven(part, list);
        std::vector<double> unevens;
        for (const Segment& one : list) unevens.push_back(level(one.uneven));
        const std::vector<double> rank = ranks(roughs, areas), uneven_rank = ranks(unevens, areas);
        const double even = quantile(unevens, areas, 0.1);
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
        columns_.add(name + ": side", [&](std::size_t p) { return of(p).side; });
        columns_.add(name + ": bulges", [&](std::size_t p) { return of(p).bulge; });
        columns_.add(name + ": spread of roughness", [&](std::size_t p) { return of(p).spread; });
        columns_.add(name + ": off its plane", [&](std::size_t p) { return level(of(p).bumpy); });
        columns_.add(name + ": rank of unevenness", [&](std::size_t p) { return uneven_rank[part[p]]; });
        columns_.add(name + ": unevenness over the most even", [&](std::size_t p) { return level(of(p).uneven) - even; });
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
            list[k].uneven = list[k].bumpy = 1;
            if (!(list[k].area > 0) || list[k].normal.norm() < 0.5) continue;
            Fit& fit = fits[k];
            fit.matrix.diagonal().array() += 1e-9;
            list[k].uneven = std::sqrt(std::max(0.0, fit.square - fit.right.dot(solve_ldlt<6>(fit.matrix, fit.right))));
            const Eigen::Matrix3d flat = fit.matrix.topLeftCorner(3, 3);
            const Vector3d right = fit.right.head(3);
            list[k].bumpy = std::sqrt(std::max(0.0, fit.square - right.dot(solve_ldlt<3>(flat, right))));
        }
    }

    FacetEvidence& evidence_;
    const FacetGraph& graph_;
    const Walls& walls_;
    const PatchSamples& samples_;
    FeatureColumns columns_;
    std::vector<double> rough_, bent_, side_;  ///< of each patch, in the middle scale
};

FeatureColumns measure(const Mesh& mesh, FacetEvidence& evidence) {
    evidence.graph = facet_graph(mesh);
    evidence.walls = walls_under(mesh, evidence.graph);
    evidence.samples = patch_samples(mesh, evidence.graph);
    evidence.around = neighbourhoods(evidence.graph, evidence.samples);
    evidence.parts = {convex_parts(evidence.graph, 40 * degree), convex_parts(evidence.graph, 25 * degree)};
    return Measurer(evidence).run();
}

}  // namespace

FacetEvidence facet_evidence(const Mesh& mesh) {
    FacetEvidence evidence;
    evidence.features = measure(mesh, evidence).table();
    return evidence;
}

const std::vector<std::string>& facet_feature_names() {
    static const std::vector<std::string> names = [] {
        TriangleSoup soup;
        soup.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        soup.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
        FacetEvidence evidence;
        return measure(build_mesh(soup), evidence).names;
    }();
    return names;
}

}  // namespace ostraka
