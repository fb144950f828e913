// Features of the parts of a surface between sharp convex edges, relative to the other parts.
#include "fracture/facet_columns.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/angles.h"
#include "ostraka/geom/eigen.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {

namespace {

using Row6 = Eigen::Matrix<double, 6, 1>;

struct Part {
    double area = 0, rough = 0, bent = 0, wall = 0, uneven = 1, bumpy = 1, side = 0, bulge = 0, spread = 0, grain = 0, ruffle = 0;
    double length = 0, turn = 0, turn_spread = 0, sharp = 0, jagged = 0;         ///< of its boundary
    double other_rough = 0, other_bent = 0, other_side = 0, main_neighbour = 0;  ///< of its neighbours, by length
    Vector3d normal = Vector3d::Zero(), middle = Vector3d::Zero();

    [[nodiscard]] double width(double size) const { return length > 0 ? area / (length * size) : 1; }
};

class Parts {
public:
    Parts(const FacetEvidence& evidence, const PatchValues& values, const std::vector<std::size_t>& part)
        : graph_(evidence.graph), values_(values), part_(part) {
        std::size_t count = 0;
        for (const std::size_t p : part) count = std::max(count, p + 1);
        parts_.resize(count);
        insides();
        boundaries();
        unevenness();
    }

    void add_to(FeatureColumns& columns, const std::string& name) const {
        std::vector<double> roughs, bents, unevens, ruffles, areas;
        for (const Part& part : parts_) {
            roughs.push_back(part.rough);
            bents.push_back(part.bent);
            unevens.push_back(feature_level(part.uneven));
            ruffles.push_back(part.ruffle);
            areas.push_back(part.area);
        }
        const std::vector<double> rank = area_ranks(roughs, areas), bent_rank = area_ranks(bents, areas),
                                  uneven_rank = area_ranks(unevens, areas), ruffle_rank = area_ranks(ruffles, areas);
        const double even = area_quantile(unevens, areas, 0.1);
        const double low = area_quantile(roughs, areas, 0.1), middle = area_quantile(roughs, areas, 0.5);
        const auto add = [&](const std::string& feature, auto&& value) {
            columns.add(name + ": " + feature, [&](std::size_t p) { return value(parts_[part_[p]]); });
        };
        const auto add_rank = [&](const std::string& feature, const std::vector<double>& ranks) {
            columns.add(name + ": rank of " + feature, [&](std::size_t p) { return ranks[part_[p]]; });
        };
        add("area", [&](const Part& part) { return part.area / graph_.area; });
        add("roughness", [](const Part& part) { return part.rough; });
        add("roughness over the smoothest", [&](const Part& part) { return part.rough - low; });
        add("roughness over the usual", [&](const Part& part) { return part.rough - middle; });
        add_rank("roughness", rank);
        add("bend", [](const Part& part) { return part.bent; });
        add_rank("bend", bent_rank);
        add("one way", [](const Part& part) { return part.normal.norm(); });
        add("unevenness", [](const Part& part) { return feature_level(part.uneven); });
        add("side", [](const Part& part) { return part.side; });
        add("bulges", [](const Part& part) { return part.bulge; });
        add("spread of roughness", [](const Part& part) { return part.spread; });
        add("off its plane", [](const Part& part) { return feature_level(part.bumpy); });
        add_rank("unevenness", uneven_rank);
        add("unevenness over the most even", [&](const Part& part) { return feature_level(part.uneven) - even; });
        add("over walls", [](const Part& part) { return part.wall; });
        add("grain", [](const Part& part) { return part.grain; });
        add("ruffle", [](const Part& part) { return part.ruffle; });
        add_rank("ruffle", ruffle_rank);
        add("turn at its boundary", [](const Part& part) { return part.turn; });
        add("spread of the turn", [](const Part& part) { return part.turn_spread; });
        add("share of sharp boundary", [](const Part& part) { return part.sharp; });
        add("jagged boundary", [](const Part& part) { return part.jagged; });
        add("width", [&](const Part& part) { return part.width(graph_.size); });
        add("roughness over its neighbours", [](const Part& part) { return part.rough - part.other_rough; });
        add("bend over its neighbours", [](const Part& part) { return part.bent - part.other_bent; });
        add("side over its neighbours", [](const Part& part) { return part.side - part.other_side; });
        add("share of one neighbour", [](const Part& part) { return part.main_neighbour; });
    }

private:
    void insides() {
        for (std::size_t p = 0; p < part_.size(); ++p) {
            Part& part = parts_[part_[p]];
            const double a = graph_.areas[p];
            part.area += a;
            part.rough += a * values_.rough[p];
            part.bent += a * values_.bent[p];
            part.side += a * values_.side[p];
            part.bulge += a * std::abs(values_.side[p]);
            part.spread += a * values_.rough[p] * values_.rough[p];
            part.wall += values_.over_wall[p] ? a : 0;
            part.grain += a * values_.grain[p];
            part.ruffle += a * values_.ruffle[p];
            part.normal += a * eigen(graph_.normals[p]);
            part.middle += a * eigen(graph_.places[p]);
        }
        for (Part& part : parts_) {
            const double a = part.area > 0 ? part.area : 1;
            for (double* sum :
                 {&part.rough, &part.bent, &part.side, &part.bulge, &part.spread, &part.wall, &part.grain, &part.ruffle})
                *sum /= a;
            part.spread = std::sqrt(std::max(0.0, part.spread - part.rough * part.rough));
            part.normal /= a;
            part.middle /= a;
        }
    }

