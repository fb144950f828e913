// study technique: classifies the objects of a collection as wheel-made or hand-made.
#include "operations/study/technique_files.h"

#include "ostraka/collection/technique_objects.h"
#include "ostraka/figures/table.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

struct StudyOfTechnique final : StudyOperation {
    void declare(Parameters& p) override {
        files.declare(p, true);
        part.declare(p);
        up.declare(
            p, "upward direction of all objects; by default the upward direction of the annotations of each object, or 0,0,1");
        slices.declare_options(p.options);
        options.declare_options(p.options);
        for (const char* word : {"positive", "negative", "answeredBy"}) p.report.values(text(word));
        for (const char* answer : {"learned", "separated"}) p.report.values(boolean(answer));
        p.report.table("classifiers", text("name"), texts("descriptors"), integer("objects"), numbers("f1Interval"),
                       boolean("better"), boolean("positiveAbove"), any("roc"), number("f1"), number("f1Deviation"),
                       number("trivialF1"), number("error"), number("precision"), number("recall"), number("area"),
                       number("threshold"));
        p.report.table("divisions", text("descriptor"), integer("objects"), integer("lower"), number("threshold"),
                       number("shareBetween"), number("p"), number("f1"));
        p.report.table("objects", integer("resamples"), text("unlike.descriptor"), number("unlike.value"),
                       numbers("unlike.labelled"), number("unlike.distance"), number("score"),
                       number("agreement", "", "fraction of the resampled collections"), numbers("roundnessInterval"),
                       any("descriptors"), text("name"), text("label"), text("answer"), text("certainty"), text("words"),
                       integer("slices.asked"), integer("slices.used"), integer("slices.open"), integer("slices.tooOpen"),
                       integer("slices.empty"));
    }

    void check() const override {
        StudyOperation::check();
        part.check();
    }

    void run(Context& context, Report& report) override {
        const Collection collection = files.read(context);
        const auto measured = measure_technique(collection, up.value(), slices, files.store(), part.parts());
        if (files.ends_with_part(report, measured)) return;
        report.notes(notes_on_directions(collection, measured));
        const std::vector<TechniqueObject> objects = technique_objects(collection, measured);
        const std::size_t left_out = report_failures(report, collection, measured);
        if (objects.empty())
            fail_input(files.collection.file(), "no object of the collection could be studied",
                       "see the notes above for each of them");
        const TechniqueStudy study = study_technique(objects, options);
        std::vector<std::string> labels;
        for (const TechniqueObject& object : objects) labels.push_back(object.label);
        const KnownAnswers known_answers(labels);
        fill(report, study, objects, known_answers);
        write_study_report(files.in("technique.json"), "technique", report.result(), context.provenance());
        write_technique_tables(files, study, objects);
        draw_technique(files, study, objects);

        report.line(fmt::format("{} objects studied, {} left out", objects.size(), left_out));
        known_answers.report_result(report);
        if (study.learned) report_learned(report, study);
        else report_divided(report, study, known_answers);
        report_answers(report, study);
        // The answer is whether the classes can be distinguished or, without known answers, whether there are two groups.
        if (!study.separated) report.answer_no();
    }

