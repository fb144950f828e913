#include "study_technique_report.h"

#include "ostraka/report/table.h"

#include <algorithm>
#include <cmath>

namespace ostraka::app {

namespace {

JsonValue number_or_null(double value) { return std::isfinite(value) ? JsonValue(value) : JsonValue(rapidjson::kNullType); }
JsonValue whole(std::size_t value) { return JsonValue(static_cast<std::uint64_t>(value)); }

JsonValue pair_of(double low, double high, JsonAllocator& allocator) {
    JsonValue pair(rapidjson::kArrayType);
    pair.PushBack(low, allocator).PushBack(high, allocator);
    return pair;
}

/// Words for the classifier or descriptor that answers.
std::string answering(const TechniqueStudy& study) {
    for (const ClassifierResult& each : study.classifiers)
        if (each.classifier.name == study.answered_by) return each.classifier.words;
    return study.answered_by;
}

std::string against_label(const TechniqueAnswer& answer) {
    return answer.label.empty() || answer.answer.empty() ? "" : answer.wrong() ? "WRONG" : "right";
}

/// Cells of a classifier: name, objects, F1, its interval, the trivial F1, whether it is better, precision, recall, ROC area.
std::vector<std::string> scores_of(const ClassifierResult& each) {
    std::vector<std::string> cells{each.classifier.name, std::to_string(each.objects)};
    if (each.validated)
        cells.insert(cells.end(),
                     {fixed(each.validation.mean_f1, 3), fixed(each.f1_interval.low, 3), fixed(each.f1_interval.high, 3),
                      fixed(each.trivial_f1, 3), each.better ? "yes" : "no", fixed(each.validation.mean_precision, 3),
                      fixed(each.validation.mean_recall, 3), fixed(each.roc.area, 3)});
    cells.resize(10);
    return cells;
}

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
    add_member(entry, "f1Interval", pair_of(each.f1_interval.low, each.f1_interval.high, allocator), allocator);
    add_member(entry, "trivialF1", JsonValue(each.trivial_f1), allocator);
    add_member(entry, "better", JsonValue(each.better), allocator);
    add_member(entry, "error", JsonValue(each.error), allocator);
    add_member(entry, "precision", JsonValue(each.validation.mean_precision), allocator);
    add_member(entry, "recall", JsonValue(each.validation.mean_recall), allocator);
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
    if (!each.answer.empty()) add_member(entry, "answer", each.answer, allocator);
    if (learned && !each.certainty.empty()) {
        add_member(entry, "certainty", each.certainty, allocator);
        add_member(entry, "score", JsonValue(each.score), allocator);
        add_member(entry, "agreement", JsonValue(each.agreement), allocator);
        add_member(entry, "resamples", JsonValue(each.asked), allocator);
    }
    if (each.unlike) {
        JsonValue unlike(rapidjson::kObjectType);
        add_member(unlike, "descriptor", each.unlike->descriptor, allocator);
        add_member(unlike, "value", JsonValue(each.unlike->value), allocator);
        add_member(unlike, "labelled", pair_of(each.unlike->low, each.unlike->high, allocator), allocator);
        add_member(unlike, "distance", JsonValue(each.unlike->distance), allocator);
        add_member(entry, "unlike", std::move(unlike), allocator);
    }
    if (each.roundness)
        add_member(entry, "roundnessInterval", pair_of(each.roundness->low, each.roundness->high, allocator), allocator);
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
    add_member(result, "separated", JsonValue(study.separated), allocator);
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
        const bool told = study.learned && !each.certainty.empty();
        const auto value = [&](double x) { return fixed_cell(told ? std::optional(x) : std::nullopt, 2); };
        answers.add({each.name, each.label, each.answer, each.certainty, against_label(each), value(each.score),
                     value(each.agreement), each.words});
    }
    answers.write(folder, "answers", "Answers by " + answering(study));
}

