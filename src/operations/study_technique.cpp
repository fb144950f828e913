// study technique: classifies the objects of a collection as wheel-made or hand-made.
#include "study_technique_files.h"

#include "ostraka/collection/technique_objects.h"
#include "ostraka/report/table.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

struct StudyOfTechnique final : StudyOperation {
    void describe(Parameters& p) override {
        files.describe(p, true);
        part.describe(p);
        up.describe(p, "upward direction of all objects; otherwise that of their annotations, otherwise 0,0,1");
        slices.describe(p.options);
        options.describe(p.options);
        for (const char* word : {"positive", "negative", "answeredBy"}) p.report.values(text(word));
        for (const char* answer : {"learned", "separated"}) p.report.values(boolean(answer));
        p.report.table("classifiers", text("name"), texts("descriptors"), integer("objects"), numbers("f1Interval"),
                       boolean("better"), boolean("positiveAbove"), any("roc"), number("f1"), number("f1Deviation"),
                       number("trivialF1"), number("error"), number("precision"), number("recall"), number("area"),
                       number("threshold"));
        p.report.table("divisions", text("descriptor"), integer("objects"), integer("lower"), number("threshold"),
                       number("shareBetween"), number("p"), number("f1"));
        p.report.table("objects", integer("resamples"), text("unlike.descriptor"), number("unlike.value"),
                       numbers("unlike.labelled"), number("unlike.distance"), number("score"), number("agreement"),
                       numbers("roundnessInterval"), any("descriptors"), text("name"), text("label"), text("answer"),
                       text("certainty"), text("words"), integer("slices.asked"), integer("slices.used"), integer("slices.open"),
                       integer("slices.tooOpen"), integer("slices.empty"));
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
        const KnownAnswers known(labels);
        fill(report, study, objects, known);
        write_study_report(files.in("technique.json"), "technique", report.result(), context.provenance());
        write_technique_tables(files, study, objects);
        draw_technique(files, study, objects);

        report.line(std::to_string(objects.size()) + " objects studied, " + std::to_string(left_out) + " left out");
        known.report_result(report);
        if (study.learned) report_learned(report, study);
        else report_divided(report, study, known);
        report_answers(report, study);
        // The answer is whether the classes can be distinguished or, without known answers, whether there are two groups.
        if (!study.separated) report.answer_no();
    }

    static void fill(Report& report, const TechniqueStudy& study, const std::vector<TechniqueObject>& objects,
                     const KnownAnswers& known) {
        report("positive", study.positive)("negative", study.negative)("learned", study.learned);
        known.add_to(report);
        report("answeredBy", study.answered_by)("separated", study.separated);
        for (const char* table : {"classifiers", "divisions", "objects"}) report.empty_table(table);
        for (const ClassifierResult& each : study.classifiers) {
            Report::Row row = report.row("classifiers");
            row("name", each.classifier.name)("descriptors", each.classifier.descriptors)("objects", each.objects);
            if (!each.validated) continue;
            row("f1", each.validation.mean_f1)("f1Deviation", each.validation.deviation)(
                "f1Interval", std::vector{each.f1_interval.low, each.f1_interval.high})("trivialF1", each.trivial_f1)(
                "better", each.better)("error", each.error)("precision", each.validation.mean_precision)(
                "recall", each.validation.mean_recall)("area", each.roc.area);
            if (each.threshold) row("threshold", each.threshold->value)("positiveAbove", each.threshold->above);
            std::vector<std::array<double, 2>> roc;
            for (const RocPoint& point : each.roc.points) roc.push_back({point.false_positive_rate, point.true_positive_rate});
            row("roc", json_value(roc, report.allocator()));
        }
        for (const TechniqueSplit& each : study.splits) {
            Report::Row row = report.row("divisions");
            row("descriptor", each.descriptor)("objects", each.objects)("lower", each.lower)("threshold", each.threshold)(
                "shareBetween", each.share)("p", each.p_value)("f1", each.f1);
        }
        for (std::size_t i = 0; i < objects.size(); ++i)
            fill_answer(report.row("objects"), study.answers[i], objects[i].measures, study.learned, report.allocator());
    }

    static void fill_answer(Report::Row row, const TechniqueAnswer& each, const TechniqueMeasures& measures, bool learned,
                            JsonAllocator& allocator) {
        row("name", each.name);
        if (!each.label.empty()) row("label", each.label);
        if (!each.answer.empty()) row("answer", each.answer);
        if (learned && !each.certainty.empty())
            row("certainty", each.certainty)("score", each.score)("agreement", each.agreement)("resamples", each.asked);
        if (each.unlike)
            row("unlike.descriptor", each.unlike->descriptor)("unlike.value", each.unlike->value)(
                "unlike.labelled", std::vector{each.unlike->low, each.unlike->high})("unlike.distance", each.unlike->distance);
        if (each.roundness) row("roundnessInterval", std::vector{each.roundness->low, each.roundness->high});
        row("slices.asked", measures.asked)("slices.used", measures.slices.size())("slices.open", measures.open_used)(
            "slices.tooOpen", measures.too_open)("slices.empty", measures.empty);
        JsonValue descriptors(rapidjson::kObjectType);
        for (const TechniqueDescriptor& d : measures.descriptors)
            add_members(descriptors, allocator, d.name, std::isfinite(d.value) ? std::optional(d.value) : std::nullopt);
        row("descriptors", std::move(descriptors))("words", each.words);
    }

