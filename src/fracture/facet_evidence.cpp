#include "ostraka/fracture/facet_evidence.h"

#include "fracture/facet_columns.h"
#include "fracture/facet_sides.h"
#include "ostraka/algebra/dense.h"
#include "ostraka/core/angles.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/point_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ostraka {

namespace {

/// Local shape of the surface around a point.
struct Shape {
    double plane = 0, quadric = 0;  ///< root mean square distances from the fits, divided by the radius
    double bend = 0;                ///< spread of the normals: 1 less the length of their mean
    double side = 0;                ///< mean height over the tangent plane, divided by the radius: below 0 where convex
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
        if (normals[k].dot(normal) < 0.3) continue;  // beyond an edge: not a height field over the tangent plane
        Row6 row;
        row << 1, x, y, x * x, x * y, y * y;
        matrix.noalias() += row * row.transpose();
        right += z * row;
        square += z * z;
        ++count;
    }
    const double total = static_cast<double>(points.size());
    shape.side = side / total;
    shape.bend = 1 - mean.norm() / total;
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
        ruffle();
        walls();
        edges();
        add_part_columns(columns_, "part", evidence_, values_, evidence_.parts[0]);
        add_part_columns(columns_, "small part", evidence_, values_, evidence_.parts[1]);
        columns_.add("edge of the mesh", [&](std::size_t) { return feature_level(graph_.edge / graph_.size); });
        return std::move(columns_);
    }

