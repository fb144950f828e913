// Explanations of the answers of a technique study.
#include "collection/technique_model.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace ostraka {

namespace {

std::string digits(const char* pattern, double value) {
    char text[64];
    std::snprintf(text, sizeof text, pattern, value);
    return text;
}
std::string percent_of_radius(double fraction) { return digits("%.3g %% of the radius", 100 * fraction); }

/// A descriptor's value for display: variances as deviations, lengths in per cent of the radius.
std::string display_value(const std::string& descriptor, double value) {
    const bool variance = descriptor.ends_with("variance");
    const double number = variance ? std::sqrt(std::max(value, 0.0)) : value;
    if (descriptor == "coherence" || descriptor == "eccentricity mean") return digits("%.3f", number);
    if (descriptor == "eccentricity variance") return digits("%.2g", number);
    if (descriptor == "wall variation") return digits("%.2g %% of the thickness", 100 * number);
    return percent_of_radius(number);
}
std::string name_of(const std::string& descriptor) {
    if (descriptor.ends_with(" variance")) return "deviation of " + descriptor.substr(0, descriptor.size() - 9);
    if (descriptor.ends_with(" mean")) return descriptor.substr(0, descriptor.size() - 5) + " in the mean";
    return descriptor;
}

/// A descriptor's value with its threshold and side; empty if unknown.
std::string threshold_words(const TechniqueStudy& study, const TechniqueObject& object, const std::string& classifier,
                            const std::string& words) {
    for (const ClassifierResult& classifier_result : study.classifiers) {
        if (classifier_result.classifier.name != classifier || !classifier_result.threshold) continue;
        const std::string& descriptor = classifier_result.classifier.descriptors.front();
        const double value = object.measures.value(descriptor);
        if (!std::isfinite(value)) return {};
        return fmt::format("{} {} (threshold {}: as {})", words, display_value(descriptor, value),
                           display_value(descriptor, classifier_result.threshold->value),
                           classifier_result.threshold->positive(value) ? study.positive : study.negative);
    }
    return {};
}

std::string outlier_words(const TechniqueOutlier& unlike) {
    return fmt::format(
        "unlike the labelled objects, so that no answer is given: {} {}, theirs from {} to {} ({} robust standard deviations "
        "outside)",
        name_of(unlike.descriptor), display_value(unlike.descriptor, unlike.value), display_value(unlike.descriptor, unlike.low),
        display_value(unlike.descriptor, unlike.high), digits("%.0f", unlike.distance));
}

std::string verdict(const TechniqueStudy& study, const TechniqueAnswer& answer, const std::string& classifier_words) {
    if (answer.outlier) return outlier_words(*answer.outlier);
    if (answer.certainty == "not told apart")
        return fmt::format("no answer: {} does not distinguish {} from {} here", classifier_words, study.positive,
                           study.negative);
    const std::string agreement_words =
        fmt::format("{} of {} resampled collections agree: {}", static_cast<int>(std::lround(answer.agreement * answer.asked)),
                    answer.asked, answer.certainty);
    const std::string distance_from_limit = digits("%.2g", std::abs(answer.score)) + " standard deviations from the limit";
    if (answer.answer.empty())
        return fmt::format("by {} nearer to {}, {}, but only {}", classifier_words,
                           answer.positive ? study.positive : study.negative, distance_from_limit, agreement_words);
    return fmt::format("by {} {}, {}; {}", classifier_words, answer.answer, distance_from_limit, agreement_words);
}

std::string explain(const TechniqueStudy& study, const TechniqueObject& object, const TechniqueAnswer& answer) {
    const double roundness = object.measures.value("roundness mean");
    std::string text;
    if (!study.learned) {
        for (const TechniqueSplit& split : study.splits) {
            if (split.descriptor != study.answered_by) continue;
            text = fmt::format("roundness {} in the mean; ", percent_of_radius(roundness));
            if (!study.separated)
                return fmt::format(
                    "{}the collection does not fall into two groups by {}{}", text, study.answered_by,
                    split.objects < 4 ? " (fewer than four objects)" : fmt::format(" (p = {})", digits("%.2g", split.p_value)));
            if (answer.answer.empty()) return fmt::format("{}no answer: {} is not known", text, study.answered_by);
            return fmt::format("{}the {} one of two groups by {} (p = {}){}", text, answer.answer, study.answered_by,
                               digits("%.2g", split.p_value),
                               answer.positive ? ", as wheel-made bodies are" : ", as hand-made bodies are");
        }
        return text;
    }
    const std::pair<std::string, std::string> shown_classifiers[] = {{"roundness", "roundness in the mean"},
                                                                     {"roundness variance", "its deviation over the slices"},
                                                                     {"eccentricity", "eccentricity in the mean"},
                                                                     {"eccentricity variance", "its deviation"}};
    for (const auto& [classifier, words] : shown_classifiers) {
        const std::string part = threshold_words(study, object, classifier, words);
        if (!part.empty()) text += (text.empty() ? "" : "; ") + part;
    }
    std::string classifier_words = study.answered_by;
    for (const ClassifierResult& classifier_result : study.classifiers)
        if (classifier_result.classifier.name == study.answered_by) classifier_words = classifier_result.classifier.words;
    if (answer.certainty.empty())
        return fmt::format("{}{}no answer by {}: it needs descriptors that are not known for this object", text,
                           text.empty() ? "" : "; ", classifier_words);
    text += "; " + verdict(study, answer, classifier_words);
    if (answer.answer.empty()) return text;
    for (const ClassifierResult& classifier_result : study.classifiers) {
        if (classifier_result.classifier.name != "roundness" || !classifier_result.threshold || !answer.roundness) continue;
        if (answer.roundness->low < classifier_result.threshold->value &&
            answer.roundness->high > classifier_result.threshold->value)
            text += "; the variation over its slices leaves the roundness on either side of the threshold";
    }
    return text;
}

}  // namespace

void explain_answers(TechniqueStudy& study, const std::vector<TechniqueObject>& objects) {
    for (std::size_t i = 0; i < objects.size(); ++i) study.answers[i].words = explain(study, objects[i], study.answers[i]);
}

}  // namespace ostraka
