// Features of the parts of a surface between sharp convex edges, relative to the other parts.
#include "facet_columns.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/dense.h"
#include "ostraka/geom/eigen.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {

using Eigen::Vector3d;

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
        list_.resize(count);
        insides();
        boundaries();
        unevenness();
    }

    void add_to(FeatureColumns& columns, const std::string& name) const {
        std::vector<double> roughs, bents, unevens, ruffles, areas;
        for (const Part& one : list_) {
            roughs.push_back(one.rough);
            bents.push_back(one.bent);
            unevens.push_back(feature_level(one.uneven));
            ruffles.push_back(one.ruffle);
            areas.push_back(one.area);
        }
        const std::vector<double> rank = area_ranks(roughs, areas), bent_rank = area_ranks(bents, areas),
                                  uneven_rank = area_ranks(unevens, areas), ruffle_rank = area_ranks(ruffles, areas);
        const double even = area_quantile(unevens, areas, 0.1);
        const double low = area_quantile(roughs, areas, 0.1), middle = area_quantile(roughs, areas, 0.5);
        const auto add = [&](const std::string& what, auto&& value) {
            columns.add(name + ": " + what, [&](std::size_t p) { return value(list_[part_[p]]); });
        };
        const auto add_rank = [&](const std::string& what, const std::vector<double>& ranks) {
            columns.add(name + ": rank of " + what, [&](std::size_t p) { return ranks[part_[p]]; });
        };
        add("area", [&](const Part& one) { return one.area / graph_.area; });
        add("roughness", [](const Part& one) { return one.rough; });
        add("roughness over the smoothest", [&](const Part& one) { return one.rough - low; });
        add("roughness over the usual", [&](const Part& one) { return one.rough - middle; });
        add_rank("roughness", rank);
        add("bend", [](const Part& one) { return one.bent; });
        add_rank("bend", bent_rank);
        add("one way", [](const Part& one) { return one.normal.norm(); });
        add("unevenness", [](const Part& one) { return feature_level(one.uneven); });
        add("side", [](const Part& one) { return one.side; });
        add("bulges", [](const Part& one) { return one.bulge; });
        add("spread of roughness", [](const Part& one) { return one.spread; });
        add("off its plane", [](const Part& one) { return feature_level(one.bumpy); });
        add_rank("unevenness", uneven_rank);
        add("unevenness over the most even", [&](const Part& one) { return feature_level(one.uneven) - even; });
        add("over walls", [](const Part& one) { return one.wall; });
        add("grain", [](const Part& one) { return one.grain; });
        add("ruffle", [](const Part& one) { return one.ruffle; });
        add_rank("ruffle", ruffle_rank);
        add("turn at its boundary", [](const Part& one) { return one.turn; });
        add("spread of the turn", [](const Part& one) { return one.turn_spread; });
        add("share of sharp boundary", [](const Part& one) { return one.sharp; });
        add("jagged boundary", [](const Part& one) { return one.jagged; });
        add("width", [&](const Part& one) { return one.width(graph_.size); });
        add("roughness over its neighbours", [](const Part& one) { return one.rough - one.other_rough; });
        add("bend over its neighbours", [](const Part& one) { return one.bent - one.other_bent; });
        add("side over its neighbours", [](const Part& one) { return one.side - one.other_side; });
        add("share of one neighbour", [](const Part& one) { return one.main_neighbour; });
    }