private:
    void shapes() {
        const std::size_t n = graph_.count();
        std::array<std::vector<Shape>, scale_count> shapes;
        for (std::size_t s = 0; s < scale_count; ++s) {
            shapes[s].resize(n);
            parallel_for(n, 64, [&](std::size_t p) {
                const Neighbourhoods& around = evidence_.around[s];
                std::vector<Vector3d> points, normals;
                for (std::size_t k = around.first[p]; k < around.first[p + 1]; ++k) {
                    const Index sample = around.samples[k];
                    const Vector& normal = graph_.normals[samples_.patch[sample]];
                    if (normal * graph_.normals[p] <= -0.4) continue;  // on another side
                    points.push_back(eigen(samples_.points[sample]));
                    normals.push_back(eigen(normal));
                }
                shapes[s][p] =
                    shape_about(eigen(graph_.places[p]), eigen(graph_.normals[p]), evidence_.around[s].radius, points, normals);
            });
        }
        // Means over the next two larger neighbourhoods describe the surroundings.
        for (std::size_t s = 0; s < scale_count; ++s) {
            const std::string suffix = " at " + std::to_string(s);
            const auto& scale_shapes = shapes[s];
            columns_.add("plane" + suffix, [&](std::size_t p) { return feature_level(scale_shapes[p].plane); });
            columns_.add("quadric" + suffix, [&](std::size_t p) { return feature_level(scale_shapes[p].quadric); });
            columns_.add("bend" + suffix, [&](std::size_t p) { return scale_shapes[p].bend; });
            columns_.add("side" + suffix, [&](std::size_t p) { return scale_shapes[p].side; });
        }
        const std::vector<double>& areas = graph_.areas;
        std::array<std::vector<double>, 3> roughs;
        for (std::size_t s = 0; s < 3; ++s) {
            const std::string suffix = " at " + std::to_string(s);
            const auto& scale_shapes = shapes[s];
            std::vector<double> rough(n), bent(n);
            const std::vector<double> mean_rough = [&] {
                std::vector<double> values(n);
                for (std::size_t p = 0; p < n; ++p) values[p] = shapes[s][p].quadric;
                return averaged(values, s);
            }();
            for (std::size_t p = 0; p < n; ++p) rough[p] = feature_level(mean_rough[p]), bent[p] = shapes[s][p].bend;
            bent = averaged(bent, s);
            const double low = area_quantile(rough, areas, 0.2), middle = area_quantile(rough, areas, 0.5);
            const std::vector<double> rank = area_ranks(rough, areas), bend_rank = area_ranks(bent, areas);
            columns_.add("roughness" + suffix, [&](std::size_t p) { return rough[p]; });
            columns_.add("roughness over the smooth" + suffix, [&](std::size_t p) { return rough[p] - low; });
            columns_.add("roughness over the usual" + suffix, [&](std::size_t p) { return rough[p] - middle; });
            columns_.add("rank of roughness" + suffix, [&](std::size_t p) { return rank[p]; });
            columns_.add("mean bend" + suffix, [&](std::size_t p) { return bent[p]; });
            columns_.add("rank of bend" + suffix, [&](std::size_t p) { return bend_rank[p]; });
            roughs[s] = rough;
            if (s == 1) {
                values_.rough = rough, values_.bent = bent;
                const double spread = area_quantile(rough, areas, 0.9) - area_quantile(rough, areas, 0.1);
                columns_.add("spread of roughness in the fragment", [&](std::size_t) { return spread; });
            }
            if (s == 2)
                for (std::size_t p = 0; p < n; ++p) values_.side.push_back(scale_shapes[p].side);
            if (s == 0)
                for (std::size_t p = 0; p < n; ++p) evidence_.convexity.push_back(std::max(0.0, -scale_shapes[p].side));
        }
        for (std::size_t s = 0; s < 2; ++s)
            columns_.add("grain at " + std::to_string(s), [&](std::size_t p) { return roughs[s][p] - roughs[s + 1][p]; });
        for (std::size_t p = 0; p < n; ++p) values_.grain.push_back(roughs[0][p] - roughs[1][p]);
    }

    /// Relief finer than the patches, or noise of the scan.
    void ruffle() {
        std::vector<double> ruffle = neighbourhood_means(evidence_, 1, graph_.normal_deviation);
        for (double& value : ruffle) value = feature_level(value);
        const double usual = area_quantile(ruffle, graph_.areas, 0.5);
        const std::vector<double> rank = area_ranks(ruffle, graph_.areas);
        columns_.add("ruffle", [&](std::size_t p) { return ruffle[p]; });
        columns_.add("ruffle over the usual", [&](std::size_t p) { return ruffle[p] - usual; });
        columns_.add("rank of ruffle", [&](std::size_t p) { return rank[p]; });
        values_.ruffle = std::move(ruffle);
    }

    [[nodiscard]] std::vector<double> averaged(const std::vector<double>& values, std::size_t s) const {
        const std::size_t larger = std::min<std::size_t>(s + 1, 2);
        return neighbourhood_means(evidence_, larger, values);
    }

    [[nodiscard]] bool over_wall(std::size_t p) const {
        return walls_.opposite[p] > 0.7 && walls_.depth[p] < 1.6 * walls_.thickness;
    }

    void walls() {
        const double typical = walls_.thickness > 0 ? walls_.thickness : graph_.size;
        columns_.add("depth", [&](std::size_t p) { return std::min(3.0, walls_.depth[p] / graph_.size); });
        columns_.add("depth in walls", [&](std::size_t p) { return std::min(20.0, walls_.depth[p] / typical); });
        columns_.add("opposite", [&](std::size_t p) { return walls_.opposite[p]; });
        columns_.add("usual wall", [&](std::size_t) { return typical / graph_.size; });
        columns_.add("area over walls", [&](std::size_t) { return walls_.share; });
        thin_walls();
        // Direction through the wall nearby: the main direction of the normals of patches over a wall.
        const std::size_t n = graph_.count();
        std::vector<double> along(n, -1), sides(n, 0), nearest_side(n, 1);
        const double radius = std::min(1.6 * typical, 0.3 * graph_.size);
        const Neighbourhoods around = neighbourhoods(graph_, samples_, radius);
        parallel_for(n, 64, [&](std::size_t p) {
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
            const auto total = static_cast<double>(around.first[p + 1] - around.first[p]);
            if (total > 0) sides[p] = count / total;
            nearest_side[p] = nearest / radius;
            if (count < 3) return;
            const SymmetricEigen<3> main(sum);
            along[p] = std::abs(main.eigenvectors().col(2).dot(eigen(graph_.normals[p])));
        });
        columns_.add("along the wall's normal", [&](std::size_t p) { return along[p]; });
        for (std::size_t p = 0; p < n; ++p) values_.over_wall.push_back(over_wall(p));
        columns_.add("share of sides nearby", [&](std::size_t p) { return sides[p]; });
        columns_.add("distance to a side", [&](std::size_t p) { return nearest_side[p]; });
    }

    /// A wall is thin relative to the fragment. If most of the area lies over a wall, the rest is fracture or lip.
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

    /// How far the edge at each point deviates from a line: spread across it divided by spread along it.
    [[nodiscard]] std::vector<double> jaggedness(const PointTree& tree, const std::vector<Point>& places) const {
        const double radius = std::min(std::max(0.05 * graph_.size, 3 * graph_.edge), 0.3 * graph_.size);
        std::vector<double> result(places.size(), 1);
        parallel_for(places.size(), 64, [&](std::size_t k) {
            std::vector<Index> neighbours;
            tree.within(places[k], radius, neighbours);
            if (neighbours.size() < 4) return;
            Vector3d mean = Vector3d::Zero();
            for (const Index q : neighbours) mean += eigen(places[q]);
            mean /= static_cast<double>(neighbours.size());
            Matrix3d spread = Matrix3d::Zero();
            for (const Index q : neighbours) spread += (eigen(places[q]) - mean) * (eigen(places[q]) - mean).transpose();
            const Vector3d main = SymmetricEigen<3>(spread).eigenvalues();
            if (main[2] > 0) result[k] = std::sqrt(std::max(0.0, main[0] + main[1]) / main[2]);
        });
        return result;
    }

    /// Distance from sharp edges and their density, convex and concave; straightness of the convex ones.
    void edges() {
        const std::size_t n = graph_.count();
        values_.jagged.assign(graph_.contacts.size(), 1);
        for (const bool outward : {true, false}) {
            std::vector<Point> places;
            std::vector<double> lengths;
            std::vector<std::size_t> contacts;
            for (std::size_t k = 0; k < graph_.contacts.size(); ++k) {
                const FacetGraph::Contact& c = graph_.contacts[k];
                if ((outward ? c.dihedral_angle : -c.dihedral_angle) <= 35 * degree) continue;
                places.push_back(c.middle);
                lengths.push_back(c.length);
                contacts.push_back(k);
            }
            const PointTree tree(places);
            std::vector<double> nearest(n, 1), density(n, 0), jagged(n, 1), sharp(n, 0);
            std::vector<double> jagged_here;
            if (outward) {
                jagged_here = jaggedness(tree, places);
                for (std::size_t k = 0; k < contacts.size(); ++k) values_.jagged[contacts[k]] = jagged_here[k];
            }
            const double radius = 0.1 * graph_.size;
            parallel_for(n, 64, [&](std::size_t p) {
                const PointTree::Near near = tree.nearest(graph_.places[p], graph_.size);
                if (near.index == no_index) return;
                nearest[p] = std::sqrt(near.squared) / graph_.size;
                if (outward) jagged[p] = jagged_here[near.index], sharp[p] = graph_.contacts[contacts[near.index]].dihedral_angle;
                if (nearest[p] > 0.1) return;
                std::vector<Index> near_edges;
                tree.within(graph_.places[p], radius, near_edges);
                for (const Index k : near_edges) density[p] += lengths[k] / radius;
            });
            const std::string name = outward ? "outward edges" : "inward edges";
            columns_.add("distance to " + name, [&](std::size_t p) { return nearest[p]; });
            columns_.add("density of " + name, [&](std::size_t p) { return density[p]; });
            double length = 0;
            for (const double edge_length : lengths) length += edge_length / graph_.size;
            columns_.add("length of " + name, [&](std::size_t) { return length; });
            if (!outward) continue;
            columns_.add("jaggedness of the edge", [&](std::size_t p) { return jagged[p]; });
            columns_.add("turn over the edge", [&](std::size_t p) { return sharp[p]; });
        }
    }

    FacetEvidence& evidence_;
    const FacetGraph& graph_;
    const Walls& walls_;
    const PatchSamples& samples_;
    FeatureColumns columns_;
    PatchValues values_;
};