    static void fill(Report& report, const TechniqueStudy& study, const std::vector<TechniqueObject>& objects,
                     const KnownAnswers& known_answers) {
        report("positive", study.positive)("negative", study.negative)("learned", study.learned);
        known_answers.add_to(report);
        report("answeredBy", study.answered_by)("separated", study.separated);
        for (const char* table : {"classifiers", "divisions", "objects"}) report.empty_table(table);
        for (const ClassifierResult& result : study.classifiers) {
            Report::Row row = report.row("classifiers");
            row("name", result.classifier.name)("descriptors", result.classifier.descriptors)("objects", result.objects);
            if (!result.validated) continue;
            row("f1", result.validation.mean_f1)("f1Deviation", result.validation.deviation)(
                "f1Interval", std::vector{result.f1_interval.low, result.f1_interval.high})("trivialF1", result.trivial_f1)(
                "better", result.better)("error", result.error)("precision", result.validation.mean_precision)(
                "recall", result.validation.mean_recall)("area", result.roc.area);
            if (result.threshold) row("threshold", result.threshold->value)("positiveAbove", result.threshold->above);
            std::vector<std::array<double, 2>> roc;
            for (const RocPoint& point : result.roc.points) roc.push_back({point.false_positive_rate, point.true_positive_rate});
            row("roc", json_value(roc, report.allocator()));
        }
        for (const TechniqueSplit& split : study.splits) {
            Report::Row row = report.row("divisions");
            row("descriptor", split.descriptor)("objects", split.objects)("lower", split.lower)("threshold", split.threshold)(
                "shareBetween", split.share)("p", split.p_value)("f1", split.f1);
        }
        for (std::size_t i = 0; i < objects.size(); ++i)
            fill_answer(report.row("objects"), study.answers[i], objects[i].measures, study.learned, report.allocator());
    }

    static void fill_answer(Report::Row row, const TechniqueAnswer& technique_answer, const TechniqueMeasures& measures,
                            bool learned, JsonAllocator& allocator) {
        row("name", technique_answer.name);
        if (!technique_answer.label.empty()) row("label", technique_answer.label);
        if (!technique_answer.answer.empty()) row("answer", technique_answer.answer);
        if (learned && !technique_answer.certainty.empty())
            row("certainty", technique_answer.certainty)("score", technique_answer.score)(
                "agreement", technique_answer.agreement)("resamples", technique_answer.asked);
        if (technique_answer.outlier)
            row("unlike.descriptor", technique_answer.outlier->descriptor)("unlike.value", technique_answer.outlier->value)(
                "unlike.labelled", std::vector{technique_answer.outlier->low, technique_answer.outlier->high})(
                "unlike.distance", technique_answer.outlier->distance);
        if (technique_answer.roundness)
            row("roundnessInterval", std::vector{technique_answer.roundness->low, technique_answer.roundness->high});
        row("slices.asked", measures.asked)("slices.used", measures.slices.size())("slices.open", measures.open_used)(
            "slices.tooOpen", measures.too_open)("slices.empty", measures.empty);
        JsonValue descriptors(rapidjson::kObjectType);
        for (const TechniqueDescriptor& d : measures.descriptors)
            add_members(descriptors, allocator, d.name, std::isfinite(d.value) ? std::optional(d.value) : std::nullopt);
        row("descriptors", std::move(descriptors))("words", technique_answer.words);
    }

    /// Reports what was learnt from the labels: the scores, and whether the chosen classifier separates the classes.
    static void report_learned(Report& report, const TechniqueStudy& study) {
        report.line(
            fmt::format("F1 of {} when left out: means over the repeats of the cross-validation; from, to: 95 % interval over "
                        "resampled objects",
                        printable(study.positive)));
        TextTable scores({"classifier", "objects", "F1", "from", "to", "all " + printable(study.positive, 20), "better",
                          "precision", "recall", "ROC area"});
        std::vector<const ClassifierResult*> better;
        const ClassifierResult* chosen = nullptr;
        for (const ClassifierResult& result : study.classifiers) {
            std::vector<std::string> cells{result.classifier.name, std::to_string(result.objects)};
            if (result.validated)
                cells.insert(cells.end(), {fixed(result.validation.mean_f1, 3), fixed(result.f1_interval.low, 3),
                                           fixed(result.f1_interval.high, 3), fixed(result.trivial_f1, 3),
                                           result.better ? "yes" : "no", fixed(result.validation.mean_precision, 3),
                                           fixed(result.validation.mean_recall, 3), fixed(result.roc.area, 3)});
            cells.resize(10);
            scores.add(cells);
            if (result.better) better.push_back(&result);
            if (result.classifier.name == study.answered_by) chosen = &result;
        }
        report.table(scores);
        if (study.separated || chosen == nullptr) return;
        if (!chosen->validated)
            return report.line(
                "this classifier does not distinguish the classes here: two objects of each label that have its descriptors are "
                "needed");
        report.line(fmt::format(
            "this classifier does not distinguish the classes here: F1 of {} is {} ({} to {}), and classifying all objects as {} "
            "gives {}; no answers are given",
            printable(answering_words(study)), fixed(chosen->validation.mean_f1, 3), fixed(chosen->f1_interval.low, 3),
            fixed(chosen->f1_interval.high, 3), printable(study.positive), fixed(chosen->trivial_f1, 3)));
        if (better.empty()) return report.line("no other classifier does better than that either: give more labelled objects");
        std::stable_sort(better.begin(), better.end(),
                         [](const auto* a, const auto* b) { return a->f1_interval.low > b->f1_interval.low; });
        std::string text;
        for (const ClassifierResult* result : better)
            text += fmt::format("{}'{}' ({})", text.empty() ? " " : ", ", result->classifier.name,
                                fixed(result->validation.mean_f1, 3));
        report.line("better classifiers here, for --answer-by:" + text);
    }

