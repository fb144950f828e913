#include "operations/study/technique_files.h"

#include "ostraka/figures/plot.h"
#include "ostraka/figures/table.h"

#include <fmt/core.h>

#include <cmath>

namespace ostraka {

std::string answering_words(const TechniqueStudy& study) {
    for (const ClassifierResult& result : study.classifiers)
        if (result.classifier.name == study.answered_by) return result.classifier.words;
    return study.answered_by;
}

void write_technique_tables(const StudyFiles& files, const TechniqueStudy& study, const std::vector<TechniqueObject>& objects) {
    std::vector<std::string> columns{"name", "label", "slices"};
    for (const DescriptorMeaning& meaning : technique_descriptors()) columns.push_back(meaning.name);
    TextTable descriptors(columns);
    for (const TechniqueObject& object : objects) {
        std::vector<TableCell> cells{object.name, object.label, std::to_string(object.measures.slices.size())};
        for (const TechniqueDescriptor& d : object.measures.descriptors) cells.push_back(number_cell(d.value, 4));
        descriptors.add(cells);
    }
    const Path folder = files.output.path();
    descriptors.write(folder, "descriptors", "Descriptors of technique");

    if (study.learned) {
        TextTable classifiers({"classifier", "objects", "F1", "from", "to", "F1 of all " + study.positive, "better", "precision",
                               "recall", "ROC area", "positive", "threshold"});
        for (const ClassifierResult& result : study.classifiers) {
            const auto value = [&](double x) { return fixed_cell(result.validated ? std::optional(x) : std::nullopt, 3); };
            std::vector<TableCell> cells{result.classifier.name,
                                         std::to_string(result.objects),
                                         value(result.validation.mean_f1),
                                         value(result.f1_interval.low),
                                         value(result.f1_interval.high),
                                         value(result.trivial_f1),
                                         !result.validated ? ""
                                         : result.better   ? "yes"
                                                           : "no",
                                         value(result.validation.mean_precision),
                                         value(result.validation.mean_recall),
                                         value(result.roc.area)};
            cells.emplace_back(!result.threshold ? "" : result.threshold->above ? "from" : "up to");
            cells.push_back(number_cell(result.threshold ? std::optional(result.threshold->value) : std::nullopt, 4));
            classifiers.add(cells);
        }
        classifiers.write(folder, "classifiers", fmt::format("F1 of {} under cross-validation", study.positive));
    }
    TextTable divisions({"descriptor", "objects", "lower", "upper", "threshold", "share between", "p", "F1"});
    for (const TechniqueSplit& split : study.splits)
        divisions.add({split.descriptor, std::to_string(split.objects), std::to_string(split.lower),
                       std::to_string(split.objects - split.lower), number_cell(split.threshold, 4), fixed_cell(split.share, 3),
                       number_cell(split.p_value, 2), fixed_cell(split.f1, 3)});
    divisions.write(folder, "divisions", "Divisions into two groups without known answers");

    TextTable answers({"name", "label", "answer", "certainty", "against the label", "score", "agreement", "why"});
    for (const TechniqueAnswer& answer : study.answers) {
        const bool certain = study.learned && !answer.certainty.empty();
        const auto value = [&](double x) { return fixed_cell(certain ? std::optional(x) : std::nullopt, 2); };
        const char* against = answer.label.empty() || answer.answer.empty() ? "" : answer.wrong() ? "WRONG" : "right";
        answers.add({answer.name, answer.label, answer.answer, answer.certainty, against, value(answer.score),
                     value(answer.agreement), answer.words});
    }
    answers.write(folder, "answers", "Answers by " + answering_words(study));
}

namespace {

/// Scatter plot of objects by two descriptors, coloured by label (or by answer, if no labels are known).
void draw_technique_scatter(const StudyFiles& files, const TechniqueStudy& study, const std::vector<TechniqueObject>& objects,
                            const std::string& file, const std::string& title, const std::string& x, const std::string& y,
                            bool logarithmic) {
    Plot plot{.title = title, .x = {x, logarithmic}, .y = {y, true}};
    std::vector<std::string> classes{study.positive, study.negative, study.learned ? "not known" : "no answer"};
    for (std::size_t c = 0; c < classes.size(); ++c) {
        PlotSeries series{.name = classes[c], .joined = false};
        for (std::size_t i = 0; i < objects.size(); ++i) {
            const std::string& kind = study.learned ? objects[i].label : study.answers[i].answer;
            const std::size_t group_index = kind == study.positive ? 0 : kind == study.negative ? 1 : 2;
            const double a = objects[i].measures.value(x), b = objects[i].measures.value(y);
            if (group_index != c || !std::isfinite(a) || !std::isfinite(b) || b <= 0 || (a <= 0 && logarithmic)) continue;
            series.points.push_back({a, b});
            // Name only the objects that need attention.
            series.labels.push_back(study.answers[i].wrong() || study.answers[i].outlier ? objects[i].name : "");
        }
        if (!series.points.empty()) plot.series.push_back(std::move(series));
    }
    if (plot.series.empty()) return;
    for (const ClassifierResult& result : study.classifiers) {
        if (!result.threshold) continue;
        if (result.classifier.descriptors.front() == x) plot.lines.push_back({result.threshold->value, true, "threshold"});
        if (result.classifier.descriptors.front() == y) plot.lines.push_back({result.threshold->value, false, "threshold"});
    }
    write_plot(files.plot(file), plot);
}

}  // namespace

void draw_technique(const StudyFiles& files, const TechniqueStudy& study, const std::vector<TechniqueObject>& objects) {
    draw_technique_scatter(files, study, objects, "roundness", "Roundness over the lower slices, relative to the radius",
                           "roundness mean", "roundness variance", true);
    draw_technique_scatter(files, study, objects, "eccentricity", "Eccentricity over the lower slices", "eccentricity mean",
                           "eccentricity variance", false);
    draw_technique_scatter(files, study, objects, "ovality", "Ovality and finger marks, relative to the radius", "ovality",
                           "marks", true);
    if (!study.learned) return;
    Plot bars{.title = fmt::format("F1 of {} under cross-validation; 95 % intervals over resampled objects", study.positive),
              .y = {.label = "F1", .minimum = 0, .maximum = 1},
              .width = 980,
              .height = 560};
    PlotSeries series{.joined = false, .mark = Mark::bars};
    for (const ClassifierResult& result : study.classifiers) {
        if (!result.validated) continue;
        bars.x.names.push_back(result.classifier.name);
        series.points.push_back({static_cast<double>(series.points.size()), result.validation.mean_f1});
        series.intervals.emplace_back(std::array<double, 2>{result.f1_interval.low, result.f1_interval.high});
        if (result.classifier.name == study.answered_by)
            bars.lines.push_back({result.trivial_f1, false, "all classified as " + study.positive});
    }
    if (series.points.empty()) return;
    bars.series.push_back(std::move(series));
    write_plot(files.plot("classifiers"), bars);

    Plot roc{.title = "Receiver operating characteristics",
             .x = {.label = fmt::format("fraction of {} classified as {}", study.negative, study.positive),
                   .minimum = 0,
                   .maximum = 1},
             .y = {.label = fmt::format("fraction of {} classified as such", study.positive), .minimum = 0, .maximum = 1},
             .width = 760,
             .height = 560,
             .square = true};
    for (const ClassifierResult& result : study.classifiers) {
        const auto& name = result.classifier.name;
        if (!result.validated || (name != "roundness" && name != "eccentricity" && name != "both" && name != "outside")) continue;
        PlotSeries curve{.name = fmt::format("{} (area {})", name, fixed(result.roc.area, 3)), .marked = false};
        // Decreasing line width keeps coinciding curves visible.
        curve.thickness = 7.5 - 2 * static_cast<double>(roc.series.size());
        for (const RocPoint& point : result.roc.points)
            curve.points.push_back({point.false_positive_rate, point.true_positive_rate});
        roc.series.push_back(std::move(curve));
    }
    if (!roc.series.empty()) write_plot(files.plot("roc"), roc);
}

}  // namespace ostraka
