#include "ostraka/collection/technique_study.h"
#include "collection/technique_model.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/stats/random.h"
#include "ostraka/stats/summary.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace ostraka {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

const std::vector<std::string>& outside_descriptors() {
    static const std::vector<std::string> names{"ovality", "marks", "coherence", "straightness"};
    return names;
}
const std::string component_name = "first component";

/// The label whose objects have the smaller median roundness deviation.
std::string rounder_label(const std::vector<TechniqueObject>& objects, const std::set<std::string>& labels) {
    std::string best;
    double minimum = std::numeric_limits<double>::infinity();
    for (const auto& label : labels) {
        std::vector<double> values;
        for (const auto& object : objects)
            if (object.label == label) values.push_back(object.measures.value("roundness mean"));
        const double median = sample_quantile(values, 0.5, "roundness");
        if (median < minimum) minimum = median, best = label;
    }
    return best;
}

/// 95 % interval of the mean roundness from resampled blocks of a tenth of the slices (moving blocks, Kuensch 1989:
/// neighbouring slices are correlated).
std::optional<Interval> roundness_interval(const TechniqueMeasures& measures, std::uint64_t seed, std::size_t object) {
    const std::size_t count = measures.slices.size(), block = std::max<std::size_t>(1, count / 10);
    if (count < 2) return std::nullopt;
    Random random(seed, 1000000 + object);
    std::vector<double> means;
    for (int i = 0; i < 400; ++i) {
        double sum = 0;
        for (std::size_t resampled = 0; resampled < count;) {
            const std::size_t start = random.below(count - block + 1);
            for (std::size_t k = 0; k < block && resampled < count; ++k, ++resampled) sum += measures.slices[start + k].roundness;
        }
        means.push_back(sum / static_cast<double>(count));
    }
    return Interval{sample_quantile(means, 0.025), sample_quantile(means, 0.975)};
}

/// Certainty of an answer: the agreement measures how stable it is, the classifier's error how often stable answers are wrong.
std::string certainty_of(const TechniqueAnswer& answer, const ClassifierResult& classifier) {
    if (answer.outlier) return "unlike";
    if (!classifier.better) return "not told apart";
    if (answer.agreement < 0.5) return "undecided";
    if (answer.agreement >= 0.95 && classifier.error <= 0.05) return "clear";
    return answer.agreement >= 0.8 && classifier.error <= 0.2 ? "likely" : "doubtful";
}

/// Answers of the chosen classifier; each object is classified by a model trained without it.
void answer_learned(TechniqueStudy& study, const std::vector<TechniqueObject>& objects, const ClassifierResult& chosen,
                    const TechniqueStudyOptions& options) {
    const DescriptorTable table = descriptor_table(objects, chosen.classifier.descriptors);
    const Labelled labelled_rows = labelled(objects, table, study.positive);
    if (!labelled_rows.enough()) return;
    study.separated = chosen.better;
    const std::size_t rows = table.objects.size();
    std::vector<TechniqueModel> models(rows);
    parallel_for(rows, 8, [&](std::size_t row) {
        std::vector<std::size_t> training_rows = labelled_rows.rows;
        std::erase(training_rows, row);
        models[row] = learn(table.values, labelled_rows.truth, training_rows);
    });
    // Bootstrap: each class is resampled with replacement to its original size.
    std::vector<std::vector<std::int8_t>> votes(static_cast<std::size_t>(options.resamples));
    std::vector<std::size_t> class_rows[2];
    for (const std::size_t row : labelled_rows.rows) class_rows[labelled_rows.truth[row] ? 1 : 0].push_back(row);
    parallel_for(votes.size(), 8, [&](std::size_t i) {
        Random random(options.seed, i);
        std::vector<std::size_t> drawn;
        std::vector<bool> is_drawn(rows, false);
        for (const auto& rows_of_class : class_rows)
            for (const std::size_t sample : random.resample(rows_of_class.size())) {
                drawn.push_back(rows_of_class[sample]);
                is_drawn[rows_of_class[sample]] = true;
            }
        const TechniqueModel model = learn(table.values, labelled_rows.truth, drawn);
        votes[i].assign(rows, -1);
        for (std::size_t row = 0; row < rows; ++row)
            if (!is_drawn[row]) votes[i][row] = model.score(table.values.row(static_cast<Eigen::Index>(row))) >= 0 ? 1 : 0;
    });
    const auto unlike = technique_outliers(objects, study.positive, options.min_outlier_distance);
    for (std::size_t row = 0; row < rows; ++row) {
        TechniqueAnswer& answer = study.answers[table.objects[row]];
        answer.score = models[row].score(table.values.row(static_cast<Eigen::Index>(row)));
        answer.positive = answer.score >= 0;
        answer.answer = answer.positive ? study.positive : study.negative;
        int agreeing_votes = 0;
        for (const auto& vote : votes) {
            if (vote[row] < 0) continue;
            ++answer.asked;
            if ((vote[row] == 1) == answer.positive) ++agreeing_votes;
        }
        answer.agreement = answer.asked > 0 ? static_cast<double>(agreeing_votes) / answer.asked : 0;
        answer.outlier = unlike[table.objects[row]];
        answer.certainty = certainty_of(answer, chosen);
        if (answer.certainty != "clear" && answer.certainty != "likely" && answer.certainty != "doubtful") answer.answer.clear();
    }
}