    static void report_divided(Report& report, const TechniqueStudy& study, const KnownAnswers& known_answers) {
        report.line((known_answers.labelled == 0 ? "no answers are known: " : "") + std::string("divided into two groups"));
        TextTable divisions({"descriptor", "objects", "groups", "share between", "p"});
        for (const TechniqueSplit& split : study.splits)
            divisions.add({split.descriptor, std::to_string(split.objects),
                           fmt::format("{} + {}", split.lower, split.objects - split.lower), fixed(split.share, 3),
                           significant(split.p_value, 2)});
        report.table(divisions);
        if (!study.separated) report.line(fmt::format("there are not two groups by {}", study.answered_by));
    }

    static void report_answers(Report& report, const TechniqueStudy& study) {
        report.line("answers by " + printable(answering_words(study)));
        std::vector<std::string> columns{"object", "label", "answer"};
        if (study.learned) columns.insert(columns.end(), {"certainty", "agreement", ""});
        TextTable answers(columns);
        std::size_t labelled = 0, correct = 0, without = 0;
        std::vector<std::string> wrong, dissimilar;
        for (const TechniqueAnswer& technique_answer : study.answers) {
            std::vector<std::string> cells{printable(technique_answer.name, 40), printable(technique_answer.label, 20),
                                           technique_answer.answer.empty() ? "-" : printable(technique_answer.answer, 20)};
            if (study.learned)
                cells.insert(cells.end(), {technique_answer.certainty,
                                           technique_answer.certainty.empty() ? "" : fixed(technique_answer.agreement, 2),
                                           technique_answer.wrong() ? "WRONG" : ""});
            answers.add(cells);
            if (technique_answer.outlier) dissimilar.push_back(technique_answer.name);
            if (technique_answer.label.empty()) continue;
            ++labelled;
            if (technique_answer.answer.empty()) ++without;
            else if (technique_answer.wrong()) wrong.push_back(technique_answer.name);
            else ++correct;
        }
        report.table(answers);
        if (!study.learned) return;
        const auto listed_names = [](const std::vector<std::string>& names) {
            std::string text;
            for (std::size_t i = 0; i < names.size() && i < 12; ++i) text += (i == 0 ? "" : ", ") + printable(names[i], 40);
            return names.size() > 12 ? fmt::format("{}, and {} more", text, names.size() - 12) : text;
        };
        if (without < labelled)
            report.line(fmt::format("{} of {} right{}{}", correct, labelled,
                                    without > 0 ? fmt::format(", {} without an answer", without) : "",
                                    wrong.empty() ? "" : "; wrong: " + listed_names(wrong)));
        if (!dissimilar.empty())
            report.line("no answer, because they are too dissimilar to the labelled objects (see answers.md): " +
                        listed_names(dissimilar));
    }

    DirectionOption up;
    StudyPart part;
    TechniqueOptions slices;
    TechniqueStudyOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_study_technique() { return make<StudyOfTechnique>(); }

}  // namespace ostraka
