#include "ostraka/shape_classes/dissimilarity.h"

#include "ostraka/algebra/dense.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace ostraka {

namespace {

/// Names of the quantities that count: all except those relative to the mean shape.
const std::set<std::string>& names_that_count() {
    static const std::set<std::string> names = [] {
        std::set<std::string> quantity_names;
        for (const ClassQuantity& quantity : geometry_quantities(std::optional<FitResiduals>()))
            quantity_names.insert(quantity.name);
        for (const ClassQuantity& quantity : geometry_quantities(WholeShape())) quantity_names.insert(quantity.name);
        return quantity_names;
    }();
    return names;
}

/// Scale that is taken as normal. Shares between 0 and 1 by logits, kept a per cent away from the ends; other values by
/// logarithms, at least 1e-4.
double normal_scale(const ClassQuantity& quantity, double value) {
    constexpr double end = 0.01, least = 1e-4;
    if (is_share_of_surface(quantity)) return std::log((value + end) / (1 - value + end));
    return std::log(std::max(value, least));
}

}  // namespace

bool counts_for_dissimilarity(const ClassQuantity& quantity) {
    return quantity.kind == QuantityKind::geometry && quantity.id < 0 && names_that_count().count(quantity.name) > 0;
}

SampleMoments dissimilarity_moments(const LearntRange& range, std::optional<std::size_t> without) {
    std::vector<double> values;
    for (std::size_t i = 0; i < range.values.size(); ++i)
        if (i != without && range.values[i]) values.push_back(normal_scale(range.quantity, *range.values[i]));
    return moments_of(values);
}

namespace {

/// Means and deviations of the members of a class, or of all but one, by which the dissimilarity of an object is measured.
class DissimilarityScale {
public:
    DissimilarityScale(const ShapeClass& learnt, std::optional<std::size_t> without) {
        for (std::size_t k = 0; k < learnt.ranges.size(); ++k) {
            const LearntRange& range = learnt.ranges[k];
            if (!counts_for_dissimilarity(range.quantity)) continue;
            SampleMoments moments = dissimilarity_moments(range, without);
            if (moments.count < 2) continue;
            moments.variance += learnt.resolution * learnt.resolution;
            if (const auto prior = learnt.variances.find(range.quantity.key()); prior != learnt.variances.end())
                moments = prior->second.moderate(moments);
            const double deviation = std::sqrt(moments.variance * (1 + 1 / static_cast<double>(moments.count)));
            if (deviation > 0) scales_.push_back({k, range.quantity, moments.mean, deviation});
        }
        if (learnt.dependence && !scales_.empty()) decorrelate(learnt, without);
    }

    [[nodiscard]] std::optional<Dissimilarity> measure(const std::vector<std::optional<double>>& values) const {
        constexpr std::size_t least_quantities = 3;
        Dissimilarity result;
        Eigen::VectorXd deviations = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(scales_.size()));
        for (std::size_t i = 0; i < scales_.size(); ++i) {
            const Scale& scale = scales_[i];
            if (!values[scale.range]) continue;
            const double deviation = (normal_scale(scale.quantity, *values[scale.range]) - scale.mean) / scale.deviation,
                         counted = scale.counted(deviation);
            if (result.count == 0 || std::abs(counted) > std::abs(result.off)) result.off = counted, result.worst = scale.range;
            deviations[static_cast<Eigen::Index>(i)] = deviation;
            ++result.count;
        }
        if (result.count < least_quantities) return {};
        if (root_.size() > 0) deviations = (root_ * deviations).eval();
        for (std::size_t i = 0; i < scales_.size(); ++i)
            if (values[scales_[i].range]) result.value += std::abs(scales_[i].counted(deviations[static_cast<Eigen::Index>(i)]));
        result.value /= static_cast<double>(result.count);
        return result;
    }

private:
    struct Scale {
        std::size_t range;
        ClassQuantity quantity;
        double mean, deviation;
        [[nodiscard]] double counted(double signed_deviation) const {
            return quantity.one_sided ? std::max(0.0, signed_deviation) : signed_deviation;
        }
    };

    /// Sets R^-1/2 from the cross products, without those of the member that is left out.
    void decorrelate(const ShapeClass& learnt, std::optional<std::size_t> without) {
        const Dependence& dependence = *learnt.dependence;
        const auto n = static_cast<Eigen::Index>(scales_.size());
        std::vector<Eigen::Index> rows;  // -1: unknown
        for (const Scale& scale : scales_) {
            const auto row = dependence.rows.find(scale.quantity.key());
            rows.push_back(row == dependence.rows.end() ? -1 : row->second);
        }
        Eigen::MatrixXd products = Eigen::MatrixXd::Zero(n, n);
        Eigen::VectorXd left_out = Eigen::VectorXd::Zero(n);
        for (Eigen::Index i = 0; i < n; ++i) {
            const Scale& scale = scales_[static_cast<std::size_t>(i)];
            const Eigen::Index row = rows[static_cast<std::size_t>(i)];
            if (row < 0) continue;
            for (Eigen::Index j = 0; j < n; ++j)
                if (const Eigen::Index column = rows[static_cast<std::size_t>(j)]; column >= 0)
                    products(i, j) = dependence.products(row, column);
            // Downdate: a member adds count / (count + 1) times its squared distance from the mean of the others.
            const LearntRange& range = learnt.ranges[scale.range];
            if (without && range.values[*without]) {
                const SampleMoments other_moments = dissimilarity_moments(range, without);
                const auto count = static_cast<double>(other_moments.count);
                left_out[i] =
                    (normal_scale(scale.quantity, *range.values[*without]) - other_moments.mean) * std::sqrt(count / (count + 1));
            }
        }
        products -= left_out * left_out.transpose();
        const double freedom = std::max(0.0, dependence.freedom - (without ? 1 : 0)),
                     weight = freedom / (freedom + static_cast<double>(n));
        Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(n, n);
        for (Eigen::Index i = 0; i < n; ++i)
            for (Eigen::Index j = 0; j < n; ++j)
                if (i != j && products(i, i) > 0 && products(j, j) > 0)
                    correlation(i, j) = weight * products(i, j) / std::sqrt(products(i, i) * products(j, j));
        const SymmetricEigenX eigen(correlation);
        if (!eigen.succeeded()) return;
        constexpr double min_eigenvalue = 0.05;  // missing values can make the matrix indefinite
        const Eigen::VectorXd roots = eigen.eigenvalues().cwiseMax(min_eigenvalue).cwiseSqrt().cwiseInverse();
        root_ = eigen.eigenvectors() * roots.asDiagonal() * eigen.eigenvectors().transpose();
    }

