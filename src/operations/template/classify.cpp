// template classify: the class to which objects belong.
#include "operations/operations.h"

#include "ostraka/shape_classes/member_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

namespace ostraka {

namespace {

struct TemplateClassify final : Operation {
    void declare(Parameters& p) override {
        p.input("files", Kind::shape_class, files,
                "class files (.class.json), then the mesh file of each object (for classes of landmarks: the landmark file)")
            .many();
        vocabulary.declare(p, as_template_words);
        p.output_option("report", Kind::report, answer,
                        "JSON file to write: the complete answer (doc/schema/classification.schema.json)");
        options.declare_options(p.options);
        p.report.schema = "classification";
        p.report.text_table("", {"object", "class", "verdict", "score", "against"});
    }

    void check() const override {
        std::size_t count = 0;
        for (std::size_t i = 0; i < files.size(); ++i) count += is_class(i);
        if (count == 0) fail_usage("there is no class", "give one or more .class.json files, then objects");
        if (count == files.size()) fail_usage("there is no object", "give mesh files after the classes");
    }

    void run(Context& context, Report& report) override {
        read_classes();
        std::vector<Classification> answers;
        std::optional<Error> first_error;
        std::size_t written_count = 0;
        Progress progress("comparing classes", files.size());
        for (std::size_t i = 0; i < files.size(); ++i, progress.advance()) {
            if (is_class(i)) continue;
            answers.push_back(answer_of(context, i, first_error));
            if (answer &&
                answers.size() >= written_count + 1 + written_count / 32) {  // at most 1/32 is lost; O(n log n) bytes in total
                write_answers(answers);
                written_count = answers.size();
            }
        }
        if (answer && written_count < answers.size()) write_answers(answers);
        if (std::all_of(answers.begin(), answers.end(), [](const auto& a) { return !a.problem.empty(); })) throw *first_error;
        report_result(report, answers);
        if (!std::all_of(answers.begin(), answers.end(), [](const auto& a) { return a.verdict == Membership::member; }))
            report.answer_no();
    }

    /// Classifies the i-th object. If it cannot be read or fitted, the others are still processed; the first error is kept.
    [[nodiscard]] Classification answer_of(Context& context, std::size_t i, std::optional<Error>& first_error) const {
        try {
            return decide(object_name(files.file(i)),
                          classes_with_templates.front()->landmarks ? compare_landmarks(context, i) : compare_meshes(i), options);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input && error.kind() != ErrorKind::failure) throw;
            if (!first_error) first_error = error;
            Classification unanswered;
            unanswered.object = object_name(files.file(i));
            unanswered.problem = error.what();
            unanswered.text = "cannot be classified: " + unanswered.problem;
            return unanswered;
        }
    }

    /// Writes the answers so far to disk, so that an interrupted run keeps them.
    void write_answers(const std::vector<Classification>& answers) const {
        OutputTransaction transaction;
        answer.write(document_of(answers));
        transaction.commit();
    }

    static Json document_of(const std::vector<Classification>& answers) {
        Json document = json_document("classification");
        auto& allocator = document.GetAllocator();
        const auto object_json = [&](const auto& classification) { return classification_to_json(classification, allocator); };
        add_members(document, allocator, "objects", json_list(answers, allocator, object_json));
        return document;
    }

    [[nodiscard]] bool is_class(std::size_t i) const { return files.file(i).ends_with(".class.json"); }

    void read_classes() {
        std::vector<std::string> class_files;
        for (std::size_t i = 0; i < files.size(); ++i) {
            if (!is_class(i)) continue;
            classes_with_templates.push_back(&files.load<ClassWithTemplate>(read_class_with_template, i));
            classes.push_back(classes_with_templates.back()->learnt);
            class_files.push_back(files.file(i));
            if (classes_with_templates.front()->landmarks.has_value() != classes_with_templates.back()->landmarks.has_value())
                fail_input(files.file(i),
                           "differs in kind from the first class: one is a class of meshes, the other a class of landmarks",
                           "use a separate call for each");
        }
        // Classes with the same name are distinguished by their files.
        for (std::size_t i = 0; i < classes.size(); ++i)
            if (std::count_if(classes_with_templates.begin(), classes_with_templates.end(),
                              [&](const auto* k) { return k->learnt.name == classes[i].name; }) > 1)
                classes[i].name += fmt::format(" ({})", class_files[i]);
        moderate_thresholds(classes);
    }

