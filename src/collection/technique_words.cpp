#include "technique_words.h"

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
std::string percent_of_radius(double share) { return digits("%.2f %% of the radius", 100 * share); }

std::string how_sure(double agreement) { return agreement >= 0.95 ? "clear" : agreement >= 0.8 ? "likely" : "doubtful"; }

/// A descriptor's value beside its threshold, and the side of it; nothing where it is not known.
std::string beside(const TechniqueStudy& study, const TechniqueObject& object, const std::string& classifier,
                   const std::string& words, bool relative) {
    for (const ClassifierResult& each : study.classifiers) {
        if (each.classifier.name != classifier || !each.threshold) continue;
        const double value = object.measures.value(each.classifier.descriptors.front());
        if (!std::isfinite(value)) return {};
        const auto shown = [&](double x) { return relative ? percent_of_radius(x) : digits("%.4g", x); };
        return words + " " + shown(value) + " (threshold " + shown(each.threshold->value) + ": as " +
               (each.threshold->positive(value) ? study.positive : study.negative) + ")";
    }
    return {};
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
                                                        {"roundness variance", "its variance"},
                                                        {"eccentricity", "eccentricity in the mean"},
                                                        {"eccentricity variance", "its variance"}};
    for (const auto& [classifier, words] : list) {
        const std::string part = beside(study, object, classifier, words, classifier == "roundness");
        if (!part.empty()) text += (text.empty() ? "" : "; ") + part;
    }
    if (answer.answer.empty())
        return text + "; no answer by '" + study.answered_by + "': it needs descriptors that are not known here";
    text += "; by '" + study.answered_by + "' " + answer.answer + ", " + digits("%.2g", std::abs(answer.score)) +
            " standard deviations from the limit; " +
            std::to_string(static_cast<int>(std::lround(answer.agreement * answer.asked))) + " of " +
            std::to_string(answer.asked) + " resampled collections agree: " + how_sure(answer.agreement);
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