    void boundaries() {
        std::vector<std::map<std::size_t, double>> shared(parts_.size());
        for (std::size_t k = 0; k < graph_.contacts.size(); ++k) {
            const FacetGraph::Contact& c = graph_.contacts[k];
            if (part_[c.a] == part_[c.b]) continue;
            for (const auto& [from, to] : {std::pair(part_[c.a], part_[c.b]), std::pair(part_[c.b], part_[c.a])}) {
                Part& part = parts_[from];
                part.length += c.length;
                part.turn += c.length * c.dihedral_angle;
                part.turn_spread += c.length * c.dihedral_angle * c.dihedral_angle;
                part.sharp += c.dihedral_angle > 40 * degree ? c.length : 0;
                part.jagged += c.length * values_.jagged[k];
                part.other_rough += c.length * parts_[to].rough;
                part.other_bent += c.length * parts_[to].bent;
                part.other_side += c.length * parts_[to].side;
                shared[from][to] += c.length;
            }
        }
        for (std::size_t k = 0; k < parts_.size(); ++k) {
            Part& part = parts_[k];
            if (!(part.length > 0)) continue;
            for (double* sum : {&part.turn, &part.turn_spread, &part.sharp, &part.jagged, &part.other_rough, &part.other_bent,
                                &part.other_side})
                *sum /= part.length;
            part.turn_spread = std::sqrt(std::max(0.0, part.turn_spread - part.turn * part.turn));
            for (const auto& [neighbour, length] : shared[k])
                part.main_neighbour = std::max(part.main_neighbour, length / part.length);
        }
    }

    /// Root mean square distance of each part from its mean plane and from a quadric over that plane, divided by the square
    /// root of its area; 1 where it is not a height field over the plane.
    void unevenness() {
        struct Fit {
            Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
            Row6 right = Row6::Zero();
            double square = 0;
        };
        const auto over_plane = [](const Part& part) { return part.area > 0 && part.normal.norm() >= 0.5; };
        std::vector<Fit> fits(parts_.size());
        for (std::size_t p = 0; p < part_.size(); ++p) {
            const Part& part = parts_[part_[p]];
            if (!over_plane(part)) continue;
            const Vector3d normal = part.normal.normalized(), u = normal.unitOrthogonal(), w = normal.cross(u),
                           d = (eigen(graph_.places[p]) - part.middle) / std::sqrt(part.area);
            const double x = u.dot(d), y = w.dot(d), z = normal.dot(d), weight = graph_.areas[p] / part.area;
            Row6 row;
            row << 1, x, y, x * x, x * y, y * y;
            fits[part_[p]].matrix += weight * row * row.transpose();
            fits[part_[p]].right += weight * z * row;
            fits[part_[p]].square += weight * z * z;
        }
        for (std::size_t k = 0; k < parts_.size(); ++k) {
            if (!over_plane(parts_[k])) continue;
            Fit& fit = fits[k];
            fit.matrix.diagonal().array() += 1e-9;
            parts_[k].uneven = std::sqrt(std::max(0.0, fit.square - fit.right.dot(solve_ldlt<6>(fit.matrix, fit.right))));
            const Eigen::Matrix3d flat = fit.matrix.topLeftCorner(3, 3);
            const Vector3d right = fit.right.head(3);
            parts_[k].bumpy = std::sqrt(std::max(0.0, fit.square - right.dot(solve_ldlt<3>(flat, right))));
        }
    }

    const FacetGraph& graph_;
    const PatchValues& values_;
    const std::vector<std::size_t>& part_;
    std::vector<Part> parts_;
};

}  // namespace

void add_part_columns(FeatureColumns& columns, const std::string& name, const FacetEvidence& evidence, const PatchValues& values,
                      const std::vector<std::size_t>& part) {
    Parts(evidence, values, part).add_to(columns, name);
}

}  // namespace ostraka