    [[nodiscard]] std::vector<ClassAnswer> compare_landmarks(Context& context, std::size_t i) const {
        std::vector<ClassAnswer> class_answers;
        const Path file = files.path(i);
        context.record([&] {
            for (std::size_t k = 0; k < classes.size(); ++k)
                class_answers.push_back(
                    compare_with(classes[k], read_landmark_member(file, *classes_with_templates[k]->landmarks), options));
        });
        return class_answers;
    }

    [[nodiscard]] std::vector<ClassAnswer> compare_meshes(std::size_t i) const {
        const WholeObject& given_object = files.load<WholeObject>(read_member, i);
        return in_file(files.file(i), [&] {
            const WholeShape whole = measure_whole_shape(given_object.mesh);
            std::vector<ClassAnswer> class_answers;
            for (std::size_t k = 0; k < classes.size(); ++k) {
                LearnOptions learn_options;
                learn_options.fit = options.fit;
                learn_options.correspondence = options.correspondence;
                learn_options.modes.sizes = classes[k].sizes;
                std::optional<WholeObject> renamed;
                if (vocabulary && classes_with_templates[k]->package.annotations)
                    vocabulary.words().rename_like(renamed.emplace(given_object).annotations,
                                                   *classes_with_templates[k]->package.annotations);
                const WholeObject& object = renamed ? *renamed : given_object;
                class_answers.push_back(compare_with(
                    classes[k], learn_member(classes_with_templates[k]->known(), object, learn_options, &whole), options));
            }
            return class_answers;
        });
    }

    void report_result(Report& report, const std::vector<Classification>& answers) const {
        report.values(document_of(answers));
        std::size_t unanswered = 0;
        for (const Classification& object : answers) {
            if (object.problem.empty()) continue;
            ++unanswered;
            report.note(fmt::format("{}: {}", object.object, object.problem));
        }
        if (unanswered > 0) report.note(fmt::format("{} of {} objects could not be classified", unanswered, answers.size()));
        for (const Classification& object : answers)
            for (const ClassAnswer& class_answer : object.answers)
                report.row(
                    "", {object.object, class_answer.name, to_string(class_answer.verdict),
                         class_answer.fit.problem.empty() ? number(class_answer.score, 4) : "-", class_answer.reasons().size()});
        for (const Classification& object : answers) {
            report.line(fmt::format("\n{} {}", printable(object.object), printable(object.text)));
            for (const ClassAnswer& class_answer : object.answers) {
                constexpr std::size_t maximum = 8;
                const auto reasons = class_answer.reasons();
                const bool is_reported = object.text.find(class_answer.undecided) != std::string::npos;
                if (!class_answer.undecided.empty() && !is_reported)
                    report.line(fmt::format("  {}: {}", printable(class_answer.name), printable(class_answer.undecided)));
                if (class_answer.undecided.empty() && !class_answer.fit_problem.empty())
                    report.line(fmt::format("  {}: {}", printable(class_answer.name), printable(class_answer.fit_problem)));
                if (&class_answer == explained_class(object))
                    for (const std::string& line : explanation_lines(class_answer))
                        report.line(fmt::format("  {}: {}", printable(class_answer.name), printable(line)));
                for (std::size_t i = 0; i < reasons.size() && i < maximum; ++i)
                    report.line(fmt::format("  against {}: {}", printable(class_answer.name), printable(reasons[i])));
                if (reasons.size() > maximum) report.line(fmt::format("  and {} more", reasons.size() - maximum));
            }
        }
    }

    /// The class whose explanation is shown: the one the object belongs to, or else the nearest.
    static const ClassAnswer* explained_class(const Classification& object) {
        const int k = object.best >= 0 ? object.best : object.nearest;
        return k < 0 ? nullptr : &object.answers[static_cast<std::size_t>(k)];
    }

    static std::vector<std::string> explanation_lines(const ClassAnswer& class_answer) {
        std::vector<std::string> lines = class_answer.unusual_findings;
        for (const std::string& line : fit_explanation(class_answer.fit)) lines.push_back(line);
        lines.insert(lines.end(), class_answer.fit.notes.begin(), class_answer.fit.notes.end());
        return lines;
    }

    FileInput files;
    JsonOutput answer;
    VocabularyOption vocabulary;
    ClassifyOptions options;
    std::vector<const ClassWithTemplate*> classes_with_templates;
    std::vector<ShapeClass> classes;  ///< known classes with thresholds adjusted to each other
};

}  // namespace

std::unique_ptr<Operation> make_template_classify() { return make<TemplateClassify>(); }

}  // namespace ostraka