/// First principal component of the outside descriptors, standardised; it increases as objects become less round.
std::vector<double> first_component(const DescriptorTable& table) {
    const Eigen::Index n = table.values.rows();
    if (n < 2) return std::vector<double>(static_cast<std::size_t>(n), 0);
    MatrixXd X = table.values.rowwise() - table.values.colwise().mean();
    for (Eigen::Index k = 0; k < X.cols(); ++k) {
        const double size = X.col(k).norm() / std::sqrt(static_cast<double>(n - 1));
        X.col(k) /= size > 1e-12 ? size : 1;
    }
    const SymmetricEigenX parts(X.transpose() * X);
    VectorXd axis = parts.eigenvectors().col(X.cols() - 1);
    if (axis[0] < 0) axis = -axis;  // increases with ovality
    const VectorXd y = X * axis;
    return {y.data(), y.data() + y.size()};
}

TechniqueSplit split_by(const std::vector<TechniqueObject>& objects, const std::string& descriptor, const std::string& positive,
                        const TechniqueStudyOptions& options) {
    TechniqueSplit split;
    split.descriptor = descriptor;
    split.group.assign(objects.size(), -1);
    const bool component = descriptor == component_name;
    const DescriptorTable table =
        descriptor_table(objects, component ? outside_descriptors() : std::vector<std::string>{descriptor});
    split.objects = table.objects.size();
    if (split.objects < 4) return split;
    std::vector<double> values = component ? first_component(table) : std::vector<double>();
    if (!component)
        for (Eigen::Index i = 0; i < table.values.rows(); ++i) values.push_back(table.values(i, 0));
    const TwoGroups groups = divide_in_two(values);
    split.share = groups.share;
    split.threshold = !component && table.logarithm ? std::exp(groups.threshold) : groups.threshold;
    for (std::size_t i = 0; i < values.size(); ++i) {
        split.group[table.objects[i]] = values[i] > groups.threshold ? 1 : 0;
        if (values[i] <= groups.threshold) ++split.lower;
    }
    std::vector<double> chance(static_cast<std::size_t>(options.simulations));
    parallel_for(chance.size(), 16, [&](std::size_t i) {
        Random random(options.seed, 2000000 + i);
        std::vector<double> simulated(values.size());
        for (double& value : simulated) value = random.normal();
        chance[i] = divide_in_two(std::move(simulated)).share;
    });
    split.p_value = split.share > 0 ? permutation_p_value(split.share, chance) : 1;
    ConfusionScores scores_by_side[2];
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (split.group[i] < 0 || objects[i].label.empty()) continue;
        for (int side = 0; side < 2; ++side) scores_by_side[side].add(split.group[i] == side, objects[i].label == positive);
    }
    const std::size_t positives = scores_by_side[0].true_positive + scores_by_side[0].false_negative;
    if (positives > 0 && positives < scores_by_side[0].count())
        split.f1 = std::max(scores_by_side[0].f1(), scores_by_side[1].f1());
    return split;
}

void answer_by_split(TechniqueStudy& study, const TechniqueSplit& split, const std::vector<TechniqueObject>& objects) {
    study.separated = split.p_value <= 0.05;
    if (!study.separated) return;
    // The group with the smaller median roundness deviation is the rounder one.
    std::vector<double> roundness[2];
    for (std::size_t i = 0; i < objects.size(); ++i)
        if (split.group[i] >= 0) roundness[split.group[i]].push_back(objects[i].measures.value("roundness mean"));
    const int rounder_group = sample_quantile(roundness[0], 0.5) <= sample_quantile(roundness[1], 0.5) ? 0 : 1;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (split.group[i] < 0) continue;
        TechniqueAnswer& answer = study.answers[i];
        answer.positive = split.group[i] == rounder_group;
        answer.answer = answer.positive ? study.positive : study.negative;
    }
}

}  // namespace

const std::vector<TechniqueClassifier>& technique_classifiers() {
    static const std::vector<TechniqueClassifier> classifiers{
        {"roundness", {"roundness mean"}, "roundness"},
        {"roundness variance", {"roundness variance"}, "the variance of roundness"},
        {"roundness mean and variance", {"roundness mean", "roundness variance"}, "roundness and its variance"},
        {"eccentricity", {"eccentricity mean"}, "eccentricity"},
        {"eccentricity variance", {"eccentricity variance"}, "the variance of eccentricity"},
        {"eccentricity mean and variance", {"eccentricity mean", "eccentricity variance"}, "eccentricity and its variance"},
        {"both means", {"roundness mean", "eccentricity mean"}, "mean roundness and mean eccentricity"},
        {"both",
         {"roundness mean", "roundness variance", "eccentricity mean", "eccentricity variance"},
         "roundness and eccentricity"},
        {"equivalent roundness", {"equivalent roundness mean"}, "equivalent roundness"},
        {"ovality", {"ovality"}, "ovality"},
        {"marks", {"marks"}, "finger marks"},
        {"coherence", {"coherence"}, "coherence"},
        {"straightness", {"straightness"}, "straightness"},
        {"upright straightness", {"upright straightness"}, "upright straightness"},
        {"wall variation", {"wall variation"}, "wall variation"},
        {"outside", {"ovality", "marks", "coherence", "straightness"}, "ovality, marks, coherence and straightness"},
        {"outside and wall",
         {"ovality", "marks", "coherence", "straightness", "wall variation"},
         "ovality, marks, coherence, straightness and wall variation"}};
    return classifiers;
}