FeatureColumns measure(const Mesh& mesh, FacetEvidence& evidence) {
    evidence.graph = facet_graph(mesh);
    evidence.walls = measure_walls(mesh, evidence.graph);
    evidence.samples = patch_samples(mesh, evidence.graph);
    evidence.around = neighbourhoods(evidence.graph, evidence.samples);
    evidence.parts = {convex_parts(evidence.graph, 40 * degree), convex_parts(evidence.graph, 25 * degree)};
    return Measurer(evidence).run();
}

}  // namespace

std::vector<double> area_ranks(const std::vector<double>& values, const std::vector<double>& areas) {
    std::vector<std::size_t> order(values.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return std::pair(values[a], a) < std::pair(values[b], b); });
    double total = 0, below = 0;
    for (const double a : areas) total += a;
    std::vector<double> result(values.size());
    for (const std::size_t k : order) {
        result[k] = (below + areas[k] / 2) / total;
        below += areas[k];
    }
    return result;
}

double area_quantile(const std::vector<double>& values, const std::vector<double>& areas, double share) {
    std::vector<std::pair<double, double>> sorted;
    double total = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
        sorted.emplace_back(values[k], areas[k]);
        total += areas[k];
    }
    std::sort(sorted.begin(), sorted.end());
    double below = 0;
    for (const auto& [value, area] : sorted)
        if ((below += area) >= share * total) return value;
    return 0;
}

FacetEvidence facet_evidence(const Mesh& mesh) {
    FacetEvidence evidence;
    evidence.features = measure(mesh, evidence).table();
    return evidence;
}

namespace {

/// The names of the features are those measured on a tetrahedron.
Mesh tetrahedron() {
    TriangleSoup soup;
    soup.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    soup.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    return build_mesh(soup);
}

}  // namespace

const std::vector<std::string>& facet_feature_names() {
    static const std::vector<std::string> names = [] {
        FacetEvidence evidence;
        return measure(tetrahedron(), evidence).names;
    }();
    return names;
}

const std::vector<std::string>& facet_context_names() {
    static const std::vector<std::string> names = [] {
        const FacetEvidence evidence = facet_evidence(tetrahedron());
        return context_columns(evidence, std::vector<double>(evidence.graph.count(), 0)).names;
    }();
    return names;
}

}  // namespace ostraka
