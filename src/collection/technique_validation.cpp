// Accuracy of a classifier on held-out objects.
#include "collection/technique_model.h"

#include "ostraka/execution/parallel.h"
#include "ostraka/stats/random.h"
#include "ostraka/stats/summary.h"

#include <cmath>

namespace ostraka {

using Eigen::VectorXd;

Labelled labelled(const std::vector<TechniqueObject>& objects, const DescriptorTable& table, const std::string& positive) {
    Labelled result;
    for (std::size_t row = 0; row < table.objects.size(); ++row) {
        const std::string& label = objects[table.objects[row]].label;
        result.truth.push_back(label == positive);
        if (!label.empty()) result.rows.push_back(row);
    }
    return result;
}

namespace {

/// Sets F1 with its interval, the F1 of classifying everything as positive, and the error rate.
void judge(ClassifierResult& result, const std::vector<bool>& truth, const TechniqueStudyOptions& options) {
    std::vector<std::size_t> kinds[2];
    for (std::size_t i = 0; i < truth.size(); ++i) kinds[truth[i] ? 1 : 0].push_back(i);
    const auto count = static_cast<double>(truth.size()), positives = static_cast<double>(kinds[1].size());
    result.trivial_f1 = 2 * positives / (positives + count);
    result.error = ((1 - result.validation.mean_accuracy) * count + 1) / (count + 2);
    std::vector<double> f1(1000);
    parallel_for(f1.size(), 32, [&](std::size_t i) {
        Random random(options.seed, 3000000 + i);
        std::vector<std::size_t> drawn;
        for (const auto& kind : kinds)
            for (const std::size_t sample : random.resample(kind.size())) drawn.push_back(kind[sample]);
        for (const auto& answers : result.validation.answers) {
            ConfusionScores scores;
            for (const std::size_t sample : drawn) scores.add(answers[sample], truth[sample]);
            f1[i] += scores.f1() / static_cast<double>(result.validation.answers.size());
        }
    });
    result.f1_interval = {std::min(1.0, sample_quantile(f1, 0.025)), std::min(1.0, sample_quantile(f1, 0.975))};
    result.better = result.f1_interval.low > result.trivial_f1;
}

}  // namespace

ClassifierResult validate_classifier(const std::vector<TechniqueObject>& objects, const TechniqueClassifier& classifier,
                                     const std::string& positive, const TechniqueStudyOptions& options) {
    ClassifierResult result;
    result.classifier = classifier;
    const DescriptorTable table = descriptor_table(objects, classifier.descriptors);
    const Labelled labelled_rows = labelled(objects, table, positive);
    result.objects = labelled_rows.rows.size();
    if (!labelled_rows.enough()) return result;
    result.validated = true;
    const auto rows_of = [&](const std::vector<std::size_t>& samples) {
        std::vector<std::size_t> rows;
        for (const std::size_t sample : samples) rows.push_back(labelled_rows.rows[sample]);
        return rows;
    };
    std::vector<bool> truth;
    for (const std::size_t row : labelled_rows.rows) truth.push_back(labelled_rows.truth[row]);
    const CrossValidationOptions folds{.folds = options.folds, .repeats = options.repeats, .seed = options.seed};
    result.validation = cross_validate(
        truth,
        [&](const std::vector<std::size_t>& training_samples, const std::vector<std::size_t>& test_samples) {
            const TechniqueModel model = learn(table.values, labelled_rows.truth, rows_of(training_samples));
            std::vector<bool> answers;
            for (const std::size_t row : rows_of(test_samples)) {
                const double x = table.values(static_cast<Eigen::Index>(row), 0);
                answers.push_back(model.threshold ? model.threshold->positive(x)
                                                  : model.score(table.values.row(static_cast<Eigen::Index>(row))) >= 0);
            }
            return answers;
        },
        folds);
    std::vector<double> scores(labelled_rows.rows.size());
    const TechniqueModel full_model = learn(table.values, labelled_rows.truth, labelled_rows.rows);
    parallel_for(scores.size(), 8, [&](std::size_t i) {
        if (full_model.threshold) {
            scores[i] =
                (full_model.threshold->above ? 1 : -1) * table.values(static_cast<Eigen::Index>(labelled_rows.rows[i]), 0);
            return;
        }
        std::vector<std::size_t> training_rows = labelled_rows.rows;
        training_rows.erase(training_rows.begin() + static_cast<std::ptrdiff_t>(i));
        // Held-out weights, but a common threshold: a threshold trained without an object shifts against its label.
        const VectorXd x = table.values.row(static_cast<Eigen::Index>(labelled_rows.rows[i]));
        scores[i] = learn(table.values, labelled_rows.truth, training_rows).weights.dot(x - full_model.middle);
    });
    judge(result, truth, options);
    result.roc = roc_curve(scores, truth);
    result.threshold = full_model.threshold;
    if (result.threshold && table.logarithm) result.threshold->value = std::exp(result.threshold->value);
    return result;
}

}  // namespace ostraka