TwoGroups divide_in_two(std::vector<double> values) {
    TwoGroups best;
    if (values.empty()) return best;
    std::sort(values.begin(), values.end());
    const double n = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double total = 0, sum = 0;
    for (const double value : values) total += (value - mean) * (value - mean);
    best.threshold = values.back();
    if (!(total > 0)) return best;
    for (std::size_t i = 0; i + 1 < values.size(); ++i) {
        sum += values[i] - mean;
        if (values[i + 1] == values[i]) continue;
        const double low = static_cast<double>(i + 1), high = n - low;
        const double between = sum * sum * (1 / low + 1 / high);
        if (between / total > best.share) best = {0.5 * (values[i] + values[i + 1]), between / total};
    }
    return best;
}

TechniqueStudy study_technique(const std::vector<TechniqueObject>& objects, const TechniqueStudyOptions& options) {
    check_options(options, "study technique");
    if (objects.empty()) fail_input("study technique", "no object remains to study");
    const auto& classifiers = technique_classifiers();
    const auto chosen =
        std::find_if(classifiers.begin(), classifiers.end(), [&](const auto& each) { return each.name == options.answer_by; });
    std::set<std::string> labels;
    for (const auto& object : objects)
        if (!object.label.empty()) labels.insert(object.label);
    if (labels.size() > 2)
        fail_input("study technique", fmt::format("there are {} different labels", labels.size()),
                   "use two labels, such as wheel and hand, and remove the labels of other objects");
    if (!options.positive.empty() && !labels.contains(options.positive))
        fail_usage(fmt::format("no object has the label '{}'", options.positive), "name one of the labels in the ground truth");

    TechniqueStudy study;
    study.learned = labels.size() == 2;
    study.positive = !options.positive.empty() ? options.positive : study.learned ? rounder_label(objects, labels) : "rounder";
    if (study.learned) study.negative = *labels.begin() == study.positive ? *labels.rbegin() : *labels.begin();
    else study.negative = "less round";
    for (std::size_t i = 0; i < objects.size(); ++i) {
        TechniqueAnswer& answer = study.answers.emplace_back();
        answer.name = objects[i].name;
        answer.label = objects[i].label;
        answer.roundness = roundness_interval(objects[i].measures, options.seed, i);
    }
    study.answered_by = chosen->name;
    std::vector<std::string> split_names{component_name};
    for (const DescriptorMeaning& each : technique_descriptors()) split_names.push_back(each.name);
    for (const auto& name : split_names) study.splits.push_back(split_by(objects, name, study.positive, options));
    if (study.learned) {
        for (const auto& classifier : classifiers)
            study.classifiers.push_back(validate_classifier(objects, classifier, study.positive, options));
        answer_learned(study, objects, study.classifiers[static_cast<std::size_t>(chosen - classifiers.begin())], options);
    } else {
        const std::string descriptor = chosen->name.starts_with("outside") ? component_name : chosen->descriptors.front();
        study.answered_by = descriptor;
        for (const TechniqueSplit& split : study.splits)
            if (split.descriptor == descriptor) answer_by_split(study, split, objects);
    }
    explain_answers(study, objects);
    return study;
}

void TechniqueStudyOptions::declare_options(OptionList& list) {
    list("positive", positive, "label of the positive class of F1; by default the label with the rounder bodies");
    std::vector<std::string> classifiers;
    for (const TechniqueClassifier& classifier : technique_classifiers()) classifiers.push_back(classifier.name);
    list("answer-by", answer_by, "classifier whose answer is reported for each object", Choices(std::move(classifiers)));
    list("folds", folds, "number of folds of the cross-validation of classifiers", Range{2, 1000});
    list("repeats", repeats, "number of times the division into folds is repeated", Range{1, 1000});
    list("resamples", resamples, "number of resampled collections from which each object is classified", Range{10, 100000});
    list("simulations", simulations,
         "number of simulated collections of one group, for the test whether a collection has two groups", Range{19, 100000});
    list("unlike-from", min_outlier_distance,
         "an object gets no answer if one of its descriptors is at least this distance from the collection, in robust standard "
         "deviations",
         Range{1, 1e6});
    list("seed", seed, "random seed", Range{0, 1e18});
}

}  // namespace ostraka
