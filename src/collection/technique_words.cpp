// Explanations of the answers of a technique study.
#include "technique_model.h"

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
std::string percent_of_radius(double share) { return digits("%.3g %% of the radius", 100 * share); }

/// A descriptor's value for display: variances as deviations, lengths in per cent of the radius.
std::string shown(const std::string& descriptor, double value) {
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
std::string beside(const TechniqueStudy& study, const TechniqueObject& object, const std::string& classifier,
                   const std::string& words) {
    for (const ClassifierResult& each : study.classifiers) {
        if (each.classifier.name != classifier || !each.threshold) continue;
        const std::string& descriptor = each.classifier.descriptors.front();
        const double value = object.measures.value(descriptor);
        if (!std::isfinite(value)) return {};
        return words + " " + shown(descriptor, value) + " (threshold " + shown(descriptor, each.threshold->value) + ": as " +
               (each.threshold->positive(value) ? study.positive : study.negative) + ")";
    }
    return {};
}

std::string unlike_words(const TechniqueOutlier& unlike) {
    return "unlike the labelled objects, so that no answer is given: " + name_of(unlike.descriptor) + " " +
           shown(unlike.descriptor, unlike.value) + ", theirs from " + shown(unlike.descriptor, unlike.low) + " to " +
           shown(unlike.descriptor, unlike.high) + " (" + digits("%.0f", unlike.distance) +
           " robust standard deviations outside)";
}

std::string verdict(const TechniqueStudy& study, const TechniqueAnswer& answer, const std::string& by) {
    if (answer.unlike) return unlike_words(*answer.unlike);
    if (answer.certainty == "not told apart")
        return "no answer: " + by + " does not tell " + study.positive + " from " + study.negative + " here";
    const std::string agree = std::to_string(static_cast<int>(std::lround(answer.agreement * answer.asked))) + " of " +
                              std::to_string(answer.asked) + " resampled collections agree: " + answer.certainty;
    const std::string away = digits("%.2g", std::abs(answer.score)) + " standard deviations from the limit";
    if (answer.answer.empty())
        return "by " + by + " nearer to " + (answer.positive ? study.positive : study.negative) + ", " + away + ", but only " +
               agree;
    return "by " + by + " " + answer.answer + ", " + away + "; " + agree;
}

std::string explain(const TechniqueStudy& study, const TechniqueObject& object, const TechniqueAnswer& answer) {
    const double roundness = object.measures.value("roundness mean");
    std::string text;
    if (!study.learned) {
        for (const TechniqueSplit& split : study.splits) {
            if (split.descriptor != study.answered_by) continue;
            text = "roundness " + percent_of_radius(roundness) + " in the mean; ";
            if (!study.separated)
                return text + "the collection does not fall into two groups by " + study.answered_by +
                       (split.objects < 4 ? " (fewer than four objects)" : " (p = " + digits("%.2g", split.p_value) + ")");
            if (answer.answer.empty()) return text + "no answer: " + study.answered_by + " is not known";
            return text + "the " + answer.answer + " one of two groups by " + study.answered_by +
                   " (p = " + digits("%.2g", split.p_value) + ")" +
                   (answer.positive ? ", as wheel-made bodies are" : ", as hand-made bodies are");
        }
        return text;
    }
    const std::pair<std::string, std::string> list[] = {{"roundness", "roundness in the mean"},
                                                        {"roundness variance", "its deviation over the slices"},
                                                        {"eccentricity", "eccentricity in the mean"},
                                                        {"eccentricity variance", "its deviation"}};
    for (const auto& [classifier, words] : list) {
        const std::string part = beside(study, object, classifier, words);
        if (!part.empty()) text += (text.empty() ? "" : "; ") + part;
    }
    std::string by = study.answered_by;
    for (const ClassifierResult& each : study.classifiers)
        if (each.classifier.name == study.answered_by) by = each.classifier.words;
    if (answer.certainty.empty())
        return text + (text.empty() ? "" : "; ") + "no answer by " + by + ": it needs descriptors that are not known here";
    text += "; " + verdict(study, answer, by);
    if (answer.answer.empty()) return text;
    for (const ClassifierResult& each : study.classifiers) {
        if (each.classifier.name != "roundness" || !each.threshold || !answer.roundness) continue;
        if (answer.roundness->low < each.threshold->value && answer.roundness->high > each.threshold->value)
            text += "; its own slices leave the roundness on either side of the threshold";
    }
    return text;
}

}  // namespace

void explain_answers(TechniqueStudy& study, const std::vector<TechniqueObject>& objects) {
    for (std::size_t i = 0; i < objects.size(); ++i) study.answers[i].words = explain(study, objects[i], study.answers[i]);
}

}  // namespace ostraka
