#include "collection/technique_model.h"
#include "ostraka/algebra/dense.h"

#include <cmath>

namespace ostraka {

using Eigen::MatrixXd;
using Eigen::VectorXd;

DescriptorTable descriptor_table(const std::vector<TechniqueObject>& objects, const std::vector<std::string>& descriptors) {
    DescriptorTable table;
    std::vector<bool> positive;
    for (const auto& name : descriptors)
        for (const DescriptorMeaning& meaning : technique_descriptors())
            if (meaning.name == name) positive.push_back(meaning.positive);
    if (positive.size() != descriptors.size()) throw std::logic_error("unknown descriptor of technique");
    std::vector<VectorXd> rows;
    const auto columns = static_cast<Eigen::Index>(descriptors.size());
    for (std::size_t i = 0; i < objects.size(); ++i) {
        VectorXd row(columns);
        for (Eigen::Index k = 0; k < columns; ++k) {
            const double value = objects[i].measures.value(descriptors[static_cast<std::size_t>(k)]);
            row[k] = positive[static_cast<std::size_t>(k)] ? std::log(std::max(value, min_positive)) : value;
            if (std::isnan(value)) row[k] = value;
        }
        if (!row.allFinite()) continue;
        rows.push_back(row);
        table.objects.push_back(i);
    }
    table.values.resize(static_cast<Eigen::Index>(rows.size()), columns);
    for (std::size_t i = 0; i < rows.size(); ++i) table.values.row(static_cast<Eigen::Index>(i)) = rows[i];
    table.logarithm = positive.front();
    return table;
}

namespace {

struct ClassStatistics {
    VectorXd mean[2];
    MatrixXd scatter;  ///< pooled covariance
    std::size_t count[2] = {0, 0};
};
ClassStatistics class_statistics(const MatrixXd& values, const std::vector<bool>& truth, const std::vector<std::size_t>& rows) {
    ClassStatistics statistics{{VectorXd::Zero(values.cols()), VectorXd::Zero(values.cols())},
                               MatrixXd::Zero(values.cols(), values.cols())};
    for (const std::size_t row : rows) {
        const int class_index = truth[row] ? 1 : 0;
        statistics.mean[class_index] += values.row(static_cast<Eigen::Index>(row)).transpose();
        ++statistics.count[class_index];
    }
    for (int class_index = 0; class_index < 2; ++class_index)
        statistics.mean[class_index] /= static_cast<double>(std::max<std::size_t>(statistics.count[class_index], 1));
    for (const std::size_t row : rows) {
        const VectorXd deviation_from_mean =
            values.row(static_cast<Eigen::Index>(row)).transpose() - statistics.mean[truth[row] ? 1 : 0];
        statistics.scatter += deviation_from_mean * deviation_from_mean.transpose();
    }
    statistics.scatter /= std::max(1.0, static_cast<double>(rows.size()) - 2);
    return statistics;
}

}  // namespace

TechniqueModel learn(const MatrixXd& values, const std::vector<bool>& truth, const std::vector<std::size_t>& rows) {
    const ClassStatistics statistics = class_statistics(values, truth, rows);
    TechniqueModel model;
    if (values.cols() == 1) {
        std::vector<double> x;
        std::vector<bool> row_truth;
        for (const std::size_t row : rows)
            x.push_back(values(static_cast<Eigen::Index>(row), 0)), row_truth.push_back(truth[row]);
        model.threshold = best_threshold(x, row_truth, Side::either);
        const double deviation = std::max(std::sqrt(statistics.scatter(0, 0)), 1e-300);
        model.weights = VectorXd::Constant(1, (model.threshold->above ? 1 : -1) / deviation);
        model.middle = VectorXd::Constant(1, model.threshold->value);
        return model;
    }
    // Fisher's discriminant (1936) of standardised columns. A twentieth of the identity is added so that nearly equal columns
    // do not get large opposite weights.
    const VectorXd column_scale = statistics.scatter.diagonal().cwiseSqrt().cwiseMax(1e-12);
    const MatrixXd standard =
        column_scale.cwiseInverse().asDiagonal() * statistics.scatter * column_scale.cwiseInverse().asDiagonal();
    const MatrixXd regularised = standard + 0.05 * MatrixXd::Identity(values.cols(), values.cols());
    const VectorXd mean_difference = (statistics.mean[1] - statistics.mean[0]).cwiseQuotient(column_scale);
    model.weights = solve_ldlt<Eigen::Dynamic>(regularised, mean_difference).cwiseQuotient(column_scale);
    const double deviation = std::sqrt(std::max(model.weights.dot(statistics.scatter * model.weights), 0.0));
    if (deviation > 1e-300) model.weights /= deviation;
    model.middle = 0.5 * (statistics.mean[0] + statistics.mean[1]);
    // The threshold is where F1 is best, as for a single descriptor.
    std::vector<double> scores;
    std::vector<bool> row_truth;
    for (const std::size_t row : rows) {
        scores.push_back(model.score(values.row(static_cast<Eigen::Index>(row))));
        row_truth.push_back(truth[row]);
    }
    model.limit = best_threshold(scores, row_truth, Side::above).value;
    return model;
}

}  // namespace ostraka