namespace {

/// Whether the answering classifier tells the labels apart, and which others do.
std::string learned_verdict(const TechniqueStudy& study) {
    std::vector<const ClassifierResult*> better;
    const ClassifierResult* chosen = nullptr;
    for (const ClassifierResult& each : study.classifiers) {
        if (each.better) better.push_back(&each);
        if (each.classifier.name == study.answered_by) chosen = &each;
    }
    if (study.separated || chosen == nullptr) return {};
    if (!chosen->validated)
        return "this classifier does not tell them apart here: two objects of each label that have its descriptors are needed\n";
    std::string text = "this classifier does not tell them apart here: F1 of " + printable(answering(study)) + " " +
                       fixed(chosen->validation.mean_f1, 3) + " (" + fixed(chosen->f1_interval.low, 3) + " to " +
                       fixed(chosen->f1_interval.high, 3) + "), of calling all of them " + printable(study.positive) + " " +
                       fixed(chosen->trivial_f1, 3) + "; no answers are given\n";
    std::stable_sort(better.begin(), better.end(),
                     [](const auto* a, const auto* b) { return a->f1_interval.low > b->f1_interval.low; });
    if (better.empty()) return text + "no other classifier does better than that either: give more labelled objects\n";
    text += "better here, by --answer-by:";
    for (std::size_t i = 0; i < better.size(); ++i)
        text += (i == 0 ? " '" : ", '") + better[i]->classifier.name + "' (" + fixed(better[i]->validation.mean_f1, 3) + ")";
    return text + "\n";
}

std::string listed(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size() && i < 12; ++i) text += (i == 0 ? "" : ", ") + printable(names[i], 40);
    return names.size() > 12 ? text + ", and " + std::to_string(names.size() - 12) + " more" : text;
}

/// "39 of 40 right; wrong: statuette-38"
std::string count_of_answers(const TechniqueStudy& study) {
    std::size_t known = 0, right = 0;
    std::vector<std::string> wrong, unlike;
    std::size_t without = 0;
    for (const TechniqueAnswer& each : study.answers) {
        if (each.unlike) unlike.push_back(each.name);
        if (each.label.empty()) continue;
        ++known;
        if (each.answer.empty()) ++without;
        else if (each.wrong()) wrong.push_back(each.name);
        else ++right;
    }
    std::string text;
    if (known > 0 && without < known) {
        text = std::to_string(right) + " of " + std::to_string(known) + " right";
        if (without > 0) text += ", " + std::to_string(without) + " without an answer";
        if (!wrong.empty()) text += "; wrong: " + listed(wrong);
        text += "\n";
    }
    if (!unlike.empty())
        text += "unlike the labelled objects, so that they get no answer (see answers.md): " + listed(unlike) + "\n";
    return text;
}

}  // namespace

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
        for (const ClassifierResult& each : study.classifiers) rows.push_back(scores_of(each));
        text += "F1 of " + printable(study.positive) +
                " when left out: means over the repeats of the cross-validation; from, to: 95 % over objects drawn anew\n" +
                table({"classifier", "objects", "F1", "from", "to", "all " + printable(study.positive, 20), "better", "precision",
                       "recall", "ROC area"},
                      rows) +
                learned_verdict(study);
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
    for (const TechniqueAnswer& each : study.answers) {
        rows.push_back(
            {printable(each.name, 40), printable(each.label, 20), each.answer.empty() ? "-" : printable(each.answer, 20)});
        if (study.learned)
            rows.back().insert(rows.back().end(), {each.certainty, each.certainty.empty() ? "" : fixed(each.agreement, 2),
                                                   each.wrong() ? "WRONG" : ""});
    }
    std::vector<std::string> columns{"object", "label", "answer"};
    if (study.learned) columns.insert(columns.end(), {"certainty", "agreement", ""});
    text += "answers by " + answering(study) + "\n" + table(columns, rows);
    if (study.learned) text += count_of_answers(study);
    return text;
}

}  // namespace ostraka::app
