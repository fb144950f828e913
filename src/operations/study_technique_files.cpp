#include "study_technique_files.h"

#include "ostraka/report/plot.h"
#include "ostraka/report/table.h"

#include <cmath>

namespace ostraka {

std::string answering_words(const TechniqueStudy& study) {
    for (const ClassifierResult& each : study.classifiers)
        if (each.classifier.name == study.answered_by) return each.classifier.words;
    return study.answered_by;
}

void write_technique_tables(const StudyFiles& files, const TechniqueStudy& study, const std::vector<TechniqueObject>& objects) {
    std::vector<std::string> columns{"name", "label", "slices"};
    for (const DescriptorMeaning& each : technique_descriptors()) columns.push_back(each.name);
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
        for (const ClassifierResult& each : study.classifiers) {
            const auto value = [&](double x) { return fixed_cell(each.validated ? std::optional(x) : std::nullopt, 3); };
            std::vector<TableCell> cells{each.classifier.name,
                                         std::to_string(each.objects),
                                         value(each.validation.mean_f1),
                                         value(each.f1_interval.low),
                                         value(each.f1_interval.high),
                                         value(each.trivial_f1),
                                         !each.validated ? ""
                                         : each.better   ? "yes"
                                                         : "no",
                                         value(each.validation.mean_precision),
                                         value(each.validation.mean_recall),
                                         value(each.roc.area)};
            cells.emplace_back(!each.threshold ? "" : each.threshold->above ? "from" : "up to");
            cells.push_back(number_cell(each.threshold ? std::optional(each.threshold->value) : std::nullopt, 4));
            classifiers.add(cells);
        }
        classifiers.write(folder, "classifiers", "F1 of " + study.positive + " under cross-validation");
    }
    TextTable divisions({"descriptor", "objects", "lower", "upper", "threshold", "share between", "p", "F1"});
    for (const TechniqueSplit& each : study.splits)
        divisions.add({each.descriptor, std::to_string(each.objects), std::to_string(each.lower),
                       std::to_string(each.objects - each.lower), number_cell(each.threshold, 4), fixed_cell(each.share, 3),
                       number_cell(each.p_value, 2), fixed_cell(each.f1, 3)});
    divisions.write(folder, "divisions", "Divisions into two groups without known answers");

    TextTable answers({"name", "label", "answer", "certainty", "against the label", "score", "agreement", "why"});
    for (const TechniqueAnswer& each : study.answers) {
        const bool certain = study.learned && !each.certainty.empty();
        const auto value = [&](double x) { return fixed_cell(certain ? std::optional(x) : std::nullopt, 2); };
        const char* against = each.label.empty() || each.answer.empty() ? "" : each.wrong() ? "WRONG" : "right";
        answers.add(
            {each.name, each.label, each.answer, each.certainty, against, value(each.score), value(each.agreement), each.words});
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
            const std::size_t number = kind == study.positive ? 0 : kind == study.negative ? 1 : 2;
            const double a = objects[i].measures.value(x), b = objects[i].measures.value(y);
            if (number != c || !std::isfinite(a) || !std::isfinite(b) || b <= 0 || (a <= 0 && logarithmic)) continue;
            series.points.push_back({a, b});
            // Name only the objects that need attention.
            series.labels.push_back(study.answers[i].wrong() || study.answers[i].unlike ? objects[i].name : "");
        }
        if (!series.points.empty()) plot.series.push_back(std::move(series));
    }
    if (plot.series.empty()) return;
    for (const ClassifierResult& each : study.classifiers) {
        if (!each.threshold) continue;
        if (each.classifier.descriptors.front() == x) plot.lines.push_back({each.threshold->value, true, "threshold"});
        if (each.classifier.descriptors.front() == y) plot.lines.push_back({each.threshold->value, false, "threshold"});
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
    Plot bars{.title = "F1 of " + study.positive + " under cross-validation; 95 % over objects drawn anew",
              .y = {.label = "F1", .minimum = 0, .maximum = 1},
              .width = 980,
              .height = 560};
    PlotSeries series{.joined = false, .mark = Mark::bars};
    for (const ClassifierResult& each : study.classifiers) {
        if (!each.validated) continue;
        bars.x.names.push_back(each.classifier.name);
        series.points.push_back({static_cast<double>(series.points.size()), each.validation.mean_f1});
        series.intervals.emplace_back(std::array<double, 2>{each.f1_interval.low, each.f1_interval.high});
        if (each.classifier.name == study.answered_by)
            bars.lines.push_back({each.trivial_f1, false, "all called " + study.positive});
    }
    if (series.points.empty()) return;
    bars.series.push_back(std::move(series));
    write_plot(files.plot("classifiers"), bars);

    Plot roc{.title = "Receiver operating characteristics",
             .x = {.label = "share of " + study.negative + " called " + study.positive, .minimum = 0, .maximum = 1},
             .y = {.label = "share of " + study.positive + " called so", .minimum = 0, .maximum = 1},
             .width = 760,
             .height = 560,
             .square = true};
    for (const ClassifierResult& each : study.classifiers) {
        const auto& name = each.classifier.name;
        if (!each.validated || (name != "roundness" && name != "eccentricity" && name != "both" && name != "outside")) continue;
        PlotSeries curve{.name = name + " (area " + fixed(each.roc.area, 3) + ")", .marked = false};
        // Decreasing line width keeps coinciding curves visible.
        curve.thickness = 7.5 - 2 * static_cast<double>(roc.series.size());
        for (const RocPoint& point : each.roc.points)
            curve.points.push_back({point.false_positive_rate, point.true_positive_rate});
        roc.series.push_back(std::move(curve));
    }
    if (!roc.series.empty()) write_plot(files.plot("roc"), roc);
}

}  // namespace ostraka
