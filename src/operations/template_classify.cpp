// template classify: the class to which objects belong.
#include "operations.h"

#include "ostraka/shape_classes/member_file.h"

#include <algorithm>
#include <optional>

namespace ostraka {

namespace {

struct TemplateClassify final : Operation {
    void describe(Parameters& p) override {
        p.input("files", Kind::shape_class, files,
                "classes (.class.json), then a mesh file for each object (of landmarks for classes of landmarks)")
            .many();
        vocabulary.describe(p, as_template_words);
        p.output_option("report", Kind::report, answer, "write the whole answer as JSON (doc/schema/classification.schema.json)");
        options.describe(p.options);
        p.report.schema = "classification";
        p.report.people_table("", {"object", "class", "verdict", "score", "against"});
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
        std::optional<Error> first;
        std::size_t kept = 0;
        Progress progress("asking classes", files.size());
        for (std::size_t i = 0; i < files.size(); ++i, progress.advance()) {
            if (is_class(i)) continue;
            answers.push_back(answer_of(context, i, first));
            if (answer && answers.size() >= kept + 1 + kept / 32) {  // at most 1/32 is lost; O(n log n) bytes in total
                keep(answers);
                kept = answers.size();
            }
        }
        if (answer && kept < answers.size()) keep(answers);
        if (std::all_of(answers.begin(), answers.end(), [](const auto& a) { return !a.problem.empty(); })) throw *first;
        report_result(report, answers);
        if (!std::all_of(answers.begin(), answers.end(), [](const auto& a) { return a.verdict == Membership::member; }))
            report.answer_no();
    }

    /// Classifies the i-th object. If it cannot be read or fitted, the others are still processed; the first error is kept.
    [[nodiscard]] Classification answer_of(Context& context, std::size_t i, std::optional<Error>& first) const {
        try {
            return decide(object_name(files.file(i)), known.front()->landmarks ? ask_landmarks(context, i) : ask_meshes(i),
                          options);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input && error.kind() != ErrorKind::failure) throw;
            if (!first) first = error;
            Classification unanswered;
            unanswered.object = object_name(files.file(i));
            unanswered.problem = error.what();
            unanswered.text = "cannot be asked about: " + unanswered.problem;
            return unanswered;
        }
    }

    /// Writes the answers so far to disk, so that an interrupted run keeps them.
    void keep(const std::vector<Classification>& answers) const {
        OutputTransaction own;
        answer.write(document_of(answers));
        own.commit();
    }

    static Json document_of(const std::vector<Classification>& answers) {
        Json document = json_document("classification");
        auto& allocator = document.GetAllocator();
        const auto object_json = [&](const auto& one) { return classification_to_json(one, allocator); };
        add_members(document, allocator, "objects", json_list(answers, allocator, object_json));
        return document;
    }

    [[nodiscard]] bool is_class(std::size_t i) const { return files.file(i).ends_with(".class.json"); }

    void read_classes() {
        std::vector<std::string> class_files;
        for (std::size_t i = 0; i < files.size(); ++i) {
            if (!is_class(i)) continue;
            known.push_back(&files.load<ClassWithTemplate>(read_class_with_template, i));
            classes.push_back(known.back()->learnt);
            class_files.push_back(files.file(i));
            if (known.front()->landmarks.has_value() != known.back()->landmarks.has_value())
                fail_input(files.file(i), "is a class of meshes, or of landmarks, and the first is not",
                           "ask them one after the other");
        }
        // Classes with the same name are distinguished by their files.
        for (std::size_t i = 0; i < classes.size(); ++i)
            if (std::count_if(known.begin(), known.end(), [&](const auto* k) { return k->learnt.name == classes[i].name; }) > 1)
                classes[i].name += " (" + class_files[i] + ")";
        moderate_thresholds(classes);
    }