    /// Reports what was learnt from the labels: the scores, and whether the chosen classifier separates the classes.
    static void report_learned(Report& report, const TechniqueStudy& study) {
        report.line("F1 of " + printable(study.positive) +
                    " when left out: means over the repeats of the cross-validation; from, to: 95 % over objects drawn anew");
        TextTable scores({"classifier", "objects", "F1", "from", "to", "all " + printable(study.positive, 20), "better",
                          "precision", "recall", "ROC area"});
        std::vector<const ClassifierResult*> better;
        const ClassifierResult* chosen = nullptr;
        for (const ClassifierResult& each : study.classifiers) {
            std::vector<std::string> cells{each.classifier.name, std::to_string(each.objects)};
            if (each.validated)
                cells.insert(cells.end(),
                             {fixed(each.validation.mean_f1, 3), fixed(each.f1_interval.low, 3), fixed(each.f1_interval.high, 3),
                              fixed(each.trivial_f1, 3), each.better ? "yes" : "no", fixed(each.validation.mean_precision, 3),
                              fixed(each.validation.mean_recall, 3), fixed(each.roc.area, 3)});
            cells.resize(10);
            scores.add(cells);
            if (each.better) better.push_back(&each);
            if (each.classifier.name == study.answered_by) chosen = &each;
        }
        report.table(scores);
        if (study.separated || chosen == nullptr) return;
        if (!chosen->validated)
            return report.line(
                "this classifier does not tell them apart here: two objects of each label that have its descriptors are needed");
        report.line("this classifier does not tell them apart here: F1 of " + printable(answering_words(study)) + " " +
                    fixed(chosen->validation.mean_f1, 3) + " (" + fixed(chosen->f1_interval.low, 3) + " to " +
                    fixed(chosen->f1_interval.high, 3) + "), of calling all of them " + printable(study.positive) + " " +
                    fixed(chosen->trivial_f1, 3) + "; no answers are given");
        if (better.empty()) return report.line("no other classifier does better than that either: give more labelled objects");
        std::stable_sort(better.begin(), better.end(),
                         [](const auto* a, const auto* b) { return a->f1_interval.low > b->f1_interval.low; });
        std::string text;
        for (const ClassifierResult* each : better)
            text += (text.empty() ? " '" : ", '") + each->classifier.name + "' (" + fixed(each->validation.mean_f1, 3) + ")";
        report.line("better here, by --answer-by:" + text);
    }

    static void report_divided(Report& report, const TechniqueStudy& study, const KnownAnswers& known) {
        report.line((known.labelled == 0 ? "no answers are known: " : "") + std::string("divided into two groups"));
        TextTable divisions({"descriptor", "objects", "groups", "share between", "p"});
        for (const TechniqueSplit& each : study.splits)
            divisions.add({each.descriptor, std::to_string(each.objects),
                           std::to_string(each.lower) + " + " + std::to_string(each.objects - each.lower), fixed(each.share, 3),
                           significant(each.p_value, 2)});
        report.table(divisions);
        if (!study.separated) report.line("by " + study.answered_by + " there are no two groups");
    }

    static void report_answers(Report& report, const TechniqueStudy& study) {
        report.line("answers by " + printable(answering_words(study)));
        std::vector<std::string> columns{"object", "label", "answer"};
        if (study.learned) columns.insert(columns.end(), {"certainty", "agreement", ""});
        TextTable answers(columns);
        std::size_t known = 0, right = 0, without = 0;
        std::vector<std::string> wrong, unlike;
        for (const TechniqueAnswer& each : study.answers) {
            std::vector<std::string> cells{printable(each.name, 40), printable(each.label, 20),
                                           each.answer.empty() ? "-" : printable(each.answer, 20)};
            if (study.learned)
                cells.insert(cells.end(), {each.certainty, each.certainty.empty() ? "" : fixed(each.agreement, 2),
                                           each.wrong() ? "WRONG" : ""});
            answers.add(cells);
            if (each.unlike) unlike.push_back(each.name);
            if (each.label.empty()) continue;
            ++known;
            if (each.answer.empty()) ++without;
            else if (each.wrong()) wrong.push_back(each.name);
            else ++right;
        }
        report.table(answers);
        if (!study.learned) return;
        const auto listed = [](const std::vector<std::string>& names) {
            std::string text;
            for (std::size_t i = 0; i < names.size() && i < 12; ++i) text += (i == 0 ? "" : ", ") + printable(names[i], 40);
            return names.size() > 12 ? text + ", and " + std::to_string(names.size() - 12) + " more" : text;
        };
        if (without < known)
            report.line(std::to_string(right) + " of " + std::to_string(known) + " right" +
                        (without > 0 ? ", " + std::to_string(without) + " without an answer" : "") +
                        (wrong.empty() ? "" : "; wrong: " + listed(wrong)));
        if (!unlike.empty())
            report.line("unlike the labelled objects, so that they get no answer (see answers.md): " + listed(unlike));
    }

    DirectionOption up;
    StudyPart part;
    TechniqueOptions slices;
    TechniqueStudyOptions options;
};

}  // namespace

std::unique_ptr<Operation> make_study_technique() { return make<StudyOfTechnique>(); }

}  // namespace ostraka