    std::vector<Scale> scales_;
    Eigen::MatrixXd root_;  ///< empty if the dependence is unknown
};

}  // namespace

Dependence dependence_of(const std::vector<ShapeClass>& classes) {
    Dependence result;
    for (const ShapeClass& shape_class : classes)
        for (const LearntRange& range : shape_class.ranges)
            if (counts_for_dissimilarity(range.quantity))
                result.rows.try_emplace(range.quantity.key(), static_cast<Eigen::Index>(result.rows.size()));
    const auto n = static_cast<Eigen::Index>(result.rows.size());
    result.products = Eigen::MatrixXd::Zero(n, n);
    for (const ShapeClass& shape_class : classes) {
        Eigen::MatrixXd deviations = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(shape_class.members.size()));
        for (const LearntRange& range : shape_class.ranges) {
            if (!counts_for_dissimilarity(range.quantity)) continue;
            const double mean = dissimilarity_moments(range).mean;
            for (std::size_t i = 0; i < range.values.size(); ++i)
                if (range.values[i])
                    deviations(result.rows.at(range.quantity.key()), static_cast<Eigen::Index>(i)) =
                        normal_scale(range.quantity, *range.values[i]) - mean;
        }
        result.products += deviations * deviations.transpose();
        result.freedom += std::max(0.0, static_cast<double>(shape_class.members.size()) - 1);
    }
    return result;
}

std::optional<Dissimilarity> dissimilarity(const ShapeClass& learnt, const std::vector<std::optional<double>>& values,
                                           std::optional<std::size_t> without) {
    return DissimilarityScale(learnt, without).measure(values);
}

void measure_dissimilarity(ShapeClass& learnt) {
    if (!learnt.has_thresholds()) return;
    const auto dissimilarity_value = [](const DissimilarityScale& scale, const std::vector<std::optional<double>>& values) {
        const auto dissimilarity_found = scale.measure(values);
        return dissimilarity_found ? std::optional(dissimilarity_found->value) : std::nullopt;
    };
    std::vector<std::optional<double>> member_values, out_of_class_values;
    for (std::size_t i = 0; i < learnt.members.size(); ++i) {
        std::vector<std::optional<double>> values;
        for (const LearntRange& range : learnt.ranges) values.push_back(range.values[i]);
        member_values.push_back(dissimilarity_value(DissimilarityScale(learnt, i), values));
    }
    const DissimilarityScale all_members(learnt, {});
    for (std::size_t i = 0; i < learnt.out_of_class.size(); ++i) {
        std::vector<std::optional<double>> values;
        for (const LearntRange& range : learnt.ranges)
            values.push_back(i < range.out_of_class.size() ? range.out_of_class[i] : std::nullopt);
        out_of_class_values.push_back(dissimilarity_value(all_members, values));
    }
    ClassQuantity quantity;
    quantity.name = unlike_the_members;
    quantity.one_sided = true;
    const auto existing = std::find_if(learnt.ranges.begin(), learnt.ranges.end(),
                                       [&](const LearntRange& range) { return range.quantity.key() == quantity.key(); });
    LearntRange& range = existing != learnt.ranges.end() ? *existing : learnt.ranges.emplace_back();
    range.quantity = quantity;
    range.values = std::move(member_values);
    range.out_of_class = std::move(out_of_class_values);
}

std::vector<double> out_of_class_logs(const LearntRange& range) {
    std::vector<double> logs;
    for (const auto& value : range.out_of_class)
        if (value && *value > 0) logs.push_back(std::log(*value));
    return logs;
}

void set_recognised(LearntRange& range, const SampleMoments& members, const SampleMoments& out_of_class, double accept,
                    double unsure) {
    range.recognised.reset();
    if (!range.high) return;
    if (out_of_class.count < ShapeClass::min_members) {
        constexpr double half = 0.5;
        range.recognised = std::min(*range.high, std::max(half, std::exp(predict(members, true, unsure).high)));
        return;
    }
    range.recognised = std::min(*range.high, std::exp(2 * out_of_class.mean - predict(out_of_class, true, accept).high));
    range.high = std::max(*range.recognised, std::min(*range.high, std::exp(out_of_class.mean)));
}

}  // namespace ostraka