    [[nodiscard]] std::vector<ClassAnswer> ask_landmarks(Context& context, std::size_t i) const {
        std::vector<ClassAnswer> list;
        const Path file = files.path(i);
        context.record([&] {
            for (std::size_t k = 0; k < classes.size(); ++k)
                list.push_back(compare_with(classes[k], read_landmark_member(file, *known[k]->landmarks), options));
        });
        return list;
    }

    [[nodiscard]] std::vector<ClassAnswer> ask_meshes(std::size_t i) const {
        const WholeObject& read = files.load<WholeObject>(read_member, i);
        return in_file(files.file(i), [&] {
            const WholeShape whole = measure_whole_shape(read.mesh);
            std::vector<ClassAnswer> list;
            for (std::size_t k = 0; k < classes.size(); ++k) {
                LearnOptions how;
                how.fit = options.fit;
                how.correspondence = options.correspondence;
                how.modes.sizes = classes[k].sizes;
                std::optional<WholeObject> renamed;
                if (vocabulary && known[k]->package.annotations)
                    vocabulary.words().rename_like(renamed.emplace(read).annotations, *known[k]->package.annotations);
                const WholeObject& object = renamed ? *renamed : read;
                list.push_back(compare_with(classes[k], learn_member(known[k]->known(), object, how, &whole), options));
            }
            return list;
        });
    }

    void report_result(Report& report, const std::vector<Classification>& answers) const {
        report.values(document_of(answers));
        std::size_t unanswered = 0;
        for (const Classification& object : answers) {
            if (object.problem.empty()) continue;
            ++unanswered;
            report.note(object.object + ": " + object.problem);
        }
        if (unanswered > 0)
            report.note(std::to_string(unanswered) + " of " + std::to_string(answers.size()) +
                        " objects could not be asked about");
        for (const Classification& object : answers)
            for (const ClassAnswer& one : object.answers)
                report.row("", {object.object, one.name, to_string(one.verdict),
                                one.fit.problem.empty() ? number(one.score, 4) : "-", one.reasons().size()});
        for (const Classification& object : answers) {
            report.line("\n" + printable(object.object) + " " + printable(object.text));
            for (const ClassAnswer& one : object.answers) {
                constexpr std::size_t maximum = 8;
                const auto reasons = one.reasons();
                const bool said = object.text.find(one.undecided) != std::string::npos;
                if (!one.undecided.empty() && !said) report.line("  " + printable(one.name) + ": " + printable(one.undecided));
                if (one.undecided.empty() && !one.off.empty())
                    report.line("  " + printable(one.name) + ": " + printable(one.off));
                if (&one == told(object))
                    for (const std::string& line : told_of(one)) report.line("  " + printable(one.name) + ": " + printable(line));
                for (std::size_t i = 0; i < reasons.size() && i < maximum; ++i)
                    report.line("  against " + printable(one.name) + ": " + printable(reasons[i]));
                if (reasons.size() > maximum) report.line("  and " + std::to_string(reasons.size() - maximum) + " more");
            }
        }
    }

    /// The class whose explanation is shown: the one the object belongs to, or else the nearest.
    static const ClassAnswer* told(const Classification& object) {
        const int k = object.best >= 0 ? object.best : object.nearest;
        return k < 0 ? nullptr : &object.answers[static_cast<std::size_t>(k)];
    }

    static std::vector<std::string> told_of(const ClassAnswer& one) {
        std::vector<std::string> lines = one.odd;
        for (const std::string& line : explained_text(one.fit)) lines.push_back(line);
        lines.insert(lines.end(), one.fit.notes.begin(), one.fit.notes.end());
        return lines;
    }

    FileInput files;
    JsonOutput answer;
    VocabularyOption vocabulary;
    ClassifyOptions options;
    std::vector<const ClassWithTemplate*> known;
    std::vector<ShapeClass> classes;  ///< known classes with thresholds adjusted to each other
};

}  // namespace

std::unique_ptr<Operation> make_template_classify() { return make<TemplateClassify>(); }

}  // namespace ostraka
