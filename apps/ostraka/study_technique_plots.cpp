// Plots of a study of technique.
#include "study_technique_report.h"

#include "ostraka/report/plot.h"
#include "ostraka/report/table.h"

#include <algorithm>
#include <cmath>

namespace ostraka::app {

namespace {

/// Objects by two descriptors, in classes by label (or answer, where no labels are known).
void draw_scatter(const StudyFiles& files, const TechniqueStudy& study, const std::vector<TechniqueObject>& objects,
                  const std::string& file, const std::string& title, const std::string& x, const std::string& y,
                  bool logarithmic) {
    Plot plot;
    plot.title = title;
    plot.x = {x, logarithmic};
    plot.y = {y, true};
    std::vector<std::string> classes{study.positive, study.negative, study.learned ? "not known" : "no answer"};
    for (std::size_t c = 0; c < classes.size(); ++c) {
        PlotSeries series;
        series.name = classes[c];
        series.joined = false;
        for (std::size_t i = 0; i < objects.size(); ++i) {
            const std::string& kind = study.learned ? objects[i].label : study.answers[i].answer;
            const std::size_t number = kind == study.positive ? 0 : kind == study.negative ? 1 : 2;
            const double a = objects[i].measures.value(x), b = objects[i].measures.value(y);
            if (number != c || !std::isfinite(a) || !std::isfinite(b) || b <= 0 || (a <= 0 && logarithmic)) continue;
            series.points.push_back({a, b});
            // Names of those to look at only.
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
    draw_scatter(files, study, objects, "roundness", "Roundness over the lower slices, relative to the radius", "roundness mean",
                 "roundness variance", true);
    draw_scatter(files, study, objects, "eccentricity", "Eccentricity over the lower slices", "eccentricity mean",
                 "eccentricity variance", false);
    draw_scatter(files, study, objects, "ovality", "Ovality and finger marks, relative to the radius", "ovality", "marks", true);
    if (!study.learned) return;
    Plot bars;
    bars.title = "F1 of " + study.positive + " under cross-validation; 95 % over objects drawn anew";
    bars.y = {"F1"};
    bars.y.minimum = 0;
    bars.y.maximum = 1;
    bars.width = 980;
    bars.height = 560;
    PlotSeries series;
    series.joined = false;
    series.mark = Mark::bars;
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

    Plot roc;
    roc.title = "Receiver operating characteristics";
    roc.x = {"hand-made taken for wheel-made"};
    roc.x.label = "share of " + study.negative + " called " + study.positive;
    roc.y = {"share of " + study.positive + " called so"};
    roc.x.minimum = roc.y.minimum = 0;
    roc.x.maximum = roc.y.maximum = 1;
    roc.square = true;
    roc.width = 760;
    roc.height = 560;
    for (const ClassifierResult& each : study.classifiers) {
        const auto& name = each.classifier.name;
        if (!each.validated || (name != "roundness" && name != "eccentricity" && name != "both" && name != "outside")) continue;
        PlotSeries curve;
        curve.name = name + " (area " + fixed(each.roc.area, 3) + ")";
        curve.marked = false;
        // Thinner from curve to curve, so that each is seen where they coincide.
        curve.thickness = 7.5 - 2 * static_cast<double>(roc.series.size());
        for (const RocPoint& point : each.roc.points)
            curve.points.push_back({point.false_positive_rate, point.true_positive_rate});
        roc.series.push_back(std::move(curve));
    }
    if (!roc.series.empty()) write_plot(files.plot("roc"), roc);
}

}  // namespace ostraka::app