private:
    void insides() {
        for (std::size_t p = 0; p < part_.size(); ++p) {
            Part& one = list_[part_[p]];
            const double a = graph_.areas[p];
            one.area += a;
            one.rough += a * values_.rough[p];
            one.bent += a * values_.bent[p];
            one.side += a * values_.side[p];
            one.bulge += a * std::abs(values_.side[p]);
            one.spread += a * values_.rough[p] * values_.rough[p];
            one.wall += values_.over_wall[p] ? a : 0;
            one.grain += a * values_.grain[p];
            one.ruffle += a * values_.ruffle[p];
            one.normal += a * eigen(graph_.normals[p]);
            one.middle += a * eigen(graph_.places[p]);
        }
        for (Part& one : list_) {
            const double a = one.area > 0 ? one.area : 1;
            for (double* sum : {&one.rough, &one.bent, &one.side, &one.bulge, &one.spread, &one.wall, &one.grain, &one.ruffle})
                *sum /= a;
            one.spread = std::sqrt(std::max(0.0, one.spread - one.rough * one.rough));
            one.normal /= a;
            one.middle /= a;
        }
    }

    void boundaries() {
        std::vector<std::map<std::size_t, double>> shared(list_.size());
        for (std::size_t k = 0; k < graph_.contacts.size(); ++k) {
            const FacetGraph::Contact& c = graph_.contacts[k];
            if (part_[c.a] == part_[c.b]) continue;
            for (const auto& [here, there] : {std::pair(part_[c.a], part_[c.b]), std::pair(part_[c.b], part_[c.a])}) {
                Part& one = list_[here];
                one.length += c.length;
                one.turn += c.length * c.turn;
                one.turn_spread += c.length * c.turn * c.turn;
                one.sharp += c.turn > 40 * degree ? c.length : 0;
                one.jagged += c.length * values_.jagged[k];
                one.other_rough += c.length * list_[there].rough;
                one.other_bent += c.length * list_[there].bent;
                one.other_side += c.length * list_[there].side;
                shared[here][there] += c.length;
            }
        }
        for (std::size_t k = 0; k < list_.size(); ++k) {
            Part& one = list_[k];
            if (!(one.length > 0)) continue;
            for (double* sum :
                 {&one.turn, &one.turn_spread, &one.sharp, &one.jagged, &one.other_rough, &one.other_bent, &one.other_side})
                *sum /= one.length;
            one.turn_spread = std::sqrt(std::max(0.0, one.turn_spread - one.turn * one.turn));
            for (const auto& [there, length] : shared[k]) one.main_neighbour = std::max(one.main_neighbour, length / one.length);
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
        const auto over_plane = [](const Part& one) { return one.area > 0 && one.normal.norm() >= 0.5; };
        std::vector<Fit> fits(list_.size());
        for (std::size_t p = 0; p < part_.size(); ++p) {
            const Part& one = list_[part_[p]];
            if (!over_plane(one)) continue;
            const Vector3d normal = one.normal.normalized(), u = normal.unitOrthogonal(), w = normal.cross(u),
                           d = (eigen(graph_.places[p]) - one.middle) / std::sqrt(one.area);
            const double x = u.dot(d), y = w.dot(d), z = normal.dot(d), share = graph_.areas[p] / one.area;
            Row6 row;
            row << 1, x, y, x * x, x * y, y * y;
            fits[part_[p]].matrix += share * row * row.transpose();
            fits[part_[p]].right += share * z * row;
            fits[part_[p]].square += share * z * z;
        }
        for (std::size_t k = 0; k < list_.size(); ++k) {
            if (!over_plane(list_[k])) continue;
            Fit& fit = fits[k];
            fit.matrix.diagonal().array() += 1e-9;
            list_[k].uneven = std::sqrt(std::max(0.0, fit.square - fit.right.dot(solve_ldlt<6>(fit.matrix, fit.right))));
            const Eigen::Matrix3d flat = fit.matrix.topLeftCorner(3, 3);
            const Vector3d right = fit.right.head(3);
            list_[k].bumpy = std::sqrt(std::max(0.0, fit.square - right.dot(solve_ldlt<3>(flat, right))));
        }
    }

    const FacetGraph& graph_;
    const PatchValues& values_;
    const std::vector<std::size_t>& part_;
    std::vector<Part> list_;
};

}  // namespace

void add_part_columns(FeatureColumns& columns, const std::string& name, const FacetEvidence& evidence, const PatchValues& values,
                      const std::vector<std::size_t>& part) {
    Parts(evidence, values, part).add_to(columns, name);
}

}  // namespace ostraka
