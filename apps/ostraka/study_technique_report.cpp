#include "study_technique_report.h"

#include "ostraka/report/plot.h"
#include "ostraka/report/table.h"

#include <algorithm>
#include <cmath>

namespace ostraka::app {

namespace {

JsonValue number_or_null(double value) { return std::isfinite(value) ? JsonValue(value) : JsonValue(rapidjson::kNullType); }
JsonValue whole(std::size_t value) { return JsonValue(static_cast<std::uint64_t>(value)); }

JsonValue classifier_entry(const ClassifierResult& each, JsonAllocator& allocator) {
    JsonValue entry(rapidjson::kObjectType), descriptors(rapidjson::kArrayType);
    add_member(entry, "name", each.classifier.name, allocator);
    for (const auto& name : each.classifier.descriptors) descriptors.PushBack(json_string(name, allocator), allocator);
    add_member(entry, "descriptors", std::move(descriptors), allocator);
    add_member(entry, "objects", whole(each.objects), allocator);
    if (!each.validated) return entry;
    JsonValue roc(rapidjson::kArrayType);
    for (const RocPoint& point : each.roc.points) {
        JsonValue pair(rapidjson::kArrayType);
        pair.PushBack(point.false_positive_rate, allocator).PushBack(point.true_positive_rate, allocator);
        roc.PushBack(pair, allocator);
    }
    add_member(entry, "f1", JsonValue(each.validation.mean_f1), allocator);
    add_member(entry, "f1Deviation", JsonValue(each.validation.deviation), allocator);
    add_member(entry, "precision", JsonValue(each.validation.first.precision()), allocator);
    add_member(entry, "recall", JsonValue(each.validation.first.recall()), allocator);
    add_member(entry, "area", JsonValue(each.roc.area), allocator);
    if (each.threshold) {
        add_member(entry, "threshold", JsonValue(each.threshold->value), allocator);
        add_member(entry, "positiveAbove", JsonValue(each.threshold->above), allocator);
    }
    add_member(entry, "roc", std::move(roc), allocator);
    return entry;
}

JsonValue split_entry(const TechniqueSplit& each, JsonAllocator& allocator) {
    JsonValue entry(rapidjson::kObjectType);
    add_member(entry, "descriptor", each.descriptor, allocator);
    add_member(entry, "objects", whole(each.objects), allocator);
    add_member(entry, "lower", whole(each.lower), allocator);
    add_member(entry, "threshold", JsonValue(each.threshold), allocator);
    add_member(entry, "shareBetween", JsonValue(each.share), allocator);
    add_member(entry, "p", JsonValue(each.p_value), allocator);
    if (each.f1) add_member(entry, "f1", JsonValue(*each.f1), allocator);
    return entry;
}

JsonValue answer_entry(const TechniqueAnswer& each, const TechniqueObject& object, bool learned, JsonAllocator& allocator) {
    JsonValue entry(rapidjson::kObjectType), descriptors(rapidjson::kObjectType), slices(rapidjson::kObjectType);
    add_member(entry, "name", each.name, allocator);
    if (!each.label.empty()) add_member(entry, "label", each.label, allocator);
    if (!each.answer.empty()) {
        add_member(entry, "answer", each.answer, allocator);
        if (learned) {
            add_member(entry, "score", JsonValue(each.score), allocator);
            add_member(entry, "agreement", JsonValue(each.agreement), allocator);
            add_member(entry, "resamples", JsonValue(each.asked), allocator);
        }
    }
    if (each.roundness) {
        JsonValue interval(rapidjson::kArrayType);
        interval.PushBack(each.roundness->low, allocator).PushBack(each.roundness->high, allocator);
        add_member(entry, "roundnessInterval", std::move(interval), allocator);
    }
    add_member(slices, "asked", whole(object.measures.asked), allocator);
    add_member(slices, "used", whole(object.measures.slices.size()), allocator);
    add_member(slices, "open", whole(object.measures.open_used), allocator);
    add_member(slices, "tooOpen", whole(object.measures.too_open), allocator);
    add_member(slices, "empty", whole(object.measures.empty), allocator);
    add_member(entry, "slices", std::move(slices), allocator);
    for (const TechniqueDescriptor& d : object.measures.descriptors)
        add_member(descriptors, d.name, number_or_null(d.value), allocator);
    add_member(entry, "descriptors", std::move(descriptors), allocator);
    add_member(entry, "words", each.words, allocator);
    return entry;
}

}  // namespace

void add_technique_result(JsonValue& result, const TechniqueStudy& study, const std::vector<TechniqueObject>& objects,
                          JsonAllocator& allocator) {
    JsonValue classifiers(rapidjson::kArrayType), divisions(rapidjson::kArrayType), answers(rapidjson::kArrayType);
    add_member(result, "positive", study.positive, allocator);
    add_member(result, "negative", study.negative, allocator);
    add_member(result, "learned", JsonValue(study.learned), allocator);
    known_answers(objects).add_to(result, allocator);
    add_member(result, "answeredBy", study.answered_by, allocator);
    if (!study.learned) add_member(result, "separated", JsonValue(study.separated), allocator);
    for (const auto& each : study.classifiers) classifiers.PushBack(classifier_entry(each, allocator), allocator);
    for (const auto& each : study.splits) divisions.PushBack(split_entry(each, allocator), allocator);
    for (std::size_t i = 0; i < objects.size(); ++i)
        answers.PushBack(answer_entry(study.answers[i], objects[i], study.learned, allocator), allocator);
    add_member(result, "classifiers", std::move(classifiers), allocator);
    add_member(result, "divisions", std::move(divisions), allocator);
    add_member(result, "objects", std::move(answers), allocator);
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
    const Path folder = files.output;
    descriptors.write(folder, "descriptors", "Descriptors of technique");

    if (study.learned) {
        TextTable classifiers(
            {"classifier", "objects", "F1", "deviation", "precision", "recall", "ROC area", "positive", "threshold"});
        for (const ClassifierResult& each : study.classifiers) {
            std::vector<TableCell> cells{each.classifier.name, std::to_string(each.objects)};
            for (const double value : {each.validation.mean_f1, each.validation.deviation, each.validation.first.precision(),
                                       each.validation.first.recall(), each.roc.area})
                cells.push_back(fixed_cell(each.validated ? std::optional(value) : std::nullopt, 3));
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

    TextTable answers({"name", "label", "answer", "score", "agreement", "why"});
    for (const TechniqueAnswer& each : study.answers) {
        const bool told = study.learned && !each.answer.empty();
        const auto value = [&](double x) { return fixed_cell(told ? std::optional(x) : std::nullopt, 2); };
        answers.add({each.name, each.label, each.answer, value(each.score), value(each.agreement), each.words});
    }
    answers.write(folder, "answers", "Answers by " + study.answered_by);
}

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
            if (number == c && std::isfinite(a) && std::isfinite(b) && b > 0 && (a > 0 || !logarithmic))
                series.points.push_back({a, b});
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
    bars.title = "F1 of " + study.positive + " under cross-validation";
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
        const double f1 = each.validation.mean_f1, s = each.validation.deviation;
        series.points.push_back({static_cast<double>(series.points.size()), f1});
        series.intervals.emplace_back(std::array<double, 2>{std::max(0.0, f1 - s), std::min(1.0, f1 + s)});
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
        for (const RocPoint& point : each.roc.points)
            curve.points.push_back({point.false_positive_rate, point.true_positive_rate});
        roc.series.push_back(std::move(curve));
    }
    if (!roc.series.empty()) write_plot(files.plot("roc"), roc);
}

KnownAnswers known_answers(const std::vector<TechniqueObject>& objects) {
    std::vector<std::string> labels;
    for (const TechniqueObject& object : objects) labels.push_back(object.label);
    return KnownAnswers(labels);
}

std::string technique_summary(const TechniqueStudy& study, const std::vector<TechniqueObject>& objects, std::size_t left_out) {
    const KnownAnswers known = known_answers(objects);
    std::string text =
        std::to_string(objects.size()) + " objects studied, " + std::to_string(left_out) + " left out\n" + known.words();
    std::vector<std::vector<std::string>> rows;
    if (study.learned) {
        for (const ClassifierResult& each : study.classifiers) {
            std::vector<std::string> cells{each.classifier.name, std::to_string(each.objects)};
            if (each.validated)
                for (const double value : {each.validation.mean_f1, each.validation.deviation, each.validation.first.precision(),
                                           each.validation.first.recall(), each.roc.area})
                    cells.push_back(fixed(value, 3));
            cells.resize(7);
            rows.push_back(std::move(cells));
        }
        text += "F1 of " + printable(study.positive) + ", each object answered when it was left out\n" +
                table({"classifier", "objects", "F1", "+-", "precision", "recall", "ROC area"}, rows);
    } else {
        for (const TechniqueSplit& each : study.splits)
            rows.push_back({each.descriptor, std::to_string(each.objects),
                            std::to_string(each.lower) + " + " + std::to_string(each.objects - each.lower), fixed(each.share, 3),
                            significant(each.p_value, 2)});
        text += (known.labelled == 0 ? "no answers are known: " : "") + std::string("divided into two groups\n") +
                table({"descriptor", "objects", "groups", "share between", "p"}, rows);
        if (!study.separated) text += "by " + study.answered_by + " there are no two groups\n";
    }
    rows.clear();
    for (const TechniqueAnswer& each : study.answers)
        rows.push_back({printable(each.name, 40), printable(each.label, 20),
                        each.answer.empty() ? "-" : printable(each.answer, 20),
                        study.learned && !each.answer.empty() ? fixed(each.agreement, 2) : ""});
    text += "answers by " + study.answered_by + "\n" + table({"object", "label", "answer", "agreement"}, rows);
    return text;
}

}  // namespace ostraka::app
